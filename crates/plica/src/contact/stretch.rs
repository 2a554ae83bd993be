//! Stretch and turning of a face: signs that it creases, and that the mesh resolves the crease.

/// Surface stretch s = λ₁² λ₂ below which a crease of a flat neo-Hookean surface has less energy than the flat surface
/// (Hong, Zhao and Suo 2009: in plane strain from the stretch 0.646 down, 0.646² = 0.417).
pub const CREASE: f64 = 0.417;

/// Surface stretch below which a flat incompressible neo-Hookean surface is unstable: x³ + x² + 3x − 1 = 0 (Biot 1963).
pub const BIOT: f64 = 0.295_597_742_522_084_8;

/// Points of an element at which a face is looked at, its ends included.
pub(super) const POINTS: usize = 9;

/// Stretch and turning of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceSurface {
    /// Smallest s = λ₁² λ₂ of the elastic stretches along and around the face, λ₁ the smaller one.
    pub stretch: f64,
    /// Axial position at rest of the smallest s, in D.
    pub stretch_at: f64,
    /// Largest angle by which the face turns along one element, in radians. A wall that bends with a radius ρ turns by
    /// h/ρ along an element of deformed length h, whatever its size: splines of any degree lose the shape of a crease
    /// where that is no longer small.
    pub turn: f64,
    /// Axial position at rest of the middle of that element, in D.
    pub turn_at: f64,
}

impl FaceSurface {
    /// A face of which no point was looked at yet.
    pub(super) const FLAT: Self = Self {
        stretch: f64::INFINITY,
        stretch_at: 0.0,
        turn: 0.0,
        turn_at: 0.0,
    };
}

/// Returns the elements that may hold the lowest value along a curve, from the values in their middles: that with the
/// lowest, and all whose value less twice the difference from a neighbour is lower.
pub(super) fn may_be_lowest(middles: &[f64]) -> Vec<usize> {
    let lowest = middles.iter().copied().fold(f64::INFINITY, f64::min);
    let difference = |e: usize, other: Option<&f64>| other.map_or(0.0, |x| (x - middles[e]).abs());
    let may = |e: &usize| {
        let before = e.checked_sub(1).and_then(|i| middles.get(i));
        let most = difference(*e, before).max(difference(*e, middles.get(e + 1)));
        middles[*e] == lowest || middles[*e] - 2.0 * most < lowest - 1e-9
    };
    (0..middles.len()).filter(may).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_of_biot_is_the_root_of_his_cubic() {
        assert!((((BIOT + 1.0) * BIOT + 3.0) * BIOT - 1.0).abs() < 1e-15);
    }

    #[test]
    fn elements_near_the_lowest_and_steep_ones_may_hold_the_lowest_value() {
        assert_eq!(may_be_lowest(&[1.0; 5]), [0, 1, 2, 3, 4]);
        assert_eq!(
            may_be_lowest(&[1.0, 1.0, 0.5, 0.6, 0.9, 0.91, 1.0]),
            [1, 2, 3, 4]
        );
    }
}
