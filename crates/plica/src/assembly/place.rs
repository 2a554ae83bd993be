//! A place in the wall, as one tells it.

use super::SplineTube;
use crate::tube::Load;
use rayon::prelude::*;

/// A place in the wall at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Along the tube, in D.
    pub z: f64,
    /// Angle around the tube, in radians; none where the tube is axisymmetric, or repeats at every element.
    pub angle: Option<f64>,
    /// How deep in the wall, from 0 at its outside to 1 at its inside.
    pub depth: f64,
}

impl Place {
    /// Angle and depth in words.
    pub fn beside_z(&self) -> String {
        // Whole degrees know no negative zero.
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
    /// A place by its reference coordinates; the angle is that of the middle of an element around the sector.
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

    /// Where the control point of an unknown lies at rest.
    pub fn place_of(&self, unknown: usize) -> Place {
        let (row, within) = (unknown / self.row_size(), unknown % self.row_size());
        let (through, ring) = (within / (3 * self.sector.rings), within % self.sector.rings);
        let place = self.place(self.axial.greville()[row], self.wall.greville()[through], 0);
        Place {
            angle: place.angle.map(|_| self.sector.ring_angle(ring)),
            ..place
        }
    }

    /// Where a state's strain energy density is highest, looked for in the middle of every element and above and below it on both
    /// walls; and how high it is, in E. Where the wall is turned over, between the points at which it is integrated, it is infinite.
    pub fn hardest_strained(&self, load: &Load, u: &[f64]) -> Option<(Place, f64)> {
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
                let density = if sample.is_turned_over() {
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
    fn a_place_is_told_in_words() {
        let beside_z = |angle: Option<f64>, depth| {
            let z = 0.75;
            Place { z, angle, depth }.beside_z()
        };
        assert_eq!(beside_z(None, 0.0), "on the outer wall");
        assert_eq!(beside_z(None, 0.25), "25 % of the wall deep");
        let at = |angle| beside_z(Some(angle), 1.0);
        assert_eq!(at(-FRAC_PI_2), "θ = 270°, on the inner wall");
        assert_eq!(at(-1e-3), "θ = 0°, on the inner wall");
    }

    #[test]
    fn an_unknown_lies_where_its_control_point_does() {
        for rings in [1, 6] {
            let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 6], rings);
            let along = tube.control_values(|z, _, _| [z; 3]);
            let inwards = tube.control_values(|_, r, _| [(0.5 - r) / 0.15; 3]);
            let around = tube.control_values(|_, _, ring| [tube.sector.ring_angle(ring); 3]);
            for unknown in 0..along.len() {
                let place = tube.place_of(unknown);
                assert_eq!(place.z, along[unknown]);
                assert!((place.depth - inwards[unknown]).abs() < 1e-12);
                assert_eq!(place.angle, (rings > 1).then_some(around[unknown]));
            }
        }
    }

    #[test]
    fn a_wall_is_strained_hardest_where_it_is_bent_most() {
        let TubeAndLoad { tube, load } = tube_and_load(3, [12, 2, 12], 12);
        let rest = tube.tube.rest();
        // Wider, by more at the inside or at the outside.
        for (power, depth) in [(-2, 1.0), (4, 0.0)] {
            let u = unknowns(&tube, |_, r, _| [0.0, 1e-3 * (r / 0.5).powi(power), 0.0]);
            let (place, density) = tube.hardest_strained(&rest, &u).unwrap();
            assert_eq!(place.depth, depth);
            assert!(density > 0.0);
        }
        // A bump, at a third of a turn.
        let bump = unknowns(&tube, |z, _, s| {
            let off = (z - 1.0).powi(2) + (s - 1.0 / 3.0).powi(2);
            [0.0, 0.02 * (-off / 0.02).exp(), 0.0]
        });
        let (place, _) = tube.hardest_strained(&rest, &bump).unwrap();
        assert!((place.z - 1.0).abs() < 0.2, "{place:?}");
        let turn = place.angle.unwrap() / TAU;
        assert!((turn - 1.0 / 3.0).abs() < 0.15, "{place:?}");
        // A wall that is turned over is no better for its energy.
        let over = unknowns(&tube, |z, r, s| {
            let off = (z - 1.0).powi(2) + (s - 1.0 / 3.0).powi(2);
            [0.0, 6.0 * (0.425 - r) * (-off / 0.02).exp(), 0.0]
        });
        let (place, density) = tube.hardest_strained(&rest, &over).unwrap();
        assert_eq!(density, f64::INFINITY);
        assert!((place.z - 1.0).abs() < 0.3, "{place:?}");
        // What is not a number is nowhere.
        let nowhere = vec![f64::NAN; bump.len()];
        assert_eq!(tube.hardest_strained(&load, &nowhere), None);
    }
}
