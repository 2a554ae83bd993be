//! The main case: energy and walls along the relaxation.

use super::super::job::Job;
use super::super::page::{Page, energy};
use super::super::pictures::{Outline, energies, outer, outlines};
use super::super::runs::{Ran, Runs};
use super::super::{Figure, Fineness, Trouble};
use super::{COARSE, axisymmetric, first, is_folded, minimum, ratio, side};
use crate::draw::{Curve, Rule, Stroke};
use crate::measure::{Face, Rotation, Side, Wall};
use crate::study::Row;

pub(super) const FIGURE: Figure = Figure {
    name: "fig4",
    title: "Fig. 4: strain energy and walls of the main case",
    paper: "With Dmin/D = 0.25 held, Lmax/L rises from 1.0 to 1.25. A: the total strain energy, with the tube's shapes. \
            B: the outer wall at Lmax/L = 1.0, 1.18 and 1.2, which rotates about a centre.",
    jobs,
    tell,
};

fn jobs(fineness: Fineness) -> Vec<Job> {
    vec![
        axisymmetric("invagination", fineness),
        Job::of("invagination")
            .named("invagination-coarse")
            .on(COARSE),
        Job::of("paper-scheme").on(COARSE),
    ]
}

fn tell(runs: &Runs, _: Fineness, page: &mut Page) -> Result<(), Trouble> {
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
    let squares = first(rows, "square");
    let overhang = first(rows, "invaginated");
    let mut rules = vec![];
    for (row, label) in [(squares, "square"), (overhang, "overhang")] {
        rules.extend(row.map(|row| Rule {
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
    let shown: Result<Vec<_>, Trouble> = shown
        .iter()
        .map(|&(at, place)| Ok((main.at(at)?, place)))
        .collect();
    page.picture(
        "energy",
        energies(vec![curve], main, &shown?, rules)?,
        "Total strain energy along the relaxation, with the tube cut open at Lmax/L = 1.00, 1.13, 1.18 and 1.25",
    );
    walls(page, main)?;
    schemes(page, runs)
}

/// V, U, square, invaginated: in this order.
fn shapes(page: &mut Page, rows: &[Row]) {
    let mut shapes: Vec<&str> = rows.iter().map(|row| row.shape.as_str()).collect();
    shapes.dedup();
    let from = |shape| ratio(first(rows, shape));
    page.claim(
        "4A",
        "V, then U, then square, then invaginated",
        format!(
            "{}; U from {}, square from {}, overhang from {}",
            shapes.join(", "),
            from("U"),
            from("square"),
            from("invaginated")
        ),
        shapes == ["V", "U", "square", "invaginated"],
    );
}

/// The energy's slope before and after the fold.
fn slopes(page: &mut Page, rows: &[Row]) -> Result<(), Trouble> {
    let none = || Trouble::State("no state before or after the fold".into());
    let folded = rows
        .iter()
        .position(|row| row.shape == "invaginated")
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

/// Outer walls, how they turn, and which side is compressed.
fn walls(page: &mut Page, main: &Ran) -> Result<(), Trouble> {
    let at = [1.0, 1.18, 1.2];
    let rows: Result<Vec<&Row>, Trouble> = at.iter().map(|&at| main.at(at)).collect();
    let rows = rows?;
    let walls: Result<Vec<Wall>, Trouble> = rows.iter().map(|row| outer(main, row)).collect();
    let walls = walls?;
    let [v, square, folded] = [rows[0], rows[1], rows[2]];
    page.claim(
        "4B",
        "at 1.0 a V, at 1.18 square, at 1.2 invaginated toward the colon",
        format!("{}; {}; {}", v.shape, square.shape, side(folded)),
        v.shape == "V" && square.shape == "square" && is_folded(folded, "colon"),
    );
    let of = |side| Rotation::of(&walls.iter().collect::<Vec<_>>(), side);
    let (colon, ileum) = (of(Side::Colon), of(Side::Ileum));
    let told = |side: &str, rotation: &Option<Rotation>| match rotation {
        Some(r) => format!(
            "{side} flank by {:.0}° about ({:.2}, {:.2}) D, to {:.3} D",
            r.turned_deg, r.centre.0, r.centre.1, r.off
        ),
        None => format!("the {side} flank does not"),
    };
    page.claim(
        "4B",
        "the wall rotates about a centre",
        format!("{}; {}", told("colon", &colon), told("ileum", &ileum)),
        [&colon, &ileum].iter().all(|r| {
            r.is_some_and(|r| r.turned_deg > 10.0 && r.off < 0.5 * main.plan.tube.thickness)
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
    let centres: Vec<Rotation> = [colon, ileum].into_iter().flatten().collect();
    page.picture(
        "walls",
        outlines(drawn, &centres)?,
        "Outer walls at Lmax/L = 1.00, 1.18 and 1.20 and the centres about which their flanks rotate",
    );
    Ok(())
}

/// How much shorter each side of the zone has become: the middle of the wall, along itself.
fn compression(page: &mut Page, main: &Ran, row: &Row) -> Result<(), Trouble> {
    let [outer, inner] = [Face::Outer, Face::Inner].map(|face| main.wall(row, face, 0.0));
    let (outer, inner) = (outer?, inner?);
    let faces = outer.points.iter().zip(&inner.points);
    let middle: Vec<(f64, f64)> = faces
        .map(|(a, b)| (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)))
        .collect();
    let strain = |from: f64, to: f64| {
        let (mut now, mut rest) = (0.0, 0.0);
        for (z, m) in outer.reference_z.windows(2).zip(middle.windows(2)) {
            if z[0] >= from && z[1] <= to {
                rest += z[1] - z[0];
                now += (m[1].0 - m[0].0).hypot(m[1].1 - m[0].1);
            }
        }
        now / rest - 1.0
    };
    let [from, to] = main.plan.tube.muscles[0].zone;
    let (colon, ileum) = (strain(0.0, from), strain(to, main.plan.tube.length));
    page.claim(
        "4B",
        "the colon side, which is shorter, is the more compressed one",
        format!(
            "at 1.18 the middle of the wall is {:.2} % shorter than at rest on the colon side, {:.2} % on the ileum side (the axial force is the same)",
            -100.0 * colon,
            -100.0 * ileum
        ),
        colon < ileum && ileum < 0.0,
    );
    Ok(())
}

/// The paper's scheme and relaxation: the same states, at what cost?
fn schemes(page: &mut Page, runs: &Runs) -> Result<(), Trouble> {
    let (ours, papers) = (runs.get("invagination-coarse")?, runs.get("paper-scheme")?);
    let mut rows = vec![];
    let (mut largest, mut alike) = (0.0_f64, 0);
    for at in [1.0, 1.05, 1.1, 1.13, 1.17, 1.2, 1.25] {
        let (a, b) = (ours.at(at)?, papers.at(at)?);
        let off = (a.energy / b.energy - 1.0).abs();
        if a.shape == b.shape && a.side == b.side {
            largest = largest.max(off);
            alike += 1;
        }
        rows.push(vec![
            format!("{at:.2}"),
            format!("{:.6e}", a.energy),
            format!("{:.6e}", b.energy),
            format!("{off:.0e}"),
            side(a),
            side(b),
        ]);
    }
    let ratio = papers.seconds() / ours.seconds().max(1e-9);
    page.claim(
        "2",
        "the scheme: Newmark, ηD/(EΔτ) = 100",
        format!(
            "takes {} solves, {:.0} s; Plica's own {} solves, {:.1} s ({ratio:.0} times less); energies differ by {largest:.0e} at most in the {alike} of {} states below that are on the same branch",
            papers.solves(), papers.seconds(), ours.solves(), ours.seconds(), rows.len()
        ),
        // Before the fold there is but one branch.
        largest < 1e-5 && alike >= 5 && papers.verdict == "complete",
    );
    page.text("**The two schemes**, on one mesh. Each state of the pseudo-time is then settled without drag (`solver.pseudo_time.settle`).");
    page.table(
        &[
            "Lmax/L",
            "W, static",
            "W, Newmark",
            "differ by",
            "static",
            "Newmark",
        ],
        rows,
    );
    Ok(())
}
