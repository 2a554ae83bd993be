//! A fold that closes: contact on the path of a whole tube.

use crate::common::main_case;
use plica::assembly::SplineTube;
use plica::contact::{ContactReport, MeridianContact, SelfContact};
use plica::equilibrium::{TubeProblem, UnstableMode, prolong, test_stability};
use plica::measure::Measures;
use plica::solve::{Equilibrium, Path};
use plica::stability::Harmonics;
use std::sync::Arc;

/// Length ratio at the end of the path, at which the flanks of the fold are 0.020 D apart without contact.
const END: f64 = 1.45;

/// Range of contact, in D: wide, so that a coarse mesh resolves it.
const RANGE: f64 = 0.03;

/// A state with its contact, and the energies of tube and contact.
struct Reached {
    problem: TubeProblem,
    path: Path<TubeProblem>,
    contact: Option<ContactReport>,
    gap: f64,
}

/// Follows the main case on a coarse mesh until the fold is narrow.
fn folded(range: Option<f64>) -> Reached {
    let plan = main_case([70, 16, 4]);
    let mut problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, 1));
    problem.contact = range.map(|range| {
        let contact = SelfContact::Meridian(MeridianContact::new(&problem.tube).with_range(range));
        Arc::new(contact)
    });
    let rest = vec![0.0; problem.tube.unknowns()];
    let settings = plan.solver.clone();
    let mut path = Path::begin(problem.clone(), plan.tube.rest(), rest, settings).unwrap();
    let mut load = plan.tube.rest();
    load.muscles[0] = 0.25;
    path.begin_segment(load.clone());
    for step in 1..=5 {
        path.advance(f64::from(step) / 5.0, &mut ()).unwrap();
    }
    load.muscles[1] = END;
    path.begin_segment(load);
    for step in 1..=15 {
        path.advance(f64::from(step) / 15.0, &mut ()).unwrap();
        if let Some(contact) = &problem.contact {
            assert_eq!(contact.crossing(&path.state().u), None, "step {step}");
        }
    }
    let (load, u) = (&path.state().load, &path.state().u);
    Reached {
        contact: problem.contact_report(load, u),
        gap: Measures::of(&problem.tube, load, u).gap,
        problem,
        path,
    }
}

#[test]
fn a_fold_that_touches_itself_keeps_its_flanks_apart_and_in_equilibrium() {
    let free = folded(None);
    let touching = folded(Some(RANGE));
    let state = touching.path.state();
    assert!(state.in_equilibrium() && state.relative_residual < 1e-6);
    let report = touching.contact.unwrap();
    let [outer, inner] = report.faces;
    let outer = outer.expect("the outer wall touches itself");
    assert_eq!(inner, None);
    assert!(outer.gap > 0.0 && outer.gap < RANGE);
    assert!(outer.force > 0.0 && outer.area > 0.0 && outer.from_to[0] < outer.from_to[1]);
    // Contact holds the fold open, which costs energy.
    assert!(
        touching.gap > free.gap + 1e-3,
        "{} {}",
        touching.gap,
        free.gap
    );
    assert!(state.energy > free.path.state().energy);
    assert!(report.energy > 0.0 && report.energy < 0.02 * state.energy);
}

#[test]
fn a_fold_that_touches_itself_is_carried_onto_a_finer_graded_mesh_and_range() {
    let coarse = folded(Some(RANGE));
    let mut plan = main_case([100, 16, 5]);
    plan.mesh.grading = 4.0;
    let mut problem = TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, 1));
    let contact =
        SelfContact::Meridian(MeridianContact::new(&problem.tube).with_range(0.5 * RANGE));
    problem.contact = Some(Arc::new(contact.clone()));
    let (load, u) = (&coarse.path.state().load, &coarse.path.state().u);
    let u = prolong(&coarse.problem.tube, &problem.tube, u);
    assert_eq!(contact.crossing(&u), None);
    let settings = plan.solver.clone();
    let mut path = Path::begin(problem.clone(), load.clone(), u, settings).unwrap();
    path.begin_segment(load.clone());
    path.advance(1.0, &mut ()).unwrap();
    let state = path.state();
    assert!(state.in_equilibrium());
    assert_eq!(contact.crossing(&state.u), None);
    let of = |report: ContactReport| report.faces[0].expect("the outer wall touches itself");
    let (fine, wide) = (
        of(problem.contact_report(load, &state.u).unwrap()),
        of(coarse.contact.unwrap()),
    );
    assert!(fine.gap > 0.0 && fine.gap < wide.gap, "{}", fine.gap);
    assert!(state.energy < coarse.path.state().energy);
}

#[test]
fn the_tangent_of_a_touching_fold_is_the_derivative_of_its_residual() {
    let Reached { problem, path, .. } = folded(Some(RANGE));
    let (load, u) = (&path.state().load, &path.state().u);
    let direction: Vec<f64> = problem
        .prescribed()
        .iter()
        .enumerate()
        .map(|(i, prescribed)| match *prescribed || i % 3 == 2 {
            true => 0.0,
            false => (0.37 * i as f64).sin(),
        })
        .collect();
    let at = |h: f64| {
        let moved: Vec<f64> = u.iter().zip(&direction).map(|(u, d)| u + h * d).collect();
        problem.forces(load, &moved).unwrap().residual
    };
    let mut product = vec![0.0; u.len()];
    let tangent = problem.tangent(load, u);
    plica::solve::Tangent::multiply_add(&tangent, 1.0, &direction, &mut product);
    let h = 1e-7;
    let (low, high) = (at(-h), at(h));
    let size = product.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    for (i, p) in product.iter().enumerate() {
        let difference = (high[i] - low[i]) / (2.0 * h);
        assert!(
            (difference - p).abs() < 1e-5 * size,
            "{i}: {difference} {p}"
        );
    }
}

#[test]
fn the_stability_test_of_a_touching_state_includes_contact() {
    let Reached {
        problem, mut path, ..
    } = folded(Some(RANGE));
    let state = path.state().clone();
    let harmonics = Harmonics::new(&problem, 3);
    let tested = harmonics.test(&state.load, &state.u).unwrap();
    let mut without = problem.clone();
    without.contact = None;
    let free = Harmonics::new(&without, 3);
    let free = free.test(&state.load, &state.u).unwrap();
    let verdict = test_stability(&problem, &mut path, 3, &mut ());
    let mut difference = 0.0_f64;
    for (n, (with, without)) in tested.iter().zip(&free).enumerate() {
        println!("{n}: {with:?} {without:?}");
        difference = difference.max((with.lowest / without.lowest - 1.0).abs());
        assert_eq!(with.negative > 0, with.lowest < 0.0, "{n}: {with:?}");
        let unstable = verdict
            .unstable_modes()
            .any(|mode| mode == UnstableMode::Circumferential(n));
        assert_eq!(unstable, with.negative > 0, "{n}: {verdict}");
    }
    // Flanks that press push each other aside, or keep each other from moving together.
    assert!(difference > 1e-4, "{difference}");
    // Eigenvalue and quotient of differences of the residual agree for a mode of the fold.
    let pairs = harmonics.lowest(0, &state.load, &state.u, 6).unwrap();
    for pair in &pairs {
        let residual = |h: f64| {
            let moved = state.u.iter().zip(&pair.vector).map(|(u, x)| u + h * x);
            let forces = problem.forces(&state.load, &moved.collect::<Vec<_>>());
            forces.unwrap().residual
        };
        let (low, high) = (residual(-1e-7), residual(1e-7));
        let differences = low.iter().zip(&high).map(|(low, high)| (high - low) / 2e-7);
        let quotient: f64 = differences.zip(&pair.vector).map(|(d, x)| d * x).sum();
        assert!(
            (quotient / pair.value - 1.0).abs() < 1e-3,
            "{quotient} {}",
            pair.value
        );
    }
}

#[test]
fn a_state_that_touches_nowhere_is_the_same_with_contact() {
    let free = folded(None);
    let narrow = folded(Some(1e-4));
    let contact = narrow.contact.as_ref().unwrap();
    assert!(contact.faces.iter().all(Option::is_none));
    // Free of twist, too, which is rounding in a tube without contact.
    let [free, narrow] = [&free, &narrow].map(|reached| &reached.path.state().u);
    let apart = free.iter().zip(narrow).map(|(a, b)| (a - b).abs());
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < 1e-13, "{apart}");
}

#[test]
fn a_pushed_end_closes_a_fold_without_passing_through_it() {
    // In few large steps: the prediction of a step, and the state whose end alone is moved, lie behind the wall.
    let Reached {
        problem, mut path, ..
    } = folded(Some(RANGE));
    let contact = problem.contact.as_ref().unwrap();
    let mut load = path.state().load.clone();
    load.ends[1].displacement = -0.6;
    path.begin_segment(load);
    for step in 1..=3 {
        let end = path.advance(f64::from(step) / 3.0, &mut ());
        assert_eq!(contact.crossing(&path.state().u), None, "step {step}");
        if let Err(error) = end {
            panic!("{step}: {error}");
        }
    }
}

#[test]
fn a_tube_with_contact_does_not_twist() {
    let plan = main_case([10, 8, 4]);
    let tube = || SplineTube::new(&plan.tube, &plan.mesh, 1);
    let problem = TubeProblem::new(tube()).with_contact();
    let mut u = vec![0.1; problem.tube.unknowns()];
    problem.apply_prescribed(&plan.tube.rest(), &mut u);
    let free = TubeProblem::new(tube());
    for (i, prescribed) in problem.prescribed().iter().enumerate() {
        let twists = i % 3 == 2;
        assert_eq!(*prescribed, twists || free.prescribed()[i], "{i}");
        assert!(!twists || u[i] == 0.0, "{i}: {}", u[i]);
    }
}
