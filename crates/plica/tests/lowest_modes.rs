//! Lowest eigenpairs of three-dimensional states against the harmonic blocks and the assembled tangent.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::matrix::lowest_eigenpairs;
use plica::solve::{Effort, Lowest, Path, Search, relaxation};
use plica::stability::Harmonics;
use plica::study::Plan;
use plica::tube::{Load, Support};

/// Returns the main case on a coarse mesh.
fn coarse(mesh: [usize; 3]) -> Plan {
    let text = include_str!("../../../cases/invagination.toml");
    let mut plan = plica::case::read(text, "invagination").unwrap();
    [plan.mesh.axial, plan.mesh.around, plan.mesh.thickness] = mesh;
    plan
}

fn problem(plan: &Plan, rings: usize) -> TubeProblem {
    TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings))
}

fn lowest(problem: &TubeProblem, load: &Load, u: &[f64], wanted: usize) -> Lowest {
    let search = Search {
        wanted,
        accuracy: 1e-4,
        iterations: 300,
        side_of: None,
    };
    let found = problem.lowest_modes(load, u, wanted + 3, &search, &mut ());
    let found = found.unwrap();
    println!("{} iterations: {:?}", found.iterations, found.values);
    assert!(found.iterations < 300, "{:?}", found.residuals);
    found
}

#[test]
fn an_axisymmetric_state_has_the_eigenvalues_of_its_modes_twice() {
    for ends in [[Support::Fixed; 2], [Support::Fixed, Support::Free]] {
        let mut plan = coarse([30, 12, 4]);
        plan.tube.ends = ends;
        let (ring, whole) = (problem(&plan, 1), problem(&plan, 12));
        let load = plan.tube.rest().towards(&plan.stages[0].load, 0.5);
        let rest = vec![0.0; ring.tube.unknowns()];
        let mut path = Path::begin(&ring, plan.tube.rest(), rest, plan.solver.clone()).unwrap();
        path.begin_segment(load.clone());
        for n in 1..=3 {
            path.advance(f64::from(n) / 3.0, &mut ()).unwrap();
        }
        let one = &path.state().u;
        let all: Vec<f64> = one.iter().flat_map(|&x| [x; 12]).collect();

        let harmonics = Harmonics::new(&ring, 5);
        let mut expected = vec![];
        for n in 0..=5 {
            let pairs = harmonics.lowest(n, &load, one, 4).unwrap();
            let times = if n == 0 { 1 } else { 2 };
            expected.extend(pairs.iter().flat_map(|pair| vec![pair.value; times]));
        }
        expected.sort_by(f64::total_cmp);
        let found = lowest(&whole, &load, &all, 8);
        for (value, exact) in found.values.iter().zip(&expected[..8]) {
            assert!(
                (value / exact - 1.0).abs() < 1e-6,
                "{value} instead of {exact}"
            );
        }
    }
}

#[test]
fn an_oval_state_has_the_eigenvalues_of_its_assembled_tangent() {
    let plan = coarse([10, 12, 4]);
    for rings in [12, 6] {
        let problem = problem(&plan, rings);
        let tube = &problem.tube;
        let load = plan.tube.rest();
        // The colon end is fixed in an oval shape.
        let row = tube.row_size();
        let oval = |i: usize| {
            let along = (i / row) as f64 / 9.0;
            let wave = 2.0 * tube.sector.ring_angle(i % rings) + 0.5 * along;
            let size = 0.03 * (1.0 - along).powi(2);
            match i / rings % 3 {
                0 => 0.0,
                1 => size * wave.cos(),
                _ => -0.5 * size * wave.sin(),
            }
        };
        let u = (0..tube.unknowns()).map(oval).collect();
        let u = relaxation(
            &problem,
            &load,
            u,
            &plan.solver,
            &mut Effort::default(),
            &mut (),
        )
        .unwrap()
        .u;
        let radial = u.chunks_exact(rings).skip(1).step_by(3);
        let most = radial.map(|u| u.iter().fold(0.0_f64, |most, x| most.max((x - u[0]).abs())));
        assert!(most.fold(0.0, f64::max) > 0.02);

        let (stiffness, mass) = (tube.tangent(&load, &u), tube.damping());
        let exact =
            lowest_eigenpairs(&stiffness.clone().into(), &mass, tube.prescribed(), 4).unwrap();
        let found = lowest(&problem, &load, &u, 4);
        // A preconditioner that couples modes which so few rings do not resolve takes 140 iterations.
        assert!(found.iterations < 60, "{}", found.iterations);
        for (value, exact) in found.values.iter().zip(exact.iter().map(|pair| pair.value)) {
            assert!(
                (value / exact - 1.0).abs() < 1e-6,
                "{value} instead of {exact}"
            );
        }
        // The vectors are normalised eigenvectors of the assembled matrix.
        for (x, value) in found.vectors.iter().zip(&found.values).take(4) {
            let [mut Kx, mut Cx] = [vec![0.0; x.len()], vec![0.0; x.len()]];
            stiffness.multiply_add(1.0, x, &mut Kx);
            mass.multiply_add(1.0, x, &mut Cx);
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            assert!((dot(x, &Cx) - 1.0).abs() < 1e-10);
            assert!((dot(x, &Kx) / value - 1.0).abs() < 1e-6);
        }
    }
}
