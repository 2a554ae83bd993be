//! Headline and warnings of a run as sentences.

use super::Run;
use super::scene::Scene;
use crate::report::VISIBLE_ASYMMETRY;
use plica::equilibrium::Stability;
use plica::measure::{Shape, Side};
use plica::run_directory::Verdict;
use plica::solve::Method;
use plica::study::findings::Unstable;
use plica::study::{Findings, Row, Scale};
use plica::tube::Symmetry;

/// Returns sentences on the end of the run and the final shape of the tube.
pub fn headline(run: &Run<'_>, findings: &Findings) -> String {
    let recorded = run.directory.state_count().unwrap_or(0);
    let missing = recorded.saturating_sub(run.rows.len());
    if missing > 0 {
        return format!(
            "Only {} of the {recorded} states of the run could be read; this page shows these.",
            run.rows.len()
        );
    }
    let ended = match (run.directory.verdict(), run.directory.stopped_at()) {
        (Verdict::Complete, Some(condition)) => {
            format!("The run was stopped at the first state with {condition}, as asked.")
        }
        (Verdict::Complete, None) => "All stages were completed.".into(),
        (Verdict::Lost, _) => "No equilibrium was found beyond the last state.".into(),
        (Verdict::Stopped, _) => "The run was stopped before it was complete.".into(),
        (Verdict::Running, _) => "The run is still in progress or was killed.".into(),
    };
    let mut sentences = vec![ended];
    if let Some(last) = run.rows.last() {
        sentences.extend(final_shape(run, last, findings));
        sentences.extend(unstable(findings));
    }
    sentences.join(" ")
}

/// Describes the deepest invagination and the last state.
fn final_shape(run: &Run<'_>, last: &Row, findings: &Findings) -> Vec<String> {
    let unit = &findings.length_unit;
    let scale = Scale::of(run.plan.units.as_ref());
    let is_invaginated = last.shape == Shape::Invaginated;
    let shape = match (last.side, is_invaginated) {
        (Side::None, _) | (_, false) => {
            format!("In the last state the tube is {}.", described(last.shape))
        }
        (side, true) => format!(
            "In the last state the tube invaginates toward the {} with an overhang of {:.3} {unit}.",
            last.name_of(side),
            last.overhang
        ),
    };
    let earlier = findings.deepest.iter().filter(|_| !is_invaginated);
    let earlier = earlier.map(|deepest| {
        format!(
            "It was invaginated before, most deeply in state {} with an overhang of {:.3} {unit}.",
            deepest.at.state, deepest.overhang
        )
    });
    let returned = findings.returned.iter().map(|found| {
        let same = if found.is_same {
            "is the same state: the tube has recovered"
        } else {
            "is another state: the tube has not recovered"
        };
        format!(
            "It has the load of state {} and {same}.",
            found.earlier.state
        )
    });
    // The prescribed imperfections make the first state asymmetric, too.
    let amplitude = match run.rows.first().map_or(0.0, |first| first.asymmetry) {
        0.0 => format!("{:.3} {unit}", last.asymmetry),
        start => format!(
            "{:.3} {unit}, from {start:.3} {unit} in the first state",
            last.asymmetry
        ),
    };
    let asymmetry = match last.asymmetry_mode {
        _ if last.asymmetry <= VISIBLE_ASYMMETRY * scale.length => None,
        1 => Some(format!(
            "It is not axisymmetric: its wall is displaced sideways by {amplitude}."
        )),
        2 => Some(format!(
            "It is not axisymmetric: its cross-section is oval with amplitude {amplitude}."
        )),
        n => Some(format!(
            "It is not axisymmetric: its wall has {n} circumferential waves with amplitude {amplitude}."
        )),
    };
    let caution = caution(last).map(|what| format!("There {what}."));
    std::iter::once(shape)
        .chain(earlier)
        .chain(returned)
        .chain(asymmetry)
        .chain(caution)
        .collect()
}

/// Returns the reason why a state is not physical or not an equilibrium, if any.
pub fn caution(row: &Row) -> Option<&'static str> {
    if row.crosses_itself() {
        Some("the wall penetrates itself, which is not physical")
    } else if row.has_closed() {
        Some("the lumen is closed, and the walls are not physical where they meet")
    } else if !row.in_equilibrium {
        Some("it is not in equilibrium")
    } else {
        None
    }
}

fn described(shape: Shape) -> String {
    match shape {
        Shape::V | Shape::U => format!("narrowed to a {shape}"),
        Shape::Square => "narrowed, with square walls".into(),
        other => other.to_string(),
    }
}

/// Names the unstable modes and the states that are unstable to them.
fn unstable(findings: &Findings) -> Option<String> {
    let phrase = |unstable: &Unstable| {
        let steps: Vec<usize> = unstable
            .states
            .iter()
            .flat_map(|interval| interval.first.state..=interval.last.state)
            .collect();
        format!("to {} in {}", unstable.description, states(&steps))
    };
    let phrases: Vec<String> = findings.unstable.iter().map(phrase).collect();
    let leaves = findings.leaves.iter().map(|departure| {
        format!(
            " A tube with a small imperfection leaves this path at state {}.",
            departure.at.state
        )
    });
    let leaves: String = leaves.collect();
    (!phrases.is_empty())
        .then(|| format!("The path is unstable {}.{leaves}", phrases.join(", and ")))
}

/// Lists states by their numbers.
fn states(steps: &[usize]) -> String {
    match (steps.first(), steps.last()) {
        (Some(first), Some(last)) if steps.len() == 1 || first == last => format!("state {first}"),
        (Some(first), Some(last)) if last - first + 1 == steps.len() => {
            format!("states {first} to {last}")
        }
        (Some(first), Some(last)) => format!("{} states between {first} and {last}", steps.len()),
        _ => "no state".into(),
    }
}

/// Returns the warnings of a run.
pub fn warnings(run: &Run<'_>, scene: &Scene) -> Vec<String> {
    let mut warnings = vec![];
    let manifest = run.directory.manifest();
    if run.directory.verdict() != Verdict::Complete {
        let text = manifest["verdict_text"].as_str();
        let text = text.unwrap_or("the run is still in progress (or was killed)");
        warnings.push(format!("{}.", capital(text)));
    }
    warnings.extend(of_states(run.rows, run.plan.symmetry));
    let version = run.directory.version();
    let program = env!("CARGO_PKG_VERSION");
    if version != program {
        warnings.push(format!(
            "The run was computed by plica {version}; this page was made by plica {program}."
        ));
    }
    if scene.missing > 0 {
        warnings.push(format!(
            "At {} of the drawn points a field has no value: elements are inverted there, between the integration points that the run checks.",
            scene.missing
        ));
    }
    warnings.extend(
        run.unread
            .iter()
            .map(|what| format!("Could not read: {what}.")),
    );
    let drawn = run.states.len();
    if drawn == 0 {
        warnings.push(
            "No state is saved in full, so none can be drawn. Set `output.states_every` in the case to save states."
                .into(),
        );
        return warnings;
    }
    if run.left_out > 0 {
        warnings.push(format!(
            "{} of the saved states are not drawn in three dimensions to keep this page small; their numbers are included.",
            run.left_out
        ));
    }
    if run.saved < run.rows.len() {
        warnings.push(format!(
            "{} of {} states are saved in full; of the others only the numbers are shown.",
            run.saved,
            run.rows.len()
        ));
    }
    warnings
}

/// Returns the warnings about states.
fn of_states(rows: &[Row], symmetry: Symmetry) -> Vec<String> {
    let mut warnings = vec![];
    let mut warn = |which: &dyn Fn(&Row) -> bool, what: &str| {
        let steps: Vec<usize> = rows
            .iter()
            .filter(|row| which(row))
            .map(|row| row.step)
            .collect();
        if !steps.is_empty() {
            warnings.push(format!("{}: {what}", capital(&states(&steps))));
        }
    };
    warn(
        &|row| !row.in_equilibrium,
        "accepted without equilibrium, as the scheme of the case permits.",
    );
    warn(
        &|row| row.crosses_itself() && !row.has_contact(),
        "the wall penetrates itself. There is no contact, so the result is not physical there.",
    );
    warn(
        &|row| row.crosses_itself() && row.has_contact(),
        "the wall penetrates itself, which contact rules out: please report it.",
    );
    warn(
        &|row| row.has_closed(),
        "the lumen is closed. There is no contact between opposite walls, so the result is not physical there.",
    );
    warn(
        &|row| row.contact.is_unresolved(),
        "a wall turns by more than 20° within one element: a crease may be finer than the mesh (mesh.refine).",
    );
    warn(
        &|row| row.method == Method::Relaxation && row.step > 0,
        "found by relaxation after Newton's method had failed; the state may be on another branch than the previous one.",
    );
    let unstable = |row: &Row, admitted: bool| {
        let mut modes = row.stability.unstable_modes();
        modes.any(|mode| mode.is_admitted_by(symmetry) == admitted)
    };
    warn(
        &|row| unstable(row, true),
        "unstable to modes that this run can represent: a saddle point of the energy, which a real tube would leave.",
    );
    warn(
        &|row| unstable(row, false),
        "unstable to circumferential modes that the symmetry of the run suppresses; a real tube would leave this state.",
    );
    warn(
        &|row| row.stability == Stability::Unknown,
        "stability not determined.",
    );
    warnings
}

/// Returns the sentence for a run without warnings. It names what was checked.
pub fn no_warnings(run: &Run<'_>) -> String {
    let tested = match run.plan.symmetry {
        Symmetry::Axisymmetric => format!(
            "no state is unstable (circumferential modes 0 to {} were tested)",
            run.plan.output.stability_modes
        ),
        _ => {
            "no negative eigenvalue was found within the permitted iterations, which is no proof of stability"
                .into()
        }
    };
    format!("No warnings: every state is in equilibrium, no wall penetrates itself, and {tested}.")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state without warnings.
    fn row(step: usize) -> Row {
        Row {
            step,
            method: Method::Newton,
            gap: 0.06,
            lumen: 0.8,
            ..Row::zero(&[], ["colon", "ileum"])
        }
    }

    #[test]
    fn states_are_listed_by_number() {
        assert_eq!(states(&[3]), "state 3");
        assert_eq!(states(&[3, 4, 5]), "states 3 to 5");
        assert_eq!(states(&[3, 5]), "2 states between 3 and 5");
    }

    #[test]
    fn a_regular_path_has_no_warnings() {
        assert!(of_states(&[row(0), row(1)], Symmetry::Axisymmetric).is_empty());
    }

    #[test]
    fn every_condition_has_a_warning() {
        let with = |change: fn(&mut Row)| {
            let mut rows = vec![row(0), row(1), row(2)];
            change(&mut rows[1]);
            rows
        };
        for (change, symmetry, words) in [
            (
                (|row| row.in_equilibrium = false) as fn(&mut Row),
                Symmetry::None,
                "without equilibrium",
            ),
            (|row| row.gap = 0.0, Symmetry::None, "penetrates itself"),
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
                "not determined",
            ),
            (
                |row| row.stability = "any:1".parse().unwrap(),
                Symmetry::None,
                "saddle point",
            ),
            (
                |row| row.stability = "1:2".parse().unwrap(),
                Symmetry::None,
                "saddle point",
            ),
            (
                |row| row.stability = "0:1".parse().unwrap(),
                Symmetry::Axisymmetric,
                "saddle point",
            ),
            (
                |row| row.stability = "1:2".parse().unwrap(),
                Symmetry::Axisymmetric,
                "suppresses",
            ),
            (
                |row| row.stability = "4:2".parse().unwrap(),
                Symmetry::Fold(2),
                "saddle point",
            ),
            (
                |row| row.stability = "3:2".parse().unwrap(),
                Symmetry::Fold(2),
                "suppresses",
            ),
        ] {
            let found = of_states(&with(change), symmetry);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(
                found[0].starts_with("State 1: ") && found[0].contains(words),
                "{found:?}"
            );
        }
    }
}
