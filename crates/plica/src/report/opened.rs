//! A tube cut open, as a picture shows it.

use super::Field;
use crate::assembly::{Point, SplineTube};
use crate::draw::{Opening, Surface};
use crate::tube::Load;
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::TAU;

/// What of a tube is shown, and what it is coloured by.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// How much of the wall is taken away, and how finely the rest is drawn.
    pub opening: Opening,
    /// Its colour.
    pub field: Field,
    /// By how much values are multiplied.
    pub factor: f64,
}

/// Pieces along a tube, at least.
const ALONG: usize = 200;

/// Position (z, x, y) and the value of the field.
type Sampled = ([f64; 3], f64);

impl Look {
    /// The near half taken away, coloured by strain energy density.
    pub fn half(tube: &SplineTube) -> Self {
        // Long elements are curved.
        let elements = tube.axial.elements();
        let along = elements * ALONG.div_ceil(elements.max(1)).max(2);
        Self {
            opening: Opening {
                points: [along + 1, 97, 13],
                ..Opening::HALF
            },
            field: Field::EnergyDensity,
            factor: 1.0,
        }
    }

    /// With an angle of the wall taken away, in degrees: 180 the near half, 90 its upper quarter, 0 nothing.
    #[must_use]
    pub fn cut(mut self, degrees: f64) -> Self {
        self.opening.kept = (degrees.to_radians(), TAU);
        let around = 1.0 + 192.0 * (1.0 - degrees / 360.0);
        self.opening.points[1] = around as usize;
        self
    }

    /// What [`Look::cut`] takes away; none if that is nothing.
    pub fn taken_away(&self) -> Option<Self> {
        let mut other = *self;
        other.opening.kept = (0.0, self.opening.kept.0);
        other.opening.points[1] = 194 - self.opening.points[1];
        (self.opening.kept.0 > 0.0).then_some(other)
    }
}

/// The surfaces of a tube with its near half taken away, coloured by strain energy density, in E; the
/// meridian at the angle `upwards` is uppermost.
pub fn opened(tube: &SplineTube, load: &Load, u: &[f64], upwards: f64) -> Vec<Surface> {
    looked_at(tube, load, u, upwards, &Look::half(tube))
}

/// The surfaces of a tube; the meridian at the angle `upwards` is uppermost.
pub fn looked_at(
    tube: &SplineTube,
    load: &Load,
    u: &[f64],
    upwards: f64,
    look: &Look,
) -> Vec<Surface> {
    let along = tube.axial.elements();
    let sample = |zeta: f64, angle: f64, xi: f64| {
        let z = tube.axial.elements_on(zeta * along as f64);
        let radius = tube.tube.inner_radius() + xi * tube.tube.thickness;
        let sample = tube.sample(load, u, Point { z, radius, angle });
        (sample.position, look.factor * look.field.of(&sample))
    };
    // Where every meridian is the same, one is sampled and turned.
    let axisymmetric = tube.sector.rings == 1;
    let known: RefCell<HashMap<[u64; 2], Sampled>> = RefCell::default();
    look.opening.surfaces(|zeta, angle, xi| {
        if !axisymmetric {
            let ([z, x, y], value) = sample(zeta, angle + upwards, xi);
            let (sin, cos) = upwards.sin_cos();
            return ([x * cos + y * sin, y * cos - x * sin, z], value);
        }
        let place = [zeta.to_bits(), xi.to_bits()];
        let ([z, x, y], value) = *known
            .borrow_mut()
            .entry(place)
            .or_insert_with(|| sample(zeta, 0.0, xi));
        let (sin, cos) = angle.sin_cos();
        ([x * cos - y * sin, x * sin + y * cos, z], value)
    })
}
