//! Orders of convergence through a wall of layers, whose strain jumps at the interfaces.

use super::layered_wall::{Layer, LayeredWall, Shape};
use super::layers::{inflated, model};
use super::report::Recorder;
use super::tube_model::radial_displacement;
use super::{Tolerance, VerificationError};

/// Elements of a layer, or of a third of the wall of one layer.
const ELEMENTS: [usize; 2] = [4, 8];
/// Points of a layer at which displacements are compared.
const POINTS: usize = 24;
/// Elements around the tube. The error of the spline circle is then far below that of the displacement.
const AROUND: usize = 600;
const PRESSURE: f64 = 0.1;

/// Returns a wall of three layers with fibres in the middle one, or of three thirds that are all alike.
fn wall(is_layered: bool) -> LayeredWall {
    let radii = [0.34, 0.42, 0.5];
    let soft = |outer| Layer::new(outer, 0.05, 1.0);
    let middle = |outer: f64| {
        let layer = Layer {
            shape: Shape::Exponential(0.5, 0.8),
            ..Layer::new(outer, 0.5, 10.0)
        };
        layer.with_pair([0.4, 0.8], 0.1, 0.5)
    };
    let stiff = |outer| Layer::new(outer, 0.9, 20.0);
    LayeredWall {
        inner: 0.26,
        layers: match is_layered {
            true => vec![soft(radii[0]), middle(radii[1]), stiff(radii[2])],
            false => vec![middle(radii[2])],
        },
        stretch: 1.1,
    }
}

/// Returns the root of the mean square error of the radial displacement over points of the wall.
fn error(wall: &LayeredWall, degree: usize, elements: usize) -> Result<f64, VerificationError> {
    let per_layer = 3 * elements / wall.layers.len();
    let mut model = model(wall, &vec![per_layer; wall.layers.len()]);
    model.degree = degree;
    model.elements[1] = AROUND;
    let (problem, state) = inflated(&model, wall, PRESSURE, 4)?;
    let exact = wall.inflate(PRESSURE, 4)?;
    let outer = wall.layers[wall.layers.len() - 1].outer;
    let points = 3 * POINTS;
    let mut sum = 0.0;
    for n in 0..points {
        let R = wall.inner + (outer - wall.inner) * (n as f64 + 0.5) / points as f64;
        // The outer radius of the tube is that of the reference solution.
        let moved = radial_displacement(&problem, &state, R);
        let difference = R + moved - wall.radius_at(&exact, PRESSURE, R)?;
        sum += difference * difference;
    }
    Ok((sum / points as f64).sqrt())
}

/// Records the orders of convergence of the displacement of walls of one and of three layers.
pub fn orders(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    for (name, is_layered) in [("one layer", false), ("three layers", true)] {
        let wall = wall(is_layered);
        recorder.case(format!(
            "wall of {name}, internal pressure p = {PRESSURE}, {} and {} elements a third",
            ELEMENTS[0], ELEMENTS[1]
        ))?;
        for degree in [2, 3] {
            let [coarse, fine] = ELEMENTS.map(|elements| error(&wall, degree, elements));
            let order = (coarse? / fine?).log2();
            let quantity = format!("order of convergence, p = {degree}");
            let expected = (degree as f64 + 1.0, "p + 1");
            recorder.row(quantity, order, expected, Tolerance::Absolute(0.5));
        }
    }
    Ok(())
}
