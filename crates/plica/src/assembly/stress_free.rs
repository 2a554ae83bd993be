//! The stress-free shape of an imperfect wall, as the kernels see it.
//!
//! An imperfect wall is free of stress at X' = X + δ(X), where the perfect one is at X.
//! Displacements are from the perfect tube all the same: x = X + u, F = ∂x/∂X, and at rest u = δ. With
//! A = ∂X'/∂X = R U, R the rotation nearest A and U symmetric (polar decomposition),
//!
//! Fe = F A⁻¹ R Fp⁻¹ = F U⁻¹ Fp⁻¹,    dV' = det U dV₀
//!
//! so that strain is measured from X', and the directions of the muscles, which the columns of Fe belong
//! to, have turned with the wall by R.
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | E | U⁻¹ − I, columns and rows along, outwards and around at the point | [`StressFree`] |
//! | D | Fp E Fp⁻¹, so that Fe = F Fp⁻¹ (I + D) | [`Departure`] |
//!
//! E is kept in double precision: rounded to single, a tube at rest would be under stresses whose
//! balance is of the size of the forces in play.

use super::kinematics::Columns;
use super::slab::{SlabInput, contract_along, contract_through, gradients};
use crate::material::Moduli;
use crate::tensor::{Lanes, Real, Tensor2};
use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};

/// Iterations for the rotation nearest A: a few near rest, and some more where the shape is so
/// distorted that it will not do.
const ITERATIONS: usize = 30;

/// Square of a step after which there is no need for another: its size is the square of this one's.
const SMALL: f64 = 1e-20;

/// E at a point of eight elements: its (along, along), (along, outwards), (along, around), (outwards,
/// outwards), (outwards, around) and (around, around).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StressFree([Lanes; 6]);

/// What leads from F Fp⁻¹ to Fe at a point.
#[derive(Clone, Copy)]
pub struct Departure<S> {
    D: Tensor2<S>,
    /// det U.
    volume: S,
}

impl StressFree {
    /// Of A, its columns along, outwards and around at the point.
    #[inline(always)]
    pub fn of<S: Simd>(A: Tensor2<f64x8<S>>) -> Self {
        let small = |x| Lanes::store(x).0.iter().all(|x| *x < SMALL);
        let E = shrinkage(A, small).0;
        let upper = [E[0][0], E[0][1], E[0][2], E[1][1], E[1][2], E[2][2]];
        Self(upper.map(Lanes::store))
    }

    /// For 1/θζ and 1/θη.
    #[inline(always)]
    pub fn imperfection_map<S: Simd>(
        &self,
        simd: S,
        inverse_along: f64x8<S>,
        inverse_around: f64x8<S>,
    ) -> Departure<f64x8<S>> {
        let [zz, zr, zt, rr, rt, tt] = self.0.map(|x| x.load(simd));
        let E = Tensor2([[zz, zr, zt], [zr, rr, rt], [zt, rt, tt]]);
        Departure::new(E, inverse_along, inverse_around)
    }
}

impl Departure<f64> {
    /// Of A, its columns along, outwards and around at the point; for 1/θζ and 1/θη.
    pub fn of(A: Tensor2, inverse_along: f64, inverse_around: f64) -> Self {
        Self::new(shrinkage(A, |x| x < SMALL), inverse_along, inverse_around)
    }
}

/// E = U⁻¹ − I of A = R U; `small` tells whether a square is.
#[inline(always)]
fn shrinkage<S: Real>(A: Tensor2<S>, small: impl Fn(S) -> bool) -> Tensor2<S> {
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

impl<S: Real> Departure<S> {
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
        }
    }

    /// Fe from F Fp⁻¹.
    #[inline(always)]
    pub fn onto(&self, F: Tensor2<S>) -> Tensor2<S> {
        self.added(F, self.D)
    }

    /// A stress on Fe as one on F Fp⁻¹.
    #[inline(always)]
    pub fn back(&self, P: Tensor2<S>) -> Tensor2<S> {
        self.added(P, self.D.transpose())
    }

    /// A volume of the perfect tube as one of the stress-free shape.
    #[inline(always)]
    pub fn volume(&self, volume: S) -> S {
        volume * self.volume
    }

    /// Moduli on Fe as moduli on F Fp⁻¹: (I + D) on both second indices.
    #[inline(always)]
    pub fn moduli(&self, A: &Moduli<S>) -> Moduli<S> {
        let mut Z = self.D;
        for i in 0..3 {
            Z.0[i][i] = Z.0[i][i] + Z.0[i][i].like(1.0);
        }
        let mut out = *A;
        for j in 0..3 {
            for i in 0..3 {
                // The law fills k ≤ l.
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

    /// T + T D.
    #[inline(always)]
    fn added(&self, T: Tensor2<S>, D: Tensor2<S>) -> Tensor2<S> {
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

/// E of a slab whose control points are displaced by `input.u`: at (layer, element around, point
/// along, point through, point around). `N` is the degree plus one.
pub fn slab_stress_free<const N: usize>(input: &SlabInput<'_>) -> Vec<StressFree> {
    dispatch!(Level::new(), simd => kernel::<_, N>(simd, input))
}

#[inline(always)]
fn kernel<S: Simd, const N: usize>(simd: S, input: &SlabInput<'_>) -> Vec<StressFree> {
    let slots = input.slots();
    let one = f64x8::splat(simd, 1.0);
    let zero = [f64x8::splat(simd, 0.0); 3];
    let mut u = vec![zero; N * N * slots];
    let mut along = vec![[zero; 2]; N * slots];
    let mut through = vec![[zero; 3]; slots];
    let mut out = vec![];
    for layer in input.layers {
        for element in 0..input.rings {
            input.gather::<S, N>(simd, layer, element, &mut u);
            for qz in 0..N {
                contract_along::<S, N>(simd, input.slab, qz, &u, &mut along);
                for qr in 0..N {
                    let radius = layer.radius[qr];
                    contract_through::<S, N>(simd, layer, qr, &along, &mut through);
                    for point in input.around {
                        let columns = Columns::new(point, radius, one, one);
                        let g = gradients(simd, point, &through);
                        out.push(StressFree::of(columns.elastic(point, radius, g)));
                    }
                }
            }
        }
    }
    out
}
