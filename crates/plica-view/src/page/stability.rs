//! What is known of a run's stability, as tables and sentences.

use super::Run;
use super::sheet::Picture;
use serde::Serialize;

/// The section of the page.
#[derive(Serialize)]
pub struct Stability {
    /// What was tested, and what came of it.
    words: String,
    /// What the table shows.
    caption: &'static str,
    heads: Vec<String>,
    lines: Vec<Vec<String>>,
    pictures: Vec<Picture>,
}

impl Stability {
    /// From what `plica stability` has left, if it has.
    pub fn of(run: &Run<'_>) -> Self {
        let table = |name: &str| run.directory.records(name);
        match (table("stability.csv"), table("eigenvalues.csv"), table("eigenpairs.csv")) {
            (Some(changes), Some(eigenvalues), _) => Self::of_harmonics(run, changes, &eigenvalues),
            (.., Some(pairs)) => Self::of_modes(run, pairs),
            _ => Self {
                words: "Each state's row below says what it is unstable to, as far as the run has looked. More is found by `plica stability` on the \
                        directory of this run; make this page again after it."
                    .into(),
                caption: "",
                heads: vec![],
                lines: vec![],
                pictures: vec![],
            },
        }
    }

    /// Of an axisymmetric run.
    fn of_harmonics(
        run: &Run<'_>,
        mut changes: Vec<Vec<String>>,
        eigenvalues: &[Vec<String>],
    ) -> Self {
        let mut heads = if changes.is_empty() {
            vec![]
        } else {
            changes.remove(0)
        };
        let column = |name: &str| heads.iter().position(|head| head == name);
        if let (Some(critical), Some(how)) = (column("critical"), column("how")) {
            for line in &mut changes {
                // Half way between two states is no critical value where the path jumps, or was not followed.
                match line[how].as_str() {
                    "snap" => line[critical] = "a snap".into(),
                    "unfollowed" => line[critical] = "unknown".into(),
                    _ => {}
                }
            }
        }
        for head in &mut heads {
            *head = head.replace('_', " ");
        }
        let words = tested(eigenvalues, changes.is_empty());
        Self {
            words,
            caption: "Where the path loses or regains stability, harmonic by harmonic; lengths in D, pressures in E.",
            heads,
            lines: changes,
            pictures: Picture::those(
                run,
                &[
                    (
                        "stability.png",
                        "Lowest eigenvalues along the path. Where one falls below zero the tube leaves it in that harmonic.",
                    ),
                    ("mode.png", "The first mode in which it does."),
                ],
            ),
        }
    }

    /// Of a run in three dimensions.
    fn of_modes(run: &Run<'_>, mut pairs: Vec<Vec<String>>) -> Self {
        let heads = if pairs.is_empty() {
            vec![]
        } else {
            pairs.remove(0)
        };
        let value = heads.iter().position(|head| head == "eigenvalue");
        let negative = |line: &&Vec<String>| {
            let value = value.and_then(|value| line.get(value)?.parse::<f64>().ok());
            value.is_some_and(|value| value < 0.0)
        };
        let state = |line: &Vec<String>| line.first().cloned().unwrap_or_default();
        let mut unstable: Vec<String> = pairs.iter().filter(negative).map(state).collect();
        unstable.dedup();
        let words = if unstable.is_empty() {
            "No lowest eigenvalue that was found is negative.".into()
        } else {
            format!(
                "Negative eigenvalues were found of state{} {}.",
                if unstable.len() == 1 { "" } else { "s" },
                unstable.join(", ")
            )
        };
        Self {
            words,
            caption: "Lowest eigenvalues of the states' own tangent, in E/D², and the share of each harmonic in their modes.",
            heads: heads.iter().map(|head| head.replace('_', " ")).collect(),
            lines: pairs,
            pictures: Picture::those(
                run,
                &[
                    ("stability.png", "Lowest eigenvalues, state by state."),
                    (
                        "mode.png",
                        "The first unstable state, or else the last one looked at, and the tube displaced by its lowest modes.",
                    ),
                ],
            ),
        }
    }
}

/// What the eigenvalues of all harmonics say, and whether that changes anywhere.
fn tested(eigenvalues: &[Vec<String>], steady: bool) -> String {
    let Some((heads, lines)) = eigenvalues.split_first() else {
        return String::new();
    };
    let negative = heads.iter().enumerate();
    let negative = negative.filter_map(|(i, head)| Some((i, head.strip_prefix("negative_")?)));
    let negative: Vec<(usize, &str)> = negative.collect();
    let highest = negative.last().map_or("0", |(_, n)| n);
    let lost = negative.iter().filter(|(i, _)| {
        let is = |line: &Vec<String>| {
            line.get(*i)
                .is_some_and(|count| count != "0" && !count.is_empty())
        };
        lines.iter().any(is)
    });
    let lost: Vec<&str> = lost.map(|(_, n)| *n).collect();
    match (lost.is_empty(), steady) {
        (true, _) => format!(
            "Every saved state is stable to harmonics 0 to {highest}, as far as was tested."
        ),
        (false, true) => format!(
            "The path begins unstable to harmonic(s) {} and stays so; harmonics 0 to {highest} were tested.",
            lost.join(", ")
        ),
        (false, false) => format!(
            "Harmonics 0 to {highest} were tested; somewhere on the path it is unstable to {}.",
            lost.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[&str]) -> Vec<Vec<String>> {
        let cells = |row: &&str| row.split(',').map(String::from).collect();
        rows.iter().map(cells).collect()
    }

    #[test]
    fn a_path_without_changes_is_not_stable_for_that() {
        let heads = "state,negative_0,negative_1,lowest_0,lowest_1";
        let stable = table(&[heads, "0,0,0,1.0,1.0", "1,0,0,1.0,0.5"]);
        assert!(tested(&stable, true).contains("stable to harmonics 0 to 1"));
        let unstable = table(&[heads, "0,0,2,1.0,-1.0", "1,0,2,1.0,-0.5"]);
        let words = tested(&unstable, true);
        assert!(
            words.contains("begins unstable to harmonic(s) 1"),
            "{words}"
        );
        let lost = table(&[heads, "0,0,0,1.0,1.0", "1,0,1,1.0,-0.5"]);
        let words = tested(&lost, false);
        assert!(
            words.contains("somewhere on the path it is unstable to 1"),
            "{words}"
        );
    }
}
