//! `manifest.json`: the case, the machine, and how the run ended.

use super::{PROGRAM, RunDirectory, RunError, STABILITY, Verdict};
use crate::equilibrium::Stability;
use crate::study::{Ending, HalfRange, Plan, Row, Scale};
use serde::Serialize;
use std::time::{SystemTime, UNIX_EPOCH};

/// The content of `manifest.json`.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Manifest {
    /// Always `plica`.
    pub program: &'static str,
    /// Version of the program.
    pub version: String,
    /// Title of the case.
    pub title: String,
    /// BLAKE3 of `case.toml`.
    pub case_hash: String,
    /// File of the state that the run started from, as the case names it; none at rest.
    pub start_state: Option<String>,
    /// Files of the modes that give imperfections their shapes, as the case names them.
    pub imperfection_modes: Vec<String>,
    /// Architecture and operating system.
    pub machine: String,
    /// Number of threads.
    pub threads: usize,
    /// Unit of lengths in the tables.
    pub length_unit: String,
    /// Unit of energies in the tables.
    pub energy_unit: String,
    /// Unit of pressures in the tables.
    pub stress_unit: String,
    /// Unit of forces in the tables.
    pub force_unit: String,
    /// Unit of moments in the tables.
    pub moment_unit: String,
    /// Seconds since 1970 at the start.
    pub started_unix: u64,
    /// Time, version and machine of every resumption.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resumed: Vec<serde_json::Value>,
    /// Seconds since 1970 at the end; none while it runs.
    pub ended_unix: Option<u64>,
    /// Verdict on the run.
    pub verdict: Verdict,
    /// The verdict in a sentence.
    pub verdict_text: String,
    /// Condition at which the run was asked to stop, and did; `plica resume` goes on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until: Option<String>,
    /// Number of accepted states, rest included.
    pub states: usize,
    /// Number of states out of equilibrium, which a pseudo-time scheme may accept.
    pub states_out_of_equilibrium: usize,
    /// Number of unstable states.
    pub states_unstable: usize,
    /// Number of states whose stability was not determined.
    pub states_untested: usize,
    /// Number of states in which a wall crosses itself.
    pub states_crossing: usize,
    /// Number of states in which the lumen is closed.
    pub states_closed: usize,
    /// Number of states in which a wall touches itself; none without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub states_touching: Option<usize>,
    /// Number of states in which a crease may be finer than the mesh; none without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub states_unresolved: Option<usize>,
    /// True in a run with friction, which the stability test leaves out; none without friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stability_without_friction: Option<bool>,
    /// Changes of the last state with half the range of contact; none if it touches nothing or was not reached.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_contact_range: Option<HalfRange>,
    /// Profiles and saved states that are missing or damaged at the end of the run.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub missing_files: Vec<String>,
    /// States and modes that `plica stability` has tested; none if it has not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stability: Option<serde_json::Value>,
    /// True once the pictures are drawn and temporary files are removed.
    pub closed: bool,
}

impl Manifest {
    /// Returns the manifest at the start of a run.
    pub fn begin(plan: &Plan, directory: &RunDirectory) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            program: PROGRAM,
            version: env!("CARGO_PKG_VERSION").into(),
            title: plan.title.clone(),
            case_hash: directory.case_hash().to_owned(),
            start_state: plan.start.as_ref().map(|start| start.file.clone()),
            imperfection_modes: plan.modes.iter().map(|mode| mode.file.clone()).collect(),
            machine: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
            threads: rayon::current_num_threads(),
            length_unit: scale.length_name,
            energy_unit: scale.energy_name,
            stress_unit: scale.stress_name,
            force_unit: scale.force_name,
            moment_unit: scale.moment_name,
            started_unix: now(),
            resumed: vec![],
            ended_unix: None,
            verdict: Verdict::Running,
            verdict_text: "the run has not ended (or was killed)".into(),
            until: None,
            states: 0,
            states_out_of_equilibrium: 0,
            states_unstable: 0,
            states_untested: 0,
            states_crossing: 0,
            states_closed: 0,
            states_touching: plan.contact.then_some(0),
            states_unresolved: plan.contact.then_some(0),
            half_contact_range: None,
            stability_without_friction: plan.has_friction().then_some(true),
            missing_files: vec![],
            stability: None,
            closed: false,
        }
    }

    /// Returns the manifest of a resumed run; the entries of its first start stay.
    pub fn resume(plan: &Plan, directory: &RunDirectory) -> Self {
        let now = Self::begin(plan, directory);
        let before = directory.manifest();
        let mut resumed = before["resumed"].as_array().cloned().unwrap_or_default();
        resumed.push(serde_json::json!({
            "unix": now.started_unix,
            "version": now.version,
            "machine": now.machine,
            "threads": now.threads,
        }));
        let text = |name: &str, now: String| before[name].as_str().map_or(now, String::from);
        let number = |name: &str, now: u64| before[name].as_u64().unwrap_or(now);
        Self {
            version: text("version", now.version),
            machine: text("machine", now.machine),
            threads: number("threads", now.threads as u64) as usize,
            started_unix: number("started_unix", now.started_unix),
            resumed,
            stability: before.get(STABILITY).cloned(),
            ..now
        }
    }

    /// Closes the manifest at the end of a run.
    pub fn end(&mut self, ending: &Ending, rows: &[Row]) {
        let (verdict, text) = match (ending, &self.until) {
            (Ending::Complete, Some(condition)) => (
                Verdict::Complete,
                format!("stopped at the first state with {condition}, as asked"),
            ),
            (Ending::Complete, None) => (Verdict::Complete, "every stage was completed".into()),
            (Ending::Stopped, _) => (
                Verdict::Stopped,
                "stopped on request; every state so far is kept".into(),
            ),
            (Ending::Lost(lost), _) => (Verdict::Lost, lost.to_string()),
        };
        self.close(verdict, text, rows);
    }

    /// Closes the manifest after an error of the program: a result is not finite.
    pub fn fail(&mut self, error: &RunError, rows: &[Row]) {
        self.close(Verdict::Lost, error.to_string(), rows);
    }

    /// Closes the manifest where another program has changed the files of the run.
    pub fn halt(&mut self, error: &RunError, rows: &[Row]) {
        self.close(Verdict::Stopped, error.to_string(), rows);
    }

    fn close(&mut self, verdict: Verdict, text: String, rows: &[Row]) {
        self.ended_unix = Some(now());
        self.verdict = verdict;
        self.verdict_text = text;
        self.states = rows.len();
        let count = |condition: fn(&Row) -> bool| rows.iter().filter(|row| condition(row)).count();
        self.states_out_of_equilibrium = count(|row| !row.in_equilibrium);
        self.states_unstable = count(|row| row.stability.is_unstable());
        self.states_untested = count(|row| row.stability == Stability::Unknown);
        self.states_crossing = count(Row::crosses_itself);
        self.states_closed = count(Row::has_closed);
        let touching = count(|row| row.contact.touches());
        self.states_touching = self.states_touching.map(|_| touching);
        let unresolved = count(|row| row.contact.is_unresolved());
        self.states_unresolved = self.states_unresolved.map(|_| unresolved);
    }
}

fn now() -> u64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |d| d.as_secs())
}
