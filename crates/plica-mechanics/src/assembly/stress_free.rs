//! Stress-free shape of an imperfect wall, and the map from F Fp⁻¹ to Fe that follows from it.
//!
//! An imperfect wall is free of stress at X' = X + δ(X), the perfect wall at X. Displacements are
//! measured from the perfect tube in both: x = X + u, F = ∂x/∂X, and at rest u = δ. With A = ∂X'/∂X
//! = R U, R the rotation nearest A and U symmetric (polar decomposition),
//!
//! Fe = F A⁻¹ R Fp⁻¹ = F U⁻¹ Fp⁻¹,    dV' = det U dV₀
//!
//! so that strain is measured from X', and the muscle directions, which the columns of Fe refer to,
//! are rotated by R with the wall.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | E | U⁻¹ − I, columns and rows along, outwards and around at the point | [`StressFreeStretch`] |
//! | D | Fp E Fp⁻¹, so that Fe = F Fp⁻¹ (I + D) | [`ImperfectionMap`] |
//!
//! E is stored in double precision: with single precision, a tube at rest would have stresses whose
//! residual is of the order of the residual scale.

use crate::material::Moduli;
use crate::tensor::{Lanes, Real, Tensor2};
use fearless_simd::{Simd, f64x8};

/// Maximum number of Newton iterations for the rotation nearest A. A few suffice for small
/// distortions.
const ITERATIONS: usize = 30;

/// Squared step below which the iteration stops: convergence is quadratic.
const SMALL: f64 = 1e-20;

/// E at a point of eight elements: the components (along, along), (along, outwards), (along,
/// around), (outwards, outwards), (outwards, around) and (around, around).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressFreeStretch([Lanes; 6]);

/// Map from F Fp⁻¹ to Fe at a point of an imperfect or patched wall.
#[derive(Clone, Copy)]
pub struct ImperfectionMap<S> {
    D: Tensor2<S>,
    /// det U, times the factor of patches on the energy.
    volume: S,
    /// Growth of volume by patches.
    growth: S,
}

impl StressFreeStretch {
    /// Of A, its columns along, outwards and around at the point.
    #[inline(always)]
    pub fn from_gradient<S: Simd>(A: Tensor2<f64x8<S>>) -> Self {
        let small = |x| Lanes::store(x).0.iter().all(|x| *x < SMALL);
        let E = inverse_stretch_less_identity(A, small).0;
        let upper = [E[0][0], E[0][1], E[0][2], E[1][1], E[1][2], E[2][2]];
        Self(upper.map(Lanes::store))
    }

    /// Returns the map from F Fp⁻¹ to Fe, given 1/θζ and 1/θη.
    #[inline(always)]
    pub fn imperfection_map<S: Simd>(
        &self,
        simd: S,
        inverse_along: f64x8<S>,
        inverse_around: f64x8<S>,
    ) -> ImperfectionMap<f64x8<S>> {
        let [zz, zr, zt, rr, rt, tt] = self.0.map(|x| x.load(simd));
        let E = Tensor2([[zz, zr, zt], [zr, rr, rt], [zt, rt, tt]]);
        ImperfectionMap::new(E, inverse_along, inverse_around)
    }
}

impl ImperfectionMap<f64> {
    /// Returns the map for a gradient A with columns along, outwards and around at the point, and
    /// 1/θζ and 1/θη.
    pub fn from_gradient(A: Tensor2, inverse_along: f64, inverse_around: f64) -> Self {
        Self::new(
            inverse_stretch_less_identity(A, |x| x < SMALL),
            inverse_along,
            inverse_around,
        )
    }
}

/// Returns E = U⁻¹ − I of A = R U. `small` decides whether a squared step has converged.
#[inline(always)]
fn inverse_stretch_less_identity<S: Real>(A: Tensor2<S>, small: impl Fn(S) -> bool) -> Tensor2<S> {
    let one = A.0[0][0].like(1.0);
    // Newton's iteration R ← (R + R⁻ᵀ)/2 (Higham 1986).
    let mut R = A;
    for _ in 0..ITERATIONS {
        let cofactor = R.cofactor();
        let inverse = cofactor.scaled(one / R.determinant_with(cofactor)); // R⁻ᵀ
        let mut step = R;
        for i in 0..3 {
            for j in 0..3 {
                step.0[i][j] = (inverse.0[i][j] - R.0[i][j]).times(0.5);
                R.0[i][j] += step.0[i][j];
            }
        }
        if small(step.dot(step)) {
            break;
        }
    }
    let mut U = R.transpose().times(A);
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        let mean = (U.0[i][j] + U.0[j][i]).times(0.5);
        (U.0[i][j], U.0[j][i]) = (mean, mean);
    }
    let cofactor = U.cofactor();
    let mut E = cofactor.scaled(one / U.determinant_with(cofactor));
    for i in 0..3 {
        E.0[i][i] = E.0[i][i] - one;
    }
    E
}

impl<S: Real> ImperfectionMap<S> {
    #[inline(always)]
    fn new(E: Tensor2<S>, inverse_along: S, inverse_around: S) -> Self {
        let one = inverse_along.like(1.0);
        let inverse = [inverse_along, one, inverse_around];
        let theta = [one / inverse_along, one, one / inverse_around];
        let (mut D, mut B) = (E, E);
        for i in 0..3 {
            B.0[i][i] = E.0[i][i] + one;
            for j in 0..3 {
                if i != j {
                    D.0[i][j] = theta[i] * E.0[i][j] * inverse[j];
                }
            }
        }
        Self {
            D,
            volume: one / B.determinant(),
            growth: one,
        }
    }

    /// Returns the map of a perfect wall; `like` is any number.
    #[inline(always)]
    pub fn identity(like: S) -> Self {
        Self {
            D: Tensor2([[like.like(0.0); 3]; 3]),
            volume: like.like(1.0),
            growth: like.like(1.0),
        }
    }

    /// Adds the growth of patches, from one over it along, through and around, and their factor on the energy: the columns
    /// of Fe are divided by the growth.
    #[inline(always)]
    pub fn with_patch(mut self, inverse: [S; 3], stiffness: S) -> Self {
        let one = stiffness.like(1.0);
        for i in 0..3 {
            for j in 0..3 {
                self.D.0[i][j] = match i == j {
                    true => self.D.0[i][j].mul_add(inverse[j], inverse[j] - one),
                    false => self.D.0[i][j] * inverse[j],
                };
            }
        }
        self.volume = self.volume * stiffness;
        self.growth = one / (inverse[0] * inverse[1] * inverse[2]);
        self
    }

    /// Returns Fe from F Fp⁻¹.
    #[inline(always)]
    pub fn apply(&self, F: Tensor2<S>) -> Tensor2<S> {
        self.times_identity_plus(F, self.D)
    }

    /// Maps a stress on Fe to a stress on F Fp⁻¹.
    #[inline(always)]
    pub fn apply_transpose(&self, P: Tensor2<S>) -> Tensor2<S> {
        self.times_identity_plus(P, self.D.transpose())
    }

    /// Converts a volume of the perfect tube to the stress-free shape, and multiplies it by the stiffness.
    #[inline(always)]
    pub fn volume(&self, volume: S) -> S {
        volume * self.volume
    }

    /// Converts a volume grown by the muscles to that grown by patches too.
    #[inline(always)]
    pub fn grown(&self, volume: S) -> S {
        volume * self.growth
    }

    /// Maps moduli on Fe to moduli on F Fp⁻¹: multiplies both second indices by (I + D).
    #[inline(always)]
    pub fn pull_back_moduli(&self, A: &Moduli<S>) -> Moduli<S> {
        let mut Z = self.D;
        for i in 0..3 {
            Z.0[i][i] = Z.0[i][i] + Z.0[i][i].like(1.0);
        }
        let mut out = *A;
        for j in 0..3 {
            for i in 0..3 {
                // The law fills only k ≤ l.
                let full = |k: usize, l: usize| match k <= l {
                    true => A[3 * k + j][3 * l + i],
                    false => A[3 * l + i][3 * k + j],
                };
                let block = Tensor2([0, 1, 2].map(|k| [0, 1, 2].map(|l| full(k, l))));
                let block = Z.times(block).times(Z.transpose());
                for k in 0..3 {
                    for l in k..3 {
                        out[3 * k + j][3 * l + i] = block.0[k][l];
                    }
                }
            }
        }
        out
    }

    /// Returns T + T D.
    #[inline(always)]
    fn times_identity_plus(&self, T: Tensor2<S>, D: Tensor2<S>) -> Tensor2<S> {
        let mut sum = T;
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    sum.0[i][j] = T.0[i][k].mul_add(D.0[k][j], sum.0[i][j]);
                }
            }
        }
        sum
    }
}
