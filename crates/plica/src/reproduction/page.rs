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
    pub verdict: Verdict,
}

/// What became of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Plica finds the same.
    Agrees,
    /// Plica does not get there, and the page shows why.
    Explained,
    /// Plica finds something else.
    Differs,
}

impl Verdict {
    /// Of a statement that either holds or does not.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Agrees } else { Self::Differs }
    }

    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Explained => "explained",
            Self::Differs => "differs",
        }
    }
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
    gap: Nearest,
    lumen: Nearest,
}

/// Where along a run walls are nearest, and from where on they have met.
#[derive(Clone, Debug, PartialEq)]
struct Nearest {
    least: f64,
    at: String,
    met: Option<String>,
}

impl Nearest {
    fn of(rows: &[Row], distance: fn(&Row) -> f64) -> Self {
        let least = rows
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let met = rows.iter().find(|row| distance(row) <= 0.0);
        Self {
            least: least.map_or(f64::INFINITY, distance),
            at: least.map_or_else(String::new, place),
            met: met.map(place),
        }
    }

    /// As a cell of a table.
    fn told(&self) -> String {
        match &self.met {
            Some(from) => format!("**met** from {from} on"),
            None => format!("{:.3} at {}", self.least, self.at),
        }
    }
}

/// Where on the path a state is.
fn place(row: &Row) -> String {
    format!("{:.2}", row.length_ratio)
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

    /// A statement that agrees if it holds, and differs if not.
    pub(super) fn claim(&mut self, panel: &'static str, paper: &str, found: String, holds: bool) {
        self.judge(panel, paper, found, Verdict::of(holds));
    }

    pub(super) fn judge(
        &mut self,
        panel: &'static str,
        paper: &str,
        found: String,
        verdict: Verdict,
    ) {
        self.claims.push(Claim {
            panel,
            paper: paper.into(),
            found,
            verdict,
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
            gap: Nearest::of(&ran.rows, |row| row.gap),
            lumen: Nearest::of(&ran.rows, |row| row.lumen),
        });
    }

    /// How many claims got a verdict.
    pub fn told(&self, verdict: Verdict) -> usize {
        let has = |claim: &&Claim| claim.verdict == verdict;
        self.claims.iter().filter(has).count()
    }

    /// Claims that are not met, and 1 if the figure could not be told to the end.
    pub fn failed(&self) -> usize {
        self.told(Verdict::Differs) + usize::from(self.trouble.is_some())
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
                took.gap.told(),
                took.lumen.told(),
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
            "gap, D",
            "lumen, D",
        ];
        page += "Nothing keeps walls apart here, as in the paper: the last two columns say how near the wall comes to itself along a \
                 meridian, and how narrow the lumen gets, with the Lmax/L of that state; past a state where walls have met nothing \
                 is physical.\n\n";
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
            verdict(claim),
        ]
    });
    let heads = ["", "the paper", "Plica", ""].map(String::from);
    table(&heads, &rows.collect::<Vec<_>>())
}

/// In a word, loud where it differs.
pub(super) fn verdict(claim: &Claim) -> String {
    let word = claim.verdict.word();
    match claim.verdict {
        Verdict::Differs => format!("**{word}**"),
        _ => word.into(),
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
