//! Relaxation on one side of the contraction: which way does it fold, and what decides?

use super::super::job::Job;
use super::super::page::{Page, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{Ran, Runs};
use super::super::{Figure, Fineness, Trouble};
use super::{COARSE, axisymmetric, first, is_folded, ratio, side};
use crate::study::Row;

pub(super) const FIGURE: Figure = Figure {
    name: "fig5",
    title: "Fig. 5: relaxation on one side of the contraction",
    paper: "The contraction (Dmin/D = 0.25) takes 0.5 to 1.75 D from the colon end, the relaxation lies beside it: A at 0 to \
            0.5, B at 1.75 to 2.25. At Lmax/L = 1.17 both are square; at 1.25 A has invaginated toward the colon, B toward \
            the ileum.",
    jobs,
    tell,
};

/// The two cases, the panel of each, and its side.
const CASES: [(&str, &str, &str); 2] =
    [("5A", "colon-side", "colon"), ("5B", "ileum-side", "ileum")];

/// Number of the state at Dmin/D = 0.25, before the relaxation.
const CONTRACTED: usize = 15;

/// Drags, and pseudo-time steps from Lmax/L = 1.0 to 1.25.
fn map(fineness: Fineness) -> (&'static [f64], &'static [usize]) {
    fineness.choose(
        (&[1.0, 10.0, 100.0], &[25, 250]),
        (&[0.1, 1.0, 10.0, 100.0, 1000.0], &[25, 250, 1000]),
    )
}

fn name(case: &str, drag: f64, ramp: usize) -> String {
    format!("{case}-drag-{drag}-ramp-{ramp}")
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![];
    for (_, case, _) in CASES {
        jobs.push(axisymmetric(case, fineness));
        let coarse = format!("{case}-coarse");
        jobs.push(Job::of(case).named(&coarse).on(COARSE));
        let (drags, ramps) = map(fineness);
        for &drag in drags {
            for &ramp in ramps {
                let job = Job::of(case).named(name(case, drag, ramp)).on(COARSE);
                jobs.push(dragged(job.from(&coarse, CONTRACTED).bare(), drag, ramp));
            }
        }
    }
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

/// In one ramp of pseudo-time from the contracted tube on.
fn dragged(job: Job, drag: f64, ramp: usize) -> Job {
    job.with("stages[1].steps", 1)
        .with("stages[2].steps", 1)
        .with("solver.scheme", "\"dragged\"")
        .with("solver.pseudo_time.drag", format!("{drag:?}"))
        .with("solver.pseudo_time.ramp", ramp)
        .with("solver.pseudo_time.tolerance", "1e-4")
        .with("solver.pseudo_time.hold", 20000)
}

fn tell(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), Trouble> {
    let mut panels = vec![];
    for (panel_name, case, towards) in CASES {
        let ran = runs.get(case)?;
        let (square, end) = (ran.at(1.17)?, ran.at(1.25)?);
        page.claim(
            panel_name,
            "a square at Lmax/L ~ 1.17",
            format!(
                "at 1.17 {}, steepest wall {:.0}°; overhangs from {}",
                square.shape,
                square.max_wall_angle_deg,
                ratio(first(&ran.rows, "invaginated"))
            ),
            square.shape == "square",
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

/// Which side is taken, over drags and ramps.
fn sides(page: &mut Page, runs: &Runs, fineness: Fineness) -> Result<(), Trouble> {
    page.text(
        "**Which side, and what decides it.** The static scheme knows no drag. With one, the whole ramp of Lmax/L from 1.0 to 1.25 \
         is done in so many pseudo-time steps of a backward Euler scheme, from the same contracted state, and then held. What counts is the \
         product of drag and rate: where it is too large the wall cannot follow, and the relaxing zone buckles by itself. \
         `reproduce` shows the static scheme in the figure.",
    );
    let (drags, ramps) = map(fineness);
    let mut heads = vec!["ηD/(EΔτ)".to_owned()];
    for (panel, ..) in CASES {
        heads.extend(
            ramps
                .iter()
                .map(|n| format!("{panel}, {:.1e} per step", 0.25 / *n as f64)),
        );
    }
    let mut rows = vec![];
    let mut still = vec!["none (static)".to_owned()];
    let (mut as_printed, mut otherwise, mut neither) = (0, 0, 0);
    for (_, case, _) in CASES {
        let ran = runs.get(case)?;
        still.extend(vec![outcome(ran, ran.last()?); ramps.len()]);
    }
    rows.push(still);
    for &drag in drags {
        let mut row = vec![format!("{drag}")];
        for (_, case, towards) in CASES {
            for &ramp in ramps {
                let ran = runs.get(&name(case, drag, ramp))?;
                let last = ran.last()?;
                let buckled = ran.verdict != "complete" || has_buckled(runs, case, last)?;
                match () {
                    () if buckled => neither += 1,
                    () if is_folded(last, towards) => as_printed += 1,
                    () => otherwise += 1,
                }
                row.push(if buckled {
                    "the zone buckles".into()
                } else {
                    outcome(ran, last)
                });
            }
        }
        rows.push(row);
    }
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    page.table(&heads, rows);
    page.claim(
        "5",
        "A folds to the colon, B to the ileum (at ηD/(EΔτ) = 100, the rate is not given)",
        format!("static: as printed; with drag, of {} ramps {as_printed} as printed, {otherwise} to the other side, {neither} buckle in the relaxing zone", as_printed + otherwise + neither),
        otherwise == 0 && as_printed > 0,
    );
    Ok(())
}

/// Energy above that of the static path's last state beyond which something else than the fold holds it.
const HIGHER: f64 = 1.5;

fn has_buckled(runs: &Runs, case: &str, last: &Row) -> Result<bool, Trouble> {
    let coarse = runs.get(&format!("{case}-coarse"))?;
    Ok(last.energy > HIGHER * coarse.last()?.energy)
}

fn outcome(ran: &Ran, row: &Row) -> String {
    match ran.verdict.as_str() {
        "complete" if row.shape == "invaginated" => row.side.clone(),
        "complete" => row.shape.clone(),
        _ => "lost".into(),
    }
}

/// The energies of both branches.
fn branches(page: &mut Page, runs: &Runs) -> Result<(), Trouble> {
    page.text(
        "**Both branches.** Pushed at the far end while it is square, each tube folds to the other side (`cases/other-side.toml`); let go \
         at Lmax/L = 1.25 it keeps that fold.",
    );
    let mut rows = vec![];
    let mut found = vec![];
    let mut good = true;
    for ((panel, case, towards), pushed) in CASES
        .into_iter()
        .zip(["other-side", "other-side-of-ileum-side"])
    {
        let coarse = runs.get(&format!("{case}-coarse"))?;
        let (own, other) = (coarse.last()?, runs.get(pushed)?.last()?);
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
            && other.shape == "invaginated"
            && other.side != towards
            && differ.abs() < 0.01;
    }
    page.table(
        &["", "by itself", "W", "pushed and let go", "W", "differ by"],
        rows,
    );
    page.claim(
        "5",
        "the two sides are mirror branches (not in the paper)",
        found.join("; "),
        good,
    );
    Ok(())
}
