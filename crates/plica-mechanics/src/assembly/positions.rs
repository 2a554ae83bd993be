//! Current positions of a grid of points at one reference radius.

use super::SplineTube;
use super::kinematics::to_element_frame;
use super::tables::CircumferentialPoint;
use rayon::prelude::*;

impl SplineTube {
    /// Returns the current positions (z, x, y) of the points at a reference radius: a row for every axial reference
    /// position, with a point for every reference angle. They are those of [`SplineTube::sample`].
    pub fn positions(
        &self,
        u: &[f64],
        radius: f64,
        reference_z: &[f64],
        angles: &[f64],
    ) -> Vec<Vec<[f64; 3]>> {
        let (rings, alpha) = (self.sector.rings, self.sector.angle());
        let wall = self.wall.evaluate(radius);
        // Element 0 is centred on angle zero.
        let around = |&angle: &f64| {
            let rotations = angle / alpha + 0.5;
            let (element, s) = (rotations.floor(), rotations - rotations.floor());
            let first_ring = (element as i64).rem_euclid(rings as i64) as usize;
            let point = CircumferentialPoint::at(&self.sector, &self.circle, s, 1.0);
            (first_ring, point, (element * alpha).sin_cos())
        };
        let around: Vec<_> = angles.iter().map(around).collect();
        let row = |&z: &f64| {
            let axial = self.axial.evaluate(z);
            // Displacement of every ring at this z and radius, component by component.
            let mut of_ring = vec![0.0; 3 * rings];
            for (a, n) in axial.value.iter().enumerate() {
                for (c, m) in wall.value.iter().enumerate() {
                    let at = (axial.first + a) * self.row_size() + (wall.first + c) * 3 * rings;
                    let u = &u[at..at + 3 * rings];
                    of_ring
                        .iter_mut()
                        .zip(u)
                        .for_each(|(sum, u)| *sum += n * m * u);
                }
            }
            let position =
                |(first, point, (sin, cos)): &(usize, CircumferentialPoint, (f64, f64))| {
                    let reference = [z, radius * point.circle.0, radius * point.circle.1];
                    let rings_here = point.ring_values.iter().enumerate();
                    let x = rings_here.fold(reference, |sum, (r, values)| {
                        let ring = (first + r) % rings;
                        to_element_frame(
                            values,
                            0,
                            [0, 1, 2].map(|i| of_ring[i * rings + ring]),
                            sum,
                        )
                    });
                    [x[0], x[1] * cos - x[2] * sin, x[1] * sin + x[2] * cos]
                };
            around.iter().map(position).collect()
        };
        reference_z.par_iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Point;
    use super::super::tests::{TubeAndLoad, tube_and_load, unknowns};

    #[test]
    fn positions_of_a_grid_are_those_of_its_points() {
        for rings in [1, 2, 6] {
            let TubeAndLoad { tube, load } = tube_and_load(3, [5, 2, 6], rings);
            let u = unknowns(&tube, |z, r, s| {
                [0.1 * z * s, 0.2 * r + 0.1 * s * s, 0.3 * z + 0.1 * s]
            });
            let (z, angles) = ([0.0, 0.7, 1.0], [-4.0, 0.0, 0.3, 2.0, 6.0]);
            let radius = 0.45;
            let found = tube.positions(&u, radius, &z, &angles);
            for (row, &z) in found.iter().zip(&z) {
                for (position, &angle) in row.iter().zip(&angles) {
                    let sample = tube.sample(&load, &u, Point { z, radius, angle });
                    for (a, b) in position.iter().zip(sample.position) {
                        assert!((a - b).abs() < 1e-14, "{position:?} {sample:?}");
                    }
                }
            }
        }
    }
}
