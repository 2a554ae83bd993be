//! What a Newton step of the whole tube costs, and how that grows with the mesh.
//!
//! `cargo bench -p plica --bench three_dimensions` prints the table of docs/performance.md: the
//! contracted tube of the main case (Dmin/D = 0.25) on every thread that there is, wall seconds,
//! medians of five.

use plica::assembly::SplineTube;
use plica::solve::{Equilibrium, Path, Solver, Tangent};
use plica::study::{Plan, TubeProblem};
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
        path.set_out(plan.stages[0].load.clone());
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
            let solved = solver.solve(&mut b.clone(), 1e-3, &mut ());
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
}
