//! Cost of a Newton step of the whole tube, and its growth with the mesh.
//!
//! `cargo bench -p plica --bench three_dimensions` prints the table of docs/performance.md: the
//! contracted tube of the main case (Dmin/D = 0.25) on every thread that there is, wall seconds,
//! medians of five; and then what a linear solve takes at states that are far from round, a tilted and
//! an oval one, which takes some minutes to find.

use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::solve::{Equilibrium, Path, Solver, Tangent};
use plica::study::Plan;
use std::time::Instant;

/// Control points along, around and through the wall: 50 thousand to 1.6 million unknowns.
const MESHES: [[usize; 3]; 4] = [[105, 32, 5], [205, 48, 6], [305, 60, 8], [467, 114, 10]];

fn main_case() -> Plan {
    let text = include_str!("../../../cases/invagination.toml");
    plica::case::read(text, "invagination").expect("the main case is sound")
}

fn median(mut work: impl FnMut()) -> f64 {
    let mut seconds: Vec<f64> = (0..5)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .collect();
    seconds.sort_by(f64::total_cmp);
    seconds[2]
}

/// Cases that leave their symmetric path: the state looked at is that at the end of so many steps of
/// their last stage.
const FAR_FROM_ROUND: [(&str, &str, [usize; 3], usize); 2] = [
    (
        "tilted",
        include_str!("../../../cases/tilt.toml"),
        [105, 32, 5],
        19,
    ),
    (
        "oval",
        include_str!("../../../cases/collapse.toml"),
        [60, 32, 4],
        7,
    ),
];

/// Cost of following a change of the load to a residual of 1e-3.
fn far_from_round() {
    println!(
        "\n{:>8} {:>13} {:>9} {:>8} {:>7} {:>9} {:>9} {:>9} {:>5}",
        "state", "mesh", "unknowns", "Lmax/L", "damping", "tangent", "factor", "solve", "its"
    );
    for (name, text, mesh, steps) in FAR_FROM_ROUND {
        let mut plan = plica::case::read(text, name).expect("the case is sound");
        [plan.mesh.axial, plan.mesh.around, plan.mesh.thickness] = mesh;
        let whole = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, mesh[1]));
        let start = whole.tube.initial_guess();
        let mut path = Path::begin(&whole, plan.tube.rest(), start, plan.solver.clone())
            .expect("a tube at rest is not inverted");
        for (number, stage) in (1..).zip(&plan.stages) {
            path.begin_segment(stage.load.clone());
            let last = if number == plan.stages.len() {
                steps
            } else {
                stage.steps
            };
            for n in 1..=last {
                path.advance(n as f64 / stage.steps as f64, &mut ())
                    .expect("the path can be followed");
            }
        }
        let (load, u) = (path.state().load.clone(), path.state().u.clone());
        let further = whole.between(&load, &plan.tube.rest(), 1e-3);
        let residual = whole.forces(&further, &u).expect("not inverted").residual;
        let free = |(r, given): (&f64, &bool)| if *given { 0.0 } else { -r };
        let b: Vec<f64> = residual.iter().zip(whole.prescribed()).map(free).collect();
        for damping in [0.0, 10.0] {
            let tangent = median(|| drop(whole.tangent(&load, &u)));
            let at = whole.tangent(&load, &u);
            let factor = median(|| drop(at.shifted(damping)));
            let solver = at.shifted(damping).expect("not singular");
            let mut iterations = String::new();
            let solve = median(|| {
                iterations = match solver.solve(&mut b.clone(), 1e-3, &()) {
                    Ok(solved) if solved.converged => solved.iterations.to_string(),
                    Ok(solved) => format!(">{}", solved.iterations),
                    Err(down) => format!("indefinite after {}", down.iterations),
                };
            });
            println!(
                "{name:>8} {:>13} {:>9} {:>8.4} {damping:>7} {tangent:>9.4} {factor:>9.4} {solve:>9.4} {iterations:>5}",
                format!("{} x {} x {}", mesh[0], mesh[1], mesh[2]),
                u.len(),
                plan.tube.length_ratio(&load),
            );
        }
    }
}

fn main() {
    println!("threads: {}", rayon::current_num_threads());
    println!(
        "{:>13} {:>9} {:>9} {:>9} {:>9} {:>9} {:>5} {:>9} {:>9}",
        "mesh", "unknowns", "residual", "tangent", "factor", "solve", "its", "product", "step/Munk"
    );
    for [axial, around, thickness] in MESHES {
        let mut plan = main_case();
        (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (axial, around, thickness);
        let ring = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, 1));
        let rest = vec![0.0; ring.tube.unknowns()];
        let mut path = Path::begin(&ring, plan.tube.rest(), rest, plan.solver.clone())
            .expect("a tube at rest is not inverted");
        path.begin_segment(plan.stages[0].load.clone());
        for n in 1..=plan.stages[0].steps {
            path.advance(n as f64 / plan.stages[0].steps as f64, &mut ())
                .expect("the path can be followed");
        }
        let load = path.state().load.clone();
        let whole = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, around));
        let same = |x: &f64| std::iter::repeat_n(*x, around);
        let u: Vec<f64> = path.state().u.iter().flat_map(same).collect();

        let residual = median(|| drop(whole.forces(&load, &u)));
        let tangent = median(|| drop(whole.tangent(&load, &u)));
        let at = whole.tangent(&load, &u);
        let factor = median(|| drop(at.shifted(0.0)));
        let solver = at.shifted(0.0).expect("a stable state is not singular");
        let mut b = vec![0.0; u.len()];
        let product = median(|| at.multiply_add(1.0, &u, &mut b));
        let mut iterations = 0;
        let solve = median(|| {
            let solved = solver.solve(&mut b.clone(), 1e-3, &());
            iterations = solved.map_or(0, |solved| solved.iterations);
        });
        let step = residual + tangent + factor + solve;
        println!(
            "{:>13} {:>9} {residual:>9.4} {tangent:>9.4} {factor:>9.4} {solve:>9.4} {iterations:>5} \
             {product:>9.4} {:>9.3}",
            format!("{axial} x {around} x {thickness}"),
            u.len(),
            step / (u.len() as f64 * 1e-6)
        );
    }
    far_from_round();
}
