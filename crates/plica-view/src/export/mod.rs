//! States as files of VTK, for ParaView and PyVista.
//!
//! Coordinates are (x, y, z), the tube along z from the colon end on; lengths and stresses are in the units of the case. A
//! spline of degree p is a polynomial of degree p on every element, so that Lagrange hexahedra of that degree are the
//! wall itself, not near it.
//!
//! | field | meaning |
//! |---|---|
//! | `displacement` | from where the point of the perfect tube was at rest |
//! | `det_Fe` | elastic change of volume |
//! | `theta_zeta`, `theta_eta` | grown over ungrown length, along and around |
//! | `strain_energy_density` | w, per grown volume |
//! | `cauchy_stress` | σ in (x, y, z): xx, yy, zz, xy, yz, xz |
//! | `von_mises_stress` | √(3/2 s : s), s the deviator of σ |
//! | `elastic_stretch` | principal stretches of Fe, largest first |
//! | `elastic_direction_1` to `_3` | their directions in the deformed wall, unit vectors |
//! | `green_lagrange_strain` | ½ (FᵀF − 1) in the axes of the wall at rest, along ζ, around η, outwards ξ: ζζ, ηη, ξξ, ζη, ηξ, ζξ |

mod fields;
mod node;
mod nodes;

use crate::vtk::{Column, Document, Movie};
use fields::FIELDS;
use nodes::Nodes;
use plica::assembly::SplineTube;
use plica::study::{Plan, Row, SavedState, Scale};

/// Writes states of a run.
pub struct Exporter {
    tube: SplineTube,
    scale: Scale,
}

/// What is written of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum What {
    /// The surface of the wall, as `.vtp`.
    Walls,
    /// The wall, as Lagrange hexahedra of the spline's degree, `.vtu`.
    Volume,
    /// The wall, as linear hexahedra between the same points, `.vtu`.
    Linear,
}

impl What {
    /// Everything that can be written.
    pub const ALL: [Self; 3] = [Self::Walls, Self::Volume, Self::Linear];

    /// What its folder and its collection are called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walls => "walls",
            Self::Volume => "volume",
            Self::Linear => "linear",
        }
    }

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Walls => "vtp",
            Self::Volume | Self::Linear => "vtu",
        }
    }
}

/// Facets of a surface, around and along, from which on elements are not cut into more than one each.
const FACETS: [usize; 2] = [96, 240];

/// The field of a surface's cells that tells which face of the wall they are of.
const FACE: &str = "face";

impl Exporter {
    /// Of a run.
    pub fn new(plan: &Plan) -> Self {
        let rings = plan.mesh.rings(plan.symmetry);
        Self {
            tube: SplineTube::new(&plan.tube, &plan.mesh, rings),
            scale: Scale::of(plan.units.as_ref()),
        }
    }

    /// The bytes of a file.
    pub fn bytes(&self, what: What, state: &SavedState, row: &Row) -> Vec<u8> {
        let (tube, length) = (&self.tube, self.scale.length);
        let lattice = match what {
            What::Walls => Nodes::lattice_of_walls(tube, FACETS),
            What::Volume | What::Linear => Nodes::lattice(tube),
        };
        let nodes = Nodes::of(tube, &state.load, &state.u, lattice);
        let points: Vec<[f64; 3]> = nodes
            .all(|node, turn| turn.of(node.position))
            .map(|x| x.map(|x| length * x))
            .collect();
        let mut file = match what {
            What::Volume => Document::grid(&points, &lattice.lagrange()),
            What::Linear => Document::grid(&points, &lattice.linear()),
            What::Walls => {
                let (cells, faces) = lattice.skin();
                let mut file = Document::surface(&points, &cells);
                file.cell_data(FACE, faces.into_iter());
                file
            }
        };
        drop(points);
        for (name, value) in values(row) {
            file.value(name, value);
        }
        for field in FIELDS {
            file.point_data(
                field.name,
                field.components,
                Column::of((field.numbers)(&nodes, &self.scale).into_iter()),
            );
        }
        file.bytes()
    }

    /// An empty film of the wall's surface.
    pub fn movie(&self) -> Movie {
        let lattice = Nodes::lattice_of_walls(&self.tube, FACETS);
        let [outwards, around, along] = lattice.points();
        let (cells, faces) = lattice.skin();
        Movie::new(cells, (FACE, faces), outwards * around * along)
    }

    /// Adds a state to it, its number as the time.
    pub fn film(&self, movie: &mut Movie, state: &SavedState, row: &Row) {
        let lattice = Nodes::lattice_of_walls(&self.tube, FACETS);
        let nodes = Nodes::of(&self.tube, &state.load, &state.u, lattice);
        let length = self.scale.length;
        let points = nodes.all(|node, turn| turn.of(node.position).map(|x| length * x));
        let field = |field: &fields::Field| {
            let numbers = (field.numbers)(&nodes, &self.scale);
            (field.name, field.components.len().max(1), numbers)
        };
        let fields = FIELDS.iter().map(field).collect();
        movie.step(state.row as f64, values(row), points, fields);
    }
}

/// What files name of a state.
fn values(row: &Row) -> [(&'static str, f64); 4] {
    [
        ("state", row.step as f64),
        ("length_ratio", row.length_ratio),
        ("diameter_ratio", row.diameter_ratio),
        ("energy", row.energy),
    ]
}
