//! Export of states as VTK files for ParaView and PyVista.
//!
//! Coordinates are (x, y, z) with the axis of the tube along z, starting at the colon end. Lengths and stresses are in the
//! units of the case. A spline of degree p is a polynomial of degree p on every element, so Lagrange hexahedra of degree p
//! represent the wall exactly.
//!
//! | field | meaning |
//! |---|---|
//! | `displacement` | position relative to the stress-free tube without imperfections |
//! | `det_Fe` | elastic volume ratio |
//! | `theta_zeta`, `theta_eta` | longitudinal and circumferential growth stretch |
//! | `theta_xi`, `stiffness_factor` | growth stretch through the wall and factor on the energy, in runs with patches |
//! | `foundation_force` | force of foundations on the outer wall, per area at rest; zero inside; in runs with foundations |
//! | `tension` | sum of the tensions of the muscles with active stress, in runs with them |
//! | `strain_energy_density` | w, per volume after growth |
//! | `cauchy_stress` | σ in (x, y, z): xx, yy, zz, xy, yz, xz |
//! | `axial_stress`, `radial_stress`, `hoop_stress` | normal components of σ along the meridian, through the wall and along the circle of the deformed wall |
//! | `von_mises_stress` | √(3/2 s : s) with the deviator s of σ |
//! | `elastic_stretch` | principal stretches of Fe, largest first |
//! | `elastic_direction_1` to `_3` | unit vectors of the principal directions in the deformed wall |
//! | `contact_pressure` | pressure of contact on the faces, per current area; zero inside; in runs with contact |
//! | `green_lagrange_strain` | ½ (FᵀF − 1) in the axes ζ (along), η (around), ξ (outwards) of the undeformed wall: ζζ, ηη, ξξ, ζη, ηξ, ζξ |

mod fields;
mod point;
mod points;

use crate::obstacle_shapes::bodies;
use crate::sampled_tube::SampledTube;
use crate::vtk::{Cells, Column, Document, Lattice, Series};
use fields::{FIELDS, OF_CONTACT, OF_FOUNDATIONS, OF_PATCHES, OF_TENSIONS};
use plica::activation::Muscle;
use plica::saved_state::SavedState;
use plica::study::{Plan, Row, Scale};
use plica::tube::Load;
use points::{Points, boundary_lattice, meridian_lattice, volume_lattice};
use std::f64::consts::TAU;

/// Converts states of a run to VTK files.
pub struct Exporter {
    tube: SampledTube,
    scale: Scale,
    has_patches: bool,
    has_tensions: bool,
    has_foundations: bool,
}

/// Geometry written to a VTK file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Geometry {
    /// Surface of the wall (`.vtp`).
    Walls,
    /// Meridian at angle zero (`.vtp`); for axisymmetric runs.
    Meridian,
    /// Wall as Lagrange hexahedra of the degree of the spline (`.vtu`).
    Volume,
    /// Wall as linear hexahedra between the same points (`.vtu`).
    Linear,
}

impl Geometry {
    /// All geometries.
    pub const ALL: [Self; 4] = [Self::Walls, Self::Meridian, Self::Volume, Self::Linear];

    /// Returns the name of its folder and its collection.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walls => "walls",
            Self::Meridian => "meridian",
            Self::Volume => "volume",
            Self::Linear => "linear",
        }
    }

    /// Returns the extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Walls | Self::Meridian => "vtp",
            Self::Volume | Self::Linear => "vtu",
        }
    }
}

/// A geometry of a state in memory.
pub struct Grid {
    /// Positions (x, y, z), in the units of the case.
    pub points: Vec<[f64; 3]>,
    /// Cells.
    pub cells: Cells,
    /// Face of the wall that each cell of [`Geometry::Walls`] belongs to: 0 inner, 1 outer, 2 and 3 the ends.
    pub faces: Option<Vec<u8>>,
    /// Fields at the points.
    pub fields: Vec<GridField>,
}

/// A field at the points of a grid.
pub struct GridField {
    /// Name in files.
    pub name: &'static str,
    /// Number of components.
    pub components: usize,
    /// Values in the units of the case, the components of a point together.
    pub values: Vec<f32>,
}

/// Number of facets of a surface, around and along, that is sufficient without subdividing elements.
const FACETS: [usize; 2] = [96, 240];

/// Largest number of intervals of a meridian, through the wall and along.
const INTERVALS: [usize; 2] = [3, 180];

/// Name of the field with the number of the obstacle, from 0 in the order of the case, that a cell belongs to.
const OBSTACLE: &str = "obstacle";

/// Name of the field with the face of the wall that a cell of the surface belongs to.
const FACE: &str = "face";

impl Exporter {
    /// Creates an exporter for the states of a run.
    pub fn new(plan: &Plan) -> Self {
        Self {
            tube: SampledTube::of(plan),
            scale: Scale::of(plan.units.as_ref()),
            has_patches: !plan.tube.patches.is_empty(),
            has_tensions: !plan.tube.muscles.iter().all(Muscle::grows),
            has_foundations: !plan.tube.foundations.is_empty(),
        }
    }

    /// Returns the fields, those of contact, patches, tensions and foundations only if the run has them.
    fn fields(&self) -> impl Iterator<Item = &'static fields::Field> {
        let contact = self.tube.has_contact();
        let of_contact: &[fields::Field] = if contact { OF_CONTACT } else { &[] };
        let of_patches: &[fields::Field] = if self.has_patches { OF_PATCHES } else { &[] };
        let of_tensions: &[fields::Field] = if self.has_tensions { OF_TENSIONS } else { &[] };
        let foundations = self.has_foundations;
        let of_foundations: &[fields::Field] = if foundations { OF_FOUNDATIONS } else { &[] };
        let fields = FIELDS.iter().chain(of_contact).chain(of_patches);
        fields.chain(of_tensions).chain(of_foundations)
    }

    /// Returns the bytes of the file of a state.
    pub fn file(&self, geometry: Geometry, state: &SavedState, row: &Row) -> Vec<u8> {
        let (lattice, points) = self.sample(geometry, &state.load, &state.u);
        let positions = self.positions(&points);
        let mut file = match geometry {
            Geometry::Volume => Document::grid(&positions, &lattice.lagrange()),
            Geometry::Linear => Document::grid(&positions, &lattice.linear()),
            Geometry::Meridian => Document::surface(&positions, &lattice.section()),
            Geometry::Walls => {
                let (cells, faces) = lattice.boundary();
                let mut file = Document::surface(&positions, &cells);
                file.cell_data(FACE, faces.into_iter());
                file
            }
        };
        drop(positions);
        for (name, value) in values(row) {
            file.field_data(name, value);
        }
        for field in self.fields() {
            file.point_data(
                field.name,
                field.components,
                Column::new((field.values)(&points, &self.scale).into_iter()),
            );
        }
        file.bytes()
    }

    /// Returns the geometry of a state, with the fields of the given names.
    pub fn grid(&self, geometry: Geometry, load: &Load, u: &[f64], names: &[&str]) -> Grid {
        let (lattice, points) = self.sample(geometry, load, u);
        let (cells, faces) = match geometry {
            Geometry::Volume => (lattice.lagrange(), None),
            Geometry::Linear => (lattice.linear(), None),
            Geometry::Meridian => (lattice.section(), None),
            Geometry::Walls => {
                let (cells, faces) = lattice.boundary();
                (cells, Some(faces))
            }
        };
        let wanted = self.fields().filter(|field| names.contains(&field.name));
        let fields = wanted.map(|field| GridField {
            name: field.name,
            components: field.components.len().max(1),
            values: (field.values)(&points, &self.scale),
        });
        Grid {
            fields: fields.collect(),
            points: self.positions(&points),
            cells,
            faces,
        }
    }

    /// Returns the bytes of a file (`.vtp`) with the surfaces of the obstacles in a state, endless ones cut off near the ends of
    /// the tube.
    pub fn obstacles_file(&self, state: &SavedState, row: &Row) -> Vec<u8> {
        let (mut points, mut corners, mut numbers) = (vec![], vec![], vec![]);
        let length = self.scale.length;
        for body in bodies(&self.tube, &state.load) {
            let grid = body.surface.grid([0.0, TAU]);
            for triangle in grid.triangles() {
                corners.extend(triangle.map(|corner| (points.len() + corner) as i64));
                numbers.push(body.obstacle as i64);
            }
            let in_order = |&[z, x, y]: &[f64; 3]| [x, y, z].map(|x| length * x);
            points.extend(grid.points.iter().map(in_order));
        }
        let mut file = Document::surface(&points, &Cells::triangles(corners));
        file.cell_data(OBSTACLE, numbers.into_iter());
        for (name, value) in values(row) {
            file.field_data(name, value);
        }
        file.bytes()
    }

    /// Returns the names of the fields of a state.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> {
        self.fields().map(|field| field.name)
    }

    /// Returns the tube whose states are exported.
    pub fn tube(&self) -> &SampledTube {
        &self.tube
    }

    /// Samples a state at the points of a geometry.
    fn sample(&self, geometry: Geometry, load: &Load, u: &[f64]) -> (Lattice, Points) {
        let tube = &self.tube;
        let lattice = match geometry {
            Geometry::Walls => boundary_lattice(tube, FACETS),
            Geometry::Meridian => meridian_lattice(tube, INTERVALS),
            Geometry::Volume | Geometry::Linear => volume_lattice(tube),
        };
        let sampled = tube.state(load, u);
        let points = match geometry {
            Geometry::Meridian => Points::meridian(&sampled, lattice),
            _ => Points::sample(&sampled, lattice),
        };
        (lattice, points)
    }

    /// Returns the positions (x, y, z) of points, in the units of the case.
    fn positions(&self, points: &Points) -> Vec<[f64; 3]> {
        let length = self.scale.length;
        points
            .evaluate(|point, rotation| rotation.vector(point.position).map(|x| length * x))
            .collect()
    }

    /// Creates an empty time series of the surface of the wall.
    pub fn series(&self) -> Series {
        let lattice = boundary_lattice(&self.tube, FACETS);
        let [outwards, around, along] = lattice.points();
        let (cells, faces) = lattice.boundary();
        Series::new(cells, (FACE, faces), outwards * around * along)
    }

    /// Appends a state to a series, with the number of the state as the time.
    pub fn append(&self, series: &mut Series, state: &SavedState, row: &Row) {
        let lattice = boundary_lattice(&self.tube, FACETS);
        let points = Points::sample(&self.tube.state(&state.load, &state.u), lattice);
        let length = self.scale.length;
        let positions =
            points.evaluate(|p, rotation| rotation.vector(p.position).map(|x| length * x));
        let field = |field: &fields::Field| {
            let values = (field.values)(&points, &self.scale);
            (field.name, field.components.len().max(1), values)
        };
        let fields = self.fields().map(field).collect();
        series.push(state.row as f64, values(row), positions, fields);
    }
}

/// Returns the named values of a state.
fn values(row: &Row) -> [(&'static str, f64); 4] {
    [
        ("state", row.step as f64),
        ("length_ratio", row.length_ratio),
        ("diameter_ratio", row.diameter_ratio),
        ("energy", row.energy),
    ]
}
