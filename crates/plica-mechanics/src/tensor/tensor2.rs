//! Second-order tensors in three dimensions.

use super::Real;

/// A 3×3 tensor; `a.0[i][j]` is the component in row i, column j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor2<S = f64>(pub [[S; 3]; 3]);

impl Tensor2 {
    /// The identity.
    pub const IDENTITY: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
}

impl<S: Real> Tensor2<S> {
    /// Returns the transpose.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let a = self.0;
        Self([
            [a[0][0], a[1][0], a[2][0]],
            [a[0][1], a[1][1], a[2][1]],
            [a[0][2], a[1][2], a[2][2]],
        ])
    }

    /// Returns the tensor of cofactors, `det(a) a⁻ᵀ`: the derivative of the determinant.
    #[inline(always)]
    pub fn cofactor(self) -> Self {
        let (a, mut c) = (self.0, self.0);
        for i in 0..3 {
            for j in 0..3 {
                let (r, s) = ((i + 1) % 3, (i + 2) % 3);
                let (p, q) = ((j + 1) % 3, (j + 2) % 3);
                c[i][j] = a[r][p].mul_add(a[s][q], -(a[r][q] * a[s][p]));
            }
        }
        Self(c)
    }

    /// Returns the determinant, given the cofactors.
    #[inline(always)]
    pub fn determinant_with(self, cofactor: Self) -> S {
        let (a, c) = (self.0[0], cofactor.0[0]);
        a[0].mul_add(c[0], a[1].mul_add(c[1], a[2] * c[2]))
    }

    /// Returns the determinant.
    #[inline(always)]
    pub fn determinant(self) -> S {
        self.determinant_with(self.cofactor())
    }

    /// Returns the full contraction `a : b`.
    #[inline(always)]
    pub fn dot(self, b: Self) -> S {
        let mut sum = self.0[0][0].like(0.0);
        for i in 0..3 {
            for j in 0..3 {
                sum = self.0[i][j].mul_add(b.0[i][j], sum);
            }
        }
        sum
    }

    /// Returns the product `a · b`.
    #[inline(always)]
    pub fn times(self, b: Self) -> Self {
        let mut c = [[self.0[0][0].like(0.0); 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    c[i][j] = self.0[i][k].mul_add(b.0[k][j], c[i][j]);
                }
            }
        }
        Self(c)
    }

    /// Returns the tensor times a vector with the components `first` and `last` and none in the middle.
    #[inline(always)]
    pub fn across(self, first: f64, last: f64) -> [S; 3] {
        let mut product = self.0[0];
        for i in 0..3 {
            let [x, _, y] = self.0[i];
            product[i] = y.mul_add(y.like(last), x.times(first));
        }
        product
    }

    /// Returns the tensor times a number.
    #[inline(always)]
    pub fn scaled(self, s: S) -> Self {
        let mut a = self.0;
        for i in 0..3 {
            for j in 0..3 {
                a[i][j] = a[i][j] * s;
            }
        }
        Self(a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cofactors_give_the_inverse() {
        let a = Tensor2([[1.0, 0.3, -0.2], [0.1, 0.8, 0.5], [-0.4, 0.2, 1.3]]);
        let inverse = a.cofactor().transpose().scaled(1.0 / a.determinant());
        let product = a.times(inverse);
        for i in 0..3 {
            for j in 0..3 {
                assert!((product.0[i][j] - Tensor2::IDENTITY.0[i][j]).abs() < 1e-15);
            }
        }
        assert!((a.dot(a.cofactor()) - 3.0 * a.determinant()).abs() < 1e-14);
    }
}
