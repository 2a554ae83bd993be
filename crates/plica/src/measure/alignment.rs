//! Alignment of two walls by an axial shift.

use super::Wall;

/// Best alignment of one wall with another that is shifted along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// Axial shift of the other wall, in D.
    pub shift: f64,
    /// Hausdorff distance of the two walls after the shift, in D.
    pub distance: f64,
}

/// Resolution of a shift, in D.
const RESOLUTION: f64 = 1e-5;

impl Wall {
    /// Returns the mirror image about the plane z = 0, with its points ordered by rising reference position.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            angle: self.angle,
            reference_z: self.reference_z.iter().rev().map(|z| -z).collect(),
            points: self.points.iter().rev().map(|&(z, r)| (-z, r)).collect(),
        }
    }

    /// Returns the part between two axial reference positions.
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

    /// Returns the largest distance of a point of this wall from `other` shifted by `shift` along the axis: one of
    /// the two directed Hausdorff distances.
    fn directed_distance(&self, other: &Self, shift: f64) -> f64 {
        let nearest = |&(z, r): &(f64, f64)| {
            let pieces = other.points.windows(2);
            let near = pieces.map(|p| distance_to_segment((z - shift, r), p[0], p[1]));
            near.fold(f64::INFINITY, f64::min)
        };
        self.points.iter().map(nearest).fold(0.0, f64::max)
    }

    /// Finds the axial shift of `other`, of at most `reach`, that minimises its Hausdorff distance from this wall.
    pub fn align(&self, other: &Self, reach: f64) -> Alignment {
        let distance = |shift: f64| {
            let forth = self.directed_distance(other, shift);
            forth.max(other.directed_distance(self, -shift))
        };
        // A coarse search of the whole range, then bisection of the step around the best shift.
        let (mut best, mut step) = ((0.0, distance(0.0)), 0.1 * reach);
        let mut try_shift = |shift: f64| {
            let here = distance(shift);
            if here < best.1 {
                best = (shift, here);
            }
            best
        };
        let mut at = 0.0;
        for i in -10..=10 {
            at = try_shift(f64::from(i) * step).0;
        }
        while step > RESOLUTION {
            step *= 0.5;
            let (low, high) = ((at - step).max(-reach), (at + step).min(reach));
            try_shift(low);
            at = try_shift(high).0;
        }
        let (shift, distance) = try_shift(at);
        Alignment { shift, distance }
    }
}

/// Returns the distance of a point from the straight segment between `a` and `b`.
fn distance_to_segment((z, r): (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
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
    fn a_shifted_wall_is_aligned_with_itself() {
        let (a, b) = (notch(1.5, 0.3).between(1.0, 2.0), notch(1.38, 0.3));
        let alignment = a.align(&b.between(0.88, 1.88), 0.3);
        assert!((alignment.shift - 0.12).abs() < 1e-3, "{alignment:?}");
        assert!(alignment.distance < 1e-3);
    }

    #[test]
    fn the_distance_of_aligned_notches_is_their_difference_in_depth() {
        let (a, b) = (notch(1.5, 0.3), notch(1.5, 0.26));
        let alignment = a.align(&b, 0.1);
        assert!((alignment.distance - 0.04).abs() < 1e-3, "{alignment:?}");
    }

    #[test]
    fn mirroring_twice_is_the_identity() {
        let wall = notch(1.2, 0.3);
        assert_eq!(wall.mirrored().mirrored(), wall);
        let cut = notch(1.5, 0.3).between(1.0, 2.0);
        let alignment = cut.align(&wall.mirrored().between(-1.7, -0.7), 3.0);
        assert!((alignment.shift - 2.7).abs() < 1e-3, "{alignment:?}");
    }
}
