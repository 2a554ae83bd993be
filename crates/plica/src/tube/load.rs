//! What a tube is under: the target of every muscle, the motion of both ends, the pressure on both
//! walls.

/// A load. Stages lead from one to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Target of each muscle of the tube, in its order: Dmin/D or Lmax/L.
    pub muscles: Vec<f64>,
    /// Motion of the colon end and the ileum end.
    pub ends: [EndMotion; 2],
    /// Pressure on the inner wall, which pushes outwards, and on the outer wall, which pushes
    /// inwards.
    pub pressures: [Pressure; 2],
}

/// How far a held end has been moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndMotion {
    /// Along z, in D.
    pub displacement: f64,
    /// About z, in radians; fixed ends only.
    pub twist: f64,
}

/// What presses on a wall, in E.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pressure {
    /// True pressure: per area as it is, normal to the wall as it is.
    pub follower: f64,
    /// Dead load: per area at rest, normal to the wall at rest.
    pub dead: f64,
}

impl Load {
    /// The load a fraction `t` of the way from this one to another.
    pub fn towards(&self, other: &Self, t: f64) -> Self {
        // At t = 1 exactly the other, whatever the rounding.
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
