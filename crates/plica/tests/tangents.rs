//! The tangent of every case of the repository is the derivative of its residual.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

use plica::assembly::SplineTube;

/// Returns a displacement field of size one: a sum of waves with pseudo-random wave numbers and phases.
fn waves(seed: u64) -> impl Fn(f64, f64, f64) -> [f64; 3] {
    let mut state = seed;
    let mut next = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    let numbers = [(); 12].map(|()| [4.0 * next(), 4.0 * next(), std::f64::consts::TAU * next()]);
    move |z, r, s| {
        let turn = std::f64::consts::TAU * s;
        [0, 1, 2].map(|i| {
            let waves = numbers[4 * i..4 * i + 4].iter();
            waves
                .map(|[along, through, phase]| 0.5 * (along * z + through * r + turn + phase).sin())
                .sum()
        })
    }
}

/// Returns u + h d.
fn moved(u: &[f64], direction: &[f64], h: f64) -> Vec<f64> {
    u.iter().zip(direction).map(|(u, d)| u + h * d).collect()
}

#[test]
fn the_tangent_of_every_case_is_the_derivative_of_its_residual() {
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut tested = 0;
    for entry in std::fs::read_dir(cases).unwrap() {
        let path = entry.unwrap().path();
        let name = path.display();
        let text = std::fs::read_to_string(&path).unwrap();
        if text.contains("start.state") {
            continue; // needs the state of another run
        }
        let mut plan = plica::case::read(&text, "case").unwrap();
        // A small mesh keeps the test short.
        plan.mesh.axial = plan.mesh.axial.min(40);
        plan.mesh.thickness = plan.mesh.thickness.min(5);
        let rings = plan.mesh.rings(plan.symmetry);
        let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
        let load = plan.tube.rest().towards(&plan.stages[0].load, 0.5);
        let field = |seed| {
            let waves = waves(seed);
            tube.control_values_from(|z, r, ring| waves(z, r, ring as f64 / rings as f64))
        };
        // The displacement is smaller than an eighth of the thickness, because control points next to a fixed end
        // move while the end does not.
        let mut u = moved(
            &vec![0.0; tube.unknowns()],
            &field(1),
            0.05 * plan.tube.thickness,
        );
        tube.apply_prescribed(&load, &mut u);
        let d = field(2);

        let residual = |h: f64| {
            let forces = tube.forces(&load, &moved(&u, &d, h));
            forces.unwrap_or_else(|e| panic!("{name}: {e}")).residual
        };
        let mut exact = vec![0.0; u.len()];
        tube.tangent(&load, &u).multiply_add(1.0, &d, &mut exact);
        let size = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>().sqrt();
        let error = |h: f64| {
            let slope = moved(&residual(h), &residual(-h), -1.0);
            size(&moved(&exact, &slope, -0.5 / h))
        };
        // Where fibres begin to bear load within the step the order is lower.
        let has_fibres = text.contains("fibres") || text.contains("material.from");
        let order = (error(1e-3) / error(5e-4)).log2();
        let is_second = (order - 2.0).abs() < 0.05;
        assert!(is_second || has_fibres, "{name}: order {order}");
        // A wrong entry would cause an error independent of the step.
        assert!(error(1e-4) < 1e-3 * size(&exact), "{name}");
        tested += 1;
    }
    assert!(tested >= 6, "{tested} cases");
}
