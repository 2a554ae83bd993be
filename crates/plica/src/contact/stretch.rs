//! Stretch and turning of a face: signs that it creases, and that the mesh resolves the crease.

/// Surface stretch s = λ₁² λ₂ below which a crease of a flat neo-Hookean surface has less energy than the flat surface
/// (Hong, Zhao and Suo 2009: in plane strain from the stretch 0.646 down, 0.646² = 0.417).
pub const CREASE: f64 = 0.417;

/// Surface stretch below which a flat incompressible neo-Hookean surface is unstable: x³ + x² + 3x − 1 = 0 (Biot 1963).
pub const BIOT: f64 = 0.295_597_742_522_084_8;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_of_biot_is_the_root_of_his_cubic() {
        assert!((((BIOT + 1.0) * BIOT + 3.0) * BIOT - 1.0).abs() < 1e-15);
    }
}
