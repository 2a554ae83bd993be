//! Block-circulant matrices: invariant under rotation of the tube by a ring, and under reflection
//! in a plane through its axis.
//!
//! Such a matrix is defined by its blocks M_d between rings d = 0 to p apart. On displacements of
//! circumferential harmonic n, (z cos nφ, r cos nφ, −θ sin nφ) or a quarter wave on, it is the same
//! real matrix
//!
//! B_n = Σ_d M_d cos(n α d), with −sin and +sin between an axial or radial component and a
//! circumferential one,
//!
//! so it decouples into one block-banded matrix of the size of the axisymmetric tube per harmonic.
//! The tangent of an axisymmetric state without twist is such a matrix.

use crate::matrix::BlockBanded;

/// A block-circulant matrix.
#[derive(Clone, Debug, Default)]
pub struct Circulant {
    /// M_0 = K̄_0 and M_d = K̄_d + S K̄_dᵀ S for d = 1 to p, where K̄_d couples ring j with ring j
    /// + d and S changes the sign of circumferential components; each is numbered like one ring.
    pub offsets: Vec<BlockBanded>,
    /// α, the angle between rings.
    pub angle: f64,
}

impl Circulant {
    /// Adds another matrix of the same shape.
    pub fn add(&mut self, other: &Self) {
        for (sum, part) in self.offsets.iter_mut().zip(&other.offsets) {
            sum.add_scaled(1.0, part);
        }
    }

    /// Returns B_n, the matrix on circumferential harmonic n of the whole tube; every unknown is
    /// free.
    #[cfg(test)]
    pub fn harmonic(&self, n: usize) -> BlockBanded {
        let like = &self.offsets[0];
        let mut block = BlockBanded::zeros(like.blocks(), like.size(), like.band());
        self.harmonic_into(n, &mut block);
        block
    }

    /// Writes B_n into a matrix of its shape.
    pub fn harmonic_into(&self, n: usize, block: &mut BlockBanded) {
        let parts: Vec<_> = self
            .offsets
            .iter()
            .enumerate()
            .map(|(d, offset)| {
                let (sin, cos) = (n as f64 * self.angle * d as f64).sin_cos();
                // By component of the row and of the column.
                let factor = move |row: usize, column: usize| match (row % 3 == 2, column % 3 == 2)
                {
                    (false, true) => -sin,
                    (true, false) => sin,
                    _ => cos,
                };
                (offset, factor)
            })
            .collect();
        block.combine(&parts);
    }
}
