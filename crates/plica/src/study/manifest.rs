//! `manifest.json`: what was run, where, and how it ended.

use super::summary::Ending;
use super::units::Scale;
use super::{Plan, Row, RunDirectory, StudyError};
use serde::Serialize;
use std::time::{SystemTime, UNIX_EPOCH};

/// The content of `manifest.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Manifest {
    /// Always `plica`.
    pub program: &'static str,
    /// Version of the program.
    pub version: String,
    /// Title of the case.
    pub title: String,
    /// BLAKE3 of `case.toml`.
    pub case_hash: String,
    /// The state that the run began from, as the case names it; none at rest.
    pub start_state: Option<String>,
    /// The modes that imperfections have the shape of, as the case names them.
    pub imperfection_modes: Vec<String>,
    /// Architecture and operating system.
    pub machine: String,
    /// Threads of the run.
    pub threads: usize,
    /// Unit of lengths in the tables.
    pub length_unit: String,
    /// Unit of energies in the tables.
    pub energy_unit: String,
    /// Unit of pressures in the tables.
    pub stress_unit: String,
    /// Seconds since 1970 at the start.
    pub started_unix: u64,
    /// When and by what it was taken up again, each time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub resumed: Vec<serde_json::Value>,
    /// Seconds since 1970 at the end; none while it runs.
    pub ended_unix: Option<u64>,
    /// running, complete, stopped or lost.
    pub verdict: String,
    /// The verdict in a sentence.
    pub verdict_text: String,
    /// Accepted states, rest included.
    pub states: usize,
    /// States that are not in equilibrium (a pseudo-time scheme may accept such).
    pub states_out_of_equilibrium: usize,
    /// States that are unstable.
    pub states_unstable: usize,
    /// Whether its pictures are drawn, and what only a run needs that goes on is not.
    pub closed: bool,
}

impl Manifest {
    /// At the start of a run.
    pub fn begin(plan: &Plan, directory: &RunDirectory) -> Self {
        let scale = Scale::of(plan.units.as_ref());
        Self {
            program: super::directory::PROGRAM,
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
            started_unix: now(),
            resumed: vec![],
            ended_unix: None,
            verdict: "running".into(),
            verdict_text: "the run has not ended (or was killed)".into(),
            states: 0,
            states_out_of_equilibrium: 0,
            states_unstable: 0,
            closed: false,
        }
    }

    /// Where a run is taken up again: by what it was begun stays.
    pub fn again(plan: &Plan, directory: &RunDirectory) -> Self {
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
            ..now
        }
    }

    /// At its end.
    pub fn end(&mut self, ending: &Ending, rows: &[Row]) {
        self.close(ending.name(), ending.to_string(), rows);
    }

    /// At an end that is a fault of the program: a number of a state is none.
    pub fn fail(&mut self, error: &StudyError, rows: &[Row]) {
        self.close("lost", error.to_string(), rows);
    }

    fn close(&mut self, verdict: &str, text: String, rows: &[Row]) {
        self.ended_unix = Some(now());
        self.verdict = verdict.into();
        self.verdict_text = text;
        self.states = rows.len();
        self.states_out_of_equilibrium = rows.iter().filter(|r| r.equilibrium == "no").count();
        self.states_unstable = rows
            .iter()
            .filter(|r| !["none", "unknown"].contains(&r.unstable_modes.as_str()))
            .count();
    }
}

fn now() -> u64 {
    SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |d| d.as_secs())
}
