//! Problems and helpers that several tests use.

use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::study::Plan;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the main case on a mesh of the given control points along, around and through the wall.
pub fn main_case([axial, around, thickness]: [usize; 3]) -> Plan {
    let text = include_str!("../../../../cases/invagination.toml");
    let mut plan = plica::case::read(text, "invagination").unwrap();
    (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (axial, around, thickness);
    plan
}

/// Returns the problem of a plan with the given number of independent rings.
pub fn problem(plan: &Plan, rings: usize) -> TubeProblem {
    TubeProblem::new(SplineTube::new(&plan.tube, &plan.mesh, rings))
}

/// Returns the root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the files with an extension in a directory and its subdirectories.
pub fn files(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = vec![];
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found
}

/// Pseudo-random numbers from a seed that is not 0, by xorshift.
pub struct Chance(pub u64);

impl Chance {
    /// Returns a number from 0 to n − 1; 0 if n is 0.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}
