//! Tubes of many rings that touch themselves.

use crate::common::main_case;
use plica::assembly::{Barrier, Point, SplineTube};
use plica::contact::Face;
use plica::equilibrium::{TubeProblem, test_stability};
use plica::solve::{Method, Path};
use plica::study::{Plan, RangeChanges, Study, half_range};
use std::f64::consts::PI;

/// Range of contact, in D: wide, so that a coarse mesh resolves it.
const RANGE: f64 = 0.03;

fn problem(plan: &Plan, rings: usize) -> TubeProblem {
    let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
    let barrier = Barrier {
        range: RANGE,
        ..*tube.barrier()
    };
    TubeProblem::new(tube.with_barrier(barrier)).with_contact()
}

#[test]
fn a_touching_fold_of_many_rings_is_that_of_one_ring() {
    let plan = main_case([70, 32, 4]);
    let ring = problem(&plan, 1);
    let rest = vec![0.0; ring.tube.unknowns()];
    let settings = plan.solver.clone();
    let mut path = Path::begin(ring.clone(), plan.tube.rest(), rest, settings.clone()).unwrap();
    let mut load = plan.tube.rest();
    load.muscles[0] = 0.25;
    path.begin_segment(load.clone());
    for step in 1..=5 {
        path.advance(f64::from(step) / 5.0, &mut ()).unwrap();
    }
    load.muscles[1] = 1.45;
    path.begin_segment(load.clone());
    for step in 1..=15 {
        path.advance(f64::from(step) / 15.0, &mut ()).unwrap();
    }
    let exact = path.state().clone();
    let of_ring = ring.contact_report(&load, &exact.u).unwrap();
    let touching = of_ring.faces[0].expect("the outer wall touches itself");
    let verdict = test_stability(&ring, &mut path, 4, &mut ());
    for rings in [4, 32] {
        let whole = problem(&plan, rings);
        let u = exact.u.iter().flat_map(|x| std::iter::repeat_n(*x, rings));
        let start: Vec<f64> = u.collect();
        let mut path = Path::begin(whole.clone(), load.clone(), start, settings.clone()).unwrap();
        path.begin_segment(load.clone());
        let step = path.advance(1.0, &mut ()).unwrap();
        let state = path.state().clone();
        assert!(state.in_equilibrium() && step.method == Method::Newton);
        assert!(step.effort.linear_solves <= 4, "{step:?}");
        assert!(step.effort.inner_iterations <= 2 * step.effort.linear_solves);
        let error = state.energy / (exact.energy * rings as f64) - 1.0;
        assert!(error.abs() < 1e-8, "{rings}: {error:e}");
        let report = whole.contact_report(&load, &state.u).unwrap();
        let found = report.faces[0].expect("the outer wall touches itself");
        assert_eq!(report.faces[1], None);
        for (found, of_ring) in [
            (report.energy, of_ring.energy),
            (found.area, touching.area),
            (found.force, touching.force),
            (found.gap, touching.gap),
            (report.surfaces[0].stretch, of_ring.surfaces[0].stretch),
        ] {
            assert!((found / of_ring - 1.0).abs() < 1e-3, "{found} {of_ring}");
        }
        assert_eq!(test_stability(&whole, &mut path, 4, &mut ()), verdict);
        // The largest pressure on the fold.
        let z = plan.tube.length * 0.25;
        let pressure = |problem: &TubeProblem, u: &[f64], angle: f64| {
            let field = problem.contact_pressure(u).unwrap();
            let places = (0..200).map(|i| z * (1.0 + 0.005 * f64::from(i)));
            places
                .map(|z| field.at(Face::Outer, z, angle))
                .fold(0.0, f64::max)
        };
        let expected = pressure(&ring, &exact.u, 0.0);
        for angle in [0.0, 1.0, -2.5] {
            let found = pressure(&whole, &state.u, angle);
            assert!(
                expected > 0.0 && (found / expected - 1.0).abs() < 1e-2,
                "{found} {expected}"
            );
        }
    }
}

#[test]
fn a_ring_that_flattens_closes_its_lumen_and_goes_no_further() {
    let text = r#"
        contact = true
        symmetry = "none"
        tube = { diameter = 1.0, length = 0.3, thickness = 0.06 }
        material.neo-hookean.poisson_ratio = 0.3
        ends = { colon = "sliding", ileum = "sliding" }
        mesh = { control_points = { axial = 4, around = 48, thickness = 4 }, contact_range = 0.05 }
        [[imperfections]]
        of = "geometry"
        amplitude = 2e-3
        shape.wave = { mode = 2, axial = "uniform" }
        [[stages]]
        steps = 10
        drive.outer-wall.pressure = 5e-4
        [[stages]]
        steps = 12
        drive.outer-wall.pressure = 1.2e-3
    "#;
    let plan = plica::case::read(text, "ring").unwrap();
    let study = Study::new(&plan).unwrap();
    let tube = SplineTube::new(&plan.tube, &plan.mesh, 48);
    let inner = plan.tube.inner_radius();
    let mut touching = 0;
    let mut last = None;
    let mut effort = [(0, 0); 2];
    for state in study {
        let state = state.unwrap();
        assert!(state.in_equilibrium);
        // The ring flattens to the line y = 0, and neither side may pass it.
        for i in 1..64 {
            let angle = PI * f64::from(i) / 64.0;
            let point = |angle: f64| Point {
                z: 0.15,
                radius: inner,
                angle,
            };
            let height = |angle: f64| {
                let sample = tube.sample(&state.load, &state.unknowns, point(angle));
                sample.position[2]
            };
            assert!(
                height(angle) > 0.0 && height(-angle) < 0.0,
                "{}",
                state.number
            );
        }
        let contact = state.contact.as_ref().unwrap();
        let touches = contact.faces[1].is_some();
        let [from, to] = contact.angles.unwrap()[1].map(f64::to_degrees);
        if touches {
            // Opposite walls touch, at 90° and 270°.
            assert!((180.0..300.0).contains(&(to - from)), "{from} {to}");
            let off = (0.5 * (from + to)).rem_euclid(180.0);
            assert!(off.min(180.0 - off) < 1.0, "{from} {to}");
        } else {
            assert_eq!([from, to], [0.0; 2]);
        }
        touching += usize::from(touches);
        if state.energy < 1e-5 {
            // Nearly round.
            continue;
        }
        let (solves, iterations) = &mut effort[usize::from(touches)];
        *solves += state.linear_solves;
        *iterations += state.inner_iterations;
        last = Some(state);
    }
    assert!(touching >= 3, "{touching}");
    let last = last.unwrap();
    let half = half_range(&plan, &last.load, &last.unknowns, &mut ()).unwrap();
    let RangeChanges { energy, force } = half.changes.unwrap();
    // Walls that come closer by less than 0.0075 D change little.
    assert!((1e-7..0.1).contains(&energy.abs()), "{energy}");
    assert!(force.abs() < 1.0 && half.linear_solves > 0, "{half:?}");
    // Iterations for a solve of a flat ring.
    let [apart, together] = effort.map(|(solves, iterations)| iterations as f64 / solves as f64);
    assert!(apart > 0.0 && together < 3.0 * apart, "{apart} {together}");
}
