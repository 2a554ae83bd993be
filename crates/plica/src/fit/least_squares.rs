//! The least-squares problem of a fit, and its solution.

use super::{FitError, FittedLaw, Measurement, ParameterUnit, StressKind};
use crate::homogeneous::{Volume, homogeneous};
use crate::material::Material;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

/// Evaluations for each parameter, from every start and then from the best of them.
const FEW: usize = 8;
const MANY: usize = 200;

/// A parameter of a fitted law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, a key of a case.
    pub name: &'static str,
    /// Its unit.
    pub unit: ParameterUnit,
    /// Its value.
    pub value: f64,
    /// Its standard error; none if the tests do not determine it.
    pub standard_error: Option<f64>,
}

/// A law fitted to tests.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// The law; its volumetric constant is a hundred times its shear modulus.
    pub material: Material,
    /// Number of stresses.
    pub stresses: usize,
    /// Root of the mean square of the differences of stress.
    pub deviation: f64,
    /// Coefficient of determination R²: 1 less the sum of the squares of the differences over that about the mean stress.
    pub determination: f64,
}

/// Fits a law to measurements.
///
/// # Errors
/// [`FitError::TooFew`], or [`FitError::NoMinimum`] if the law describes the tests with no parameters.
pub fn fit(law: FittedLaw, measurements: &[Measurement]) -> Result<Fit, FitError> {
    let (count, needed) = (measurements.len(), law.parameters().len());
    if count <= needed {
        return Err(FitError::TooFew {
            stresses: count,
            parameters: needed,
        });
    }
    let squares: f64 = measurements.iter().map(|m| m.stress * m.stress).sum();
    let scale = (squares / count as f64).sqrt();
    if scale == 0.0 {
        return Err(FitError::NoMinimum);
    }
    let template = Problem {
        law,
        measurements,
        scale,
        largest: largest_invariant(measurements),
        x: DVector::zeros(needed),
    };
    let mut best: Option<(f64, Problem<'_>)> = None;
    for start in law.starts(stiffness(measurements)) {
        let mut problem = template.clone();
        problem.x = DVector::from_vec(start);
        let (found, sum) = minimised(problem, FEW);
        if sum.is_finite() && best.as_ref().is_none_or(|(least, _)| sum < *least) {
            best = Some((sum, found));
        }
    }
    let (_, problem) = best.ok_or(FitError::NoMinimum)?;
    let (problem, _) = minimised(problem, MANY);
    problem.result().ok_or(FitError::NoMinimum)
}

/// Returns the problem after a minimisation, and half the sum of its squares.
fn minimised(problem: Problem<'_>, patience: usize) -> (Problem<'_>, f64) {
    let method = LevenbergMarquardt::new().with_patience(patience);
    let (found, report) = method.minimize(problem);
    (found, report.objective_function)
}

/// A law with free numbers x for its parameters. Stresses are measured in their root mean square.
#[derive(Clone)]
struct Problem<'a> {
    law: FittedLaw,
    measurements: &'a [Measurement],
    scale: f64,
    /// Largest I₁ − 3 of the tests.
    largest: f64,
    x: DVector<f64>,
}

impl Problem<'_> {
    fn residuals_at(&self, x: &DVector<f64>) -> Option<DVector<f64>> {
        let values = self.law.values(x.as_slice(), self.largest);
        let law = self.law.material(&values);
        let residual = |m: &Measurement| Some((stress(&law, m)? - m.stress) / self.scale);
        let residuals: Option<Vec<f64>> = self.measurements.iter().map(residual).collect();
        residuals.map(DVector::from_vec)
    }

    fn result(&self) -> Option<Fit> {
        let residuals = self.residuals_at(&self.x)?;
        let values = self.law.values(self.x.as_slice(), self.largest);
        let (n, p) = (residuals.len(), values.len());
        let squares = residuals.norm_squared() * self.scale * self.scale;
        let mean = self.measurements.iter().map(|m| m.stress).sum::<f64>() / n as f64;
        let about_mean = self.measurements.iter().map(|m| (m.stress - mean).powi(2));
        let total: f64 = about_mean.sum();
        // Covariance of x, and of the parameters.
        let J = self.jacobian()?;
        let covariance = (J.transpose() * &J).try_inverse();
        let variance = residuals.norm_squared() / (n - p) as f64;
        let errors: Vec<Option<f64>> = (0..p)
            .map(|i| {
                let slopes = DVector::from_fn(p, |j, _| {
                    self.difference(j, |x| Some(self.law.values(x.as_slice(), self.largest)[i]))
                        .unwrap_or(f64::NAN)
                });
                let covariance = covariance.as_ref()?;
                let square = (slopes.transpose() * covariance * &slopes)[(0, 0)] * variance;
                Some(square.sqrt())
                    .filter(|error| error.is_finite() && *error < 1e3 * values[i].abs())
            })
            .collect();
        let parameters = self.law.parameters().iter().zip(&values).zip(errors);
        Some(Fit {
            parameters: parameters
                .map(|((&(name, unit), &value), standard_error)| Parameter {
                    name,
                    unit,
                    value,
                    standard_error,
                })
                .collect(),
            material: self.law.material(&values),
            stresses: n,
            deviation: (squares / n as f64).sqrt(),
            determination: 1.0 - squares / total,
        })
    }

    /// Returns the derivative of a function of x by x_j.
    fn difference(&self, j: usize, f: impl Fn(&DVector<f64>) -> Option<f64>) -> Option<f64> {
        let h = 1e-5;
        let at = |h: f64| {
            let mut x = self.x.clone();
            x[j] += h;
            f(&x)
        };
        Some((at(h)? - at(-h)?) / (2.0 * h))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.x.copy_from(x);
    }

    fn params(&self) -> DVector<f64> {
        self.x.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.residuals_at(&self.x)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let h = 1e-5;
        let mut columns = vec![];
        for j in 0..self.x.len() {
            let at = |h: f64| {
                let mut x = self.x.clone();
                x[j] += h;
                self.residuals_at(&x)
            };
            columns.push((at(h)? - at(-h)?) / (2.0 * h));
        }
        Some(DMatrix::from_columns(&columns))
    }
}

/// Returns the stress of a law in a test.
fn stress(law: &Material, m: &Measurement) -> Option<f64> {
    let state = homogeneous(law, m.prescribed, Volume::Constant)?;
    Some(match m.kind {
        StressKind::Nominal => state.nominal()[m.direction],
        StressKind::Cauchy => state.cauchy[m.direction],
    })
}

/// Returns the largest I₁ − 3, with lateral stretches of an isotropic material where they are free.
fn largest_invariant(measurements: &[Measurement]) -> f64 {
    let own = |m: &Measurement| {
        let given = [m.prescribed.along, m.prescribed.around].map(|x| x.map(|x| x * x));
        let [a, b] = match given {
            [Some(a), Some(b)] => [a, b],
            [Some(a), None] | [None, Some(a)] => [a, 1.0 / a.sqrt()],
            [None, None] => [1.0; 2],
        };
        a + b + 1.0 / (a * b) - 3.0
    };
    measurements.iter().map(own).fold(0.0, f64::max)
}

/// Returns a stiffness in tension that is typical of the tests.
fn stiffness(measurements: &[Measurement]) -> f64 {
    let slope = |m: &Measurement| {
        let given = [m.prescribed.along, None, m.prescribed.around];
        let strain = given[m.direction]? - 1.0;
        (strain.abs() > 1e-6).then_some(m.stress / strain)
    };
    let mut slopes: Vec<f64> = measurements.iter().filter_map(slope).collect();
    slopes.retain(|slope| *slope > 0.0);
    slopes.sort_by(f64::total_cmp);
    // A low one: laws stiffen.
    slopes.get(slopes.len() / 4).copied().unwrap_or(1.0)
}
