//! A branch: points that follow one another at steps of the arc length.

use super::curve::{Curve, Failure, Point, hermite};
use super::error::ArcFailure;
use super::family::Family;
use super::step_length::StepLength;
use crate::monitor::Monitor;

/// A branch of equilibria, with its last point.
pub struct Branch<'c, 'f, F: Family> {
    curve: &'c Curve<'f, F>,
    /// Range of the parameter.
    range: [f64; 2],
    step: StepLength,
    previous: Option<Point>,
    point: Point,
}

/// The end of a branch.
#[derive(Clone, Debug, PartialEq)]
pub enum BranchEnd<E: std::error::Error> {
    /// The parameter has reached an end of its range; the last point lies there.
    Range,
    /// No further point was found.
    Lost(ArcFailure<E>),
}

type End<F> =
    BranchEnd<<<F as Family>::Problem as super::super::equilibrium::Equilibrium>::EvaluationError>;

impl<'c, 'f, F: Family> Branch<'c, 'f, F> {
    /// Begins at a point, and leads along its tangent, while the parameter is in a range.
    pub fn begin(curve: &'c Curve<'f, F>, point: Point, range: [f64; 2]) -> Self {
        let settings = &curve.settings;
        Self {
            curve,
            range: [range[0].min(range[1]), range[0].max(range[1])],
            step: StepLength {
                length: settings.first_step,
                shortest: settings.shortest_step,
                longest: settings.longest_step,
            },
            previous: None,
            point,
        }
    }

    /// Returns the last point.
    pub fn point(&self) -> &Point {
        &self.point
    }

    /// Advances to the next point.
    ///
    /// # Errors
    /// The end of the branch.
    pub fn advance(&mut self, monitor: &mut dyn Monitor) -> Result<&Point, End<F>> {
        let [low, high] = self.range;
        if (self.point.parameter >= high && self.point.tangent.1 > 0.0)
            || (self.point.parameter <= low && self.point.tangent.1 < 0.0)
        {
            return Err(BranchEnd::Range);
        }
        loop {
            let failed = match self.try_step(monitor) {
                Ok((point, degrees)) => {
                    self.step.accept(point.corrections, degrees);
                    self.previous = Some(std::mem::replace(&mut self.point, point));
                    return Ok(&self.point);
                }
                Err(failed) => failed,
            };
            if matches!(failed, ArcFailure::Cancelled) || !self.step.shorten() {
                return Err(BranchEnd::Lost(failed));
            }
        }
    }

    /// Takes a step of the present length. Returns its point with the angle by which the tangent turned, in degrees.
    fn try_step(&self, monitor: &mut dyn Monitor) -> Result<(Point, f64), Failure<F>> {
        let (curve, at, length) = (self.curve, &self.point, self.step.length);
        let start = self.predict(length)?;
        let [low, high] = self.range;
        if start.1 > high || start.1 < low {
            let limit = if start.1 > high { high } else { low };
            // A prediction with the parameter at the end of its range.
            let share = (limit - at.parameter) / (start.1 - at.parameter);
            let start = self.predict(share * length)?;
            let found = curve.at_parameter(start, limit, monitor)?;
            let point = curve.point(found, at.s + share * length, &at.tangent)?;
            return self.checked(point);
        }
        let found = curve.in_plane(&at.tangent, start, length, monitor)?;
        let point = curve.point(found, at.s + length, &at.tangent)?;
        self.checked(point)
    }

    /// Refuses a point whose tangent turns too far, or which lies on another branch.
    fn checked(&self, mut point: Point) -> Result<(Point, f64), Failure<F>> {
        let degrees = self.curve.angle(&self.point, &point);
        if !self.step.permits(degrees) {
            return Err(ArcFailure::NotConverged {
                relative_residual: point.relative_residual,
            });
        }
        // The chord is a better measure of the way than the step.
        point.s = self.point.s + self.curve.distance(&self.point, &point);
        Ok((point, degrees))
    }

    /// Predicts the state at a distance along the tangent, or along the cubic through the point before, whichever has the
    /// smaller residual.
    fn predict(&self, length: f64) -> Result<(Vec<f64>, f64), Failure<F>> {
        let (curve, at) = (self.curve, &self.point);
        let along = at.u.iter().zip(&at.tangent.0);
        let line = (
            along.map(|(u, v)| u + length * v).collect::<Vec<f64>>(),
            at.parameter + length * at.tangent.1,
        );
        let residual = |(u, parameter): &(Vec<f64>, f64)| {
            let forces = curve.forces(*parameter, &mut u.clone());
            forces.map_or(f64::INFINITY, |forces| {
                forces.relative_residual(curve.prescribed())
            })
        };
        let mut best = line;
        if let Some(previous) = &self.previous {
            let cubic = hermite(previous, at, at.s + length);
            if residual(&cubic) < residual(&best) {
                best = cubic;
            }
        }
        match curve.is_reachable(at, &best) {
            true => Ok(best),
            false => Err(ArcFailure::Blocked),
        }
    }
}
