//! Rigid obstacles that the walls of a tube may touch.
//!
//! Vectors are (z, x, y), lengths in D. An obstacle is described by the distance g of a point from its surface, positive
//! outside the rigid body.

/// A rigid obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Name.
    pub name: String,
    /// Shape.
    pub shape: ObstacleShape,
    /// Placement at rest.
    pub rest: Placement,
    /// Coefficient of friction of the walls on it.
    pub friction: f64,
}

/// The shape of an obstacle, apart from its placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObstacleShape {
    /// A solid cylinder along z with hemispherical ends, the centre of its axis at the position.
    Rod {
        /// Half the distance between the centres of the hemispheres; infinite for a rod without ends.
        half_length: f64,
    },
    /// The space outside an infinite cylinder along z.
    Sheath,
    /// A ball.
    Ball,
    /// A half-space whose surface contains the position.
    Plate {
        /// Unit normal out of the half-space.
        normal: [f64; 3],
    },
}

/// Size and place of an obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Radius; none of a plate.
    pub radius: f64,
    /// Position of the centre, or of a point of the surface of a plate.
    pub position: [f64; 3],
}

/// Distance of a point from an obstacle, and its derivatives over the position of the point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// g.
    pub gap: f64,
    /// ∇g, a unit vector.
    pub normal: [f64; 3],
    /// ∇∇g.
    pub curvature: [[f64; 3]; 3],
}

impl Obstacle {
    /// Returns whether a placement of the obstacle is symmetric about the axis of the tube.
    pub fn is_axisymmetric(&self, placement: &Placement) -> bool {
        let [_, x, y] = match self.shape {
            ObstacleShape::Plate { normal } => normal,
            _ => placement.position,
        };
        x == 0.0 && y == 0.0
    }
}

impl ObstacleShape {
    /// Returns the distance of a point from the surface.
    pub fn distance(&self, placement: &Placement, point: [f64; 3]) -> Distance {
        let Placement { radius, position } = placement;
        let from: [f64; 3] = std::array::from_fn(|i| point[i] - position[i]);
        match self {
            Self::Rod { half_length } => {
                let beyond = from[0] - from[0].clamp(-half_length, *half_length);
                let is_along = beyond != 0.0;
                round([beyond, from[1], from[2]], is_along, *radius)
            }
            Self::Ball => round(from, true, *radius),
            Self::Sheath => {
                let Distance {
                    gap,
                    normal,
                    curvature,
                } = round([0.0, from[1], from[2]], false, *radius);
                Distance {
                    gap: -gap,
                    normal: normal.map(|x| -x),
                    curvature: curvature.map(|row| row.map(|x| -x)),
                }
            }
            Self::Plate { normal } => Distance {
                gap: (0..3).map(|i| normal[i] * from[i]).sum(),
                normal: *normal,
                curvature: [[0.0; 3]; 3],
            },
        }
    }

    /// Returns ∂g/∂radius.
    pub fn radius_slope(&self) -> f64 {
        match self {
            Self::Rod { .. } | Self::Ball => -1.0,
            Self::Sheath => 1.0,
            Self::Plate { .. } => 0.0,
        }
    }

    /// Returns the shape turned about the z axis by an angle with the given sine and cosine.
    pub fn turned(&self, sin_cos: (f64, f64)) -> Self {
        match *self {
            Self::Plate { normal } => Self::Plate {
                normal: turned(normal, sin_cos),
            },
            shape => shape,
        }
    }
}

impl Placement {
    /// Returns the placement turned about the z axis by an angle with the given sine and cosine.
    pub fn turned(&self, sin_cos: (f64, f64)) -> Self {
        Self {
            position: turned(self.position, sin_cos),
            ..*self
        }
    }
}

/// Returns a vector turned about the z axis by an angle with the given sine and cosine.
pub fn turned([z, x, y]: [f64; 3], (sin, cos): (f64, f64)) -> [f64; 3] {
    [z, x * cos - y * sin, x * sin + y * cos]
}

/// Returns |d| − radius and its derivatives; the z component counts if `is_along`.
fn round(d: [f64; 3], is_along: bool, radius: f64) -> Distance {
    // On the axis, deep inside, there is no direction out.
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-12);
    let normal = d.map(|x| x / length);
    let mut curvature = [[0.0; 3]; 3];
    let first = if is_along { 0 } else { 1 };
    for i in first..3 {
        for j in first..3 {
            let identity = if i == j { 1.0 } else { 0.0 };
            curvature[i][j] = (identity - normal[i] * normal[j]) / length;
        }
    }
    Distance {
        gap: length - radius,
        normal,
        curvature,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [ObstacleShape; 5] = [
        ObstacleShape::Rod {
            half_length: f64::INFINITY,
        },
        ObstacleShape::Rod { half_length: 0.3 },
        ObstacleShape::Sheath,
        ObstacleShape::Ball,
        ObstacleShape::Plate {
            normal: [0.48, -0.6, 0.64],
        },
    ];

    #[test]
    fn normal_and_curvature_are_derivatives_of_the_gap() {
        let placement = Placement {
            radius: 0.2,
            position: [1.0, 0.1, -0.05],
        };
        for shape in SHAPES {
            for point in [[1.1, 0.4, 0.2], [1.7, 0.2, -0.3], [0.4, -0.2, 0.1]] {
                let at = shape.distance(&placement, point);
                let length: f64 = at.normal.iter().map(|x| x * x).sum();
                assert!((length - 1.0).abs() < 1e-12);
                for i in 0..3 {
                    let h = 1e-5;
                    let [low, high] = [-h, h].map(|h| {
                        let mut moved = point;
                        moved[i] += h;
                        shape.distance(&placement, moved)
                    });
                    let slope = (high.gap - low.gap) / (2.0 * h);
                    assert!((slope - at.normal[i]).abs() < 1e-9, "{shape:?}");
                    for j in 0..3 {
                        let slope = (high.normal[j] - low.normal[j]) / (2.0 * h);
                        assert!((slope - at.curvature[i][j]).abs() < 1e-8, "{shape:?}");
                    }
                }
                let wider = Placement {
                    radius: 0.25,
                    ..placement
                };
                let change = shape.distance(&wider, point).gap - at.gap;
                assert!((change - 0.05 * shape.radius_slope()).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn gaps_are_distances_from_known_bodies() {
        let placement = Placement {
            radius: 0.2,
            position: [1.0, 0.0, 0.0],
        };
        let gap = |shape: ObstacleShape, point| shape.distance(&placement, point).gap;
        let [endless, rod, sheath, ball, plate] = SHAPES;
        assert!((gap(endless, [5.0, 0.3, 0.4]) - 0.3).abs() < 1e-15);
        assert!((gap(rod, [1.2, 0.3, 0.4]) - 0.3).abs() < 1e-15);
        // 0.3 beyond the centre of the hemisphere.
        assert!((gap(rod, [1.6, 0.0, 0.4]) - 0.3).abs() < 1e-15);
        assert!((gap(sheath, [5.0, 0.06, 0.08]) - 0.1).abs() < 1e-15);
        assert!((gap(ball, [1.3, 0.0, 0.4]) - 0.3).abs() < 1e-15);
        assert!((gap(plate, [2.0, 0.0, 1.0]) - 1.12).abs() < 1e-15);
    }
}
