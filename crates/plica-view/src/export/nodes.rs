//! Points of a lattice over the wall, and what is known there.

use super::node::{Node, Turn};
use crate::vtk::Lattice;
use plica::assembly::{Point, SplineTube};
use plica::tube::Load;
use rayon::prelude::*;

/// The points of one sector, outwards, then around, then along; the others are those, turned.
pub struct Nodes {
    lattice: Lattice,
    nodes: Vec<Node>,
    /// Points around one sector.
    around: usize,
    turns: Vec<Turn>,
}

impl Nodes {
    /// Every element cut into as many spans as the degree: with the points of Lagrange cells.
    pub fn lattice(tube: &SplineTube) -> Lattice {
        let degree = tube.degree();
        let elements = [
            tube.wall.elements(),
            tube.sector.around,
            tube.axial.elements(),
        ];
        Lattice {
            spans: elements.map(|elements| degree * elements),
            degree,
        }
    }

    /// Through the wall from face to face; around and along every element cut into as many pieces as it takes to so many
    /// facets, three at most.
    pub fn lattice_of_walls(tube: &SplineTube, facets: [usize; 2]) -> Lattice {
        let elements = [tube.sector.around, tube.axial.elements()];
        let pieces = |i: usize| facets[i].div_ceil(elements[i]).clamp(1, 3);
        Lattice {
            spans: [1, pieces(0) * elements[0], pieces(1) * elements[1]],
            degree: 1,
        }
    }

    /// The points of a lattice over a state.
    pub fn of(tube: &SplineTube, load: &Load, u: &[f64], lattice: Lattice) -> Self {
        let [outwards, all_around, along] = lattice.points();
        let sectors = tube.sector.around / tube.sector.rings;
        let around = all_around / sectors;
        let per_element = all_around / tube.sector.around;
        let radii = tube.wall.spread(outwards);
        let zs = tube.axial.spread(along);
        let rows = zs.par_iter().flat_map_iter(|&z| {
            let radii = &radii;
            (0..around).flat_map(move |j| {
                // Element 0 is centred on angle zero.
                let turns = j as f64 / per_element as f64 - 0.5;
                let angle = turns * tube.sector.angle();
                radii
                    .iter()
                    .map(move |&radius| Node::of(&tube.sample(load, u, Point { z, radius, angle })))
            })
        });
        let sector = tube.sector.angle() * tube.sector.rings as f64;
        Self {
            lattice,
            nodes: rows.collect(),
            around,
            turns: (0..sectors).map(|k| Turn::by(sector * k as f64)).collect(),
        }
    }

    /// Something of every point of the lattice, in its order: of a point of the sector, and the turn from there.
    pub fn all<T, F: Fn(&Node, &Turn) -> T>(&self, of: F) -> impl Iterator<Item = T> {
        let [outwards, around, along] = self.lattice.points();
        (0..outwards * around * along).map(move |point| {
            let (i, j, k) = (
                point % outwards,
                point / outwards % around,
                point / outwards / around,
            );
            let (own, turn) = (j % self.around, &self.turns[j / self.around]);
            of(&self.nodes[i + outwards * (own + self.around * k)], turn)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// A tube of `rings` rings of 12.
    fn tube(rings: usize) -> SplineTube {
        SplineTube::new(&fixture::short(), &fixture::coarse(), rings)
    }

    fn nodes(tube: &SplineTube, lattice: Lattice) -> Vec<Node> {
        // Wider along the tube, and twisted.
        let u = tube.control_values(|z, r, _| [0.1 * z * z, 0.2 * z * r, 0.3 * z * r]);
        let nodes = Nodes::of(tube, &tube.tube.rest(), &u, lattice);
        let turned = nodes.all(|node, turn| Node {
            position: turn.of(node.position),
            displacement: turn.of_short(node.displacement),
            stress: turn.of_tensor(node.stress),
            directions: node.directions.map(|v| turn.of_short(v)),
            ..*node
        });
        turned.collect()
    }

    #[test]
    fn a_ring_that_is_turned_is_the_whole_tube() {
        let (one, whole) = (tube(1), tube(12));
        for lattice in [Nodes::lattice(&one), Nodes::lattice_of_walls(&one, [36, 9])] {
            let (a, b) = (nodes(&one, lattice), nodes(&whole, lattice));
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
    fn points_lie_at_the_ends_of_elements_and_evenly_between() {
        let tube = tube(1);
        let lattice = Nodes::lattice(&tube);
        let [outwards, around, along] = lattice.points();
        assert_eq!([outwards, around, along], [4, 36, 10]);
        let z = tube.axial.spread(along);
        assert!((z[0], z[9]) == (0.0, 1.0) && (z[3] - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(tube.wall.spread(2), [0.4, 0.5]);
    }
}
