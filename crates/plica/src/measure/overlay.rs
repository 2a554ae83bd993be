//! Two walls laid over each other.

use super::Wall;

/// How well one wall lies over another that was shifted along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlay {
    /// The shift, in D, with which they lie closest.
    pub shift: f64,
    /// The largest distance of a point of one of them from the other, then.
    pub apart: f64,
}

/// A shift is found to this, in D.
const FINE: f64 = 1e-5;

impl Wall {
    /// Its mirror image about the plane z = 0, colon to ileum again.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            angle: self.angle,
            reference_z: self.reference_z.iter().rev().map(|z| -z).collect(),
            points: self.points.iter().rev().map(|&(z, r)| (-z, r)).collect(),
        }
    }

    /// The part whose reference position lies between two.
    #[must_use]
    pub fn between(&self, from: f64, to: f64) -> Self {
        let inside = |z: &f64| (from..=to).contains(z);
        let kept = self.reference_z.iter().zip(&self.points);
        let (reference_z, points) = kept.filter(|(z, _)| inside(z)).unzip();
        Self {
            angle: self.angle,
            reference_z,
            points,
        }
    }

    /// The largest distance of a point of this wall from another wall that is shifted along the axis (one of
    /// the two distances of Hausdorff).
    pub fn distance_from(&self, other: &Self, shift: f64) -> f64 {
        let nearest = |&(z, r): &(f64, f64)| {
            let pieces = other.points.windows(2);
            let near = pieces.map(|p| from_piece((z - shift, r), p[0], p[1]));
            near.fold(f64::INFINITY, f64::min)
        };
        self.points.iter().map(nearest).fold(0.0, f64::max)
    }

    /// Shifts another wall along the axis, by up to `reach`, to where it lies closest over this one.
    pub fn overlay(&self, other: &Self, reach: f64) -> Overlay {
        let apart = |shift: f64| {
            let there = self.distance_from(other, shift);
            there.max(other.distance_from(self, -shift))
        };
        // A coarse look, then the best place's neighbourhood finer and finer.
        let (mut best, mut step) = ((0.0, apart(0.0)), 0.1 * reach);
        let mut look = |shift: f64| {
            let there = apart(shift);
            if there < best.1 {
                best = (shift, there);
            }
            best
        };
        let mut at = 0.0;
        for i in -10..=10 {
            at = look(f64::from(i) * step).0;
        }
        while step > FINE {
            step *= 0.5;
            let (low, high) = ((at - step).max(-reach), (at + step).min(reach));
            look(low);
            at = look(high).0;
        }
        let (shift, apart) = look(at);
        Overlay { shift, apart }
    }
}

/// The distance of a place from a straight piece.
fn from_piece((z, r): (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dz, dr) = (b.0 - a.0, b.1 - a.1);
    let length = dz * dz + dr * dr;
    let t = if length > 0.0 {
        (((z - a.0) * dz + (r - a.1) * dr) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (z - a.0 - t * dz).hypot(r - a.1 - t * dr)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn notch(at: f64, depth: f64) -> Wall {
        let z: Vec<f64> = (0..=300).map(|i| f64::from(i) / 100.0).collect();
        let r = |z: f64| 0.5 - depth * (-((z - at) / 0.2_f64).powi(2)).exp();
        Wall {
            angle: 0.0,
            points: z.iter().map(|&z| (z, r(z))).collect(),
            reference_z: z,
        }
    }

    #[test]
    fn a_wall_that_was_shifted_lies_over_itself() {
        let (a, b) = (notch(1.5, 0.3).between(1.0, 2.0), notch(1.38, 0.3));
        let overlay = a.overlay(&b.between(0.88, 1.88), 0.3);
        assert!((overlay.shift - 0.12).abs() < 1e-3, "{overlay:?}");
        assert!(overlay.apart < 1e-3);
    }

    #[test]
    fn what_is_deeper_stays_apart_by_that() {
        let (a, b) = (notch(1.5, 0.3), notch(1.5, 0.26));
        let overlay = a.overlay(&b, 0.1);
        assert!((overlay.apart - 0.04).abs() < 1e-3, "{overlay:?}");
    }

    #[test]
    fn a_mirrored_wall_is_mirrored_back() {
        let wall = notch(1.2, 0.3);
        assert_eq!(wall.mirrored().mirrored(), wall);
        let cut = notch(1.5, 0.3).between(1.0, 2.0);
        let overlay = cut.overlay(&wall.mirrored().between(-1.7, -0.7), 3.0);
        assert!((overlay.shift - 2.7).abs() < 1e-3, "{overlay:?}");
    }
}
