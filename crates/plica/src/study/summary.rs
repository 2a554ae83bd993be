//! How a run ended, and the short table it closes with.

use super::units::Scale;
use super::{Findings, Plan, Row};
use crate::assembly::{Inverted, Place, SplineTube};
use crate::solve::{Failure, PathError};
use crate::tube::Load;
use std::fmt;
use std::path::{Path, PathBuf};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// Every stage was done.
    Complete,
    /// Someone asked to stop.
    Stopped,
    /// The tube could not be followed further.
    Lost {
        /// Where it was lost.
        phase: Phase,
        /// What was tried.
        error: PathError<Inverted>,
        /// Where in the tube it is to be looked for.
        whereabouts: Vec<Whereabouts>,
        /// The units in which that is told.
        scale: Box<Scale>,
    },
}

/// Where on its path a tube is lost.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// On the way to rest, with its imperfections.
    Rest,
    /// On the way to equilibrium of the state that it starts from.
    Start,
    /// On the way to a step of a stage.
    Stage {
        /// The stage's name.
        name: String,
        /// The step, from 1 on.
        step: usize,
        /// The steps of the stage.
        steps: usize,
    },
}

impl Ending {
    /// In one word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Stopped => "stopped",
            Self::Lost { .. } => "lost",
        }
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => f.write_str("every stage was done"),
            Self::Stopped => f.write_str("stopped on request; every state so far is kept"),
            Self::Lost {
                phase,
                error,
                whereabouts,
                scale,
            } => {
                match phase {
                    Phase::Rest => write!(
                        f,
                        "with its imperfections the tube was not brought to rest ({error}); there is no first state. "
                    ),
                    Phase::Start => write!(
                        f,
                        "the state that it starts from was not brought to equilibrium on this mesh ({error}); there is no first state. "
                    ),
                    Phase::Stage { name, step, steps } => write!(
                        f,
                        "the tube could not be followed further in stage `{name}`, step {step} of {steps} ({error}); the last good state is kept. "
                    ),
                }?;
                for there in whereabouts {
                    write!(f, "{}. ", there.told(scale))?;
                }
                f.write_str(advice(phase, error))
            }
        }
    }
}

/// A place at which to look for why a tube was lost.
#[derive(Clone, Debug, PartialEq)]
pub enum Whereabouts {
    /// What was tried last was farthest from balance there.
    Unbalanced(Place),
    /// What was tried last still moved most there.
    Moving(Place),
    /// What was tried last is turned inside out there.
    Inverted(Place),
    /// The last good state is turned over there, between points of integration.
    Turned(Place),
    /// The last good state has its highest strain energy density there, in E.
    Strained(Place, f64),
}

/// Where to look for why a tube was lost: by what was tried last, and by the last good state.
pub(super) fn whereabouts(
    tube: &SplineTube,
    error: &PathError<Inverted>,
    last: Option<(&Load, &[f64])>,
) -> Vec<Whereabouts> {
    let tried = error.attempts.last().and_then(|(_, failure)| {
        if let Failure::Evaluation(Inverted { place, .. }) = failure {
            return Some(Whereabouts::Inverted(*place));
        }
        let place = tube.place_of(failure.worst_unknown()?);
        Some(match failure {
            Failure::StillMoving { .. } => Whereabouts::Moving(place),
            _ => Whereabouts::Unbalanced(place),
        })
    });
    let strained = last.and_then(|(load, u)| tube.hardest_strained(load, u));
    let strained = strained
        .filter(|(_, density)| *density > ROUNDING)
        .map(|(place, density)| match density.is_finite() {
            true => Whereabouts::Strained(place, density),
            false => Whereabouts::Turned(place),
        });
    tried.into_iter().chain(strained).collect()
}

/// A strain energy density, in E, that is none.
const ROUNDING: f64 = 1e-12;

impl Whereabouts {
    /// In words, with lengths and stresses in the units of a case.
    pub fn told(&self, scale: &Scale) -> String {
        let at = |place: &Place| {
            let z = significant(scale.length * place.z);
            format!("at z = {z} {}, {}", scale.length_name, place.beside_z())
        };
        match self {
            Self::Unbalanced(place) => {
                format!("What was tried last was farthest off {}", at(place))
            }
            Self::Moving(place) => format!("What was tried last still moved most {}", at(place)),
            Self::Inverted(place) => {
                format!("What was tried last is turned inside out {}", at(place))
            }
            Self::Turned(place) => format!(
                "The last good state is turned over {}, between the points at which it is integrated: it needs a finer mesh there",
                at(place)
            ),
            Self::Strained(place, density) => format!(
                "The last good state is strained hardest {} (energy density {:.1e} {})",
                at(place),
                scale.stress * density,
                scale.stress_name
            ),
        }
    }
}

/// A number to four digits.
fn significant(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

/// What may help, by where the tube was lost and how the last method failed.
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
        Some(Failure::InaccurateSolves { .. }) => {
            "Try more steps in this stage, or fewer or more even elements (mesh.refine)"
        }
        Some(Failure::Evaluation(_)) => {
            "Try more steps in this stage, more solver.max_step_halvings, or a finer mesh there (mesh.refine)"
        }
        _ => {
            "Try more steps in this stage, more solver.max_step_halvings or solver.relaxation_steps, or a finer mesh in the zone"
        }
    }
}

/// An accepted state in full.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// The load it is under.
    pub load: Load,
    /// Its unknowns.
    pub u: Vec<f64>,
}

/// What a run found.
#[derive(Clone, Debug)]
pub struct Summary {
    rows: Vec<Row>,
    snapshots: Vec<Option<Snapshot>>,
    ending: Ending,
    scale: Scale,
    directory: PathBuf,
}

impl Summary {
    /// Of a run.
    pub fn new(
        plan: &Plan,
        rows: Vec<Row>,
        snapshots: Vec<Option<Snapshot>>,
        ending: Ending,
        directory: &Path,
    ) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            rows,
            snapshots,
            ending,
            scale,
            directory: directory.to_owned(),
        }
    }

    /// Whether every stage was done.
    pub fn finished(&self) -> bool {
        self.ending == Ending::Complete
    }

    /// How it ended.
    pub fn ending(&self) -> &Ending {
        &self.ending
    }

    /// The accepted states.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The accepted states in full, one per row, none of what a run that was taken up again could not read back; nothing at all if
    /// the case wants no pictures.
    pub fn snapshots(&self) -> &[Option<Snapshot>] {
        &self.snapshots
    }

    /// What they come to.
    pub fn findings(&self) -> Findings<'_> {
        Findings {
            rows: &self.rows,
            scale: self.scale.clone(),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.findings().lines();
        if lines.is_empty() {
            return writeln!(f, "no state was accepted");
        }
        for (name, value) in lines {
            writeln!(f, "  {name:<22} {value}")?;
        }
        writeln!(f, "  {:<22} {}", "written to", self.directory.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{LengthUnit, StressUnit, Units};

    #[test]
    fn places_are_told_in_the_units_of_the_case() {
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
        let strained = Whereabouts::Strained(place, 0.06);
        assert_eq!(
            strained.told(&plain),
            "The last good state is strained hardest at z = 1.875 D, θ = 57°, 25 % of the wall deep (energy density 6.0e-2 E)"
        );
        assert_eq!(
            strained.told(&scaled),
            "The last good state is strained hardest at z = 46.88 mm, θ = 57°, 25 % of the wall deep (energy density 2.4e0 kPa)"
        );
        let inverted = Whereabouts::Inverted(place).told(&scaled);
        assert!(
            inverted.ends_with("inside out at z = 46.88 mm, θ = 57°, 25 % of the wall deep"),
            "{inverted}"
        );
    }
}
