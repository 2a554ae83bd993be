//! A rank-one term of a symmetric matrix: A + κ g gᵀ.
//!
//! With w = A⁻¹ g and s = 1 + κ g · w,
//!
//! (A + κ g gᵀ)⁻¹ b = A⁻¹ b − (κ/s) (g · A⁻¹ b) w
//!
//! (Sherman and Morrison 1950). For κ > 0 the inertia of the bordered matrix [A g; gᵀ −1/κ], taken by either of its
//! diagonal blocks (Haynsworth 1968), shows that A + κ g gᵀ has one negative eigenvalue less than A if s < 0, and else as
//! many.

use super::{CoupledFactor, Singular};

/// A term κ g gᵀ with κ > 0.
#[derive(Clone, Debug)]
pub struct RankOne {
    /// κ.
    pub factor: f64,
    /// g.
    pub vector: Vec<f64>,
}

/// The factorisation of a matrix with a rank-one term.
#[derive(Clone, Debug)]
pub struct RankOneFactor {
    /// A.
    matrix: CoupledFactor,
    term: RankOne,
    /// w.
    solution: Vec<f64>,
    /// s.
    denominator: f64,
}

impl RankOne {
    /// Adds `factor` · κ g (g · x) to `y`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        let part = factor * self.factor * dot(&self.vector, x);
        for (y, g) in y.iter_mut().zip(&self.vector) {
            *y += part * g;
        }
    }

    /// Sets the entries of prescribed unknowns to zero.
    pub fn constrain(&mut self, prescribed: &[bool]) {
        for (g, prescribed) in self.vector.iter_mut().zip(prescribed) {
            if *prescribed {
                *g = 0.0;
            }
        }
    }
}

impl RankOneFactor {
    /// Adds the term to a factored matrix.
    ///
    /// # Errors
    ///
    /// If the sum is singular.
    pub fn new(matrix: CoupledFactor, term: RankOne) -> Result<Self, Singular> {
        let mut solution = term.vector.clone();
        matrix.solve(&mut solution);
        let denominator = 1.0 + term.factor * dot(&term.vector, &solution);
        if denominator == 0.0 || !denominator.is_finite() {
            return Err(Singular { unknown: 0 });
        }
        Ok(Self {
            matrix,
            term,
            solution,
            denominator,
        })
    }

    /// Returns the number of negative eigenvalues.
    pub fn negative_pivots(&self) -> usize {
        let removed = usize::from(self.denominator < 0.0);
        self.matrix.negative_pivots().saturating_sub(removed)
    }

    /// Solves in place.
    pub fn solve(&self, b: &mut [f64]) {
        self.matrix.solve(b);
        self.correct(b);
    }

    /// Solves for two right-hand sides at once.
    pub fn solve_pair(&self, [a, b]: [&mut [f64]; 2]) {
        self.matrix.solve_pair([&mut *a, &mut *b]);
        self.correct(a);
        self.correct(b);
    }

    fn correct(&self, x: &mut [f64]) {
        let part = self.term.factor * dot(&self.term.vector, x) / self.denominator;
        for (x, w) in x.iter_mut().zip(&self.solution) {
            *x -= part * w;
        }
    }

    /// Replaces the pivots of the matrix by their size, unless the sum is positive definite already.
    pub fn make_positive(&mut self) {
        if self.negative_pivots() == 0 {
            return;
        }
        self.matrix.make_positive();
        self.solution.clone_from(&self.term.vector);
        self.matrix.solve(&mut self.solution);
        self.denominator = 1.0 + self.term.factor * dot(&self.term.vector, &self.solution);
    }

    /// Returns the factored matrix without the term.
    pub fn into_matrix(self) -> CoupledFactor {
        self.matrix
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::super::{BlockBanded, CoupledBanded};
    use super::*;

    /// Returns a matrix of a chain of springs of stiffness 1, held at one end, less `shift`, with a term on all unknowns.
    fn chain(shift: f64, factor: f64) -> CoupledBanded {
        let n = 6;
        let mut band = BlockBanded::zeros(n, 1, 1);
        for i in 0..n {
            let diagonal = if i + 1 < n { 2.0 } else { 1.0 };
            band.add_at(i, 0, 0, 0, diagonal - shift);
            if i + 1 < n {
                band.add_at(i, 1, 0, 0, -1.0);
            }
        }
        let mut matrix = CoupledBanded::from(band);
        let vector = (0..n).map(|i| (i as f64 + 1.0).sqrt()).collect();
        matrix.term = Some(RankOne { factor, vector });
        matrix
    }

    #[test]
    fn solutions_and_inertia_are_those_of_the_sum() {
        // The lowest eigenvalue of the chain is 0.058, the next 0.50; the term raises the lowest.
        for (shift, factor, negative) in [
            (0.0, 2.0, 0),
            (0.1, 2.0, 0),
            (0.1, 1e-4, 1),
            (0.6, 2.0, 1),
            (0.6, 1e-4, 2),
        ] {
            let matrix = chain(shift, factor);
            let x: Vec<f64> = (0..6).map(|i| (1.3 * i as f64).sin() + 0.2).collect();
            let mut b = vec![0.0; 6];
            matrix.multiply_add(1.0, &x, &mut b);
            let mut factored = matrix.factor().unwrap();
            assert_eq!(factored.negative_pivots(), negative, "{shift} {factor}");
            let mut other = b.clone();
            factored.solve(&mut b);
            for (a, b) in b.iter().zip(&x) {
                assert!((a - b).abs() < 1e-10, "{a} {b}");
            }
            factored.make_positive();
            let right = other.clone();
            factored.solve(&mut other);
            assert!(dot(&right, &other) > 0.0);
        }
    }

    #[test]
    fn a_prescribed_unknown_has_no_part_in_the_term() {
        let mut matrix = chain(0.1, 2.0);
        let prescribed = [false, false, true, false, false, false];
        matrix.constrain(&prescribed);
        let mut b = vec![0.0, 0.0, 3.0, 0.0, 0.0, 0.0];
        matrix.factor().unwrap().solve(&mut b);
        assert_eq!(b, [0.0, 0.0, 3.0, 0.0, 0.0, 0.0]);
    }
}
