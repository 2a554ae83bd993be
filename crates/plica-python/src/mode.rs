//! Buckling modes and modes of vibration of a run's stability analysis.

use super::state::{Tube, bytes, material_points};
use plica::assembly::Point;
use plica::saved_state::SavedState;
use plica::tube::Tube as Shape;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::prelude::*;
use std::path::Path;
use std::sync::Arc;

/// A mode at a state.
#[pyclass(frozen, module = "plica._native")]
pub struct Mode {
    tube: Arc<Tube>,
    state: SavedState,
    shape: Vec<f64>,
    /// Circumferential mode, or that with the largest share.
    harmonic: usize,
    eigenvalue: f64,
    /// Largest displacement on the outer wall, in D.
    largest: f64,
}

impl Mode {
    /// Reads a mode.
    pub fn read(tube: &Arc<Tube>, path: &Path) -> PyResult<Self> {
        let failed = |why: String| PyOSError::new_err(format!("{}: {why}", path.display()));
        let mut state = SavedState::read(path).map_err(|error| failed(error.to_string()))?;
        let accepted = tube.plan.accepts(&state);
        accepted.map_err(|error| failed(error.to_string()))?;
        let scalar = |name: &str| state.arrays.get(name)?.values.first().copied();
        let (harmonic, eigenvalue) = (scalar("harmonic"), scalar("eigenvalue"));
        let shape = state.arrays.remove("mode").map(|array| array.values);
        let (Some(harmonic), Some(eigenvalue), Some(shape)) = (harmonic, eigenvalue, shape) else {
            return Err(failed("this is no mode".into()));
        };
        if shape.len() != state.u.len() {
            return Err(failed("the mode has another number of unknowns".into()));
        }
        let mut mode = Self {
            tube: Arc::clone(tube),
            harmonic: harmonic as usize,
            eigenvalue,
            shape,
            largest: 1.0,
            state,
        };
        mode.largest = mode.largest_displacement();
        Ok(mode)
    }

    /// Returns the largest displacement on the outer wall.
    fn largest_displacement(&self) -> f64 {
        let tube = self.tube.exporter.tube();
        let angles: Vec<f64> = match tube.sector.rings {
            // Largest where the cosine or the sine is one.
            1 => [0.0, 0.25].map(|turn| self.quarter(turn)).to_vec(),
            rings => (0..rings)
                .map(|ring| tube.sector.ring_angle(ring))
                .collect(),
        };
        let mut largest = 0.0_f64;
        for z in tube.axial.positions(4 * tube.axial.elements() + 1) {
            for &angle in &angles {
                let radius = Shape::OUTER_RADIUS;
                let [x, y, z] = self.displacement(Point { z, radius, angle });
                largest = largest.max(x.hypot(y).hypot(z));
            }
        }
        largest.max(f64::MIN_POSITIVE)
    }

    /// Returns the angle of a fraction of a wave around the tube.
    fn quarter(&self, waves: f64) -> f64 {
        waves * std::f64::consts::TAU / self.harmonic.max(1) as f64
    }

    /// Returns the displacement (x, y, z) of the mode at a material point.
    fn displacement(&self, at: Point) -> [f64; 3] {
        let tube = self.tube.exporter.tube();
        let is_meridian = tube.sector.rings == 1;
        let place = Point {
            angle: if is_meridian { 0.0 } else { at.angle },
            ..at
        };
        let sample = tube.sample(&self.state.load, &self.shape, place);
        let [z, r, t] = [0, 1, 2].map(|i| sample.position[i] - sample.reference[i]);
        if !is_meridian {
            return [r, t, z];
        }
        // Amplitudes of (z cos nφ, r cos nφ, −θ sin nφ); of (z, r, θ) for n = 0.
        let (sin, cos) = match self.harmonic {
            0 => (-1.0, 1.0),
            n => (n as f64 * at.angle).sin_cos(),
        };
        let [z, r, t] = [z * cos, r * cos, -t * sin];
        let (sin, cos) = at.angle.sin_cos();
        [r * cos - t * sin, r * sin + t * cos, z]
    }
}

#[pymethods]
impl Mode {
    /// The circumferential mode, or that with the largest share.
    #[getter]
    fn harmonic(&self) -> usize {
        self.harmonic
    }

    /// The eigenvalue, in E/D².
    #[getter]
    fn eigenvalue(&self) -> f64 {
        self.eigenvalue
    }

    /// The number of the saved state, or of the last one before the mode's.
    #[getter]
    fn state(&self) -> usize {
        self.state.row
    }

    /// Radii of the inner and the outer wall at rest, the length at rest, and the name of the unit of length.
    #[getter]
    fn size(&self) -> (f64, f64, f64, String) {
        self.tube.size()
    }

    /// Returns positions in the state, in the unit of length, and displacements of the mode, whose largest one on the outer wall
    /// is one: (x, y, z) both, for material points (z, radius, angle) at rest.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        points: &[u8],
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>)> {
        let length = self.tube.scale.length;
        let points = material_points(points, length);
        let (positions, displacements): (Vec<[f64; 3]>, Vec<[f64; 3]>) =
            super::monitor::compute(py, None, None, |_| {
                let tube = self.tube.exporter.tube();
                let at = |point: &Point| {
                    let sample = tube.sample(&self.state.load, &self.state.u, *point);
                    let [z, x, y] = sample.position.map(|x| length * x);
                    (
                        [x, y, z],
                        self.displacement(*point).map(|x| x / self.largest),
                    )
                };
                points.par_iter().map(at).unzip()
            })?;
        Ok((
            bytes(py, positions.as_flattened())?,
            bytes(py, displacements.as_flattened())?,
        ))
    }
}
