//! Place and reason where a tube could not be followed further.

use super::{LimitPoint, Plan, Scale};
use crate::assembly::{Inverted, Place, SplineTube};
use crate::solve::{Cause, Failure, PathError};
use crate::tube::Load;
use std::fmt;

/// A tube that could not be followed further: where on its path, why, and where in its wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Lost {
    /// Part of the path at which the tube was lost.
    pub phase: Phase,
    /// The attempts, in order, and how each failed.
    pub error: PathError<Inverted>,
    /// Places of the wall that the failure points to.
    pub locations: Vec<Location>,
    /// Extreme values of what the stage drives, if that is why it could not be followed further.
    pub limit_points: Vec<LimitPoint>,
    /// Units in which the message gives places and stresses.
    scale: Scale,
}

/// Part of a path.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// The tube at rest, with its imperfections.
    Rest,
    /// The state that the study starts from.
    Start,
    /// A step of a stage.
    Stage {
        /// Name of the stage.
        name: String,
        /// The step, from 1.
        step: usize,
        /// Steps of the stage.
        steps: usize,
    },
}

impl Lost {
    /// Locates a failure in the wall, by the last attempt and by the last good state. `limit` is the load at which the
    /// path turns back, if that explains the failure.
    pub(super) fn new(
        plan: &Plan,
        tube: &SplineTube,
        phase: Phase,
        error: PathError<Inverted>,
        last: Option<(&Load, &[f64])>,
        limit: Option<&Load>,
    ) -> Self {
        let limit_points = match (last, limit) {
            (Some((last, _)), Some(limit)) => LimitPoint::between(plan, last, limit),
            _ => vec![],
        };
        Self {
            locations: locations(tube, &error, last),
            limit_points,
            scale: Scale::of(plan.units.as_ref()),
            phase,
            error,
        }
    }
}

impl std::error::Error for Lost {}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let error = &self.error;
        match &self.phase {
            Phase::Rest => write!(
                f,
                "no equilibrium of the tube at rest with its imperfections was found ({error}); there is no first state. "
            ),
            Phase::Start => write!(
                f,
                "no equilibrium was found on this mesh near the state to start from ({error}); there is no first state. "
            ),
            Phase::Stage { name, step, steps } => write!(
                f,
                "the tube could not be followed further in stage `{name}`, step {step} of {steps} ({error}); the last good state is kept. "
            ),
        }?;
        if !self.limit_points.is_empty() {
            return f.write_str(&at_limit_point(&self.limit_points));
        }
        for location in &self.locations {
            write!(f, "{}. ", location.describe(&self.scale))?;
        }
        f.write_str(advice(&self.phase, error))
    }
}

/// A place of the wall that a failure points to.
#[derive(Clone, Debug, PartialEq)]
pub enum Location {
    /// The last attempt has its largest residual there.
    LargestResidual(Place),
    /// The last attempt still moved most there.
    Moving(Place),
    /// The last attempt has an inverted element there.
    Inverted(Place),
    /// The last good state is inverted there, between quadrature points.
    InvertedBetweenPoints(Place),
    /// The last good state has its largest strain energy density there, in E.
    Strained(Place, f64),
}

/// Returns the places that the last attempt and the last good state point to.
fn locations(
    tube: &SplineTube,
    error: &PathError<Inverted>,
    last: Option<(&Load, &[f64])>,
) -> Vec<Location> {
    let tried = error.attempts.last().and_then(|(_, failure)| {
        if let Failure::Evaluation(Inverted { place, .. }) = failure {
            return Some(Location::Inverted(*place));
        }
        let place = tube.place_of_unknown(failure.worst_unknown()?);
        Some(match failure {
            Failure::StillMoving { .. } => Location::Moving(place),
            _ => Location::LargestResidual(place),
        })
    });
    let strained = last.and_then(|(load, u)| tube.max_energy_density(load, u));
    let strained = strained
        .filter(|(_, density)| *density > ROUNDING)
        .map(|(place, density)| match density.is_finite() {
            true => Location::Strained(place, density),
            false => Location::InvertedBetweenPoints(place),
        });
    tried.into_iter().chain(strained).collect()
}

/// Strain energy density, in E, below which it is rounding.
const ROUNDING: f64 = 1e-12;

impl Location {
    /// Describes the place, with lengths and stresses in the units of a case.
    pub fn describe(&self, scale: &Scale) -> String {
        let at = |place: &Place| {
            let z = significant(scale.length * place.z);
            format!(
                "at z = {z} {}, {}",
                scale.length_name,
                place.angle_and_depth()
            )
        };
        match self {
            Self::LargestResidual(place) => {
                format!("The last attempt has its largest residual {}", at(place))
            }
            Self::Moving(place) => format!("The last attempt still moved most {}", at(place)),
            Self::Inverted(place) => {
                format!("The last attempt has an inverted element {}", at(place))
            }
            Self::InvertedBetweenPoints(place) => format!(
                "The last good state is inverted {}, between quadrature points: it needs a finer mesh there",
                at(place)
            ),
            Self::Strained(place, density) => format!(
                "The last good state has its largest strain energy density {} ({:.1e} {})",
                at(place),
                scale.stress * density,
                scale.stress_name
            ),
        }
    }
}

/// Rounds to four digits.
fn significant(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// Describes the limit points, and what to do.
fn at_limit_point(limit_points: &[LimitPoint]) -> String {
    let extremes: Vec<String> = limit_points.iter().map(LimitPoint::to_string).collect();
    let it = match limit_points {
        [_] => "it",
        _ => "them together",
    };
    let pressure = |limit: &LimitPoint| limit.quantity == "inner-wall.pressure";
    let volume = match limit_points.iter().any(pressure) {
        true => {
            ". To go past a maximum of the pressure, drive lumen.volume_ratio instead of inner-wall.pressure"
        }
        false => "",
    };
    format!(
        "The path turns back here: {}. No equilibrium beyond was found, and more steps or a finer mesh will not help. \
         End the stage before, or hold {it} there and drive something else: a muscle or an end of the tube{volume}",
        extremes.join(", and ")
    )
}

/// Returns advice by where the tube was lost and how the last attempt failed.
fn advice(phase: &Phase, error: &PathError<Inverted>) -> &'static str {
    match phase {
        Phase::Rest => {
            return "Try a smaller imperfection, more solver.newton_iterations or solver.relaxation_steps, or a finer mesh there (mesh.refine)";
        }
        Phase::Start => {
            return "Try a mesh nearer to that of the saved state, or more solver.newton_iterations or solver.relaxation_steps";
        }
        Phase::Stage { .. } => {}
    }
    match error.attempts.last().map(|(_, failure)| failure) {
        Some(Failure::StillMoving { .. }) => {
            "Try more pseudo-time (solver.pseudo_time.max_steps), less damping, or more steps in this stage"
        }
        Some(Failure::NotConverged {
            cause: Cause::InaccurateSolves,
            ..
        }) => "Try more steps in this stage, or fewer or more even elements (mesh.refine)",
        Some(Failure::Friction { .. }) => {
            "Try a smaller coefficient of friction, or more steps in this stage"
        }
        Some(Failure::Evaluation(_)) => {
            "Try more steps in this stage, more solver.max_step_halvings, or a finer mesh there (mesh.refine)"
        }
        _ => {
            "Try more steps in this stage, more solver.max_step_halvings or solver.relaxation_steps, or a finer mesh in the zone"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{LengthUnit, StressUnit, Units};

    #[test]
    fn places_are_given_in_the_units_of_the_case() {
        let place = Place {
            z: 1.87504,
            angle: Some(1.0),
            depth: 0.25,
        };
        let units = Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 40.0,
        };
        let (plain, scaled) = (Scale::of(None), Scale::of(Some(&units)));
        let strained = Location::Strained(place, 0.06);
        assert_eq!(
            strained.describe(&plain),
            "The last good state has its largest strain energy density at z = 1.875 D, θ = 57°, 25 % of the wall deep (6.0e-2 E)"
        );
        assert_eq!(
            strained.describe(&scaled),
            "The last good state has its largest strain energy density at z = 46.88 mm, θ = 57°, 25 % of the wall deep (2.4e0 kPa)"
        );
        let inverted = Location::Inverted(place).describe(&scaled);
        assert!(
            inverted.ends_with("inverted element at z = 46.88 mm, θ = 57°, 25 % of the wall deep"),
            "{inverted}"
        );
    }
}
