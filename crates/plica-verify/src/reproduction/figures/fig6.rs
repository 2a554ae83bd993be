//! The contracting regions of both cases of Fig. 5, superposed.

use super::super::job::Job;
use super::super::page::Page;
use super::super::pictures::{Outline, outer, outlines};
use super::super::runs::Runs;
use super::super::{Figure, Fineness, ReproductionError};
use super::axisymmetric;
use plica::measure::Wall;
use plica_view::draw::Stroke;

pub(super) const FIGURE: Figure = Figure {
    name: "fig6",
    title: "Fig. 6: the contracting region is the same on both sides",
    paper: "The outer walls of the contracting region at Lmax/L = 1.17 (A), 1.05 and 1.1 (B), of the tubes of Figs. 5A and \
            5B laid over each other: nearly the same before invagination.",
    jobs,
    describe,
};

/// The contracting region, in D.
const ZONE: [f64; 2] = [0.5, 1.75];
/// Largest distance of walls that count as nearly the same, in D: a third of the thickness of the wall, about a thick
/// line in a printed figure.
const NEARLY: f64 = 0.02;
/// Largest shift along the axis in D: the two relaxations push the region to opposite ends.
const REACH: f64 = 1.0;

fn jobs(fineness: Fineness) -> Vec<Job> {
    ["colon-side", "ileum-side"]
        .map(|case| axisymmetric(case, fineness))
        .to_vec()
}

fn describe(runs: &Runs, _: Fineness, page: &mut Page) -> Result<(), ReproductionError> {
    let (a, b) = (runs.get("colon-side")?, runs.get("ileum-side")?);
    let [from, to] = ZONE;
    let (mut drawn, mut over) = (vec![], vec![]);
    let mut rows = vec![];
    for (colour, (panel, at)) in [("6B", 1.05), ("6B", 1.1), ("6A", 1.17)]
        .into_iter()
        .enumerate()
    {
        let walls: Result<Vec<Wall>, ReproductionError> = [a, b]
            .map(|ran| Ok(outer(ran, ran.at(at)?)?.between(from, to)))
            .into_iter()
            .collect();
        let walls = walls?;
        let straight = walls[0].align(&walls[1], REACH);
        // One wall is the mirror image of the other.
        let mirrored = walls[0].align(&walls[1].mirrored(), 4.0);
        page.claim(
            panel,
            &format!("nearly the same walls at Lmax/L = {at}"),
            format!(
                "{:.1e} D apart at most, {:.1e} D if one is mirrored",
                straight.distance, mirrored.distance
            ),
            straight.distance < NEARLY,
        );
        rows.push(vec![
            format!("{at:.2}"),
            format!("{:.4}", straight.shift),
            format!("{:.1e}", straight.distance),
            format!("{:.1e}", mirrored.distance),
        ]);
        let [full, mut dashed] = [walls[0].clone(), walls[1].clone()];
        dashed.points.iter_mut().for_each(|p| p.0 += straight.shift);
        drawn.push(Outline {
            wall: full,
            label: format!("5A, *L*_{{max}}/*L* = {at:.2}"),
            colour: colour + 1,
            stroke: Stroke::Solid,
        });
        over.push(Outline {
            wall: dashed,
            label: if colour == 0 {
                "5B".into()
            } else {
                String::new()
            },
            colour: 0,
            stroke: Stroke::Dashed,
        });
    }
    drawn.extend(over);
    page.text("Each wall of 5B is shifted along the axis to where it lies closest over that of 5A; the distance is the largest from a point of either to the other (Hausdorff's).");
    page.table(
        &[
            "Lmax/L",
            "shift of 5B, D",
            "apart, D",
            "apart if mirrored, D",
        ],
        rows,
    );
    page.picture(
        "walls",
        outlines(drawn, &[])?,
        "Outer walls of the contracting region at Lmax/L = 1.05, 1.10 and 1.17: relaxation on the colon side (5A) and on the ileum side (5B)",
    );
    Ok(())
}
