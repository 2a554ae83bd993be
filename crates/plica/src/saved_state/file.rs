//! The file of a state, `states/state-NNNN.safetensors`.
//!
//! The format is [safetensors](https://github.com/huggingface/safetensors): the length of a header,
//! the header (JSON), then raw arrays, little-endian. Plica's header is one JSON object under
//! `__metadata__.plica`; the arrays are `u`, further arrays of the state, and its knots and control
//! points. The checksum is
//! BLAKE3 of the whole file with its own 64 digits written as zeros. docs/run-directory.md
//! describes the file for readers in other languages.

use super::header::Header;
use super::{Array, SavedState, SavedStateError, geometry};
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensorError, SafeTensors};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::path::Path;

/// Version of the format that is written, and the newest that can be read.
pub(super) const FORMAT: u32 = 1;
/// Placeholder of the checksum while it is computed.
pub(super) const BLANK: &str = "0000000000000000000000000000000000000000000000000000000000000000";

impl SavedState {
    /// Returns the content of the file of the state.
    ///
    /// # Errors
    /// [`SavedStateError::Array`] if an array does not have the length that its shape says, or a number in it is not finite.
    pub fn to_bytes(&self) -> Result<Vec<u8>, SavedStateError> {
        let header = serde_json::to_string(&self.header()).map_err(Error::other)?;
        check_finite("u", &self.u)?;
        for (name, array) in &self.arrays {
            check_finite(name, &array.values)?;
        }
        let u = Array {
            shape: self.layout.shape().to_vec(),
            values: vec![],
        };
        let derived = geometry::arrays(&self.layout, &self.u);
        let derived = derived.iter().flatten().zip(geometry::NAMES);
        let others = self.arrays.iter();
        let others = others
            .map(|(name, a)| (name.as_str(), a, &a.values))
            .chain(derived.map(|(a, name)| (name, a, &a.values)));
        let arrays: Vec<(&str, &Array, Vec<u8>)> = std::iter::once(("u", &u, &self.u))
            .chain(others)
            .map(|(name, array, values)| {
                let bytes = values.iter().flat_map(|x| x.to_le_bytes()).collect();
                (name, array, bytes)
            })
            .collect();
        let views = arrays.iter().map(|(name, array, bytes)| {
            let view = TensorView::new(Dtype::F64, array.shape.clone(), bytes);
            view.map(|view| (*name, view))
                .map_err(|_| SavedStateError::Array {
                    name: (*name).to_owned(),
                    what: format!("has shape {:?} and {} bytes", array.shape, bytes.len()),
                })
        });
        let views = views.collect::<Result<Vec<_>, _>>()?;
        let metadata = [("plica".to_owned(), header)].into_iter().collect();
        let mut bytes = safetensors::serialize(views, Some(metadata)).map_err(Error::other)?;
        let checksum = blake3::hash(&bytes).to_string();
        if let Some(at) = position(&bytes, BLANK.as_bytes()) {
            bytes[at..at + BLANK.len()].copy_from_slice(checksum.as_bytes());
        }
        Ok(bytes)
    }

    /// Reads a state from the content of its file.
    ///
    /// # Errors
    /// Any [`SavedStateError`]. No content makes this panic or allocate much more memory than the content itself.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, SavedStateError> {
        let (_, metadata) =
            SafeTensors::read_metadata(bytes).map_err(|e| format_error(bytes, &e))?;
        let file = SafeTensors::deserialize(bytes).map_err(|e| format_error(bytes, &e))?;
        let text = metadata.metadata().as_ref().and_then(|m| m.get("plica"));
        let foreign = |what: &str| SavedStateError::Foreign(what.to_owned());
        let text = text.ok_or_else(|| foreign("its header has no entry `plica`"))?;
        // The number of a later format must be found even if the rest of its header differs.
        let about: serde_json::Value =
            serde_json::from_str(text).map_err(|e| foreign(&e.to_string()))?;
        let format = about["format"].as_u64().unwrap_or(0);
        if format > u64::from(FORMAT) {
            let found = u32::try_from(format).unwrap_or(u32::MAX);
            return Err(SavedStateError::Newer { found });
        }
        verify(bytes, about["blake3"].as_str().unwrap_or_default())?;
        let header: Header = serde_json::from_value(about).map_err(|e| foreign(&e.to_string()))?;

        let mut arrays = BTreeMap::new();
        for (name, view) in file.tensors() {
            if geometry::NAMES.contains(&name.as_str()) {
                continue;
            }
            let array = array(&name, &view)?;
            arrays.insert(name, array);
        }
        let missing = || SavedStateError::Array {
            name: "u".into(),
            what: "is missing".into(),
        };
        let u = arrays.remove("u").ok_or_else(missing)?;
        Self::new(header, u, arrays)
    }

    /// Reads the file of a state.
    ///
    /// # Errors
    /// As [`SavedState::from_bytes`]; also if the file cannot be read or is not a regular file.
    pub fn read(path: &Path) -> Result<Self, SavedStateError> {
        // Opening a pipe without a writer would block.
        let about = std::fs::metadata(path)?;
        if !about.is_file() {
            let what = "not a plain file";
            return Err(Error::new(ErrorKind::InvalidInput, what).into());
        }
        let file = File::open(path)?;
        let mut bytes = vec![];
        file.take(about.len()).read_to_end(&mut bytes)?;
        Self::from_bytes(&bytes)
    }
}

/// Reads an array of a file.
fn array(name: &str, view: &TensorView<'_>) -> Result<Array, SavedStateError> {
    let wrong = |what: String| SavedStateError::Array {
        name: name.to_owned(),
        what,
    };
    if view.dtype() != Dtype::F64 {
        return Err(wrong(format!(
            "is of type {:?} instead of F64",
            view.dtype()
        )));
    }
    let (words, _) = view.data().as_chunks::<8>();
    let values: Vec<f64> = words.iter().map(|&word| f64::from_le_bytes(word)).collect();
    check_finite(name, &values)?;
    Ok(Array {
        shape: view.shape().to_vec(),
        values,
    })
}

/// Refuses an array with a number that is not finite.
fn check_finite(name: &str, values: &[f64]) -> Result<(), SavedStateError> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(at) => Err(SavedStateError::Array {
            name: name.to_owned(),
            what: format!("is {} at {at}, not finite", values[at]),
        }),
    }
}

/// Compares the checksum in a file with its content.
fn verify(bytes: &[u8], expected: &str) -> Result<(), SavedStateError> {
    let mut hasher = blake3::Hasher::new();
    match position(bytes, expected.as_bytes()) {
        Some(at) if expected.len() == BLANK.len() => {
            hasher.update(&bytes[..at]);
            hasher.update(BLANK.as_bytes());
            hasher.update(&bytes[at + BLANK.len()..]);
        }
        _ => {
            hasher.update(bytes);
        }
    }
    let found = hasher.finalize().to_string();
    if found == expected {
        return Ok(());
    }
    Err(SavedStateError::Damaged {
        expected: expected.to_owned(),
        found,
    })
}

/// Returns the position of the first occurrence of a text.
fn position(bytes: &[u8], text: &[u8]) -> Option<usize> {
    (!text.is_empty()).then(|| bytes.windows(text.len()).position(|window| window == text))?
}

/// Converts an error of the file format.
fn format_error(bytes: &[u8], error: &SafeTensorError) -> SavedStateError {
    use SafeTensorError as E;
    match error {
        E::HeaderTooSmall | E::InvalidHeaderLength | E::MetadataIncompleteBuffer => {
            SavedStateError::Cut { bytes: bytes.len() }
        }
        other => SavedStateError::Foreign(other.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::activation::MuscleTarget;
    use crate::saved_state::Layout;
    use crate::spline::Refinement;
    use crate::tube::{EndMotion, Load, Mesh, MeshLayer, Placement, Pressure};

    /// A state whose numbers use all their bits.
    fn state() -> SavedState {
        let layout = Layout {
            length: 3.0,
            thickness: 0.06,
            mesh: Mesh {
                axial: 7,
                around: 12,
                thickness: 7,
                degree: 3,
                refinements: vec![Refinement {
                    from: 1.0 / 3.0,
                    to: 1.0,
                    factor: 3.0,
                }],
                grading: 3.0,
                contact_range: 0.5,
                volumetric: Default::default(),
                layers: [1.0 / 3.0, 2.0 / 3.0]
                    .map(|share| MeshLayer { share, elements: 1 })
                    .to_vec(),
            },
            rings: 2,
        };
        let number = |i: usize| (i as f64 * 0.7).sin() / 3.0;
        let velocity = Array {
            shape: vec![2, 3],
            values: (0..6).map(number).collect(),
        };
        SavedState {
            // Nothing that a user writes is taken for the checksum.
            stage: format!("a \"stage\" {BLANK}"),
            row: 17,
            along: 0.1 + 0.2,
            muscles: vec![("ring".into(), MuscleTarget::DiameterRatio)],
            load: Load {
                muscles: vec![1.0 / 7.0],
                shifts: vec![-1.0 / 19.0],
                ends: [
                    EndMotion::default(),
                    EndMotion {
                        displacement: -0.1,
                        twist: 1e-300,
                        shift: [0.1, 1.0 / 3.0],
                        tilt: [-1e-5, 0.0],
                    },
                ],
                pressures: [
                    Pressure::default(),
                    Pressure {
                        follower: 1.0 / 11.0,
                        dead: -1e-5,
                    },
                ],
                lumen_volume: Some(1.0 / 19.0),
                obstacles: vec![Placement {
                    radius: 1.0 / 13.0,
                    position: [0.1, -1e-300, 1.0 / 17.0],
                }],
                patches: vec![1.0 / 19.0],
            },
            obstacles: vec!["a \"ball\"".into()],
            patches: vec!["a scar".into()],
            u: (0..layout.unknowns()).map(number).collect(),
            layout,
            arrays: [("velocity".into(), velocity)].into(),
        }
    }

    #[test]
    fn usual_grading_and_range_are_not_written() {
        let mut usual = state();
        let text = |state: &SavedState| serde_json::to_string(&state.header()).unwrap();
        assert!(text(&usual).contains(r#""grading":3.0,"contact_range":0.5"#));
        (usual.layout.mesh.grading, usual.layout.mesh.contact_range) = (1.0, 0.25);
        assert!(!text(&usual).contains("grading") && !text(&usual).contains("contact_range"));
    }

    #[test]
    fn a_saved_state_is_read_as_it_was_written_to_the_bit() {
        let bytes = state().to_bytes().unwrap();
        assert_eq!(SavedState::from_bytes(&bytes).unwrap(), state());
        assert_eq!(state().to_bytes().unwrap(), bytes);
    }

    #[test]
    fn a_truncated_file_is_reported_as_such() {
        let bytes = state().to_bytes().unwrap();
        for length in 0..bytes.len() {
            let error = SavedState::from_bytes(&bytes[..length]).unwrap_err();
            assert!(
                matches!(error, SavedStateError::Cut { .. }),
                "{length}: {error}"
            );
        }
        let longer = [bytes.as_slice(), b"x"].concat();
        assert!(matches!(
            SavedState::from_bytes(&longer),
            Err(SavedStateError::Cut { .. })
        ));
    }

    #[test]
    fn every_flipped_bit_is_detected() {
        let bytes = state().to_bytes().unwrap();
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(SavedState::from_bytes(&flipped).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn an_inconsistent_state_with_a_valid_checksum_is_refused() {
        let refused = |change: &dyn Fn(&mut SavedState)| {
            let mut state = state();
            change(&mut state);
            let bytes = state.to_bytes().unwrap();
            SavedState::from_bytes(&bytes).unwrap_err().to_string()
        };
        let message = refused(&|state| state.layout.mesh.around = 11);
        assert!(message.contains("do not divide"), "{message}");
        let message = refused(&|state| state.layout.mesh.degree = 0);
        assert!(message.contains("degree"), "{message}");
        let message = refused(&|state| state.layout.length = -1.0);
        assert!(message.contains("no length"), "{message}");
    }

    #[test]
    fn a_number_that_is_not_finite_is_neither_written_nor_read() {
        let mut state = state();
        state.u[5] = 123.25;
        let mut bytes = state.to_bytes().unwrap();
        let at = position(&bytes, &123.25_f64.to_le_bytes()).unwrap();
        bytes[at..at + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        // With the checksum that it would have.
        let name = br#"blake3\":\""#;
        let at = position(&bytes, name).unwrap() + name.len();
        bytes[at..at + BLANK.len()].copy_from_slice(BLANK.as_bytes());
        let checksum = blake3::hash(&bytes).to_string();
        bytes[at..at + BLANK.len()].copy_from_slice(checksum.as_bytes());
        let message = SavedState::from_bytes(&bytes).unwrap_err().to_string();
        assert!(message.contains("`u` is NaN at 5"), "{message}");
        state.u[5] = f64::NAN;
        let message = state.to_bytes().unwrap_err().to_string();
        assert!(message.contains("`u` is NaN at 5"), "{message}");
    }

    #[test]
    fn an_array_of_another_length_is_not_written() {
        let mut state = state();
        state.u.pop();
        assert!(matches!(
            state.to_bytes(),
            Err(SavedStateError::Array { .. })
        ));
    }

    #[test]
    fn later_formats_and_foreign_files_are_reported_as_such() {
        let text = String::from_utf8_lossy(&state().to_bytes().unwrap()).into_owned();
        assert!(text.contains(r#"\"format\":1,"#), "{text}");
        let header = r#"{"__metadata__":{"plica":"{\"format\":9}"}}"#;
        let file = |header: &str| {
            let mut bytes = (header.len() as u64).to_le_bytes().to_vec();
            bytes.extend(header.as_bytes());
            SavedState::from_bytes(&bytes).unwrap_err()
        };
        assert!(matches!(file(header), SavedStateError::Newer { found: 9 }));
        assert!(matches!(file("{}"), SavedStateError::Foreign(_)));
        assert!(matches!(file("PK"), SavedStateError::Foreign(_)));
        // A header that claims more than there is takes no memory.
        let huge = [u64::MAX.to_le_bytes(), [0; 8]].concat();
        assert!(SavedState::from_bytes(&huge).is_err());
    }
}
