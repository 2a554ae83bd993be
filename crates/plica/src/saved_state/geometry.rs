//! Knots and control points of a state, for readers without Plica. They follow from the layout and the unknowns.

use super::{Array, Layout};
use crate::spline::Circle;
use crate::tube::Tube;
use std::f64::consts::TAU;

/// Names of the arrays in a file: the knots along the tube and through the wall, and the control points.
pub(super) const NAMES: [&str; 3] = ["knots_along", "knots_through", "control_points"];

/// Returns the arrays of the names above; none if the unknowns do not fit the layout.
///
/// The control points are (x, y, z), with z along the tube, of every row along, through the wall and of every ring of the
/// sector. Ring j is at the angle (j − p/2) 2π/n, for n rings of degree p around the tube.
pub(super) fn arrays(layout: &Layout, u: &[f64]) -> Option<[Array; 3]> {
    if layout.fault().is_some() || u.len() != layout.unknowns() {
        return None;
    }
    let (mesh, p) = (&layout.mesh, layout.mesh.degree);
    let inner_radius = Tube::OUTER_RADIUS - layout.thickness;
    let along = mesh.breakpoints_along(layout.length);
    let axial = knots(&along, &vec![1; along.len() - 2], p);
    let radii = mesh.breakpoints_through(layout.thickness);
    let radii: Vec<f64> = radii.iter().map(|h| inner_radius + h).collect();
    let wall = knots(&radii, &mesh.multiplicities_through(), p);
    let stretch = Circle::new(p, mesh.around).control_radius;
    let angle = |ring: usize| (ring as f64 - 0.5 * p as f64) * TAU / mesh.around as f64;
    let mut points = Vec::with_capacity(u.len());
    for (row, &z) in greville(&axial, p).iter().enumerate() {
        for (layer, &r) in greville(&wall, p).iter().enumerate() {
            for ring in 0..layout.rings {
                let at =
                    |i: usize| u[((row * mesh.thickness + layer) * 3 + i) * layout.rings + ring];
                let (sin, cos) = angle(ring).sin_cos();
                let (outwards, around) = (stretch * r + at(1), at(2));
                points.push(outwards * cos - around * sin);
                points.push(outwards * sin + around * cos);
                points.push(z + at(0));
            }
        }
    }
    let list = |values: Vec<f64>| Array {
        shape: vec![values.len()],
        values,
    };
    Some([
        list(axial),
        list(wall),
        Array {
            shape: vec![mesh.axial, mesh.thickness, layout.rings, 3],
            values: points,
        },
    ])
}

/// Returns open knots: the breakpoints, the first and the last p + 1 times, the others as often as given.
fn knots(breakpoints: &[f64], multiplicities: &[usize], p: usize) -> Vec<f64> {
    let (first, last) = (breakpoints[0], breakpoints[breakpoints.len() - 1]);
    let mut knots = vec![first; p + 1];
    for (&knot, &m) in breakpoints[1..].iter().zip(multiplicities) {
        knots.extend(vec![knot; m]);
    }
    knots.extend(vec![last; p + 1]);
    knots
}

/// Returns the Greville abscissae: the means of p consecutive knots.
fn greville(knots: &[f64], p: usize) -> Vec<f64> {
    let mean = |knots: &[f64]| knots.iter().sum::<f64>() / p as f64;
    knots[1..knots.len() - 1].windows(p).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{Point, SplineTube};
    use crate::spline::Basis;
    use crate::study::fixture::{plan, state};
    use crate::tube::{Mesh, MeshLayer, Symmetry};

    /// Evaluates the formula of docs/run-directory.md.
    #[allow(non_snake_case)]
    fn position(layout: &Layout, arrays: &[Array; 3], at: Point) -> [f64; 3] {
        let (p, n, rings) = (layout.mesh.degree, layout.mesh.around, layout.rings);
        let basis = |array: &Array| {
            let mut breakpoints = array.values.clone();
            breakpoints.dedup();
            let count = |t: &f64| array.values.iter().filter(|knot| *knot == t).count();
            let inner = breakpoints[1..breakpoints.len() - 1].iter();
            let multiplicities: Vec<usize> = inner.map(count).collect();
            Basis::with_multiplicities(p, &breakpoints, &multiplicities)
        };
        let along = basis(&arrays[0]).evaluate(at.z);
        let through = basis(&arrays[1]).evaluate(at.radius);
        let element = Basis::uniform_element(p);
        let alpha = TAU / n as f64;
        let turns = at.angle / alpha + 0.5;
        let around = element.evaluate_in(0, turns - turns.floor());
        let mut x = [0.0; 3];
        for (a, N) in along.value.iter().enumerate() {
            for (c, M) in through.value.iter().enumerate() {
                for (b, B) in around.value.iter().enumerate() {
                    let ring = (turns.floor() as usize + b) % n;
                    let place = ((along.first + a) * layout.mesh.thickness + through.first + c)
                        * rings
                        + ring % rings;
                    let P = &arrays[2].values[3 * place..];
                    let (sin, cos) = ((ring / rings * rings) as f64 * alpha).sin_cos();
                    let turned = [P[0] * cos - P[1] * sin, P[0] * sin + P[1] * cos, P[2]];
                    (0..3).for_each(|i| x[i] += N * M * B * turned[i]);
                }
            }
        }
        x
    }

    #[test]
    fn knots_and_control_points_give_the_positions_of_the_wall() {
        let symmetries = [Symmetry::Axisymmetric, Symmetry::Fold(3), Symmetry::None];
        let plans = symmetries.map(|symmetry| (plan(symmetry), symmetry));
        let mut layered = plan(Symmetry::Fold(3));
        layered.tube.layers = vec![layered.tube.layers[0].clone(); 2];
        (layered.tube.layers[0].share, layered.tube.layers[1].share) = (0.3, 0.7);
        let shares = [0.3, 0.7];
        layered.mesh.layers = shares
            .map(|share| MeshLayer { share, elements: 2 })
            .to_vec();
        layered.mesh.thickness = Mesh::points_through(layered.mesh.degree, &layered.mesh.layers);
        for (plan, symmetry) in plans.into_iter().chain([(layered, Symmetry::Fold(3))]) {
            let state = state(&plan, 2);
            let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(symmetry));
            let arrays = arrays(&state.layout, &state.u).unwrap();
            for (z, depth, angle) in [(0.0, 0.0, 0.0), (0.37, 0.4, 1.0), (0.9, 1.0, 4.0)] {
                let radius = tube.tube.inner_radius() + depth * tube.tube.thickness;
                let at = Point { z, radius, angle };
                let [z, x, y] = tube.sample(&state.load, &state.u, at).position;
                let found = position(&state.layout, &arrays, at);
                for (a, b) in found.iter().zip([x, y, z]) {
                    assert!((a - b).abs() < 1e-13, "{symmetry:?}: {found:?} {x} {y} {z}");
                }
            }
        }
    }
}
