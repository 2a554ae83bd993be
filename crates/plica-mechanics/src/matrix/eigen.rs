//! The lowest eigenpairs of A x = λ B x, by shift-and-invert Lanczos (Ericsson and Ruhe 1980).
//!
//! The operator (A − σB)⁻¹ B is self-adjoint in the product x · B y, and maps the eigenvalues next above
//! σ to its largest, θ = 1/(λ − σ). The shift σ lies below all eigenvalues: it is zero, or lower until
//! the inertia of A − σB shows no negative one. Finally, the inertia of A − τB, with τ just below the
//! last pair, shows whether a lower pair was missed.

use super::dense::symmetric_eigen;
use super::{BlockBanded, CoupledBanded, CoupledFactor};

/// Largest number of Lanczos vectors.
const LANCZOS_VECTORS: usize = 160;
/// Lanczos vectors between two tests of convergence.
const TEST_INTERVAL: usize = 6;
/// Residual of a converged pair, relative to θ.
const CONVERGED: f64 = 1e-10;
/// Distance of eigenvalues that inertias resolve in spite of rounding, relative to their mean size.
const ROUNDING: f64 = 1e-13;
/// Number of starting vectors. Each finds pairs that the previous ones missed, such as further ones of
/// a multiple eigenvalue.
const STARTS: u64 = 3;

/// An eigenvalue and its vector.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpair {
    /// λ.
    pub value: f64,
    /// x, with x · B x = 1 and zeros for prescribed unknowns.
    pub vector: Vec<f64>,
}

/// The eigenpairs could not be found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the lowest {count} eigenvalue(s) could not be found")]
pub struct NoEigenpairs {
    /// Number of pairs that were requested.
    pub count: usize,
}

/// Returns the `count` lowest eigenpairs of A x = λ B x on the unknowns that are not prescribed, the
/// lowest first; B must be positive definite. Returns fewer if there are fewer unknowns.
///
/// # Errors
/// [`NoEigenpairs`] if pairs are still missing after three starting vectors, or the matrices are not
/// finite.
pub fn lowest_eigenpairs(
    a: &CoupledBanded,
    b: &BlockBanded,
    prescribed: &[bool],
    count: usize,
) -> Result<Vec<Eigenpair>, NoEigenpairs> {
    lowest_eigenpairs_excluding(a, b, prescribed, count, &[])
}

/// Does the same with the exception of known eigenpairs: `null_vectors` are independent vectors x with
/// A x = 0, such as rigid-body motions.
///
/// # Errors
/// Those of [`lowest_eigenpairs`].
pub fn lowest_eigenpairs_excluding(
    a: &CoupledBanded,
    b: &BlockBanded,
    prescribed: &[bool],
    count: usize,
    null_vectors: &[Vec<f64>],
) -> Result<Vec<Eigenpair>, NoEigenpairs> {
    let failed = NoEigenpairs { count };
    let pencil = Pencil { a, b, prescribed };
    let excluded = pencil.orthonormal(null_vectors);
    let free = prescribed.iter().filter(|prescribed| !**prescribed).count() - excluded.len();
    let count = count.min(free);
    let (shift, factor) = pencil.below_all(!excluded.is_empty()).ok_or(failed)?;
    let mut found: Vec<Eigenpair> = vec![];
    for start in 0..STARTS {
        let more = count.min(free - found.len());
        let known = [&excluded[..], &found].concat();
        found.extend(
            pencil
                .lanczos(shift, &factor, more, start, &known)
                .unwrap_or_default(),
        );
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        let known = [&excluded[..], &found[..count.min(found.len())]].concat();
        if found.len() >= count && pencil.none_is_missed(shift, &known, found.get(count - 1)) {
            found.truncate(count);
            return Ok(found);
        }
    }
    Err(failed)
}

struct Pencil<'a> {
    a: &'a CoupledBanded,
    b: &'a BlockBanded,
    prescribed: &'a [bool],
}

impl Pencil<'_> {
    /// A − σB on the free unknowns, factored.
    fn factor(&self, shift: f64) -> Option<CoupledFactor> {
        let mut shifted = self.a.clone();
        if shift != 0.0 {
            shifted.add_scaled(-shift, self.b);
        }
        shifted.constrain(self.prescribed);
        shifted.factor().ok()
    }

    /// Returns a shift below all eigenvalues, zero if possible, and the factored A − σB.
    fn below_all(&self, singular: bool) -> Option<(f64, CoupledFactor)> {
        let negative = |factor: &CoupledFactor| factor.negative_pivots();
        let at_zero = || self.factor(0.0).filter(|factor| negative(factor) == 0);
        if let Some(factor) = (!singular).then(at_zero).flatten() {
            return Some((0.0, factor));
        }
        // Growing negative shifts, the first of them small compared with the mean eigenvalue.
        let mean = self.mean();
        let shifts = (0..60).map(|n| -1e-9 * mean * 4_f64.powi(n));
        for shift in shifts.filter(|shift| shift.is_finite() && *shift < 0.0) {
            if let Some(factor) = self.factor(shift).filter(|factor| negative(factor) == 0) {
                return Some((shift, factor));
            }
        }
        None
    }

    /// Returns pairs of eigenvalue 0 whose vectors are orthonormal in B.
    fn orthonormal(&self, vectors: &[Vec<f64>]) -> Vec<Eigenpair> {
        let mut pairs: Vec<Eigenpair> = vec![];
        for vector in vectors {
            let mut vector = vector.clone();
            for pair in &pairs {
                orthogonalise(&mut vector, &pair.vector, &self.times_b(&pair.vector));
            }
            let norm = dot(&vector, &self.times_b(&vector)).sqrt();
            vector.iter_mut().for_each(|x| *x /= norm);
            pairs.push(Eigenpair { value: 0.0, vector });
        }
        pairs
    }

    /// Returns the mean size of the eigenvalues.
    fn mean(&self) -> f64 {
        let diagonal = |m: &BlockBanded| -> f64 {
            let free = (0..m.unknowns()).filter(|&i| !self.prescribed[i]);
            free.map(|i| m.entry(i, i)).sum()
        };
        (diagonal(&self.a.band) / diagonal(self.b)).abs()
    }

    /// Returns B x on the free unknowns.
    fn times_b(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        self.b.multiply_add(1.0, x, &mut y);
        for (y, prescribed) in y.iter_mut().zip(self.prescribed) {
            if *prescribed {
                *y = 0.0;
            }
        }
        y
    }

    /// Returns the pairs next above the shift, without the known ones; None if they do not converge.
    fn lanczos(
        &self,
        shift: f64,
        factor: &CoupledFactor,
        count: usize,
        start: u64,
        known: &[Eigenpair],
    ) -> Option<Vec<Eigenpair>> {
        // Lanczos vectors q, Bq, and the tridiagonal matrix of the operator.
        let (mut q, mut products): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (vec![], vec![]);
        let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
        let known: Vec<(&Vec<f64>, Vec<f64>)> = known
            .iter()
            .map(|pair| (&pair.vector, self.times_b(&pair.vector)))
            .collect();
        let free = self
            .prescribed
            .iter()
            .filter(|prescribed| !**prescribed)
            .count()
            - known.len();
        let mut next = self.noise(start);
        for (vector, product) in &known {
            orthogonalise(&mut next, vector, product);
        }
        loop {
            let mut product = self.times_b(&next);
            let norm = dot(&next, &product).sqrt();
            // The vectors span an invariant subspace.
            let ended = q.len() == free || norm <= 1e-13 * alpha.first().map_or(0.0, |a| a.abs());
            let full = q.len() == LANCZOS_VECTORS.min(free) || ended;
            let test = q.len() >= count && (full || q.len().is_multiple_of(TEST_INTERVAL));
            if test {
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
            for (x, w) in next.iter_mut().zip(&mut product) {
                (*x, *w) = (*x / norm, *w / norm);
            }
            let mut image = product.clone();
            factor.solve(&mut image);
            alpha.push(dot(&image, &product));
            q.push(std::mem::take(&mut next));
            products.push(product);
            // Reorthogonalise, twice because of rounding, so that converged vectors do not come back.
            for _ in 0..2 {
                for (vector, product) in &known {
                    orthogonalise(&mut image, vector, product);
                }
                for (vector, product) in q.iter().zip(&products) {
                    orthogonalise(&mut image, vector, product);
                }
            }
            next = image;
        }
    }

    /// Returns the pairs of the tridiagonal matrix if the `count` largest have converged.
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
            let mut vector = vec![0.0; self.prescribed.len()];
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

    /// Returns whether as many eigenvalues lie below the last pair as are known.
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

    /// Returns a pseudo-random vector with zeros for prescribed unknowns, always the same for a start.
    fn noise(&self, start: u64) -> Vec<f64> {
        let mut state = start + 1;
        let mut number = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
        };
        let prescribed = self.prescribed.iter();
        prescribed
            .map(|prescribed| if *prescribed { 0.0 } else { number() })
            .collect()
    }
}

/// Makes x orthogonal in B to a unit vector q with the product Bq.
fn orthogonalise(x: &mut [f64], vector: &[f64], product: &[f64]) {
    let part = dot(x, product);
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

    /// A chain of 40 unit masses between 41 unit springs, in blocks of two, with `shift` subtracted from
    /// its diagonal: λ_k = 4 sin²(kπ/82) − shift.
    fn chain(shift: f64) -> (CoupledBanded, BlockBanded) {
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
        (a.into(), b)
    }

    fn eigenvalue(k: usize, masses: usize) -> f64 {
        let angle = k as f64 * std::f64::consts::PI / (2 * masses + 2) as f64;
        4.0 * angle.sin().powi(2)
    }

    #[test]
    fn a_chain_of_masses_has_its_known_eigenvalues() {
        // All are positive, some negative, one zero up to rounding.
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
    fn a_spring_between_the_ends_closes_the_chain_to_a_ring() {
        // λ = 4 sin²(kπ/40) of a ring of 40 masses, each but the first and the last twice.
        let (mut a, b) = chain(0.05);
        a.add_at(39, 0, -1.0);
        assert!(!a.far.is_empty());
        let pairs = lowest_eigenpairs(&a, &b, &[false; 40], 5).unwrap();
        for (k, pair) in [0, 1, 1, 2, 2].iter().zip(&pairs) {
            let expected = 4.0 * (f64::from(*k) * std::f64::consts::PI / 40.0).sin().powi(2) - 0.05;
            assert!((pair.value - expected).abs() < 1e-11, "{k}: {}", pair.value);
        }
        let prescribed: Vec<bool> = (0..40).map(|i| i == 39).collect();
        let fixed = lowest_eigenpairs(&a, &b, &prescribed, 1).unwrap()[0].value;
        assert!((fixed + 0.05 - eigenvalue(1, 39)).abs() < 1e-11, "{fixed}");
    }

    #[test]
    fn prescribed_unknowns_are_zero_in_eigenvectors() {
        // A fixed mass in the middle divides the chain into two of 19 and 20 masses.
        let (a, b) = chain(0.0);
        let prescribed: Vec<bool> = (0..40).map(|i| i == 19).collect();
        let pairs = lowest_eigenpairs(&a, &b, &prescribed, 2).unwrap();
        for (pair, masses) in pairs.iter().zip([20, 19]) {
            assert!((pair.value - eigenvalue(1, masses)).abs() < 1e-12);
            assert_eq!(pair.vector[19], 0.0);
        }
    }

    #[test]
    fn a_double_eigenvalue_is_found_twice() {
        // Two fixed masses in the middle divide the chain into two of 19.
        let (a, b) = chain(0.1);
        let prescribed: Vec<bool> = (0..40).map(|i| i == 19 || i == 20).collect();
        let found = lowest_eigenpairs(&a, &b, &prescribed, 2);
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
