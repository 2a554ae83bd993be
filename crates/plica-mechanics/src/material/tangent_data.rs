//! Data of a state at a quadrature point from which the matrix-free product A : dF is computed.

use super::Law;
use crate::tensor::{Real, Tensor2};

/// Numbers that the matrix-free product stores at a quadrature point.
///
/// They are stored in single precision: reading them limits the speed of a product. A product must
/// therefore be symmetric, dF' : A : dF = dF : A : dF', for rounded numbers too.
pub trait TangentData<L> {
    /// Returns the count of the numbers, even.
    fn count(law: &L) -> usize;
    /// Computes the numbers at Fe and passes them to `store`, two at a time.
    fn linearise<S: Real>(law: &L, F: &Tensor2<S>, store: impl FnMut([S; 2]));
    /// Returns the change of stress dP = A : dF. `pair` returns the n-th two numbers.
    fn tangent_product<S: Real>(
        law: &L,
        pair: impl Fn(usize) -> [S; 2],
        dF: &Tensor2<S>,
    ) -> Tensor2<S>;
}

/// The 45 independent tangent moduli and a zero: the tangent data of a law without its own.
pub enum ModuliData {}

impl<L: Law> TangentData<L> for ModuliData {
    #[inline(always)]
    fn count(_: &L) -> usize {
        46
    }

    // The upper triangle of the 9 × 9 moduli, row by row.
    #[inline(always)]
    fn linearise<S: Real>(law: &L, F: &Tensor2<S>, mut store: impl FnMut([S; 2])) {
        let A = law.moduli(F);
        let mut data = [A[0][0].like(0.0); 46];
        let mut at = 0;
        for r in 0..9 {
            for c in r..9 {
                data[at] = A[r][c];
                at += 1;
            }
        }
        for pair in data.as_chunks().0 {
            store(*pair);
        }
    }

    // dP_r = A_rc dF_c, components numbered column by column.
    #[inline(always)]
    fn tangent_product<S: Real>(
        _: &L,
        pair: impl Fn(usize) -> [S; 2],
        dF: &Tensor2<S>,
    ) -> Tensor2<S> {
        let zero = dF.0[0][0].like(0.0);
        let mut dP = Tensor2([[zero; 3]; 3]);
        let mut data = [zero; 46];
        for (n, data) in data.as_chunks_mut().0.iter_mut().enumerate() {
            *data = pair(n);
        }
        let mut at = 0;
        for r in 0..9 {
            let (k, j) = (r / 3, r % 3);
            for c in r..9 {
                let (l, i) = (c / 3, c % 3);
                dP.0[j][k] = data[at].mul_add(dF.0[i][l], dP.0[j][k]);
                if c > r {
                    dP.0[i][l] = data[at].mul_add(dF.0[j][k], dP.0[i][l]);
                }
                at += 1;
            }
        }
        dP
    }
}
