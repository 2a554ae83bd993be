//! Perturbed boundary conditions.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{CompletedRun, Runs};
use super::super::{Figure, Fineness, ReproductionError};
use super::{FOLD, axisymmetric, side};
use plica::measure::Shape;
use plica::measure::{Face, Side};
use plica::run_directory;
use plica::study::Row;

pub(super) const FIGURE: Figure = Figure {
    name: "appendix-b",
    title: "Appendix B: a perturbed boundary condition",
    paper: "The tube still invaginates when the boundary condition is perturbed (the perturbation is described in an appendix \
            that is not available here). Plica perturbs the support of an end in several ways and follows the tube in three \
            dimensions to Lmax/L = 1.25.",
    jobs,
    describe,
};

/// A kind of perturbation of the end.
struct Kind {
    name: &'static str,
    words: &'static str,
    direction: &'static str,
    shape: &'static str,
    /// Additional imperfection.
    additional: &'static str,
}

/// A second imperfection that triggers the sideways branch of an oval tube, along the short axis of the oval: the tube
/// finally tilts in this direction. Along the long axis it tilts there first and then rotates by a quarter, nearly neutrally,
/// and relaxation does not converge.
const SIDEWAYS: &str = ", { of = \"ileum-end\", amplitude = 1e-4, shape = { wave = { mode = 1, phase_degrees = 90 } } }";

const KINDS: [Kind; 4] = [
    Kind {
        name: "shifted",
        words: "the colon end shifted sideways",
        direction: "across",
        shape: "{ wave = { mode = 1 } }",
        additional: "",
    },
    Kind {
        name: "tilted",
        words: "the colon end tilted",
        direction: "axial",
        shape: "{ wave = { mode = 1 } }",
        additional: "",
    },
    Kind {
        name: "oval",
        words: "the colon end made oval (and the ileum end shifted by 1e-4 D)",
        direction: "across",
        shape: "{ wave = { mode = 2 } }",
        additional: SIDEWAYS,
    },
    Kind {
        name: "uneven",
        words: "the colon end made uneven (random circumferential modes 0 to 4)",
        direction: "across",
        shape: "{ random = { seed = 7 } }",
        additional: "",
    },
];

/// Amplitude in D that is used for every kind: a twelfth of the thickness of the wall.
const USUAL: f64 = 5e-3;

/// Returns the kinds with their amplitudes in D. The last two have one amplitude: the uneven end hardly triggers the
/// sideways branch, so that its run takes many minutes through the fold.
fn perturbations(fineness: Fineness) -> [(&'static Kind, &'static [f64]); 4] {
    let [shifted, tilted, oval, uneven] = &KINDS;
    let several: &[f64] = fineness.choose(&[USUAL], &[1e-3, USUAL, 1.5e-2]);
    let once: &[f64] = fineness.choose(&[], &[USUAL]);
    [
        (shifted, several),
        (tilted, several),
        (oval, once),
        (uneven, once),
    ]
}

fn job(kind: &Kind, amplitude: f64) -> Job {
    let own = format!(
        "{{ of = \"colon-end\", amplitude = {amplitude:?}, direction = \"{}\", shape = {} }}",
        kind.direction, kind.shape
    );
    Job::of("perturbed")
        .named(format!("perturbed-{}-{amplitude}", kind.name))
        .with("imperfections", format!("[{own}{}]", kind.additional))
}

fn on_paper_mesh() -> Job {
    let job = job(&KINDS[0], 1e-4).named("perturbed-paper-mesh");
    job.on([305, 60, 8]).large()
}

/// The unperturbed tube on the same mesh.
fn unperturbed() -> Job {
    Job::of("perturbed")
        .named("perturbed-not-at-all")
        .with("imperfections", "[]")
        .with("symmetry", "\"axisymmetric\"")
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![unperturbed()];
    for (kind, amplitudes) in perturbations(fineness) {
        jobs.extend(amplitudes.iter().map(|&a| job(kind, a)));
    }
    if fineness == Fineness::Full {
        jobs.push(on_paper_mesh());
        jobs.push(axisymmetric("invagination", fineness));
    }
    jobs
}

/// Folds of the two opposite sides of a tilted tube.
struct Sides {
    /// Overhang of each in D, and the end that it points to.
    folds: [(f64, Side); 2],
}

impl Sides {
    fn of(ran: &CompletedRun, row: &Row) -> Result<Self, ReproductionError> {
        let crest = row.asymmetry_angle_deg.to_radians();
        let across = crest + std::f64::consts::PI / row.asymmetry_mode.max(1) as f64;
        let fold = |angle| Ok(ran.wall(row, Face::Outer, angle)?.overhang());
        let folds: Result<Vec<(f64, Side)>, ReproductionError> =
            [crest, across].map(fold).into_iter().collect();
        let folds = folds?;
        Ok(Self {
            folds: [folds[0], folds[1]],
        })
    }

    fn describe(&self) -> String {
        let [a, b] = self.folds.map(|(overhang, side)| match side {
            Side::None => "does not overhang".into(),
            side => format!("folds {overhang:.3} D to the {side}"),
        });
        if self.to_one_end() {
            format!("all around: one side {a}, the other {b}")
        } else {
            format!("it tilts: one side {a}, the other {b}")
        }
    }

    /// Returns whether it folds to the same end all around, as an axisymmetric tube does.
    fn to_one_end(&self) -> bool {
        let [(_, a), (_, b)] = self.folds;
        a == b && a != Side::None
    }
}

/// Returns whether a perturbed tube still invaginates: it agrees if it folds to one end all around; if it tilts, its sides
/// fold to different ends, which is explained.
fn verdict(ran: &CompletedRun, row: &Row, sides: &Sides) -> Verdict {
    let arrived = ran.verdict == run_directory::Verdict::Complete
        && row.shape == Shape::Invaginated
        && row.overhang > FOLD;
    match (arrived, sides.to_one_end()) {
        (true, true) => Verdict::Agrees,
        (true, false) => Verdict::Explained,
        _ => Verdict::Differs,
    }
}

fn describe(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
    let mut panels = vec![];
    let perfect = runs.get(&unperturbed().name)?.last()?;
    let mut rows = vec![vec![
        "none (axisymmetric)".into(),
        "0".into(),
        side(perfect),
        "–".into(),
        energy(perfect),
        "–".into(),
    ]];
    let paper = |what: &str| format!("the tube still invaginates: {what}");
    for (kind, amplitudes) in perturbations(fineness) {
        if amplitudes.is_empty() {
            continue;
        }
        let mut found = vec![];
        let mut verdicts = vec![];
        for &amplitude in amplitudes {
            let ran = runs.get(&job(kind, amplitude).name)?;
            let last = ran.last()?;
            let sides = Sides::of(ran, last)?;
            verdicts.push(verdict(ran, last, &sides));
            let end = match ran.verdict {
                run_directory::Verdict::Complete => sides.describe(),
                _ => format!("lost after {:.3}; {}", last.length_ratio, sides.describe()),
            };
            found.push(format!("{amplitude} D: {end}"));
            rows.push(vec![
                kind.words.into(),
                format!("{amplitude}"),
                end,
                format!(
                    "circumferential mode {}, {:.3} D",
                    last.asymmetry_mode, last.asymmetry
                ),
                energy(last),
                format!("{:.0}", ran.seconds()),
            ]);
            if amplitude == USUAL {
                panels.push(panel(ran, last, kind.words)?);
            }
        }
        let worst = [Verdict::Differs, Verdict::Explained, Verdict::Agrees];
        let worst = worst.into_iter().find(|v| verdicts.contains(v));
        page.judge(
            "B",
            &paper(kind.words),
            found.join("; "),
            worst.unwrap_or(Verdict::Differs),
        );
    }
    if fineness == Fineness::Full {
        let ran = runs.get(&on_paper_mesh().name)?;
        let last = ran.last()?;
        let sides = Sides::of(ran, last)?;
        page.judge(
            "B",
            &paper(
                "on the paper's mesh, 439,200 unknowns, the colon end shifted sideways by 1e-4 D",
            ),
            format!(
                "{}; W = {}, asymmetry {:.3} D (circumferential mode {})",
                sides.describe(),
                energy(last),
                last.asymmetry,
                last.asymmetry_mode
            ),
            verdict(ran, last, &sides),
        );
        let perfect = runs.get("invagination")?;
        let mut energies = vec![];
        for at in [1.2, 1.25] {
            energies.push(format!(
                "at Lmax/L = {at:.2} {} against {}",
                energy(ran.at(at)?),
                energy(perfect.at(at)?)
            ));
        }
        page.text(format!(
            "**Energy of the tilted tube.** On the paper's mesh, W of the tilted tube compared with that of the axisymmetric one: {}.",
            energies.join(", ")
        ));
        panels.push(panel(ran, last, "on the paper's mesh, shifted by 1e-4 D")?);
    }
    page.table(
        &[
            "perturbation",
            "amplitude, D",
            "at Lmax/L = 1.25",
            "asymmetry",
            "W",
            "seconds",
        ],
        rows,
    );
    page.picture(
        "tubes",
        tubes(panels)?,
        "Perturbed tubes at Lmax/L = 1.25, cut open along the plane in which they tilt, coloured by strain energy density",
    );
    page.text(
        "**Why it tilts.** The axisymmetric path of the main case is unstable to circumferential mode 1 between Lmax/L = 1.179 and 1.198 (`plica stability` of it on the paper's mesh; \
         docs/stability.md), before its wall overhangs. A perturbation with a component in mode 1 triggers the tilt there, and the tube then folds to both ends at once, to \
         a different end on each side. Without such a component the tube keeps the symmetric fold of the paper. The paper's \
         own perturbation is described in an appendix that is not available.",
    );
    if fineness == Fineness::Full {
        page.text(
            "**Direction of the tilt.** An oval end does not trigger the tilt, so the ileum end is shifted along the short axis \
             of the oval. With a shift along the long axis (`phase_degrees` 0 instead of 90) the tube tilts in that direction \
             first and then rotates by a quarter, almost without resistance: relaxation of plica 0.1.0 found no equilibrium at \
             Lmax/L = 1.209 after eleven minutes (not run here).",
        );
    }
    Ok(())
}
