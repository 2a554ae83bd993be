//! A tube of many rings against the axisymmetric one.

use plica::assembly::SplineTube;
use plica::solve::{Path, Step};
use plica::study::{Plan, TubeProblem};

/// The main case on a small mesh, contracted in three steps to Dmin/D = 0.6.
fn contracted(plan: &Plan, problem: &TubeProblem) -> (Vec<(f64, Step)>, Vec<f64>) {
    let rest = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, plan.tube.rest(), rest, plan.solver.clone()).unwrap();
    let load = plan.tube.rest().towards(&plan.stages[0].load, 0.4 / 0.75);
    path.set_out(load);
    let states = (1..=3)
        .map(|n| {
            let step = path.advance(f64::from(n) / 3.0, &mut ()).unwrap();
            (path.state().energy, step)
        })
        .collect();
    (states, path.state().u.clone())
}

fn small() -> Plan {
    let text = include_str!("../../../cases/invagination.toml");
    let mut plan = plica::case::read(text, "invagination").unwrap();
    (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (40, 12, 4);
    plan
}

fn problem(plan: &Plan, rings: usize) -> TubeProblem {
    TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings))
}

#[test]
fn a_perfect_tube_in_three_dimensions_is_the_axisymmetric_one() {
    let plan = small();
    let (axisymmetric, ring) = contracted(&plan, &problem(&plan, 1));
    for rings in [12, 4] {
        let (states, u) = contracted(&plan, &problem(&plan, rings));
        for ((energy, step), (exact, _)) in states.iter().zip(&axisymmetric) {
            let error = energy / (exact * rings as f64) - 1.0;
            assert!(error.abs() < 1e-8, "{rings} rings: {error:e}");
            // The harmonic solver is the inverse of the tangent; what is kept in single precision
            // may ask for a second iteration.
            assert!(step.inner_iterations <= 2 * step.iterations, "{step:?}");
        }
        for (rings, exact) in u.chunks_exact(rings).zip(&ring) {
            for u in rings {
                assert!((u - exact).abs() < 1e-7, "{u} {exact}");
                assert!((u - rings[0]).abs() < 1e-12, "{rings:?}");
            }
        }
    }
}

#[test]
fn the_path_in_three_dimensions_does_not_depend_on_the_number_of_threads() {
    let plan = small();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| contracted(&plan, &problem(&plan, 12)))
    };
    let one = with(1);
    for threads in [2, 3] {
        assert!(with(threads) == one, "{threads} threads");
    }
}
