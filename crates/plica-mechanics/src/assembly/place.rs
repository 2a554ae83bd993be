//! Places in the wall, and the search for the largest energy density.

use super::SplineTube;
use crate::tube::Load;
use rayon::prelude::*;

/// A place in the wall at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Position along the tube, in D.
    pub z: f64,
    /// Angle around the tube, in radians; none if the tube is axisymmetric or repeats at every
    /// element.
    pub angle: Option<f64>,
    /// Depth in the wall, from 0 at the outside to 1 at the inside.
    pub depth: f64,
}

impl Place {
    /// Describes angle and depth in words.
    pub fn angle_and_depth(&self) -> String {
        // An integer has no negative zero.
        let degrees = |angle: f64| (angle.to_degrees().round() as i64).rem_euclid(360);
        let angle =
            (self.angle).map_or(String::new(), |angle| format!("θ = {}°, ", degrees(angle)));
        angle
            + &match 100.0 * self.depth {
                depth if depth < 0.5 => "on the outer wall".into(),
                depth if depth >= 99.5 => "on the inner wall".into(),
                depth => format!("{depth:.0} % of the wall deep"),
            }
    }
}

impl SplineTube {
    /// Returns a place by its reference coordinates; the angle is that of the middle of an element
    /// around the sector.
    pub(super) fn place(&self, z: f64, radius: f64, around: usize) -> Place {
        let angle = self.sector.angle() * around as f64;
        let tube = &self.tube;
        let depth = (tube.inner_radius() + tube.thickness - radius) / tube.thickness;
        Place {
            z,
            angle: (self.sector.rings > 1).then_some(angle),
            depth: depth.clamp(0.0, 1.0),
        }
    }

    /// Returns the place at rest of the control point of an unknown.
    pub fn place_of_unknown(&self, unknown: usize) -> Place {
        let (row, within) = (unknown / self.row_size(), unknown % self.row_size());
        let (through, ring) = (within / (3 * self.sector.rings), within % self.sector.rings);
        let place = self.place(self.axial.greville()[row], self.wall.greville()[through], 0);
        Place {
            angle: place.angle.map(|_| self.sector.ring_angle(ring)),
            ..place
        }
    }

    /// Returns the place with the highest strain energy density of a state, and the density in E.
    /// Evaluates the middle of every element, and the points above and below it on both walls. The
    /// density is infinite where the wall is inverted.
    pub fn max_energy_density(&self, load: &Load, u: &[f64]) -> Option<(Place, f64)> {
        let tube = &self.tube;
        let (inner, thickness) = (tube.inner_radius(), tube.thickness);
        let radii = [inner, inner + 0.5 * thickness, inner + thickness];
        let of_element = |element: usize| {
            let (from, to) = self.axial.element(element);
            let z = f64::midpoint(from, to);
            let places =
                (0..self.sector.rings).flat_map(|around| radii.map(|radius| (radius, around)));
            let density = |(radius, around): (f64, usize)| {
                let angle = self.sector.angle() * around as f64;
                let at = super::Point { z, radius, angle };
                let sample = self.sample(load, u, at);
                let density = if sample.is_inverted() {
                    f64::INFINITY
                } else {
                    sample.energy_density
                };
                (self.place(z, radius, around), density)
            };
            places
                .map(density)
                .filter(|(_, density)| !density.is_nan())
                .max_by(|a, b| a.1.total_cmp(&b.1))
        };
        let highest: Vec<_> = (0..self.axial.elements())
            .into_par_iter()
            .filter_map(of_element)
            .collect();
        highest.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{TubeAndLoad, tube_and_load, unknowns};
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    #[test]
    fn place_is_described_in_words() {
        let angle_and_depth = |angle: Option<f64>, depth| {
            let z = 0.75;
            Place { z, angle, depth }.angle_and_depth()
        };
        assert_eq!(angle_and_depth(None, 0.0), "on the outer wall");
        assert_eq!(angle_and_depth(None, 0.25), "25 % of the wall deep");
        let at = |angle| angle_and_depth(Some(angle), 1.0);
        assert_eq!(at(-FRAC_PI_2), "θ = 270°, on the inner wall");
        assert_eq!(at(-1e-3), "θ = 0°, on the inner wall");
    }

    #[test]
    fn place_of_unknown_is_that_of_its_control_point() {
        for rings in [1, 6] {
            let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], rings);
            let along = tube.control_values_from(|z, _, _| [z; 3]);
            let inwards = tube.control_values_from(|_, r, _| [(0.5 - r) / 0.15; 3]);
            let around = tube.control_values_from(|_, _, ring| [tube.sector.ring_angle(ring); 3]);
            for unknown in 0..along.len() {
                let place = tube.place_of_unknown(unknown);
                assert_eq!(place.z, along[unknown]);
                assert!((place.depth - inwards[unknown]).abs() < 1e-12);
                assert_eq!(place.angle, (rings > 1).then_some(around[unknown]));
            }
        }
    }

    #[test]
    fn max_energy_density_is_found_at_the_largest_deformation() {
        let TubeAndLoad { tube, load } = tube_and_load(3, [12, 2, 12], 12);
        let rest = tube.tube.rest();
        // Wider, and more so at the inside or at the outside.
        for (power, depth) in [(-2, 1.0), (4, 0.0)] {
            let u = unknowns(&tube, |_, r, _| [0.0, 1e-3 * (r / 0.5).powi(power), 0.0]);
            let (place, density) = tube.max_energy_density(&rest, &u).unwrap();
            assert_eq!(place.depth, depth);
            assert!(density > 0.0);
        }
        // A bump at a third of the circumference.
        let bump = unknowns(&tube, |z, _, s| {
            let off = (z - 1.0).powi(2) + (s - 1.0 / 3.0).powi(2);
            [0.0, 0.02 * (-off / 0.02).exp(), 0.0]
        });
        let (place, _) = tube.max_energy_density(&rest, &bump).unwrap();
        assert!((place.z - 1.0).abs() < 0.07, "{place:?}");
        let turn = place.angle.unwrap() / TAU;
        assert!((turn - 1.0 / 3.0).abs() < 0.09, "{place:?}");
        // An inverted wall counts as infinite.
        let over = unknowns(&tube, |z, r, s| {
            let off = (z - 1.0).powi(2) + (s - 1.0 / 3.0).powi(2);
            [0.0, 6.0 * (0.425 - r) * (-off / 0.02).exp(), 0.0]
        });
        let (place, density) = tube.max_energy_density(&rest, &over).unwrap();
        assert_eq!(density, f64::INFINITY);
        assert!((place.z - 1.0).abs() < 0.2, "{place:?}");
        // NaN has no place.
        let nowhere = vec![f64::NAN; bump.len()];
        assert_eq!(tube.max_energy_density(&load, &nowhere), None);
    }
}
