//! Stability of a run as sentences and tables.

use super::Run;
use super::picture::Picture;
use plica::run_directory::StabilityCoverage;
use serde::Serialize;

/// Data of the section on stability.
#[derive(Serialize)]
pub struct Stability {
    /// Summary of the tests.
    words: String,
    /// Caption of the table.
    caption: &'static str,
    heads: Vec<String>,
    lines: Vec<Vec<String>>,
    pictures: Vec<Picture>,
}

impl Stability {
    /// Reads the results of `plica stability`, if any.
    pub fn of(run: &Run<'_>) -> Self {
        let table = |name: &str| run.directory.records(name);
        match (table("stability.csv"), table("eigenvalues.csv"), table("eigenpairs.csv")) {
            (Some(changes), Some(eigenvalues), _) => Self::of_harmonics(run, changes, &eigenvalues),
            (.., Some(pairs)) => Self::of_modes(run, pairs),
            _ => Self {
                words: "The table of states shows the unstable modes that the run has found. Run `plica stability` on the directory of this \
                        run for critical loads and modes, then make this page again."
                    .into(),
                caption: "",
                heads: vec![],
                lines: vec![],
                pictures: vec![],
            },
        }
    }

    /// Section for an axisymmetric run.
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
                // The midpoint of two states is no critical value if the path snaps or could not be followed in between.
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
        let words = summary(eigenvalues, changes.is_empty()) + &gaps(run, eigenvalues);
        Self {
            words,
            caption: "Points where the path loses or regains stability, for each circumferential mode; lengths in D, pressures in E.",
            heads,
            lines: changes,
            pictures: Picture::read_all(
                run,
                &[
                    (
                        "stability.png",
                        "Lowest eigenvalues along the path. Where one is negative, the path is unstable to that circumferential mode.",
                    ),
                    ("mode.png", "The first unstable mode."),
                ],
            ),
        }
    }

    /// Section for a three-dimensional run.
    fn of_modes(run: &Run<'_>, mut pairs: Vec<Vec<String>>) -> Self {
        let gaps = gaps(run, &pairs);
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
        let words: String = if unstable.is_empty() {
            "All eigenvalues found are positive.".into()
        } else {
            format!(
                "Negative eigenvalues were found at state{} {}.",
                if unstable.len() == 1 { "" } else { "s" },
                unstable.join(", ")
            )
        };
        Self {
            words: words + &gaps,
            caption: "Lowest eigenvalues of the tangent, in E/D², and the share of each circumferential mode in their eigenvectors.",
            heads: heads.iter().map(|head| head.replace('_', " ")).collect(),
            lines: pairs,
            pictures: Picture::read_all(
                run,
                &[
                    ("stability.png", "Lowest eigenvalues of each state."),
                    (
                        "mode.png",
                        "The first unstable state, or else the last tested one, and the tube displaced by its lowest modes.",
                    ),
                ],
            ),
        }
    }
}

/// Returns a sentence on saved states that a table of tested states lacks; empty if it has all.
fn gaps(run: &Run<'_>, table: &[Vec<String>]) -> String {
    let Some((heads, lines)) = table.split_first() else {
        return String::new();
    };
    let state = heads.iter().position(|head| head == "state");
    let number = |line: &Vec<String>| line.get(state?)?.parse().ok();
    let mut states: Vec<usize> = lines.iter().filter_map(number).collect();
    states.sort_unstable();
    states.dedup();
    let highest_mode = None;
    let tested = StabilityCoverage {
        states,
        highest_mode,
    };
    let saved = run.directory.state_numbers().unwrap_or_default();
    tested.gaps(&saved).map_or(String::new(), |gaps| {
        format!(" But {gaps}: run `plica stability` on the directory of this run again.")
    })
}

/// Summarises the eigenvalues of all circumferential modes; `steady` means that no mode changes its stability.
fn summary(eigenvalues: &[Vec<String>], steady: bool) -> String {
    let Some((heads, lines)) = eigenvalues.split_first() else {
        return String::new();
    };
    let negative = heads.iter().enumerate();
    let negative = negative.filter_map(|(i, head)| Some((i, head.strip_prefix("negative_")?)));
    let negative: Vec<(usize, &str)> = negative.collect();
    let highest = negative.last().map_or("0", |(_, n)| n);
    let unstable = negative.iter().filter(|(i, _)| {
        let is = |line: &Vec<String>| {
            line.get(*i)
                .is_some_and(|count| count != "0" && !count.is_empty())
        };
        lines.iter().any(is)
    });
    let unstable: Vec<&str> = unstable.map(|(_, n)| *n).collect();
    match (unstable.is_empty(), steady) {
        (true, _) => {
            format!("Every tested state is stable to circumferential modes 0 to {highest}.")
        }
        (false, true) => format!(
            "The whole path is unstable to circumferential mode(s) {}; modes 0 to {highest} were tested.",
            unstable.join(", ")
        ),
        (false, false) => format!(
            "Circumferential modes 0 to {highest} were tested; part of the path is unstable to mode(s) {}.",
            unstable.join(", ")
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
    fn a_path_without_changes_may_be_unstable() {
        let heads = "state,negative_0,negative_1,lowest_0,lowest_1";
        let stable = table(&[heads, "0,0,0,1.0,1.0", "1,0,0,1.0,0.5"]);
        assert!(summary(&stable, true).contains("stable to circumferential modes 0 to 1"));
        let unstable = table(&[heads, "0,0,2,1.0,-1.0", "1,0,2,1.0,-0.5"]);
        let words = summary(&unstable, true);
        assert!(
            words.contains("whole path is unstable to circumferential mode(s) 1"),
            "{words}"
        );
        let changing = table(&[heads, "0,0,0,1.0,1.0", "1,0,1,1.0,-0.5"]);
        let words = summary(&changing, false);
        assert!(
            words.contains("part of the path is unstable to mode(s) 1"),
            "{words}"
        );
    }
}
