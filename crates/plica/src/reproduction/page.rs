//! What a figure has to tell: claims and what became of them, tables, pictures.

use super::runs::Ran;
use super::{Figure, Fineness};
use crate::study::Row;
use std::fmt::Write;

/// A statement of the paper beside what Plica finds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// The part of the figure: `3A`.
    pub panel: &'static str,
    /// What the paper states.
    pub paper: String,
    /// What Plica finds.
    pub found: String,
    /// Whether that agrees.
    pub agrees: bool,
}

/// A run, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Took {
    name: String,
    case: &'static str,
    mesh: String,
    scheme: String,
    states: usize,
    solves: usize,
    cg_iterations: usize,
    seconds: f64,
    verdict: String,
}

/// Something on a page, in its order.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A paragraph, in Markdown.
    Text(String),
    /// A table: heads and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A picture: name of its file, PNG bytes, what it shows.
    Picture(String, Vec<u8>, String),
}

/// The page of a figure.
pub struct Page {
    /// The figure.
    pub figure: &'static Figure,
    /// Its claims.
    pub claims: Vec<Claim>,
    /// Whatever else it tells.
    pub items: Vec<Item>,
    /// The runs that were looked at.
    pub took: Vec<Took>,
    /// Why it could not be told to the end.
    pub trouble: Option<String>,
}

impl Page {
    pub(super) fn new(figure: &'static Figure) -> Self {
        Self {
            figure,
            claims: vec![],
            items: vec![],
            took: vec![],
            trouble: None,
        }
    }

    pub(super) fn claim(&mut self, panel: &'static str, paper: &str, found: String, agrees: bool) {
        self.claims.push(Claim {
            panel,
            paper: paper.into(),
            found,
            agrees,
        });
    }

    pub(super) fn text(&mut self, text: impl Into<String>) {
        self.items.push(Item::Text(text.into()));
    }

    pub(super) fn table(&mut self, heads: &[&str], rows: Vec<Vec<String>>) {
        let heads = heads.iter().map(ToString::to_string).collect();
        self.items.push(Item::Table(heads, rows));
    }

    pub(super) fn picture(&mut self, name: &str, png: Vec<u8>, caption: impl Into<String>) {
        let name = format!("{}-{name}.png", self.figure.name);
        self.items.push(Item::Picture(name, png, caption.into()));
    }

    /// Takes down what a run took, once.
    pub(super) fn took(&mut self, ran: &Ran) {
        if self.took.iter().any(|took| took.name == ran.job.name) {
            return;
        }
        let (plan, mesh) = (&ran.plan, &ran.plan.mesh);
        let rings = match plan.mesh.rings(plan.symmetry) {
            1 => "axisymmetric".to_owned(),
            n if n == mesh.around => "whole".to_owned(),
            n => format!("repeats {} times", mesh.around / n),
        };
        self.took.push(Took {
            name: ran.job.name.clone(),
            case: ran.job.case,
            mesh: format!(
                "{} × {} × {}, {rings}",
                mesh.axial, mesh.around, mesh.thickness
            ),
            scheme: plan.solver.scheme.to_string(),
            states: ran.rows.len(),
            solves: ran.solves(),
            cg_iterations: ran.cg_iterations(),
            seconds: ran.seconds(),
            verdict: ran.verdict.clone(),
        });
    }

    /// Claims that are not met, and 1 if the figure could not be told to the end.
    pub fn failed(&self) -> usize {
        let differ = self.claims.iter().filter(|claim| !claim.agrees).count();
        differ + usize::from(self.trouble.is_some())
    }

    /// The name of its file.
    pub fn file(&self) -> String {
        format!("{}.md", self.figure.name)
    }

    /// The page, in Markdown.
    pub fn markdown(&self, fineness: Fineness) -> String {
        let Figure { title, paper, .. } = self.figure;
        let mut page = format!("# {title}\n\n{}\n\n{paper}\n\n", fineness.sentence());
        if let Some(trouble) = &self.trouble {
            let _ = writeln!(page, "**Not told to the end: {trouble}**\n");
        }
        page += &claims(&self.claims);
        for item in &self.items {
            page.push('\n');
            match item {
                Item::Text(text) => page += &format!("{text}\n"),
                Item::Table(heads, rows) => page += &table(heads, rows),
                Item::Picture(name, _, caption) => {
                    page += &format!("![{caption}]({name})\n\n*{caption}*\n");
                }
            }
        }
        page += "\n## What was run\n\n";
        let rows = self.took.iter().map(|took| {
            let lost = if took.verdict == "complete" {
                ""
            } else {
                " (lost)"
            };
            vec![
                format!("`{}`{lost}", took.name),
                format!("`cases/{}.toml`", took.case),
                took.mesh.clone(),
                took.scheme.clone(),
                took.states.to_string(),
                took.solves.to_string(),
                took.cg_iterations.to_string(),
                format!("{:.1}", took.seconds),
            ]
        });
        let heads = [
            "run",
            "case",
            "control points",
            "scheme",
            "states",
            "solves",
            "CG iterations",
            "seconds",
        ];
        page += &table(&heads.map(String::from), &rows.collect::<Vec<_>>());
        page
    }
}

/// Claims as a table.
pub(super) fn claims(claims: &[Claim]) -> String {
    let rows = claims.iter().map(|claim| {
        vec![
            claim.panel.to_owned(),
            claim.paper.clone(),
            claim.found.clone(),
            verdict(claim).to_owned(),
        ]
    });
    let heads = ["", "the paper", "Plica", ""].map(String::from);
    table(&heads, &rows.collect::<Vec<_>>())
}

/// In a word.
pub(super) fn verdict(claim: &Claim) -> &'static str {
    if claim.agrees {
        "agrees"
    } else {
        "**differs**"
    }
}

/// A table in Markdown.
fn table(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells = cells.iter().map(|cell| cell.replace('|', "\\|"));
        format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
    };
    let rule = format!("|{}\n", "---|".repeat(heads.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(heads) + &rule + &rows
}

/// How a state is told in a table: W with five digits.
pub(super) fn energy(row: &Row) -> String {
    format!("{:.4e}", row.energy)
}
