//! Relaxation on one side of the contraction, and the side of the fold.

use super::super::job::Job;
use super::super::page::{Page, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::Runs;
use super::super::{Figure, Fineness, ReproductionError};
use super::ramps::{self, Ramps, outcome};
use super::{COARSE, COARSER, axisymmetric, first, is_folded, ratio, side};
use plica::measure::{Shape, Side};
use plica::run_directory;

pub(super) const FIGURE: Figure = Figure {
    name: "fig5",
    title: "Fig. 5: relaxation on one side of the contraction",
    paper: "The contraction (Dmin/D = 0.25) takes 0.5 to 1.75 D from the colon end, the relaxation lies beside it: A at 0 to \
            0.5, B at 1.75 to 2.25. At Lmax/L = 1.17 both are square; at 1.25 A has invaginated toward the colon, B toward \
            the ileum.",
    jobs,
    describe,
};

/// The two cases, the panel of each, and its side.
const CASES: [ramps::Panel; 2] = [
    ("5A", "colon-side", Side::Colon),
    ("5B", "ileum-side", Side::Ileum),
];

/// Number of the state at Dmin/D = 0.25, before the relaxation.
const CONTRACTED: usize = 15;

/// Number of the state at Lmax/L = 1.17, a square.
const SQUARE: usize = 32;

/// Damping coefficients, and pseudo-time steps from Lmax/L = 1.0 to 1.25.
fn ramps(fineness: Fineness) -> Ramps {
    Ramps {
        panels: CASES,
        dampings: fineness.choose(&[1.0, 10.0, 100.0], &[0.1, 1.0, 10.0, 100.0, 1000.0]),
        steps: fineness.choose(&[25, 250], &[25, 250, 1000]),
        range: (0.25, "L"),
    }
}

/// The paper's scheme from the square on: Newmark with ηD/(EΔτ) = 100, ten pseudo-time steps to each 0.01 of Lmax/L.
fn newmark(case: &'static str, fineness: Fineness) -> Job {
    let mesh = fineness.choose(COARSER, COARSE);
    let job = Job::of(case).named(format!("{case}-newmark")).on(mesh);
    job.from(&coarse(case), SQUARE)
        .with("stages[1].steps", 1)
        .with("stages[2].steps", 8)
        .with("solver.scheme", "\"newmark\"")
        .with("solver.pseudo_time.max_steps", 20000)
        .history_only()
}

fn coarse(case: &str) -> String {
    format!("{case}-coarse")
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![];
    for (_, case, _) in CASES {
        jobs.push(axisymmetric(case, fineness));
        jobs.push(Job::of(case).named(coarse(case)).on(COARSE));
        jobs.push(newmark(case, fineness));
    }
    // One ramp from the contracted tube.
    jobs.extend(ramps(fineness).jobs(|case| {
        let job = Job::of(case).on(COARSE).from(&coarse(case), CONTRACTED);
        job.with("stages[1].steps", 1).with("stages[2].steps", 1)
    }));
    jobs.push(Job::of("other-side").on(COARSE));
    let mirrored = Job::of("other-side")
        .named("other-side-of-ileum-side")
        .on(COARSE);
    jobs.push(
        mirrored
            .with("muscles.longitudinal.zone", "[1.75, 2.25]")
            .with("stages[3].drive.colon.displacement", 0.15)
            .with("stages[3].drive.ileum.displacement", 0.0)
            .with("stages[5].drive.colon.displacement", 0.0),
    );
    jobs
}

fn describe(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
    let mut panels = vec![];
    for (panel_name, case, towards) in CASES {
        let ran = runs.get(case)?;
        let (square, end) = (ran.at(1.17)?, ran.at(1.25)?);
        page.claim(
            panel_name,
            "a square at Lmax/L ~ 1.17",
            format!(
                "at 1.17 {}, steepest wall {:.0}° (square from 78° on; at 1.16 {:.0}°); overhangs from {}",
                square.shape,
                square.max_wall_angle_deg,
                ran.at(1.16)?.max_wall_angle_deg,
                ratio(first(&ran.rows, Shape::Invaginated))
            ),
            square.shape == Shape::Square,
        );
        page.claim(
            panel_name,
            &format!("at 1.25 invaginated toward the {towards}"),
            side(end),
            is_folded(end, towards),
        );
        for at in [1.0, 1.17, 1.25] {
            let row = ran.at(at)?;
            let label = format!("{panel_name}   *L*_{{max}}/*L* = {at:.2}: {}", row.shape);
            panels.push(panel(ran, row, label)?);
        }
    }
    page.picture(
        "tubes",
        tubes(panels)?,
        "Tubes cut open at Lmax/L = 1.00, 1.17 and 1.25, coloured by strain energy density: A relaxes on the colon side, B on the ileum side",
    );
    sides(page, runs, fineness)?;
    branches(page, runs)
}

/// Tabulates the side of the fold over damping coefficients and rates.
fn sides(page: &mut Page, runs: &Runs, fineness: Fineness) -> Result<(), ReproductionError> {
    page.text(
        "**What decides the side.** The static scheme has no damping. With damping, Lmax/L rises from 1.0 to 1.25 in one \
         ramp of pseudo-time steps (backward Euler) from the same contracted state, and then stays constant. The product of \
         damping and rate decides: where it is too large, the wall cannot follow, and the relaxing zone buckles. The figure \
         shows the static scheme.",
    );
    let without = [
        outcome(runs.get(&coarse(CASES[0].1))?)?,
        outcome(runs.get(&coarse(CASES[1].1))?)?,
    ];
    let (papers, as_printed_by_it) =
        ramps::as_the_paper(CASES, runs, |case| newmark(case, fineness))?;
    let [mut as_printed, mut otherwise, mut buckled, mut lost] = [0; 4];
    ramps(fineness).table(page, runs, &without, |(_, case, towards), ran| {
        let last = ran.last()?;
        let by_itself = runs.get(&coarse(case))?.last()?;
        let more = last.energy / by_itself.energy;
        if ran.verdict != run_directory::Verdict::Complete {
            lost += 1;
            return Ok(format!("lost after {:.2}", last.length_ratio));
        }
        if more > HIGHER {
            buckled += 1;
            return Ok(format!("{}, *W* × {more:.1}", outcome(ran)?));
        }
        if is_folded(last, *towards) {
            as_printed += 1;
        } else {
            otherwise += 1;
        }
        outcome(ran)
    })?;
    let all = as_printed + otherwise + buckled + lost;
    page.text(format!(
        "Of {all} ramps {as_printed} end as printed, {otherwise} on the other side, {buckled} with more than {HIGHER} times \
         the energy of the static path (the relaxing zone has buckled too), and {lost} found no further equilibrium."
    ));
    page.claim(
        "5",
        "A folds to the colon, B to the ileum, with the paper's scheme (Newmark, ηD/(EΔτ) = 100; its rate is not given)",
        format!(
            "from the square on with 0.001 of Lmax/L per pseudo-time step {}; static {}, {}",
            papers,
            without[0],
            without[1]
        ),
        as_printed_by_it
            && without.iter().zip(CASES).all(|(found, (_, _, towards))| *found == towards.to_string()),
    );
    Ok(())
}

/// Energy, relative to the last state of the static path, above which the wall has buckled besides the fold.
const HIGHER: f64 = 1.5;

/// Compares the energies of both branches.
fn branches(page: &mut Page, runs: &Runs) -> Result<(), ReproductionError> {
    page.text(
        "**Both branches.** If the far end is pushed while the tube is square, each tube folds to the other side (`cases/other-side.toml`), and \
         it keeps that fold when the end is released at Lmax/L = 1.25. The walls pass through each other during the push; \
         only the final states are compared.",
    );
    let mut rows = vec![];
    let mut found = vec![];
    let mut good = true;
    for ((panel, case, towards), pushed) in CASES
        .into_iter()
        .zip(["other-side", "other-side-of-ileum-side"])
    {
        let (own, other) = (runs.get(&coarse(case))?.last()?, runs.get(pushed)?.last()?);
        let differ = other.energy / own.energy - 1.0;
        rows.push(vec![
            panel.into(),
            side(own),
            energy(own),
            side(other),
            energy(other),
            format!("{differ:+.1e}"),
        ]);
        found.push(format!(
            "{panel}: {} by itself, {} when pushed, W {differ:+.1e}",
            own.side, other.side
        ));
        good &= is_folded(own, towards)
            && other.shape == Shape::Invaginated
            && other.side != towards
            && differ.abs() < 0.01;
    }
    page.table(
        &[
            "",
            "by itself",
            "W",
            "pushed and released",
            "W",
            "differ by",
        ],
        rows,
    );
    page.add(
        "5",
        "the two sides are mirror branches of nearly the same energy",
        found.join("; "),
        good,
    );
    Ok(())
}
