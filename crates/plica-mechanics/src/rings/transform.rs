//! Discrete Fourier transform over the rings of a sector.
//!
//! A vector of k rings is a matrix of k columns with one row for every unknown of a ring. Its
//! coefficients on 1, cos φ, sin φ, cos 2φ, … are the product of that matrix with a k × k matrix.
//! For the tens of rings of a tube the dense product takes no longer than a fast transform of so
//! many short rows (2.6e7 multiply-adds at paper scale, 2 ms), stores the columns of a harmonic
//! side by side, and sums in a fixed order.

use crate::matrix::multiply;
use std::f64::consts::TAU;

/// Discrete Fourier transform over k rings.
#[derive(Clone, Debug)]
pub struct Transform {
    rings: usize,
    /// The values of 1, cos φ, sin φ, … at each ring, wave by wave.
    waves: Vec<f64>,
    /// Inverse sums of the squares of the waves.
    scale: Vec<f64>,
}

/// Columns of the coefficients of one circumferential harmonic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HarmonicColumns {
    /// Harmonic of the sector: periods over the k rings.
    pub harmonic: usize,
    /// Column of the cosine.
    pub cosine: usize,
    /// Column of the sine; none for harmonics 0 and k/2.
    pub sine: Option<usize>,
}

impl Transform {
    /// Returns the transform over `rings` rings.
    pub fn new(rings: usize) -> Self {
        let waves = (0..rings)
            .flat_map(|column| {
                let n = column.div_ceil(2);
                (0..rings).map(move |j| {
                    // n j modulo k, so that every wave is exact.
                    let phi = TAU * ((n * j) % rings) as f64 / rings as f64;
                    if column % 2 == 1 || column == 0 {
                        phi.cos()
                    } else {
                        phi.sin()
                    }
                })
            })
            .collect();
        let alone = |column: usize| column == 0 || (column == rings - 1 && rings.is_multiple_of(2));
        let scale = (0..rings)
            .map(|column| if alone(column) { 1.0 } else { 2.0 } / rings as f64)
            .collect();
        Self {
            rings,
            waves,
            scale,
        }
    }

    /// Returns k.
    pub fn rings(&self) -> usize {
        self.rings
    }

    /// Returns the columns of the harmonics, 0 to k/2.
    pub fn harmonics(&self) -> impl Iterator<Item = HarmonicColumns> + use<> {
        let rings = self.rings;
        (0..=rings / 2).map(move |harmonic| HarmonicColumns {
            harmonic,
            cosine: if harmonic == 0 { 0 } else { 2 * harmonic - 1 },
            sine: (harmonic > 0 && 2 * harmonic < rings).then_some(2 * harmonic),
        })
    }

    /// Returns the sums over the rings of u times each wave: one column of unknowns of a ring per
    /// wave.
    pub fn forward(&self, u: &[f64]) -> Vec<f64> {
        let (k, lines) = (self.rings, u.len() / self.rings);
        let mut out = vec![0.0; u.len()];
        multiply(
            (u, [lines, k], [k, 1]),
            (&self.waves, [k, k], [1, k]),
            (&mut out, [1, lines]),
        );
        out
    }

    /// Returns the contribution of every harmonic, 0 to k/2, to u · v.
    pub fn dot_by_harmonic(&self, u: &[f64], v: &[f64]) -> Vec<f64> {
        let lines = u.len() / self.rings;
        let (u, v) = (self.forward(u), self.forward(v));
        let columns = u.chunks_exact(lines).zip(v.chunks_exact(lines));
        let product = |(u, v): (&[f64], &[f64])| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
        let products: Vec<f64> = columns
            .map(product)
            .zip(&self.scale)
            .map(|(product, scale)| product * scale)
            .collect();
        let of_wave =
            |wave: HarmonicColumns| products[wave.cosine] + wave.sine.map_or(0.0, |s| products[s]);
        self.harmonics().map(of_wave).collect()
    }

    /// Returns the displacements from coefficients: the inverse of [`Transform::forward`].
    pub fn inverse(&self, coefficients: &[f64]) -> Vec<f64> {
        let (k, lines) = (self.rings, coefficients.len() / self.rings);
        let scaled: Vec<f64> = (0..k * k)
            .map(|at| self.scale[at / k] * self.waves[at])
            .collect();
        let mut out = vec![0.0; coefficients.len()];
        multiply(
            (coefficients, [lines, k], [1, lines]),
            (&scaled, [k, k], [k, 1]),
            (&mut out, [k, 1]),
        );
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_inverts_forward() {
        for rings in [1, 2, 3, 4, 7, 12, 60] {
            let transform = Transform::new(rings);
            let u: Vec<f64> = (0..5 * rings).map(|i| (i as f64 * 0.37).sin()).collect();
            let back = transform.inverse(&transform.forward(&u));
            for (a, b) in back.iter().zip(&u) {
                assert!((a - b).abs() < 1e-14, "{rings} rings: {a} {b}");
            }
        }
    }

    #[test]
    fn dot_products_by_harmonic_add_up() {
        for rings in [1, 2, 5, 12] {
            let transform = Transform::new(rings);
            let u: Vec<f64> = (0..4 * rings).map(|i| (i as f64 * 0.37).sin()).collect();
            let v: Vec<f64> = (0..4 * rings).map(|i| (i as f64 * 0.81).cos()).collect();
            let whole: f64 = u.iter().zip(&v).map(|(u, v)| u * v).sum();
            let parts = transform.dot_by_harmonic(&u, &v);
            assert_eq!(parts.len(), rings / 2 + 1);
            assert!((parts.iter().sum::<f64>() - whole).abs() < 1e-14);
        }
        // A wave contributes to its own harmonic only.
        let wave = |phase: f64| -> Vec<f64> {
            let angle = |j: usize| TAU * (3 * j) as f64 / 12.0 + phase;
            (0..12).map(|j| angle(j).cos()).collect()
        };
        for (n, part) in (0..).zip(Transform::new(12).dot_by_harmonic(&wave(0.3), &wave(0.7))) {
            let expected = if n == 3 { 6.0 * 0.4_f64.cos() } else { 0.0 };
            assert!((part - expected).abs() < 1e-13, "{n}: {part}");
        }
    }

    #[test]
    fn wave_has_coefficients_in_its_column_only() {
        let (rings, n) = (12, 3);
        let transform = Transform::new(rings);
        let u: Vec<f64> = (0..rings)
            .map(|j| (TAU * (n * j) as f64 / rings as f64).sin())
            .collect();
        let wave = transform.harmonics().nth(n).unwrap();
        let found = transform.forward(&u);
        for (column, x) in found.iter().enumerate() {
            let expected = if Some(column) == wave.sine { 6.0 } else { 0.0 };
            assert!((x - expected).abs() < 1e-14, "column {column}: {x}");
        }
    }
}
