//! The computations of Okino et al. (2025), figure by figure, beside what the paper reports.
//!
//! | file | holds |
//! |---|---|
//! | `job` | a run: a case of the house with keys changed |
//! | `runs` | doing what is not done yet, side by side; looking at a run that is done |
//! | `page` | claims of the paper and what became of them; a figure's page |
//! | `pictures` | pictures in the manner of the paper's |
//! | `figures` | one file a figure: its runs, and what it tells of them |
//!
//! A figure is told from the run directories alone, so that what is done need not be done again.

mod figures;
mod job;
mod page;
mod pictures;
mod runs;

pub use figures::FIGURES;
pub use job::Job;
pub use page::{Claim, Item, Page, Took, Verdict};
pub use runs::{Ran, Runs};

use plica_view::draw::DrawError;
use std::fmt::Write;
use std::path::Path;

/// What a summary begins with.
pub const TITLE: &str = "# Okino et al. (2025), figure by figure";

/// How fine meshes are, and what is three-dimensional.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fineness {
    /// Coarser meshes: minutes.
    Quick,
    /// The paper's mesh, and three dimensions where they matter: hours.
    Full,
}

impl Fineness {
    /// One of two, for quick and for full.
    pub fn choose<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }

    /// What pages say of it.
    pub fn sentence(self) -> &'static str {
        self.choose(
            "Written by `plica reproduce --quick`: coarser meshes than the paper's.",
            "Written by `plica reproduce --full`: figures on the paper's mesh, maps of many runs on coarser ones (each page says which, under *What was run*).",
        )
    }
}

/// A figure, or an appendix, of the paper.
pub struct Figure {
    /// What it is asked for by.
    pub name: &'static str,
    /// What it is about.
    pub title: &'static str,
    /// What the paper shows there.
    pub paper: &'static str,
    jobs: fn(Fineness) -> Vec<Job>,
    tell: fn(&Runs, Fineness, &mut Page) -> Result<(), Trouble>,
}

impl Figure {
    /// The runs that it is told from.
    pub fn jobs(&self, fineness: Fineness) -> Vec<Job> {
        distinct((self.jobs)(fineness))
    }

    /// The figure that a person means: by its name, or as `4`, `4A`, `Fig. 4`, `A` or `appendix a`.
    pub fn meant(name: &str) -> Option<&'static Self> {
        let plain = |text: &str| -> String {
            let letters = text.chars().filter(|c| c.is_ascii_alphanumeric());
            letters.map(|c| c.to_ascii_lowercase()).collect()
        };
        let name = plain(name);
        let bare = ["figure", "fig", "appendix", "app"]
            .iter()
            .find_map(|word| name.strip_prefix(word))
            .unwrap_or(&name);
        // A panel of a figure means the figure.
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

/// Each run once: one name means one run.
fn distinct(jobs: impl IntoIterator<Item = Job>) -> Vec<Job> {
    let mut distinct: Vec<Job> = vec![];
    for job in jobs {
        if !distinct.iter().any(|other| other.name == job.name) {
            distinct.push(job);
        }
    }
    distinct
}

/// Is told what goes on, and may ask to stop.
pub trait Observer {
    /// A run is done; so many of all that were to do.
    fn ran(&mut self, _ran: &Ran, _done: usize, _of: usize) {}
    /// A run could not be done.
    fn failed(&mut self, _run: &str, _why: &str) {}
    /// What takes time, and how far it all is (0 to 1).
    fn working(&mut self, _what: &str, _fraction: f64) {}
    /// Whether to stop.
    fn stop(&mut self) -> bool {
        false
    }
}

impl Observer for () {}

/// Why a figure cannot be told.
#[derive(Debug, thiserror::Error)]
pub enum Trouble {
    /// Someone asked to stop.
    #[error("stopped")]
    Stopped,
    /// A run is not there.
    #[error("the run {run} is missing: {why}")]
    Missing {
        /// Its name.
        run: String,
        /// What became of it.
        why: String,
    },
    /// A state is not there, or cannot be read.
    #[error("{0}")]
    State(String),
    /// A picture cannot be drawn.
    #[error("no picture: {0}")]
    Draw(#[from] DrawError),
}

/// What was reproduced.
pub struct Reproduction {
    /// How fine.
    pub fineness: Fineness,
    /// The figures, in the order of the paper.
    pub pages: Vec<Page>,
}

/// Runs what the wanted figures are told from, as far as it is not in `folder` yet, and tells them; and with them those
/// whose runs are all there already.
///
/// # Errors
/// [`Trouble::Stopped`] if the observer asked to stop; runs that were done by then need not be done again. Any other
/// trouble is told on the page of its figure.
pub fn reproduce(
    wanted: &[&'static Figure],
    fineness: Fineness,
    folder: &Path,
    observer: &mut (dyn Observer + Send),
) -> Result<Reproduction, Trouble> {
    let is_wanted = |figure: &Figure| wanted.iter().any(|wanted| wanted.name == figure.name);
    let there = |figure: &Figure| Runs::are_there(&figure.jobs(fineness), folder);
    let told: Vec<&Figure> = FIGURES
        .iter()
        .filter(|figure| is_wanted(figure) || there(figure))
        .collect();
    let jobs = distinct(told.iter().flat_map(|figure| figure.jobs(fineness)));
    let runs = Runs::of(&jobs, folder, observer)?;
    let mut pages = vec![];
    for figure in told {
        if observer.stop() {
            return Err(Trouble::Stopped);
        }
        let mut page = Page::new(figure);
        for job in figure.jobs(fineness) {
            if let Ok(ran) = runs.get(&job.name) {
                page.took(ran);
            }
        }
        if let Err(trouble) = (figure.tell)(&runs, fineness, &mut page) {
            page.trouble = Some(trouble.to_string());
        }
        pages.push(page);
    }
    Ok(Reproduction { fineness, pages })
}

impl Reproduction {
    /// Claims that are not met, and figures that could not be told.
    pub fn failed(&self) -> usize {
        self.pages.iter().map(Page::failed).sum()
    }

    /// The claims, as text of plain lines.
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
            if let Some(trouble) = &page.trouble {
                let _ = writeln!(text, "{}: not told to the end: {trouble}", page.figure.name);
            }
        }
        text += &self.count();
        text.push('\n');
        text
    }

    /// How many of the paper's statements agree.
    fn count(&self) -> String {
        let told = |verdict| {
            let pages = self.pages.iter();
            pages.map(|page| page.told(verdict)).sum::<usize>()
        };
        let [agree, explained, differ] =
            [Verdict::Agrees, Verdict::Explained, Verdict::Differs].map(told);
        let of = agree + explained + differ;
        let mut text = format!("{agree} of {of} statements of the paper agree");
        if explained > 0 {
            let _ = write!(text, ", {explained} explained");
        }
        let torn = self.pages.iter().filter(|page| page.trouble.is_some());
        match torn.count() {
            0 => {}
            torn => {
                let _ = write!(text, "; figures that could not be told to the end: {torn}");
            }
        }
        text
    }

    /// The summary, in Markdown.
    pub fn summary(&self) -> String {
        let mut page = format!(
            "{TITLE}\n\n{} {}.\n\n\
             - *agrees*: Plica finds the same.\n\
             - *explained*: it finds something else, or does not get there, and the page of the figure shows why.\n\
             - *differs*: it finds something else, and nobody knows why.\n\
             - *added*: the paper does not say.\n\n",
            self.fineness.sentence(),
            self.count()
        );
        page += "| | the paper | Plica | |\n|---|---|---|---|\n";
        for told in &self.pages {
            for claim in &told.claims {
                let _ = writeln!(
                    page,
                    "| [{}]({}) | {} | {} | {} |",
                    claim.panel,
                    told.file(),
                    claim.paper,
                    claim.found,
                    page::verdict(claim)
                );
            }
            if let Some(trouble) = &told.trouble {
                let _ = writeln!(
                    page,
                    "| [{}]({}) | | {trouble} | **not told** |",
                    told.figure.name,
                    told.file()
                );
            }
        }
        page
    }

    /// Every file: its name and its bytes, the summary first.
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

/// The file of the summary.
pub const SUMMARY: &str = "reproduction.md";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_known_by_many_names() {
        let meant = |name| Figure::meant(name).map(|figure| figure.name);
        for name in ["fig4", "4", "4A", "Fig. 4b", "figure4"] {
            assert_eq!(meant(name), Some("fig4"), "{name}");
        }
        for name in ["appendix-a", "A", "app. a", "Appendix A"] {
            assert_eq!(meant(name), Some("appendix-a"), "{name}");
        }
        for name in ["", "fig", "44", "fig8", "c", "fig4d", "colon"] {
            assert_eq!(meant(name), None, "{name}");
        }
    }

    #[test]
    fn every_job_is_a_sound_case_and_one_name_means_one_run() {
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
                // A state to start from is there only when the run before it is done.
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
                // And that comes before it.
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
