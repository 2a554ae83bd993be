//! The main case: energy and walls along the relaxation.

use super::super::job::Job;
use super::super::page::{Page, Verdict, energy};
use super::super::pictures::{Outline, energies, outer, outlines};
use super::super::runs::{CompletedRun, Runs};
use super::super::{Figure, Fineness, ReproductionError};
use super::{COARSE, axisymmetric, first, is_folded, minimum, ratio, side, unstable};
use plica::measure::{Face, Flank, Rotation, Shape, Side, Wall};
use plica::run_directory;
use plica::study::Row;
use plica_view::draw::{Curve, Stroke, VerticalLine};

pub(super) const FIGURE: Figure = Figure {
    name: "fig4",
    title: "Fig. 4: strain energy and walls of the main case",
    paper: "With Dmin/D = 0.25 held, Lmax/L rises from 1.0 to 1.25. A: the total strain energy, with the tube's shapes. \
            B: the outer wall at Lmax/L = 1.0, 1.18 and 1.2, which rotates about a centre.",
    jobs,
    describe,
};

/// The paper's scheme with the paper's rule of acceptance, without equilibration.
fn not_equilibrated() -> Job {
    let job = Job::of("paper-scheme").named("paper-scheme-not-equilibrated");
    job.on(COARSE)
        .with("solver.pseudo_time.equilibrate", false)
        .with("solver.pseudo_time.max_steps", 20000)
        .history_only()
}

fn jobs(fineness: Fineness) -> Vec<Job> {
    vec![
        axisymmetric("invagination", fineness),
        Job::of("invagination")
            .named("invagination-coarse")
            .on(COARSE),
        Job::of("paper-scheme").on(COARSE),
        not_equilibrated(),
    ]
}

fn describe(runs: &Runs, _: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
    let main = runs.get("invagination")?;
    let rows = main.stage("relax");
    let least = minimum(rows)?;
    shapes(page, rows);
    let off = (least.length_ratio - 1.13).abs();
    page.claim(
        "4A",
        "the energy falls to a minimum at Lmax/L ~ 1.13",
        format!(
            "from {} to {} E D³ at Lmax/L = {:.2}",
            energy(&rows[0]),
            energy(least),
            least.length_ratio
        ),
        off < 0.0101 && least.energy < 0.5 * rows[0].energy,
    );
    slopes(page, rows)?;
    let squares = first(rows, Shape::Square);
    let overhang = first(rows, Shape::Invaginated);
    let mut vertical_lines = vec![];
    for (row, label) in [(squares, "square"), (overhang, "overhang")] {
        vertical_lines.extend(row.map(|row| VerticalLine {
            at: row.length_ratio,
            label: label.into(),
        }));
    }
    let curve = Curve {
        points: rows
            .iter()
            .map(|row| (row.length_ratio, row.energy))
            .collect(),
        colour: 1,
        dots: true,
        ..Curve::default()
    };
    let shown = [
        (1.0, (0.24, 0.84)),
        (1.13, (0.46, 0.55)),
        (1.18, (0.66, 0.8)),
        (1.25, (0.84, 0.18)),
    ];
    let shown: Result<Vec<_>, ReproductionError> = shown
        .iter()
        .map(|&(at, place)| Ok((main.at(at)?, place)))
        .collect();
    page.picture(
        "energy",
        energies(vec![curve], main, &shown?, vertical_lines)?,
        "Total strain energy along the relaxation, with the tube cut open at Lmax/L = 1.00, 1.13, 1.18 and 1.25",
    );
    walls(page, main)?;
    schemes(page, runs)
}

/// Checks the order of the shapes: V, U, square, invaginated.
fn shapes(page: &mut Page, rows: &[Row]) {
    let mut shapes: Vec<Shape> = rows.iter().map(|row| row.shape).collect();
    shapes.dedup();
    let from = |shape| ratio(first(rows, shape));
    page.claim(
        "4A",
        "V, then U, then square, then invaginated",
        format!(
            "{}; U from {}, square from {}, overhang from {}",
            shapes
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join(", "),
            from(Shape::U),
            from(Shape::Square),
            from(Shape::Invaginated)
        ),
        shapes == [Shape::V, Shape::U, Shape::Square, Shape::Invaginated],
    );
}

/// Checks the slopes of the energy before and after the fold.
fn slopes(page: &mut Page, rows: &[Row]) -> Result<(), ReproductionError> {
    let none = || ReproductionError::State("no state before or after the fold".into());
    let folded = rows
        .iter()
        .position(|row| row.shape == Shape::Invaginated)
        .ok_or_else(none)?;
    let slope = |a: &Row, b: &Row| (b.energy - a.energy) / (b.length_ratio - a.length_ratio);
    let (Some(before), Some(last)) = (folded.checked_sub(3), rows.last()) else {
        return Err(none());
    };
    let before = slope(&rows[before], &rows[folded - 1]);
    let after = slope(&rows[folded], last);
    page.claim(
        "4A",
        "it then rises, and less steeply after invagination",
        format!("slope dW/d(Lmax/L) = {before:.2e} over the last two steps before the overhang, {after:.2e} from there to the end"),
        before > 0.0 && after < before,
    );
    Ok(())
}

/// Describes the outer walls, their rotation, and their compression.
fn walls(page: &mut Page, main: &CompletedRun) -> Result<(), ReproductionError> {
    let at = [1.0, 1.18, 1.2];
    let rows: Result<Vec<&Row>, ReproductionError> = at.iter().map(|&at| main.at(at)).collect();
    let rows = rows?;
    let walls: Result<Vec<Wall>, ReproductionError> =
        rows.iter().map(|row| outer(main, row)).collect();
    let walls = walls?;
    let [v, square, folded] = [rows[0], rows[1], rows[2]];
    page.claim(
        "4B",
        "at 1.0 a V, at 1.18 square, at 1.2 invaginated toward the colon",
        format!("{}; {}; {}", v.shape, square.shape, side(folded)),
        v.shape == Shape::V && square.shape == Shape::Square && is_folded(folded, Side::Colon),
    );
    let turning: Vec<&Row> = main
        .stage("relax")
        .iter()
        .filter(|row| row.length_ratio < 1.2 + 1e-9)
        .collect();
    let all: Result<Vec<Wall>, ReproductionError> =
        turning.iter().map(|row| outer(main, row)).collect();
    let all = all?;
    let [colon, ileum] = [Side::Colon, Side::Ileum].map(|side| Turn::of(&walls, &all, side));
    let describe = |side: &str, turn: &Option<Turn>| match turn {
        Some(turn) => format!("{side} flank {}", turn.describe()),
        None => format!("the {side} flank does not rotate"),
    };
    page.claim(
        "4B",
        "the wall rotates about a centre",
        format!(
            "{}; {} ({} states from 1.00 to 1.20)",
            describe("colon", &colon),
            describe("ileum", &ileum),
            all.len()
        ),
        [&colon, &ileum].iter().all(|turn| {
            turn.as_ref().is_some_and(|turn| {
                turn.largest() > 10.0 && turn.rotation.max_distance < 0.5 * main.plan.tube.thickness
            })
        }),
    );
    compression(page, main, square)?;
    let outline = |((row, wall), colour): ((&&Row, &Wall), usize)| Outline {
        wall: wall.clone(),
        label: format!("*L*_{{max}}/*L* = {:.2}: {}", row.length_ratio, row.shape),
        colour,
        stroke: Stroke::Solid,
    };
    let drawn = rows.iter().zip(&walls).zip(1..).map(outline).collect();
    let centres: Vec<Rotation> = [colon, ileum]
        .into_iter()
        .flatten()
        .map(|turn| turn.rotation)
        .collect();
    page.picture(
        "walls",
        outlines(drawn, &centres)?,
        "Outer walls at Lmax/L = 1.00, 1.18 and 1.20 and the centres about which their flanks rotate",
    );
    Ok(())
}

/// Rotation of a flank.
struct Turn {
    /// Its angles in the states of the figure, in degrees.
    angles: Vec<f64>,
    /// Centre of rotation through all states.
    rotation: Rotation,
}

impl Turn {
    fn of(shown: &[Wall], all: &[Wall], side: Side) -> Option<Self> {
        let angle = |wall: &Wall| Some(Flank::of(wall, side)?.angle_deg);
        Some(Self {
            angles: shown.iter().map(angle).collect::<Option<_>>()?,
            rotation: Rotation::of(&all.iter().collect::<Vec<_>>(), side)?,
        })
    }

    /// Returns the largest rotation between two of the shown states, in degrees.
    fn largest(&self) -> f64 {
        let ends = self
            .angles
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        ends.1 - ends.0
    }

    fn describe(&self) -> String {
        let angles: Vec<String> = self.angles.iter().map(|a| format!("{a:.0}°")).collect();
        let Rotation {
            centre,
            max_distance,
            ..
        } = self.rotation;
        format!(
            "at {} about ({:.2}, {:.2}) D, to {max_distance:.3} D",
            angles.join(", "),
            centre.0,
            centre.1
        )
    }
}

/// Compares the compression of the middle of the wall on both sides of the zone.
fn compression(page: &mut Page, main: &CompletedRun, row: &Row) -> Result<(), ReproductionError> {
    let [outer, inner] = [Face::Outer, Face::Inner].map(|face| main.wall(row, face, 0.0));
    let (outer, inner) = (outer?, inner?);
    let faces = outer.points.iter().zip(&inner.points);
    let middle: Vec<(f64, f64)> = faces
        .map(|(a, b)| (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)))
        .collect();
    let shorter = |from: f64, to: f64| {
        let (mut now, mut rest) = (0.0, 0.0);
        for (z, m) in outer.reference_z.windows(2).zip(middle.windows(2)) {
            if z[0] >= from && z[1] <= to {
                rest += z[1] - z[0];
                now += (m[1].0 - m[0].0).hypot(m[1].1 - m[0].1);
            }
        }
        100.0 * (1.0 - now / rest)
    };
    let [from, to] = main.plan.tube.muscles[0].zone;
    let (colon, ileum) = (shorter(0.0, from), shorter(to, main.plan.tube.length));
    let beside = shorter(to, to + from);
    page.judge(
        "4B",
        "the colon side, which is shorter, is the more compressed one",
        format!(
            "at 1.18 the middle of the wall is {colon:.2} % shorter than at rest on the whole colon side, {ileum:.2} % on the whole ileum \
             side, but {beside:.2} % on the half diameter of it beside the zone, which is as long as the colon side"
        ),
        if colon > ileum && ileum > 0.0 { Verdict::Explained } else { Verdict::Differs },
    );
    page.text(
        "**Which side is more compressed?** The axial force is the same along the whole tube. On average the colon side is compressed more, because the ileum side is longer and most of it is far from the zone, \
         where the wall does not bend. Over equal lengths beside the zone both are compressed alike, so compression does not \
         explain the side. (The tubes of Fig. 5 have folds to both ends, of nearly the same energy.)",
    );
    Ok(())
}

/// Compares the states and the cost of the paper's scheme and of the static one.
fn schemes(page: &mut Page, runs: &Runs) -> Result<(), ReproductionError> {
    let (ours, papers) = (runs.get("invagination-coarse")?, runs.get("paper-scheme")?);
    let raw = runs.get(&not_equilibrated().name)?;
    let mut rows = vec![];
    let (mut equilibrated, mut as_accepted, mut alike) = (0.0_f64, 0.0_f64, true);
    for at in [1.0, 1.05, 1.1, 1.13, 1.17, 1.2, 1.25] {
        let (a, b, c) = (ours.at(at)?, papers.at(at)?, raw.at(at)?);
        alike &= [b, c]
            .iter()
            .all(|row| a.shape == row.shape && a.side == row.side);
        let off = |row: &Row| (row.energy / a.energy - 1.0).abs();
        (equilibrated, as_accepted) = (equilibrated.max(off(b)), as_accepted.max(off(c)));
        rows.push(vec![
            format!("{at:.2}"),
            format!("{:.6e}", a.energy),
            format!("{:.0e}", off(b)),
            format!("{:.0e}", off(c)),
            format!("{:.0e}", c.residual),
            side(a),
            side(b),
            side(c),
        ]);
    }
    let ratio = papers.seconds() / ours.seconds().max(1e-9);
    let good = alike
        && equilibrated < 1e-5
        && as_accepted < 1e-2
        && [papers, raw]
            .iter()
            .all(|ran| ran.verdict == run_directory::Verdict::Complete);
    page.add(
        "Fig. 2",
        "the paper's scheme (Newmark, ηD/(EΔτ) = 100) against Plica's",
        format!(
            "{} solves and {:.0} s against {} and {:.1} s ({ratio:.0} times less); the energies of seven states from 1.00 to 1.25 differ by at most {equilibrated:.0e} after equilibration without damping, and by {as_accepted:.0e} with the paper's rule \
             of acceptance",
            papers.solves(), papers.seconds(), ours.solves(), ours.seconds()
        ),
        good,
    );
    page.text(
        "**The two schemes**, on one mesh. A state is accepted when no control point moves by 1e-5 D in a pseudo-time step. It is then equilibrated without \
         damping (`solver.pseudo_time.equilibrate`), or not; the relative residual of the latter omits the damping forces.",
    );
    page.table(
        &[
            "Lmax/L",
            "W, static",
            "Newmark, equilibrated: difference",
            "not equilibrated: difference",
            "its residual",
            "static",
            "Newmark, equilibrated",
            "not equilibrated",
        ],
        rows,
    );
    page.text(format!(
        "**Stability.** These axisymmetric states are also equilibria of the whole tube, which leaves their path where it is unstable: at \
         Lmax/L = {} \
         (Appendix B).",
        unstable(runs.get("invagination")?.stage("relax"))
    ));
    Ok(())
}
