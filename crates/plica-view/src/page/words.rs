//! What a run came to, and what to beware of, in sentences.

use super::Run;
use super::scene::Scene;
use crate::report::VISIBLE;
use plica::equilibrium::{Stability, UnstableMode};
use plica::measure::{Shape, Side};
use plica::run_directory::Verdict;
use plica::solve::Method;
use plica::study::{Findings, Row};
use plica::tube::Symmetry;
use std::collections::BTreeMap;

/// How the run ended and what the tube did.
pub fn headline(run: &Run<'_>, findings: &Findings<'_>) -> String {
    let told = run.directory.state_count().unwrap_or(0);
    let missing = told.saturating_sub(run.rows.len());
    if missing > 0 {
        return format!(
            "Only {} of the run's {told} states could be read, and this page tells of no more.",
            run.rows.len()
        );
    }
    let ended = match run.directory.verdict() {
        Verdict::Complete => "Every stage was done.",
        Verdict::Lost => "The tube could not be followed to the end.",
        Verdict::Stopped => "The run was stopped before its end.",
        Verdict::Running => "The run has not ended, or was killed.",
    };
    let mut sentences = vec![ended.to_owned()];
    if let Some(last) = run.rows.last() {
        sentences.extend(did(last, findings));
        sentences.extend(unstable(run));
    }
    sentences.join(" ")
}

/// What became of the tube.
fn did(last: &Row, findings: &Findings<'_>) -> Vec<String> {
    let unit = &findings.scale.length_name;
    let shape = match (findings.side(), last.shape) {
        (Side::None, shape) => format!("At its last state the tube is {}.", shaped(shape)),
        (side, _) => format!(
            "The tube invaginates toward the {side}, with an overhang of {:.3} {unit}.",
            last.overhang
        ),
    };
    let far = format!("{:.3} {unit}", last.asymmetry);
    let leans = match last.asymmetry_mode {
        _ if last.asymmetry <= VISIBLE * findings.scale.length => None,
        1 => Some(format!(
            "It is not axisymmetric: its wall has moved sideways by {far}."
        )),
        2 => Some(format!(
            "It is not axisymmetric: its wall is oval, by {far}."
        )),
        n => Some(format!(
            "It is not axisymmetric: its wall has {n} waves around, of {far}."
        )),
    };
    let beware = beware(last).map(|what| format!("There {what}."));
    std::iter::once(shape).chain(leans).chain(beware).collect()
}

/// What makes of a state less than it seems.
pub fn beware(row: &Row) -> Option<&'static str> {
    if row.crosses_itself() {
        Some("its wall crosses itself, which is not physical")
    } else if row.has_closed() {
        Some("its lumen is closed, and what walls do there is not physical")
    } else if !row.in_equilibrium {
        Some("it is not in equilibrium")
    } else {
        None
    }
}

fn shaped(shape: Shape) -> String {
    match shape {
        Shape::V | Shape::U => format!("narrowed to a {shape}"),
        Shape::Square => "narrowed, with square walls".into(),
        other => other.to_string(),
    }
}

/// The harmonics that are lost, with the states they are lost at.
fn unstable(run: &Run<'_>) -> Option<String> {
    let mut lost: BTreeMap<UnstableMode, Vec<usize>> = BTreeMap::new();
    for row in run.rows {
        for mode in row.stability.unstable_modes() {
            lost.entry(mode).or_default().push(row.step);
        }
    }
    let told =
        (lost.iter()).map(|(mode, steps)| format!("to {} in {}", mode.describe(), states(steps)));
    let told: Vec<String> = told.collect();
    (!told.is_empty()).then(|| format!("Its path is unstable {}.", told.join(", and ")))
}

/// Some states by their numbers.
fn states(steps: &[usize]) -> String {
    match (steps.first(), steps.last()) {
        (Some(first), Some(last)) if steps.len() == 1 || first == last => format!("state {first}"),
        (Some(first), Some(last)) if last - first + 1 == steps.len() => {
            format!("states {first} to {last}")
        }
        (Some(first), Some(last)) => format!("{} states from {first} to {last}", steps.len()),
        _ => "no state".into(),
    }
}

/// Whether the run itself can go the way of a harmonic, or its symmetry keeps it from that.
fn own(symmetry: Symmetry, mode: UnstableMode) -> bool {
    use UnstableMode::{Circumferential, Lowest};
    match (symmetry, mode) {
        (_, Lowest | Circumferential(0)) | (Symmetry::None, _) => true,
        (Symmetry::Axisymmetric, _) => false,
        (Symmetry::Fold(m), Circumferential(n)) => n % m == 0,
    }
}

/// What a reader must know before trusting it.
pub fn warnings(run: &Run<'_>, scene: &Scene) -> Vec<String> {
    let mut warnings = vec![];
    let manifest = run.directory.manifest();
    if run.directory.verdict() != Verdict::Complete {
        let text = manifest["verdict_text"].as_str();
        let text = text.unwrap_or("the run has not ended (or was killed)");
        warnings.push(format!("{}.", capital(text)));
    }
    warnings.extend(of_states(run.rows, run.plan.symmetry));
    let version = run.directory.version();
    let program = env!("CARGO_PKG_VERSION");
    if version != program {
        warnings.push(format!(
            "The run was written by plica {version}, this page by {program}."
        ));
    }
    if scene.missing > 0 {
        warnings.push(format!(
            "At {} of the drawn points a field has no value: the wall is turned inside out there, between the points at which the run looks.",
            scene.missing
        ));
    }
    warnings.extend(run.unread.iter().map(|what| format!("Not read: {what}.")));
    let drawn = run.states.len();
    if drawn == 0 {
        warnings.push(
            "No state is saved in full that could be drawn; with `output.states_every` in its case the run would leave some."
                .into(),
        );
        return warnings;
    }
    if run.left_out > 0 {
        warnings.push(format!(
            "{} of the saved states are not drawn in three dimensions, so that this page stays small; their numbers are all here.",
            run.left_out
        ));
    }
    if run.saved < run.rows.len() {
        warnings.push(format!(
            "{} of {} states are saved in full; the others have their numbers here, and no picture.",
            run.saved,
            run.rows.len()
        ));
    }
    warnings
}

/// Those that the states give cause for.
fn of_states(rows: &[Row], symmetry: Symmetry) -> Vec<String> {
    let mut warnings = vec![];
    let mut those = |which: &dyn Fn(&Row) -> bool, what: &str| {
        let steps: Vec<usize> = rows
            .iter()
            .filter(|row| which(row))
            .map(|row| row.step)
            .collect();
        if !steps.is_empty() {
            warnings.push(format!("{}: {what}", capital(&states(&steps))));
        }
    };
    those(
        &|row| !row.in_equilibrium,
        "accepted out of equilibrium, as the case's scheme allows.",
    );
    those(
        &|row| row.crosses_itself(),
        "the wall crosses itself; nothing holds it apart, and what it does there is not physical.",
    );
    those(
        &|row| row.has_closed(),
        "the lumen is closed; nothing holds opposite walls apart, and what they do there is not physical.",
    );
    those(
        &|row| row.method == Method::Relaxation && row.step > 0,
        "found by relaxation after Newton's way along the path had failed: on another branch, it may be, than the state before.",
    );
    let lost = |row: &Row, to_own: bool| {
        let mut modes = row.stability.unstable_modes();
        modes.any(|mode| own(symmetry, mode) == to_own)
    };
    those(
        &|row| lost(row, true),
        "unstable to what this very run allows: saddles of the energy, which the tube would leave.",
    );
    those(
        &|row| lost(row, false),
        "unstable to harmonics that the run's symmetry keeps from growing; a whole tube would leave them.",
    );
    those(
        &|row| row.stability == Stability::Unknown,
        "not shown to be stable or unstable.",
    );
    warnings
}

/// What is said where nothing is to beware of: no more than was looked at.
pub fn all_well(run: &Run<'_>) -> String {
    let tested = match run.plan.symmetry {
        Symmetry::Axisymmetric => format!(
            "no state was found unstable (harmonics 0 to {} were tested; only 0 of one that is twisted)",
            run.plan.output.stability_modes
        ),
        _ => {
            "no negative eigenvalue showed in the iterations that were allowed, which proves little"
                .into()
        }
    };
    format!(
        "Nothing was found: every state is in equilibrium, no wall crosses itself, and {tested}."
    )
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state of which nothing is to be said.
    fn row(step: usize) -> Row {
        let csv = "step,stage,length_ratio,diameter_ratio,colon_displacement,ileum_displacement,colon_twist_deg,ileum_twist_deg,energy,\
            energy_ungrown_volume,residual,damping_work,method,equilibrium,iterations,cg_iterations,seconds,outer_radius_min,z_at_min,\
            max_wall_angle_deg,overhang,side,flatness,gap,lumen,shape,asymmetry,asymmetry_mode,asymmetry_angle_deg,min_det_fe,\
            unstable_modes\n0,s,1,1,0,0,0,0,0,0,0,0,newton,yes,4,0,0.1,0.5,1,0,0,none,0,0.06,0.8,V,0,0,0,1,none\n";
        let mut table = csv::Reader::from_reader(csv.as_bytes());
        let mut row: Row = table.deserialize().next().unwrap().unwrap();
        row.step = step;
        row
    }

    #[test]
    fn states_are_named_by_their_numbers() {
        assert_eq!(states(&[3]), "state 3");
        assert_eq!(states(&[3, 4, 5]), "states 3 to 5");
        assert_eq!(states(&[3, 5]), "2 states from 3 to 5");
    }

    #[test]
    fn nothing_is_said_of_a_sound_path() {
        assert!(of_states(&[row(0), row(1)], Symmetry::Axisymmetric).is_empty());
    }

    #[test]
    fn every_trouble_has_its_sentence() {
        let with = |change: fn(&mut Row)| {
            let mut rows = vec![row(0), row(1), row(2)];
            change(&mut rows[1]);
            rows
        };
        for (change, symmetry, words) in [
            (
                (|row| row.in_equilibrium = false) as fn(&mut Row),
                Symmetry::None,
                "out of equilibrium",
            ),
            (|row| row.gap = 0.0, Symmetry::None, "crosses itself"),
            (
                |row| row.lumen = -1e-3,
                Symmetry::None,
                "the lumen is closed",
            ),
            (
                |row| row.method = Method::Relaxation,
                Symmetry::None,
                "another branch",
            ),
            (
                |row| row.stability = "unknown".parse().unwrap(),
                Symmetry::None,
                "not shown to be",
            ),
            (
                |row| row.stability = "any:1".parse().unwrap(),
                Symmetry::None,
                "saddles",
            ),
            (
                |row| row.stability = "1:2".parse().unwrap(),
                Symmetry::None,
                "saddles",
            ),
            (
                |row| row.stability = "0:1".parse().unwrap(),
                Symmetry::Axisymmetric,
                "saddles",
            ),
            (
                |row| row.stability = "1:2".parse().unwrap(),
                Symmetry::Axisymmetric,
                "keeps from growing",
            ),
            (
                |row| row.stability = "4:2".parse().unwrap(),
                Symmetry::Fold(2),
                "saddles",
            ),
            (
                |row| row.stability = "3:2".parse().unwrap(),
                Symmetry::Fold(2),
                "keeps from growing",
            ),
        ] {
            let told = of_states(&with(change), symmetry);
            assert_eq!(told.len(), 1, "{told:?}");
            assert!(
                told[0].starts_with("State 1: ") && told[0].contains(words),
                "{told:?}"
            );
        }
    }
}
