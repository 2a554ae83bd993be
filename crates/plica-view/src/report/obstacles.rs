//! Rigid obstacles in cutaways.

use crate::draw::{Sides, Surface};
use crate::obstacle_shapes::{Body, bodies};
use plica::assembly::SplineTube;
use plica::tube::{Load, ObstacleShape};
use std::f64::consts::{PI, TAU};

/// Distance from the axis towards the viewer, in D, beyond which a body may hide the tube.
const IN_FRONT: f64 = 0.3;

/// Obstacles in the coordinates of a cutaway, without values, which are drawn grey.
#[derive(Default)]
pub(super) struct DrawnObstacles {
    /// Bodies inside and behind the tube, and the rear half of sheaths.
    pub solid: Vec<Surface>,
    /// Bodies in front of the tube, and plates across it.
    pub translucent: Vec<Surface>,
}

/// Returns the obstacles of a tube under a load; the angle `upwards` points up, and the viewer looks against `toward`.
pub(super) fn obstacles(
    tube: &SplineTube,
    load: &Load,
    upwards: f64,
    toward: [f64; 3],
) -> DrawnObstacles {
    let mut drawn = DrawnObstacles::default();
    // Angle of the viewer about the axis of the tube.
    let viewer = upwards + toward[1].atan2(toward[0]);
    let (sin, cos) = upwards.sin_cos();
    for body in bodies(tube, load) {
        let around = match body.shape {
            ObstacleShape::Sheath => [viewer + 0.5 * PI, viewer + 1.5 * PI],
            _ => [0.0, TAU],
        };
        let grid = body.surface.grid(around);
        let point = |&[z, x, y]: &[f64; 3]| [x * cos + y * sin, y * cos - x * sin, z];
        let surface = Surface {
            columns: grid.columns,
            rows: grid.points.len() / grid.columns,
            values: vec![f64::NAN; grid.points.len()],
            points: grid.points.iter().map(point).collect(),
            sides: Sides::Both,
        };
        match is_in_front(&body, tube.tube.length, viewer) {
            true => drawn.translucent.push(surface),
            false => drawn.solid.push(surface),
        }
    }
    drawn
}

/// Returns whether a body may hide the tube from a viewer at an angle about the axis.
fn is_in_front(body: &Body, length: f64, viewer: f64) -> bool {
    let (sin, cos) = viewer.sin_cos();
    let towards = |x: f64, y: f64| x * cos + y * sin;
    let [z, x, y] = body.placement.position;
    match &body.shape {
        ObstacleShape::Sheath => false,
        ObstacleShape::Rod { .. } | ObstacleShape::Ball => towards(x, y) > IN_FRONT,
        ObstacleShape::Plate { normal } => {
            let [n_z, n_x, n_y] = *normal;
            // Where the plane is nearest to the middle of the axis.
            let distance = n_z * (z - 0.5 * length) + n_x * x + n_y * y;
            n_z.abs() > n_x.hypot(n_y) || distance * towards(n_x, n_y) > 0.0
        }
    }
}
