//! Newton's method for u together with one scalar, in a plane.

use super::super::equilibrium::{EQUILIBRIUM, Equilibrium, ResidualEvaluation, largest};
use super::super::operator::{add, dot};
use super::bordered::{Border, Linear};
use super::curve::{Curve, LinearOf};
use super::error::ArcFailure;
use super::family::Family;
use crate::monitor::Monitor;

/// Largest number of corrections.
const CORRECTIONS: usize = 12;
/// Smallest fraction of a correction that is tried.
const SHORTEST: f64 = 1.0 / 32.0;
/// Distance from the plane of a solution, relative to its scale.
const PLANE: f64 = 1e-9;

/// The scalar that is solved for beside u.
#[derive(Clone, Copy)]
pub(super) enum Scalar<'a> {
    /// The parameter: R(u, λ) = 0.
    Parameter,
    /// The factor η of a force at a fixed parameter: R(u, λ) + η c = 0.
    Force { parameter: f64, force: &'a [f64] },
}

/// The plane row · (u − u₀) + corner (y − y₀) = 0.
pub(super) struct Plane<'a> {
    pub row: Vec<f64>,
    pub corner: f64,
    pub origin: (&'a [f64], f64),
    /// Size of its left-hand side that counts as one.
    pub scale: f64,
}

/// A solution.
pub(super) struct Corrected<P: Equilibrium> {
    pub u: Vec<f64>,
    pub scalar: f64,
    pub energy: f64,
    pub relative_residual: f64,
    pub corrections: usize,
    pub linear: Linear<P::Tangent>,
    /// Derivative of the residual in the scalar.
    pub column: Vec<f64>,
}

/// An iterate.
struct Iterate {
    u: Vec<f64>,
    scalar: f64,
    forces: ResidualEvaluation,
    relative_residual: f64,
    /// Left-hand side of the plane.
    distance: f64,
}

impl Plane<'_> {
    fn distance(&self, u: &[f64], scalar: f64) -> f64 {
        let at = dot(&self.row, u) - dot(&self.row, self.origin.0);
        at + self.corner * (scalar - self.origin.1)
    }
}

type Failure<F> = ArcFailure<<<F as Family>::Problem as Equilibrium>::EvaluationError>;

impl<F: Family> Curve<'_, F> {
    /// Solves from a start. Every correction must decrease, measured with the same factors (natural monotonicity).
    pub(super) fn correct(
        &self,
        scalar: Scalar<'_>,
        plane: &Plane<'_>,
        (u, y): (Vec<f64>, f64),
        monitor: &mut dyn Monitor,
    ) -> Result<Corrected<F::Problem>, Failure<F>> {
        let tolerance = self.settings.tolerance * scalar.accuracy();
        let converged = |at: &Iterate| {
            at.relative_residual <= tolerance && at.distance.abs() <= PLANE * plane.scale
        };
        let mut now = self.iterate(scalar, plane, u, y)?;
        let mut corrections = 0;
        while !converged(&now) {
            if monitor.is_cancelled() {
                return Err(ArcFailure::Cancelled);
            }
            if corrections == CORRECTIONS {
                return Err(not_converged(&now));
            }
            let (linear, column) = self.linearise(scalar, &now.u, now.scalar)?;
            let border = Border {
                column: &column,
                row: &plane.row,
                corner: plane.corner,
            };
            let newton = |at: &Iterate| {
                let minus: Vec<f64> = at.forces.residual.iter().map(|r| -r).collect();
                linear.solve(&border, &minus, -at.distance)
            };
            let (du, dy) = newton(&now)?;
            let size = self.size(scalar, &du, dy);
            let limit = self.longest_step(scalar, &now, &du, dy);
            if limit == 0.0 {
                return Err(ArcFailure::Blocked);
            }
            corrections += 1;
            let (mut fraction, mut failed) = (limit, None);
            let next = loop {
                let mut u = now.u.clone();
                add(fraction, &du, &mut u);
                match self.iterate(scalar, plane, u, now.scalar + fraction * dy) {
                    Ok(next) if converged(&next) => break Some(next),
                    Ok(next) => {
                        let (du, dy) = newton(&next)?;
                        if self.size(scalar, &du, dy) <= (1.0 - 0.25 * fraction) * size {
                            break Some(next);
                        }
                        failed = None;
                    }
                    Err(error) => failed = Some(error),
                }
                fraction *= 0.5;
                if fraction < SHORTEST * limit {
                    break None;
                }
            };
            match (next, failed) {
                (Some(next), _) => now = next,
                // Rounding hides the decrease.
                (None, None)
                    if now.relative_residual <= EQUILIBRIUM
                        && now.distance.abs() <= PLANE * plane.scale =>
                {
                    break;
                }
                (None, None) => return Err(not_converged(&now)),
                (None, Some(error)) => return Err(error),
            }
            let activity = format_args!(
                "correction {corrections}, residual {:.1e}",
                now.relative_residual
            );
            monitor.working(&activity, 0.0);
        }
        let (linear, column) = self.linearise(scalar, &now.u, now.scalar)?;
        Ok(Corrected {
            u: now.u,
            scalar: now.scalar,
            energy: now.forces.energy,
            relative_residual: now.relative_residual,
            corrections,
            linear,
            column,
        })
    }

    fn iterate(
        &self,
        scalar: Scalar<'_>,
        plane: &Plane<'_>,
        mut u: Vec<f64>,
        y: f64,
    ) -> Result<Iterate, Failure<F>> {
        let parameter = scalar.parameter(y);
        let mut forces = self.forces(parameter, &mut u)?;
        if let Scalar::Force { force, .. } = scalar {
            add(y, force, &mut forces.residual);
        }
        Ok(Iterate {
            relative_residual: forces.relative_residual(self.prescribed()),
            distance: plane.distance(&u, y),
            scalar: y,
            forces,
            u,
        })
    }

    /// Returns the factored tangent stiffness, and the derivative of the residual in the scalar.
    fn linearise(
        &self,
        scalar: Scalar<'_>,
        u: &[f64],
        y: f64,
    ) -> Result<(LinearOf<F>, Vec<f64>), Failure<F>> {
        let linear = self.linear(u, scalar.parameter(y))?;
        let column = match scalar {
            Scalar::Parameter => self.slope(u, y)?,
            Scalar::Force { force, .. } => force.to_vec(),
        };
        Ok((linear, column))
    }

    fn size(&self, scalar: Scalar<'_>, du: &[f64], dy: f64) -> f64 {
        match scalar {
            Scalar::Parameter => self.metric.length(du, dy),
            Scalar::Force { .. } => self.metric.length(du, 0.0),
        }
    }

    /// Returns the longest fraction of a correction that leads past no barrier, with the motion of prescribed unknowns.
    fn longest_step(&self, scalar: Scalar<'_>, now: &Iterate, du: &[f64], dy: f64) -> f64 {
        let parameter = scalar.parameter(now.scalar + dy);
        let Some((problem, load)) = self.family.at(parameter) else {
            return 1.0;
        };
        let mut to = now.u.clone();
        add(1.0, du, &mut to);
        problem.apply_prescribed(&load, &mut to);
        let step: Vec<f64> = to.iter().zip(&now.u).map(|(a, b)| a - b).collect();
        if largest(step.iter().copied().enumerate()).1 == 0.0 {
            return 1.0;
        }
        problem.longest_step(&now.u, &step)
    }
}

impl Scalar<'_> {
    /// Returns the factor of the tolerance: derivatives of forces are differences of them.
    fn accuracy(&self) -> f64 {
        match self {
            Self::Parameter => 1.0,
            Self::Force { .. } => 1e-3,
        }
    }

    fn parameter(&self, y: f64) -> f64 {
        match self {
            Self::Parameter => y,
            Self::Force { parameter, .. } => *parameter,
        }
    }
}

fn not_converged<E: std::error::Error>(at: &Iterate) -> ArcFailure<E> {
    ArcFailure::NotConverged {
        relative_residual: at.relative_residual,
    }
}
