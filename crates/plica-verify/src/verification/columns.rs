//! Tubes between plates that come closer: ovals, wrinkles, columns.

use super::found::{Findings, Trouble};
use super::one_dimension::{Wall, first};
use super::rings::limit;
use super::specimen::{Specimen, lost};
use plica_view::draw::{Chart, Curve, Stroke};
use std::f64::consts::PI;

const NU: f64 = 0.495;
const B: f64 = 0.5;
const ONE: &str = "one-dimensional solution";

/// The strain at which a tube between sliding plates first has a wave n around, and its half waves along.
fn critical(
    wall: Wall,
    length: f64,
    n: usize,
    half_waves: std::ops::RangeInclusive<usize>,
    most: f64,
) -> Result<(f64, usize), Trouble> {
    let mut lowest = (f64::INFINITY, 0);
    for m in half_waves {
        let negative = |strain: f64| {
            let stretch = 1.0 - strain;
            Wall { stretch, ..wall }
                .balance(1)
                .map(|balanced| balanced.negative(n, PI * m as f64 / length))
        };
        if negative(most)? == 0 {
            continue;
        }
        let strain = first(0.0, most, negative)?;
        if strain < lowest.0 {
            lowest = (strain, m);
        }
    }
    Ok(lowest)
}

/// Plica's, near a strain.
fn computed(specimen: &Specimen, n: usize, near: f64) -> Result<f64, Trouble> {
    let problem = specimen.problem(1);
    let mut load = specimen.tube.rest();
    load.ends[1].displacement = -near * specimen.tube.length;
    Ok(near * lost(&problem, &load, n, [0.97, 0.99])?)
}

/// A tube three diameters long turns oval before it wrinkles.
pub fn plates(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::new(3.0, 0.06, NU, [60, 120, 3]);
    found.case("tube, L = 3, between sliding plates")?;
    for (n, most) in [(2, 0.08), (0, 0.09), (3, 0.09)] {
        let wall = Wall::new([B - 0.06, B], NU);
        let (strain, m) = critical(wall, 3.0, n, 1..=16, most)?;
        let name = format!("critical strain, n = {n} (m = {m})");
        found.within(1e-4, name, computed(&specimen, n, strain)?, (strain, ONE));
    }
    Ok(())
}

/// Thinner and thinner, rings form at the classical stress.
pub fn thin_shell(found: &mut Findings<'_>) -> Result<(), Trouble> {
    // At ν = 0.3, where uniaxial stress is E ε but for terms of the size of the strain.
    let nu: f64 = 0.3;
    let walls = if found.full {
        vec![0.04, 0.02, 0.01, 0.005]
    } else {
        vec![0.04, 0.02, 0.01]
    };
    let mut ratios = vec![];
    for &h in &walls {
        let R = B - 0.5 * h;
        let classical = h / R / (3.0 * (1.0 - nu * nu)).sqrt();
        // Half waves are π (R h)^½ / (12 (1 − ν²))^¼ long: eight of them are all that is needed.
        let half_wave = PI * (R * h).sqrt() / (12.0 * (1.0 - nu * nu)).powf(0.25);
        let length = 8.0 * half_wave;
        let wall = Wall::new([B - h, B], nu);
        let (strain, m) = critical(wall, length, 0, 5..=11, 1.3 * classical)?;
        found.case(format!("tube between sliding plates, H = {h}, ν = 0.3"))?;
        let specimen = Specimen::new(length, h, nu, [64, 120, 3]);
        let found_strain = computed(&specimen, 0, strain)?;
        let name = format!("critical strain, n = 0 (m = {m} of L = {length:.4})");
        found.within(1e-4, name, found_strain, (strain, ONE));
        ratios.push((h, found_strain / classical));
    }
    let limit = limit(&ratios[ratios.len() - 3..]);
    found.case("thinner and thinner tube between plates")?;
    found.within(
        5e-3,
        "strain over the classical one, H → 0, n = 0",
        limit,
        (1.0, "h/(R√(3(1−ν²)))"),
    );
    Ok(())
}

/// Longer and longer, a tube buckles as Euler's column.
pub fn column(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let (h, nu) = (0.06, 0.3);
    let a = B - h;
    // I/A of the section.
    let gyration = 0.25 * (a * a + B * B);
    let lengths = [10.0, 20.0, 40.0];
    let mut ratios = vec![];
    for length in lengths {
        let euler = PI * PI * gyration / (length * length);
        let (strain, _) = critical(Wall::new([a, B], nu), length, 1, 1..=1, 1.5 * euler)?;
        found.case(format!(
            "tube between sliding plates, L = {length}, ν = 0.3"
        ))?;
        let specimen = Specimen::new(length, h, nu, [40, 120, 3]);
        let found_strain = computed(&specimen, 1, strain)?;
        found.within(
            1e-4,
            "critical strain, n = 1 (m = 1)",
            found_strain,
            (strain, ONE),
        );
        ratios.push((1.0 / (length * length), found_strain / euler));
    }
    // Linear in 1/L².
    let [_, (x, f), (y, g)] = [ratios[0], ratios[1], ratios[2]];
    let limit = g - y * (f - g) / (x - y);
    found.case("longer and longer tube between plates")?;
    found.within(
        1e-3,
        "strain over Euler's, L → ∞",
        limit,
        (1.0, "π² I/(A L²)"),
    );
    let mut points = vec![(0.0, limit)];
    points.extend(ratios.into_iter().rev());
    found.picture(
        "column.png",
        "Critical strain of a tube between sliding plates over that of Euler's column, π² I/(A L²), as it gets longer; at \
         D/L = 0 what the longest two extrapolate to.",
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
