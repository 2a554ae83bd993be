//! Pages of figures: claims of the paper beside results of Plica, tables and pictures.

use super::runs::CompletedRun;
use super::{Figure, Fineness};
use plica::run_directory;
use plica::solve::Scheme;
use plica::study::Row;
use std::fmt::Write;

/// A statement of the paper with the result of Plica.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// Panel of the figure, for example `3A`.
    pub panel: &'static str,
    /// Statement of the paper.
    pub paper: String,
    /// Result of Plica.
    pub found: String,
    /// True if they agree.
    pub verdict: Verdict,
}

/// Comparison of a statement with the result of Plica.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The result is the same.
    Agrees,
    /// The result differs, or the state is not reached, and the page shows why.
    Explained,
    /// The result differs.
    Differs,
    /// The paper has no such statement.
    Added,
}

impl Verdict {
    /// Returns `Agrees` if the statement holds, otherwise `Differs`.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Agrees } else { Self::Differs }
    }

    /// Returns its name on pages.
    pub fn word(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Explained => "explained",
            Self::Differs => "differs",
            Self::Added => "added",
        }
    }
}

/// Size and cost of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunCost {
    name: String,
    case: &'static str,
    mesh: String,
    scheme: String,
    states: usize,
    solves: usize,
    cg_iterations: usize,
    seconds: f64,
    verdict: run_directory::Verdict,
    gap: String,
    lumen: String,
}

/// Smallest distance between walls along a run, and the states in which they have met.
#[derive(Clone, Debug, PartialEq)]
struct Nearest {
    least: f64,
    state: usize,
    met: Vec<[usize; 2]>,
}

impl Nearest {
    fn of(rows: &[Row], distance: fn(&Row) -> f64) -> Self {
        let least = rows
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let met = rows.iter().filter(|row| distance(row) <= 0.0);
        Self {
            least: least.map_or(f64::INFINITY, distance),
            state: least.map_or(0, |row| row.step),
            met: spans(met.map(|row| row.step)),
        }
    }

    /// Formats a cell of a table; a dash where the distance is that of a straight tube.
    fn describe(&self, straight: f64) -> String {
        if self.met.is_empty() && self.least > 0.99 * straight {
            return "–".into();
        }
        if self.met.is_empty() {
            return format!("{:.3} in state {}", self.least, self.state);
        }
        let spans = self.met.iter().map(|[from, to]| {
            if from == to {
                format!("{from}")
            } else {
                format!("{from} to {to}")
            }
        });
        format!("**met** in {}", spans.collect::<Vec<_>>().join(", "))
    }
}

/// Returns the ranges of consecutive numbers.
fn spans(numbers: impl Iterator<Item = usize>) -> Vec<[usize; 2]> {
    let mut spans: Vec<[usize; 2]> = vec![];
    for number in numbers {
        match spans.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => spans.push([number; 2]),
        }
    }
    spans
}

/// An item of a page.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A paragraph, in Markdown.
    Text(String),
    /// A table: headings and rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A picture: file name, PNG data, caption.
    Picture(String, Vec<u8>, String),
}

/// The page of a figure.
pub struct Page {
    /// The figure.
    pub figure: &'static Figure,
    /// Its claims.
    pub claims: Vec<Claim>,
    /// Text, tables and pictures after the claims.
    pub items: Vec<Item>,
    /// Its runs.
    pub runs: Vec<RunCost>,
    /// Error that left the page incomplete.
    pub error: Option<String>,
}

impl Page {
    pub(super) fn new(figure: &'static Figure) -> Self {
        Self {
            figure,
            claims: vec![],
            items: vec![],
            runs: vec![],
            error: None,
        }
    }

    /// Adds a statement of the paper, which agrees if it holds.
    pub(super) fn claim(&mut self, panel: &'static str, paper: &str, found: String, holds: bool) {
        self.judge(panel, paper, found, Verdict::of(holds));
    }

    /// Adds a statement that the paper does not make.
    pub(super) fn add(&mut self, panel: &'static str, statement: &str, found: String, holds: bool) {
        let verdict = if holds {
            Verdict::Added
        } else {
            Verdict::Differs
        };
        self.judge(panel, statement, found, verdict);
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

    /// Adds the cost of a run, unless it is there already.
    pub(super) fn add_run(&mut self, ran: &CompletedRun) {
        if self.runs.iter().any(|cost| cost.name == ran.job.name) {
            return;
        }
        let (plan, mesh) = (&ran.plan, &ran.plan.mesh);
        let rings = match plan.mesh.rings(plan.symmetry) {
            1 => "axisymmetric".to_owned(),
            n if n == mesh.around => "whole".to_owned(),
            n => format!("repeats {} times", mesh.around / n),
        };
        self.runs.push(RunCost {
            name: ran.job.name.clone(),
            case: ran.job.case,
            mesh: format!(
                "{} × {} × {}, {rings}",
                mesh.axial, mesh.around, mesh.thickness
            ),
            scheme: scheme(ran),
            states: ran.rows.len(),
            solves: ran.solves(),
            cg_iterations: ran.cg_iterations(),
            seconds: ran.seconds(),
            verdict: ran.verdict,
            gap: Nearest::of(&ran.rows, |row| row.gap).describe(plan.tube.thickness),
            lumen: Nearest::of(&ran.rows, |row| row.lumen).describe(2.0 * plan.tube.inner_radius()),
        });
    }

    /// Returns the number of claims with a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        let has = |claim: &&Claim| claim.verdict == verdict;
        self.claims.iter().filter(has).count()
    }

    /// Returns the number of claims that differ, plus 1 if the page is incomplete.
    pub fn failed(&self) -> usize {
        self.count(Verdict::Differs) + usize::from(self.error.is_some())
    }

    /// Returns the name of its file.
    pub fn file(&self) -> String {
        format!("{}.md", self.figure.name)
    }

    /// Returns the page in Markdown.
    pub fn markdown(&self, fineness: Fineness) -> String {
        let Figure { title, paper, .. } = self.figure;
        let mut page = format!("# {title}\n\n{}\n\n{paper}\n\n", fineness.sentence());
        if let Some(error) = &self.error {
            let _ = writeln!(page, "**Incomplete: {error}**\n");
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
        let rows = self.runs.iter().map(|cost| {
            let lost = if cost.verdict == run_directory::Verdict::Complete {
                ""
            } else {
                " (lost)"
            };
            vec![
                format!("`{}`{lost}", cost.name),
                format!("`cases/{}.toml`", cost.case),
                cost.mesh.clone(),
                cost.scheme.clone(),
                cost.states.to_string(),
                cost.solves.to_string(),
                cost.cg_iterations.to_string(),
                format!("{:.1}", cost.seconds),
                cost.gap.clone(),
                cost.lumen.clone(),
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
        let seconds: f64 = self.runs.iter().map(|cost| cost.seconds).sum();
        let _ = writeln!(
            page,
            "{} runs by plica {}, {seconds:.0} s in total. Axisymmetric runs, and small ones of Appendix B, take one thread each \
             and run in parallel; other three-dimensional runs use all threads.\n\n\
             Plica and the paper's equations have no contact. The gap is the smallest distance between parts of the wall along a \
             meridian; the lumen is its smallest width. States in which walls have **met** are not physical (later ones may be, \
             although the path to them was not).\n",
            self.runs.len(),
            env!("CARGO_PKG_VERSION")
        );
        page += &table(&heads.map(String::from), &rows.collect::<Vec<_>>());
        page
    }
}

/// Formats claims as a table.
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

/// Formats the verdict of a claim; bold if it differs.
pub(super) fn verdict(claim: &Claim) -> String {
    let word = claim.verdict.word();
    match claim.verdict {
        Verdict::Differs => format!("**{word}**"),
        _ => word.into(),
    }
}

/// Formats a table in Markdown.
fn table(heads: &[String], rows: &[Vec<String>]) -> String {
    let line = |cells: &[String]| {
        let cells = cells.iter().map(|cell| cell.replace('|', "\\|"));
        format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
    };
    let rule = format!("|{}\n", "---|".repeat(heads.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    line(heads) + &rule + &rows
}

/// Formats W of a state with five digits.
pub(super) fn energy(row: &Row) -> String {
    format!("{:.4e}", row.energy)
}

/// Describes the scheme of a run.
fn scheme(ran: &CompletedRun) -> String {
    let scheme = &ran.plan.solver.scheme;
    match scheme {
        Scheme::Static => scheme.to_string(),
        Scheme::PseudoTime(p) => {
            let equilibrated = if p.equilibrate {
                "equilibrated"
            } else {
                "not equilibrated"
            };
            format!("{scheme}, steps ramped over {}, {equilibrated}", p.ramp)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> Page {
        Page::new(&super::super::FIGURES[0])
    }

    #[test]
    fn false_claims_and_incomplete_pages_count_as_failed() {
        let mut page = page();
        page.claim("3A", "it holds", "yes".into(), true);
        page.claim("3B", "it does not", "no".into(), false);
        page.judge("3C", "it cannot", "for a reason".into(), Verdict::Explained);
        assert_eq!(page.failed(), 1);
        let text = page.markdown(Fineness::Quick);
        assert!(
            text.contains("| 3B | it does not | no | **differs** |"),
            "{text}"
        );
        assert!(text.contains("| 3C | it cannot | for a reason | explained |"));
        page.error = Some("a run is missing".into());
        assert_eq!(page.failed(), 2);
    }

    #[test]
    fn nearest_walls_are_described_by_their_states() {
        assert_eq!(spans([1, 2, 4].into_iter()), [[1, 2], [4, 4]]);
        assert!(spans(std::iter::empty()).is_empty());
        let nearest = |least, met: &[[usize; 2]]| Nearest {
            least,
            state: 7,
            met: met.to_vec(),
        };
        assert_eq!(nearest(0.06, &[]).describe(0.06), "–");
        assert_eq!(nearest(0.02, &[]).describe(0.06), "0.020 in state 7");
        assert_eq!(
            nearest(0.0, &[[1, 2], [4, 4]]).describe(0.06),
            "**met** in 1 to 2, 4"
        );
    }
}
