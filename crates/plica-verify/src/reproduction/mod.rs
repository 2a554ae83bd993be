//! Reproduction of the figures of Okino et al. (2025), compared with the statements of the paper.
//!
//! | module | content |
//! |---|---|
//! | `job` | a run to do: a case of `cases/` with changed keys |
//! | `runs` | performs missing runs in parallel; results of completed runs |
//! | `page` | the page of a figure: claims of the paper beside results of Plica |
//! | `pictures` | pictures in the style of the paper |
//! | `figures` | the runs and the evaluation of every figure |
//!
//! Figures are evaluated from run directories, so completed runs are not repeated.

mod figures;
mod job;
mod page;
mod pictures;
mod runs;

pub use figures::FIGURES;
pub use job::Job;
pub use page::{Claim, Item, Page, RunCost, Verdict};
pub use runs::{CompletedRun, Runs};

use plica::monitor::Monitor;
use plica_view::draw::DrawError;
use std::fmt::Write;
use std::path::Path;

/// First line of the summary.
pub const TITLE: &str = "# Okino et al. (2025), figure by figure";

/// Resolution of the meshes, and extent of the three-dimensional runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fineness {
    /// Coarser meshes: minutes.
    Quick,
    /// The paper's mesh, and three dimensions where they matter: hours.
    Full,
}

impl Fineness {
    /// Returns one of two values.
    pub fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }

    /// Returns the sentence about it on pages.
    pub fn sentence(self) -> &'static str {
        self.choose(
            "Written by `plica reproduce --quick`: coarser meshes than the paper's.",
            "Written by `plica reproduce --full`: figures on the paper's mesh, maps of many runs on coarser ones (each page says which, under *What was run*).",
        )
    }
}

/// A figure or an appendix of the paper.
pub struct Figure {
    /// Name on the command line.
    pub name: &'static str,
    /// Title of its page.
    pub title: &'static str,
    /// Content of the figure in the paper.
    pub paper: &'static str,
    jobs: fn(Fineness) -> Vec<Job>,
    describe: fn(&Runs, Fineness, &mut Page) -> Result<(), ReproductionError>,
}

impl Figure {
    /// Returns the runs that it needs.
    pub fn jobs(&self, fineness: Fineness) -> Vec<Job> {
        distinct((self.jobs)(fineness))
    }

    /// Finds a figure by its name, or by `4`, `4A`, `Fig. 4`, `A` or `appendix a`.
    pub fn find(name: &str) -> Option<&'static Self> {
        let plain = |text: &str| -> String {
            let letters = text.chars().filter(|c| c.is_ascii_alphanumeric());
            letters.map(|c| c.to_ascii_lowercase()).collect()
        };
        let name = plain(name);
        let bare = ["figure", "fig", "appendix", "app"]
            .iter()
            .find_map(|word| name.strip_prefix(word))
            .unwrap_or(&name);
        // A panel stands for its figure.
        let bare = match bare.as_bytes() {
            [digit @ b'0'..=b'9', b'a'..=b'c'] => char::from(*digit).to_string(),
            _ => bare.to_owned(),
        };
        if bare.is_empty() {
            return None;
        }
        FIGURES.iter().find(|figure| {
            let own = plain(figure.name);
            own == name
                || ["fig", "appendix"]
                    .iter()
                    .any(|word| own == format!("{word}{bare}"))
        })
    }
}

/// Removes repeated runs. Runs of the same name are equal.
fn distinct(jobs: impl IntoIterator<Item = Job>) -> Vec<Job> {
    let mut distinct: Vec<Job> = vec![];
    for job in jobs {
        if !distinct.iter().any(|other| other.name == job.name) {
            distinct.push(job);
        }
    }
    distinct
}

/// Errors of the reproduction.
#[derive(Debug, thiserror::Error)]
pub enum ReproductionError {
    /// The monitor cancelled the computation.
    #[error("cancelled")]
    Cancelled,
    /// A run is missing.
    #[error("the run {run} is missing: {why}")]
    Missing {
        /// Its name.
        run: String,
        /// Reason.
        why: String,
    },
    /// A state is missing or cannot be read.
    #[error("{0}")]
    State(String),
    /// A picture cannot be drawn.
    #[error("no picture: {0}")]
    Draw(#[from] DrawError),
}

/// Result of the reproduction.
pub struct Reproduction {
    /// Resolution.
    pub fineness: Fineness,
    /// The figures, in the order of the paper.
    pub pages: Vec<Page>,
}

/// Performs the runs of the wanted figures that are not in `folder` yet and evaluates these figures, and those whose
/// runs are all complete. The monitor gets a notice for every run.
///
/// # Errors
/// [`ReproductionError::Cancelled`] if the monitor cancels; completed runs are not repeated. Any other error is shown on
/// the page of its figure.
pub fn reproduce(
    wanted: &[&'static Figure],
    fineness: Fineness,
    folder: &Path,
    monitor: &mut (dyn Monitor + Send),
) -> Result<Reproduction, ReproductionError> {
    let is_wanted = |figure: &Figure| wanted.iter().any(|wanted| wanted.name == figure.name);
    let is_complete = |figure: &Figure| Runs::are_complete(&figure.jobs(fineness), folder);
    let figures: Vec<&Figure> = FIGURES
        .iter()
        .filter(|figure| is_wanted(figure) || is_complete(figure))
        .collect();
    let jobs = distinct(figures.iter().flat_map(|figure| figure.jobs(fineness)));
    let runs = Runs::of(&jobs, folder, monitor)?;
    let mut pages = vec![];
    for figure in figures {
        if monitor.is_cancelled() {
            return Err(ReproductionError::Cancelled);
        }
        let mut page = Page::new(figure);
        for job in figure.jobs(fineness) {
            if let Ok(ran) = runs.get(&job.name) {
                page.add_run(ran);
            }
        }
        if let Err(error) = (figure.describe)(&runs, fineness, &mut page) {
            page.error = Some(error.to_string());
        }
        pages.push(page);
    }
    Ok(Reproduction { fineness, pages })
}

impl Reproduction {
    /// Returns the number of claims that differ and of incomplete figures.
    pub fn failed(&self) -> usize {
        self.pages.iter().map(Page::failed).sum()
    }

    /// Returns the claims as plain text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for page in &self.pages {
            for claim in &page.claims {
                let word = claim.verdict.word();
                let verdict = match claim.verdict {
                    Verdict::Differs => word.to_uppercase(),
                    _ => word.into(),
                };
                let _ = writeln!(
                    text,
                    "{:<4} {verdict:<9}  {}\n                {}",
                    claim.panel, claim.paper, claim.found
                );
            }
            if let Some(error) = &page.error {
                let _ = writeln!(text, "{}: incomplete: {error}", page.figure.name);
            }
        }
        text += &self.counts();
        text.push('\n');
        text
    }

    /// Returns a sentence with the numbers of claims by verdict.
    fn counts(&self) -> String {
        let count = |verdict| {
            let pages = self.pages.iter();
            pages.map(|page| page.count(verdict)).sum::<usize>()
        };
        let [agree, explained, differ] =
            [Verdict::Agrees, Verdict::Explained, Verdict::Differs].map(count);
        let of = agree + explained + differ;
        let mut text = format!("{agree} of {of} statements of the paper agree");
        if explained > 0 {
            let _ = write!(text, ", {explained} explained");
        }
        let incomplete = self.pages.iter().filter(|page| page.error.is_some());
        match incomplete.count() {
            0 => {}
            incomplete => {
                let _ = write!(text, "; incomplete figures: {incomplete}");
            }
        }
        text
    }

    /// Returns the summary in Markdown.
    pub fn summary(&self) -> String {
        let mut page = format!(
            "{TITLE}\n\n{} {}.\n\n\
             - *agrees*: Plica finds the same.\n\
             - *explained*: the result differs, or the state is not reached, and the page of the figure shows why.\n\
             - *differs*: the result differs for an unknown reason.\n\
             - *added*: the paper has no such statement.\n\n",
            self.fineness.sentence(),
            self.counts()
        );
        page += "| | the paper | Plica | |\n|---|---|---|---|\n";
        for figure_page in &self.pages {
            for claim in &figure_page.claims {
                let _ = writeln!(
                    page,
                    "| [{}]({}) | {} | {} | {} |",
                    claim.panel,
                    figure_page.file(),
                    claim.paper,
                    claim.found,
                    page::verdict(claim)
                );
            }
            if let Some(error) = &figure_page.error {
                let _ = writeln!(
                    page,
                    "| [{}]({}) | | {error} | **incomplete** |",
                    figure_page.figure.name,
                    figure_page.file()
                );
            }
        }
        page
    }

    /// Returns the names and contents of all files, the summary first.
    pub fn files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = vec![(SUMMARY.to_owned(), self.summary().into_bytes())];
        for page in &self.pages {
            files.push((page.file(), page.markdown(self.fineness).into_bytes()));
            for item in &page.items {
                if let Item::Picture(name, png, _) = item {
                    files.push((name.clone(), png.clone()));
                }
            }
        }
        files
    }
}

/// Name of the file of the summary.
pub const SUMMARY: &str = "reproduction.md";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_found_by_several_names() {
        let find = |name| Figure::find(name).map(|figure| figure.name);
        for name in ["fig4", "4", "4A", "Fig. 4b", "figure4"] {
            assert_eq!(find(name), Some("fig4"), "{name}");
        }
        for name in ["appendix-a", "A", "app. a", "Appendix A"] {
            assert_eq!(find(name), Some("appendix-a"), "{name}");
        }
        for name in ["", "fig", "44", "fig8", "c", "fig4d", "colon"] {
            assert_eq!(find(name), None, "{name}");
        }
    }

    #[test]
    fn every_job_is_a_valid_case_and_names_are_unique() {
        for fineness in [Fineness::Quick, Fineness::Full] {
            let mut jobs: Vec<Job> = vec![];
            for job in FIGURES.iter().flat_map(|figure| (figure.jobs)(fineness)) {
                match jobs.iter().find(|other| other.name == job.name) {
                    Some(other) => assert_eq!(*other, job),
                    None => jobs.push(job),
                }
            }
            for job in &jobs {
                let starts = job.parent();
                // The state to start from does not exist before the run of the parent.
                let text = job.text();
                match plica::case::read(&text, &job.name) {
                    Ok(_) => assert!(starts.is_none()),
                    Err(error) => {
                        let keys: Vec<&str> =
                            error.problems.iter().map(|p| p.key.as_str()).collect();
                        assert!(
                            starts.is_some() && keys == ["start.state"],
                            "{}: {error:?}",
                            job.name
                        );
                    }
                }
                // The parent comes first.
                if let Some(from) = starts {
                    let at = |name: &str| jobs.iter().position(|other| other.name == name);
                    assert!(
                        at(&from) < at(&job.name) && at(&from).is_some(),
                        "{}",
                        job.name
                    );
                    let parent = &jobs[at(&from).unwrap()];
                    assert!(job.large || !parent.large && parent.parent().is_none());
                }
            }
        }
    }
}
