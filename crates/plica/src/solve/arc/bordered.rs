//! Bordered systems [K b; cᵀ d] [x; y] = [f; g], by block elimination with a factored K and refinement.
//!
//! Near a fold or a branch point K is nearly singular, and the elimination loses digits that the refinement with the bordered
//! matrix itself, which is regular, brings back (Govaerts 2000, section 3).

use super::super::operator::{add, dot};
use super::super::tangent::{Solver, Tangent};
use super::error::ArcFailure;

/// Refinements of a solution.
const REFINEMENTS: usize = 2;
/// Refinements where K is singular to working precision, and a matrix beside it was factored instead.
const OF_NEIGHBOUR: usize = 8;
/// Shift of that matrix, relative to the mean eigenvalue of K.
const SHIFT: f64 = 1e-13;

/// A tangent stiffness with its factorisation.
pub(super) struct Linear<T: Tangent> {
    tangent: T,
    solver: T::Solver,
    prescribed: Vec<bool>,
    refinements: usize,
}

/// The border of a system: column b, row c, corner d.
pub(super) struct Border<'a> {
    pub column: &'a [f64],
    pub row: &'a [f64],
    pub corner: f64,
}

impl<T: Tangent> Linear<T> {
    /// Factors a tangent stiffness. `mean` is an estimate of the mean eigenvalue of K x = ν C x.
    pub fn new<E: std::error::Error>(
        tangent: T,
        prescribed: &[bool],
        mean: impl FnOnce(&T) -> f64,
    ) -> Result<Self, ArcFailure<E>> {
        let (solver, refinements) = match tangent.shifted(0.0) {
            Ok(solver) => (solver, REFINEMENTS),
            Err(singular) => {
                let shift = SHIFT * mean(&tangent);
                let beside = tangent.shifted(shift);
                (
                    beside.map_err(|_| ArcFailure::Singular(singular))?,
                    OF_NEIGHBOUR,
                )
            }
        };
        Ok(Self {
            tangent,
            solver,
            prescribed: prescribed.to_vec(),
            refinements,
        })
    }

    /// Returns the number of negative eigenvalues of K.
    pub fn negative(&self) -> usize {
        self.solver.negative_pivots()
    }

    /// Solves K x = f for the free unknowns.
    pub fn solve_alone<E: std::error::Error>(&self, f: &[f64]) -> Result<Vec<f64>, ArcFailure<E>> {
        let mut x = f.to_vec();
        self.clear(&mut x);
        match self.solver.solve(&mut x, 1e-12, &()) {
            Ok(_) => Ok(x),
            Err(_) => Err(ArcFailure::Indefinite),
        }
    }

    /// Adds `factor` · K v of the free unknowns to `y`.
    pub fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.tangent.multiply_add(factor, v, y);
        self.clear(y);
    }

    /// Solves the bordered system for the free unknowns.
    pub fn solve<E: std::error::Error>(
        &self,
        border: &Border<'_>,
        f: &[f64],
        g: f64,
    ) -> Result<(Vec<f64>, f64), ArcFailure<E>> {
        let column = self.solve_alone(border.column)?;
        let pivot = border.corner - dot(border.row, &column);
        let (mut x, mut y) = (vec![0.0; f.len()], 0.0);
        let (mut left, mut rest) = (f.to_vec(), g);
        self.clear(&mut left);
        for refinement in 0..=self.refinements {
            let part = self.solve_alone(&left)?;
            let dy = (rest - dot(border.row, &part)) / pivot;
            add(1.0, &part, &mut x);
            add(-dy, &column, &mut x);
            y += dy;
            if refinement == self.refinements {
                break;
            }
            left.copy_from_slice(f);
            self.multiply_add(-1.0, &x, &mut left);
            add(-y, border.column, &mut left);
            self.clear(&mut left);
            rest = g - dot(border.row, &x) - border.corner * y;
        }
        Ok((x, y))
    }

    fn clear(&self, v: &mut [f64]) {
        for (x, prescribed) in v.iter_mut().zip(&self.prescribed) {
            if *prescribed {
                *x = 0.0;
            }
        }
    }
}
