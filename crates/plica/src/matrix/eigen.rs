//! The lowest eigenpairs of A x = λ B x, by shift and invert.
//!
//! Lanczos's method on (A − σB)⁻¹ B, which is self-adjoint in the product x · B y and turns the
//! eigenvalues next above σ into its largest, θ = 1/(λ − σ) (Ericsson and Ruhe 1980). σ lies below
//! all eigenvalues: zero, or further down until the inertia of A − σB shows no negative one. In the
//! end the inertia of A − τB, with τ just below the last pair, says whether a pair below it was
//! missed.

use super::block_banded::{BlockBanded, Factor};
use super::dense::symmetric_eigen;

/// Lanczos vectors at most.
const LONGEST: usize = 160;
/// New vectors between two looks at what has converged.
const BETWEEN: usize = 6;
/// Residual of a converged pair, relative to θ.
const CONVERGED: f64 = 1e-10;
/// How far apart eigenvalues are that rounding lets inertias tell, over the mean of all.
const ROUNDING: f64 = 1e-13;
/// Starting vectors that are tried; each adds what those before missed (all but one of several
/// equal eigenvalues, for one).
const STARTS: u64 = 3;

/// An eigenvalue and its vector.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// λ.
    pub value: f64,
    /// x, with x · B x = 1 and zero where an unknown is given.
    pub vector: Vec<f64>,
}

/// The eigenpairs could not be found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the lowest {count} eigenvalue(s) could not be found")]
pub struct NoEigenpairs {
    /// How many were looked for.
    pub count: usize,
}

/// The `count` lowest eigenpairs of A x = λ B x over the unknowns that are not `given`, rising; B
/// is positive definite. Fewer if there are not so many unknowns.
///
/// # Errors
/// [`NoEigenpairs`] if none of three starting vectors leads to pairs below which the inertia shows
/// no other, or the matrices are not finite.
pub fn lowest_eigenpairs(
    a: &BlockBanded,
    b: &BlockBanded,
    given: &[bool],
    count: usize,
) -> Result<Vec<Eigenpair>, NoEigenpairs> {
    lowest_eigenpairs_beside(a, b, given, count, &[])
}

/// The same of the eigenpairs beside some that are known: `beside` holds independent vectors x with
/// A x = 0, such as rigid motions.
///
/// # Errors
/// Those of [`lowest_eigenpairs`].
pub fn lowest_eigenpairs_beside(
    a: &BlockBanded,
    b: &BlockBanded,
    given: &[bool],
    count: usize,
    beside: &[Vec<f64>],
) -> Result<Vec<Eigenpair>, NoEigenpairs> {
    let failed = NoEigenpairs { count };
    let pencil = Pencil { a, b, given };
    let beside = pencil.orthonormal(beside);
    let free = given.iter().filter(|given| !**given).count() - beside.len();
    let count = count.min(free);
    let (shift, factor) = pencil.below_all(!beside.is_empty()).ok_or(failed)?;
    let mut found: Vec<Eigenpair> = vec![];
    for start in 0..STARTS {
        let more = count.min(free - found.len());
        let known = [&beside[..], &found].concat();
        found.extend(
            pencil
                .lanczos(shift, &factor, more, start, &known)
                .unwrap_or_default(),
        );
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        let known = [&beside[..], &found[..count.min(found.len())]].concat();
        if found.len() >= count && pencil.none_is_missed(shift, &known, found.get(count - 1)) {
            found.truncate(count);
            return Ok(found);
        }
    }
    Err(failed)
}

struct Pencil<'a> {
    a: &'a BlockBanded,
    b: &'a BlockBanded,
    given: &'a [bool],
}

impl Pencil<'_> {
    /// A − σB on the free unknowns, factored.
    fn factor(&self, shift: f64) -> Option<Factor> {
        let mut shifted = self.a.clone();
        if shift != 0.0 {
            shifted.add_scaled(-shift, self.b);
        }
        shifted.constrain(self.given);
        shifted.factor().ok()
    }

    /// A shift below all eigenvalues; zero if that will do and is no eigenvalue.
    fn below_all(&self, singular: bool) -> Option<(f64, Factor)> {
        let negative = |factor: &Factor| factor.negative_pivots();
        let at_zero = || self.factor(0.0).filter(|factor| negative(factor) == 0);
        if let Some(factor) = (!singular).then(at_zero).flatten() {
            return Some((0.0, factor));
        }
        // Down in strides that grow, from one that is small beside the eigenvalues' mean.
        let mean = self.mean();
        let strides = (0..60).map(|n| -1e-9 * mean * 4_f64.powi(n));
        for shift in strides.filter(|shift| shift.is_finite() && *shift < 0.0) {
            if let Some(factor) = self.factor(shift).filter(|factor| negative(factor) == 0) {
                return Some((shift, factor));
            }
        }
        None
    }

    /// Vectors with A x = 0, made orthonormal in B.
    fn orthonormal(&self, vectors: &[Vec<f64>]) -> Vec<Eigenpair> {
        let mut pairs: Vec<Eigenpair> = vec![];
        for vector in vectors {
            let mut vector = vector.clone();
            for pair in &pairs {
                take_part(&mut vector, &pair.vector, &self.weigh(&pair.vector));
            }
            let norm = dot(&vector, &self.weigh(&vector)).sqrt();
            vector.iter_mut().for_each(|x| *x /= norm);
            pairs.push(Eigenpair { value: 0.0, vector });
        }
        pairs
    }

    /// The size of the eigenvalues, on the average.
    fn mean(&self) -> f64 {
        let diagonal = |m: &BlockBanded| -> f64 {
            let free = (0..m.unknowns()).filter(|&i| !self.given[i]);
            free.map(|i| m.entry(i, i)).sum()
        };
        (diagonal(self.a) / diagonal(self.b)).abs()
    }

    /// B x on the free unknowns.
    fn weigh(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.b.multiply_add(1.0, x, &mut y);
        for (y, given) in y.iter_mut().zip(self.given) {
            if *given {
                *y = 0.0;
            }
        }
        y
    }

    /// The pairs next above the shift, the known ones aside; none if they do not converge.
    fn lanczos(
        &self,
        shift: f64,
        factor: &Factor,
        count: usize,
        start: u64,
        known: &[Eigenpair],
    ) -> Option<Vec<Eigenpair>> {
        // Vectors q, their weights Bq, and the tridiagonal matrix of the operator between them.
        let (mut q, mut weights): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (vec![], vec![]);
        let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
        let known: Vec<(&Vec<f64>, Vec<f64>)> = known
            .iter()
            .map(|pair| (&pair.vector, self.weigh(&pair.vector)))
            .collect();
        let free = self.given.iter().filter(|given| !**given).count() - known.len();
        let mut next = self.noise(start);
        for (vector, weight) in &known {
            take_part(&mut next, vector, weight);
        }
        loop {
            let mut weight = self.weigh(&next);
            let norm = dot(&next, &weight).sqrt();
            // Nothing is left: what there is spans an invariant space.
            let ended = q.len() == free || norm <= 1e-13 * alpha.first().map_or(0.0, |a| a.abs());
            let full = q.len() == LONGEST.min(free) || ended;
            let look = q.len() >= count && (full || q.len().is_multiple_of(BETWEEN));
            if look {
                let left = if ended { 0.0 } else { norm };
                if let Some(pairs) = self.ritz(shift, count, &q, &alpha, &beta, left) {
                    return Some(pairs);
                }
            }
            if full || norm.is_nan() || norm == 0.0 {
                return None;
            }
            if !q.is_empty() {
                beta.push(norm);
            }
            for (x, w) in next.iter_mut().zip(&mut weight) {
                (*x, *w) = (*x / norm, *w / norm);
            }
            let mut image = weight.clone();
            factor.solve(&mut image);
            alpha.push(dot(&image, &weight));
            q.push(std::mem::take(&mut next));
            weights.push(weight);
            // Against all vectors, twice: rounding would let converged ones back in.
            for _ in 0..2 {
                for (vector, weight) in &known {
                    take_part(&mut image, vector, weight);
                }
                for (vector, weight) in q.iter().zip(&weights) {
                    take_part(&mut image, vector, weight);
                }
            }
            next = image;
        }
    }

    /// The pairs of the tridiagonal matrix, if the largest `count` have converged.
    fn ritz(
        &self,
        shift: f64,
        count: usize,
        q: &[Vec<f64>],
        alpha: &[f64],
        beta: &[f64],
        left: f64,
    ) -> Option<Vec<Eigenpair>> {
        let size = alpha.len();
        let (theta, vectors) = symmetric_eigen(size, |i, j| match i.abs_diff(j) {
            0 => alpha[i],
            1 => beta[i.min(j)],
            _ => 0.0,
        })?;
        let mut pairs = vec![];
        for (theta, s) in theta.iter().zip(&vectors).rev().take(count) {
            if *theta <= 0.0 || left * s[size - 1].abs() > CONVERGED * theta {
                return None;
            }
            let mut vector = vec![0.0; self.given.len()];
            for (q, s) in q.iter().zip(s) {
                for (x, q) in vector.iter_mut().zip(q) {
                    *x += s * q;
                }
            }
            pairs.push(Eigenpair {
                value: shift + 1.0 / theta,
                vector,
            });
        }
        Some(pairs)
    }

    /// Whether as many eigenvalues lie below the last pair as are known there.
    fn none_is_missed(&self, shift: f64, pairs: &[Eigenpair], last: Option<&Eigenpair>) -> bool {
        let Some(last) = last else {
            return true;
        };
        let apart = (1e-6 * (last.value - shift)).max(ROUNDING * self.mean());
        let below = last.value - apart;
        let found = pairs.iter().filter(|pair| pair.value < below).count();
        self.factor(below)
            .is_some_and(|factor| factor.negative_pivots() == found)
    }

    /// A vector without a pattern, zero where an unknown is given; always the same one.
    fn noise(&self, start: u64) -> Vec<f64> {
        let mut state = start + 1;
        let mut number = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        let given = self.given.iter();
        given
            .map(|given| if *given { 0.0 } else { number() })
            .collect()
    }
}

/// Takes the part along a vector q off x, by its weight Bq.
fn take_part(x: &mut [f64], vector: &[f64], weight: &[f64]) {
    let part = dot(x, weight);
    for (x, q) in x.iter_mut().zip(vector) {
        *x -= part * q;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of 40 unit masses in pairs between springs, its ends held by springs too, with
    /// `shift` taken off its diagonal: λ_k = 4 sin²(kπ/82) − shift.
    fn chain(shift: f64) -> (BlockBanded, BlockBanded) {
        let (mut a, mut b) = (BlockBanded::zeros(20, 2, 1), BlockBanded::zeros(20, 2, 1));
        let [first, coupled, second, on] = [(0, 0, 0), (0, 1, 0), (0, 1, 1), (1, 0, 1)]
            .map(|(d, row, column)| a.place(d, row, column));
        for (j, panel) in a.panels_mut().enumerate() {
            (panel[first], panel[second]) = (2.0 - shift, 2.0 - shift);
            panel[coupled] = -1.0;
            if j < 19 {
                panel[on] = -1.0;
            }
        }
        for panel in b.panels_mut() {
            (panel[first], panel[second]) = (1.0, 1.0);
        }
        (a, b)
    }

    fn eigenvalue(k: usize, masses: usize) -> f64 {
        let angle = k as f64 * std::f64::consts::PI / (2 * masses + 2) as f64;
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn a_chain_of_masses_has_its_frequencies() {
        // All positive, some negative, one zero to rounding.
        for shift in [0.0, 0.31, eigenvalue(3, 40)] {
            let (a, b) = chain(shift);
            let pairs = lowest_eigenpairs(&a, &b, &[false; 40], 6).unwrap();
            assert_eq!(pairs.len(), 6);
            for (k, pair) in (1..).zip(&pairs) {
                let expected = eigenvalue(k, 40) - shift;
                assert!(
                    (pair.value - expected).abs() < 1e-12,
                    "{shift}, {k}: {}",
                    pair.value
                );
                let mut residual = vec![0.0; 40];
                a.multiply_add(1.0, &pair.vector, &mut residual);
                b.multiply_add(-pair.value, &pair.vector, &mut residual);
                assert!(dot(&residual, &residual).sqrt() < 1e-8);
            }
        }
    }

    #[test]
    fn given_unknowns_stay_where_they_are() {
        // Held in the middle the chain falls into two of 19 and 20 masses.
        let (a, b) = chain(0.0);
        let given: Vec<bool> = (0..40).map(|i| i == 19).collect();
        let pairs = lowest_eigenpairs(&a, &b, &given, 2).unwrap();
        for (pair, masses) in pairs.iter().zip([20, 19]) {
            assert!((pair.value - eigenvalue(1, masses)).abs() < 1e-12);
            assert_eq!(pair.vector[19], 0.0);
        }
    }

    #[test]
    fn a_pair_that_occurs_twice_is_found_twice() {
        // Held at both sides of its middle: two chains of 19.
        let (a, b) = chain(0.1);
        let given: Vec<bool> = (0..40).map(|i| i == 19 || i == 20).collect();
        let found = lowest_eigenpairs(&a, &b, &given, 2);
        let value = eigenvalue(1, 19) - 0.1;
        let values: Vec<f64> = found.unwrap().iter().map(|pair| pair.value).collect();
        assert!(
            values.iter().all(|v| (v - value).abs() < 1e-10),
            "{values:?}"
        );
    }

    #[test]
    fn matrices_that_are_not_finite_are_an_error() {
        let (mut a, b) = chain(0.0);
        a.add_scaled(f64::NAN, &b);
        assert!(lowest_eigenpairs(&a, &b, &[false; 40], 1).is_err());
    }
}
