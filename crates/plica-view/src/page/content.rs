//! Data of a run for the template of the page.

use super::data::RunData;
use super::picture::Picture;
use super::stability::Stability;
use super::{Run, summary};
use crate::draw::label;
use crate::report::{Column, Role};
use plica::run_directory::Verdict;
use plica::study::{Findings, Row, Scale};
use serde::Serialize;

/// Text, tables and pictures of a run.
#[derive(Serialize)]
pub struct Content {
    name: String,
    title: String,
    headline: String,
    complete: bool,
    findings: Vec<(String, String)>,
    warnings: Vec<String>,
    /// Sentence shown if there are no warnings.
    no_warnings: String,
    case: String,
    /// Files that the case refers to.
    needs: Vec<String>,
    manifest: serde_json::Value,
    mesh: String,
    unknowns: usize,
    seconds: String,
    drawn: String,
    table: Vec<Line>,
    heads: Vec<String>,
    stability: Stability,
    pictures: Vec<Picture>,
}

/// A row of the table of states.
#[derive(Serialize)]
struct Line {
    step: usize,
    stage: String,
    shape: String,
    unstable: String,
    method: String,
    numbers: Vec<String>,
    drawn: bool,
}

impl Content {
    /// Collects the data of a run.
    pub fn of(run: &Run<'_>, columns: &[Column], data: &RunData) -> Self {
        let scale = Scale::of(run.plan.units.as_ref());
        let findings = Findings::of(run.rows, &scale, run.plan.symmetry);
        let tabled = columns.iter().filter(|c| c.role != Role::Other);
        let tabled: Vec<&Column> = tabled.collect();
        let line = |(i, row): (usize, &Row)| Line {
            step: row.step,
            stage: row.stage.clone(),
            shape: row.shape.to_string(),
            unstable: row.stability.to_string(),
            method: row.method.to_string(),
            numbers: tabled.iter().map(|c| number(c.values[i])).collect(),
            drawn: data.scene.rows.contains(&row.step),
        };
        let mesh = &run.plan.mesh;
        let [axial, around, thickness] = [mesh.axial, mesh.around, mesh.thickness];
        let rings = mesh.rings(run.plan.symmetry);
        let symmetry = match rings {
            1 => "axisymmetric".to_owned(),
            n if n == around => "the whole circumference".into(),
            n => format!("a sector of {n} rings repeated {} times", around / n),
        };
        let seconds: f64 = run.rows.iter().map(|row| row.seconds).sum();
        let case = run.directory.read("case.toml").unwrap_or_default();
        let [along, through, meridians] = data.scene.points;
        let modes = run.plan.modes.iter().map(|mode| mode.file.clone());
        let start = run.plan.start.iter().map(|start| start.file.clone());
        Self {
            name: run.name.clone(),
            title: run.plan.title.clone(),
            headline: summary::headline(run, &findings),
            complete: run.directory.verdict() == Verdict::Complete,
            findings: findings.lines().into_iter().map(formatted).collect(),
            warnings: summary::warnings(run, &data.scene),
            no_warnings: summary::no_warnings(run),
            case: String::from_utf8_lossy(&case).into_owned(),
            needs: start.chain(modes).collect(),
            manifest: run.directory.manifest(),
            mesh: format!("{axial} × {around} × {thickness} control points, {symmetry}"),
            unknowns: 3 * axial * rings * thickness,
            seconds: format!("{seconds:.1}"),
            drawn: if data.scene.drawn {
                format!(
                    "{along} × {} × {through} points per state (along, around, through the wall)",
                    meridians * data.scene.sectors
                )
            } else {
                "nothing, because no state is saved in full".into()
            },
            table: run.rows.iter().enumerate().map(line).collect(),
            heads: tabled.iter().map(|c| label::html(&c.label)).collect(),
            stability: Stability::of(run),
            pictures: Picture::read_all(
                run,
                &[
                    (
                        "tube.png",
                        "The tube cut open at selected states, coloured by strain energy density.",
                    ),
                    ("walls.png", "Outer and inner wall at the same states."),
                ],
            ),
        }
    }
}

/// Formats the units and numbers of a finding for the page.
fn formatted((name, words): (String, String)) -> (String, String) {
    let words = words
        .replace("D^3", "D³")
        .replace(" uJ", " µJ")
        .replace(" um", " µm");
    (name, with_superscripts(&words))
}

/// Formats a number for the table.
fn number(value: Option<f64>) -> String {
    match value {
        None => "–".into(),
        Some(0.0) => "0".into(),
        Some(x) if (1e-2..1e4).contains(&x.abs()) => format!("{x:.4}").replace('-', "−"),
        Some(x) => with_superscripts(&format!("{x:.3e}")),
    }
}

/// Replaces numbers such as -1.5e-4 by −1.5×10⁻⁴.
fn with_superscripts(text: &str) -> String {
    let format = |word: &str| {
        let end = word.trim_end_matches(|c: char| !c.is_ascii_digit()).len();
        let (bare, rest) = word.split_at(end);
        let begin = bare.len() - bare.trim_start_matches(|c: char| "(".contains(c)).len();
        let (before, bare) = bare.split_at(begin);
        match bare.split_once('e') {
            Some((mantissa, power)) if bare.parse::<f64>().is_ok() => {
                let power = label::plain(&format!("^{{{power}}}"));
                format!("{before}{}×10{power}{rest}", mantissa.replace('-', "−"))
            }
            _ => word.to_owned(),
        }
    };
    text.split(' ')
        .map(format)
        .collect::<Vec<String>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_powers_of_ten_become_superscripts() {
        assert_eq!(
            with_superscripts("W = -1.500e-4 D³ (residual 3e-12), 2 states, the end 1e5"),
            "W = −1.500×10⁻⁴ D³ (residual 3×10⁻¹²), 2 states, the end 1×10⁵"
        );
        assert_eq!(number(Some(1.5e-5)), "1.500×10⁻⁵");
        assert_eq!(number(Some(-0.25)), "−0.2500");
    }
}
