//! Points of a study: the case of one tube, and the name of its run.

use super::{Keep, Sweep};
use crate::case::{self, CaseError, EditError, Input, InputFile};
use crate::study::Plan;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// A tube of a study.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Point {
    /// A value for each axis, written as in TOML.
    pub values: Vec<String>,
}

/// The case of a point.
#[derive(Clone, Debug)]
pub struct PointCase {
    /// Its text.
    pub text: String,
    /// The plan that the text describes.
    pub plan: Plan,
    /// Name of its run: 16 hexadecimal digits made from the text, the files that it names and the version of Plica.
    pub name: String,
}

/// A point whose case cannot be made or run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PointError {
    /// A key of the base case cannot be changed.
    #[error("{0}")]
    Edit(#[from] EditError),
    /// The case is not valid.
    #[error("{0}")]
    Case(#[from] CaseError),
}

/// A number of steps beyond that of every stage, so that only the last state of each is kept.
const NEVER: &str = "100000";

/// Returns the path of a file that a case in a folder names.
///
/// # Errors
/// If the file is neither in that folder nor in the current one.
fn allowed(folder: &Path, wanted: InputFile<'_>) -> Result<PathBuf, std::io::Error> {
    let file = folder.join(wanted.path()).canonicalize()?;
    let here = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    for allowed in [here, Path::new(".")] {
        if file.starts_with(allowed.canonicalize()?) {
            return Ok(file);
        }
    }
    let why = "the file is neither in the folder of the base case nor in the current one";
    Err(std::io::Error::new(
        std::io::ErrorKind::PermissionDenied,
        why,
    ))
}

impl Sweep {
    /// Returns the case of a point.
    ///
    /// # Errors
    /// [`PointError`] if the base case with the values of the point is not a valid case.
    pub fn case(&self, point: &Point) -> Result<PointCase, PointError> {
        let axes = self.axes.iter().map(|axis| axis.key.as_str());
        let mut changes: Vec<(&str, &str)> =
            axes.zip(point.values.iter().map(String::as_str)).collect();
        changes.push(("output.pictures", "false"));
        if self.keep == Keep::Last {
            changes.push(("output.states_every", NEVER));
            changes.push(("output.profiles_every", NEVER));
        }
        let text = case::edited(&self.text, &changes)?;
        let folder = self.base.parent().unwrap_or_else(|| "".as_ref());
        let hash = RefCell::new(blake3::Hasher::new());
        hash.borrow_mut()
            .update(env!("CARGO_PKG_VERSION").as_bytes())
            .update(&[0])
            .update(text.as_bytes());
        let open = |wanted: InputFile<'_>| {
            let path = allowed(folder, wanted)?;
            let input = Input::read(wanted, &path)?;
            let bytes = std::fs::read(&path)?;
            hash.borrow_mut().update(&[0]).update(&bytes);
            Ok(input)
        };
        let stem = self.base.file_stem().unwrap_or_default();
        let plan = case::read_with(&text, &stem.to_string_lossy(), &open)?;
        let name = hash.borrow().finalize().to_hex()[..16].to_owned();
        Ok(PointCase { text, plan, name })
    }
}
