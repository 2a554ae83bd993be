//! Contraction alone, relaxation alone, and both.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{Ran, Runs};
use super::super::{Figure, Fineness, Trouble};
use super::{FOLD, axisymmetric, is_folded, side, unstable};
use plica::equilibrium::UnstableMode;
use plica::measure::{Shape, Side};
use plica::run_directory;

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
    let job = Job::of("collapse").named("collapse-damped-on").large();
    job.from("collapse", OVAL)
        .with("stages[1].steps", 12)
        .with("stages[1].drive.longitudinal.length_ratio", 1.2)
        .with("solver.scheme", "\"damped\"")
        .with("solver.pseudo_time.tolerance", "1e-3")
        .with("solver.pseudo_time.equilibrate", false)
}

/// The axisymmetric tube on the mesh of the oval, to compare energies with.
fn kept_round() -> Job {
    let job = Job::of("relaxation").named("relaxation-on-the-mesh-of-the-oval");
    job.on([105, 32, 5])
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![
        axisymmetric("contraction", fineness),
        axisymmetric("relaxation", fineness),
        axisymmetric("invagination", fineness),
        Job::of("collapse").large(),
        kept_round(),
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
    let (a, b, c) = (contraction.last()?, collapse.last()?, both.at(1.25)?);
    let rings = ring_buckled.at(1.2)?;

    let overhang = largest_overhang(contraction);
    page.claim(
        "3A",
        "contraction alone gives a V and no invagination",
        format!(
            "{}, steepest wall {:.0}°, overhang of {overhang:.3} D in any state, at most",
            a.shape, a.max_wall_angle_deg
        ),
        a.shape == Shape::V
            && overhang < 1e-3
            && contraction.verdict == run_directory::Verdict::Complete,
    );
    let overhang = largest_overhang(collapse);
    page.claim(
        "3B",
        "relaxation alone makes the tube collapse, without invagination",
        format!(
            "an oval at Lmax/L = {:.2}{}: harmonic {}, {:.3} D from round, the lumen {:.3} D wide at its narrowest, overhang {overhang:.3} D",
            b.length_ratio,
            fineness.choose(" (--full goes on to the paper's 1.2)", ""),
            b.asymmetry_mode,
            b.asymmetry,
            b.lumen
        ),
        b.asymmetry > 0.05
            // Less than half of what it is at rest.
            && b.lumen < collapse.plan.tube.inner_radius()
            && b.in_equilibrium
            && overhang < FOLD,
    );
    if fineness == Fineness::Full {
        collapse_at_the_papers_length(page, runs.get(&dragged_on().name)?)?;
    }
    page.claim(
        "3C",
        "both together make it invaginate",
        side(c),
        is_folded(c, Side::Colon) || is_folded(c, Side::Ileum),
    );

    let ratio = |ratio: f64| format!("*L*_{{max}}/*L* = {ratio:.2}");
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
                format!("B   {}: {}", ratio(b.length_ratio), b.shape),
            )?,
            panel(
                ring_buckled,
                rings,
                format!(
                    "B, if it stayed axisymmetric   {}",
                    ratio(rings.length_ratio)
                ),
            )?,
            panel(
                both,
                c,
                format!(
                    "C   *D*_{{min}}/*D* = 0.25, {}: {}",
                    ratio(c.length_ratio),
                    c.shape
                ),
            )?,
        ])?,
        "Tubes cut open, coloured by strain energy density; B is cut through its widest meridians",
    );
    instead(page, runs, ring_buckled)?;
    page.text(format!(
        "**Stability.** A and C are axisymmetric states, those of the full tube as well; but a full tube leaves the path of C where it is \
         unstable: at Lmax/L = {} (Appendix B).",
        unstable(both.stage("relax"))
    ));
    Ok(())
}

fn largest_overhang(ran: &Ran) -> f64 {
    let overhangs = ran.rows.iter().map(|row| row.overhang);
    overhangs.fold(0.0, f64::max)
}

/// What the tube of 3B does in rings, and why it does not.
fn instead(page: &mut Page, runs: &Runs, rings: &Ran) -> Result<(), Trouble> {
    let lost = rings.rows.iter().find(|row| row.stability.is_unstable());
    let oval_first = match lost {
        Some(row)
            if row
                .stability
                .unstable_modes()
                .eq([UnstableMode::Circumferential(2)]) =>
        {
            format!(
                "the first harmonic that its path loses is 2, an oval, by Lmax/L = {:.2}: this is what the run of B is started on, by an end \
             that is held on an oval of 1e-4 D, and it is run as two halves that are alike",
                row.length_ratio
            )
        }
        Some(row) => format!(
            "its path first loses harmonics {} by Lmax/L = {:.2}; the run of B is started on an oval all the same",
            row.stability, row.length_ratio
        ),
        None => {
            "its path loses no harmonic; the run of B is started on an oval all the same".into()
        }
    };
    let folds = match rings.rows.iter().find(|row| row.overhang > FOLD) {
        Some(row) => format!(
            "at Lmax/L = {:.2} a ring has folded over itself outwards, {:.2} D deep{}",
            row.length_ratio,
            row.overhang,
            if row.crosses_itself() {
                ", and the wall crosses itself"
            } else {
                ""
            }
        ),
        None => "no ring folds over".into(),
    };
    let (oval, round) = (runs.get("collapse")?, runs.get(&kept_round().name)?);
    let at = 1.08;
    let (oval, round) = (oval.at(at)?, round.at(at)?);
    page.text(format!(
        "**B, told in full.** A tube that relaxes and cannot get longer is under compression. Kept axisymmetric (`cases/relaxation.toml`) it \
         swells and buckles in rings; {folds}. In three dimensions it does not get there: {oval_first}. At Lmax/L = {at} the oval has \
         W = {}, the axisymmetric tube on the same mesh {} E D³ ({:.0} % more).",
        energy(oval),
        energy(round),
        100.0 * (round.energy / oval.energy - 1.0),
    ));
    Ok(())
}

/// What becomes of 3B between 1.08 and Lmax/L = 1.2.
fn collapse_at_the_papers_length(page: &mut Page, on: &Ran) -> Result<(), Trouble> {
    let last = on.last()?;
    let closed = on.rows.iter().find(|row| row.has_closed());
    let off = on.rows.iter().map(|row| row.residual).fold(0.0, f64::max);
    let reached = format!(
        "damped on from 1.08, out of equilibrium by up to {off:.0e} of the forces in play, to {:.2}: {:.3} D from round, lumen {:.3} D",
        last.length_ratio, last.asymmetry, last.lumen
    );
    let overhang = largest_overhang(on);
    let holds = on.verdict == run_directory::Verdict::Complete
        && last.shape == Shape::Collapsed
        && overhang < FOLD;
    let (found, verdict) = match closed {
        Some(row) => (
            format!(
                "{reached}; its lumen is closed from {:.2} on, where only contact could hold it",
                row.length_ratio
            ),
            Verdict::Explained,
        ),
        None => (reached, Verdict::of(holds)),
    };
    page.judge("3B", "it has collapsed at Lmax/L = 1.2", found, verdict);
    page.text(
        "**3B at 1.2.** Past 1.08 the oval does not come to rest in the relaxation of the static scheme (200 solves), so it is followed with \
         damping (backward Euler, ηD/(EΔτ) = 5), each state taken when nothing moves by 1e-3 D in a step of pseudo-time. The states are nearly, \
         and not quite, in equilibrium. The paper accepts its own by such a rule too, with 1e-5 D.",
    );
    Ok(())
}
