//! The lowest eigenpairs of A x = ν C x, by LOBPCG: locally optimal, block, preconditioned
//! conjugate gradients (Knyazev 2001).
//!
//! Each iteration finds the best block X within the span of three: X itself, the preconditioned
//! residuals W = M⁻¹ (A X − C X ν), and P, the last change of X. For robustness it follows Hetmaniuk and
//! Lehoucq (2006) and Duersch et al. (2018): W is made orthogonal to X beforehand, P to X through the
//! coefficients, and the basis is orthonormalised by the eigenvectors of its Gram matrix, without those
//! that are due to rounding.
//!
//! | letter | meaning |
//! |---|---|
//! | ν | eigenvalues, the lowest first |
//! | X, W, P | blocks of vectors, orthonormal in C where it matters |
//! | S | the basis (X, W, P) |
//! | δ | error bound of an eigenvalue |

use super::operator::{Operator, add, dot, project};
use crate::matrix::TallMatrix;
use crate::monitor::Monitor;

/// Eigenvalues of a basis's Gram matrix, scaled to a unit diagonal and relative to the largest, below
/// which their directions are due to rounding.
const DEPENDENT: f64 = 1e-10;
/// Iterations after which A X and C X are computed anew instead of combined.
const REFRESH: usize = 25;
/// Distance of the lowest Ritz value above a value, in error bounds, at which its side is certain. The
/// bound is exact for M = A only, and does not include eigenvectors that are hardly present yet: with 2,
/// and M from the undeformed tube, tubes that had just become unstable were found to be stable.
const CERTAIN: f64 = 10.0;
/// Residuals are relative to at least this fraction of the largest wanted eigenvalue.
const NEAR_ZERO: f64 = 1e-2;

/// The eigenpairs to search for, and the criteria for stopping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Number of eigenvalues, at most the number of seeds.
    pub wanted: usize,
    /// Largest relative residual of a converged eigenpair. (The relative error of the eigenvalue is
    /// about its square.)
    pub accuracy: f64,
    /// Largest number of iterations.
    pub iterations: usize,
    /// If given, the search ends as soon as it is certain on which side of this value the lowest
    /// eigenvalue lies.
    pub side_of: Option<f64>,
}

/// The lowest eigenpairs, as far as they have converged.
#[derive(Clone, Debug)]
pub struct Lowest {
    /// Eigenvalues ν, the lowest first, as many as there were independent seeds. They are Rayleigh
    /// quotients, so the lowest eigenvalue is at most the first.
    pub values: Vec<f64>,
    /// Eigenvectors x of all unknowns, with x · C x = 1.
    pub vectors: Vec<Vec<f64>>,
    /// Error bounds δ: at least one eigenvalue lies within this distance.
    pub errors: Vec<f64>,
    /// Relative residuals (r · M⁻¹ r/s)^½ with r = A x − ν C x and s = |ν|, but at least a hundredth of
    /// the largest wanted eigenvalue. The error of an eigenvalue is about their square times s.
    pub residuals: Vec<f64>,
    /// Iterations; each applies A, M⁻¹ and C once to every vector that has not converged.
    pub iterations: usize,
}

impl Lowest {
    /// Returns whether the lowest eigenvalue is below a value; None if that is not certain. A Rayleigh
    /// quotient below proves it. The opposite is as certain as that the seeds contain every
    /// eigenvector, and requires it of all pairs: a seed that happens to be an eigenvector has no error,
    /// and a lower eigenvalue shows in the others.
    pub fn is_below(&self, value: f64) -> Option<bool> {
        let certain = |(found, error): (&f64, &f64)| found - value > CERTAIN * error;
        if *self.values.first()? < value {
            Some(true)
        } else if self.values.iter().zip(&self.errors).all(certain) {
            Some(false)
        } else {
            None
        }
    }

    /// Computes error bounds and residuals from r · M⁻¹ r.
    fn measure(&mut self, squares: &[f64], wanted: usize) {
        let wanted = self.values.iter().take(wanted);
        let near_zero = NEAR_ZERO * wanted.fold(0.0, |most: f64, value| most.max(value.abs()));
        let pairs = || self.values.iter().zip(squares);
        self.errors = pairs().map(|(v, q)| (v.abs() * q).sqrt()).collect();
        self.residuals = pairs()
            .map(|(v, q)| (q / v.abs().max(near_zero)).sqrt())
            .collect();
    }
}

/// Finds the lowest eigenpairs of A x = ν C x on the free unknowns, from seeds: vectors that together
/// contain every eigenvector of interest, however little of it. More seeds than wanted eigenvalues help
/// where the lowest lie close together.
///
/// The error bound of a pair is δ² = |ν| r · M⁻¹ r with r = A x − ν C x: with x = Σ c v over
/// eigenvectors and Σ c² = 1, r · A⁻¹ r = Σ c² (νᵢ − ν)²/νᵢ, so some νᵢ has |νᵢ − ν| ≤ (νᵢ r · A⁻¹ r)^½.
/// It costs nothing, and does not depend on the mesh.
///
/// The search reports every iteration, and ends with what it has when the monitor cancels.
pub fn lowest<O: Operator>(
    operator: &O,
    seeds: &[Vec<f64>],
    search: &Search,
    monitor: &mut dyn Monitor,
) -> Lowest {
    let mut found = Lowest {
        values: vec![],
        vectors: vec![],
        errors: vec![],
        residuals: vec![],
        iterations: 0,
    };
    let Some(start) = Basis::of_seeds(operator, seeds) else {
        return found;
    };
    let Some(ritz) = Ritz::of(&start, seeds.len()) else {
        return found;
    };
    let mut x = start.times(&ritz.coefficients);
    found.values = ritz.values;
    let mut p: Option<Basis> = None;
    loop {
        let (squares, corrections) = corrections(operator, &x, &found.values);
        found.measure(&squares, search.wanted);
        let open: Vec<usize> = (0..found.values.len())
            .filter(|&j| found.residuals[j] > search.accuracy)
            .collect();
        let all = open.iter().all(|&j| j >= search.wanted);
        let decided = |value| found.is_below(value).is_some();
        if open.is_empty()
            || (all && search.side_of.is_none())
            || search.side_of.is_some_and(decided)
            || found.iterations == search.iterations
        {
            break;
        }
        report(&found, search, monitor);
        if monitor.is_cancelled() {
            break;
        }
        let mut basis = x.clone();
        basis.append(&Basis::of(operator, x.without(corrections.select(&open))));
        if let Some(p) = &p {
            basis.append(&p.select(&open));
        }
        let Some(ritz) = Ritz::of(&basis, found.values.len()) else {
            break; // NaN
        };
        found.iterations += 1;
        x = basis.times(&ritz.coefficients);
        p = Some(basis.times(&ritz.changes));
        // The basis contains the previous vectors, so only rounding can raise a value.
        let risen = ritz.values[0] > found.values[0] + DEPENDENT * found.values[0].abs();
        found.values = ritz.values;
        if risen || found.iterations.is_multiple_of(REFRESH) {
            x = Basis::of(operator, x.vectors);
            p = p.filter(|_| !risen);
        }
    }
    found.vectors = (0..found.values.len())
        .map(|j| x.vectors.column(j).to_vec())
        .collect();
    found
}

fn report(found: &Lowest, search: &Search, monitor: &mut dyn Monitor) {
    let residuals = found.residuals.iter().take(search.wanted);
    let activity = format_args!(
        "{} iterations, lowest eigenvalue {:.3e}, residual {:.0e}",
        found.iterations,
        found.values[0],
        residuals.fold(0.0, |most: f64, r| most.max(*r)),
    );
    monitor.working(&activity, 0.0);
}

/// Returns r · M⁻¹ r and M⁻¹ r of eigenpairs.
fn corrections<O: Operator>(operator: &O, x: &Basis, values: &[f64]) -> (Vec<f64>, TallMatrix) {
    let (mut squares, mut corrections) = (vec![], TallMatrix::new(x.vectors.rows()));
    let mut z = vec![0.0; x.vectors.rows()];
    for (j, &value) in values.iter().enumerate() {
        let mut r = x.applied.column(j).to_vec();
        add(-value, x.measured.column(j), &mut r);
        operator.precondition(&r, &mut z);
        project(operator, &mut z);
        squares.push(dot(&r, &z).max(0.0));
        corrections.push(&z);
    }
    (squares, corrections)
}

/// Vectors S with A S and C S.
#[derive(Clone, Debug)]
struct Basis {
    vectors: TallMatrix,
    applied: TallMatrix,
    measured: TallMatrix,
}

impl Basis {
    fn of<O: Operator>(operator: &O, vectors: TallMatrix) -> Self {
        let image = |apply: &dyn Fn(&[f64], &mut [f64])| {
            let mut images = vectors.clone();
            for j in 0..vectors.columns() {
                apply(vectors.column(j), images.column_mut(j));
                project(operator, images.column_mut(j));
            }
            images
        };
        Self {
            applied: image(&|v, out| operator.apply(v, out)),
            measured: image(&|v, out| operator.metric(v, out)),
            vectors,
        }
    }

    fn of_seeds<O: Operator>(operator: &O, seeds: &[Vec<f64>]) -> Option<Self> {
        let mut vectors = TallMatrix::new(seeds.first()?.len());
        for seed in seeds {
            let mut seed = seed.clone();
            project(operator, &mut seed);
            vectors.push(&seed);
        }
        Some(Self::of(operator, vectors))
    }

    fn times(&self, coefficients: &TallMatrix) -> Self {
        Self {
            vectors: self.vectors.times(coefficients),
            applied: self.applied.times(coefficients),
            measured: self.measured.times(coefficients),
        }
    }

    fn select(&self, which: &[usize]) -> Self {
        Self {
            vectors: self.vectors.select(which),
            applied: self.applied.select(which),
            measured: self.measured.select(which),
        }
    }

    fn append(&mut self, other: &Self) {
        self.vectors.append(&other.vectors);
        self.applied.append(&other.applied);
        self.measured.append(&other.measured);
    }

    /// Projects other vectors orthogonally to these orthonormal ones: w − X Xᵀ C w, twice because of
    /// rounding.
    fn without(&self, mut others: TallMatrix) -> TallMatrix {
        for _ in 0..2 {
            let part = self.measured.gram(&others);
            self.vectors.add_product(-1.0, &part, &mut others);
        }
        others
    }
}

/// The lowest eigenpairs within the span of a basis (Rayleigh and Ritz).
struct Ritz {
    values: Vec<f64>,
    /// X = S · coefficients, orthonormal in C.
    coefficients: TallMatrix,
    /// P = S · changes: the part of X outside the first columns of the basis, orthogonal to X.
    changes: TallMatrix,
}

impl Ritz {
    /// Computes `wanted` pairs, or as many as there are independent vectors in the basis. None if there
    /// are none, or at NaN.
    fn of(basis: &Basis, wanted: usize) -> Option<Self> {
        let A = basis.vectors.gram(&basis.applied);
        let C = basis.vectors.gram(&basis.measured);
        let independent = orthonormal(&C)?;
        let inside = independent.gram(&A.times(&independent));
        let (mut values, vectors) = inside.eigen()?;
        let count = wanted.min(values.len());
        values.truncate(count);
        let chosen: Vec<usize> = (0..count).collect();
        let coefficients = independent.times(&vectors.select(&chosen));
        let mut changes = TallMatrix::from_fn(C.rows(), count, |i, j| {
            if i < count {
                0.0
            } else {
                coefficients.entry(i, j)
            }
        });
        let part = coefficients.gram(&C.times(&changes));
        coefficients.add_product(-1.0, &part, &mut changes);
        Some(Self {
            values,
            coefficients,
            changes,
        })
    }
}

/// Returns coefficients T with Tᵀ C T = 1 of all directions that are not due to rounding (Stathopoulos
/// and Wu 2002). None if there are none.
fn orthonormal(C: &TallMatrix) -> Option<TallMatrix> {
    let n = C.rows();
    let scale: Vec<f64> = (0..n)
        .map(|i| C.entry(i, i).sqrt().recip())
        .map(|scale| if scale.is_finite() { scale } else { 0.0 })
        .collect();
    let scaled = TallMatrix::from_fn(n, n, |i, j| scale[i] * C.entry(i, j) * scale[j]);
    let (sizes, directions) = scaled.eigen()?;
    let least = DEPENDENT * sizes[n - 1];
    let kept: Vec<usize> = (0..n).filter(|&j| sizes[j] > least).collect();
    (!kept.is_empty()).then(|| {
        TallMatrix::from_fn(n, kept.len(), |i, k| {
            scale[i] * directions.entry(i, kept[k]) / sizes[kept[k]].sqrt()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::reflected::Reflected;
    use super::*;

    fn seeds(n: usize, count: usize) -> Vec<Vec<f64>> {
        let seed = |k: usize| {
            (1..=n)
                .map(|i| ((i * i * (k + 1)) as f64 * 0.7).sin())
                .collect()
        };
        (0..count).map(seed).collect()
    }

    fn lowest_of(operator: &Reflected, seeds: &[Vec<f64>], search: &Search) -> Lowest {
        lowest(operator, seeds, search, &mut ())
    }

    fn search(wanted: usize) -> Search {
        Search {
            wanted,
            accuracy: 1e-5,
            iterations: 300,
            side_of: None,
        }
    }

    /// Compares pairs with the spectrum and with the eigenvalue equation.
    fn assert_lowest(operator: &Reflected, found: &Lowest, exact: &[f64]) {
        for (j, &exact) in exact.iter().enumerate() {
            let (value, error) = (found.values[j], found.errors[j]);
            assert!(
                (value - exact).abs() <= error.max(1e-13),
                "{value}, not {exact}"
            );
            assert!(
                (value - exact).abs() < 1e-8 * exact.abs(),
                "{value}, not {exact}"
            );
            let x = &found.vectors[j];
            let [mut Ax, mut Cx] = [vec![0.0; x.len()], vec![0.0; x.len()]];
            operator.apply(x, &mut Ax);
            operator.metric(x, &mut Cx);
            assert!((dot(x, &Ax) - value).abs() < 1e-8 * exact.abs());
            for (k, other) in found.vectors.iter().enumerate() {
                let one = f64::from(u8::from(k == j));
                assert!((dot(other, &Cx) - one).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_cluster_of_lowest_eigenvalues_is_resolved() {
        let mut spectrum: Vec<f64> = (0..300).map(|i| 1.0 + (i * i) as f64).collect();
        (spectrum[100], spectrum[7], spectrum[200]) = (1e-3, 1.01e-3, 1.02e-3);
        let operator = Reflected::new(&spectrum, 3.0);
        let found = lowest_of(&operator, &seeds(300, 4), &search(3));
        assert!(found.iterations < 60, "{}", found.iterations);
        assert_lowest(&operator, &found, &[1e-3, 1.01e-3, 1.02e-3]);
    }

    #[test]
    fn negative_eigenvalues_are_found() {
        let mut spectrum: Vec<f64> = (0..300).map(|i| 0.5 * (1 + i) as f64).collect();
        (spectrum[250], spectrum[3]) = (-0.2, -0.05);
        let operator = Reflected::new(&spectrum, 3.0);
        let found = lowest_of(&operator, &seeds(300, 3), &search(2));
        assert!(found.iterations < 60, "{}", found.iterations);
        assert_lowest(&operator, &found, &[-0.2, -0.05]);
    }

    #[test]
    fn seeds_that_are_eigenvectors_do_not_hide_a_negative_eigenvalue() {
        let mut spectrum: Vec<f64> = (0..300).map(|i| 0.5 * (1 + i) as f64).collect();
        (spectrum[7], spectrum[20], spectrum[250]) = (1e-3, 2e-3, -0.05);
        let operator = Reflected::new(&spectrum, 3.0);
        let of = |sought: f64| {
            let search = Search {
                wanted: 3,
                iterations: 300,
                ..search(3)
            };
            let found = lowest_of(&operator, &seeds(300, 6), &search);
            let at = found.values.iter().position(|v| (v - sought).abs() < 1e-6);
            found.vectors[at.unwrap()].clone()
        };
        let mut noise = vec![0.0; 300];
        operator.precondition(&seeds(300, 1)[0], &mut noise);
        let seeds = [of(1e-3), of(2e-3), noise];
        let side = Search {
            wanted: 1,
            side_of: Some(0.0),
            ..search(1)
        };
        let found = lowest_of(&operator, &seeds, &side);
        assert_eq!(found.is_below(0.0), Some(true), "{:?}", found.values);
    }

    #[test]
    fn one_vector_is_enough_for_a_single_lowest_eigenvalue() {
        let spectrum: Vec<f64> = (0..200).map(|i| 0.01 + i as f64).collect();
        let operator = Reflected::new(&spectrum, 10.0);
        let found = lowest_of(&operator, &seeds(200, 1), &search(1));
        assert!(found.iterations < 100, "{}", found.iterations);
        assert_lowest(&operator, &found, &[0.01]);
    }

    #[test]
    fn the_iteration_converges_to_rounding_and_stays_there() {
        let mut spectrum: Vec<f64> = (0..100).map(|i| 1.0 + (i * i) as f64).collect();
        spectrum[50] = 0.9;
        let operator = Reflected::new(&spectrum, 3.0);
        let exact = Search {
            accuracy: 0.0,
            ..search(2)
        };
        let found = lowest_of(&operator, &seeds(100, 3), &exact);
        assert_eq!(found.iterations, 300);
        assert_lowest(&operator, &found, &[0.9, 1.0]);
        assert!(
            found.errors[0] < 1e-6 && found.errors[1] < 1e-6,
            "{:?}",
            found.errors
        );
    }

    #[test]
    fn the_side_of_a_value_takes_fewer_iterations() {
        let mut spectrum: Vec<f64> = (0..300).map(|i| 1.0 + (i * i) as f64).collect();
        for (lowest_value, below) in [(0.4, true), (0.6, false)] {
            spectrum[100] = lowest_value;
            let operator = Reflected::new(&spectrum, 3.0);
            let side = Search {
                side_of: Some(0.5),
                ..search(1)
            };
            let quick = lowest_of(&operator, &seeds(300, 3), &side);
            assert_eq!(quick.is_below(0.5), Some(below));
            let whole = lowest_of(&operator, &seeds(300, 3), &search(1));
            assert!(quick.iterations < whole.iterations);
        }
    }

    #[test]
    fn dependent_seeds_count_once() {
        let spectrum: Vec<f64> = (0..60).map(|i| 1.0 + i as f64).collect();
        let operator = Reflected::new(&spectrum, 3.0);
        let mut seeds = seeds(60, 2);
        seeds.push(seeds[0].iter().map(|x| -3.0 * x).collect());
        seeds.push(vec![0.0; 60]);
        let found = lowest_of(&operator, &seeds, &search(2));
        assert_eq!(found.values.len(), 2);
        assert_lowest(&operator, &found, &[1.0, 2.0]);
    }

    #[test]
    fn a_block_as_large_as_the_problem_is_solved_at_once() {
        let operator = Reflected::new(&[3.0, -1.0, 2.0], 2.0);
        let found = lowest_of(&operator, &seeds(3, 3), &search(3));
        assert!(found.iterations <= 1, "{}", found.iterations);
        assert_lowest(&operator, &found, &[-1.0, 2.0, 3.0]);
        assert!(lowest_of(&operator, &[], &search(1)).values.is_empty());
    }

    #[test]
    fn prescribed_unknowns_are_zero_in_eigenvectors() {
        let spectrum: Vec<f64> = (0..40).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 3.0);
        for i in [0, 11, 39] {
            operator.prescribed[i] = true;
        }
        let found = lowest_of(&operator, &seeds(40, 2), &search(1));
        let x = &found.vectors[0];
        assert_eq!([x[0], x[11], x[39]], [0.0; 3]);
        // Constraints do not lower eigenvalues.
        assert!(found.values[0] > 1.0);
    }

    #[test]
    fn eigenvectors_are_orthogonal_to_constrained_combinations() {
        let spectrum: Vec<f64> = (0..40).map(|i| 1.0 + i as f64).collect();
        let mut operator = Reflected::new(&spectrum, 3.0);
        // With the lowest eigenvector constrained, the others are left.
        let free = lowest_of(&operator, &seeds(40, 2), &search(1));
        let mut pinned = vec![0.0; 40];
        operator.metric(&free.vectors[0], &mut pinned);
        let size = dot(&pinned, &pinned).sqrt();
        operator.pinned = Some(pinned.iter().map(|x| x / size).collect());
        let found = lowest_of(&operator, &seeds(40, 3), &search(2));
        assert!(dot(&found.vectors[0], &pinned).abs() < 1e-9);
        assert_lowest(&operator, &found, &[2.0, 3.0]);
    }
}
