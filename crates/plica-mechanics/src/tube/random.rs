//! Smooth random shapes from a seed. A seed gives the same shape on every machine and in every
//! version of the program.
//!
//! For n = 0 … N around and k = 1 … K along, the shape is a sum of waves
//!
//! c_nk sin kπx cos n(φ − φ_nk),
//!
//! x from 0 to 1 over a span of the tube (for an end, without the factor along it). The coefficients
//! of cosine and sine are normally distributed with one variance: c² is exponential and nφ uniform
//! (Box and Muller 1958). The sum is scaled to a maximum of 1 on a grid of 32 points per shortest
//! wave around and along; between the points it may exceed 1 by half a percent.

use super::{Axial, Wave};
use std::f64::consts::{PI, TAU};

/// A random shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    seed: u64,
    waves: Vec<Wave>,
}

impl Random {
    /// Creates a sum of circumferential modes 0 to `harmonics` with 1 to `half_waves` half-waves along
    /// the tube (0: uniform along it), restricted to multiples of `fold`.
    pub fn new(seed: u64, harmonics: usize, half_waves: usize, fold: usize) -> Self {
        let mut numbers = Numbers::of(seed);
        let mut waves = vec![];
        for n in 0..=harmonics {
            for k in half_waves.min(1)..=half_waves {
                // Drawn for every wave, so that the others do not depend on `fold`.
                let (size, angle) = numbers.normal_pair();
                let (phase, share) = match n {
                    0 => (0.0, size * angle.cos()),
                    n => (angle / n as f64, size),
                };
                let axial = match k {
                    0 => Axial::Uniform,
                    k => Axial::HalfWaves(k),
                };
                if n.is_multiple_of(fold) {
                    let wave = Wave::new(n, phase, axial);
                    waves.push(Wave { share, ..wave });
                }
            }
        }
        let largest = largest(&waves, harmonics, half_waves);
        for wave in &mut waves {
            wave.share /= largest;
        }
        Self { seed, waves }
    }

    /// Returns the seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Returns the waves.
    pub fn waves(&self) -> &[Wave] {
        &self.waves
    }
}

/// Returns the largest |f| on the grid.
fn largest(waves: &[Wave], harmonics: usize, half_waves: usize) -> f64 {
    let (around, along) = (32 * harmonics.max(1), 16 * half_waves);
    let angles: Vec<(f64, f64)> = (0..around)
        .map(|i| (TAU * i as f64 / around as f64).sin_cos())
        .collect();
    let mut largest = 0.0_f64;
    for i in 0..=along {
        let x = i as f64 / along.max(1) as f64;
        // Coefficients of the cosine and the sine of each mode.
        let mut sums = vec![(0.0, 0.0); harmonics + 1];
        for wave in waves {
            let (sin, cos) = (wave.harmonic as f64 * wave.phase).sin_cos();
            let size = wave.share * wave.axial.value(x, [0.0, 1.0]);
            sums[wave.harmonic].0 += size * cos;
            sums[wave.harmonic].1 += size * sin;
        }
        for j in 0..around {
            let terms = sums.iter().enumerate().map(|(n, (a, b))| {
                let (sin, cos) = angles[n * j % around];
                a * cos + b * sin
            });
            largest = largest.max(terms.sum::<f64>().abs());
        }
    }
    largest
}

/// Random numbers from the extended output of BLAKE3, whose specification is fixed.
struct Numbers(blake3::OutputReader);

impl Numbers {
    fn of(seed: u64) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(b"plica random imperfection");
        hasher.update(&seed.to_le_bytes());
        Self(hasher.finalize_xof())
    }

    /// Returns a number uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        let mut bytes = [0; 8];
        self.0.fill(&mut bytes);
        (u64::from_le_bytes(bytes) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns radius and angle of a point with two normal coordinates of variance one.
    fn normal_pair(&mut self) -> (f64, f64) {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        (radius, 2.0 * PI * self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tube::Shape;

    fn shape(seed: u64, fold: usize) -> Shape {
        Shape::Random(Random::new(seed, 4, 3, fold))
    }

    /// Returns some values of a shape over a tube of length 3.
    fn values(shape: &Shape) -> [f64; 4] {
        let at = [(0.0, 0.5), (1.0, 1.0), (3.0, 1.7), (5.0, 2.6)];
        at.map(|(phi, z)| shape.value(phi, z, [0.0, 3.0]))
    }

    #[test]
    fn the_shape_of_a_seed_does_not_change() {
        let seven = [
            0.333142857804912,
            0.066832243547265,
            -0.629501754409571,
            0.408537538873979,
        ];
        for (value, golden) in values(&shape(7, 1)).into_iter().zip(seven) {
            assert!((value - golden).abs() < 1e-12, "{:?}", values(&shape(7, 1)));
        }
        assert_eq!(shape(7, 1), shape(7, 1));
    }

    #[test]
    fn different_seeds_give_different_shapes() {
        for seed in 0..20 {
            let (one, other) = (values(&shape(seed, 1)), values(&shape(seed + 1, 1)));
            let difference = one.iter().zip(other).map(|(a, b)| (a - b).abs());
            assert!(difference.sum::<f64>() > 0.05, "{seed}");
        }
    }

    #[test]
    fn the_maximum_of_a_random_shape_is_nearly_one() {
        for seed in 0..10 {
            let shape = shape(seed, 1);
            let mut largest = 0.0_f64;
            for i in 0..=300 {
                for j in 0..200 {
                    let (z, phi) = (0.01 * f64::from(i), TAU * f64::from(j) / 200.0);
                    largest = largest.max(shape.value(phi, z, [0.0, 3.0]).abs());
                }
            }
            assert!((0.99..1.005).contains(&largest), "{seed}: {largest}");
        }
    }

    #[test]
    fn a_random_shape_of_an_end_is_uniform_along_the_tube() {
        for (harmonics, fold) in [(0, 1), (1, 1), (4, 1), (4, 2), (6, 3)] {
            let random = Random::new(3, harmonics, 0, fold);
            let expected: Vec<usize> = (0..=harmonics).step_by(fold).collect();
            let modes: Vec<usize> = random.waves().iter().map(|w| w.harmonic).collect();
            assert_eq!(modes, expected);
            assert!(random.waves().iter().all(|w| w.axial == Axial::Uniform));
            let shape = Shape::Random(random);
            let mut largest = 0.0_f64;
            for j in 0..2000 {
                let value = shape.value(TAU * f64::from(j) / 2000.0, 0.0, [0.0, 3.0]);
                assert!(value.is_finite());
                largest = largest.max(value.abs());
            }
            assert!((0.99..1.005).contains(&largest), "{harmonics}: {largest}");
        }
    }

    #[test]
    fn every_wave_has_its_mode_and_its_half_waves_once() {
        let random = Random::new(3, 2, 3, 1);
        let numbers: Vec<(usize, Axial)> = random
            .waves()
            .iter()
            .map(|w| (w.harmonic, w.axial))
            .collect();
        let expected = (0..=2).flat_map(|n| (1..=3).map(move |k| (n, Axial::HalfWaves(k))));
        assert_eq!(numbers, expected.collect::<Vec<_>>());
    }

    #[test]
    fn a_fold_selects_its_multiples_and_leaves_them_unchanged() {
        let Shape::Random(whole) = shape(7, 1) else {
            unreachable!()
        };
        let Shape::Random(half) = shape(7, 2) else {
            unreachable!()
        };
        let kept = whole.waves().iter().filter(|w| w.harmonic % 2 == 0);
        assert_eq!(half.waves().len(), 9);
        for (a, b) in kept.zip(half.waves()) {
            assert_eq!(
                (a.harmonic, a.phase, a.axial),
                (b.harmonic, b.phase, b.axial)
            );
        }
    }

    #[test]
    fn coefficients_are_normally_distributed() {
        let mut numbers = Numbers::of(1);
        let pairs: Vec<(f64, f64)> = (0..4000).map(|_| numbers.normal_pair()).collect();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let sum: f64 = pairs.iter().map(|(r, a)| of(r * a.cos())).sum();
            sum / pairs.len() as f64
        };
        // Moments of the normal distribution: 0, 1, 3.
        assert!(mean(&|x| x).abs() < 0.05);
        assert!((mean(&|x| x * x) - 1.0).abs() < 0.08);
        assert!((mean(&|x| x.powi(4)) - 3.0).abs() < 0.5);
    }
}
