//! Side of the fold over damping coefficients and rates, with one ramp of pseudo-time each.

use super::super::ReproductionError;
use super::super::job::Job;
use super::super::page::Page;
use super::super::runs::{CompletedRun, Runs};
use super::is_folded;
use plica::measure::{Shape, Side};
use plica::run_directory;

/// A panel of a figure, its case, and the side of its fold in the paper.
pub type Panel = (&'static str, &'static str, Side);

/// Runs of two panels over damping coefficients and rates.
pub struct Ramps {
    /// The panels.
    pub panels: [Panel; 2],
    /// Damping coefficients ηD/(EΔτ).
    pub dampings: &'static [f64],
    /// Pseudo-time steps of the whole ramp.
    pub steps: &'static [usize],
    /// Total change of the ramped quantity, and its unit.
    pub range: (f64, &'static str),
}

/// Returns the name of a run.
fn name(case: &str, damping: f64, steps: usize) -> String {
    format!("{case}-damping-{damping}-ramp-{steps}")
}

impl Ramps {
    /// Returns the runs; `start` creates each from its case.
    pub fn jobs(&self, start: impl Fn(&'static str) -> Job) -> Vec<Job> {
        let mut jobs = vec![];
        for (_, case, _) in self.panels {
            for &damping in self.dampings {
                for &steps in self.steps {
                    let job = start(case).named(name(case, damping, steps)).history_only();
                    jobs.push(
                        job.with("solver.scheme", "\"backward-euler\"")
                            .with("solver.pseudo_time.damping", format!("{damping:?}"))
                            .with("solver.pseudo_time.ramp", steps)
                            .with("solver.pseudo_time.tolerance", "1e-4")
                            .with("solver.pseudo_time.max_steps", 20000),
                    );
                }
            }
        }
        jobs
    }

    /// Adds a table of the outcomes: first without damping, then of every run.
    ///
    /// # Errors
    /// [`ReproductionError`] if a run is missing.
    pub fn table(
        &self,
        page: &mut Page,
        runs: &Runs,
        without: &[String; 2],
        mut outcome: impl FnMut(&Panel, &CompletedRun) -> Result<String, ReproductionError>,
    ) -> Result<(), ReproductionError> {
        let (range, unit) = self.range;
        let mut heads = vec!["ηD/(EΔτ)".to_owned()];
        let mut first = vec!["none (static)".to_owned()];
        for ((panel, ..), without) in self.panels.iter().zip(without) {
            for &steps in self.steps {
                heads.push(format!(
                    "{panel}, {:.1e} {unit} per step",
                    range / steps as f64
                ));
                first.push(without.clone());
            }
        }
        let mut rows = vec![first];
        for &damping in self.dampings {
            let mut row = vec![format!("{damping}")];
            for panel in &self.panels {
                for &steps in self.steps {
                    row.push(outcome(panel, runs.get(&name(panel.1, damping, steps))?)?);
                }
            }
            rows.push(row);
        }
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        page.table(&heads, rows);
        Ok(())
    }
}

/// Returns the side of the fold of a run, or else its shape or `lost`.
pub fn outcome(ran: &CompletedRun) -> Result<String, ReproductionError> {
    let row = ran.last()?;
    Ok(match ran.verdict {
        run_directory::Verdict::Complete if row.shape == Shape::Invaginated => row.side.to_string(),
        run_directory::Verdict::Complete => row.shape.to_string(),
        _ => "lost".into(),
    })
}

/// Describes the outcome of one run per panel, and whether all agree with the paper.
pub fn as_the_paper(
    panels: [Panel; 2],
    runs: &Runs,
    run: impl Fn(&'static str) -> Job,
) -> Result<(String, bool), ReproductionError> {
    let (mut outcomes, mut all) = (vec![], true);
    for (panel, case, towards) in panels {
        let ran = runs.get(&run(case).name)?;
        outcomes.push(format!("{panel}: {}", outcome(ran)?));
        all &= ran.verdict == run_directory::Verdict::Complete && is_folded(ran.last()?, towards);
    }
    Ok((outcomes.join(", "), all))
}
