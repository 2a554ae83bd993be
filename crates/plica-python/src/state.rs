//! Accepted states: their numbers, unknowns, walls and fields.

use plica::assembly::Point;
use plica::study::{Plan, Row, Scale};
use plica::tube::{Load, Tube as Shape};
use plica_view::sampled_tube::SampledTube;
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
    sampled: SampledTube,
}

impl Tube {
    /// Makes the tube of a plan.
    pub fn of(plan: Plan) -> Self {
        Self {
            scale: Scale::of(plan.units.as_ref()),
            sampled: SampledTube::of(&plan),
            plan,
        }
    }
}

/// An accepted state.
#[pyclass(frozen, module = "plica._native")]
pub struct State {
    tube: Arc<Tube>,
    load: Load,
    u: Vec<f64>,
    /// Columns of the history: name, unit and text.
    cells: Vec<(String, Option<String>, String, bool)>,
}

/// Names of the fields, with the number of components.
const FIELDS: [(&str, usize); 10] = [
    ("position", 3),
    ("cauchy_stress", 9),
    ("axial_stress", 1),
    ("radial_stress", 1),
    ("hoop_stress", 1),
    ("von_mises_stress", 1),
    ("energy_density", 1),
    ("jacobian", 1),
    ("elastic_stretches", 3),
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
    fn unknowns<'py>(&self, py: Python<'py>) -> (Bound<'py, PyBytes>, [usize; 4]) {
        (bytes(py, &self.u), self.tube.plan.layout().shape())
    }

    /// Radii of the inner and the outer wall at rest, the length at rest, and the name of the unit of length.
    #[getter]
    fn size(&self) -> (f64, f64, f64, String) {
        let (tube, scale) = (&self.tube.plan.tube, &self.tube.scale);
        let [inner, outer, length] =
            [tube.inner_radius(), Shape::OUTER_RADIUS, tube.length].map(|x| scale.length * x);
        (inner, outer, length, scale.length_name.clone())
    }

    /// Names and units of the fields.
    #[getter]
    fn field_units(&self) -> Vec<(&'static str, Option<String>)> {
        let scale = &self.tube.scale;
        let unit = |name: &str| match name {
            "position" => Some(scale.length_name.clone()),
            "jacobian" | "elastic_stretches" => None,
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
        let numbers: Vec<f64> = points
            .chunks_exact(8)
            .map(|x| f64::from_ne_bytes(x.try_into().unwrap_or_default()))
            .collect();
        let scale = &self.tube.scale;
        let points: Vec<Point> = numbers
            .chunks_exact(3)
            .map(|p| Point {
                z: p[0] / scale.length,
                radius: p[1] / scale.length,
                angle: p[2],
            })
            .collect();
        let columns = super::monitor::compute(py, None, None, |_| {
            let state = self.tube.sampled.state(&self.load, &self.u);
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
                    "energy_density" => vec![scale.stress * wall.energy_density],
                    "jacobian" => vec![wall.jacobian],
                    "elastic_stretches" => wall.stretches().map(|(stretch, _)| stretch).to_vec(),
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
            fields.set_item(name, (bytes(py, column), components))?;
        }
        Ok(fields)
    }
}

/// Returns numbers as bytes.
pub fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> Bound<'py, PyBytes> {
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_ne_bytes()).collect();
    PyBytes::new(py, &bytes)
}
