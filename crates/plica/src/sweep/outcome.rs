//! The outcome of a point: what its run found, as a row of the study's table.

use crate::run_directory::Verdict;
use crate::study::Findings;
use crate::study::findings::{Interval, Place};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The state of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Every stage was completed.
    Complete,
    /// The tube could not be followed further; the states before are results.
    Lost,
    /// The case is not valid.
    Invalid,
    /// The run ended with an error.
    Failed,
    /// The run was begun, and may be going on.
    Begun,
    /// Nothing was computed yet.
    Missing,
}

impl Status {
    /// Returns whether the run has ended with states.
    pub fn has_states(self) -> bool {
        matches!(self, Self::Complete | Self::Lost)
    }

    /// Returns whether nothing is left to compute.
    pub fn is_final(self) -> bool {
        !matches!(self, Self::Begun | Self::Missing)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Complete => "complete",
            Self::Lost => "lost",
            Self::Invalid => "invalid",
            Self::Failed => "failed",
            Self::Begun => "begun",
            Self::Missing => "missing",
        })
    }
}

/// The outcome of a point. Loads are values of the first load that changes in the stage of a state; energies and lengths have
/// the units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Its state.
    pub status: Status,
    /// Accepted states.
    pub states: usize,
    /// Shape of the last state; empty without states.
    pub shape: String,
    /// Name of the end to which the last state overhangs, or none.
    pub side: String,
    /// Overhang of the last state.
    pub overhang: Option<f64>,
    /// Strain energy of the last state.
    pub energy: Option<f64>,
    /// Strain energy at the first minimum inside a stage, and the load there.
    pub energy_minimum: Option<f64>,
    /// Load at that minimum.
    pub energy_minimum_load: Option<f64>,
    /// The first state with a square wall.
    pub square_state: Option<usize>,
    /// Its load.
    pub square_load: Option<f64>,
    /// The first state whose wall overhangs.
    pub overhang_state: Option<usize>,
    /// Its load.
    pub overhang_load: Option<f64>,
    /// The first invaginated state.
    pub invaginated_state: Option<usize>,
    /// Its load.
    pub invaginated_load: Option<f64>,
    /// The first state in which a wall touches itself.
    pub touching_state: Option<usize>,
    /// Its load.
    pub touching_load: Option<f64>,
    /// The first unstable state.
    pub unstable_state: Option<usize>,
    /// Its load.
    pub unstable_load: Option<f64>,
    /// The circumferential mode to which it is unstable; `stable` if there is none, `other` for modes of a tube that is not
    /// axisymmetric.
    pub unstable_mode: String,
    /// True if the last state is that of an earlier one under the same load; none if no load returns.
    pub recovered: Option<bool>,
    /// States that do not describe a real tube.
    pub unphysical_states: usize,
    /// States whose stability was not determined.
    pub untested_states: usize,
    /// Linear solves.
    pub linear_solves: usize,
    /// Reason why there is no complete path.
    pub reason: String,
}

impl Outcome {
    /// Returns the outcome of a point without states.
    pub fn of_status(status: Status) -> Self {
        Self {
            status,
            states: 0,
            shape: String::new(),
            side: String::new(),
            overhang: None,
            energy: None,
            energy_minimum: None,
            energy_minimum_load: None,
            square_state: None,
            square_load: None,
            overhang_state: None,
            overhang_load: None,
            invaginated_state: None,
            invaginated_load: None,
            touching_state: None,
            touching_load: None,
            unstable_state: None,
            unstable_load: None,
            unstable_mode: String::new(),
            recovered: None,
            unphysical_states: 0,
            untested_states: 0,
            linear_solves: 0,
            reason: String::new(),
        }
    }

    /// Returns the outcome of a point that was not computed, with the reason.
    pub fn without_states(status: Status, reason: impl fmt::Display) -> Self {
        Self {
            reason: reason.to_string(),
            ..Self::of_status(status)
        }
    }

    /// Returns the outcome of a run that has ended.
    pub fn of_run(findings: &Findings, verdict: Verdict, reason: &str) -> Self {
        let status = match verdict {
            Verdict::Complete => Status::Complete,
            Verdict::Lost => Status::Lost,
            Verdict::Running | Verdict::Stopped => Status::Begun,
        };
        let first = |states: &[Interval]| {
            let first = states.first().map(|states| &states.first);
            (first.map(|place| place.state), first.and_then(load))
        };
        let unstable = findings.unstable.iter();
        let unstable = unstable.filter_map(|of| Some((of, &of.states.first()?.first)));
        let unstable = unstable.min_by_key(|(_, place)| place.state);
        let last = findings.stages.last();
        let minimum = findings.energy_minima().next();
        let (square_state, square_load) = first(&findings.square);
        let (overhang_state, overhang_load) = first(&findings.overhanging);
        let (invaginated_state, invaginated_load) = first(&findings.invaginated);
        let (touching_state, touching_load) = first(&findings.touching);
        let untested = findings.untested.iter().map(Interval::states).sum();
        Self {
            states: findings.work.states,
            shape: last
                .map(|stage| stage.shape.to_string())
                .unwrap_or_default(),
            side: last.map(|stage| stage.toward.clone()).unwrap_or_default(),
            overhang: last.map(|stage| stage.overhang),
            energy: last.map(|stage| stage.energy),
            energy_minimum: minimum.map(|extreme| extreme.energy),
            energy_minimum_load: minimum.and_then(|extreme| load(&extreme.at)),
            square_state,
            square_load,
            overhang_state,
            overhang_load,
            invaginated_state,
            invaginated_load,
            touching_state,
            touching_load,
            unstable_state: unstable.map(|(_, place)| place.state),
            unstable_load: unstable.and_then(|(_, place)| load(place)),
            unstable_mode: match unstable {
                None => "stable".into(),
                Some((of, _)) => of.mode.map_or("other".into(), |mode| mode.to_string()),
            },
            recovered: findings.returned.as_ref().map(|found| found.is_same),
            unphysical_states: findings.unphysical_states(),
            untested_states: untested,
            linear_solves: findings.work.linear_solves,
            reason: reason.to_owned(),
            ..Self::of_status(status)
        }
    }
}

/// Returns the first load that changes in the stage of a state.
fn load(place: &Place) -> Option<f64> {
    place.loads.first().map(|load| load.value)
}
