//! Rings in plane strain: pressure, growth and buckling.

use super::VerificationError;
use super::one_dimension::{Solution, VolumetricEnergy, Wall, critical_load};
use super::report::Recorder;
use super::tube_model::{
    TubeModel, critical_fraction, energy, radial_displacement, solve_from_rest, stress,
};
use plica::activation::Direction;
use plica::equilibrium::TubeProblem;
use plica::material::{Material, MooneyRivlin, NeoHookean, Volumetric};
use plica::solve::State;
use plica::tube::Load;
use plica_view::draw::{Chart, Curve, Stroke};
use std::f64::consts::PI;

const A: f64 = 0.44;
const B: f64 = 0.5;
const NU: f64 = 0.495;
/// Source of most references.
const ONE: &str = "one-dimensional solution";

fn wall() -> Wall {
    Wall::new([A, B], NU)
}

/// A ring solved by Plica.
type Ring<'a> = (&'a TubeProblem, &'a State<Load>);

/// Records its current radii.
fn radii(
    recorder: &mut Recorder<'_>,
    tolerance: f64,
    (problem, state): Ring<'_>,
    solution: &Solution,
) {
    for ((name, R), r) in [("a", A), ("b", B)].into_iter().zip(solution.radii()) {
        let radius = R + radial_displacement(problem, state, R);
        recorder.relative(tolerance, name, radius, (r, ONE));
    }
}

/// Records its circumferential stresses.
fn stresses(recorder: &mut Recorder<'_>, (problem, state): Ring<'_>, solution: &Solution) {
    for ((name, R), sigma) in [("a", A), ("b", B)].into_iter().zip(solution.stress()) {
        let around = stress(problem, state, R)[2];
        recorder.relative(1e-4, format!("σθ({name})"), around, (sigma[1], ONE));
    }
}

/// Records displacements and stresses of a ring under a small internal pressure (Lamé).
pub fn lame(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::ring(B - A, NU, 8);
    let problem = model.problem(1);
    let p = 1e-7;
    let state = solve_from_rest(&problem, &model.under_pressure([p, 0.0]), 1)?;
    // Plane strain: u = (1 + ν)/E · p A²/(B² − A²) · ((1 − 2ν) R + B²/R).
    let c = A * A / (B * B - A * A);
    let u = |R: f64| (1.0 + NU) * c * ((1.0 - 2.0 * NU) * R + B * B / R);
    let hoop_stress = |R: f64| c * (1.0 + B * B / (R * R));
    recorder.case("ring, small internal pressure")?;
    for (name, R) in [("A", A), ("B", B)] {
        let lame = "Lamé";
        let displacement = radial_displacement(&problem, &state, R) / p;
        recorder.relative(1e-5, format!("u({name})/p"), displacement, (u(R), lame));
        let sigma = stress(&problem, &state, R);
        recorder.relative(
            1e-4,
            format!("σθ({name})/p"),
            sigma[2] / p,
            (hoop_stress(R), lame),
        );
        if R == A {
            recorder.relative(1e-4, "σz(A)/p", sigma[0] / p, (2.0 * NU * c, lame));
        }
    }
    Ok(())
}

/// Records radii and stresses of a ring inflated by follower pressure.
pub fn inflation(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::ring(B - A, NU, 8);
    let problem = model.problem(1);
    for (stretch, p, steps) in [(1.1, 0.0122352033, 2), (1.5, 0.0329557773, 6)] {
        let pressures = [p, 0.0];
        let solution = Wall {
            pressures,
            ..wall()
        }
        .solve(8)?;
        let state = solve_from_rest(&problem, &model.under_pressure(pressures), steps)?;
        recorder.case(format!("ring, internal pressure p = {p} (a/A = {stretch})"))?;
        radii(recorder, 1e-5, (&problem, &state), &solution);
        stresses(recorder, (&problem, &state), &solution);
    }
    Ok(())
}

/// Records the inflation of a compressible ring with the volumetric energy λ/4 (J² − 1 − 2 ln J).
pub fn quadratic(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let nu = 0.3;
    let mut model = TubeModel::ring(B - A, nu, 8);
    model.tube.layers[0].material = Material::NeoHookean(NeoHookean {
        volumetric: Volumetric::Quadratic,
        ..NeoHookean::new(1.0, nu)
    });
    let problem = model.problem(1);
    for p in [0.02, 0.03] {
        let pressures = [p, 0.0];
        let wall = Wall {
            volumetric: VolumetricEnergy::Quadratic,
            pressures,
            ..Wall::new([A, B], nu)
        };
        let solution = wall.solve(8)?;
        let state = solve_from_rest(&problem, &model.under_pressure(pressures), 6)?;
        recorder.case(format!(
            "ring, quadratic volumetric energy, ν = 0.3, internal pressure p = {p}"
        ))?;
        let [a, b] = solution.radii();
        let radius = |R: f64| R + radial_displacement(&problem, &state, R);
        recorder.relative(1e-5, "a", radius(A), (a, ONE));
        recorder.relative(1e-5, "b", radius(B), (b, ONE));
        let W = energy(&problem, &state) / model.tube.length;
        let work = p * PI * (a * a - A * A);
        recorder.relative(
            1e-5,
            "W − p ΔV over length",
            W,
            (solution.energy() - work, ONE),
        );
        let sigma = stress(&problem, &state, A)[2];
        recorder.relative(1e-4, "σθ(a)", sigma, (solution.stress()[0][1], ONE));
    }
    Ok(())
}

/// Records radii, energy and residual stresses of a closed ring after circumferential growth.
pub fn growth(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::ring(B - A, NU, 20).with_uniform_muscle(Direction::Circular);
    let problem = model.problem(1);
    for g in [0.75, 0.5] {
        let growth = [g, 1.0];
        let solution = Wall { growth, ..wall() }.solve(8)?;
        let load = Load {
            muscles: vec![g],
            ..model.tube.rest()
        };
        let state = solve_from_rest(&problem, &load, 5)?;
        recorder.case(format!("closed ring, growth θη = {g}"))?;
        radii(recorder, 1e-6, (&problem, &state), &solution);
        let W = energy(&problem, &state) / model.tube.length;
        recorder.relative(1e-6, "W over length", W, (solution.energy(), ONE));
        stresses(recorder, (&problem, &state), &solution);
    }
    Ok(())
}

/// Records a Mooney–Rivlin ring that is stretched along by growth: radii and stresses under internal pressure, and
/// radii, energy and stresses after circumferential growth.
///
/// In plane strain alone I₁ and I₂ of a nearly incompressible wall coincide, and so would the law with the neo-Hookean
/// one. The elastic stretch along the axis, 1/θζ, separates them.
pub fn mooney_rivlin(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let share = 0.3;
    let mut model = TubeModel::ring(B - A, NU, 20)
        .with_uniform_muscle(Direction::Circular)
        .with_uniform_muscle(Direction::Longitudinal);
    model.tube.layers[0].material = Material::MooneyRivlin(MooneyRivlin::new(1.0, NU, share));
    let problem = model.problem(1);
    for (growth, p) in [([1.0, 0.8], 0.01), ([1.0, 0.8], 0.03), ([0.75, 0.8], 0.0)] {
        let pressures = [p, 0.0];
        let wall = Wall {
            growth,
            pressures,
            ..Wall::mooney_rivlin([A, B], NU, share)
        };
        let solution = wall.solve(8)?;
        let load = Load {
            muscles: growth.to_vec(),
            ..model.under_pressure(pressures)
        };
        let state = solve_from_rest(&problem, &load, 6)?;
        let [around, along] = growth;
        let ring = (&problem, &state);
        recorder.case(format!(
            "ring, Mooney–Rivlin, share of I₂ {share}, growth θη = {around}, θζ = {along}, internal pressure p = {p}"
        ))?;
        if p == 0.0 {
            radii(recorder, 1e-6, ring, &solution);
            let W = energy(&problem, &state) / model.tube.length;
            recorder.relative(1e-6, "W over length", W, (solution.energy(), ONE));
        } else {
            radii(recorder, 1e-5, ring, &solution);
        }
        stresses(recorder, ring, &solution);
    }
    Ok(())
}

/// Returns the external follower pressure at which a ring loses stability to circumferential mode n.
fn critical(wall: Wall, n: usize, guess: f64) -> Result<f64, VerificationError> {
    let negative = |p: f64| {
        let pressures = [0.0, p];
        Wall { pressures, ..wall }
            .solve(1)
            .map(|solution| solution.negative_eigenvalues(n, 0.0))
    };
    Ok(critical_load(0.0, 2.0 * guess, negative)?)
}

/// Returns (n² − 1) E h³ / (12 (1 − ν²) R³), the critical pressure of a thin ring of mean radius R.
fn thin_ring(h: f64, nu: f64, n: usize) -> f64 {
    let n = n as f64;
    (n * n - 1.0) * (h / (B - 0.5 * h)).powi(3) / (12.0 * (1.0 - nu * nu))
}

/// Records critical external pressures of a ring for modes of two, three and four lobes.
pub fn buckling(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::ring(B - A, NU, 8);
    let problem = model.problem(1);
    recorder.case("ring, external pressure, H = 0.06")?;
    for n in [2, 3, 4] {
        let p = critical(wall(), n, thin_ring(B - A, NU, n))?;
        let load = model.under_pressure([0.0, p]);
        let computed = p * critical_fraction(&problem, &load, n, [0.9, 1.05])?;
        recorder.relative(1e-4, format!("critical p, n = {n}"), computed, (p, ONE));
    }
    Ok(())
}

/// Records critical external pressures of ever thinner rings and their limit.
pub fn thin_limit(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let nu = 0.3;
    let walls = [0.08, 0.04, 0.02, 0.01];
    let mut curves = vec![];
    for n in [2, 3] {
        let mut ratios = vec![];
        for h in walls {
            let thin = thin_ring(h, nu, n);
            let p = critical(Wall::new([B - h, B], nu), n, thin)?;
            let model = TubeModel::ring(h, nu, 4);
            let problem = model.problem(1);
            recorder.case(format!("ring, external pressure, H = {h}, ν = 0.3"))?;
            let computed =
                p * critical_fraction(&problem, &model.under_pressure([0.0, p]), n, [0.9, 1.05])?;
            recorder.relative(1e-4, format!("critical p, n = {n}"), computed, (p, ONE));
            ratios.push((h, computed / thin));
        }
        let limit = extrapolate(&ratios[1..]);
        recorder.case("ring in the limit of a thin wall")?;
        let quantity = format!("p over that of a thin ring, H → 0, n = {n}");
        recorder.relative(2e-3, quantity, limit, (1.0, "(n²−1) E h³/(12(1−ν²)R³)"));
        curves.push(Curve {
            label: format!("*n* = {n}"),
            points: std::iter::once((0.0, limit))
                .chain(ratios.into_iter().rev())
                .collect(),
            colour: n - 1,
            dots: true,
            ..Curve::default()
        });
    }
    curves.push(Curve {
        points: vec![(0.0, 1.0), (walls[0], 1.0)],
        stroke: Stroke::Dashed,
        ..Curve::default()
    });
    recorder.chart(
        "thin-ring.png",
        "Critical pressure of a ring over that of a thin ring, (n² − 1) E h³/(12(1 − ν²)R³), against wall thickness; at H = 0 \
         the extrapolation of the three thinnest.",
        Chart {
            x_label: "*H*/*D*".into(),
            y_label: "*p*/*p*_{thin}".into(),
            curves,
            ..Chart::default()
        },
    );
    Ok(())
}

/// Extrapolates a parabola through three points, each at half the abscissa of the previous one, to zero.
pub(super) fn extrapolate(points: &[(f64, f64)]) -> f64 {
    let [(_, c), (_, b), (_, a)] = [points[0], points[1], points[2]];
    // f(h) = f₀ + f₁ h + f₂ h² at 4, 2 and 1.
    (8.0 * a - 6.0 * b + c) / 3.0
}
