//! A mode of stability, as the shape of an imperfect geometry.

use super::{SavedState, SavedStateError};
use crate::tube::Mode;

/// A mode that a case names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMode {
    /// Number of its imperfection in the case, from 1.
    pub imperfection: usize,
    /// Its file, as the case names it.
    pub file: String,
    /// What the file holds: the mode, and the state that it belongs to.
    pub state: SavedState,
}

impl SavedState {
    /// The mode that goes with the state, if the file is one of a run's `modes/`.
    ///
    /// # Errors
    /// [`SavedStateError::NoMode`] if there is none, [`SavedStateError::Array`] if it cannot be one of
    /// the state's mesh.
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
                "is of a three-dimensional run; a shape has one harmonic, as the modes that \
                        plica stability finds of an axisymmetric run have"
                    .into();
            return Err(wrong("mode", what));
        }
        if mode.shape != expected {
            let what = format!(
                "has shape {:?}, and its mesh needs {expected:?}",
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
