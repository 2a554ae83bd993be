//! Cross-checks: the same result computed in two ways.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, energy, solve_from_rest, tight_settings};
use plica::activation::{Direction, Muscle, Profile};
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean, Volumetric};
use plica::solve::{
    Effort, Equilibrium, Integrator, Path, PseudoTime, Scheme, Settings, Solver, State, Tangent,
};
use plica::tube::{
    Axial, End, EndDirection, Imperfection, Integration, Load, Part, Shape, Support, Wave,
};

/// Returns a tube whose middle contracts and relaxes, on a coarse mesh.
fn small_tube(around: usize) -> TubeModel {
    let mut model = TubeModel::new(3.0, 0.06, 0.495, [24, around, 2]);
    model.tube.ends = [Support::Fixed; 2];
    for direction in [Direction::Circular, Direction::Longitudinal] {
        model.tube.muscles.push(Muscle::new(
            String::new(),
            direction,
            [0.5, 1.5],
            Profile::RaisedCosine,
        ));
    }
    model
}

/// Returns the load with the given targets of the circular and the longitudinal muscle.
fn activation(model: &TubeModel, diameter: f64, length: f64) -> Load {
    Load {
        muscles: vec![diameter, length],
        ..model.tube.rest()
    }
}

/// Returns a displacement of waves without symmetry.
fn wave_field(problem: &TubeProblem, seed: f64) -> Vec<f64> {
    let tube = &problem.tube;
    tube.control_values_from(|z, r, ring| {
        let phi = tube.sector.ring_angle(ring) * tube.sector.repeats();
        [0.0, 1.0, 2.0].map(|i| (2.3 * z + 5.0 * r + (1.0 + i) * phi + seed * (1.0 + i)).sin())
    })
}

/// Returns the order at which central differences of the residual converge to the tangent.
fn order_of_differences(
    problem: &TubeProblem,
    load: &Load,
    u: &[f64],
) -> Result<f64, VerificationError> {
    let d = wave_field(problem, 0.7);
    let mut exact = vec![0.0; u.len()];
    problem.tangent(load, u).multiply_add(1.0, &d, &mut exact);
    let residual = |h: f64| -> Result<Vec<f64>, VerificationError> {
        let at: Vec<f64> = u.iter().zip(&d).map(|(u, d)| u + h * d).collect();
        Ok(problem.forces(load, &at)?.residual)
    };
    let error = |h: f64| -> Result<f64, VerificationError> {
        let (after, before) = (residual(h)?, residual(-h)?);
        let squares = (0..u.len()).map(|i| ((after[i] - before[i]) / (2.0 * h) - exact[i]).powi(2));
        Ok(squares.sum::<f64>().sqrt())
    };
    let h = 2e-4;
    Ok((error(h)? / error(0.5 * h)?).log2())
}

/// Records the orders of convergence of differences of the residual to the tangent.
pub fn tangents(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("tangent and differences of the residual")?;
    let whole = small_tube(12);
    let quadratic = {
        let mut model = small_tube(12);
        model.tube.layers[0].material = Material::NeoHookean(NeoHookean {
            volumetric: Volumetric::Quadratic,
            ..NeoHookean::new(1.0, 0.495)
        });
        model
    };
    let imperfect = {
        let mut model = small_tube(12);
        model.tube.imperfections.push(Imperfection {
            of: Part::Geometry,
            amplitude: 0.01,
            shape: Shape::Wave(Wave::new(2, 0.3, Axial::HalfWaves(1))),
        });
        model
    };
    let reduced = TubeModel {
        volumetric: Integration::Reduced,
        ..small_tube(12)
    };
    for (name, model, rings) in [
        ("axisymmetric", &whole, 1),
        ("threefold", &whole, 4),
        ("no symmetry", &whole, 12),
        ("quadratic volumetric energy", &quadratic, 12),
        ("imperfect geometry", &imperfect, 12),
        ("reduced integration", &reduced, 12),
    ] {
        recorder.check_cancelled()?;
        let problem = model.problem(rings);
        let mut load = activation(model, 0.8, 1.05);
        load.pressures = model.under_pressure([1e-3, 2e-3]).pressures;
        let u: Vec<f64> = wave_field(&problem, 0.1).iter().map(|u| 2e-3 * u).collect();
        let order = order_of_differences(&problem, &load, &u)?;
        let quantity = format!("order of convergence, {name}");
        recorder.row(
            quantity,
            order,
            (2.0, "central differences"),
            super::Tolerance::Absolute(0.1),
        );
    }
    Ok(())
}

/// Records the difference between solutions by conjugate gradients with the harmonic preconditioner and by a
/// factorisation of the assembled matrix.
pub fn solvers(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let mut oval = small_tube(12);
    oval.tube.imperfections.push(Imperfection {
        of: Part::End(End::Colon, EndDirection::Across),
        amplitude: 0.05,
        shape: Shape::Wave(Wave::new(2, 0.3, Axial::HalfWaves(1))),
    });
    recorder.case("linear system of 12 rings")?;
    for (name, model) in [("axisymmetric", small_tube(12)), ("oval", oval)] {
        let problem = model.problem(12);
        let load = activation(&model, 0.8, 1.02);
        let u = solve_from_rest(&problem, &load, 3)?.u;
        let b = wave_field(&problem, 0.4);
        let tangent = problem.tangent(&load, &u);
        let mut harmonic = b.clone();
        for (x, prescribed) in harmonic.iter_mut().zip(problem.prescribed()) {
            *x = if *prescribed { 0.0 } else { *x };
        }
        let mut direct = harmonic.clone();
        let solver = tangent
            .shifted(0.0)
            .map_err(|e| VerificationError::Solve(e.to_string()))?;
        let solved = solver
            .solve(&mut harmonic, 1e-10, &())
            .map_err(|_| VerificationError::Solve("negative curvature".into()))?;
        let mut matrix = problem.tube.tangent(&load, &u);
        matrix.constrain(problem.prescribed());
        let factor = matrix
            .factor()
            .map_err(|e| VerificationError::Solve(e.to_string()))?;
        factor.solve(&mut direct);
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let difference: Vec<f64> = harmonic.iter().zip(&direct).map(|(a, b)| a - b).collect();
        let error = norm(&difference) / norm(&direct);
        let quantity = format!(
            "relative difference, {name} state, {} iteration(s)",
            solved.iterations
        );
        recorder.zero(
            1e-5,
            quantity,
            error,
            "direct factorisation (products in single precision)",
        );
    }
    Ok(())
}

/// Records energies of the same path with one ring, a cyclic sector of four rings, and all rings.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = small_tube(12);
    let load = activation(&model, 0.7, 1.03);
    let mut energies = vec![];
    for rings in [1, 4, 12] {
        recorder.check_cancelled()?;
        let problem = model.problem(rings);
        energies.push(energy(&problem, &solve_from_rest(&problem, &load, 4)?));
    }
    recorder.case("contracting tube, small mesh")?;
    let axisymmetric = (energies[0], "axisymmetric");
    recorder.relative(1e-8, "W, threefold", energies[1], axisymmetric);
    recorder.relative(1e-8, "W, no symmetry", energies[2], axisymmetric);
    Ok(())
}

/// Follows a path from rest through load segments of the given numbers of steps.
fn follow(
    problem: &TubeProblem,
    settings: Settings,
    segments: &[(Load, usize)],
) -> Result<State<Load>, VerificationError> {
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, problem.tube.tube.rest(), u, settings)?;
    for (load, steps) in segments {
        path.begin_segment(load.clone());
        for n in 1..=*steps {
            path.advance(n as f64 / *steps as f64, &mut ())?;
        }
    }
    Ok(path.state().clone())
}

/// Records the energies of pseudo-time schemes and of relaxation from rest against Newton's method along the path.
pub fn schemes(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = small_tube(12);
    let problem = model.problem(1);
    let segments = [
        (activation(&model, 0.9, 1.0), 5),
        (activation(&model, 0.9, 1.01), 2),
    ];
    let direct = energy(&problem, &follow(&problem, tight_settings(), &segments)?);
    recorder.case("contracting tube, small mesh")?;
    for (name, integrator) in [
        ("the paper's Newmark scheme", Integrator::Newmark),
        ("backward Euler", Integrator::BackwardEuler),
    ] {
        recorder.check_cancelled()?;
        let settings = Settings {
            scheme: Scheme::PseudoTime(PseudoTime {
                integrator,
                ..PseudoTime::default()
            }),
            ..Settings::default()
        };
        let damped = energy(&problem, &follow(&problem, settings, &segments)?);
        recorder.relative(
            1e-8,
            format!("W, {name}"),
            damped,
            (direct, "Newton's method along the path"),
        );
    }
    let rest = vec![0.0; problem.tube.unknowns()];
    let relaxed = plica::solve::relaxation(
        &problem,
        &segments[1].0,
        rest,
        &tight_settings(),
        &mut Effort::default(),
        &mut (),
    )
    .map_err(|e| VerificationError::Solve(e.to_string()))?;
    let relaxed = relaxed.forces.energy * problem.tube.sector.repeats();
    let quantity = "W, relaxation from rest in one step";
    recorder.relative(
        1e-8,
        quantity,
        relaxed,
        (direct, "Newton's method along the path"),
    );
    Ok(())
}

/// Records the numbers of values whose bits differ between one thread and several.
pub fn threads(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = small_tube(12);
    let problem = model.problem(12);
    let load = activation(&model, 0.8, 1.05);
    let u: Vec<f64> = wave_field(&problem, 0.1).iter().map(|u| 2e-3 * u).collect();
    let d = wave_field(&problem, 0.7);
    let evaluate = |threads: usize| -> Result<(f64, Vec<f64>, Vec<f64>), VerificationError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| VerificationError::Solve(e.to_string()))?;
        pool.install(|| {
            let forces = problem.forces(&load, &u)?;
            let mut product = vec![0.0; u.len()];
            problem
                .tangent(&load, &u)
                .multiply_add(1.0, &d, &mut product);
            Ok((forces.energy, forces.residual, product))
        })
    };
    let one = evaluate(1)?;
    recorder.case("12 rings on several threads")?;
    for threads in [2, 3] {
        let other = evaluate(threads)?;
        let pairs = one.1.iter().zip(&other.1).chain(one.2.iter().zip(&other.2));
        let differ = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        let differ = differ + usize::from(one.0.to_bits() != other.0.to_bits());
        let quantity = format!("values that differ, {threads} threads");
        recorder.zero(0.0, quantity, differ as f64, "one thread");
    }
    Ok(())
}
