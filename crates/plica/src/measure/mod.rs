//! Geometric measures of a deformed tube: radii, wall angle, overhang, gap, shape, asymmetry.
//!
//! A meridian is the material line at a reference angle φ. The radius of one of its points (z, x, y)
//! is its coordinate along the meridian's own direction,
//!
//! ρ = x cos(φ + ω) + y sin(φ + ω),
//!
//! where ω is the rotation about the axis in the axisymmetric part of the displacement. In an
//! axisymmetric tube ρ = r. Otherwise ρ is negative past the axis, where the wall continues straight
//! and r would turn back.
//!
//! | measure | definition |
//! |---|---|
//! | wall | the points (z, ρ) of one meridian of the outer or inner face, colon to ileum |
//! | wall angle | angle between the wall's tangent, directed from colon to ileum, and the axis: 0° along the tube, 90° radial, above 90° where the wall runs back |
//! | overhang | largest axial distance that the wall runs back: the maximum of z(s) − z(s') over s < s' |
//! | side | shoulder with the larger overhang: colon if the wall runs back on the colon side of its narrowest point, ileum if on the other |
//! | own axis | axis about which the radii of the outer face have no first harmonic |
//! | depth | radial narrowing: outer radius at rest minus the smallest outer radius about the own axis |
//! | flatness | axial extent of the wall narrowed by more than ¾ of the depth, over that narrowed by more than ¼ |
//! | flank | straight line through the two points on one side of the narrowest point where the wall is narrowed by ¼ and ¾ of the depth |
//! | centre of rotation | point with the least squared distance from the lines of one flank in two or more states |
//! | gap | smallest distance between two points of a meridian of either face that are at least one wall thickness apart along it; in a tube that is not axisymmetric also between any two points of a face that are as far apart along it, that face each other (normals 60° or more apart) and that are at least twice as far apart along the face as in space; 0 if a face crosses itself |
//! | lumen | smallest ρ(φ) + ρ(φ + π) of two points of the inner face that are opposite each other at rest, where that is negative (the walls have passed through each other) or the tube is axisymmetric; otherwise 0 if parts of the inner face a third of a turn or more apart at rest cross, or else the smallest distance of two such points, in one section or two, over that of points with these angles in one section at rest, times the inner diameter |
//! | shape | see [`Shape`] |
//! | asymmetry | amplitude √(aᶻ² + aᵨ²) of the largest wave cos n(φ − φ₀), n ≥ 1, in z and ρ around the outer face |

mod alignment;
mod dimensions;
mod gap;
mod lumen;
mod meridians;
mod patches;
mod reactions;
mod rotation;
mod shape;
mod surface;
mod triangle;
mod wall;

pub use alignment::Alignment;
pub use dimensions::Dimensions;
pub use meridians::{Asymmetry, Meridians};
pub use reactions::Reaction;
pub use rotation::{Flank, Rotation};
pub use shape::{Shape, Side};
pub use wall::{Face, Wall};

use crate::activation::{Direction, Muscle};
use crate::assembly::SplineTube;
use crate::tube::{Load, Tube};
use surface::Surface;

/// Geometric measures of one state; lengths in D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Smallest radius of the outer face about the tube's own axis.
    pub outer_radius_min: f64,
    /// Axial position of the smallest radius.
    pub z_at_min: f64,
    /// Steepest wall angle of the outer face, in degrees.
    pub max_wall_angle_deg: f64,
    /// Overhang of the outer face: an axial distance.
    pub overhang: f64,
    /// Side of the larger overhang.
    pub side: Side,
    /// Flatness of the narrowest meridian of the outer face; 0 if the tube is not narrowed.
    pub flatness: f64,
    /// Smallest distance of a wall from itself; 0 where it crosses itself, since contact is not modelled.
    pub gap: f64,
    /// Smallest width of the lumen; negative where walls have passed through each other.
    pub lumen: f64,
    /// Shape of the contracting region.
    pub shape: Shape,
    /// Deviation from axisymmetry.
    pub asymmetry: Asymmetry,
}

/// Sample points on a meridian per axial element.
const POINTS_PER_ELEMENT: usize = 6;

impl Measures {
    /// Measures a state. In a tube that is not axisymmetric each measure is the extreme one of
    /// sixteen meridians, of which the first is at the crest of the asymmetry.
    pub fn of(tube: &SplineTube, load: &Load, u: &[f64]) -> Self {
        let meridians = Meridians::of(tube, load, u);
        let asymmetry = meridians.asymmetry();
        let angles = meridians.sample_angles(asymmetry.crest);
        let z = tube
            .axial
            .positions(tube.axial.elements() * POINTS_PER_ELEMENT + 1);
        let [outer, inner] =
            [Face::Outer, Face::Inner].map(|face| meridians.walls(face, &angles, &z));
        let overhangs = outer.iter().map(Wall::overhang);
        let steepest = outer.iter().map(Wall::steepest_angle_deg);
        let angle = steepest.fold(0.0, f64::max);
        let gaps = outer
            .iter()
            .chain(&inner)
            .map(|wall| wall.gap(tube.tube.thickness));
        let mut gap = gaps.fold(f64::INFINITY, f64::min);
        let mut lumen = meridians.min_width(&inner);
        if angles.len() > 1 {
            let mut closes = false;
            for face in [Face::Outer, Face::Inner] {
                let surface = Surface::of(tube, u, face, asymmetry.crest);
                let contact = surface.contact(tube.tube.thickness, gap);
                gap = gap.min(contact.gap);
                closes |= face == Face::Inner && contact.closes;
            }
            if lumen > 0.0 {
                lumen = if closes {
                    0.0
                } else {
                    lumen::width(tube, u, asymmetry.crest, &z)
                };
            }
        }

        let [own_outer, own_inner] = meridians.centred([&outer, &inner]);
        let radius = |&i: &usize| own_outer[i].narrowest().1;
        let narrowest = (0..angles.len()).min_by(|a, b| radius(a).total_cmp(&radius(b)));
        let (Some(narrowest), Some((overhang, side))) =
            (narrowest, overhangs.max_by(|a, b| a.0.total_cmp(&b.0)))
        else {
            unreachable!("a tube has a meridian")
        };
        let (z_at_min, outer_radius_min) = own_outer[narrowest].narrowest();
        // A tube whose diameter varies is narrowed where it is narrower than at rest.
        let relative: Option<Vec<Wall>> = tube.tube.outline().map(|outline| {
            let walls = own_outer.iter();
            walls.map(|wall| wall.on_cylinder(outline)).collect()
        });
        let relative = relative.as_ref().unwrap_or(&own_outer);
        let radius = |&i: &usize| relative[i].narrowest().1;
        let deepest = (0..angles.len()).min_by(|a, b| radius(a).total_cmp(&radius(b)));
        let deepest = deepest.unwrap_or(narrowest);
        let narrowed = Tube::OUTER_RADIUS - radius(&deepest) >= Shape::MIN_DEPTH;
        let flatness = if narrowed {
            relative[deepest].flatness()
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
                &relative[deepest],
                &own_inner[deepest],
                angle,
                contracts(&tube.tube, load),
                asymmetry.amplitude,
            ),
            asymmetry,
        }
    }
}

/// Returns true if a circular muscle contracts in the tube, by growth to a Dmin/D that is visible or by a tension.
fn contracts(tube: &Tube, load: &Load) -> bool {
    let acts = |m: usize| {
        let muscle = &tube.muscles[m];
        let active = |z: f64| muscle.activity(muscle.unshifted(z, load.shifts[m])) > 0.0;
        (1..POINTS).any(|i| active(tube.length * f64::from(i) / f64::from(POINTS)))
    };
    let pulls = |m: usize| {
        let muscle: &Muscle = &tube.muscles[m];
        let is_circular = !muscle.grows() && muscle.direction == Direction::Circular;
        is_circular && load.muscles[m] > 0.0 && acts(m)
    };
    tube.diameter_ratio(load) <= 1.0 - Shape::MIN_DEPTH || (0..tube.muscles.len()).any(pulls)
}

/// Intervals along the tube between points where the activity of a muscle is looked for.
const POINTS: i32 = 240;

#[cfg(test)]
mod tests;
