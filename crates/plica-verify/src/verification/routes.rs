//! The same answer by a second way through the code.

use super::found::{Findings, Trouble};
use super::specimen::{Specimen, energy, tight, under};
use plica::activation::{Direction, Muscle, Profile};
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean, Volumetric};
use plica::solve::{
    Effort, Equilibrium, Integrator, Path, PseudoTime, Scheme, Settings, Solver, State, Tangent,
};
use plica::tube::{Axial, End, Imperfection, Integration, Load, Part, Push, Shape, Support, Wave};

/// A tube whose middle contracts and relaxes, on a coarse mesh.
fn small(around: usize) -> Specimen {
    let mut specimen = Specimen::new(3.0, 0.06, 0.495, [24, around, 2]);
    specimen.tube.ends = [Support::Fixed; 2];
    for direction in [Direction::Circular, Direction::Longitudinal] {
        specimen.tube.muscles.push(Muscle {
            name: String::new(),
            direction,
            zone: [0.5, 1.5],
            profile: Profile::RaisedCosine,
        });
    }
    specimen
}

/// Contracted to this diameter and grown to this length.
fn driven(specimen: &Specimen, diameter: f64, length: f64) -> Load {
    Load {
        muscles: vec![diameter, length],
        ..specimen.tube.rest()
    }
}

/// A sum of waves, of no symmetry.
fn waves(problem: &TubeProblem, seed: f64) -> Vec<f64> {
    let tube = &problem.tube;
    tube.control_values_from(|z, r, ring| {
        let phi = tube.sector.ring_angle(ring) * tube.sector.repeats();
        [0.0, 1.0, 2.0].map(|i| (2.3 * z + 5.0 * r + (1.0 + i) * phi + seed * (1.0 + i)).sin())
    })
}

/// How the difference between the tangent and the slope of the residual falls with the step.
fn order(problem: &TubeProblem, load: &Load, u: &[f64]) -> Result<f64, Trouble> {
    let d = waves(problem, 0.7);
    let mut exact = vec![0.0; u.len()];
    problem.tangent(load, u).multiply_add(1.0, &d, &mut exact);
    let residual = |h: f64| -> Result<Vec<f64>, Trouble> {
        let at: Vec<f64> = u.iter().zip(&d).map(|(u, d)| u + h * d).collect();
        Ok(problem.forces(load, &at)?.residual)
    };
    let error = |h: f64| -> Result<f64, Trouble> {
        let (after, before) = (residual(h)?, residual(-h)?);
        let off = (0..u.len()).map(|i| ((after[i] - before[i]) / (2.0 * h) - exact[i]).powi(2));
        Ok(off.sum::<f64>().sqrt())
    };
    let h = 2e-4;
    Ok((error(h)? / error(0.5 * h)?).log2())
}

/// Tangents against differences of residuals.
pub fn tangents(found: &mut Findings<'_>) -> Result<(), Trouble> {
    found.case("tangent against differences of the residual")?;
    let whole = small(12);
    let quadratic = {
        let mut specimen = small(12);
        specimen.tube.material = Material::NeoHookean(NeoHookean {
            volumetric: Volumetric::Quadratic,
            ..NeoHookean::new(1.0, 0.495)
        });
        specimen
    };
    let imperfect = {
        let mut specimen = small(12);
        specimen.tube.imperfections.push(Imperfection {
            of: Part::Geometry,
            amplitude: 0.01,
            shape: Shape::Wave(Wave::new(2, 0.3, Axial::HalfWaves(1))),
        });
        specimen
    };
    let reduced = Specimen {
        volumetric: Integration::Reduced,
        ..small(12)
    };
    for (name, specimen, rings) in [
        ("axisymmetric", &whole, 1),
        ("threefold", &whole, 4),
        ("no symmetry", &whole, 12),
        ("quadratic law", &quadratic, 12),
        ("imperfect geometry", &imperfect, 12),
        ("reduced integration", &reduced, 12),
    ] {
        found.resume()?;
        let problem = specimen.problem(rings);
        let mut load = driven(specimen, 0.8, 1.05);
        load.pressures = specimen.pressed([1e-3, 2e-3]).pressures;
        let u: Vec<f64> = waves(&problem, 0.1).iter().map(|u| 2e-3 * u).collect();
        let order = order(&problem, &load, &u)?;
        let quantity = format!("order of the difference, {name}");
        found.row(
            quantity,
            order,
            (2.0, "central differences"),
            super::Tolerance::Absolute(0.1),
        );
    }
    Ok(())
}

/// A tangent is solved with by conjugate gradients around the harmonic solver, and by a factorisation of the
/// assembled matrix.
pub fn solvers(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let mut oval = small(12);
    oval.tube.imperfections.push(Imperfection {
        of: Part::End(End::Colon, Push::Across),
        amplitude: 0.05,
        shape: Shape::Wave(Wave::new(2, 0.3, Axial::HalfWaves(1))),
    });
    found.case("tangent of 12 rings, solved with twice")?;
    for (name, specimen) in [("a round state", small(12)), ("an oval one", oval)] {
        let problem = specimen.problem(12);
        let load = driven(&specimen, 0.8, 1.02);
        let u = under(&problem, &load, 3)?.u;
        let b = waves(&problem, 0.4);
        let tangent = problem.tangent(&load, &u);
        let mut harmonic = b.clone();
        for (x, given) in harmonic.iter_mut().zip(problem.prescribed()) {
            *x = if *given { 0.0 } else { *x };
        }
        let mut direct = harmonic.clone();
        let solver = tangent
            .shifted(0.0)
            .map_err(|e| Trouble::Solve(e.to_string()))?;
        let solved = solver
            .solve(&mut harmonic, 1e-10, &())
            .map_err(|_| Trouble::Solve("negative curvature".into()))?;
        let mut matrix = problem.tube.tangent(&load, &u);
        matrix.constrain(problem.prescribed());
        let factor = matrix.factor().map_err(|e| Trouble::Solve(e.to_string()))?;
        factor.solve(&mut direct);
        let size = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let off: Vec<f64> = harmonic.iter().zip(&direct).map(|(a, b)| a - b).collect();
        let off = size(&off) / size(&direct);
        let quantity = format!("difference at {name}, {} iteration(s)", solved.iterations);
        found.nothing(
            1e-5,
            quantity,
            off,
            "direct factorisation (the product keeps single precision)",
        );
    }
    Ok(())
}

/// The same path with one ring, a fold of them, and all.
pub fn symmetries(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = small(12);
    let load = driven(&specimen, 0.7, 1.03);
    let mut energies = vec![];
    for rings in [1, 4, 12] {
        found.resume()?;
        let problem = specimen.problem(rings);
        energies.push(energy(&problem, &under(&problem, &load, 4)?));
    }
    found.case("contracting tube, small mesh")?;
    let axisymmetric = (energies[0], "axisymmetric");
    found.within(1e-8, "W, threefold", energies[1], axisymmetric);
    found.within(1e-8, "W, no symmetry", energies[2], axisymmetric);
    Ok(())
}

fn lead(
    problem: &TubeProblem,
    settings: Settings,
    segments: &[(Load, usize)],
) -> Result<State<Load>, Trouble> {
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

/// The paper's pseudo-time scheme, a drag that stays, and relaxation from afar, against Newton.
pub fn schemes(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = small(12);
    let problem = specimen.problem(1);
    let segments = [
        (driven(&specimen, 0.9, 1.0), 5),
        (driven(&specimen, 0.9, 1.01), 2),
    ];
    let direct = energy(&problem, &lead(&problem, tight(), &segments)?);
    found.case("contracting tube, small mesh")?;
    for (name, integrator) in [
        ("the paper's Newmark scheme", Integrator::Newmark),
        ("backward Euler", Integrator::BackwardEuler),
    ] {
        found.resume()?;
        let settings = Settings {
            scheme: Scheme::PseudoTime(PseudoTime {
                integrator,
                ..PseudoTime::default()
            }),
            ..Settings::default()
        };
        let damped = energy(&problem, &lead(&problem, settings, &segments)?);
        found.within(
            1e-8,
            format!("W, {name}"),
            damped,
            (direct, "Newton along the path"),
        );
    }
    let rest = vec![0.0; problem.tube.unknowns()];
    let mut effort = Effort::default();
    let relaxed = plica::solve::relaxation(
        &problem,
        &segments[1].0,
        rest,
        &tight(),
        &mut effort,
        &mut (),
    )
    .map_err(|e| Trouble::Solve(e.to_string()))?;
    let relaxed = relaxed.forces.energy * problem.tube.sector.repeats();
    let quantity = "W, relaxation from rest in one step";
    found.within(1e-8, quantity, relaxed, (direct, "Newton along the path"));
    Ok(())
}

/// One thread and several: the same bits.
pub fn threads(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = small(12);
    let problem = specimen.problem(12);
    let load = driven(&specimen, 0.8, 1.05);
    let u: Vec<f64> = waves(&problem, 0.1).iter().map(|u| 2e-3 * u).collect();
    let d = waves(&problem, 0.7);
    let by = |threads: usize| -> Result<(f64, Vec<f64>, Vec<f64>), Trouble> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|e| Trouble::Solve(e.to_string()))?;
        pool.install(|| {
            let forces = problem.forces(&load, &u)?;
            let mut product = vec![0.0; u.len()];
            problem
                .tangent(&load, &u)
                .multiply_add(1.0, &d, &mut product);
            Ok((forces.energy, forces.residual, product))
        })
    };
    let one = by(1)?;
    found.case("12 rings by several threads")?;
    for threads in [2, 3] {
        let other = by(threads)?;
        let pairs = one.1.iter().zip(&other.1).chain(one.2.iter().zip(&other.2));
        let differ = pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        let differ = differ + usize::from(one.0.to_bits() != other.0.to_bits());
        let quantity = format!("numbers that differ from one thread's, {threads} threads");
        found.nothing(0.0, quantity, differ as f64, "bit for bit");
    }
    Ok(())
}
