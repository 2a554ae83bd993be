//! A tube and its contact, sampled at material points of states.

use plica::assembly::{Point, Sample, SplineTube};
use plica::contact::{Face, PressedPoint, PressureField, SelfContact};
use plica::study::Plan;
use plica::tube::{Load, Tube};
use std::ops::Deref;

/// Distance from a face, in D, within which a point is on it.
const ON_FACE: f64 = 1e-9;

/// The tube of a plan on its mesh, with its contact if the plan has that.
pub struct SampledTube {
    tube: SplineTube,
    contact: Option<SelfContact>,
}

/// A state of a tube.
pub struct SampledState<'a> {
    tube: &'a SplineTube,
    load: &'a Load,
    u: &'a [f64],
    pressure: Option<PressureField<'a>>,
}

/// Fields at a material point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldSample {
    /// Fields of the wall.
    pub wall: Sample,
    /// Pressure of contact, per current area, in E; zero inside the wall.
    pub contact_pressure: f64,
}

impl Deref for FieldSample {
    type Target = Sample;

    fn deref(&self) -> &Sample {
        &self.wall
    }
}

impl Deref for SampledTube {
    type Target = SplineTube;

    fn deref(&self) -> &SplineTube {
        &self.tube
    }
}

impl SampledTube {
    /// Makes the tube of a plan.
    pub fn of(plan: &Plan) -> Self {
        let tube = SplineTube::new(&plan.tube, &plan.mesh, plan.mesh.rings(plan.symmetry));
        Self {
            contact: plan.contact.then(|| SelfContact::new(&tube)),
            tube,
        }
    }

    /// Returns whether the walls can touch.
    pub fn has_contact(&self) -> bool {
        self.contact.is_some()
    }

    /// Returns the quadrature points of a face that are under the pressure of its contact with itself.
    pub fn pressed_points(&self, u: &[f64], face: Face) -> Vec<PressedPoint> {
        let contact = self.contact.as_ref();
        contact.map_or(vec![], |contact| contact.pressed_points(u, face))
    }

    /// Prepares a state for sampling.
    pub fn state<'a>(&'a self, load: &'a Load, u: &'a [f64]) -> SampledState<'a> {
        SampledState {
            pressure: self
                .contact
                .as_ref()
                .map(|contact| contact.pressure(&self.tube, u)),
            ..SampledState::without_contact(&self.tube, load, u)
        }
    }
}

impl<'a> SampledState<'a> {
    /// Prepares a state of a tube without contact.
    pub fn without_contact(tube: &'a SplineTube, load: &'a Load, u: &'a [f64]) -> Self {
        Self {
            tube,
            load,
            u,
            pressure: None,
        }
    }

    /// Returns the tube.
    pub fn tube(&self) -> &SplineTube {
        self.tube
    }

    /// Evaluates the fields at a material point.
    pub fn at(&self, point: Point) -> FieldSample {
        let is_on = |radius: f64| (point.radius - radius).abs() < ON_FACE;
        let pressure = |field: &PressureField<'_>| {
            let face = if is_on(Tube::OUTER_RADIUS) {
                Face::Outer
            } else if is_on(self.tube.tube.inner_radius()) {
                Face::Inner
            } else {
                return 0.0;
            };
            field.at(face, point.z, point.angle)
        };
        FieldSample {
            wall: self.tube.sample(self.load, self.u, point),
            contact_pressure: self.pressure.as_ref().map_or(0.0, pressure),
        }
    }
}
