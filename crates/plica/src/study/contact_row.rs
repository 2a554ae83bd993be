//! The contact of the wall with itself in a row of the history.

use super::Scale;
use super::table::{Quantity, Visitor};
use crate::contact::{ContactReport, FaceContact};

/// The names that a case has for the inner and the outer wall; no muscle has them.
pub(super) const WALLS: [&str; 2] = ["inner-wall", "outer-wall"];

/// Angle by which a wall may turn within one element. In the main case the wall turns by 12° where uniform meshes agree to
/// 2.5e-5, by 23° at the next state, and by 32° where they differ by 7e-3.
pub const RESOLVED_TURN_DEG: f64 = 20.0;

/// Contact of the wall with itself in a row. All are none in a run without contact, and zero where nothing touches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactRow {
    /// Energy of contact Π_c.
    pub energy: Option<f64>,
    /// Π_c over the strain energy W: a bound of what the range of contact adds to W. 0 at rest.
    pub energy_share: Option<f64>,
    /// Contact of the inner and of the outer wall with itself.
    pub walls: [WallContactRow; 2],
}

/// Contact of one wall with itself in a row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallContactRow {
    /// Area at rest of both sides.
    pub area: Option<f64>,
    /// Sum of the sizes of the forces between the two sides.
    pub force: Option<f64>,
    /// Smallest gap between points in contact.
    pub gap: Option<f64>,
    /// Axial position at rest of the first point in contact.
    pub from: Option<f64>,
    /// Axial position at rest of the last point in contact.
    pub to: Option<f64>,
    /// First and last angle at rest of the shortest arc with all points in contact, from 0 to 360°; the last may lie beyond.
    /// Of one of the sectors into which the symmetry divides the tube. None of an axisymmetric tube.
    pub angles_deg: [Option<f64>; 2],
    /// Smallest surface stretch s = λ₁² λ₂: [`FaceSurface::stretch`](crate::contact::FaceSurface::stretch).
    pub surface_stretch: Option<f64>,
    /// Largest angle by which the wall turns within one element: [`FaceSurface::turn`](crate::contact::FaceSurface::turn).
    pub element_turn_deg: Option<f64>,
    /// Sum of the sizes of the friction forces between the two sides; this and the next column exist only with friction.
    pub friction_force: Option<f64>,
    /// Energy that friction of the wall with itself has dissipated so far.
    pub friction_work: Option<f64>,
}

impl ContactRow {
    /// Converts the contact of a state of a strain energy, in E·D³, to the units of its case.
    pub(super) fn new(contact: &ContactReport, energy: f64, scale: &Scale) -> Self {
        let wall = |i: usize| {
            let (face, surface) = (contact.faces[i], contact.surfaces[i]);
            let friction = contact.friction.map(|faces| faces[i]);
            let of = |value: fn(FaceContact) -> f64| Some(face.map_or(0.0, value));
            let (length, force) = (scale.length, scale.force);
            WallContactRow {
                area: of(|face| face.area).map(|area| length * length * area),
                force: of(|face| face.force).map(|f| force * f),
                gap: of(|face| face.gap).map(|gap| length * gap),
                from: of(|face| face.from_to[0]).map(|z| length * z),
                to: of(|face| face.from_to[1]).map(|z| length * z),
                angles_deg: match contact.angles {
                    None => [None; 2],
                    Some(angles) => angles[i].map(|angle| Some(angle.to_degrees())),
                },
                surface_stretch: Some(surface.stretch),
                element_turn_deg: Some(surface.turn.to_degrees()),
                friction_force: friction.map(|on| scale.force * on.force),
                friction_work: friction.map(|on| scale.energy * on.dissipated),
            }
        };
        Self {
            energy: Some(scale.energy * contact.energy),
            energy_share: Some(if energy > 0.0 {
                contact.energy / energy
            } else {
                0.0
            }),
            // Inner, outer.
            walls: [wall(1), wall(0)],
        }
    }

    /// Sets every number that is none to zero.
    pub(super) fn fill_with_zeros(&mut self) {
        self.energy.get_or_insert(0.0);
        self.energy_share.get_or_insert(0.0);
        for wall in &mut self.walls {
            for value in [
                &mut wall.area,
                &mut wall.force,
                &mut wall.gap,
                &mut wall.from,
                &mut wall.to,
                &mut wall.surface_stretch,
                &mut wall.element_turn_deg,
            ] {
                value.get_or_insert(0.0);
            }
        }
    }

    /// Visits the columns.
    pub(super) fn visit(&mut self, v: &mut impl Visitor) {
        use Quantity::{Area, Degrees, Energy, Force, Length, Ratio};
        v.optional("contact_energy", Energy, &mut self.energy);
        let share = &mut self.energy_share;
        v.optional("contact_energy_share", Ratio, share);
        for (wall, name) in self.walls.iter_mut().zip(WALLS) {
            v.optional(&format!("contact_area_{name}"), Area, &mut wall.area);
            v.optional(&format!("contact_force_{name}"), Force, &mut wall.force);
            v.optional(&format!("contact_gap_{name}"), Length, &mut wall.gap);
            v.optional(&format!("contact_from_{name}"), Length, &mut wall.from);
            v.optional(&format!("contact_to_{name}"), Length, &mut wall.to);
            for (end, angle) in ["from", "to"].iter().zip(&mut wall.angles_deg) {
                v.optional(&format!("contact_angle_{end}_deg_{name}"), Degrees, angle);
            }
            let [stretch, turn] =
                ["surface_stretch", "element_turn_deg"].map(|of| format!("{of}_{name}"));
            v.optional(&stretch, Ratio, &mut wall.surface_stretch);
            v.optional(&turn, Degrees, &mut wall.element_turn_deg);
            let [force, work] = ["force", "work"].map(|of| format!("friction_{of}_{name}"));
            v.optional(&force, Force, &mut wall.friction_force);
            v.optional(&work, Energy, &mut wall.friction_work);
        }
    }

    /// Returns whether a wall touches itself.
    pub fn touches(&self) -> bool {
        self.walls.iter().any(WallContactRow::touches)
    }

    /// Returns the smallest surface stretch of both walls; none in a run without contact.
    pub fn surface_stretch(&self) -> Option<f64> {
        let walls = self.walls.iter().filter_map(|wall| wall.surface_stretch);
        walls.min_by(f64::total_cmp)
    }

    /// Returns whether a wall turns so much within an element that a crease may be finer than the mesh.
    pub fn is_unresolved(&self) -> bool {
        let turn = self.walls.iter().filter_map(|wall| wall.element_turn_deg);
        turn.fold(0.0, f64::max) > RESOLVED_TURN_DEG
    }
}

impl WallContactRow {
    /// Returns whether the wall touches itself.
    pub fn touches(&self) -> bool {
        self.area.is_some_and(|area| area > 0.0)
    }

    /// Returns the first and last axial position in contact, and the angles if the tube is not axisymmetric.
    pub fn place(&self) -> ([f64; 2], Option<[f64; 2]>) {
        let ends = [self.from, self.to].map(Option::unwrap_or_default);
        let [from, to] = self.angles_deg;
        (ends, from.zip(to).map(|(from, to)| [from, to]))
    }
}
