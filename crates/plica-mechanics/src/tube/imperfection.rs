//! Imperfections: small deviations from the perfect tube, which select the branch at a bifurcation
//! of the perfect tube.
//!
//! An imperfection is a shape f(φ, z), between −1 and 1, times an amplitude. A shape is a sum of
//! waves around the tube, each with a factor along it:
//!
//! f(φ, z) = Σ c g(z) cos n(φ − φ₀)
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | n | circumferential mode | [`Wave::harmonic`] |
//! | φ₀ | angle of a crest | [`Wave::phase`] |
//! | c | share of the wave in the shape | [`Wave::share`] |
//! | g | factor along the tube | [`Axial::value`] |
//!
//! An imperfect geometry may also have the shape of a [`Mode`], for example a buckling mode. A diameter or a thickness that
//! varies along the tube, an [`Outline`], displaces the stress-free shape likewise, though not by a small amount.

use super::{End, Mesh, Outline, Random};
use std::f64::consts::{PI, TAU};

/// One imperfection of a tube.
#[derive(Clone, Debug, PartialEq)]
pub struct Imperfection {
    /// Imperfect part of the tube.
    pub of: Part,
    /// Amplitude: of an end or the geometry a displacement in D, of a muscle a fraction of its
    /// activity.
    pub amplitude: f64,
    /// Shape.
    pub shape: Shape,
}

/// An imperfect part of a tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Constant displacement of an end that is held there along the whole path.
    End(End, EndDirection),
    /// Stress-free shape of the wall.
    Geometry,
    /// Strength of the muscle with this index: θ − 1 becomes (θ − 1)(1 + a f).
    Muscle(usize),
}

/// Direction in which an end face is displaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndDirection {
    /// In its plane, normal to the wall, and around it so that rings keep their length. Mode 1
    /// shifts the face sideways, mode 2 makes it oval.
    Across,
    /// Along the axis. Mode 1 tilts the face.
    Axial,
}

/// A shape f(φ, z), between −1 and 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One wave around the tube.
    Wave(Wave),
    /// A random sum of waves.
    Random(Random),
    /// A displacement of the control points, for the geometry only.
    Mode(Mode),
    /// Diameter and thickness along the tube, with the amplitude 1, for the geometry only.
    Outline(Outline),
}

/// A displacement (z cos nφ, r cos nφ, −θ sin nφ) of control points. An imperfect geometry scales it
/// so that the amplitude is its maximum.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// n.
    pub harmonic: usize,
    /// The mesh whose control points are displaced.
    pub mesh: Mesh,
    /// (z, r, θ) of every control point of one ring: row by row along the tube, and in a row point
    /// by point through the wall; not all zero. For n = 0 the displacement.
    pub values: Vec<f64>,
}

/// One wave around the tube, c g(z) cos n(φ − φ₀).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// n; 0 is axisymmetric.
    pub harmonic: usize,
    /// φ₀, the angle of a crest, in radians.
    pub phase: f64,
    /// g, the factor along the tube.
    pub axial: Axial,
    /// c; 1 for a shape of one wave.
    pub share: f64,
}

/// A factor along a span of the tube: the whole tube, or the zone of a muscle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axial {
    /// One.
    Uniform,
    /// sin kπx, x from 0 to 1 over the span.
    HalfWaves(usize),
    /// ½ (1 − cos 2πx), x from 0 to 1 over a zone in D; zero elsewhere.
    Zone([f64; 2]),
}

impl Shape {
    /// Returns the waves of a sum; none for a mode or an outline.
    pub fn waves(&self) -> &[Wave] {
        match self {
            Self::Wave(wave) => std::slice::from_ref(wave),
            Self::Random(random) => random.waves(),
            Self::Mode(_) | Self::Outline(_) => &[],
        }
    }

    /// Returns f(φ, z) of a sum of waves, φ in radians, for a span of the tube in D.
    pub fn value(&self, phi: f64, z: f64, span: [f64; 2]) -> f64 {
        let waves = self.waves().iter();
        waves.map(|wave| wave.value(phi, z, span)).sum()
    }
}

impl Wave {
    /// Creates a wave with c = 1.
    pub fn new(harmonic: usize, phase: f64, axial: Axial) -> Self {
        Self {
            harmonic,
            phase,
            axial,
            share: 1.0,
        }
    }

    /// Returns c g(z) cos n(φ − φ₀).
    pub fn value(&self, phi: f64, z: f64, span: [f64; 2]) -> f64 {
        let around = (self.harmonic as f64 * (phi - self.phase)).cos();
        self.share * self.axial.value(z, span) * around
    }
}

impl Axial {
    /// Returns g(z) for a span in D.
    pub fn value(&self, z: f64, span: [f64; 2]) -> f64 {
        let fraction = |[a, b]: [f64; 2]| (z - a) / (b - a);
        match *self {
            Self::Uniform => 1.0,
            Self::HalfWaves(k) => {
                let x = fraction(span).clamp(0.0, 1.0);
                // Exactly zero at both ends.
                if x == 1.0 {
                    0.0
                } else {
                    (k as f64 * PI * x).sin()
                }
            }
            Self::Zone(zone) => {
                let x = fraction(zone).clamp(0.0, 1.0);
                0.5 * (1.0 - (TAU * x).cos())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_maximum_of_a_wave_is_one_at_its_crest() {
        let span = [0.0, 3.0];
        for axial in [
            Axial::Uniform,
            Axial::HalfWaves(1),
            Axial::HalfWaves(5),
            Axial::Zone([0.5, 1.0]),
        ] {
            for harmonic in [0, 1, 2, 5] {
                let shape = Shape::Wave(Wave::new(harmonic, 0.7, axial));
                let mut largest = 0.0_f64;
                for i in 0..=600 {
                    for j in 0..40 {
                        let phi = 0.7 + TAU * f64::from(j) / 40.0;
                        let f = shape.value(phi, 3.0 * f64::from(i) / 600.0, span);
                        assert!(f.abs() <= 1.0);
                        largest = largest.max(f);
                    }
                }
                assert!((largest - 1.0).abs() < 1e-14, "{shape:?}: {largest}");
            }
        }
    }

    #[test]
    fn factors_along_the_tube_are_zero_at_both_ends() {
        let span = [0.3, 2.9];
        for axial in [Axial::HalfWaves(1), Axial::HalfWaves(4), Axial::Zone(span)] {
            for z in [0.0, 0.3, 2.9, 3.0] {
                assert_eq!(axial.value(z, span), 0.0, "{axial:?} at {z}");
            }
        }
    }
}
