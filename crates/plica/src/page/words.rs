//! What a run came to, in sentences.

use super::Told;
use crate::study::{Findings, Row};

/// How the run ended and what the tube did, in a sentence or two.
pub fn headline(told: &Told<'_>, findings: &Findings<'_>) -> String {
    let verdict = told.directory.verdict();
    let ended = match verdict.as_str() {
        "complete" => "Every stage was done.",
        "lost" => "The tube could not be followed to the end.",
        "stopped" => "The run was stopped before its end.",
        _ => "The run has not ended, or was killed.",
    };
    let unit = &findings.scale.length_name;
    let last = findings.rows.last();
    let did = last.map(|last| match (findings.side(), last.shape.as_str()) {
        ("none", "straight") => "The tube stays straight.".to_owned(),
        ("none", shape) => format!("At its last state the tube is {}.", shaped(shape)),
        (side, _) => format!(
            "The tube invaginates toward the {side}, {:.3} {unit} deep.",
            last.overhang
        ),
    });
    let leans = last.filter(|last| last.departure > super::VISIBLE * findings.scale.length);
    let leans = leans.map(|last| {
        let waves = last.departure_harmonic;
        let far = format!("{:.3} {unit}", last.departure);
        format!(
            "It is not axisymmetric: its wall {} by {far}.",
            match waves {
                1 => "has moved sideways".to_owned(),
                2 => "is oval".to_owned(),
                n => format!("has {n} waves around"),
            }
        )
    });
    let words = [Some(ended.to_owned()), did, leans];
    words.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

fn shaped(shape: &str) -> String {
    match shape {
        "V" | "U" => format!("narrowed to a {shape}"),
        "square" => "narrowed, with square walls".into(),
        other => other.to_owned(),
    }
}

/// What a reader must know before trusting it.
pub fn warnings(told: &Told<'_>, left_out: usize) -> Vec<String> {
    let mut warnings = vec![];
    let manifest = told.directory.manifest();
    let verdict = told.directory.verdict();
    if verdict != "complete" {
        let text = manifest["verdict_text"]
            .as_str()
            .unwrap_or("the run has not ended");
        warnings.push(format!("{}.", capital(text)));
    }
    let mut count = |which: fn(&Row) -> bool, what: &str| {
        let steps: Vec<usize> = told
            .rows
            .iter()
            .filter(|row| which(row))
            .map(|row| row.step)
            .collect();
        if let (Some(first), Some(last)) = (steps.first(), steps.last()) {
            let states = match steps.len() {
                1 => format!("State {first}"),
                n if last - first + 1 == n => format!("States {first} to {last}"),
                n => format!("{n} states from {first} to {last}"),
            };
            warnings.push(format!("{states}: {what}"));
        }
    };
    count(
        |row| row.equilibrium == "no",
        "accepted out of equilibrium, as the case's scheme allows.",
    );
    count(
        |row| row.crosses_itself(),
        "the wall crosses itself; nothing holds it apart, and what it does there is not physical.",
    );
    count(
        |row| row.has_closed(),
        "the lumen is closed; nothing holds opposite walls apart, and what they do there is not physical.",
    );
    count(
        |row| row.method == "relaxation",
        "found by relaxation; the path before ended there, or was lost sight of, and the tube went down in energy to another state.",
    );
    count(
        |row| row.lost_harmonics().any(|n| n != "unknown"),
        "unstable, if only to what their symmetry does not let happen here.",
    );
    count(
        |row| row.lost_harmonics().any(|n| n == "unknown"),
        "not shown to be stable or unstable.",
    );
    let version = told.directory.written_by();
    let own = env!("CARGO_PKG_VERSION");
    if version != own {
        warnings.push(format!(
            "The run was written by plica {version}, this page by {own}."
        ));
    }
    if left_out > 0 {
        warnings.push(format!("{left_out} of the saved states are not drawn in three dimensions, so that this page stays small; their numbers are all here."));
    }
    if told.states.len() < told.rows.len() {
        warnings.push(format!(
            "{} of {} states are saved in full; the others have their numbers here, and no picture.",
            told.states.len(),
            told.rows.len()
        ));
    }
    warnings
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
