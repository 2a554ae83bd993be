//! Surfaces and meridian sections of the rigid obstacles of a tube, for pictures and files.
//!
//! Vectors are (z, x, y), lengths in D. Endless bodies are drawn a little beyond the ends of the tube.

use plica::assembly::SplineTube;
use plica::tube::{Load, ObstacleShape, Placement};
use std::f64::consts::{PI, TAU};

/// Length that is drawn of an endless body, and of a plate, beyond the ends of the tube.
const BEYOND: f64 = 0.15;
/// Length that is drawn of a body with ends beyond those of the tube.
const FAR_BEYOND: f64 = 0.6;
/// Half the width of a plate.
const REACH: f64 = 0.9;
/// Largest distance from the axis at which a section is drawn.
const HIGHEST: f64 = 1.2;
/// Points along a body and along an arc of its profile.
const POINTS: [usize; 2] = [61, 25];
/// Points around a body.
const AROUND: usize = 73;

/// An obstacle as it is drawn, or a copy where the symmetry of the tube repeats it.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Number of the obstacle in the tube.
    pub obstacle: usize,
    /// Its shape.
    pub shape: ObstacleShape,
    /// Its placement.
    pub placement: Placement,
    /// The part of its surface near the tube.
    pub surface: BodySurface,
}

/// The surface of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodySurface {
    /// A profile turned about an axis parallel to that of the tube.
    Revolved {
        /// Points (z, distance from the axis of the body).
        profile: Vec<[f64; 2]>,
        /// Position (x, y) of the axis.
        axis: [f64; 2],
    },
    /// A quadrilateral, by its corners: two rows of two points.
    Flat([[f64; 3]; 4]),
}

/// A structured grid of points of a body. The rows of a revolved one lie around its axis.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyGrid {
    /// Points along a row.
    pub columns: usize,
    /// Points row by row.
    pub points: Vec<[f64; 3]>,
}

/// A section of an obstacle by the half-plane of a meridian.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleSection {
    /// Number of the obstacle in the tube.
    pub obstacle: usize,
    /// Lines of points (z, r).
    pub lines: Vec<Vec<[f64; 2]>>,
}

impl BodySurface {
    /// Returns a grid of the surface; a revolved one between two angles about its axis, in radians.
    pub fn grid(&self, [from, to]: [f64; 2]) -> BodyGrid {
        match self {
            Self::Flat(corners) => BodyGrid {
                columns: 2,
                points: corners.to_vec(),
            },
            Self::Revolved { profile, axis } => {
                let [x, y] = *axis;
                let row = |j: usize| {
                    let angle = from + (to - from) * j as f64 / (AROUND - 1) as f64;
                    let (sin, cos) = angle.sin_cos();
                    let turned = move |&[z, r]: &[f64; 2]| [z, x + r * cos, y + r * sin];
                    profile.iter().map(turned)
                };
                BodyGrid {
                    columns: profile.len(),
                    points: (0..AROUND).flat_map(row).collect(),
                }
            }
        }
    }
}

impl BodyGrid {
    /// Returns its triangles, by the indices of their points; those without area are left out.
    pub fn triangles(&self) -> Vec<[usize; 3]> {
        let columns = self.columns;
        let mut all = vec![];
        for row in 1..self.points.len() / columns {
            for column in 1..columns {
                let d = row * columns + column;
                let (a, b, c) = (d - columns - 1, d - columns, d - 1);
                all.extend([[a, b, d], [a, d, c]]);
            }
        }
        let same = |a: usize, b: usize| {
            (0..3).all(|i| (self.points[a][i] - self.points[b][i]).abs() < 1e-12)
        };
        all.retain(|&[a, b, c]| !same(a, b) && !same(b, c) && !same(c, a));
        all
    }
}

/// Returns the obstacles of a tube under a load with their copies; those that are far from the tube are left out.
pub fn bodies(tube: &SplineTube, load: &Load) -> Vec<Body> {
    let length = tube.tube.length;
    let copies = placed(tube, load).into_iter();
    let body = |(obstacle, shape, placement): (usize, ObstacleShape, Placement)| {
        let surface = match shape {
            ObstacleShape::Plate { normal } => {
                BodySurface::Flat(plate(normal, &placement, length)?)
            }
            _ => BodySurface::Revolved {
                profile: Some(profile(&shape, &placement, length)).filter(|p| p.len() > 1)?,
                axis: [placement.position[1], placement.position[2]],
            },
        };
        Some(Body {
            obstacle,
            shape,
            placement,
            surface,
        })
    };
    copies.filter_map(body).collect()
}

/// Returns numbers, shapes and placements of the obstacles under a load and their copies.
fn placed(tube: &SplineTube, load: &Load) -> Vec<(usize, ObstacleShape, Placement)> {
    let obstacles = tube.tube.obstacles.iter().zip(&load.obstacles);
    let copies = obstacles
        .enumerate()
        .flat_map(|(number, (obstacle, placement))| {
            let repeats = match obstacle.is_axisymmetric(placement) {
                true => 1,
                false => tube.sector.around / tube.sector.rings,
            };
            (0..repeats).map(move |i| {
                let turn = (TAU * i as f64 / repeats as f64).sin_cos();
                (number, obstacle.shape.turned(turn), placement.turned(turn))
            })
        });
    copies.collect()
}

/// Returns the sections of all obstacles under a load by the half-plane at an angle, in radians; those without points are left
/// out.
pub fn sections(tube: &SplineTube, load: &Load, angle: f64) -> Vec<ObstacleSection> {
    let length = tube.tube.length;
    let section = |(obstacle, shape, placement): (usize, ObstacleShape, Placement)| {
        let lines = match shape {
            ObstacleShape::Plate { normal } => plate_section(normal, &placement, length, angle),
            _ => round_section(&profile(&shape, &placement, length), &placement, angle),
        };
        (!lines.is_empty()).then_some(ObstacleSection { obstacle, lines })
    };
    placed(tube, load).into_iter().filter_map(section).collect()
}

/// Returns the profile (z, radius about the axis of the body) of a body with an axis, within the drawn length.
fn profile(shape: &ObstacleShape, placement: &Placement, length: f64) -> Vec<[f64; 2]> {
    let (radius, middle) = (placement.radius, placement.position[0]);
    let half = match shape {
        ObstacleShape::Rod { half_length } => *half_length,
        ObstacleShape::Ball => 0.0,
        _ => f64::INFINITY,
    };
    let [along, arc] = POINTS;
    if !half.is_finite() {
        let at = |i: usize| {
            let part = i as f64 / (along - 1) as f64;
            [part * (length + 2.0 * BEYOND) - BEYOND, radius]
        };
        return (0..along).map(at).collect();
    }
    // From the lower pole over the cylinder to the upper one.
    let hemisphere = |from: f64, centre: f64| {
        (0..arc).map(move |i| {
            let angle = from + 0.5 * PI * i as f64 / (arc - 1) as f64;
            [centre - radius * angle.cos(), radius * angle.sin()]
        })
    };
    let lower = hemisphere(0.0, middle - half);
    let upper = hemisphere(0.5 * PI, middle + half);
    let is_drawn = |[z, _]: &[f64; 2]| (-FAR_BEYOND..=length + FAR_BEYOND).contains(z);
    lower.chain(upper).filter(is_drawn).collect()
}

/// The plane n · p = d of a plate; `across` is the length of the part of n across the axis.
struct Plane {
    normal: [f64; 3],
    offset: f64,
    across: f64,
}

impl Plane {
    fn new(normal: [f64; 3], placement: &Placement) -> Self {
        let [z, x, y] = placement.position;
        Self {
            normal,
            offset: normal[0] * z + normal[1] * x + normal[2] * y,
            across: normal[1].hypot(normal[2]),
        }
    }

    /// Returns whether the plate is drawn along the tube; else it lies across.
    fn runs_along(&self) -> bool {
        self.across > self.normal[0].abs()
    }
}

/// Returns the corners of a plate near the tube; none if it is far from it.
fn plate(normal: [f64; 3], placement: &Placement, length: f64) -> Option<[[f64; 3]; 4]> {
    let plane = Plane::new(normal, placement);
    let [n_z, n_x, n_y] = normal;
    let sides = [-REACH, REACH];
    if !plane.runs_along() {
        let corner = |x: f64, y: f64| [(plane.offset - n_x * x - n_y * y) / n_z, x, y];
        let corners = sides.map(|x| sides.map(|y| corner(x, y)));
        let middle = plane.offset / n_z;
        let is_near = (-FAR_BEYOND..=length + FAR_BEYOND).contains(&middle);
        let [[a, b], [c, d]] = corners;
        return is_near.then_some([a, b, c, d]);
    }
    // Distance of the plane from the axis at z, between the planes of the ends and where it is near.
    let distance = |z: f64| (plane.offset - n_z * z) / plane.across;
    let mut ends = [-BEYOND, length + BEYOND];
    if n_z != 0.0 {
        let mut near = sides.map(|d| (plane.offset - 2.0 * d * plane.across) / n_z);
        near.sort_by(f64::total_cmp);
        ends = [ends[0].max(near[0]), ends[1].min(near[1])];
    }
    if ends[0] >= ends[1] || distance(ends[0]).abs() > 2.0 * REACH + 1e-9 {
        return None;
    }
    let [x, y] = [n_x, n_y].map(|n| n / plane.across);
    let corner = |side: f64, z: f64| {
        let d = distance(z);
        [z, d * x - side * y, d * y + side * x]
    };
    let [[a, b], [c, d]] = sides.map(|side| ends.map(|z| corner(side, z)));
    Some([a, b, c, d])
}

fn plate_section(
    normal: [f64; 3],
    placement: &Placement,
    length: f64,
    angle: f64,
) -> Vec<Vec<[f64; 2]>> {
    let plane = Plane::new(normal, placement);
    let (sin, cos) = angle.sin_cos();
    let outwards = normal[1] * cos + normal[2] * sin;
    let [along, _] = POINTS;
    if outwards.abs() > 1e-9 && plane.runs_along() {
        let at = |i: usize| {
            let z = i as f64 / (along - 1) as f64 * (length + 2.0 * BEYOND) - BEYOND;
            [z, (plane.offset - normal[0] * z) / outwards]
        };
        return unbroken((0..along).map(at));
    }
    if plane.runs_along() {
        return vec![];
    }
    let at = |i: usize| {
        let r = i as f64 / (along - 1) as f64 * REACH;
        [(plane.offset - outwards * r) / normal[0], r]
    };
    unbroken((0..along).map(at))
}

/// Returns the section of a body with an axis parallel to that of the tube, by the half-plane at an angle.
fn round_section(profile: &[[f64; 2]], placement: &Placement, angle: f64) -> Vec<Vec<[f64; 2]>> {
    let [_, x, y] = placement.position;
    let (sin, cos) = angle.sin_cos();
    let (along, across) = (x * cos + y * sin, y * cos - x * sin);
    // |r e − c| = radius, with e the direction of the half-plane and c the centre; NaN where they do not meet.
    let branch = |sign: f64| {
        unbroken(profile.iter().map(move |&[z, radius]| {
            let square = radius * radius - across * across;
            [z, along + sign * square.sqrt()]
        }))
    };
    let mut lines = branch(1.0);
    lines.extend(branch(-1.0));
    lines
}

/// Returns the parts of a line that lie on the half-plane near the tube, those of at least two points.
fn unbroken(points: impl Iterator<Item = [f64; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut lines = vec![vec![]];
    for point in points {
        if (0.0..=HIGHEST).contains(&point[1]) {
            if let Some(line) = lines.last_mut() {
                line.push(point);
            }
        } else if lines.last().is_some_and(|line| !line.is_empty()) {
            lines.push(vec![]);
        }
    }
    lines.retain(|line| line.len() > 1);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use plica::assembly::SplineTube;
    use plica::tube::{Distance, Obstacle};

    /// A tube with obstacles of all shapes, on its axis and beside it.
    fn tube() -> (SplineTube, Load) {
        let plan = crate::fixture::plan(plica::tube::Symmetry::None);
        let mut tube = plan.tube.clone();
        let shapes = [
            (ObstacleShape::Ball, 0.3, [1.0, 0.0, 0.0]),
            (ObstacleShape::Ball, 0.3, [1.0, 0.1, -0.2]),
            (ObstacleShape::Sheath, 0.7, [0.0, 0.0, 0.1]),
            (
                ObstacleShape::Rod { half_length: 0.4 },
                0.1,
                [0.5, 0.05, 0.0],
            ),
            (
                ObstacleShape::Rod {
                    half_length: f64::INFINITY,
                },
                0.1,
                [0.0; 3],
            ),
            (
                ObstacleShape::Plate {
                    normal: [0.0, 0.6, 0.8],
                },
                0.0,
                [0.0, -0.6, 0.0],
            ),
            (
                ObstacleShape::Plate {
                    normal: [0.28, 0.0, 0.96],
                },
                0.0,
                [0.2, 0.1, -0.6],
            ),
            (
                ObstacleShape::Plate {
                    normal: [0.96, 0.28, 0.0],
                },
                0.0,
                [0.4, 0.1, 0.0],
            ),
        ];
        let obstacle =
            |(i, (shape, radius, position)): (usize, (ObstacleShape, f64, [f64; 3]))| Obstacle {
                name: format!("body-{i}"),
                shape,
                rest: Placement { radius, position },
                friction: 0.0,
            };
        tube.obstacles = shapes.into_iter().enumerate().map(obstacle).collect();
        let load = tube.rest();
        (
            SplineTube::new(&tube, &plan.mesh, plan.mesh.rings(plan.symmetry)),
            load,
        )
    }

    #[test]
    fn all_drawn_points_lie_on_their_obstacle() {
        let (tube, load) = tube();
        let gap = |obstacle: usize, point| {
            let Distance { gap, .. } = tube.tube.obstacles[obstacle]
                .shape
                .distance(&load.obstacles[obstacle], point);
            gap
        };
        let bodies = bodies(&tube, &load);
        assert_eq!(bodies.len(), 8);
        for body in &bodies {
            let grid = body.surface.grid([0.0, TAU]);
            assert_eq!(grid.points.len() % grid.columns, 0);
            for point in &grid.points {
                assert!(gap(body.obstacle, *point).abs() < 1e-12, "{body:?}");
            }
        }
        for angle in [0.0, 0.7, -2.0] {
            let (sin, cos) = f64::sin_cos(angle);
            let sections = sections(&tube, &load, angle);
            assert!(sections.len() > 4, "{angle}: {}", sections.len());
            for section in sections {
                for [z, r] in section.lines.concat() {
                    let off = gap(section.obstacle, [z, r * cos, r * sin]).abs();
                    assert!(
                        off < 1e-7 && r >= 0.0,
                        "{angle} {}: {off:e}",
                        section.obstacle
                    );
                }
            }
        }
    }

    #[test]
    fn the_triangles_of_a_ball_have_its_area() {
        let (tube, load) = tube();
        let grid = bodies(&tube, &load)[0].surface.grid([0.0, TAU]);
        let area = |&[a, b, c]: &[usize; 3]| {
            let [a, b, c] = [a, b, c].map(|i| grid.points[i]);
            let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
            let cross = [1, 2, 0].map(|i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                u[j] * v[k] - u[k] * v[j]
            });
            0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
        };
        let sum: f64 = grid.triangles().iter().map(area).sum();
        let exact = 4.0 * PI * 0.3 * 0.3;
        assert!((sum / exact - 1.0).abs() < 3e-3, "{sum} {exact}");
    }

    #[test]
    fn the_section_of_a_ball_on_the_axis_is_a_half_circle() {
        let (tube, load) = tube();
        let of_ball = &sections(&tube, &load, 0.3)[0];
        let line = &of_ball.lines[0];
        assert_eq!(of_ball.lines.len(), 1, "the other half has r < 0");
        let ends = [line[0], line[line.len() - 1]];
        assert!((ends[0][0] - 0.7).abs() < 1e-12 && (ends[1][0] - 1.3).abs() < 1e-12);
        assert!(line.iter().any(|[_, r]| (r - 0.3).abs() < 1e-12));
    }
}
