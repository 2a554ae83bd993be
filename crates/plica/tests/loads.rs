//! Tubes under pressure and between plates, against closed forms and one-dimensional solutions.
//!
//! Between sliding ends that do not move a short tube is a ring in plane strain. E = 1, ν = 0.495,
//! from A = 0.44 to B = 0.5.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

use plica::assembly::{Point, SplineTube};
use plica::material::{Law, Material, NeoHookean};
use plica::solve::{Path, Settings, State};
use plica::stability::Harmonics;
use plica::study::TubeProblem;
use plica::tube::{Load, Mesh, Pressure, Support, Tube};

const A: f64 = 0.44;
const B: f64 = 0.5;

fn tube(length: f64, poisson_ratio: f64) -> Tube {
    Tube {
        length,
        thickness: B - A,
        material: Material::NeoHookean(NeoHookean::new(1.0, poisson_ratio)),
        muscles: vec![],
        ends: [Support::Sliding; 2],
        imperfections: vec![],
    }
}

/// A tube on so many elements along, around and through, of which `rings` are solved for.
fn problem(tube: &Tube, [along, around, through]: [usize; 3], rings: usize) -> TubeProblem {
    let mesh = Mesh {
        axial: along + 3,
        around,
        thickness: through + 3,
        degree: 3,
        refinements: vec![],
        volumetric: Default::default(),
    };
    TubeProblem::new(SplineTube::new(tube, &mesh, rings))
}

fn follower(follower: f64) -> Pressure {
    Pressure {
        follower,
        dead: 0.0,
    }
}

fn inside(tube: &Tube, pressure: Pressure) -> Load {
    Load {
        pressures: [pressure, Pressure::default()],
        ..tube.rest()
    }
}

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

/// The state under a load, reached from rest in equal steps.
fn under(problem: &TubeProblem, load: &Load, steps: usize) -> State<Load> {
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, problem.tube.tube.rest(), u, tight()).unwrap();
    path.set_out(load.clone());
    for n in 1..=steps {
        path.advance(n as f64 / steps as f64, &mut ()).unwrap();
    }
    path.state().clone()
}

/// How far a point of the wall has moved away from the axis.
fn swelling(problem: &TubeProblem, state: &State<Load>, radius: f64) -> f64 {
    let (z, angle) = (0.3 * problem.tube.tube.length, 0.3);
    let point = Point { z, radius, angle };
    let sample = problem.tube.sample(&state.load, &state.u, point);
    let away = |[_, x, y]: [f64; 3]| x.hypot(y);
    away(sample.position) - away(sample.reference)
}

/// Cauchy stress along, outwards and around at a point of the wall.
fn stress(problem: &TubeProblem, state: &State<Load>, radius: f64) -> [f64; 3] {
    // Angle 0 is the middle of an element, where outwards is outwards.
    let (z, angle) = (0.3 * problem.tube.tube.length, 0.0);
    let point = Point { z, radius, angle };
    let Fe = problem.tube.sample(&state.load, &state.u, point).elastic;
    let Material::NeoHookean(law) = problem.tube.tube.material;
    let sigma = law.stress(&Fe).times(Fe.transpose());
    [0, 1, 2].map(|i| sigma.0[i][i] / Fe.determinant())
}

fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    let off = found / expected - 1.0;
    println!("{what}: {found:.9e}, expected {expected:.9e}, off by {off:.1e}");
    assert!(
        off.abs() < tolerance,
        "{what}: {found}, expected {expected}"
    );
}

#[test]
fn a_little_pressure_swells_a_ring_as_lame_says() {
    let tube = tube(0.1, 0.495);
    let problem = problem(&tube, [1, 60, 8], 1);
    let p = 1e-7;
    for kind in [
        follower(p),
        Pressure {
            follower: 0.0,
            dead: p,
        },
    ] {
        let state = under(&problem, &inside(&tube, kind), 1);
        let sigma = [A, B].map(|radius| stress(&problem, &state, radius));
        assert_near("u(A)", swelling(&problem, &state, A) / p, 2.93835994, 1e-5);
        assert_near("u(B)", swelling(&problem, &state, B) / p, 2.59154539, 1e-5);
        assert_near("around at A", sigma[0][2] / p, 7.86524823, 1e-4);
        assert_near("around at B", sigma[1][2] / p, 6.86524823, 1e-4);
        assert_near("along", sigma[0][0] / p, 3.39829787, 1e-4);
        assert_near("outwards at A", sigma[0][1] / p, -1.0, 1e-3);
    }
}

#[test]
fn a_ring_inflates_as_far_as_one_dimension_says() {
    let tube = tube(0.1, 0.495);
    let problem = problem(&tube, [1, 60, 8], 1);
    for (a, p, b, [at_a, at_b], steps) in [
        (1.1, 0.0122352033, 0.5391973105, [0.11511727, 0.10041075], 2),
        (1.5, 0.0329557773, 0.7016189198, [0.56679648, 0.48463349], 6),
    ] {
        let state = under(&problem, &inside(&tube, follower(p)), steps);
        assert_eq!(state.negative_pivots, 0);
        let radius = |rest: f64| rest + swelling(&problem, &state, rest);
        assert_near("a", radius(A), a * A, 1e-5);
        assert_near("b", radius(B), b, 1e-5);
        assert_near("around at A", stress(&problem, &state, A)[2], at_a, 1e-4);
        assert_near("around at B", stress(&problem, &state, B)[2], at_b, 1e-4);
        assert_near("outwards at A", stress(&problem, &state, A)[1], -p, 1e-3);
    }
}

/// Where the lowest eigenvalue of a harmonic is zero on the way to a load, as a fraction of it.
fn lost(problem: &TubeProblem, load: &Load, harmonic: usize, [mut from, mut to]: [f64; 2]) -> f64 {
    let harmonics = Harmonics::new(&problem.tube, harmonic);
    let lowest = |t: f64| {
        let state = under(problem, &problem.tube.tube.rest().towards(load, t), 1);
        let tested = harmonics.test(&state.load, &state.u).unwrap()[harmonic];
        assert_eq!(tested.negative > 0, tested.lowest < 0.0);
        tested.lowest
    };
    // By secants.
    let mut values = [lowest(from), lowest(to)];
    for _ in 0..3 {
        let next = from - values[0] * (to - from) / (values[1] - values[0]);
        (from, to, values) = (to, next, [values[1], lowest(next)]);
    }
    to
}

#[test]
fn a_ring_under_external_pressure_turns_oval_and_then_lobed() {
    let tube = tube(0.1, 0.495);
    let problem = problem(&tube, [1, 60, 8], 1);
    for (n, p) in [(2, 6.94351e-4), (3, 1.883913e-3)] {
        let critical = lost(&problem, &outside(&tube, p), n, [0.9, 1.05]);
        assert_near(&format!("harmonic {n}"), critical * p, p, 1e-4);
    }
}

#[test]
fn a_tube_between_plates_turns_oval_before_it_wrinkles() {
    let tube = tube(3.0, 0.495);
    let problem = problem(&tube, [60, 60, 3], 1);
    let mut load = tube.rest();
    load.ends[1].displacement = -0.1 * 3.0;
    for (n, strain, range) in [
        (2, 0.0552884, [0.54, 0.56]),
        (0, 0.0805741, [0.8, 0.81]),
        (3, 0.0762781, [0.75, 0.77]),
    ] {
        let critical = lost(&problem, &load, n, range);
        assert_near(&format!("harmonic {n}"), 0.1 * critical, strain, 1e-4);
    }
}

#[test]
fn a_ring_under_dead_pressure_turns_oval_at_four_thirds_of_the_true_one() {
    // 4 E I/r³ where the load keeps its direction, 3 E I/r³ where it follows a thin ring.
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
    let critical = lost(&problem, &dead, 2, [3.9, 4.1]);
    assert_near("dead", critical, 4.0, 0.03);
    let critical = lost(&problem, &outside(&tube, bending), 2, [2.9, 3.1]);
    assert_near("true", critical, 3.0, 0.03);
}
