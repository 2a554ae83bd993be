//! Buckling of tubes compressed between sliding plates: ovals, axisymmetric wrinkles, columns.

use super::VerificationError;
use super::one_dimension::{Wall, critical_load};
use super::report::Recorder;
use super::rings::extrapolate;
use super::tube_model::{TubeModel, critical_fraction};
use plica_view::draw::{Chart, Curve, Stroke};
use std::f64::consts::PI;

const NU: f64 = 0.495;
const B: f64 = 0.5;
const ONE: &str = "one-dimensional solution";

/// Returns the lowest axial strain of at most `most` at which a tube between sliding plates loses stability to
/// circumferential mode n, with its number of axial half waves.
fn critical(
    wall: Wall,
    length: f64,
    n: usize,
    half_waves: std::ops::RangeInclusive<usize>,
    most: f64,
) -> Result<(f64, usize), VerificationError> {
    let mut lowest = (f64::INFINITY, 0);
    for m in half_waves {
        let negative = |strain: f64| {
            let stretch = 1.0 - strain;
            Wall { stretch, ..wall }
                .solve(1)
                .map(|solution| solution.negative_eigenvalues(n, PI * m as f64 / length))
        };
        if negative(most)? == 0 {
            continue;
        }
        let strain = critical_load(0.0, most, negative)?;
        if strain < lowest.0 {
            lowest = (strain, m);
        }
    }
    Ok(lowest)
}

/// Returns the critical strain near a guess, computed by Plica.
fn computed(model: &TubeModel, n: usize, near: f64) -> Result<f64, VerificationError> {
    let problem = model.problem(1);
    let mut load = model.tube.rest();
    load.ends[1].displacement = -near * model.tube.length;
    Ok(near * critical_fraction(&problem, &load, n, [0.97, 0.99])?)
}

/// Records critical strains of a tube three diameters long.
pub fn plates(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let model = TubeModel::new(3.0, 0.06, NU, [60, 120, 3]);
    recorder.case("tube, L = 3, between sliding plates")?;
    for (n, most) in [(2, 0.08), (0, 0.09), (3, 0.09)] {
        let wall = Wall::new([B - 0.06, B], NU);
        let (strain, m) = critical(wall, 3.0, n, 1..=16, most)?;
        let name = format!("critical strain, n = {n} (m = {m})");
        recorder.relative(1e-4, name, computed(&model, n, strain)?, (strain, ONE));
    }
    Ok(())
}

/// Records critical strains of ever thinner tubes for axisymmetric wrinkles and their classical limit.
pub fn thin_shell(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    // At ν = 0.3 uniaxial stress is E ε up to relative terms of the order of the strain.
    let nu: f64 = 0.3;
    let walls = if recorder.full {
        vec![0.04, 0.02, 0.01, 0.005]
    } else {
        vec![0.04, 0.02, 0.01]
    };
    let mut ratios = vec![];
    for &h in &walls {
        let R = B - 0.5 * h;
        let classical = h / R / (3.0 * (1.0 - nu * nu)).sqrt();
        // The length of eight half waves, π (R h)^½ / (12 (1 − ν²))^¼ each.
        let half_wave = PI * (R * h).sqrt() / (12.0 * (1.0 - nu * nu)).powf(0.25);
        let length = 8.0 * half_wave;
        let wall = Wall::new([B - h, B], nu);
        let (strain, m) = critical(wall, length, 0, 5..=11, 1.3 * classical)?;
        recorder.case(format!("tube between sliding plates, H = {h}, ν = 0.3"))?;
        let model = TubeModel::new(length, h, nu, [64, 120, 3]);
        let strain_computed = computed(&model, 0, strain)?;
        let name = format!("critical strain, n = 0 (m = {m} of L = {length:.4})");
        recorder.relative(1e-4, name, strain_computed, (strain, ONE));
        ratios.push((h, strain_computed / classical));
    }
    let limit = extrapolate(&ratios[ratios.len() - 3..]);
    recorder.case("tube between sliding plates in the limit of a thin wall")?;
    recorder.relative(
        5e-3,
        "strain over the classical one, H → 0, n = 0",
        limit,
        (1.0, "h/(R√(3(1−ν²)))"),
    );
    Ok(())
}

/// Records critical strains of ever longer tubes and their limit, Euler's column.
pub fn column(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let (h, nu) = (0.06, 0.3);
    let a = B - h;
    // I/A of the cross-section.
    let gyration = 0.25 * (a * a + B * B);
    let lengths = [10.0, 20.0, 40.0];
    let mut ratios = vec![];
    for length in lengths {
        let euler = PI * PI * gyration / (length * length);
        let (strain, _) = critical(Wall::new([a, B], nu), length, 1, 1..=1, 1.5 * euler)?;
        recorder.case(format!(
            "tube between sliding plates, L = {length}, ν = 0.3"
        ))?;
        let model = TubeModel::new(length, h, nu, [40, 120, 3]);
        let strain_computed = computed(&model, 1, strain)?;
        recorder.relative(
            1e-4,
            "critical strain, n = 1 (m = 1)",
            strain_computed,
            (strain, ONE),
        );
        ratios.push((1.0 / (length * length), strain_computed / euler));
    }
    // Linear in 1/L².
    let [_, (x, f), (y, g)] = [ratios[0], ratios[1], ratios[2]];
    let limit = g - y * (f - g) / (x - y);
    recorder.case("tube between sliding plates in the limit of a long tube")?;
    recorder.relative(
        1e-3,
        "strain over Euler's, L → ∞",
        limit,
        (1.0, "π² I/(A L²)"),
    );
    let mut points = vec![(0.0, limit)];
    points.extend(ratios.into_iter().rev());
    recorder.chart(
        "column.png",
        "Critical strain of a tube between sliding plates over that of Euler's column, π² I/(A L²), against its length; at \
         D/L = 0 the extrapolation of the two longest.",
        Chart {
            x_label: "(*D*/*L*)^{2}".into(),
            y_label: "*ε*/*ε*_{Euler}".into(),
            curves: vec![
                Curve {
                    points,
                    dots: true,
                    ..Curve::default()
                },
                Curve {
                    points: vec![(0.0, 1.0), (0.01, 1.0)],
                    stroke: Stroke::Dashed,
                    ..Curve::default()
                },
            ],
            ..Chart::default()
        },
    );
    Ok(())
}
