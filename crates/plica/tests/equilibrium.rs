//! Equilibria of whole tubes, compared with closed forms, with each other, and with orders of
//! convergence.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

use plica::activation::{Direction, Muscle, Profile};
use plica::assembly::{Point, SplineTube};
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean};
use plica::monitor::Monitor;
use plica::solve::{Equilibrium, Integrator, Path, PseudoTime, Scheme, Settings, State};
use plica::spline::Refinement;
use plica::tube::{Load, Mesh, Support, Tube, WallLayer};
use std::f64::consts::PI;
use std::fmt::Display;

fn muscle(direction: Direction, zone: [f64; 2], profile: Profile) -> Muscle {
    Muscle::new(String::new(), direction, zone, profile)
}

/// Activation 1 everywhere in the zone.
fn uniform() -> Profile {
    Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)])
}

fn tube(length: f64, muscles: Vec<Muscle>, ends: Support) -> Tube {
    Tube {
        length,
        thickness: 0.06,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.495,
        )))],
        muscles,
        ends: [ends; 2],
        imperfections: vec![],
        obstacles: vec![],
        patches: vec![],
        foundations: vec![],
    }
}

/// Returns the mesh of so many elements along, around and through the wall.
fn mesh(degree: usize, [along, around, through]: [usize; 3]) -> Mesh {
    Mesh {
        axial: along + degree,
        around,
        thickness: through + degree,
        degree,
        refinements: vec![],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    }
}

fn problem(tube: &Tube, mesh: &Mesh, rings: usize) -> TubeProblem {
    TubeProblem::new(SplineTube::new(tube, mesh, rings))
}

/// Returns the state at the end of segments from rest, each divided into equal steps.
fn follow(problem: &TubeProblem, settings: Settings, segments: &[(Load, usize)]) -> State<Load> {
    let rest = problem.tube.tube.rest();
    let zero = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, rest, zero, settings).unwrap();
    for (load, steps) in segments {
        path.begin_segment(load.clone());
        for i in 1..=*steps {
            path.advance(i as f64 / *steps as f64, &mut ()).unwrap();
        }
    }
    path.state().clone()
}

fn position(
    problem: &TubeProblem,
    state: &State<Load>,
    z: f64,
    radius: f64,
    angle: f64,
) -> [f64; 3] {
    let point = Point { z, radius, angle };
    problem.tube.sample(&state.load, &state.u, point).position
}

/// Returns the current distance of a point of the wall from the axis.
fn radius(problem: &TubeProblem, state: &State<Load>, z: f64, radius: f64) -> f64 {
    let [_, x, y] = position(problem, state, z, radius, 0.0);
    x.hypot(y)
}

/// Returns the volume of the undeformed splines, e_z · C e_z.
fn volume(problem: &TubeProblem) -> f64 {
    let (n, rings) = (problem.tube.unknowns(), problem.tube.sector.rings);
    let shift: Vec<f64> = (0..n)
        .map(|i| f64::from(u8::from(i / rings % 3 == 0))) // axial components
        .collect();
    let mut product = vec![0.0; n];
    problem.damping(1.0, &shift, &mut product);
    let sector: f64 = shift.iter().zip(&product).map(|(u, c)| u * c).sum();
    sector * problem.tube.sector.repeats()
}

/// Returns the energy of the whole tube.
fn whole_energy(problem: &TubeProblem, state: &State<Load>) -> f64 {
    problem.tube.forces(&state.load, &state.u).unwrap().energy
}

fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// Returns settings for energies with more digits than a residual of 1e-8 gives.
fn tight() -> Settings {
    Settings {
        tolerance: 1e-11,
        ..Settings::default()
    }
}

#[test]
fn a_free_tube_under_uniform_growth_is_free_of_stress() {
    let along = muscle(Direction::Longitudinal, [0.0, 1.0], uniform());
    let tube = tube(1.0, vec![along], Support::Free);
    for rings in [1, 3, 12] {
        let problem = problem(&tube, &mesh(3, [6, 12, 2]), rings);
        let grown = Load {
            muscles: vec![1.3],
            ..tube.rest()
        };
        let state = follow(&problem, tight(), &[(grown, 2)]);
        let energy = whole_energy(&problem, &state);
        // Energy densities are differences of numbers of order one, over a volume of 0.08.
        assert!(energy.abs() < 1e-16, "{rings} rings: {energy}");
        assert_eq!(state.negative_pivots, 0);
        for angle in [0.2, 2.0, 4.5] {
            let begin = position(&problem, &state, 0.0, 0.5, angle);
            let end = position(&problem, &state, 1.0, 0.5, angle);
            let length = (0..3)
                .map(|i| (end[i] - begin[i]).powi(2))
                .sum::<f64>()
                .sqrt();
            assert!((length - 1.3).abs() < 1e-9, "{rings} rings: {length}");
        }
    }
}

#[test]
fn a_uniformly_contracted_ring_has_the_radii_and_energy_of_the_closed_form() {
    // Plane strain, E = 1, nu = 0.495, radii 0.44 and 0.5; digits of a one-dimensional solution. Per
    // case: growth stretch, inner and outer radius, energy per length.
    let around = muscle(Direction::Circular, [0.0, 0.2], uniform());
    let tube = tube(0.2, vec![around], Support::Sliding);
    let problem = problem(&tube, &mesh(3, [3, 60, 12]), 1);
    for (ratio, inner, outer, energy) in [
        (0.75, 0.3227579338, 0.3827173371, 1.32551829e-5),
        (0.5, 0.2058835933, 0.2656827340, 7.91898869e-5),
    ] {
        let contracted = Load {
            muscles: vec![ratio],
            ..tube.rest()
        };
        let state = follow(&problem, tight(), &[(contracted, 5)]);
        for z in [0.0, 0.07, 0.2] {
            // The spline circle is round to 3.1e-7.
            let (a, b) = (
                radius(&problem, &state, z, 0.44),
                radius(&problem, &state, z, 0.5),
            );
            assert!(relative(a, inner) < 4e-7, "{ratio}: inner radius {a}");
            assert!(relative(b, outer) < 4e-7, "{ratio}: outer radius {b}");
        }
        let per_length = whole_energy(&problem, &state) / 0.2;
        // The error is 1.2e-7 with half as many elements through the wall, and of order h⁶.
        assert!(relative(per_length, energy) < 2e-8, "{ratio}: {per_length}");
    }
}

/// Contraction and relaxation of one zone, less than in the main case of the paper.
fn main_case() -> (Tube, [(Load, usize); 2]) {
    let zone = [0.5, 1.0];
    let muscles = vec![
        muscle(Direction::Circular, zone, Profile::RaisedCosine),
        muscle(Direction::Longitudinal, zone, Profile::RaisedCosine),
    ];
    let tube = tube(3.0, muscles, Support::Fixed);
    let load = |circular: f64, longitudinal: f64| Load {
        muscles: vec![circular, longitudinal],
        ..tube.rest()
    };
    let segments = [(load(0.7, 1.0), 2), (load(0.7, 1.03), 1)];
    (tube, segments)
}

#[test]
fn the_energy_does_not_depend_on_the_number_of_rings_in_a_sector() {
    let (tube, segments) = main_case();
    let mesh = Mesh {
        axial: 60,
        around: 12,
        thickness: 5,
        degree: 3,
        refinements: vec![Refinement {
            from: 0.5,
            to: 1.0,
            factor: 3.0,
        }],
        grading: 1.0,
        contact_range: 0.25,
        volumetric: Default::default(),
        layers: vec![],
    };
    let energy = |rings: usize| {
        let problem = problem(&tube, &mesh, rings);
        whole_energy(&problem, &follow(&problem, tight(), &segments))
    };
    let one = energy(1);
    for rings in [2, 3] {
        // The error of the energy is the square of that of the residual.
        let off = relative(energy(rings), one);
        assert!(off < 1e-10, "{rings} rings: {off:e}");
    }
}

#[test]
fn the_residual_is_the_derivative_of_the_energy() {
    // In every sector with the same factor, since damping adds energies of its own.
    let (tube, segments) = main_case();
    let load = &segments[1].0;
    for rings in [1, 3, 6] {
        let problem = problem(&tube, &mesh(3, [24, 6, 1]), rings);
        let state = follow(&problem, tight(), &segments[..1]);
        let direction: Vec<f64> = (0..state.u.len()).map(|i| (0.3 * i as f64).sin()).collect();
        let at = |h: f64| {
            let moved = state.u.iter().zip(&direction).map(|(u, d)| u + h * d);
            problem.forces(load, &moved.collect::<Vec<_>>()).unwrap()
        };
        let residual = at(0.0).residual;
        let exact: f64 = residual.iter().zip(&direction).map(|(r, d)| r * d).sum();
        let error = |h: f64| ((at(h).energy - at(-h).energy) / (2.0 * h) - exact).abs();
        let order = (error(4e-5) / error(2e-5)).log2();
        assert!((order - 2.0).abs() < 0.05, "{rings} rings: order {order}");
    }
}

/// Records the relative residual after every linear solve.
struct Residuals(Vec<f64>);

impl Monitor for Residuals {
    fn working(&mut self, activity: &dyn Display, _: f64) {
        let activity = activity.to_string();
        let (_, residual) = activity.rsplit_once("residual ").unwrap();
        self.0.push(residual.parse().unwrap());
    }
}

#[test]
fn newton_converges_quadratically() {
    let (tube, [(contracted, _), _]) = main_case();
    let problem = problem(&tube, &mesh(3, [60, 12, 2]), 1);
    let zero = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(&problem, tube.rest(), zero, tight()).unwrap();
    path.begin_segment(contracted);
    let mut pairs = 0;
    for t in [0.25, 0.5, 0.75, 1.0] {
        let mut residuals = Residuals(vec![]);
        path.advance(t, &mut residuals).unwrap();
        for pair in residuals.0.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            // Between the linear range and rounding.
            if before < 0.1 && after > 1e-11 {
                assert!(after < 100.0 * before * before, "{:?}", residuals.0);
                pairs += 1;
            }
        }
    }
    assert!(pairs >= 4, "only {pairs} pairs");
}

#[test]
fn pseudo_time_reaches_the_same_states_as_newton() {
    let (tube, _) = main_case();
    let problem = problem(&tube, &mesh(3, [24, 12, 1]), 1);
    let load = |circular, longitudinal| Load {
        muscles: vec![circular, longitudinal],
        ..tube.rest()
    };
    // Every step is ramped over ten pseudo-time steps.
    let segments = [(load(0.9, 1.0), 5), (load(0.9, 1.01), 2)];
    let direct = follow(&problem, tight(), &segments);
    for integrator in [Integrator::Newmark, Integrator::BackwardEuler] {
        let scheme = Scheme::PseudoTime(PseudoTime {
            integrator,
            ..PseudoTime::default()
        });
        let settings = Settings {
            scheme,
            ..Settings::default()
        };
        let damped = follow(&problem, settings, &segments);
        let [damped, direct] = [&damped, &direct].map(|state| whole_energy(&problem, state));
        let off = relative(damped, direct);
        assert!(off < 1e-9, "{integrator:?}: {off:e}");
    }
}

#[test]
fn a_pulled_tube_is_under_uniaxial_stress() {
    // The lateral stress P = μ (λt − 1/λt) + Λ ln J / λt with J = λ λt² vanishes at the lateral
    // stretch λt, found by Newton's method; the energy is w times the volume.
    let (E, nu, lambda) = (1.0, 0.495, 1.1_f64);
    let (mu, Lame) = (
        E / (2.0 * (1.0 + nu)),
        E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    );
    let mut lateral = 1.0_f64;
    for _ in 0..50 {
        let ln_J = (lambda * lateral * lateral).ln();
        let stress = mu * (lateral * lateral - 1.0) + Lame * ln_J; // λt P
        lateral -= stress / (2.0 * mu * lateral + 2.0 * Lame / lateral);
    }
    let ln_J = (lambda * lateral * lateral).ln();
    let I1 = lambda * lambda + 2.0 * lateral * lateral;
    let w = 0.5 * mu * (I1 - 3.0) - mu * ln_J + 0.5 * Lame * ln_J * ln_J;

    let tube = tube(1.5, vec![], Support::Sliding);
    let mut pulled = tube.rest();
    pulled.ends[1].displacement = 0.15;
    for (degree, rings) in [(1, 1), (2, 1), (3, 1), (3, 4), (3, 24)] {
        let problem = problem(&tube, &mesh(degree, [2, 24, 1]), rings);
        let state = follow(&problem, tight(), &[(pulled.clone(), 2)]);
        // A whole tube is fixed laterally at one point only, so diameters are compared.
        let diameter = |state: &State<Load>| {
            let [_, x0, y0] = position(&problem, state, 0.7, 0.5, 0.0);
            let [_, x1, y1] = position(&problem, state, 0.7, 0.5, PI);
            (x1 - x0).hypot(y1 - y0)
        };
        let rest = follow(&problem, tight(), &[]);
        let ratio = diameter(&state) / diameter(&rest);
        let name = format!("degree {degree}, {rings} rings");
        assert!(relative(ratio, lateral) < 1e-9, "{name}: {ratio}");
        let off = relative(whole_energy(&problem, &state), w * volume(&problem));
        assert!(off < 1e-11, "{name}: {off:e}");
    }
}

#[test]
fn a_twisted_tube_has_the_torsional_stiffness_of_saint_venant() {
    let length = 1.0;
    let tube = tube(length, vec![], Support::Fixed);
    let problem = problem(&tube, &mesh(3, [12, 60, 2]), 1);
    let mu = 1.0 / (2.0 * 1.495);
    let stiffness = mu * PI / 2.0 * (0.5_f64.powi(4) - 0.44_f64.powi(4)) / length;
    let off = |twist: f64| {
        let mut twisted = tube.rest();
        twisted.ends[1].twist = twist;
        let state = follow(&problem, tight(), &[(twisted, 1)]);
        // The rotation of a cross-section is proportional to its position.
        let [_, x, y] = position(&problem, &state, 0.25, 0.47, 0.0);
        assert!((y.atan2(x) - 0.25 * twist).abs() < 0.1 * twist.powi(3));
        whole_energy(&problem, &state) / (0.5 * stiffness * twist * twist) - 1.0
    };
    // Exact for small angles; the error grows with the square of the angle.
    assert!(off(0.02).abs() < 1e-4, "{:e}", off(0.02));
    let order = (off(0.1) / off(0.05)).log2();
    assert!((order - 2.0).abs() < 0.05, "order {order}");
}

#[test]
fn the_order_of_convergence_of_the_energy_is_twice_the_degree() {
    // Sliding ends are planes of symmetry and the profile is even about them, so the solution is
    // smooth. The wall is compressible, so that linear elements do not lock.
    let length = 1.0;
    let around = muscle(Direction::Circular, [0.0, length], Profile::RaisedCosine);
    let tube = Tube {
        thickness: 0.2,
        layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
            1.0, 0.3,
        )))],
        ..tube(length, vec![around], Support::Sliding)
    };
    let contracted = Load {
        muscles: vec![0.9],
        ..tube.rest()
    };
    for (degree, coarsest) in [(1, 8), (2, 4), (3, 4)] {
        let energy = |refined: usize| {
            let n = coarsest << refined;
            let problem = problem(&tube, &mesh(degree, [2 * n, 24, n / 2]), 1);
            whole_energy(
                &problem,
                &follow(&problem, tight(), &[(contracted.clone(), 1)]),
            )
        };
        let w = [energy(0), energy(1), energy(2)];
        let order = ((w[0] - w[1]) / (w[1] - w[2])).log2();
        assert!(w[0] > w[1] && w[1] > w[2], "degree {degree}: {w:?}");
        assert!(
            (order - 2.0 * degree as f64).abs() < 0.3,
            "degree {degree}: order {order}"
        );
    }
}
