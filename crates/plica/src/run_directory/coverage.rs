//! Results of `plica stability`, and the states that they cover.

use super::clear::{remove, stability_files};
use super::resume::list;
use super::{RunDirectory, RunError, STABILITY, manifest};
use std::path::PathBuf;

/// The states and modes that a stability analysis covers.
#[derive(Clone, Debug, PartialEq)]
pub struct StabilityCoverage {
    /// Numbers of the tested states, in ascending order.
    pub states: Vec<usize>,
    /// Highest circumferential mode tested; none for the lowest modes of three-dimensional states.
    pub highest_mode: Option<usize>,
}

impl StabilityCoverage {
    /// Returns the coverage for the manifest.
    fn to_json(&self) -> serde_json::Value {
        serde_json::json!({ "states": self.states, "highest_mode": self.highest_mode })
    }

    /// Returns the numbers of the states as a text, such as `0 to 12, 14`.
    pub fn list(&self) -> String {
        list(&self.states)
    }

    /// Returns a statement on the states that are not covered, of those with these numbers; none if all are.
    pub fn gaps(&self, saved: &[usize]) -> Option<String> {
        let is_new = |number: &usize| !self.states.contains(number);
        let missing: Vec<usize> = saved.iter().copied().filter(is_new).collect();
        (!missing.is_empty()).then(|| {
            format!(
                "stability was tested at states {} only, not at {}",
                self.list(),
                list(&missing)
            )
        })
    }
}

impl RunDirectory {
    /// Returns the states that `plica stability` has tested, as the manifest says; none if it has not.
    pub fn stability_coverage(&self) -> Option<StabilityCoverage> {
        let about = &manifest(&self.path)[STABILITY];
        let states = about["states"].as_array()?.iter();
        Some(StabilityCoverage {
            states: states.filter_map(|n| Some(n.as_u64()? as usize)).collect(),
            highest_mode: about["highest_mode"].as_u64().map(|n| n as usize),
        })
    }

    /// Removes the results of a stability analysis; returns whether there were any.
    ///
    /// # Errors
    /// [`RunError::File`] if a file cannot be removed or the manifest cannot be written.
    pub fn clear_stability(&self) -> Result<bool, RunError> {
        let are_there = stability_files(&self.path).iter().any(|file| file.exists());
        self.keep_stability(&[], None)?;
        Ok(are_there)
    }

    /// Removes all results of stability analyses but these, by relative path, and writes to the manifest what they cover.
    ///
    /// # Errors
    /// As [`RunDirectory::clear_stability`].
    pub fn keep_stability(
        &self,
        names: &[String],
        coverage: Option<StabilityCoverage>,
    ) -> Result<(), RunError> {
        let kept: Vec<PathBuf> = names.iter().map(|name| self.path.join(name)).collect();
        let mut files = stability_files(&self.path);
        files.retain(|file| !kept.contains(file));
        remove(files)?;
        let mut about = self.about();
        let before = about.remove(STABILITY);
        let now = coverage.map(|coverage| coverage.to_json());
        if before == now {
            return Ok(());
        }
        about.extend(now.map(|now| (STABILITY.to_owned(), now)));
        self.write_manifest(&about)
    }
}
