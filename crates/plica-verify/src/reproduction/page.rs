//! What a figure has to tell: claims and what became of them, tables, pictures.

use super::runs::Ran;
use super::{Figure, Fineness};
use plica::run_directory;
use plica::solve::Scheme;
use plica::study::Row;
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
    /// The paper does not say; Plica adds it.
    Added,
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
            Self::Added => "added",
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
    verdict: run_directory::Verdict,
    gap: String,
    lumen: String,
}

/// How near walls come along a run, and in which states they have met.
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

    /// As a cell of a table; a dash where the least is no less than what a straight tube has.
    fn told(&self, straight: f64) -> String {
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

/// Spans of numbers that follow each other.
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

    /// Something that the paper does not say; it differs if it does not hold.
    pub(super) fn add(&mut self, panel: &'static str, what: &str, found: String, holds: bool) {
        let verdict = if holds {
            Verdict::Added
        } else {
            Verdict::Differs
        };
        self.judge(panel, what, found, verdict);
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
            scheme: scheme(ran),
            states: ran.rows.len(),
            solves: ran.solves(),
            cg_iterations: ran.cg_iterations(),
            seconds: ran.seconds(),
            verdict: ran.verdict,
            gap: Nearest::of(&ran.rows, |row| row.gap).told(plan.tube.thickness),
            lumen: Nearest::of(&ran.rows, |row| row.lumen).told(2.0 * plan.tube.inner_radius()),
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
            let lost = if took.verdict == run_directory::Verdict::Complete {
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
                took.gap.clone(),
                took.lumen.clone(),
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
        let seconds: f64 = self.took.iter().map(|took| took.seconds).sum();
        let _ = writeln!(
            page,
            "{} runs by plica {}, {seconds:.0} s if done one after the other. A run of one ring takes one thread, and as many go side \
             by side as there are threads; one of many rings is given all of them, but for those of Appendix B.\n\n\
             Nothing keeps walls apart, and the paper's equations have no contact either. The gap is how near the wall comes to itself \
             along a meridian, the lumen how narrow it gets; where walls have **met**, in the states of those numbers, the state is not \
             physical (one after them may be, though the way to it was not).\n",
            self.took.len(),
            env!("CARGO_PKG_VERSION")
        );
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

/// How states were found, as far as it differs from run to run.
fn scheme(ran: &Ran) -> String {
    let scheme = &ran.plan.solver.scheme;
    match scheme {
        Scheme::Static => scheme.to_string(),
        Scheme::PseudoTime(p) => {
            let settled = if p.equilibrate {
                "settled"
            } else {
                "not settled"
            };
            format!("{scheme}, steps ramped over {}, {settled}", p.ramp)
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
    fn what_does_not_hold_differs_and_counts() {
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
        page.trouble = Some("a run is missing".into());
        assert_eq!(page.failed(), 2);
    }

    #[test]
    fn walls_that_met_are_told_by_their_states() {
        assert_eq!(spans([1, 2, 4].into_iter()), [[1, 2], [4, 4]]);
        assert!(spans(std::iter::empty()).is_empty());
        let nearest = |least, met: &[[usize; 2]]| Nearest {
            least,
            state: 7,
            met: met.to_vec(),
        };
        assert_eq!(nearest(0.06, &[]).told(0.06), "–");
        assert_eq!(nearest(0.02, &[]).told(0.06), "0.020 in state 7");
        assert_eq!(
            nearest(0.0, &[[1, 2], [4, 4]]).told(0.06),
            "**met** in 1 to 2, 4"
        );
    }
}
