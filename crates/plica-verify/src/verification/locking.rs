//! Volumetric locking of a thick, nearly incompressible wall, and reduced integration against it.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, energy, radial_displacement, solve_from_rest};
use plica::activation::{Direction, Muscle, Profile};
use plica::tube::{Integration, Load, Support};
use plica_view::draw::{Chart, Curve, Stroke};

/// Radii 3 and 9 of the usual benchmark, scaled to D = 1.
const A: f64 = 0.5 / 3.0;
const B: f64 = 0.5;

/// Returns the relative error of u(A) against Lamé's solution.
fn error(
    nu: f64,
    degree: usize,
    through: usize,
    volumetric: Integration,
) -> Result<f64, VerificationError> {
    // A polygon of 4000 chords approximates a circle to 3e-7.
    let around = if degree == 1 { 4000 } else { 240 };
    let model = TubeModel {
        degree,
        volumetric,
        ..TubeModel::new(0.1, B - A, nu, [1, around, through])
    };
    let problem = model.problem(1);
    let p = 1e-8;
    let state = solve_from_rest(&problem, &model.under_pressure([p, 0.0]), 1)?;
    Ok(radial_displacement(&problem, &state, A) / (p * lame(nu)) - 1.0)
}

/// Returns u(A)/(p D) of Lamé's solution.
fn lame(nu: f64) -> f64 {
    let c = A * A / (B * B - A * A);
    (1.0 + nu) * c * ((1.0 - 2.0 * nu) * A + B * B / A)
}

/// Records the radial displacement of the thick cylinder with full and with reduced integration.
pub fn thick_cylinder(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    const THROUGH: [usize; 5] = [1, 2, 4, 8, 16];
    let nu = 0.4999;
    let mut curves = vec![];
    for (volumetric, stroke, name) in [
        (Integration::Full, Stroke::Dashed, "full"),
        (Integration::Reduced, Stroke::Solid, "reduced"),
    ] {
        for degree in [1, 2, 3] {
            recorder.check_cancelled()?;
            if degree < 3 && volumetric == Integration::Reduced {
                continue;
            }
            let points = THROUGH.map(|through| {
                let error = error(nu, degree, through, volumetric)?;
                Ok((f64::from(through as u32).log2(), error.abs().log10()))
            });
            curves.push(Curve {
                label: format!("*p* = {degree}, {name}"),
                points: points
                    .into_iter()
                    .collect::<Result<_, VerificationError>>()?,
                colour: degree,
                stroke,
                dots: true,
            });
        }
    }
    for nu in [0.49, 0.499, 0.4999] {
        recorder.case(format!(
            "thick cylinder, A = 3, B = 9 (in these units), pressure E/1000, ν = {nu}"
        ))?;
        // In the units of the benchmark: E = 1000, p = 1, D = 18.
        let exact = 18.0 * lame(nu) * 1e-3;
        for (degree, volumetric, name, tolerance) in [
            (3, Integration::Full, "full", 1e-4),
            (3, Integration::Reduced, "reduced", 1e-5),
        ] {
            let computed = exact * (1.0 + error(nu, degree, 16, volumetric)?);
            let quantity = format!("u(A), degree {degree}, 16 elements, {name} integration");
            recorder.relative(tolerance, quantity, computed, (exact, "Lamé"));
        }
        // Without locking the error of a coarse mesh does not depend on ν.
        let computed = exact * (1.0 + error(nu, 3, 4, Integration::Reduced)?);
        let quantity = "u(A), degree 3, 4 elements, reduced integration";
        recorder.relative(1e-4, quantity, computed, (exact, "Lamé"));
    }
    recorder.chart(
        "locking.png",
        "Thick cylinder, ν = 0.4999: relative error of u(A) against elements through the wall, with full (dashed) and reduced \
         (solid; degree 3) integration of the volumetric energy.",
        Chart {
            x_label: "log_{2} elements".into(),
            y_label: "log_{10} error of *u*(*A*)".into(),
            curves,
            width_pt: 360.0,
            ..Chart::default()
        },
    );
    Ok(())
}

/// Records the energy of a contracted thick, nearly incompressible tube with one element through its wall.
pub fn contraction(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let W = |elements: [usize; 3], volumetric: Integration| -> Result<f64, VerificationError> {
        let mut model = TubeModel {
            volumetric,
            ..TubeModel::new(3.0, 0.2, 0.4999, elements)
        };
        model.tube.ends = [Support::Fixed; 2];
        model.tube.muscles.push(Muscle::new(
            String::new(),
            Direction::Circular,
            [0.5, 2.5],
            Profile::RaisedCosine,
        ));
        let load = Load {
            muscles: vec![0.6],
            ..model.tube.rest()
        };
        let problem = model.problem(1);
        Ok(energy(&problem, &solve_from_rest(&problem, &load, 4)?))
    };
    recorder.case("thick tube contracted to 0.6, ν = 0.4999")?;
    let fine = W([80, 60, 10], Integration::Full)?;
    recorder.check_cancelled()?;
    let reduced = W([30, 60, 1], Integration::Reduced)?;
    let source = "Plica, 80 × 10 elements, full integration";
    recorder.relative(
        1e-2,
        "W, 30 × 1 elements, reduced integration",
        reduced,
        (fine, source),
    );
    Ok(())
}
