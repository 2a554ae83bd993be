//! Perturbed boundary conditions.

use super::super::job::Job;
use super::super::page::{Page, energy};
use super::super::pictures::{panel, tubes};
use super::super::runs::Runs;
use super::super::{Figure, Fineness, Trouble};
use super::side;

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
}

const KINDS: [Kind; 4] = [
    Kind {
        name: "shifted",
        words: "the colon end shifted sideways",
        direction: "across",
        shape: "{ wave = { harmonic = 1 } }",
    },
    Kind {
        name: "tilted",
        words: "the colon end tilted",
        direction: "axial",
        shape: "{ wave = { harmonic = 1 } }",
    },
    Kind {
        name: "oval",
        words: "the colon end held on an oval",
        direction: "across",
        shape: "{ wave = { harmonic = 2 } }",
    },
    Kind {
        name: "uneven",
        words: "the colon end held unevenly (random harmonics 0 to 4)",
        direction: "across",
        shape: "{ random = { seed = 7 } }",
    },
];

/// An amplitude that is looked at of every kind, in D: a twelfth of the wall's thickness.
const USUAL: f64 = 5e-3;

/// The kinds, and the amplitudes of each in D. Little in the last two leads the tube off a path that is unstable
/// sideways, so that they take many minutes through the fold: they are looked at once.
fn perturbations(fineness: Fineness) -> [(&'static Kind, &'static [f64]); 4] {
    let [shifted, tilted, oval, uneven] = &KINDS;
    let several: &[f64] = fineness.choose(&[USUAL], &[1e-4, USUAL, 1.5e-2]);
    let once: &[f64] = fineness.choose(&[], &[USUAL]);
    [
        (shifted, several),
        (tilted, several),
        (oval, once),
        (uneven, once),
    ]
}

fn job(kind: &Kind, amplitude: f64) -> Job {
    Job::of("perturbed")
        .named(format!("perturbed-{}-{amplitude}", kind.name))
        .with(
            "imperfections[1].direction",
            format!("\"{}\"", kind.direction),
        )
        .with("imperfections[1].shape", kind.shape)
        .with("imperfections[1].amplitude", format!("{amplitude:?}"))
}

fn on_paper_mesh() -> Job {
    let job = job(&KINDS[0], 1e-4).named("perturbed-paper-mesh");
    job.on([305, 60, 8]).large()
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    let mut jobs = vec![];
    for (kind, amplitudes) in perturbations(fineness) {
        jobs.extend(amplitudes.iter().map(|&a| job(kind, a)));
    }
    if fineness == Fineness::Full {
        jobs.push(on_paper_mesh());
    }
    jobs
}

fn tell(runs: &Runs, fineness: Fineness, page: &mut Page) -> Result<(), Trouble> {
    let mut panels = vec![];
    let mut rows = vec![];
    for (kind, amplitudes) in perturbations(fineness) {
        if amplitudes.is_empty() {
            continue;
        }
        let mut found = vec![];
        let mut all = true;
        for &amplitude in amplitudes {
            let ran = runs.get(&job(kind, amplitude).name)?;
            let last = ran.last()?;
            let folds = last.shape == "invaginated" && ran.verdict == "complete";
            all &= folds;
            found.push(format!("{amplitude} D: {}", side(last)));
            rows.push(vec![
                kind.words.into(),
                format!("{amplitude}"),
                side(last),
                format!(
                    "harmonic {}, {:.3} D",
                    last.departure_harmonic, last.departure
                ),
                energy(last),
                format!("{:.0}", ran.seconds()),
            ]);
            if amplitude == USUAL {
                panels.push(panel(ran, last, format!("{}: {}", kind.words, last.shape))?);
            }
        }
        page.claim(
            "B",
            &format!("it still invaginates: {}", kind.words),
            found.join("; "),
            all,
        );
    }
    if fineness == Fineness::Full {
        let ran = runs.get(&on_paper_mesh().name)?;
        let last = ran.last()?;
        page.claim(
            "B",
            "it still invaginates: on the paper's mesh, 439,200 unknowns",
            format!(
                "{}, W = {}, {:.3} D from axisymmetric (harmonic {})",
                side(last),
                energy(last),
                last.departure,
                last.departure_harmonic
            ),
            last.shape == "invaginated" && ran.verdict == "complete",
        );
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
        "The axisymmetric path of the main case is unstable sideways between Lmax/L = 1.179 and 1.198 (`plica stability` of it on the paper's mesh; docs/stability.md): any perturbation that has a part in \
         harmonic 1 lets the tube tilt before it folds.",
    );
    Ok(())
}
