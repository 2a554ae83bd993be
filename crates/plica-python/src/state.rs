//! Accepted states: their numbers, unknowns, walls and fields.

use plica::assembly::Point;
use plica::contact::Face;
use plica::study::{Plan, Row, Scale};
use plica::tube::{Load, Tube as Shape};
use plica_view::export::{Exporter, Geometry};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;
use std::sync::Arc;

/// The tube of states, and its units.
pub struct Tube {
    /// The plan.
    pub plan: Plan,
    /// The units.
    pub scale: Scale,
    /// Its fields and geometries.
    pub exporter: Exporter,
}

impl Tube {
    /// Makes the tube of a plan.
    pub fn of(plan: Plan) -> Self {
        Self {
            scale: Scale::of(plan.units.as_ref()),
            exporter: Exporter::new(&plan),
            plan,
        }
    }

    /// Returns the radii of the inner and the outer wall at rest, the length at rest, and the name of the unit of length.
    pub fn size(&self) -> (f64, f64, f64, String) {
        let (tube, scale) = (&self.plan.tube, &self.scale);
        let [inner, outer, length] =
            [tube.inner_radius(), Shape::OUTER_RADIUS, tube.length].map(|x| scale.length * x);
        (inner, outer, length, scale.length_name.clone())
    }
}

/// An accepted state.
#[pyclass(frozen, module = "plica._native")]
pub struct State {
    tube: Arc<Tube>,
    pub(super) load: Load,
    pub(super) u: Vec<f64>,
    /// Columns of the history: name, unit and text.
    cells: Vec<(String, Option<String>, String, bool)>,
}

/// Names of the fields, with the number of components.
const FIELDS: [(&str, usize); 17] = [
    ("position", 3),
    ("displacement", 3),
    ("cauchy_stress", 9),
    ("axial_stress", 1),
    ("radial_stress", 1),
    ("hoop_stress", 1),
    ("von_mises_stress", 1),
    ("strain_energy_density", 1),
    ("det_Fe", 1),
    ("elastic_stretch", 3),
    ("theta_zeta", 1),
    ("theta_eta", 1),
    ("theta_xi", 1),
    ("tension", 1),
    ("stiffness_factor", 1),
    ("foundation_force", 3),
    ("contact_pressure", 1),
];

impl State {
    /// Makes a state from its load, unknowns and row.
    pub fn new(tube: &Arc<Tube>, load: Load, u: Vec<f64>, row: &Row) -> Self {
        let cells = row.cells().into_iter().map(|cell| {
            let is_text = cell.number().is_none();
            let unit = tube.scale.unit(cell.quantity).map(String::from);
            (cell.name, unit, cell.text, is_text)
        });
        Self {
            cells: cells.collect(),
            tube: Arc::clone(tube),
            load,
            u,
        }
    }
}

#[pymethods]
impl State {
    /// The columns of the history: name, unit, text, and whether it is a text.
    #[getter]
    fn cells(&self) -> Vec<(String, Option<String>, String, bool)> {
        self.cells.clone()
    }

    /// The unknowns in D, as bytes of float64, and their shape (rows along, points through, components, rings).
    #[getter]
    fn unknowns<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyBytes>, [usize; 4])> {
        Ok((bytes(py, &self.u)?, self.tube.plan.layout().shape()))
    }

    /// Radii of the inner and the outer wall at rest, the length at rest, and the name of the unit of length.
    #[getter]
    fn size(&self) -> (f64, f64, f64, String) {
        self.tube.size()
    }

    /// Names and units of the fields.
    #[getter]
    fn field_units(&self) -> Vec<(&'static str, Option<String>)> {
        let scale = &self.tube.scale;
        let unit = |name: &str| match name {
            "position" | "displacement" => Some(scale.length_name.clone()),
            "det_Fe" | "elastic_stretch" | "theta_zeta" | "theta_eta" | "theta_xi"
            | "stiffness_factor" => None,
            _ => Some(scale.stress_name.clone()),
        };
        FIELDS.iter().map(|&(name, _)| (name, unit(name))).collect()
    }

    /// Evaluates fields at material points (z, radius, angle in radians) at rest, given as bytes of float64. Returns the bytes
    /// of each field and its number of components.
    fn fields<'py>(
        &self,
        py: Python<'py>,
        points: &[u8],
        names: Vec<String>,
    ) -> PyResult<Bound<'py, PyDict>> {
        for name in &names {
            if !FIELDS.iter().any(|(known, _)| known == name) {
                let known: Vec<&str> = FIELDS.iter().map(|(known, _)| *known).collect();
                return Err(PyValueError::new_err(format!(
                    "there is no field {name}; there are {}",
                    known.join(", ")
                )));
            }
        }
        let scale = &self.tube.scale;
        let points = material_points(points, scale.length);
        let columns = super::monitor::compute(py, None, None, |_| {
            let state = self.tube.exporter.tube().state(&self.load, &self.u);
            let at = |point: &Point| -> Vec<Vec<f64>> {
                let sample = state.at(*point);
                let wall = &sample.wall;
                let [axial, radial, hoop] = wall.wall_stresses();
                let of = |name: &String| match name.as_str() {
                    // (x, y, z)
                    "position" => [1, 2, 0].map(|i| scale.length * wall.position[i]).to_vec(),
                    "cauchy_stress" => {
                        let all = wall.stress.0.as_flattened();
                        all.iter().map(|s| scale.stress * s).collect()
                    }
                    "axial_stress" => vec![scale.stress * axial],
                    "radial_stress" => vec![scale.stress * radial],
                    "hoop_stress" => vec![scale.stress * hoop],
                    "von_mises_stress" => vec![scale.stress * wall.von_mises()],
                    "displacement" => {
                        let moved = |i: usize| wall.position[i] - wall.reference[i];
                        [1, 2, 0].map(|i| scale.length * moved(i)).to_vec()
                    }
                    "strain_energy_density" => vec![scale.stress * wall.energy_density],
                    "det_Fe" => vec![wall.jacobian],
                    "elastic_stretch" => wall.stretches().map(|(stretch, _)| stretch).to_vec(),
                    "theta_zeta" => vec![wall.grown[0]],
                    "theta_eta" => vec![wall.grown[1]],
                    "theta_xi" => vec![wall.grown_through],
                    "tension" => vec![scale.stress * wall.tension],
                    "stiffness_factor" => vec![wall.stiffness],
                    "foundation_force" => {
                        let [z, x, y] = wall.foundation.map(|f| scale.stress * f);
                        let (sin, cos) = wall.element_angle.sin_cos();
                        vec![x * cos - y * sin, x * sin + y * cos, z]
                    }
                    _ => vec![scale.stress * sample.contact_pressure],
                };
                names.iter().map(of).collect()
            };
            let rows: Vec<Vec<Vec<f64>>> = points.par_iter().map(at).collect();
            let column = |n: usize| rows.iter().flat_map(|row| row[n].iter().copied()).collect();
            (0..names.len()).map(column).collect::<Vec<Vec<f64>>>()
        })?;
        let fields = PyDict::new(py);
        for (name, column) in names.iter().zip(&columns) {
            let components = FIELDS.iter().find(|(known, _)| known == name);
            let components = components.map_or(1, |(_, components)| *components);
            fields.set_item(name, (bytes(py, column)?, components))?;
        }
        Ok(fields)
    }

    /// Returns a geometry: points (x, y, z), cells as indices of points, points per cell, the type of cell in VTK, the face of
    /// each cell of the walls, and the fields of the given names with their number of components.
    fn grid<'py>(
        &self,
        py: Python<'py>,
        geometry: &str,
        names: Vec<String>,
    ) -> PyResult<Grid<'py>> {
        let exporter = &self.tube.exporter;
        let known: Vec<&str> = exporter.field_names().collect();
        if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
            return Err(PyValueError::new_err(format!(
                "there is no field {name}; there are {}",
                known.join(", ")
            )));
        }
        let geometry = Geometry::ALL.into_iter().find(|g| g.name() == geometry);
        let geometry =
            geometry.ok_or_else(|| PyValueError::new_err("there is no such geometry"))?;
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let grid = super::monitor::compute(py, None, None, |_| {
            exporter.grid(geometry, &self.load, &self.u, &names)
        })?;
        let fields = PyDict::new(py);
        for field in &grid.fields {
            let values = raw(py, &field.values, f32::to_ne_bytes)?;
            fields.set_item(field.name, (values, field.components))?;
        }
        Ok((
            bytes(py, grid.points.as_flattened())?,
            raw(py, &grid.cells.points, i64::to_ne_bytes)?,
            grid.cells.points_per_cell,
            grid.cells.cell_type,
            grid.faces.map(|faces| PyBytes::new(py, &faces)),
            fields,
        ))
    }

    /// Names of the fields of geometries.
    #[getter]
    fn grid_fields(&self) -> Vec<&'static str> {
        self.tube.exporter.field_names().collect()
    }

    /// Number of control rings of the cyclic sector; one for an axisymmetric state.
    #[getter]
    fn rings(&self) -> usize {
        self.tube.plan.layout().shape()[3]
    }

    /// Returns axial position, area and pressure of the points of the inner and the outer face that touch themselves.
    fn pressed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let scale = &self.tube.scale;
        let points = super::monitor::compute(py, None, None, |_| {
            let tube = self.tube.exporter.tube();
            let pressed = |face| tube.pressed_points(&self.u, face);
            [Face::Inner, Face::Outer].map(pressed).concat()
        })?;
        let area = scale.length * scale.length;
        let number = |p: &plica::contact::PressedPoint| {
            [scale.length * p.z, area * p.area, scale.stress * p.pressure]
        };
        let numbers: Vec<f64> = points.iter().flat_map(number).collect();
        bytes(py, &numbers)
    }
}

/// Points, cells, points per cell, type of cell, faces, and fields of a geometry.
type Grid<'py> = (
    Bound<'py, PyBytes>,
    Bound<'py, PyBytes>,
    usize,
    u8,
    Option<Bound<'py, PyBytes>>,
    Bound<'py, PyDict>,
);

/// Reads material points (z, radius, angle) at rest from bytes of float64, in units of `length`.
pub fn material_points(points: &[u8], length: f64) -> Vec<Point> {
    let numbers = points.chunks_exact(8);
    let number = |x: &[u8]| f64::from_ne_bytes(x.try_into().unwrap_or_default());
    let numbers: Vec<f64> = numbers.map(number).collect();
    let point = |p: &[f64]| Point {
        z: p[0] / length,
        radius: p[1] / length,
        angle: p[2],
    };
    numbers.chunks_exact(3).map(point).collect()
}

/// Returns numbers as bytes.
pub fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyBytes>> {
    raw(py, numbers, f64::to_ne_bytes)
}

/// Copies numbers of `N` bytes each into a new object.
fn raw<'py, T: Copy, const N: usize>(
    py: Python<'py>,
    numbers: &[T],
    to_bytes: fn(T) -> [u8; N],
) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, N * numbers.len(), |to| {
        for (to, number) in to.chunks_exact_mut(N).zip(numbers) {
            to.copy_from_slice(&to_bytes(*number));
        }
        Ok(())
    })
}
