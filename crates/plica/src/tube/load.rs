//! Loads of a tube: targets of the muscles, displacements of the ends, pressures on the walls.

/// A load of a tube.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Target of each muscle of the tube, in the order of the tube: Dmin/D or Lmax/L.
    pub muscles: Vec<f64>,
    /// Motion of the colon end and the ileum end.
    pub ends: [EndMotion; 2],
    /// Pressure on the inner wall, acting outwards, and on the outer wall, acting inwards.
    pub pressures: [Pressure; 2],
}

/// Prescribed motion of a supported end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndMotion {
    /// Along z, in D.
    pub displacement: f64,
    /// About z, in radians; fixed ends only.
    pub twist: f64,
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
    /// Interpolates linearly to another load, which has t = 1.
    pub fn towards(&self, other: &Self, t: f64) -> Self {
        // At t = 1 the other load to the bit.
        let mix = |a: f64, b: f64| if t == 1.0 { b } else { a + t * (b - a) };
        let end = |i: usize| EndMotion {
            displacement: mix(self.ends[i].displacement, other.ends[i].displacement),
            twist: mix(self.ends[i].twist, other.ends[i].twist),
        };
        let pressure = |i: usize| Pressure {
            follower: mix(self.pressures[i].follower, other.pressures[i].follower),
            dead: mix(self.pressures[i].dead, other.pressures[i].dead),
        };
        Self {
            muscles: self
                .muscles
                .iter()
                .zip(&other.muscles)
                .map(|(&a, &b)| mix(a, b))
                .collect(),
            ends: [end(0), end(1)],
            pressures: [pressure(0), pressure(1)],
        }
    }
}
