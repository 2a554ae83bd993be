//! Measures of a deformed tube: what a person reads off its wall.
//!
//! A meridian is the material line at a reference angle φ. The radius of one of its points (z, x, y)
//! is how far it lies out along its own direction,
//!
//! ρ = x cos(φ + ω) + y sin(φ + ω),
//!
//! where ω is the angle by which the axisymmetric part of the displacement has turned its place in
//! the wall about the axis. In an axisymmetric tube ρ = r. Else ρ has a sign: past the axis it is negative,
//! and the wall goes straight on there, where r would turn back.
//!
//! | measure | definition |
//! |---|---|
//! | wall | the points (z, ρ) of one meridian of the outer or inner face, colon to ileum |
//! | wall angle | angle between the wall's tangent, followed from colon to ileum, and the axis; 0° along the tube, 90° straight in or out, past 90° where the wall runs back |
//! | overhang | how far the wall runs back along the axis, at most: the largest z(s) − z(s') over s < s' |
//! | side | the shoulder that overhangs more: colon if the wall runs back while it goes in, ileum if while it comes out |
//! | own axis | where the radii of the outer face have no first harmonic |
//! | depth | outer radius at rest less the smallest outer radius about the own axis |
//! | flatness | axial extent of the wall deeper than ¾ of the depth, over that deeper than ¼ |
//! | flank | the straight line through the wall on one side of the narrowest place, where it is ¼ and ¾ of the depth below its radius at rest |
//! | centre of rotation | the place with the least squared distance from the lines of a flank in two states or more |
//! | gap | smallest distance of two points of a meridian of either face that lie a wall's thickness or more from each other along it; 0 if a meridian crosses itself |
//! | lumen | smallest ρ(φ) + ρ(φ + π) of two points of the inner face that lay opposite each other at rest; negative where the wall has passed through the wall across |
//! | shape | see [`Shape`] |
//! | departure | amplitude √(aᶻ² + aᵨ²) of the largest wave cos n(φ − φ₀), n ≥ 1, in z and ρ around the outer face |

mod gap;
mod meridians;
mod overlay;
mod rotation;
mod shape;
mod wall;

pub use meridians::{Asymmetry, Meridians};
pub use overlay::Overlay;
pub use rotation::{Flank, Rotation};
pub use shape::{Shape, Side};
pub use wall::{Face, Wall};

use crate::assembly::SplineTube;
use crate::tube::{Load, Tube};

/// The measures of one state; lengths in D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Smallest radius of the outer face, about the tube's own axis.
    pub outer_radius_min: f64,
    /// Where along the tube that is.
    pub z_at_min: f64,
    /// Steepest wall angle of the outer face, in degrees.
    pub max_wall_angle_deg: f64,
    /// Overhang of the outer face.
    pub overhang: f64,
    /// The side it overhangs on.
    pub side: Side,
    /// Flatness of the outer face where it is deepest; 0 of a tube that is nowhere narrower than at rest.
    pub flatness: f64,
    /// How near a wall comes to itself; 0 where it crosses itself, which nothing prevents.
    pub gap: f64,
    /// Narrowest width of the lumen; negative where walls have passed through each other.
    pub lumen: f64,
    /// What the contracting region looks like.
    pub shape: Shape,
    /// How far it is from axisymmetric.
    pub asymmetry: Asymmetry,
}

/// Points along the outer face from which measures are taken, per element along the tube.
const POINTS_PER_ELEMENT: usize = 6;

impl Measures {
    /// Measures a state. Where the tube is not axisymmetric, each is that of the meridian where
    /// it is most, of sixteen from the crest of its departure on.
    pub fn of(tube: &SplineTube, load: &Load, u: &[f64]) -> Self {
        let meridians = Meridians::of(tube, load, u);
        let asymmetry = meridians.asymmetry();
        let angles = meridians.around(asymmetry.crest);
        let z = tube
            .axial
            .spread(tube.axial.elements() * POINTS_PER_ELEMENT + 1);
        let [outer, inner] =
            [Face::Outer, Face::Inner].map(|face| meridians.walls(face, &angles, &z));
        let overhangs = outer.iter().map(Wall::overhang);
        let steepest = outer.iter().map(Wall::steepest_angle_deg);
        let angle = steepest.fold(0.0, f64::max);
        let gaps = outer
            .iter()
            .chain(&inner)
            .map(|wall| wall.gap(tube.tube.thickness));
        let gap = gaps.fold(f64::INFINITY, f64::min);
        let lumen = meridians.narrowest_across(&inner);

        let [own_outer, own_inner] = meridians.about_own_axis([&outer, &inner]);
        let narrowest = |&i: &usize| own_outer[i].narrowest().1;
        let deepest = (0..angles.len()).min_by(|a, b| narrowest(a).total_cmp(&narrowest(b)));
        let (Some(deepest), Some((overhang, side))) =
            (deepest, overhangs.max_by(|a, b| a.0.total_cmp(&b.0)))
        else {
            unreachable!("a tube has a meridian")
        };
        let (z_at_min, outer_radius_min) = own_outer[deepest].narrowest();
        let narrowed = Tube::OUTER_RADIUS - outer_radius_min >= Shape::LEAVES;
        let flatness = if narrowed {
            own_outer[deepest].flatness()
        } else {
            0.0
        };
        Self {
            outer_radius_min,
            z_at_min,
            max_wall_angle_deg: angle,
            overhang,
            side,
            flatness,
            gap,
            lumen,
            shape: Shape::of(
                &own_outer[deepest],
                &own_inner[deepest],
                angle,
                tube.tube.diameter_ratio(load),
            ),
            asymmetry,
        }
    }
}

#[cfg(test)]
mod tests;
