//! A tube cut open, as a picture shows it.

use crate::assembly::{Point, SplineTube};
use crate::draw::{Opening, Surface};
use crate::tube::Load;
use std::cell::RefCell;
use std::collections::HashMap;

/// Position (z, x, y) and strain energy density.
type Sampled = ([f64; 3], f64);

/// The surfaces of a tube with its near half taken away, coloured by strain energy density; the
/// meridian at the angle `upwards` is uppermost.
pub fn opened(tube: &SplineTube, load: &Load, u: &[f64], upwards: f64) -> Vec<Surface> {
    let along = tube.axial.elements();
    let opening = Opening {
        points: [2 * along + 1, 97, 13],
        ..Opening::HALF
    };
    let sample = |zeta: f64, angle: f64, xi: f64| {
        let at = zeta * along as f64;
        let element = (at as usize).min(along - 1);
        let (from, to) = tube.axial.element(element);
        let z = from + (to - from) * (at - element as f64);
        let radius = tube.tube.inner_radius() + xi * tube.tube.thickness;
        let sample = tube.sample(load, u, Point { z, radius, angle });
        // What rounding leaves of a wall without stress is no energy.
        let density = sample.energy_density;
        (sample.position, if density < 1e-12 { 0.0 } else { density })
    };
    // Where every meridian is the same, one is sampled and turned.
    let axisymmetric = tube.sector.rings == 1;
    let known: RefCell<HashMap<[u64; 2], Sampled>> = RefCell::default();
    opening.surfaces(|zeta, angle, xi| {
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
