//! The pressure of contact at points of a face.

use super::meridian::MeridianPressure;
use super::surfaces::SurfacePressure;
use super::{Face, SelfContact};
use crate::assembly::SplineTube;

/// A quadrature point of a face under pressure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressedPoint {
    /// Current axial position, in D.
    pub z: f64,
    /// Current area on the whole tube, in D².
    pub area: f64,
    /// Pressure of contact, per current area, in E.
    pub pressure: f64,
}

/// The pressure of contact in a state.
///
/// The energy ½ ∫ b dA₀ gives both points of a pair half of their common force, so the pressure at x is
/// −½ b′ (dA₀/da|x + dA₀/da|y), summed over the points y that x is in contact with.
pub struct PressureField<'a> {
    tube: &'a SplineTube,
    of: Pressure<'a>,
}

enum Pressure<'a> {
    Meridian(MeridianPressure<'a>),
    Surface(SurfacePressure<'a>),
}

impl PressureField<'_> {
    /// Returns the pressure, force per current area in E, at a place of a face at rest: its axial position in D and its angle
    /// in radians.
    pub fn at(&self, face: Face, z: f64, angle: f64) -> f64 {
        let along = place(self.tube, z);
        match &self.of {
            Pressure::Meridian(pressure) => pressure.at(face, along),
            Pressure::Surface(pressure) => {
                let sector = &self.tube.sector;
                // Element 0 is centred on angle zero.
                let turns = angle / sector.angle() + 0.5;
                let element = turns.floor();
                let around = (element as i64).rem_euclid(sector.around as i64) as usize;
                pressure.at(face, [along.0, around], [along.1, turns - element])
            }
        }
    }
}

/// Returns the element of an axial position at rest, and the position from 0 to 1 in it.
fn place(tube: &SplineTube, z: f64) -> (usize, f64) {
    let element = tube.axial.evaluate(z).element;
    let (from, to) = tube.axial.element(element);
    (element, ((z - from) / (to - from)).clamp(0.0, 1.0))
}

impl SelfContact {
    /// Returns the pressure of contact in a state of a tube.
    pub fn pressure<'a>(&'a self, tube: &'a SplineTube, u: &[f64]) -> PressureField<'a> {
        let of = match self {
            Self::Meridian(contact) => Pressure::Meridian(contact.pressure(u)),
            Self::Surface(contact) => Pressure::Surface(contact.pressure(u)),
        };
        PressureField { tube, of }
    }

    /// Returns the quadrature points of a face that are under pressure. The sum of pressure times area is twice the force
    /// between the two sides of the contact.
    pub fn pressed_points(&self, u: &[f64], face: Face) -> Vec<PressedPoint> {
        match self {
            Self::Meridian(contact) => contact.pressed_points(u, face),
            Self::Surface(contact) => contact.pressed_points(u, face),
        }
    }
}
