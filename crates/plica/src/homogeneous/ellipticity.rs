//! Strong ellipticity: every plane wave of small amplitude has a positive stiffness.
//!
//! Displacements m along a wave direction n have the stiffness m ⊗ n : A : m ⊗ n. For each n the least over m is the
//! smallest eigenvalue of the acoustic tensor Q_ij = A_ijkl n_j n_l. Directions n are sampled.

use super::{MechanicalTest, Volume, homogeneous};
use crate::material::{Law, Material};
use crate::tensor::Tensor2;
use std::f64::consts::PI;

/// Steps of the polar angle of n from 0° to 90°.
const POLAR: usize = 18;
/// Steps of its azimuth over 180°.
const AZIMUTH: usize = 36;
/// Steps of the stretch, in its logarithm, before the place of the loss is bisected.
const STEPS: usize = 24;

/// Returns the least stiffness of a plane wave in a material at Fe; not positive if the law is not elliptic there.
pub fn least_wave_stiffness(law: &Material, F: &Tensor2) -> f64 {
    least_over(law, F, 2 * AZIMUTH)
}

/// Returns the least stiffness of a wave along a direction with one of the first azimuths.
fn least_over(law: &Material, F: &Tensor2, azimuths: usize) -> f64 {
    let A = law.moduli(F);
    let modulus = |j: usize, k: usize, i: usize, l: usize| match k <= l {
        true => A[3 * k + j][3 * l + i],
        false => A[3 * l + i][3 * k + j],
    };
    let stiffness = |n: [f64; 3]| {
        let mut Q = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        Q[j][i] += modulus(j, k, i, l) * n[k] * n[l];
                    }
                }
            }
        }
        smallest_eigenvalue(Q)
    };
    let mut least = f64::INFINITY;
    for p in 0..=POLAR {
        let polar = 0.5 * PI * p as f64 / POLAR as f64;
        for a in 0..azimuths {
            // At the pole all azimuths are the same.
            if p == 0 && a > 0 {
                break;
            }
            let azimuth = PI * a as f64 / AZIMUTH as f64;
            let n = [
                polar.sin() * azimuth.cos(),
                polar.cos(),
                polar.sin() * azimuth.sin(),
            ];
            let own = stiffness(n);
            // NaN is no stiffness.
            if own.is_nan() {
                return own;
            }
            least = least.min(own);
        }
    }
    least
}

/// Returns the stretch at which a law loses ellipticity on the way from 1 to `limit` in a test; none if it does not, or if the
/// law has no such states before it does.
pub fn loses_ellipticity(law: &Material, test: MechanicalTest, limit: f64) -> Option<f64> {
    // Directions that are mirror images have the same stiffness in a state without shear.
    let azimuths = match law.is_mirror_symmetric() {
        true => AZIMUTH / 2 + 1,
        false => AZIMUTH,
    };
    let stiffness = |stretch: f64| {
        let state = homogeneous(law, test.prescribed(stretch), Volume::Free)?;
        let mut F = Tensor2::IDENTITY;
        for i in 0..3 {
            F.0[i][i] = state.stretches[i];
        }
        Some(least_over(law, &F, azimuths))
    };
    let at = |step: usize| limit.powf(step as f64 / STEPS as f64);
    let mut before = 1.0;
    let steps = if limit == 1.0 { 0 } else { STEPS };
    for step in 0..=steps {
        let stretch = at(step);
        if stiffness(stretch)? > 0.0 {
            before = stretch;
            continue;
        }
        let mut after = stretch;
        for _ in 0..12 {
            let middle = (before * after).sqrt();
            match stiffness(middle).is_some_and(|own| own > 0.0) {
                true => before = middle,
                false => after = middle,
            }
        }
        return Some(after);
    }
    None
}

/// Returns the smallest eigenvalue of a symmetric matrix (Smith 1961).
fn smallest_eigenvalue(Q: [[f64; 3]; 3]) -> f64 {
    let mean = (Q[0][0] + Q[1][1] + Q[2][2]) / 3.0;
    let mut square = 0.0;
    for i in 0..3 {
        for j in 0..3 {
            let part = Q[i][j] - if i == j { mean } else { 0.0 };
            square += part * part;
        }
    }
    if square == 0.0 {
        return mean;
    }
    let p = (square / 6.0).sqrt();
    let B = [0, 1, 2].map(|i| [0, 1, 2].map(|j| (Q[i][j] - if i == j { mean } else { 0.0 }) / p));
    let r = (0.5 * Tensor2(B).determinant()).clamp(-1.0, 1.0);
    mean + 2.0 * p * (r.acos() / 3.0 + 2.0 * PI / 3.0).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_eigenvalue_is_that_of_the_matrix() {
        // Eigenvalues 1, 3 and 5, rotated.
        let (s, c) = 0.6_f64.sin_cos();
        let R = Tensor2([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
        let (s, c) = 1.1_f64.sin_cos();
        let R = R.times(Tensor2([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]));
        let D = Tensor2([[3.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 1.0]]);
        let Q = R.times(D).times(R.transpose());
        assert!((smallest_eigenvalue(Q.0) - 1.0).abs() < 1e-13);
        assert_eq!(smallest_eigenvalue(Tensor2::IDENTITY.0), 1.0);
    }
}
