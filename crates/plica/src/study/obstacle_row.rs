//! The numbers of an obstacle in a row of the history.

use super::Scale;
use super::state::ObstacleState;
use super::table::{Quantity, Visitor};

/// The numbers of an obstacle in a row. Energy, force, reaction, area, from and to are zero where nothing touches it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObstacleRow {
    /// Its name in the case.
    pub name: String,
    /// Its radius; 0 of a plate.
    pub radius: f64,
    /// Its position, [x, y, z].
    pub position: [f64; 3],
    /// Energy of its contact with the walls.
    pub energy: f64,
    /// Sum of the sizes of the contact forces.
    pub force: f64,
    /// Resultant of the contact forces and of friction on the obstacle, [x, y, z].
    pub reaction: [f64; 3],
    /// Area at rest of the walls within the range of contact.
    pub area: f64,
    /// Smallest distance of the walls from the obstacle, also where they do not touch it.
    pub gap: f64,
    /// Axial position at rest of the first point in contact.
    pub from: f64,
    /// Axial position at rest of the last point in contact.
    pub to: f64,
    /// First and last angle at rest of the shortest arc with all points in contact, as
    /// [`WallContactRow::angles_deg`](super::WallContactRow::angles_deg); none of an axisymmetric tube.
    pub angles_deg: [Option<f64>; 2],
    /// Work that has been done on it so far to move it or to change its radius.
    pub work: f64,
    /// Sum of the sizes of the friction forces; this and the next column exist only for an obstacle with friction.
    pub friction_force: Option<f64>,
    /// Energy that friction on it has dissipated so far.
    pub friction_work: Option<f64>,
}

impl ObstacleRow {
    /// Converts an obstacle of a state to the units of its case.
    pub(super) fn new(obstacle: &ObstacleState, scale: &Scale) -> Self {
        let ObstacleState {
            name,
            placement,
            contact,
        } = obstacle;
        let length = scale.length;
        // From (z, x, y).
        let in_order = |[z, x, y]: [f64; 3], factor: f64| [x, y, z].map(|x| factor * x);
        let [from, to] = contact.from_to.unwrap_or_default();
        Self {
            name: name.clone(),
            radius: length * placement.radius,
            position: in_order(placement.position, length),
            energy: scale.energy * contact.energy,
            force: scale.force * contact.force,
            reaction: in_order(contact.reaction, scale.force),
            area: length * length * contact.area,
            gap: length * contact.gap,
            from: length * from,
            to: length * to,
            angles_deg: match contact.angles {
                None => [None; 2],
                Some(angles) => angles.map(|angle| Some(angle.to_degrees())),
            },
            work: 0.0,
            friction_force: contact.friction.map(|on| scale.force * on.force),
            friction_work: contact.friction.map(|on| scale.energy * on.dissipated),
        }
    }

    /// Visits the columns other than that of the work.
    pub(super) fn visit(&mut self, v: &mut impl Visitor) {
        use Quantity::{Area, Degrees, Energy, Force, Length};
        let name = &self.name;
        v.cell(&format!("radius_{name}"), Length, &mut self.radius);
        for (axis, x) in ["x", "y", "z"].iter().zip(&mut self.position) {
            v.cell(&format!("{axis}_{name}"), Length, x);
        }
        v.cell(&format!("contact_energy_{name}"), Energy, &mut self.energy);
        v.cell(&format!("contact_force_{name}"), Force, &mut self.force);
        for (axis, x) in ["x", "y", "z"].iter().zip(&mut self.reaction) {
            v.cell(&format!("reaction_{axis}_{name}"), Force, x);
        }
        v.cell(&format!("contact_area_{name}"), Area, &mut self.area);
        v.cell(&format!("contact_gap_{name}"), Length, &mut self.gap);
        v.cell(&format!("contact_from_{name}"), Length, &mut self.from);
        v.cell(&format!("contact_to_{name}"), Length, &mut self.to);
        for (end, angle) in ["from", "to"].iter().zip(&mut self.angles_deg) {
            v.optional(&format!("contact_angle_{end}_deg_{name}"), Degrees, angle);
        }
        let force = &mut self.friction_force;
        v.optional(&format!("friction_force_{name}"), Force, force);
        let work = &mut self.friction_work;
        v.optional(&format!("friction_work_{name}"), Energy, work);
    }
}
