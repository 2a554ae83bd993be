//! Sectors of the circumference with smooth edges.

use std::f64::consts::{PI, TAU};

/// A sector of the circumference, repeated at equal angles around the tube. Its function of the angle is 1 inside, falls
/// like half a cosine at both edges, and is 0 outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngularSector {
    /// Angle of its middle, in radians.
    pub centre: f64,
    /// Its width with both edges, in radians; times `repeats` at most a full turn.
    pub width: f64,
    /// Width of an edge, in radians; above zero and at most half the width.
    pub edge: f64,
    /// Number of equal sectors around the tube, at least one.
    pub repeats: usize,
}

impl AngularSector {
    /// Returns its function at the angle `phi`, in radians: from 0 to 1.
    pub fn value(&self, phi: f64) -> f64 {
        let period = TAU / self.repeats as f64;
        let from_centre = (phi - self.centre + 0.5 * period).rem_euclid(period) - 0.5 * period;
        smooth_rise((0.5 * self.width - from_centre.abs()) / self.edge)
    }
}

/// Returns ½ (1 − cos πx) for x from 0 to 1; 0 below and 1 above.
pub fn smooth_rise(x: f64) -> f64 {
    if x >= 1.0 {
        1.0
    } else {
        0.5 * (1.0 - (PI * x.max(0.0)).cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sector_is_one_inside_and_falls_at_its_edges() {
        let degrees = |x: f64| x.to_radians();
        let once = AngularSector {
            centre: degrees(350.0),
            width: degrees(100.0),
            edge: degrees(20.0),
            repeats: 1,
        };
        let thrice = AngularSector { repeats: 3, ..once };
        for (at, expected) in [
            (350.0, 1.0),
            (-10.0, 1.0),
            (19.0, 1.0),
            (320.5, 1.0),
            (30.0, 0.5),
            (310.0, 0.5),
            (25.0, 0.5 + 0.5 * 0.5_f64.sqrt()),
            (41.0, 0.0),
            (170.0, 0.0),
        ] {
            for turn in [-360.0, 0.0, 720.0] {
                let found = once.value(degrees(at + turn));
                assert!((found - expected).abs() < 1e-12, "{at}: {found}");
            }
            if at < 45.0 {
                let found = thrice.value(degrees(at + 120.0));
                assert!((found - expected).abs() < 1e-12, "{at}: {found}");
            }
        }
    }

    #[test]
    fn the_mean_of_a_sector_is_its_share_of_the_circumference() {
        let sector = AngularSector {
            centre: 0.3,
            width: 1.1,
            edge: 0.4,
            repeats: 2,
        };
        let angles = (0..3600).map(|i| TAU * f64::from(i) / 3600.0);
        let mean = angles.map(|phi| sector.value(phi)).sum::<f64>() / 3600.0;
        assert!((mean - 2.0 * (1.1 - 0.4) / TAU).abs() < 1e-5, "{mean}");
    }
}
