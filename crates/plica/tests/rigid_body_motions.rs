//! Three-dimensional tubes whose ends permit rigid-body motions.

use crate::common::{main_case, problem};
use plica::solve::{Effort, Integrator, Path, PseudoTime, Scheme, State};
use plica::study::Plan;
use plica::tube::{Axial, Imperfection, Load, Part, Shape, Support, Wave};

/// Ends that permit rigid-body motions, and last a tube with a fixed end for comparison.
const ENDS: [[Support; 2]; 4] = [
    [Support::Sliding, Support::Sliding],
    [Support::Free, Support::Sliding],
    [Support::Free, Support::Free],
    [Support::Fixed, Support::Free],
];

/// Returns the main case on a coarse mesh with the given ends and scheme.
fn plan(ends: [Support; 2], scheme: Scheme) -> Plan {
    let mut plan = main_case([24, 12, 4]);
    plan.tube.ends = ends;
    plan.solver.scheme = scheme;
    plan
}

/// Returns the load of Dmin/D = 0.85.
fn contracted(plan: &Plan) -> Load {
    plan.tube.rest().towards(&plan.stages[0].load, 0.2)
}

/// Returns the energies of two states and the effort of finding them.
fn states(plan: &Plan, rings: usize) -> Vec<(f64, Effort)> {
    let problem = problem(plan, rings);
    let rest = problem.tube.initial_guess();
    let mut path = Path::begin(&problem, plan.tube.rest(), rest, plan.solver.clone()).unwrap();
    path.begin_segment(contracted(plan));
    [0.5, 1.0]
        .map(|t| {
            let step = path.advance(t, &mut ()).unwrap();
            let state = path.state();
            assert!(
                state.relative_residual <= plan.solver.tolerance,
                "{}",
                state.relative_residual
            );
            let energy = state.energy / rings as f64;
            (energy, step.effort)
        })
        .to_vec()
}

#[test]
fn three_dimensional_solutions_with_rigid_body_motions_match_the_axisymmetric_ones() {
    let damped = |integrator| {
        Scheme::PseudoTime(PseudoTime {
            integrator,
            damping: 1.0,
            ramp: 2,
            tolerance: 1e-3,
            ..PseudoTime::default()
        })
    };
    let schemes = [
        (Scheme::Static, vec![12, 6]),
        (damped(Integrator::Newmark), vec![12]),
        (damped(Integrator::BackwardEuler), vec![4]),
    ];
    for (scheme, sectors) in schemes {
        for rings in sectors {
            for ends in ENDS {
                let plan = plan(ends, scheme.clone());
                let exact = states(&plan, 1);
                let found = states(&plan, rings);
                for ((energy, effort), (exact, _)) in found.iter().zip(&exact) {
                    let error = energy / exact - 1.0;
                    assert!(error.abs() < 1e-10, "{ends:?}, {rings} rings: {error:e}");
                    // The preconditioner is the exact inverse, as it is with fixed ends.
                    assert!(
                        effort.inner_iterations <= effort.linear_solves + 2,
                        "{ends:?}, {rings} rings: {found:?}"
                    );
                }
            }
        }
    }
}

/// Returns the state of a tube with an uneven muscle that starts from a displacement along z and sideways.
fn uneven_contraction(
    ends: [Support; 2],
    harmonic: usize,
    rings: usize,
    shift: f64,
) -> State<Load> {
    let mut plan = plan(ends, Scheme::Static);
    plan.tube.imperfections.push(Imperfection {
        of: Part::Muscle(0),
        amplitude: 0.1,
        shape: Shape::Wave(Wave {
            harmonic,
            phase: 0.3,
            axial: Axial::Uniform,
            share: 1.0,
        }),
    });
    let problem = problem(&plan, rings);
    let (tube, rest) = (&problem.tube, plan.tube.rest());
    let mut start = tube.control_values_from(|_, _, ring| {
        let (sin, cos) = tube.sector.ring_angle(ring).sin_cos();
        [shift, shift * cos, -shift * sin]
    });
    tube.apply_prescribed(&rest, &mut start);
    let mut path = Path::begin(&problem, rest, start, plan.solver.clone()).unwrap();
    path.begin_segment(contracted(&plan));
    path.advance(1.0, &mut ()).unwrap();
    let state = path.state().clone();
    assert!(state.relative_residual <= plan.solver.tolerance);

    // The residual includes the reactions of the rigid-body constraints.
    let forces = tube.forces(&state.load, &state.u).unwrap();
    let free = forces.residual.iter().zip(tube.prescribed());
    let squares = free
        .filter(|(_, prescribed)| !**prescribed)
        .map(|(r, _)| r * r);
    let residual = squares.sum::<f64>().sqrt() / forces.residual_scale;
    assert!(
        residual <= 1.1 * plan.solver.tolerance,
        "{ends:?}: {residual:e}"
    );
    state
}

#[test]
fn rigid_body_constraints_of_an_uneven_tube_carry_no_force() {
    use Support::{Free, Sliding};
    let same = |one: &State<Load>, energy: f64| {
        let rows = one
            .u
            .chunks_exact(12)
            .flat_map(|u| u.iter().map(|x| (x - u[0]).abs()));
        assert!(rows.fold(0.0, f64::max) > 5e-3);
        let error = energy / one.energy - 1.0;
        assert!(error.abs() < 1e-10, "{error:e}");
    };
    // With circumferential modes 0 and 2 alone, shifts and tilts need no constraint.
    let oval = uneven_contraction([Sliding, Sliding], 2, 12, 0.0);
    same(
        &oval,
        2.0 * uneven_contraction([Sliding, Sliding], 2, 6, 0.0).energy,
    );
    let bent = uneven_contraction([Free, Free], 1, 12, 0.0);
    same(&bent, uneven_contraction([Free, Free], 1, 12, 4e-3).energy);
}
