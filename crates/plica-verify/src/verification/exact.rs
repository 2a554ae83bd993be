//! Identities that hold to rounding: rest, stress-free growth, rigid motion, rotated muscles; and the splines.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, energy, solve_from_rest};
use plica::activation::Direction;
use plica::assembly::Point;
use plica::assembly::SplineTube;
use plica::matrix::BlockBanded;
use plica::spline::{Basis, gauss_legendre};
use plica::tube::{Axial, Imperfection, Load, Part, Shape, Support, Wave};

/// Relative error due to rounding.
const ROUNDING: f64 = 1e-12;

/// Records energy and length of a tube with a free end that grows uniformly along its axis without stress.
pub fn free_growth(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    for (rings, name) in [(1, "axisymmetric"), (12, "no symmetry")] {
        let mut model = TubeModel::new(1.0, 0.06, 0.495, [8, 12, 2]);
        model.tube.ends = [Support::Fixed, Support::Free];
        // The fixed end would hinder circumferential growth, but not axial growth.
        let model = model.with_uniform_muscle(Direction::Longitudinal);
        let problem = model.problem(rings);
        let theta = 1.3;
        let load = Load {
            muscles: vec![theta],
            ..model.tube.rest()
        };
        let state = solve_from_rest(&problem, &load, 3)?;
        recorder.case(format!("tube with a free end, growth θζ = {theta}, {name}"))?;
        recorder.zero(1e-14, "W", energy(&problem, &state), "stress-free growth");
        let at = Point {
            z: 1.0,
            radius: 0.5,
            angle: 0.1,
        };
        let end = problem.tube.sample(&state.load, &state.u, at).position[0];
        recorder.relative(ROUNDING, "length", end, (theta, "stress-free growth"));
    }
    Ok(())
}

/// Records the energy and the residual of an active tube before and after a rigid motion.
pub fn objectivity(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model =
        TubeModel::new(1.0, 0.1, 0.495, [8, 12, 2]).with_uniform_muscle(Direction::Circular);
    let tube = model.problem(12).tube;
    let load = Load {
        muscles: vec![0.8],
        ..model.tube.rest()
    };
    // Waves without symmetry, then a rotation about a transverse axis and a translation.
    let wavy = |z: f64, r: f64, phi: f64| {
        [
            0.03 * (2.0 * z + phi).sin(),
            0.04 * (3.0 * z + 2.0 * phi).cos() * r,
            0.03 * (z - phi).sin(),
        ]
    };
    let (sin, cos) = 0.9_f64.sin_cos();
    let moved = |[z, x, y]: [f64; 3]| [cos * z - sin * x + 0.3, sin * z + cos * x - 0.2, y + 0.1];
    let control = tube.circle.control_radius;
    let displacement = |rigid_motion: bool| {
        tube.control_values_from(|z, r, ring| {
            let phi = tube.sector.ring_angle(ring);
            let (s, c) = phi.sin_cos();
            let [along, outwards, around] = wavy(z, r, phi);
            if !rigid_motion {
                return [along, outwards, around];
            }
            let r = r * control;
            let (x, y) = (r + outwards, around);
            let at = moved([z + along, c * x - s * y, s * x + c * y]);
            // In the local components of the ring, from the reference position.
            [at[0] - z, c * at[1] + s * at[2] - r, -s * at[1] + c * at[2]]
        })
    };
    let [before, after] = [false, true].map(|rigid| tube.forces(&load, &displacement(rigid)));
    let (before, after) = (before?, after?);
    let norm = |residual: &[f64]| residual.iter().map(|r| r * r).sum::<f64>().sqrt();
    let source = "before the motion";
    recorder.case("active tube after a rigid motion")?;
    recorder.relative(ROUNDING, "W", after.energy, (before.energy, source));
    recorder.relative(
        ROUNDING,
        "norm of the residual",
        norm(&after.residual),
        (norm(&before.residual), source),
    );
    Ok(())
}

/// Records the energy of a tube with an uneven muscle that is rotated by one ring and by half a ring.
pub fn muscle_rotation(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let mut model =
        TubeModel::new(1.0, 0.1, 0.495, [8, 12, 2]).with_uniform_muscle(Direction::Circular);
    model.tube.ends = [Support::Fixed; 2];
    let load = Load {
        muscles: vec![0.8],
        ..model.tube.rest()
    };
    let mut energies = vec![];
    for rotation in [0.0, 1.0, 0.5] {
        let angle = 0.3 + rotation * std::f64::consts::TAU / 12.0;
        model.tube.imperfections = vec![Imperfection {
            of: Part::Muscle(0),
            amplitude: 0.3,
            shape: Shape::Wave(Wave::new(1, angle, Axial::HalfWaves(1))),
        }];
        let problem = model.problem(12);
        energies.push(energy(&problem, &solve_from_rest(&problem, &load, 1)?));
    }
    recorder.case("tube with an uneven muscle, 12 rings")?;
    let before = (energies[0], "before the rotation");
    recorder.relative(1e-10, "W, muscle rotated by a ring", energies[1], before);
    recorder.relative(
        1e-6,
        "W, muscle rotated by half a ring",
        energies[2],
        before,
    );
    Ok(())
}

/// Records the error of the spline circle and the orders of convergence of projections on splines.
pub fn splines(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("spline circle")?;
    let unevenness = |around: usize| {
        let model = TubeModel::new(1.0, 0.06, 0.495, [1, around, 1]);
        let problem = model.problem(1);
        let rest = vec![0.0; problem.tube.unknowns()];
        let radii = (0..=50).map(|i| {
            let angle = f64::from(i) / 50.0 * std::f64::consts::TAU / around as f64;
            let at = Point {
                z: 0.5,
                radius: 0.5,
                angle,
            };
            let [_, x, y] = problem.tube.sample(&model.tube.rest(), &rest, at).position;
            x.hypot(y)
        });
        let (low, high) = radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| {
            (low.min(r), high.max(r))
        });
        (high - low) / 0.5
    };
    let error = unevenness(60);
    let quantity = "largest difference of radii over the radius, 60 cubics";
    recorder.row(
        quantity,
        error,
        (3.1e-7, "prototype, two digits"),
        super::Tolerance::Absolute(0.06e-7),
    );
    let order = (error / unevenness(120)).log2();
    recorder.row(
        "order of convergence",
        order,
        (4.0, "p + 1"),
        super::Tolerance::Absolute(0.05),
    );
    recorder.case("L2 projection of a wave on splines")?;
    for degree in 1..=4 {
        let order = (projection(degree, 16)? / projection(degree, 32)?).log2();
        let quantity = format!("order of convergence, p = {degree}");
        let expected = (degree as f64 + 1.0, "p + 1");
        recorder.row(quantity, order, expected, super::Tolerance::Absolute(0.1));
    }
    Ok(())
}

/// Returns the L2 error of the L2 projection of a wave on splines.
fn projection(degree: usize, elements: usize) -> Result<f64, VerificationError> {
    let breakpoints: Vec<f64> = (0..=elements).map(|e| e as f64 / elements as f64).collect();
    let basis = Basis::open(degree, &breakpoints);
    let wave = |x: f64| (5.0 * x + 0.3).sin();
    let mut mass = BlockBanded::zeros(basis.functions(), 1, degree);
    let mut control = vec![0.0; basis.functions()];
    let points: Vec<(f64, f64)> = breakpoints
        .windows(2)
        .flat_map(|ends| {
            let h = ends[1] - ends[0];
            let scaled = move |(x, w): (f64, f64)| (ends[0] + h * x, h * w);
            gauss_legendre(degree + 4).into_iter().map(scaled)
        })
        .collect();
    for &(x, weight) in &points {
        let at = basis.evaluate(x);
        for (a, n) in at.value.iter().enumerate() {
            control[at.first + a] += weight * n * wave(x);
            for (b, m) in at.value.iter().enumerate().skip(a) {
                mass.add_at(at.first + a, b - a, 0, 0, weight * n * m);
            }
        }
    }
    let factor = mass
        .factor()
        .map_err(|e| VerificationError::Solve(e.to_string()))?;
    factor.solve(&mut control);
    let squares = points.iter().map(|&(x, weight)| {
        let at = basis.evaluate(x);
        let values = at.value.iter().zip(&control[at.first..]);
        let value: f64 = values.map(|(n, c)| n * c).sum();
        weight * (value - wave(x)).powi(2)
    });
    Ok(squares.sum::<f64>().sqrt())
}

/// Records energy, residual and volume of a tube at rest.
pub fn rest(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::new(3.0, 0.06, 0.495, [4, 60, 2]);
    let tube: &SplineTube = &model.problem(1).tube;
    let forces = tube.forces(&model.tube.rest(), &vec![0.0; tube.unknowns()])?;
    recorder.case("tube at rest")?;
    recorder.zero(1e-16, "W", forces.energy, "no stress");
    let largest = forces
        .residual
        .iter()
        .fold(0.0_f64, |most, r| most.max(r.abs()));
    recorder.zero(1e-15, "largest residual", largest, "no stress");
    // The mass matrix ∫ N N dV₀ applied to a unit axial displacement gives the volume.
    let along = tube.control_values_from(|_, _, _| [1.0, 0.0, 0.0]);
    let mut product = vec![0.0; along.len()];
    tube.damping().multiply_add(1.0, &along, &mut product);
    let volume: f64 = along.iter().zip(&product).map(|(u, m)| u * m).sum();
    let (a, b) = (model.tube.inner_radius(), 0.5);
    let exact = std::f64::consts::PI * (b * b - a * a) * model.tube.length;
    let volume = volume * tube.sector.repeats();
    recorder.relative(1e-10, "volume", volume, (exact, "π (B² − A²) L"));
    Ok(())
}
