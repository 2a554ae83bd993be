//! The tangent stiffness as the drivers see it: something that multiplies, and that can be solved
//! with once a drag is added.

use super::Monitor;
use crate::matrix::{BlockBanded, Factor, Singular};
use std::sync::Arc;

/// The tangent stiffness K of a state, ready to be shifted by a drag.
pub trait Tangent {
    /// What solves with it.
    type Solver: Solver;

    /// y += factor · K v, every unknown free.
    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]);

    /// K + α C on the free unknowns, ready to be solved with.
    ///
    /// # Errors
    ///
    /// If K + α C, or what stands in for it in a preconditioner, is singular to working precision.
    fn shifted(&self, alpha: f64) -> Result<Self::Solver, Singular>;

    /// The same where K is not needed for anything else, which may save a copy of it.
    ///
    /// # Errors
    ///
    /// Those of [`Tangent::shifted`].
    fn into_shifted(self, alpha: f64) -> Result<Self::Solver, Singular>
    where
        Self: Sized,
    {
        self.shifted(alpha)
    }
}

/// K + α C on the free unknowns.
pub trait Solver {
    /// Negative eigenvalues that a factorisation tells of. One of the whole matrix tells of all;
    /// one of a part (the symmetry that the state itself has) of those in the part; where there is
    /// none, 0, and only the iteration may tell.
    fn negative_pivots(&self) -> usize;

    /// Whether what it leads to is known to lie on an unstable branch, without an iteration: the matrix is not
    /// positive definite on displacements that the state's own symmetry allows.
    fn is_unstable(&self) -> bool {
        self.negative_pivots() > 0
    }

    /// Solves (K + α C) x = b in place for the free unknowns, until the Euclidean norm of the
    /// residual is at most `accuracy` times that of b, or as far as it gets: what it then leaves is
    /// still a direction in which the energy falls. Entries of unknowns that supports give take no
    /// part and stay as they are. A direct solver is exact, whatever the accuracy; one that iterates
    /// is cut off where the watch says so.
    ///
    /// # Errors
    ///
    /// If it meets a direction of negative curvature. What is in `b` then is the iterate so far.
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Solved, NegativeCurvature>;
}

/// What a linear solve took, and whether it came as far as it was to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Solved {
    /// Iterations; 0 of a direct solver.
    pub iterations: usize,
    /// Whether the residual is as small as was asked for. If not it was cut off, or rounding allows no
    /// better.
    pub reached: bool,
}

/// A direction d along which the energy is curved downwards: d · (K + α C) d ≤ 0.
#[derive(Clone, Debug, PartialEq)]
pub struct NegativeCurvature {
    /// d · (K + α C) d over d · C d; at most 0. A drag larger by more than its size makes up for
    /// it along d.
    pub curvature: f64,
    /// d, for every unknown; zero where a support gives it.
    pub direction: Vec<f64>,
    /// Iterations until it was met.
    pub iterations: usize,
}

/// A tangent stiffness that is assembled and factored.
#[derive(Clone, Debug)]
pub struct Direct {
    stiffness: BlockBanded,
    damping: Arc<BlockBanded>,
    prescribed: Arc<[bool]>,
}

impl Direct {
    /// Of an assembled stiffness K and drag matrix C, every unknown free, and the unknowns that
    /// supports give. Panics if their sizes differ.
    pub fn new(stiffness: BlockBanded, damping: Arc<BlockBanded>, prescribed: Arc<[bool]>) -> Self {
        assert_eq!(stiffness.unknowns(), damping.unknowns());
        assert_eq!(stiffness.unknowns(), prescribed.len());
        Self {
            stiffness,
            damping,
            prescribed,
        }
    }
}

impl Tangent for Direct {
    type Solver = Factor;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.stiffness.multiply_add(factor, v, y);
    }

    fn shifted(&self, alpha: f64) -> Result<Factor, Singular> {
        self.clone().into_shifted(alpha)
    }

    fn into_shifted(self, alpha: f64) -> Result<Factor, Singular> {
        let mut A = self.stiffness;
        if alpha != 0.0 {
            A.add_scaled(alpha, &self.damping);
        }
        A.constrain(&self.prescribed);
        A.factor()
    }
}

impl Solver for Factor {
    fn negative_pivots(&self) -> usize {
        Factor::negative_pivots(self)
    }

    fn solve(
        &self,
        b: &mut [f64],
        _: f64,
        _: &mut dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        Factor::solve(self, b);
        Ok(Solved {
            iterations: 0,
            reached: true,
        })
    }
}
