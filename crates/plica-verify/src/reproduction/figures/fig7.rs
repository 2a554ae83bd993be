//! A square contraction pushed from one end.

use super::super::job::Job;
use super::super::page::{Page, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::Runs;
use super::super::{Figure, Fineness, ReproductionError};
use super::ramps::{self, Ramps, outcome};
use super::{COARSE, COARSER, axisymmetric, is_folded, mesh, side};
use plica::measure::Side;
use plica::run_directory;

pub(super) const FIGURE: Figure = Figure {
    name: "fig7",
    title: "Fig. 7: a square contraction pushed from an end",
    paper: "From the tube of Fig. 5B at Lmax/L = 1.17, which is square, one end is pushed by 0.15 D towards the other. \
            A: pushed at the colon end it invaginates toward the colon; B: pushed at the ileum end, toward the ileum.",
    jobs,
    describe,
};

/// Panel, case, and the end that is pushed.
const CASES: [ramps::Panel; 2] = [
    ("7A", "push-colon", Side::Colon),
    ("7B", "push-ileum", Side::Ileum),
];

/// Number of the state of Fig. 5B at Lmax/L = 1.17.
const SQUARE: usize = 32;

/// Damping coefficients, and pseudo-time steps to a push of 0.15 D.
fn ramps(fineness: Fineness) -> Ramps {
    Ramps {
        panels: CASES,
        dampings: fineness.choose(&[1.0, 10.0], &[0.1, 1.0, 10.0, 100.0]),
        steps: fineness.choose(&[30, 150], &[30, 150, 600]),
        range: (0.15, "D"),
    }
}

/// Creates a run of a push that starts from the square state of another run.
fn from(case: &'static str, run: &str) -> Job {
    let job = Job::of(case).from(run, SQUARE);
    job.with("stages[1].steps", 1).with("stages[2].steps", 1)
}

fn coarse(case: &'static str) -> Job {
    from(case, "ileum-side-coarse").on(COARSE)
}

/// The paper's scheme: Newmark with ηD/(EΔτ) = 100, ten pseudo-time steps to each push of 0.01 D.
fn newmark(case: &'static str, fineness: Fineness) -> Job {
    let job = from(case, "ileum-side-coarse").named(format!("{case}-newmark"));
    let job = job.on(fineness.choose(COARSER, COARSE)).history_only();
    job.with("solver.scheme", "\"newmark\"")
        .with("solver.pseudo_time.damping", "100.0")
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![
        axisymmetric("ileum-side", fineness),
        Job::of("ileum-side").named("ileum-side-coarse").on(COARSE),
    ];
    for (_, case, _) in CASES {
        jobs.push(from(case, "ileum-side").on(mesh(fineness)));
        let without_damping = coarse(case).named(format!("{case}-static")).history_only();
        jobs.push(without_damping.with("solver", "{ scheme = \"static\" }"));
    }
    jobs.extend(CASES.map(|(_, case, _)| newmark(case, fineness)));
    jobs.extend(ramps(fineness).jobs(|case| coarse(case).with("stages[3].steps", 1)));
    jobs
}

fn describe(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
    let square = runs.get("ileum-side")?;
    let row = square.at(1.17)?;
    let mut panels = vec![panel(square, row, "5B at *L*_{max}/*L* = 1.17")?];
    for (panel_name, case, towards) in CASES {
        let ran = runs.get(case)?;
        let last = ran.last()?;
        page.claim(
            panel_name,
            &format!("pushed at the {towards} end it invaginates toward the {towards}"),
            format!(
                "{} after a push of 0.15 D, W = {}",
                side(last),
                energy(last)
            ),
            is_folded(last, towards) && ran.verdict == run_directory::Verdict::Complete,
        );
        panels.push(panel(
            ran,
            last,
            format!("{panel_name}   pushed at the {towards} end"),
        )?);
    }
    page.picture(
        "tubes",
        tubes(panels)?,
        "Tubes cut open, coloured by strain energy density: before the push, pushed at the colon end, pushed at the ileum end",
    );
    page.text(
        "**What decides the side.** Without damping, a push at one end differs from a push at the other only by a \
         translation of the whole tube, so both must lead to the same side. The pushed end matters only if something resists \
         the translation, which the damping does. The figure uses backward Euler with ηD/(EΔτ) = 5 and a push of 0.001 D per \
         pseudo-time step, equilibrated without damping after every 0.01 D. In the table, the whole push is one ramp.",
    );
    let static_outcome = |case| runs.get(&format!("{case}-static")).and_then(outcome);
    let without = [static_outcome(CASES[0].1)?, static_outcome(CASES[1].1)?];
    let (mut as_printed, mut all) = (0, 0);
    ramps(fineness).table(page, runs, &without, |(_, _, towards), ran| {
        all += 1;
        as_printed += usize::from(is_folded(ran.last()?, *towards));
        outcome(ran)
    })?;
    page.text(format!(
        "With damping the pushed side invaginates in {as_printed} of {all} settings; without it, pushed at the colon end the tube folds to the {}, pushed at the ileum end \
         to the {}.",
        without[0], without[1]
    ));
    let (papers, as_printed_by_it) =
        ramps::as_the_paper(CASES, runs, |case| newmark(case, fineness))?;
    page.claim(
        "7",
        "the pushed side invaginates, with the paper's scheme (Newmark, ηD/(EΔτ) = 100; its rate is not given)",
        format!(
            "with 0.001 D per pseudo-time step {}",
            papers
        ),
        as_printed_by_it,
    );
    Ok(())
}
