//! Measures of a deformed tube: what a person reads off its wall.
//!
//! | measure | definition |
//! |---|---|
//! | wall | the points (z, r) of one meridian of the outer or inner face, colon to ileum |
//! | wall angle | angle between the wall's tangent, followed from colon to ileum, and the axis; 0° along the tube, 90° straight in or out, past 90° where the wall runs back |
//! | overhang | how far the wall runs back along the axis, at most: the largest z(s) − z(s') over s < s' |
//! | side | the shoulder that overhangs more: colon if the wall runs back while it goes in, ileum if while it comes out |
//! | depth | outer radius at rest less the smallest outer radius |
//! | flatness | axial extent of the wall deeper than ¾ of the depth, over that deeper than ¼ |
//! | shape | see [`Shape`] |

mod shape;
mod wall;

pub use shape::{Shape, Side};
pub use wall::{Face, Wall, even, meridians};

use crate::assembly::SplineTube;
use crate::tube::Load;

/// The measures of one state; lengths in D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Smallest radius of the outer face.
    pub outer_radius_min: f64,
    /// Where along the tube that is.
    pub z_at_min: f64,
    /// Steepest wall angle of the outer face, in degrees.
    pub max_wall_angle_deg: f64,
    /// Overhang of the outer face.
    pub overhang: f64,
    /// The side it overhangs on.
    pub side: Side,
    /// What the contracting region looks like.
    pub shape: Shape,
}

/// Points along the outer face from which measures are taken, per element along the tube.
const POINTS_PER_ELEMENT: usize = 6;

impl Measures {
    /// Measures a state. Where the tube is not axisymmetric, each is that of the meridian where
    /// it is most.
    pub fn of(tube: &SplineTube, load: &Load, u: &[f64]) -> Self {
        let walls: Vec<Wall> = meridians(tube)
            .into_iter()
            .map(|angle| Wall::fine(tube, load, u, Face::Outer, angle, POINTS_PER_ELEMENT))
            .collect();
        let narrowest = |wall: &Wall| wall.narrowest().1;
        let deepest = walls
            .iter()
            .min_by(|a, b| narrowest(a).total_cmp(&narrowest(b)));
        let overhanging = walls
            .iter()
            .max_by(|a, b| a.overhang().0.total_cmp(&b.overhang().0));
        let (Some(deepest), Some(overhanging)) = (deepest, overhanging) else {
            unreachable!("a tube has a meridian")
        };
        let angle = walls
            .iter()
            .map(Wall::steepest_angle_deg)
            .fold(0.0, f64::max);
        let (z_at_min, outer_radius_min) = deepest.narrowest();
        let (overhang, side) = overhanging.overhang();
        let inner = Wall::fine(
            tube,
            load,
            u,
            Face::Inner,
            deepest.angle,
            POINTS_PER_ELEMENT,
        );
        Self {
            outer_radius_min,
            z_at_min,
            max_wall_angle_deg: angle,
            overhang,
            side,
            shape: Shape::of(deepest, &inner, angle, tube.tube.diameter_ratio(load)),
        }
    }
}
