//! Contraction alone, relaxation alone, and both.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{Ran, Runs};
use super::super::{Figure, Fineness, Trouble};
use super::{axisymmetric, side};

pub(super) const FIGURE: Figure = Figure {
    name: "fig3",
    title: "Fig. 3: contraction alone, relaxation alone, and both",
    paper: "The paper's Fig. 3 shows three tubes: A contracts (Dmin/D = 0.25) and forms a V; B relaxes (Lmax/L = 1.2) and \
            collapses; C does both (Lmax/L = 1.25) and invaginates.",
    jobs,
    tell,
};

/// Number of the last state of `cases/collapse.toml`, at Lmax/L = 1.08.
const OVAL: usize = 8;

/// The oval dragged on: each step until nothing moves 1e-3 D in a step of pseudo-time, and not settled, since it does not
/// come to rest before its lumen is closed.
fn dragged_on() -> Job {
    let job = Job::of("collapse").named("collapse-dragged-on").large();
    job.from("collapse", OVAL)
        .with("stages[0].steps", 12)
        .with("stages[0].drive.longitudinal.length_ratio", 1.2)
        .with("solver.scheme", "\"dragged\"")
        .with("solver.pseudo_time.tolerance", "1e-3")
        .with("solver.pseudo_time.settle", false)
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![
        axisymmetric("contraction", fineness),
        axisymmetric("relaxation", fineness),
        axisymmetric("invagination", fineness),
        Job::of("collapse").large(),
    ];
    if fineness == Fineness::Full {
        let finer = Job::of("collapse").named("collapse-paper-mesh").large();
        jobs.push(finer.on([305, 60, 8]).from("collapse", OVAL - 1));
        jobs.push(dragged_on());
    }
    jobs
}

fn tell(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), Trouble> {
    let [contraction, ring_buckled, both] =
        ["contraction", "relaxation", "invagination"].map(|name| runs.get(name));
    let (contraction, ring_buckled, both) = (contraction?, ring_buckled?, both?);
    let collapse = runs.get(fineness.choose("collapse", "collapse-paper-mesh"))?;
    let (a, b, c) = (contraction.last()?, collapse.last()?, both.last()?);

    let overhang = contraction.rows.iter().map(|row| row.overhang);
    let overhang = overhang.fold(0.0, f64::max);
    page.claim(
        "3A",
        "contraction alone gives a V and no invagination",
        format!(
            "{}, steepest wall {:.0}°, overhang of {overhang:.3} D in any state, at most",
            a.shape, a.max_wall_angle_deg
        ),
        a.shape == "V" && overhang < 1e-3,
    );
    let never = collapse.rows.iter().all(|row| row.shape != "invaginated");
    page.claim(
        "3B",
        "relaxation alone makes the tube collapse, without invagination",
        format!(
            "{} at Lmax/L = {:.2}, in equilibrium{}: harmonic {}, {:.3} D from round, the lumen {:.3} D wide at its narrowest",
            b.shape,
            b.length_ratio,
            fineness.choose(" (--full goes on to the paper's 1.2)", ""),
            b.departure_harmonic,
            b.departure,
            b.lumen
        ),
        b.shape == "collapsed" && b.departure > 0.05 && b.equilibrium == "yes" && never,
    );
    if fineness == Fineness::Full {
        collapse_at_the_papers_length(page, runs.get(&dragged_on().name)?)?;
    }
    page.claim(
        "3C",
        "both together make it invaginate",
        side(c),
        c.shape == "invaginated",
    );

    page.picture(
        "tubes",
        tubes(vec![
            panel(
                contraction,
                a,
                format!("A   *D*_{{min}}/*D* = 0.25: {}", a.shape),
            )?,
            panel(
                collapse,
                b,
                format!("B   *L*_{{max}}/*L* = {:.2}: {}", b.length_ratio, b.shape),
            )?,
            panel(
                both,
                c,
                format!(
                    "C   *D*_{{min}}/*D* = 0.25, *L*_{{max}}/*L* = 1.25: {}",
                    c.shape
                ),
            )?,
        ])?,
        "Tubes cut open, coloured by strain energy density; B is cut through its widest meridians",
    );

    let round = ring_buckled
        .at(b.length_ratio)
        .or_else(|_| ring_buckled.last())?;
    page.text(format!(
        "**B, told in full.** A tube that relaxes and cannot get longer is under compression. Kept axisymmetric it \
         swells and then buckles in rings (`cases/relaxation.toml`); in three dimensions it turns oval first. At Lmax/L = {:.2} \
         the oval has W = {} and the axisymmetric tube {} E D³ ({:.0} % more).",
        round.length_ratio,
        energy(b),
        energy(round),
        100.0 * (round.energy / b.energy - 1.0),
    ));
    Ok(())
}

/// Why 3B is not followed to Lmax/L = 1.2.
fn collapse_at_the_papers_length(page: &mut Page, on: &Ran) -> Result<(), Trouble> {
    let last = on.last()?;
    let closed = on.rows.iter().find(|row| row.has_closed());
    let (found, verdict) = match closed {
        Some(row) => (
            format!(
                "dragged on from 1.08, the oval has closed its lumen at {:.2}: from there on opposite walls pass through each other, in the paper's model as in this",
                row.length_ratio
            ),
            Verdict::Explained,
        ),
        None => (
            format!(
                "dragged on from 1.08, the oval is {:.3} D from round at {:.2}, and its lumen {:.3} D wide",
                last.departure, last.length_ratio, last.lumen
            ),
            Verdict::of(on.verdict == "complete" && last.shape == "collapsed"),
        ),
    };
    page.judge("3B", "it has collapsed at Lmax/L = 1.2", found, verdict);
    Ok(())
}
