//! Which side a tube folds to, over drags and rates: one ramp of pseudo-time each.

use super::super::Trouble;
use super::super::job::Job;
use super::super::page::Page;
use super::super::runs::{Ran, Runs};
use super::is_folded;
use plica::measure::{Shape, Side};
use plica::run_directory;

/// A panel of a figure, its case, and the side that the paper has it fold to.
pub type Panel = (&'static str, &'static str, Side);

/// Two panels, over drags and ramps.
pub struct Ramps {
    /// The panels.
    pub panels: [Panel; 2],
    /// Drags ηD/(EΔτ).
    pub drags: &'static [f64],
    /// Pseudo-time steps of the whole ramp.
    pub steps: &'static [usize],
    /// What is ramped, in all, and its unit.
    pub way: (f64, &'static str),
}

/// The name of a case's run with a drag, in so many steps.
fn name(case: &str, damping: f64, steps: usize) -> String {
    format!("{case}-damping-{damping}-ramp-{steps}")
}

impl Ramps {
    /// The runs, each made of its case by `start`.
    pub fn jobs(&self, start: impl Fn(&'static str) -> Job) -> Vec<Job> {
        let mut jobs = vec![];
        for (_, case, _) in self.panels {
            for &damping in self.drags {
                for &steps in self.steps {
                    let job = start(case).named(name(case, damping, steps)).bare();
                    jobs.push(
                        job.with("solver.scheme", "\"damped\"")
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

    /// The map as a table: what became of each panel without drag, then what `outcome` tells of each run.
    ///
    /// # Errors
    /// [`Trouble`] if a run is missing.
    pub fn table(
        &self,
        page: &mut Page,
        runs: &Runs,
        without: &[String; 2],
        mut outcome: impl FnMut(&Panel, &Ran) -> Result<String, Trouble>,
    ) -> Result<(), Trouble> {
        let (way, unit) = self.way;
        let mut heads = vec!["ηD/(EΔτ)".to_owned()];
        let mut first = vec!["none (static)".to_owned()];
        for ((panel, ..), without) in self.panels.iter().zip(without) {
            for &steps in self.steps {
                heads.push(format!(
                    "{panel}, {:.1e} {unit} per step",
                    way / steps as f64
                ));
                first.push(without.clone());
            }
        }
        let mut rows = vec![first];
        for &damping in self.drags {
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

/// The side that a run folded to, or what became of it instead.
pub fn outcome(ran: &Ran) -> Result<String, Trouble> {
    let row = ran.last()?;
    Ok(match ran.verdict {
        run_directory::Verdict::Complete if row.shape == Shape::Invaginated => row.side.to_string(),
        run_directory::Verdict::Complete => row.shape.to_string(),
        _ => "lost".into(),
    })
}

/// What becomes of each panel in a run of its own, in words; and whether all end as the paper has it.
pub fn as_the_paper(
    panels: [Panel; 2],
    runs: &Runs,
    run: impl Fn(&'static str) -> Job,
) -> Result<(String, bool), Trouble> {
    let (mut told, mut all) = (vec![], true);
    for (panel, case, towards) in panels {
        let ran = runs.get(&run(case).name)?;
        told.push(format!("{panel}: {}", outcome(ran)?));
        all &= ran.verdict == run_directory::Verdict::Complete && is_folded(ran.last()?, towards);
    }
    Ok((told.join(", "), all))
}
