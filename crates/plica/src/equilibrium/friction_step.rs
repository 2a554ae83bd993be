//! Friction in a load step of a tube: on obstacles, and of the wall with itself.

use crate::assembly::{Forces, Friction, ObstacleFriction, SplineTube, StepStart};
use crate::contact::{FaceFriction, MeridianContact, SelfFriction};
use crate::tube::Load;

/// A load step with friction: the state from which it begins, and the friction with the normal forces of a state.
#[derive(Clone, Debug)]
pub struct FrictionStep {
    start: StepStart,
    /// Elastic slips of the wall on itself at the start.
    own_slips: Vec<f64>,
    /// Energy that friction has dissipated up to the start: on each obstacle, and of the outer and the inner face.
    dissipated: Vec<f64>,
    /// On obstacles.
    friction: Option<Friction>,
    /// Of the wall with itself.
    own: Option<SelfFriction>,
}

/// Returns the contact of a wall that has friction on itself.
fn rough(contact: Option<&MeridianContact>) -> Option<&MeridianContact> {
    contact.filter(|contact| contact.has_friction())
}

impl FrictionStep {
    /// Begins a step at a state with its history, which is empty at the first state. Returns none without friction.
    pub fn begin(
        tube: &SplineTube,
        contact: Option<&MeridianContact>,
        (load, u): (&Load, &[f64]),
        history: &[f64],
    ) -> Option<Self> {
        if !tube.has_friction() && rough(contact).is_none() {
            return None;
        }
        let totals = tube.tube.obstacles.len() + 2;
        let (dissipated, rest) = history.split_at_checked(totals).unwrap_or_default();
        let count = rest.first().map_or(0, |count| *count as usize);
        let (slips, own_slips) = rest
            .get(1..)
            .and_then(|slips| slips.split_at_checked(count))
            .unwrap_or_default();
        let mut all = dissipated.to_vec();
        all.resize(totals, 0.0);
        let mut step = Self {
            start: StepStart {
                load: load.clone(),
                u: u.to_vec(),
                slips: slips.to_vec(),
            },
            own_slips: own_slips.to_vec(),
            dissipated: all,
            friction: None,
            own: None,
        };
        step.update(tube, contact, (load, u));
        Some(step)
    }

    /// Takes the normal forces and tangent planes from a state.
    pub fn update(
        &mut self,
        tube: &SplineTube,
        contact: Option<&MeridianContact>,
        (load, u): (&Load, &[f64]),
    ) {
        if tube.has_friction() {
            self.friction = Some(tube.friction(&self.start, load, u));
        }
        if let Some(contact) = rough(contact) {
            let start = (self.start.u.as_slice(), self.own_slips.as_slice());
            self.own = Some(contact.friction(start, u, tube.elastic_slip()));
        }
    }

    /// Returns the history of a state that ends the step: the energy dissipated on each obstacle, of the outer and of the
    /// inner face, the number of numbers of elastic slips on obstacles, these, and those of the wall on itself.
    pub fn history(
        &self,
        tube: &SplineTube,
        contact: Option<&MeridianContact>,
        (load, u): (&Load, &[f64]),
    ) -> Vec<f64> {
        let on = self.on_obstacles(tube, load, u);
        let mut history: Vec<f64> = on.iter().map(|friction| friction.dissipated).collect();
        history.extend(
            self.on_faces(contact, u)
                .map(|friction| friction.dissipated),
        );
        let slips = self.friction.as_ref();
        let slips = slips.map_or(vec![], |friction| tube.elastic_slips(friction, load, u));
        history.push(slips.len() as f64);
        history.extend(slips);
        if let (Some(own), Some(contact)) = (&self.own, contact) {
            history.extend(contact.elastic_slips(own, u));
        }
        history
    }

    /// Returns the friction of a state on each obstacle, with the energy that it has dissipated since the first state.
    pub fn on_obstacles(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Vec<ObstacleFriction> {
        let mut on = match &self.friction {
            Some(friction) => tube.friction_on_obstacles(friction, load, u),
            None => vec![ObstacleFriction::default(); tube.tube.obstacles.len()],
        };
        for (friction, before) in on.iter_mut().zip(&self.dissipated) {
            friction.dissipated += before;
        }
        on
    }

    /// Returns the friction of the outer and the inner face with itself in a state, with the energy that it has dissipated
    /// since the first state.
    pub fn on_faces(&self, contact: Option<&MeridianContact>, u: &[f64]) -> [FaceFriction; 2] {
        let mut on = match (&self.own, contact) {
            (Some(own), Some(contact)) => contact.friction_on_faces(own, u),
            _ => Default::default(),
        };
        let before = &self.dissipated[self.dissipated.len() - 2..];
        for (friction, before) in on.iter_mut().zip(before) {
            friction.dissipated += before;
        }
        on
    }

    /// Adds friction on obstacles to the forces of a state.
    pub fn add_on_obstacles(&self, tube: &SplineTube, load: &Load, u: &[f64], forces: &mut Forces) {
        if let Some(friction) = &self.friction {
            tube.add_friction(friction, load, u, forces);
        }
    }

    /// Returns the friction on obstacles.
    pub fn friction(&self) -> Option<&Friction> {
        self.friction.as_ref()
    }

    /// Returns the friction of the wall with itself.
    pub fn own(&self) -> Option<&SelfFriction> {
        self.own.as_ref()
    }
}
