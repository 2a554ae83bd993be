//! Second-order tensors in three dimensions.

use super::Real;

/// A 3×3 tensor; `a.0[i][j]` is the component in row i, column j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor2<S = f64>(pub [[S; 3]; 3]);

impl<S: Real> Tensor2<S> {
    /// The zero tensor.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([[S::zero(); 3]; 3])
    }

    /// The identity.
    #[inline(always)]
    pub fn identity() -> Self {
        let mut a = Self::zero();
        for i in 0..3 {
            a.0[i][i] = S::splat(1.0);
        }
        a
    }

    /// The transpose.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let a = self.0;
        Self([
            [a[0][0], a[1][0], a[2][0]],
            [a[0][1], a[1][1], a[2][1]],
            [a[0][2], a[1][2], a[2][2]],
        ])
    }

    /// The tensor of cofactors, `det(a) a⁻ᵀ`: the derivative of the determinant.
    #[inline(always)]
    pub fn cofactor(self) -> Self {
        let a = self.0;
        let minor = |i: usize, j: usize| {
            let (r, s) = ((i + 1) % 3, (i + 2) % 3);
            let (p, q) = ((j + 1) % 3, (j + 2) % 3);
            a[r][p].mul_add(a[s][q], -(a[r][q] * a[s][p]))
        };
        Self([
            [minor(0, 0), minor(0, 1), minor(0, 2)],
            [minor(1, 0), minor(1, 1), minor(1, 2)],
            [minor(2, 0), minor(2, 1), minor(2, 2)],
        ])
    }

    /// The determinant, from a cofactor tensor already at hand.
    #[inline(always)]
    pub fn determinant_with(self, cofactor: Self) -> S {
        let (a, c) = (self.0[0], cofactor.0[0]);
        a[0].mul_add(c[0], a[1].mul_add(c[1], a[2] * c[2]))
    }

    /// The determinant.
    #[inline(always)]
    pub fn determinant(self) -> S {
        self.determinant_with(self.cofactor())
    }

    /// The full contraction `a : b`.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        let mut sum = S::zero();
        for i in 0..3 {
            for j in 0..3 {
                sum = self.0[i][j].mul_add(b.0[i][j], sum);
            }
        }
        sum
    }

    /// The product `a · b`.
    #[inline(always)]
    pub fn times(self, b: Self) -> Self {
        let mut c = Self::zero();
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    c.0[i][j] = self.0[i][k].mul_add(b.0[k][j], c.0[i][j]);
                }
            }
        }
        c
    }

    /// The tensor scaled by a number.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        let mut a = self;
        for row in &mut a.0 {
            for x in row {
                *x = *x * s;
            }
        }
        a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cofactor_inverts() {
        let a = Tensor2([[1.0, 0.3, -0.2], [0.1, 0.8, 0.5], [-0.4, 0.2, 1.3]]);
        let inverse = a.cofactor().transpose().scaled(1.0 / a.determinant());
        let product = a.times(inverse);
        for i in 0..3 {
            for j in 0..3 {
                let identity = if i == j { 1.0 } else { 0.0 };
                assert!((product.0[i][j] - identity).abs() < 1e-15);
            }
        }
        assert!((a.dot(a.cofactor()) - 3.0 * a.determinant()).abs() < 1e-14);
    }
}
