//! Data of a state at a quadrature point from which the matrix-free product A : dF is computed.

use super::Law;
use crate::tensor::{Real, Tensor2};

/// Numbers that the matrix-free product stores at a quadrature point.
///
/// They are stored in single precision: reading them limits the speed of a product. A product must
/// therefore be symmetric, dF' : A : dF = dF : A : dF', for rounded numbers too.
pub trait TangentData<S: Real, L>: AsRef<[S]> + AsMut<[S]> {
    /// Count of the numbers, even.
    const LEN: usize;

    /// Returns data of zeros, in vectors like `like`.
    fn zeros(like: S) -> Self;
    /// Computes the data at Fe.
    fn linearise(law: &L, F: &Tensor2<S>) -> Self;
    /// Returns the change of stress dP = A : dF.
    fn tangent_product(&self, law: &L, dF: &Tensor2<S>) -> Tensor2<S>;
}

/// The 45 independent tangent moduli and a zero: the tangent data of a law without its own.
pub type ModuliData<S> = [S; 46];

impl<S: Real, L: Law> TangentData<S, L> for ModuliData<S> {
    const LEN: usize = 46;

    #[inline(always)]
    fn zeros(like: S) -> Self {
        [like.like(0.0); 46]
    }

    // The upper triangle of the 9 × 9 moduli, row by row.
    #[inline(always)]
    fn linearise(law: &L, F: &Tensor2<S>) -> Self {
        let A = law.moduli(F);
        let mut data = [A[0][0].like(0.0); 46];
        let mut at = 0;
        for r in 0..9 {
            for c in r..9 {
                data[at] = A[r][c];
                at += 1;
            }
        }
        data
    }

    // dP_r = A_rc dF_c, components numbered column by column.
    #[inline(always)]
    fn tangent_product(&self, _: &L, dF: &Tensor2<S>) -> Tensor2<S> {
        let zero = dF.0[0][0].like(0.0);
        let mut dP = Tensor2([[zero; 3]; 3]);
        let mut at = 0;
        for r in 0..9 {
            let (k, j) = (r / 3, r % 3);
            for c in r..9 {
                let (l, i) = (c / 3, c % 3);
                dP.0[j][k] = self[at].mul_add(dF.0[i][l], dP.0[j][k]);
                if c > r {
                    dP.0[i][l] = self[at].mul_add(dF.0[j][k], dP.0[i][l]);
                }
                at += 1;
            }
        }
        dP
    }
}
