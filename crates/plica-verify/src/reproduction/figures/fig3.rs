//! Contraction alone, relaxation alone, and both.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{CompletedRun, Runs};
use super::super::{Figure, Fineness, ReproductionError};
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
    describe,
};

/// Number of the last state of `cases/collapse.toml`, at Lmax/L = 1.08.
const OVAL: usize = 8;

/// The oval continued with damping. Each state is accepted when no control point moves by 1e-3 D in a pseudo-time step and
/// is not equilibrated, because no equilibrium is found before the lumen closes.
fn continued_with_damping() -> Job {
    let job = Job::of("collapse").named("collapse-with-damping").large();
    job.from("collapse", OVAL)
        .with("stages[1].steps", 12)
        .with("stages[1].drive.longitudinal.length_ratio", 1.2)
        .with("solver.scheme", "\"backward-euler\"")
        .with("solver.pseudo_time.tolerance", "1e-3")
        .with("solver.pseudo_time.equilibrate", false)
}

/// The axisymmetric tube on the mesh of the oval, for a comparison of energies.
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
        jobs.push(continued_with_damping());
    }
    jobs
}

fn describe(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
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
            "{}, steepest wall {:.0}°, overhang of at most {overhang:.3} D in any state",
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
            "an oval at Lmax/L = {:.2}{}: circumferential mode {}, asymmetry {:.3} D, narrowest lumen {:.3} D, overhang {overhang:.3} D",
            b.length_ratio,
            fineness.choose(" (--full continues to the paper's 1.2)", ""),
            b.asymmetry_mode,
            b.asymmetry,
            b.lumen
        ),
        b.asymmetry > 0.05
            // Less than half of the lumen at rest.
            && b.lumen < collapse.plan.tube.inner_radius()
            && b.in_equilibrium
            && overhang < FOLD,
    );
    if fineness == Fineness::Full {
        collapse_at_the_papers_length(page, runs.get(&continued_with_damping().name)?)?;
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
    axisymmetric_alternative(page, runs, ring_buckled)?;
    page.text(format!(
        "**Stability.** A and C are axisymmetric and also equilibria of the whole tube; but the whole tube leaves the path of C where it is \
         unstable: at Lmax/L = {} (Appendix B).",
        unstable(both.stage("relax"))
    ));
    Ok(())
}

fn largest_overhang(ran: &CompletedRun) -> f64 {
    let overhangs = ran.rows.iter().map(|row| row.overhang);
    overhangs.fold(0.0, f64::max)
}

/// Compares the oval of 3B with the axisymmetric tube.
fn axisymmetric_alternative(
    page: &mut Page,
    runs: &Runs,
    rings: &CompletedRun,
) -> Result<(), ReproductionError> {
    let lost = rings.rows.iter().find(|row| row.stability.is_unstable());
    let oval_first = match lost {
        Some(row)
            if row
                .stability
                .unstable_modes()
                .eq([UnstableMode::Circumferential(2)]) =>
        {
            format!(
                "its path first loses stability to circumferential mode 2 (oval), by Lmax/L = {:.2}. An oval imperfection of 1e-4 D \
                 at one end starts the run of B on this mode, with two-fold symmetry",
                row.length_ratio
            )
        }
        Some(row) => format!(
            "its path first loses stability to circumferential modes {} by Lmax/L = {:.2}; the run of B nevertheless starts from \
             an oval",
            row.stability, row.length_ratio
        ),
        None => {
            "its path is stable to all tested modes; the run of B nevertheless starts from an oval"
                .into()
        }
    };
    let folds = match rings.rows.iter().find(|row| row.overhang > FOLD) {
        Some(row) => format!(
            "at Lmax/L = {:.2} a ring has folded over outwards, with an overhang of {:.2} D{}",
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
        "**B in detail.** A tube that relaxes between fixed ends is under compression. An axisymmetric tube \
         (`cases/relaxation.toml`) swells and buckles in rings; {folds}. In three dimensions it collapses earlier: {oval_first}. At Lmax/L = {at} the oval has \
         W = {}, the axisymmetric tube on the same mesh {} E D³ ({:.0} % more).",
        energy(oval),
        energy(round),
        100.0 * (round.energy / oval.energy - 1.0),
    ));
    Ok(())
}

/// Describes the tube of 3B between Lmax/L = 1.08 and 1.2.
fn collapse_at_the_papers_length(
    page: &mut Page,
    on: &CompletedRun,
) -> Result<(), ReproductionError> {
    let last = on.last()?;
    let closed = on.rows.iter().find(|row| row.has_closed());
    let off = on.rows.iter().map(|row| row.residual).fold(0.0, f64::max);
    let reached = format!(
        "continued with damping from 1.08, with relative residuals up to {off:.0e}, to {:.2}: asymmetry {:.3} D, lumen {:.3} D",
        last.length_ratio, last.asymmetry, last.lumen
    );
    let overhang = largest_overhang(on);
    let holds = on.verdict == run_directory::Verdict::Complete
        && last.shape == Shape::Collapsed
        && overhang < FOLD;
    let (found, verdict) = match closed {
        Some(row) => (
            format!(
                "{reached}; its lumen is closed from {:.2} on, where an equilibrium would need contact",
                row.length_ratio
            ),
            Verdict::Explained,
        ),
        None => (reached, Verdict::of(holds)),
    };
    page.judge("3B", "it has collapsed at Lmax/L = 1.2", found, verdict);
    page.text(
        "**3B at 1.2.** Beyond 1.08 the relaxation of the static scheme finds no equilibrium of the oval (200 solves), so the path is \
         continued with damping (backward Euler, ηD/(EΔτ) = 5). Each state is accepted when no control point moves by 1e-3 D \
         in a pseudo-time step, so the states are only nearly in equilibrium. The paper accepts states by such a rule too, \
         with 1e-5 D.",
    );
    Ok(())
}
