//! The equilibria of a family: points, tangents, and points between two others.

use super::super::continuation::PreviousPoint;
use super::super::equilibrium::{Equilibrium, ResidualEvaluation, is_reachable};
use super::super::operator::dot;
use super::super::tangent::Tangent;
use super::bordered::{Border, Linear};
use super::corrector::{Corrected, Plane, Scalar};
use super::error::ArcFailure;
use super::family::Family;
use super::metric::Metric;
use crate::monitor::Monitor;

/// Settings of arc-length continuation. Lengths are arc lengths, which begin as changes of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcSettings {
    /// Largest relative residual of a point.
    pub tolerance: f64,
    /// Length of the first step.
    pub first_step: f64,
    /// Shortest step.
    pub shortest_step: f64,
    /// Longest step.
    pub longest_step: f64,
    /// Change of the parameter in the central differences that give R_λ.
    pub difference: f64,
}

impl ArcSettings {
    /// Returns the settings for a range of the parameter: a first step of a fiftieth of it, and none longer than a twenty-fifth.
    pub fn for_range(range: [f64; 2]) -> Self {
        let width = (range[1] - range[0]).abs();
        Self {
            tolerance: 1e-8,
            first_step: 0.02 * width,
            shortest_step: 1e-6 * width,
            longest_step: 0.04 * width,
            difference: 1e-5 * width,
        }
    }
}

/// A point of a branch.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Arc length from the first point.
    pub s: f64,
    /// λ.
    pub parameter: f64,
    /// Unknowns.
    pub u: Vec<f64>,
    /// du/ds and dλ/ds.
    pub tangent: (Vec<f64>, f64),
    /// Energy.
    pub energy: f64,
    /// Relative residual.
    pub relative_residual: f64,
    /// Number of negative eigenvalues of K.
    pub negative: usize,
    /// Corrections that it took.
    pub corrections: usize,
}

impl Point {
    /// Returns the same point with the opposite tangent.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let (u, parameter) = &self.tangent;
        Self {
            tangent: (u.iter().map(|x| -x).collect(), -parameter),
            ..self.clone()
        }
    }
}

/// The equilibria of a family, with the measure of length along them.
pub struct Curve<'a, F: Family> {
    pub(super) family: &'a F,
    pub(super) settings: ArcSettings,
    pub(super) metric: Metric<F::Problem>,
}

pub(super) type Failure<F> = ArcFailure<<<F as Family>::Problem as Equilibrium>::EvaluationError>;
pub(super) type LinearOf<F> = Linear<<<F as Family>::Problem as Equilibrium>::Tangent>;

impl<'a, F: Family> Curve<'a, F> {
    /// Solves for the equilibrium near a state, at which K must not be singular, and measures lengths there. Returns the
    /// point with its tangent toward rising λ, too.
    ///
    /// # Errors
    /// [`ArcFailure`] if there is no such equilibrium.
    pub fn begin(
        family: &'a F,
        settings: ArcSettings,
        parameter: f64,
        u: Vec<f64>,
        monitor: &mut dyn Monitor,
    ) -> Result<(Self, Point), Failure<F>> {
        let problem = || {
            family
                .at(parameter)
                .ok_or(ArcFailure::Undefined { parameter })
        };
        let mut curve = Self {
            family,
            settings,
            metric: Metric::unit(problem()?.0),
        };
        let found = curve.at_parameter((u, parameter), parameter, monitor)?;
        let minus: Vec<f64> = found.column.iter().map(|r| -r).collect();
        let slope = found.linear.solve_alone(&minus)?;
        curve.metric = curve.metric.scaled(&slope);
        let tangent = curve.unit(slope, 1.0);
        let point = curve.point(found, 0.0, &tangent)?;
        Ok((curve, point))
    }

    /// Returns the family.
    pub fn family(&self) -> &'a F {
        self.family
    }

    /// Returns for every unknown whether a support prescribes it.
    pub fn prescribed(&self) -> &[bool] {
        self.metric.prescribed()
    }

    /// Returns the angle between the tangents of two points, in degrees.
    pub fn angle(&self, a: &Point, b: &Point) -> f64 {
        let (row, corner) = self.metric.row(&a.tangent.0, a.tangent.1);
        let cosine = dot(&row, &b.tangent.0) + corner * b.tangent.1;
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    }

    /// Returns the distance of two points.
    pub fn distance(&self, a: &Point, b: &Point) -> f64 {
        let apart: Vec<f64> = a.u.iter().zip(&b.u).map(|(a, b)| a - b).collect();
        self.metric.length(&apart, a.parameter - b.parameter)
    }

    /// Solves for the point at a fraction of the way from one point to the next, 0 to 1.
    ///
    /// # Errors
    /// [`ArcFailure`] if it is not found.
    pub fn between(
        &self,
        [a, b]: [&Point; 2],
        fraction: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Point, Failure<F>> {
        let s = a.s + fraction * (b.s - a.s);
        let (u, parameter) = hermite(a, b, s);
        let chord: Vec<f64> = b.u.iter().zip(&a.u).map(|(b, a)| b - a).collect();
        let chord = self.unit(chord, b.parameter - a.parameter);
        let found = self.in_plane(&chord, (u, parameter), b.s - a.s, monitor)?;
        self.point(found, s, &chord)
    }

    /// Solves for the point with a value of the parameter near a start.
    pub(super) fn at_parameter(
        &self,
        start: (Vec<f64>, f64),
        parameter: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Corrected<F::Problem>, Failure<F>> {
        let origin = vec![0.0; start.0.len()];
        let plane = Plane {
            row: vec![0.0; start.0.len()],
            corner: 1.0,
            origin: (&origin, parameter),
            scale: self.settings.first_step.max(1e-3 * parameter.abs()),
        };
        let found = self.correct(Scalar::Parameter, &plane, (start.0, parameter), monitor)?;
        Ok(Corrected {
            scalar: parameter,
            ..found
        })
    }

    /// Solves in the plane through a start that is orthogonal to a direction.
    pub(super) fn in_plane(
        &self,
        direction: &(Vec<f64>, f64),
        start: (Vec<f64>, f64),
        length: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Corrected<F::Problem>, Failure<F>> {
        let (row, corner) = self.metric.row(&direction.0, direction.1);
        let plane = Plane {
            row,
            corner,
            origin: (&start.0.clone(), start.1),
            scale: length,
        };
        self.correct(Scalar::Parameter, &plane, start, monitor)
    }

    /// Returns a solution as a point, with the tangent that leads forward along a direction.
    pub(super) fn point(
        &self,
        found: Corrected<F::Problem>,
        s: f64,
        forward: &(Vec<f64>, f64),
    ) -> Result<Point, Failure<F>> {
        let (row, corner) = self.metric.row(&forward.0, forward.1);
        let border = Border {
            column: &found.column,
            row: &row,
            corner,
        };
        let (u, parameter) = found.linear.solve(&border, &vec![0.0; row.len()], 1.0)?;
        Ok(Point {
            s,
            parameter: found.scalar,
            tangent: self.unit(u, parameter),
            negative: found.linear.negative(),
            u: found.u,
            energy: found.energy,
            relative_residual: found.relative_residual,
            corrections: found.corrections,
        })
    }

    /// Returns a direction of unit length.
    pub(super) fn unit(&self, mut u: Vec<f64>, parameter: f64) -> (Vec<f64>, f64) {
        let length = self.metric.length(&u, parameter);
        u.iter_mut().for_each(|x| *x /= length);
        (u, parameter / length)
    }

    /// Evaluates energy and residual, whose prescribed entries are zero, with the prescribed values of the parameter in `u`.
    pub(super) fn forces(
        &self,
        parameter: f64,
        u: &mut [f64],
    ) -> Result<ResidualEvaluation, Failure<F>> {
        let at = self.family.at(parameter);
        let (problem, load) = at.ok_or(ArcFailure::Undefined { parameter })?;
        problem.apply_prescribed(&load, u);
        let mut forces = problem.forces(&load, u).map_err(ArcFailure::Evaluation)?;
        self.metric.clear_prescribed(&mut forces.residual);
        Ok(forces)
    }

    /// Returns the factored tangent stiffness at a point.
    pub(super) fn linear(&self, u: &[f64], parameter: f64) -> Result<LinearOf<F>, Failure<F>> {
        let at = self.family.at(parameter);
        let (problem, load) = at.ok_or(ArcFailure::Undefined { parameter })?;
        Linear::new(problem.tangent(&load, u), self.prescribed(), |K| {
            // xᵀ K x / xᵀ C x with the signs of x alternating from unknown to unknown is dominated by large eigenvalues.
            let alternating = (0..u.len()).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 });
            let mut x: Vec<f64> = alternating.collect();
            self.metric.clear_prescribed(&mut x);
            let mut product = vec![0.0; x.len()];
            K.multiply_add(1.0, &x, &mut product);
            (dot(&x, &product) / dot(&x, &self.metric.dual(&x))).abs()
        })
    }

    /// Returns R_λ at a point, where prescribed unknowns move with λ: a central difference.
    pub(super) fn slope(&self, u: &[f64], parameter: f64) -> Result<Vec<f64>, Failure<F>> {
        let step = self.settings.difference;
        let mut moved = u.to_vec();
        let after = self.forces(parameter + step, &mut moved)?.residual;
        let before = self.forces(parameter - step, &mut moved)?.residual;
        let pairs = after.iter().zip(&before);
        Ok(pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect())
    }

    /// Returns whether no barrier lies on the straight way from a point to a state.
    pub(super) fn is_reachable(&self, from: &Point, to: &(Vec<f64>, f64)) -> bool {
        let Some((problem, load)) = self.family.at(to.1) else {
            return false;
        };
        let mut u = to.0.clone();
        problem.apply_prescribed(&load, &mut u);
        is_reachable(&problem, &from.u, &u)
    }
}

/// Returns the state at arc length `s` on the cubic through two points with their tangents.
pub(super) fn hermite(a: &Point, b: &Point, s: f64) -> (Vec<f64>, f64) {
    let before = |u: &[f64], tangent: &[f64]| PreviousPoint {
        t: a.s,
        u: u.to_vec(),
        tangent: tangent.to_vec(),
    };
    let u = before(&a.u, &a.tangent.0).extrapolate(b.s, &b.u, &b.tangent.0, s);
    let parameter =
        before(&[a.parameter], &[a.tangent.1]).extrapolate(b.s, &[b.parameter], &[b.tangent.1], s);
    (u, parameter[0])
}
