//! Volume of the lumen and its derivative.

use super::volume::{sum, volume_slopes};
use super::{LoadedWall, SplineTube};
use std::f64::consts::PI;

impl SplineTube {
    /// Returns the volume V of the lumen of the whole tube between ends that stay in planes z = const: that of a circular
    /// cylinder at zero displacement, and the change by the displacement, whose work under a unit follower pressure it is.
    pub fn lumen_volume(&self, u: &[f64]) -> f64 {
        let wall = self.unit_wall();
        let parts = self.integrate_over_wall(&wall, [u], |[moved], point| {
            ([-wall.potential(&moved, point), 0.0, 0.0], [[0.0; 3]; 3])
        });
        let change: f64 = parts.iter().map(|part| part.energies[0]).sum();
        self.lumen_volume_of_cylinder() + self.sector.repeats() * change
    }

    /// Returns the volume of the lumen at zero displacement.
    pub fn lumen_volume_of_cylinder(&self) -> f64 {
        PI * self.tube.inner_radius().powi(2) * self.tube.length
    }

    /// Returns the volume of the lumen of the stress-free shape.
    pub fn lumen_volume_at_rest(&self) -> f64 {
        match self.geometric_imperfection() {
            Some(shape) => self.lumen_volume(shape),
            None => self.lumen_volume(&vec![0.0; self.unknowns()]),
        }
    }

    /// Returns ∂V/∂u of every unknown of the sector, over the number of sectors around: the forces of a unit follower
    /// pressure on the inner wall.
    pub fn lumen_volume_slope(&self, u: &[f64]) -> Vec<f64> {
        let wall = self.unit_wall();
        let parts = self.integrate_over_wall(&wall, [u], |[moved], point| {
            let position = sum(&wall.at_rest(point), &moved);
            ([0.0; 3], volume_slopes(&position))
        });
        let mut slope = vec![0.0; u.len()];
        self.add_wall_forces(&wall, &parts, 1.0, &mut slope);
        slope
    }

    /// Returns the inner wall under a unit follower pressure.
    fn unit_wall(&self) -> LoadedWall {
        LoadedWall {
            follower: 1.0,
            ..self.bare_wall(0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::tests::{TubeAndLoad, direction, dot, moved, tube_and_load, wavy};
    use crate::tube::Tube;
    use std::f64::consts::PI;

    #[test]
    fn an_expanded_cylinder_has_its_volume() {
        let TubeAndLoad { tube, .. } = tube_and_load(3, [5, 2, 60], 1);
        let u = tube
            .control_values_from(|z, r, _| [0.2 * z, 0.1 * r * tube.circle.control_radius, 0.0]);
        let Tube { length, .. } = tube.tube;
        let expected = PI * (1.1 * tube.tube.inner_radius()).powi(2) * 1.2 * length;
        assert!((tube.lumen_volume(&u) / expected - 1.0).abs() < 1e-11);
        let rest = PI * tube.tube.inner_radius().powi(2) * length;
        assert!((tube.lumen_volume_at_rest() / rest - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_volume_in_every_symmetry() {
        for rings in [6, 3, 1] {
            let TubeAndLoad { tube, .. } = tube_and_load(3, [9, 2, 6], rings);
            let (u, v) = (wavy(&tube), direction(&tube));
            let volume = |h: f64| tube.lumen_volume(&moved(&u, &v, h));
            // V is a cubic in u.
            let [h, d] = [1e-2, 2e-2].map(|h| (volume(h) - volume(-h)) / (2.0 * h));
            let difference = (4.0 * h - d) / 3.0;
            let slope = tube.sector.repeats() * dot(&tube.lumen_volume_slope(&u), &v);
            assert!(
                (difference / slope - 1.0).abs() < 1e-9,
                "{rings} rings: {difference} {slope}"
            );
        }
    }
}
