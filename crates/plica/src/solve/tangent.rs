//! The tangent stiffness as the solvers see it: it multiplies vectors, and can be solved with once
//! damping is added.

use crate::matrix::{BlockBanded, CoupledBanded, CoupledFactor, Singular};
use crate::monitor::Monitor;
use std::sync::Arc;

/// The tangent stiffness K of a state.
pub trait Tangent {
    /// Solver with K + α C.
    type Solver: Solver;

    /// Adds `factor` · K v to `y`, with K of all unknowns, prescribed or not.
    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]);

    /// Prepares the solution with K + α C on the free unknowns.
    ///
    /// # Errors
    ///
    /// If K + α C, or the matrix of its preconditioner, is singular to working precision.
    fn shifted(&self, alpha: f64) -> Result<Self::Solver, Singular>;

    /// Does the same where K is not needed afterwards, which may save a copy of it.
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

/// Solver with K + α C on the free unknowns.
pub trait Solver {
    /// Returns the number of negative eigenvalues that a factorisation shows: all of them if the whole
    /// matrix is factored; those with the symmetry of the state if only that part is; 0 if none is.
    fn negative_pivots(&self) -> usize;

    /// Returns whether K + α C is known not to be positive definite, without an iteration.
    fn is_unstable(&self) -> bool {
        self.negative_pivots() > 0
    }

    /// Solves (K + α C) x = b in place for the free unknowns, until the Euclidean norm of the residual
    /// is at most `accuracy` times that of b, or as far as possible; the energy decreases along the
    /// result in any case. Entries of prescribed unknowns stay as they are. A direct solver ignores the
    /// accuracy; an iterative one stops when the monitor cancels.
    ///
    /// # Errors
    ///
    /// If it meets a direction of negative curvature; `b` then holds the iterate so far.
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &dyn Monitor,
    ) -> Result<Solved, NegativeCurvature>;
}

/// Outcome of a linear solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Solved {
    /// Iterations; 0 for a direct solver.
    pub iterations: usize,
    /// True if the residual is as small as required. It is not if the solve was cut off, or if rounding
    /// does not permit it.
    pub converged: bool,
}

/// A direction d of negative curvature: d · (K + α C) d ≤ 0.
#[derive(Clone, Debug, PartialEq)]
pub struct NegativeCurvature {
    /// d · (K + α C) d / d · C d, at most 0. An increase of α by more than its size makes the curvature
    /// along d positive.
    pub curvature: f64,
    /// d, with zeros for prescribed unknowns.
    pub direction: Vec<f64>,
    /// Iterations until it was met.
    pub iterations: usize,
}

/// A tangent stiffness that is assembled and factored.
#[derive(Clone, Debug)]
pub struct Direct {
    stiffness: CoupledBanded,
    damping: Arc<BlockBanded>,
    prescribed: Arc<[bool]>,
}

impl Direct {
    /// Takes the assembled stiffness K and damping matrix C of all unknowns, and which of them are prescribed.
    ///
    /// # Panics
    ///
    /// If their sizes differ.
    pub fn new(
        stiffness: impl Into<CoupledBanded>,
        damping: Arc<BlockBanded>,
        prescribed: Arc<[bool]>,
    ) -> Self {
        let stiffness = stiffness.into();
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
    type Solver = CoupledFactor;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.stiffness.multiply_add(factor, v, y);
    }

    fn shifted(&self, alpha: f64) -> Result<CoupledFactor, Singular> {
        self.clone().into_shifted(alpha)
    }

    fn into_shifted(self, alpha: f64) -> Result<CoupledFactor, Singular> {
        let mut A = self.stiffness;
        if alpha != 0.0 {
            A.add_scaled(alpha, &self.damping);
        }
        A.constrain(&self.prescribed);
        A.factor()
    }
}

impl Solver for CoupledFactor {
    fn negative_pivots(&self) -> usize {
        Self::negative_pivots(self)
    }

    fn solve(&self, b: &mut [f64], _: f64, _: &dyn Monitor) -> Result<Solved, NegativeCurvature> {
        Self::solve(self, b);
        Ok(Solved {
            iterations: 0,
            converged: true,
        })
    }
}
