//! Rings under dead loads and follower pressure, against the closed form of a thin ring. `plica verify` checks plates, growth and
//! other pressures.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean};
use plica::solve::{Path, Settings, State};
use plica::stability::Harmonics;
use plica::tube::{Load, Mesh, Pressure, Support, Tube, WallLayer};

fn tube(length: f64, poisson_ratio: f64) -> Tube {
    Tube {
        length,
        thickness: 0.06,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0,
            poisson_ratio,
        )))],
        muscles: vec![],
        ends: [Support::Sliding; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    }
}

/// Returns the problem of a tube with the given numbers of elements and of independent rings.
fn problem(tube: &Tube, [along, around, through]: [usize; 3], rings: usize) -> TubeProblem {
    let mesh = Mesh {
        axial: along + 3,
        around,
        thickness: through + 3,
        degree: 3,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    };
    TubeProblem::new(SplineTube::new(tube, &mesh, rings))
}

/// Returns a follower pressure.
fn follower(follower: f64) -> Pressure {
    Pressure {
        follower,
        dead: 0.0,
    }
}

/// Returns the load of a follower pressure on the outer wall.
fn outside(tube: &Tube, pressure: f64) -> Load {
    Load {
        pressures: [Pressure::default(), follower(pressure)],
        ..tube.rest()
    }
}

fn tight() -> Settings {
    Settings {
        tolerance: 1e-10,
        ..Settings::default()
    }
}

/// Returns the state under a load, reached from rest in equal steps.
fn under(problem: &TubeProblem, load: &Load, steps: usize) -> State<Load> {
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, problem.tube.tube.rest(), u, tight()).unwrap();
    path.begin_segment(load.clone());
    for n in 1..=steps {
        path.advance(n as f64 / steps as f64, &mut ()).unwrap();
    }
    path.state().clone()
}

fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    let error = found / expected - 1.0;
    println!("{what}: {found:.9e}, expected {expected:.9e}, error {error:.1e}");
    assert!(
        error.abs() < tolerance,
        "{what}: {found}, expected {expected}"
    );
}

/// Returns the fraction of a load at which the lowest eigenvalue of a circumferential mode is zero, by the secant method.
fn critical_fraction(
    problem: &TubeProblem,
    load: &Load,
    harmonic: usize,
    [mut from, mut to]: [f64; 2],
) -> f64 {
    let harmonics = Harmonics::new(problem, harmonic);
    let lowest = |t: f64| {
        let state = under(problem, &problem.tube.tube.rest().towards(load, t), 1);
        let tested = harmonics.test(&state.load, &state.u).unwrap()[harmonic];
        assert_eq!(tested.negative > 0, tested.lowest < 0.0);
        tested.lowest
    };
    let mut values = [lowest(from), lowest(to)];
    for _ in 0..3 {
        let next = from - values[0] * (to - from) / (values[1] - values[0]);
        (from, to, values) = (to, next, [values[1], lowest(next)]);
    }
    to
}

#[test]
fn a_ring_under_dead_load_buckles_at_four_thirds_of_the_follower_pressure() {
    // The critical load of a thin ring is 4 E I/r³ if it keeps its direction, and 3 E I/r³ if it follows the wall. A dead
    // load on the outer wall, at R, does the work ½ p R² θ² as a section turns by θ, instead of ½ p r² θ².
    let tube = Tube {
        thickness: 0.01,
        ..tube(0.1, 0.3)
    };
    let problem = problem(&tube, [1, 60, 2], 1);
    let middle = 0.5 - 0.5 * tube.thickness;
    let bending = (tube.thickness / middle).powi(3) / 12.0 / (1.0 - 0.3 * 0.3);
    let dead = Load {
        pressures: [
            Pressure::default(),
            Pressure {
                follower: 0.0,
                dead: bending,
            },
        ],
        ..tube.rest()
    };
    let critical = critical_fraction(&problem, &dead, 2, [3.9, 4.1]);
    assert_near("dead load", critical, 4.0 * (middle / 0.5).powi(2), 1e-3);
    let critical = critical_fraction(&problem, &outside(&tube, bending), 2, [2.9, 3.1]);
    assert_near("follower pressure", critical, 3.0, 1e-3);
}
