//! Buckling modes in saved states, as shapes of imperfections.

use super::{SavedState, SavedStateError};
use crate::tube::Mode;

impl SavedState {
    /// Returns the buckling mode in the file of a mode (`modes/` of a run directory).
    ///
    /// # Errors
    /// [`SavedStateError::NoMode`] if there is none, [`SavedStateError::Array`] if it does not fit the mesh of the state.
    pub fn mode(&self) -> Result<Mode, SavedStateError> {
        let array = |name: &str| self.arrays.get(name).ok_or(SavedStateError::NoMode);
        let (mode, harmonic) = (array("mode")?, array("harmonic")?);
        let wrong = |name: &str, what: String| SavedStateError::Array {
            name: name.into(),
            what,
        };
        let [axial, thickness, components, _] = self.layout.shape();
        let expected = [axial, thickness, components];
        if mode.shape.len() == 4 {
            let what =
                "is of a three-dimensional run; an imperfection has one circumferential mode, as the modes of an \
                        axisymmetric run have"
                    .into();
            return Err(wrong("mode", what));
        }
        if mode.shape != expected {
            let what = format!(
                "has shape {:?} and needs {expected:?} on its mesh",
                mode.shape
            );
            return Err(wrong("mode", what));
        }
        if mode.values.iter().all(|x| *x == 0.0) {
            return Err(wrong("mode", "is zero everywhere".into()));
        }
        let highest = (self.layout.mesh.around - 1) / 2;
        match harmonic.values[..] {
            [n] if n >= 0.0 && n.fract() == 0.0 && n <= highest as f64 => Ok(Mode {
                harmonic: n as usize,
                mesh: self.layout.mesh.clone(),
                values: mode.values.clone(),
            }),
            _ => {
                let what = format!("is not a whole number from 0 to {highest}");
                Err(wrong("harmonic", what))
            }
        }
    }
}
