//! Loads of a tube: targets and shifts of the muscles, displacements of the ends, pressures on the walls, placements of
//! obstacles, growth of patches.

use super::Placement;

/// A load of a tube.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Target of each muscle of the tube, in the order of the tube: Dmin/D, Lmax/L, or the tension in E.
    pub muscles: Vec<f64>,
    /// Shift of the zone of each muscle along the tube, in D.
    pub shifts: Vec<f64>,
    /// Motion of the colon end and the ileum end.
    pub ends: [EndMotion; 2],
    /// Pressure on the inner wall, acting outwards, and on the outer wall, acting inwards.
    pub pressures: [Pressure; 2],
    /// Volume of the lumen over that of the stress-free shape, if it is driven. The follower pressure on the inner wall then
    /// is what holds it: that of an accepted state, and of no meaning before.
    pub lumen_volume: Option<f64>,
    /// Placement of each obstacle of the tube, in the order of the tube.
    pub obstacles: Vec<Placement>,
    /// Stress-free thickness over the thickness at rest in the middle of each patch of the tube, in the order of the tube.
    pub patches: Vec<f64>,
}

/// Prescribed motion of a supported end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndMotion {
    /// Along z, in D.
    pub displacement: f64,
    /// About z, in radians; fixed ends only.
    pub twist: f64,
    /// Across the axis, along x and y, in D; fixed ends of whole tubes only.
    pub shift: [f64; 2],
    /// Rotation vector about x and y, in radians, after the twist: its direction is the axis and its length the angle;
    /// fixed ends of whole tubes only.
    pub tilt: [f64; 2],
}

impl EndMotion {
    /// Returns whether the end leaves its axis.
    pub fn is_sideways(&self) -> bool {
        self.shift != [0.0; 2] || self.tilt != [0.0; 2]
    }
}

/// Pressures on one wall, in E.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressure {
    /// Follower pressure: per current area, normal to the current wall.
    pub follower: f64,
    /// Dead load: per reference area, normal to the reference wall.
    pub dead: f64,
}

impl Load {
    /// Returns the load without the pressure that holds a driven volume of the lumen.
    #[must_use]
    pub fn without_multiplier(mut self) -> Self {
        if self.lumen_volume.is_some() {
            self.pressures[0].follower = 0.0;
        }
        self
    }

    /// Interpolates linearly to another load, which has t = 1.
    pub fn towards(&self, other: &Self, t: f64) -> Self {
        // At t = 1 the other load to the bit.
        let mix = |a: f64, b: f64| if t == 1.0 { b } else { a + t * (b - a) };
        let end = |i: usize| EndMotion {
            displacement: mix(self.ends[i].displacement, other.ends[i].displacement),
            twist: mix(self.ends[i].twist, other.ends[i].twist),
            shift: [0, 1].map(|k| mix(self.ends[i].shift[k], other.ends[i].shift[k])),
            tilt: [0, 1].map(|k| mix(self.ends[i].tilt[k], other.ends[i].tilt[k])),
        };
        let pressure = |i: usize| Pressure {
            follower: mix(self.pressures[i].follower, other.pressures[i].follower),
            dead: mix(self.pressures[i].dead, other.pressures[i].dead),
        };
        let placement = |(a, b): (&Placement, &Placement)| Placement {
            radius: mix(a.radius, b.radius),
            position: std::array::from_fn(|i| mix(a.position[i], b.position[i])),
        };
        let all = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(&a, &b)| mix(a, b)).collect();
        Self {
            muscles: all(&self.muscles, &other.muscles),
            shifts: all(&self.shifts, &other.shifts),
            ends: [end(0), end(1)],
            pressures: [pressure(0), pressure(1)],
            lumen_volume: match [self.lumen_volume, other.lumen_volume] {
                [Some(a), Some(b)] => Some(mix(a, b)),
                [_, b] => b,
            },
            obstacles: self
                .obstacles
                .iter()
                .zip(&other.obstacles)
                .map(placement)
                .collect(),
            patches: self
                .patches
                .iter()
                .zip(&other.patches)
                .map(|(&a, &b)| mix(a, b))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_a_load_is_interpolated_linearly() {
        let load = |x: f64| Load {
            muscles: vec![x, 2.0 * x],
            shifts: vec![11.0 * x, 12.0 * x],
            ends: [3.0, 4.0].map(|s| EndMotion {
                displacement: s * x,
                twist: 10.0 * s * x,
                shift: [20.0, 30.0].map(|t| t * s * x),
                tilt: [40.0, 50.0].map(|t| t * s * x),
            }),
            pressures: [5.0, 6.0].map(|s| Pressure {
                follower: s * x,
                dead: 10.0 * s * x,
            }),
            lumen_volume: Some(11.0 * x),
            obstacles: vec![Placement {
                radius: 7.0 * x,
                position: [8.0, 9.0, 10.0].map(|s| s * x),
            }],
            patches: vec![11.0 * x],
        };
        assert_eq!(load(1.0).towards(&load(3.0), 0.25), load(1.5));
        assert_eq!(load(0.1).towards(&load(0.3), 0.0), load(0.1));
        assert_eq!(load(0.1).towards(&load(0.3), 1.0), load(0.3));
    }
}
