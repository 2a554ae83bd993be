//! Rings in plane strain: under pressure, grown, and about to buckle.

use super::found::{Findings, Trouble};
use super::one_dimension::{Balanced, Resistance, Wall, first};
use super::specimen::{Specimen, energy, lost, stress, swelling, under};
use plica::activation::Direction;
use plica::equilibrium::TubeProblem;
use plica::material::{Material, NeoHookean, Volumetric};
use plica::solve::State;
use plica::tube::Load;
use plica_view::draw::{Chart, Curve, Stroke};
use std::f64::consts::PI;

const A: f64 = 0.44;
const B: f64 = 0.5;
const NU: f64 = 0.495;
/// The reference of most rows.
const ONE: &str = "one-dimensional solution";

fn wall() -> Wall {
    Wall::new([A, B], NU)
}

/// A ring as Plica finds it.
type Ring<'a> = (&'a TubeProblem, &'a State<Load>);

/// Rows of its radii.
fn radii(
    found: &mut Findings<'_>,
    tolerance: f64,
    (problem, state): Ring<'_>,
    balanced: &Balanced,
) {
    for ((name, R), r) in [("a", A), ("b", B)].into_iter().zip(balanced.radii()) {
        let radius = R + swelling(problem, state, R);
        found.within(tolerance, name, radius, (r, ONE));
    }
}

/// Rows of its stresses around.
fn stresses(found: &mut Findings<'_>, (problem, state): Ring<'_>, balanced: &Balanced) {
    for ((name, R), sigma) in [("a", A), ("b", B)].into_iter().zip(balanced.stress()) {
        let around = stress(problem, state, R)[2];
        found.within(1e-4, format!("σθ({name})"), around, (sigma[1], ONE));
    }
}

/// Displacements and stresses of a ring under a small pressure from inside: Lamé.
pub fn lame(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::ring(B - A, NU, 8);
    let problem = specimen.problem(1);
    let p = 1e-7;
    let state = under(&problem, &specimen.pressed([p, 0.0]), 1)?;
    // Plane strain: u = (1 + ν)/E · p A²/(B² − A²) · ((1 − 2ν) R + B²/R).
    let c = A * A / (B * B - A * A);
    let u = |R: f64| (1.0 + NU) * c * ((1.0 - 2.0 * NU) * R + B * B / R);
    let around = |R: f64| c * (1.0 + B * B / (R * R));
    found.case("ring, small pressure inside")?;
    for (name, R) in [("A", A), ("B", B)] {
        let lame = "Lamé";
        let moved = swelling(&problem, &state, R) / p;
        found.within(1e-5, format!("u({name})/p"), moved, (u(R), lame));
        let sigma = stress(&problem, &state, R);
        found.within(
            1e-4,
            format!("σθ({name})/p"),
            sigma[2] / p,
            (around(R), lame),
        );
        if R == A {
            found.within(1e-4, "σz(A)/p", sigma[0] / p, (2.0 * NU * c, lame));
        }
    }
    Ok(())
}

/// A ring blown up by true pressure.
pub fn inflation(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::ring(B - A, NU, 8);
    let problem = specimen.problem(1);
    for (swollen, p, steps) in [(1.1, 0.0122352033, 2), (1.5, 0.0329557773, 6)] {
        let pressures = [p, 0.0];
        let balanced = Wall {
            pressures,
            ..wall()
        }
        .balance(8)?;
        let state = under(&problem, &specimen.pressed(pressures), steps)?;
        found.case(format!("ring, p = {p} inside (a/A = {swollen})"))?;
        radii(found, 1e-5, (&problem, &state), &balanced);
        stresses(found, (&problem, &state), &balanced);
    }
    Ok(())
}

/// The same of a wall that resists a change of volume by λ/4 (J² − 1 − 2 ln J), compressible enough to show it.
pub fn quadratic(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let nu = 0.3;
    let mut specimen = Specimen::ring(B - A, nu, 8);
    specimen.tube.material = Material::NeoHookean(NeoHookean {
        volumetric: Volumetric::Quadratic,
        ..NeoHookean::new(1.0, nu)
    });
    let problem = specimen.problem(1);
    for p in [0.02, 0.03] {
        let pressures = [p, 0.0];
        let wall = Wall {
            resistance: Resistance::Square,
            pressures,
            ..Wall::new([A, B], nu)
        };
        let balanced = wall.balance(8)?;
        let state = under(&problem, &specimen.pressed(pressures), 6)?;
        found.case(format!("ring, quadratic law, ν = 0.3, p = {p} inside"))?;
        let [a, b] = balanced.radii();
        let radius = |R: f64| R + swelling(&problem, &state, R);
        found.within(1e-5, "a", radius(A), (a, ONE));
        found.within(1e-5, "b", radius(B), (b, ONE));
        let W = energy(&problem, &state) / specimen.tube.length;
        let work = p * PI * (a * a - A * A);
        found.within(
            1e-5,
            "W − p ΔV over length",
            W,
            (balanced.energy() - work, ONE),
        );
        let sigma = stress(&problem, &state, A)[2];
        found.within(1e-4, "σθ(a)", sigma, (balanced.stress()[0][1], ONE));
    }
    Ok(())
}

/// A closed ring whose wall has grown around: residual stress.
pub fn growth(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::ring(B - A, NU, 20).with_even_muscle(Direction::Circular);
    let problem = specimen.problem(1);
    for g in [0.75, 0.5] {
        let grown = [g, 1.0];
        let balanced = Wall { grown, ..wall() }.balance(8)?;
        let load = Load {
            muscles: vec![g],
            ..specimen.tube.rest()
        };
        let state = under(&problem, &load, 5)?;
        found.case(format!("closed ring, θη = {g}"))?;
        radii(found, 1e-6, (&problem, &state), &balanced);
        let W = energy(&problem, &state) / specimen.tube.length;
        found.within(1e-6, "W over length", W, (balanced.energy(), ONE));
        stresses(found, (&problem, &state), &balanced);
    }
    Ok(())
}

/// Where a ring under true pressure from outside loses harmonic n.
fn critical(wall: Wall, n: usize, guess: f64) -> Result<f64, Trouble> {
    let negative = |p: f64| {
        let pressures = [0.0, p];
        Wall { pressures, ..wall }
            .balance(1)
            .map(|balanced| balanced.negative(n, 0.0))
    };
    Ok(first(0.0, 2.0 * guess, negative)?)
}

/// (n² − 1) E h³ / (12 (1 − ν²) R³), R the middle radius.
fn thin_ring(h: f64, nu: f64, n: usize) -> f64 {
    let n = n as f64;
    (n * n - 1.0) * (h / (B - 0.5 * h)).powi(3) / (12.0 * (1.0 - nu * nu))
}

/// Rings under pressure from outside turn oval, three- and four-lobed.
pub fn buckling(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::ring(B - A, NU, 8);
    let problem = specimen.problem(1);
    found.case("ring, true pressure outside, H = 0.06")?;
    for n in [2, 3, 4] {
        let p = critical(wall(), n, thin_ring(B - A, NU, n))?;
        let load = specimen.pressed([0.0, p]);
        let computed = p * lost(&problem, &load, n, [0.9, 1.05])?;
        found.within(1e-4, format!("critical p, n = {n}"), computed, (p, ONE));
    }
    Ok(())
}

/// Thinner and thinner, a ring buckles as a thin ring does.
pub fn thin_limit(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let nu = 0.3;
    let walls = [0.08, 0.04, 0.02, 0.01];
    let mut curves = vec![];
    for n in [2, 3] {
        let mut ratios = vec![];
        for h in walls {
            let thin = thin_ring(h, nu, n);
            let p = critical(Wall::new([B - h, B], nu), n, thin)?;
            let specimen = Specimen::ring(h, nu, 4);
            let problem = specimen.problem(1);
            found.case(format!("ring, true pressure outside, H = {h}, ν = 0.3"))?;
            let computed = p * lost(&problem, &specimen.pressed([0.0, p]), n, [0.9, 1.05])?;
            found.within(1e-4, format!("critical p, n = {n}"), computed, (p, ONE));
            ratios.push((h, computed / thin));
        }
        let limit = limit(&ratios[1..]);
        found.case("thinner and thinner ring")?;
        let quantity = format!("p over that of a thin ring, H → 0, n = {n}");
        found.within(2e-3, quantity, limit, (1.0, "(n²−1) E h³/(12(1−ν²)R³)"));
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
    found.picture(
        "thin-ring.png",
        "Critical pressure of a ring over that of a thin ring, (n² − 1) E h³/(12(1 − ν²)R³), as its wall thins; at H = 0 \
         what the thinnest three extrapolate to.",
        Chart {
            x_label: "*H*/*D*".into(),
            y_label: "*p*/*p*_{thin}".into(),
            curves,
            ..Chart::default()
        },
    );
    Ok(())
}

/// Where a parabola through three points, each at half the place of the one before, is at zero.
pub(super) fn limit(points: &[(f64, f64)]) -> f64 {
    let [(_, c), (_, b), (_, a)] = [points[0], points[1], points[2]];
    // f(h) = f₀ + f₁ h + f₂ h² at 4, 2 and 1.
    (8.0 * a - 6.0 * b + c) / 3.0
}
