//! Perturbed boundary conditions.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::{Ran, Runs};
use super::super::{Figure, Fineness, Trouble};
use super::{FOLD, axisymmetric, side};
use plica::measure::Shape;
use plica::measure::{Face, Side};
use plica::run_directory;
use plica::study::Row;

pub(super) const FIGURE: Figure = Figure {
    name: "appendix-b",
    title: "Appendix B: a perturbed boundary condition",
    paper: "The tube still invaginates when the boundary condition is perturbed (how is told in an appendix that is not at hand \
            here). Plica perturbs where an end is held, in several ways, and follows the tube in three dimensions to Lmax/L = 1.25.",
    jobs,
    tell,
};

/// A perturbation: its name, in words, the direction and the shape of the displacement of the end.
struct Kind {
    name: &'static str,
    words: &'static str,
    direction: &'static str,
    shape: &'static str,
    /// Another imperfection beside it.
    besides: &'static str,
}

/// What leads a tube sideways that would otherwise stay in balance there: along the short axis of its oval, as that is
/// where it tilts to in the end. Led along the long one it tilts there first, and then turns, in a balance so nearly
/// neutral that relaxation is lost on the way.
const LED_ASIDE: &str = ", { of = \"ileum-end\", amplitude = 1e-4, shape = { wave = { mode = 1, phase_degrees = 90 } } }";

const KINDS: [Kind; 4] = [
    Kind {
        name: "shifted",
        words: "the colon end shifted sideways",
        direction: "across",
        shape: "{ wave = { mode = 1 } }",
        besides: "",
    },
    Kind {
        name: "tilted",
        words: "the colon end tilted",
        direction: "axial",
        shape: "{ wave = { mode = 1 } }",
        besides: "",
    },
    Kind {
        name: "oval",
        words: "the colon end held on an oval (and the ileum end shifted by 1e-4 D)",
        direction: "across",
        shape: "{ wave = { mode = 2 } }",
        besides: LED_ASIDE,
    },
    Kind {
        name: "uneven",
        words: "the colon end held unevenly (random harmonics 0 to 4)",
        direction: "across",
        shape: "{ random = { seed = 7 } }",
        besides: "",
    },
];

/// An amplitude that is looked at of every kind, in D: a twelfth of the wall's thickness.
const USUAL: f64 = 5e-3;

/// The kinds, and the amplitudes of each in D. The last two are looked at once: little in the uneven end leads the tube
/// off a path that is unstable sideways, so that it takes many minutes through the fold.
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
        .with("imperfections", format!("[{own}{}]", kind.besides))
}

fn on_paper_mesh() -> Job {
    let job = job(&KINDS[0], 1e-4).named("perturbed-paper-mesh");
    job.on([305, 60, 8]).large()
}

/// The tube that nothing perturbs, on the same mesh.
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

/// How the two sides of a tube that leans fold: that which leans out, and that across from it.
struct Sides {
    /// Overhang of each, in D, and the end that it is towards.
    folds: [(f64, Side); 2],
}

impl Sides {
    fn of(ran: &Ran, row: &Row) -> Result<Self, Trouble> {
        let crest = row.asymmetry_angle_deg.to_radians();
        let across = crest + std::f64::consts::PI / row.asymmetry_mode.max(1) as f64;
        let fold = |angle| Ok(ran.wall(row, Face::Outer, angle)?.overhang());
        let folds: Result<Vec<(f64, Side)>, Trouble> =
            [crest, across].map(fold).into_iter().collect();
        let folds = folds?;
        Ok(Self {
            folds: [folds[0], folds[1]],
        })
    }

    fn told(&self) -> String {
        let [a, b] = self.folds.map(|(deep, side)| match side {
            Side::None => "does not overhang".into(),
            side => format!("folds {deep:.3} D to the {side}"),
        });
        if self.to_one_end() {
            format!("all around: one side {a}, the other {b}")
        } else {
            format!("it tilts: one side {a}, the other {b}")
        }
    }

    /// Whether it folds to the same end all around, as an axisymmetric tube does.
    fn to_one_end(&self) -> bool {
        let [(_, a), (_, b)] = self.folds;
        a == b && a != Side::None
    }
}

/// Whether a perturbed tube still invaginates: it does if it folds to one end all around; if it tilts, both of its sides
/// fold, each to an end of its own, and that is told.
fn verdict(ran: &Ran, row: &Row, sides: &Sides) -> Verdict {
    let arrived = ran.verdict == run_directory::Verdict::Complete
        && row.shape == Shape::Invaginated
        && row.overhang > FOLD;
    match (arrived, sides.to_one_end()) {
        (true, true) => Verdict::Agrees,
        (true, false) => Verdict::Explained,
        _ => Verdict::Differs,
    }
}

fn tell(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), Trouble> {
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
                run_directory::Verdict::Complete => sides.told(),
                _ => format!("lost after {:.3}; {}", last.length_ratio, sides.told()),
            };
            found.push(format!("{amplitude} D: {end}"));
            rows.push(vec![
                kind.words.into(),
                format!("{amplitude}"),
                end,
                format!("harmonic {}, {:.3} D", last.asymmetry_mode, last.asymmetry),
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
                "{}; W = {}, {:.3} D from axisymmetric (harmonic {})",
                sides.told(),
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
            "**Does the tilted tube store less?** On the paper's mesh, W of the tilted tube against that of the axisymmetric one: {}.",
            energies.join(", ")
        ));
        panels.push(panel(ran, last, "on the paper's mesh, shifted by 1e-4 D")?);
    }
    page.table(
        &[
            "perturbation",
            "amplitude, D",
            "at Lmax/L = 1.25",
            "from axisymmetric",
            "W",
            "seconds",
        ],
        rows,
    );
    page.picture(
        "tubes",
        tubes(panels)?,
        "Perturbed tubes at Lmax/L = 1.25, cut open along the plane in which they lean, coloured by strain energy density",
    );
    page.text(
        "**Why it tilts.** The axisymmetric path of the main case is unstable to harmonic 1 between Lmax/L = 1.179 and 1.198 (`plica stability` of it on the paper's mesh; \
         docs/stability.md), before its wall overhangs. A perturbation that has a part in harmonic 1 lets the tube tilt there, and it \
         then folds to both ends at once: to one on the side that leans in, to the other across. The paper's symmetric fold is what is left where nothing leads the tube \
         aside. Its own perturbation is told in an appendix that is not at hand.",
    );
    if fineness == Fineness::Full {
        page.text(
            "**Which way.** An oval end leaves the tube in balance sideways, so the ileum end leads it aside along the oval's short axis. Led along \
             the long axis (`phase_degrees` 0 in place of 90) it tilts that way first and then has to turn by a quarter, with next to nothing to drive it: \
             plica 0.1.0 was lost on that way, in relaxation at Lmax/L = 1.209 after eleven minutes (not run here).",
        );
    }
    Ok(())
}
