//! Sampling of the wall at the points of a lattice.

use super::point::{PointData, Rotation};
use crate::sampled_tube::SampledState;
use crate::vtk::Lattice;
use plica::assembly::{Point, SplineTube};
use rayon::prelude::*;

/// Samples of one sector, ordered outwards, then around, then along; the other sectors are rotated copies.
pub(super) struct Points {
    lattice: Lattice,
    sector: Vec<PointData>,
    /// Points around one sector.
    around: usize,
    rotations: Vec<Rotation>,
}

/// Returns the lattice of the Lagrange cells: every element has as many intervals as the degree.
pub(super) fn volume_lattice(tube: &SplineTube) -> Lattice {
    let degree = tube.degree();
    let elements = [
        tube.wall.elements(),
        tube.sector.around,
        tube.axial.elements(),
    ];
    Lattice {
        intervals: elements.map(|elements| degree * elements),
        degree,
    }
}

/// Returns a lattice with one interval through the wall. Around and along, every element has as many intervals as `facets`
/// requires, at most three.
pub(super) fn boundary_lattice(tube: &SplineTube, facets: [usize; 2]) -> Lattice {
    let elements = [tube.sector.around, tube.axial.elements()];
    let per_element = |i: usize| facets[i].div_ceil(elements[i]).clamp(1, 3);
    Lattice {
        intervals: [
            1,
            per_element(0) * elements[0],
            per_element(1) * elements[1],
        ],
        degree: 1,
    }
}

/// Returns a lattice of one meridian, with at most three intervals per element and a largest number of intervals through the wall
/// and along.
pub(super) fn meridian_lattice(tube: &SplineTube, most: [usize; 2]) -> Lattice {
    let elements = [tube.wall.elements(), tube.axial.elements()];
    let intervals = |i: usize| most[i].min(3 * elements[i]);
    Lattice {
        intervals: [intervals(0), 1, intervals(1)],
        degree: 1,
    }
}

impl Points {
    /// Samples a state at the points of a lattice of the meridian at angle zero.
    pub fn meridian(state: &SampledState<'_>, lattice: Lattice) -> Self {
        let tube = state.tube();
        let [outwards, _, along] = lattice.points();
        let radii = tube.wall.positions(outwards);
        let zs = tube.axial.positions(along);
        let points = zs.par_iter().flat_map_iter(|&z| {
            radii.iter().map(move |&radius| {
                let at = Point {
                    z,
                    radius,
                    angle: 0.0,
                };
                PointData::new(&state.at(at))
            })
        });
        Self {
            lattice,
            sector: points.collect(),
            around: 1,
            rotations: vec![Rotation::by(0.0)],
        }
    }

    /// Samples a state at the points of a lattice.
    pub fn sample(state: &SampledState<'_>, lattice: Lattice) -> Self {
        let tube = state.tube();
        let [outwards, all_around, along] = lattice.points();
        let sectors = tube.sector.around / tube.sector.rings;
        let around = all_around / sectors;
        let per_element = all_around / tube.sector.around;
        let radii = tube.wall.positions(outwards);
        let zs = tube.axial.positions(along);
        let rows = zs.par_iter().flat_map_iter(|&z| {
            let radii = &radii;
            (0..around).flat_map(move |j| {
                // Element 0 is centred on angle zero.
                let elements = j as f64 / per_element as f64 - 0.5;
                let angle = elements * tube.sector.angle();
                radii
                    .iter()
                    .map(move |&radius| PointData::new(&state.at(Point { z, radius, angle })))
            })
        });
        let sector = tube.sector.angle() * tube.sector.rings as f64;
        Self {
            lattice,
            sector: rows.collect(),
            around,
            rotations: (0..sectors)
                .map(|k| Rotation::by(sector * k as f64))
                .collect(),
        }
    }

    /// Applies a function to all points of the lattice in order. Its arguments are the sample within the first sector and the
    /// rotation to the point.
    pub fn evaluate<T, F: Fn(&PointData, &Rotation) -> T>(&self, of: F) -> impl Iterator<Item = T> {
        let [outwards, around, along] = self.lattice.points();
        (0..outwards * around * along).map(move |point| {
            let (i, j, k) = (
                point % outwards,
                point / outwards % around,
                point / outwards / around,
            );
            let (own, rotation) = (j % self.around, &self.rotations[j / self.around]);
            of(
                &self.sector[i + outwards * (own + self.around * k)],
                rotation,
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// A tube whose sector has `rings` of 12 rings.
    fn tube(rings: usize) -> SplineTube {
        SplineTube::new(&fixture::short(), &fixture::coarse(), rings)
    }

    fn points(tube: &SplineTube, lattice: Lattice) -> Vec<PointData> {
        // Wider along the tube, and twisted.
        let u = tube.control_values_from(|z, r, _| [0.1 * z * z, 0.2 * z * r, 0.3 * z * r]);
        let load = tube.tube.rest();
        let state = SampledState::without_contact(tube, &load, &u);
        let points = Points::sample(&state, lattice);
        let rotated = points.evaluate(|point, rotation| PointData {
            position: rotation.vector(point.position),
            displacement: rotation.vector_f32(point.displacement),
            stress: rotation.tensor(point.stress),
            directions: point.directions.map(|v| rotation.vector_f32(v)),
            ..*point
        });
        rotated.collect()
    }

    #[test]
    fn rotated_copies_of_a_sector_equal_the_whole_tube() {
        let (one, whole) = (tube(1), tube(12));
        for lattice in [volume_lattice(&one), boundary_lattice(&one, [36, 9])] {
            let (a, b) = (points(&one, lattice), points(&whole, lattice));
            assert_eq!(a.len(), lattice.points().iter().product::<usize>());
            assert_eq!(a.len(), b.len());
            for (a, b) in a.iter().zip(&b) {
                let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-5, "{a} {b}");
                for i in 0..3 {
                    assert!((a.position[i] - b.position[i]).abs() < 1e-12);
                    near(a.displacement[i], b.displacement[i]);
                    near(a.stretches[i], b.stretches[i]);
                }
                (0..6).for_each(|i| near(a.stress[i], b.stress[i]));
                (0..6).for_each(|i| near(a.strain[i], b.strain[i]));
            }
        }
    }

    #[test]
    fn points_are_equally_spaced_within_elements() {
        let tube = tube(1);
        let lattice = volume_lattice(&tube);
        let [outwards, around, along] = lattice.points();
        assert_eq!([outwards, around, along], [4, 36, 10]);
        let z = tube.axial.positions(along);
        assert!((z[0], z[9]) == (0.0, 1.0) && (z[3] - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(tube.wall.positions(2), [0.4, 0.5]);
    }
}
