//! Cells of a structured grid that is periodic in its second direction.

use super::lagrange::lagrange_hexahedron;

/// A structured grid of points (i, j, k), the first index varying fastest. It is periodic in j.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// Intervals between points in each direction.
    pub intervals: [usize; 3],
    /// Polynomial degree of the Lagrange cells; the numbers of intervals are multiples of it.
    pub degree: usize,
}

/// Cells of one type, defined by the indices of their points.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Points of all cells, cell by cell.
    pub points: Vec<i64>,
    /// Number of points per cell.
    pub points_per_cell: usize,
    /// Number of the cell type in VTK.
    pub cell_type: u8,
}

impl Cells {
    /// Makes triangles of the indices of their points, three each.
    pub fn triangles(points: Vec<i64>) -> Self {
        Self {
            points,
            points_per_cell: 3,
            cell_type: TRIANGLE,
        }
    }
}

/// VTK_TRIANGLE.
const TRIANGLE: u8 = 5;
/// VTK_QUAD.
const QUADRILATERAL: u8 = 9;
/// VTK_HEXAHEDRON.
const HEXAHEDRON: u8 = 12;
/// VTK_LAGRANGE_HEXAHEDRON.
const LAGRANGE_HEXAHEDRON: u8 = 72;

impl Lattice {
    /// Returns the number of points in each direction.
    pub fn points(&self) -> [usize; 3] {
        let [i, j, k] = self.intervals;
        [i + 1, j, k + 1]
    }

    /// Returns the index of a point.
    fn index(&self, [i, j, k]: [usize; 3]) -> i64 {
        let [across, around, _] = self.points();
        (i + across * (j % around + around * k)) as i64
    }

    /// Returns Lagrange hexahedra of the degree.
    pub fn lagrange(&self) -> Cells {
        self.hexahedra(self.degree, LAGRANGE_HEXAHEDRON)
    }

    /// Returns linear hexahedra between neighbouring points.
    pub fn linear(&self) -> Cells {
        self.hexahedra(1, HEXAHEDRON)
    }

    fn hexahedra(&self, degree: usize, cell_type: u8) -> Cells {
        let nodes = lagrange_hexahedron(degree);
        let [across, around, along] = self.intervals.map(|n| n / degree);
        let mut points = Vec::with_capacity(across * around * along * nodes.len());
        for k in 0..along {
            for j in 0..around {
                for i in 0..across {
                    let at =
                        |n: &[usize; 3]| [i * degree + n[0], j * degree + n[1], k * degree + n[2]];
                    points.extend(nodes.iter().map(|n| self.index(at(n))));
                }
            }
        }
        Cells {
            points,
            points_per_cell: nodes.len(),
            cell_type,
        }
    }

    /// Returns the quadrilaterals of the first layer in the second direction.
    pub fn section(&self) -> Cells {
        let [across, _, along] = self.intervals;
        let mut points = Vec::with_capacity(4 * across * along);
        for k in 0..along {
            for i in 0..across {
                let corners = [[i, 0, k], [i + 1, 0, k], [i + 1, 0, k + 1], [i, 0, k + 1]];
                points.extend(corners.map(|at| self.index(at)));
            }
        }
        Cells {
            points,
            points_per_cell: 4,
            cell_type: QUADRILATERAL,
        }
    }

    /// Returns the boundary quadrilaterals with outward normals, and the number of the face of each: 0 and 1 for the lower and
    /// upper end of the first direction, 2 and 3 for those of the last.
    pub fn boundary(&self) -> (Cells, Vec<u8>) {
        let [across, around, along] = self.intervals;
        let (mut points, mut faces) = (vec![], vec![]);
        let mut add = |face: u8, corners: [[usize; 3]; 4], outwards: bool| {
            let mut corners = corners.map(|at| self.index(at));
            if !outwards {
                corners.reverse();
            }
            points.extend(corners);
            faces.push(face);
        };
        for (face, i) in [(0, 0), (1, across)] {
            for k in 0..along {
                for j in 0..around {
                    let corners = [[i, j, k], [i, j + 1, k], [i, j + 1, k + 1], [i, j, k + 1]];
                    add(face, corners, face == 1);
                }
            }
        }
        for (face, k) in [(2, 0), (3, along)] {
            for j in 0..around {
                for i in 0..across {
                    let corners = [[i, j, k], [i + 1, j, k], [i + 1, j + 1, k], [i, j + 1, k]];
                    add(face, corners, face == 3);
                }
            }
        }
        let cells = Cells {
            points,
            points_per_cell: 4,
            cell_type: QUADRILATERAL,
        };
        (cells, faces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATTICE: Lattice = Lattice {
        intervals: [2, 12, 4],
        degree: 2,
    };

    /// Position of a point of a thick ring.
    fn position(number: i64) -> [f64; 3] {
        let [across, around, _] = LATTICE.points();
        let number = number as usize;
        let (i, j, k) = (
            number % across,
            number / across % around,
            number / across / around,
        );
        let angle = std::f64::consts::TAU * j as f64 / around as f64;
        let radius = 1.0 + 0.1 * i as f64;
        [radius * angle.cos(), radius * angle.sin(), 0.2 * k as f64]
    }

    /// Six times the volume of the tetrahedron between a triangle and the origin.
    fn volume_to_origin([a, b, c]: [i64; 3]) -> f64 {
        let [a, b, c] = [a, b, c].map(position);
        let across = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            b[j] * c[k] - b[k] * c[j]
        });
        a[0] * across[0] + a[1] * across[1] + a[2] * across[2]
    }

    #[test]
    fn the_boundary_is_closed_with_outward_normals() {
        let (cells, faces) = LATTICE.boundary();
        assert_eq!(faces.len(), cells.points.len() / cells.points_per_cell);
        let mut edges = std::collections::BTreeMap::new();
        let mut volume = 0.0;
        for quad in cells.points.chunks(4) {
            for i in 0..4 {
                let (from, to) = (quad[i], quad[(i + 1) % 4]);
                *edges.entry((from.min(to), from.max(to))).or_insert(0) +=
                    if from < to { 1 } else { -1 };
            }
            volume += (volume_to_origin([quad[0], quad[1], quad[2]])
                + volume_to_origin([quad[0], quad[2], quad[3]]))
                / 6.0;
        }
        assert!(edges.values().all(|&sum| sum == 0));
        // Area of a regular polygon with twelve corners.
        let polygon = 12.0 * 0.5 * (std::f64::consts::TAU / 12.0).sin();
        let expected = polygon * (1.2_f64.powi(2) - 1.0) * 0.8;
        assert!((volume - expected).abs() < 1e-12, "{volume} {expected}");
    }

    #[test]
    fn cells_have_positive_volume() {
        for cells in [LATTICE.lagrange(), LATTICE.linear()] {
            for cell in cells.points.chunks(cells.points_per_cell) {
                let at = |i: usize| position(cell[i]);
                let [o, a, b, c] = [at(0), at(1), at(3), at(4)];
                let edge = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - o[i]);
                let [a, b, c] = [a, b, c].map(edge);
                let triple = a[0] * (b[1] * c[2] - b[2] * c[1])
                    + a[1] * (b[2] * c[0] - b[0] * c[2])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]);
                assert!(triple > 0.0);
            }
        }
        assert_eq!(LATTICE.lagrange().points.len(), 6 * 2 * 27);
        assert_eq!(LATTICE.linear().points.len(), 2 * 12 * 4 * 8);
    }
}
