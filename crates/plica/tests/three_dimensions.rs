//! Three-dimensional solutions of perfect tubes match the axisymmetric ones.

use crate::common::{main_case, problem};
use plica::equilibrium::{Stability, TubeProblem, UnstableMode};
use plica::solve::{Path, Step};
use plica::study::{Plan, Study};

/// Contracts a tube in three steps to Dmin/D = 0.6. Returns energies and steps, and the last displacement.
fn contracted(plan: &Plan, problem: &TubeProblem) -> (Vec<(f64, Step)>, Vec<f64>) {
    let rest = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, plan.tube.rest(), rest, plan.solver.clone()).unwrap();
    let load = plan.tube.rest().towards(&plan.stages[0].load, 0.4 / 0.75);
    path.begin_segment(load);
    let states = (1..=3)
        .map(|n| {
            let step = path.advance(f64::from(n) / 3.0, &mut ()).unwrap();
            (path.state().energy, step)
        })
        .collect();
    (states, path.state().u.clone())
}

#[test]
fn a_perfect_tube_in_three_dimensions_matches_the_axisymmetric_one() {
    let plan = main_case([40, 12, 4]);
    let (axisymmetric, ring) = contracted(&plan, &problem(&plan, 1));
    for rings in [12, 4] {
        let (states, u) = contracted(&plan, &problem(&plan, rings));
        for ((energy, step), (exact, _)) in states.iter().zip(&axisymmetric) {
            let error = energy / (exact * rings as f64) - 1.0;
            assert!(error.abs() < 1e-8, "{rings} rings: {error:e}");
            // The harmonic solver is the inverse of the tangent; its single precision may require a second iteration.
            assert!(
                step.effort.inner_iterations <= 2 * step.effort.linear_solves,
                "{step:?}"
            );
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
    let plan = main_case([40, 12, 4]);
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

#[test]
fn an_axisymmetric_state_has_the_same_unstable_modes_in_every_symmetry() {
    let unstable = |symmetry: &str| {
        let case = format!(
            "symmetry = {symmetry}\n\
             output.pictures = false\n\
             mesh.control_points = {{ axial = 40, around = 12, thickness = 4 }}\n\
             [muscles.longitudinal]\n\
             direction = \"longitudinal\"\n\
             zone = [0.5, 1.0]\n\
             [[stages]]\n\
             steps = 8\n\
             drive.longitudinal.length_ratio = 1.08\n"
        );
        let plan = plica::case::read(&case, "rounds").unwrap();
        let states = Study::new(&plan).unwrap().map(|state| {
            let state = state.unwrap();
            (state.measures.asymmetry.harmonic, state.stability)
        });
        states.collect::<Vec<_>>()
    };
    let one = unstable("\"axisymmetric\"");
    // One ring assembles the blocks of the modes; many rings use those of the harmonic solver.
    assert_eq!(one[6].1, Stability::Stable);
    let first = one[8].1.unstable_modes().next();
    assert_eq!(first, Some(UnstableMode::Circumferential(2)), "{one:?}");
    for symmetry in ["\"none\"", "{ fold = 2 }"] {
        assert_eq!(unstable(symmetry), one, "{symmetry}");
    }
}
