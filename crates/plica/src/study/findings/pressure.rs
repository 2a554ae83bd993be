//! Maxima and minima of the pressure in a driven lumen.

use super::place::{Path, Place};
use serde::Serialize;

/// A maximum or a minimum of the pressure inside a stage, in a run that drives the volume of the lumen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PressureExtreme {
    /// The state that is nearest.
    pub at: Place,
    /// The pressure, of the parabola through three states.
    pub pressure: f64,
    /// The volume of the lumen there.
    pub volume: f64,
    /// True for a maximum, false for a minimum.
    pub is_maximum: bool,
}

/// Difference of pressures, relative to the largest on the path, up to which they are equal.
const ROUNDING: f64 = 1e-7;

/// Returns the extremes of the pressure inside the stages of a run that drives the volume of the lumen.
pub(super) fn extremes(path: &Path<'_>) -> Vec<PressureExtreme> {
    let pressures: Option<Vec<f64>> = path.rows.iter().map(|row| row.lumen_pressure).collect();
    let Some(pressures) = pressures else {
        return vec![];
    };
    let largest = pressures.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
    let mut found = vec![];
    for part in &path.parts {
        let [first, last] = [part.rows[0].saturating_sub(1), part.rows[1]];
        for i in first + 1..last {
            let [before, after] = [i - 1, i + 1].map(|j| pressures[i] - pressures[j]);
            let smallest = before.abs().min(after.abs());
            if before * after > 0.0 && smallest > ROUNDING * largest {
                let points = [i - 1, i, i + 1].map(|j| [path.rows[j].lumen_volume, pressures[j]]);
                let [volume, pressure] = vertex(points);
                found.push(PressureExtreme {
                    at: path.place(i),
                    pressure,
                    volume,
                    is_maximum: before > 0.0,
                });
            }
        }
    }
    found
}

/// Returns the vertex of the parabola through three points; the middle one if they have no order.
fn vertex([a, b, c]: [[f64; 2]; 3]) -> [f64; 2] {
    let [left, right] = [(a[1] - b[1]) / (a[0] - b[0]), (c[1] - b[1]) / (c[0] - b[0])];
    let curvature = (right - left) / (c[0] - a[0]);
    let slope = left - curvature * (a[0] - b[0]);
    let x = -0.5 * slope / curvature;
    let inside = b[0] + x > a[0].min(c[0]) && b[0] + x < a[0].max(c[0]);
    match inside {
        true => [b[0] + x, b[1] + 0.5 * slope * x],
        false => b,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vertex_of_a_parabola_is_found_from_any_three_points() {
        let p = |x: f64| [x, 3.0 - 2.0 * (x - 1.3).powi(2)];
        for points in [[1.0, 1.2, 2.0], [1.6, 1.4, 0.9]] {
            let [x, y] = vertex(points.map(p));
            assert!(
                (x - 1.3).abs() < 1e-12 && (y - 3.0).abs() < 1e-12,
                "{x} {y}"
            );
        }
        assert_eq!(vertex([[1.0, 0.0], [1.0, 2.0], [1.0, 1.0]]), [1.0, 2.0]);
    }
}
