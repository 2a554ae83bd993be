//! Forecast of the room that a run takes on the disk.

use crate::study::Plan;

/// Bytes of a number in the binary files.
const NUMBER: u64 = 8;
/// Average bytes of a number in a profile, with its comma.
const PROFILE_NUMBER: f64 = 14.7;
/// Bytes of a row of the history: of every state, and of each muscle.
const ROW: [u64; 2] = [600, 40];
/// Bytes of the header of a saved state.
const HEADER: u64 = 1000;
/// Bytes of the two checkpoints beside their vectors of unknowns, and the number of these vectors.
const CHECKPOINT: [u64; 2] = [10_000, 12];
/// Bytes of the pictures.
const PICTURES: u64 = 400_000;

/// Bytes of the files of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DiskUse {
    /// States saved in full.
    pub states: u64,
    /// Wall profiles.
    pub profiles: u64,
    /// The history.
    pub history: u64,
    /// Checkpoints, which are removed at the end, and pictures.
    pub others: u64,
}

impl DiskUse {
    /// Forecasts the room that a run takes.
    pub fn of(plan: &Plan) -> Self {
        let (mesh, output) = (&plan.mesh, &plan.output);
        let rings = mesh.rings(plan.symmetry);
        let unknowns = 3 * (mesh.axial * mesh.thickness * rings) as u64;
        let meridians = if rings == 1 { 1 } else { 2 };
        let contact = if plan.contact { 2 * meridians } else { 0 };
        let columns = 1 + 4 * meridians + contact;
        let profile = output.wall_points as f64 * columns as f64 * PROFILE_NUMBER;
        // Unknowns, control points and knots.
        let state = HEADER + NUMBER * (2 * unknowns + (mesh.axial + 32) as u64);
        let rows = 1 + plan
            .stages
            .iter()
            .map(|stage| stage.steps as u64)
            .sum::<u64>();
        let [row, of_muscle] = ROW;
        let row = row + of_muscle * plan.tube.muscles.len() as u64;
        let [others, vectors] = CHECKPOINT;
        let pictures = if output.pictures { PICTURES } else { 0 };
        Self {
            states: state * due(plan, output.states_every),
            profiles: profile as u64 * due(plan, output.profiles_every),
            history: row * (rows + 1),
            others: others + vectors * NUMBER * unknowns + pictures,
        }
    }

    /// Returns the bytes of all files.
    pub fn total(&self) -> u64 {
        self.states + self.profiles + self.history + self.others
    }
}

/// Returns the number of states of which a file is written for every n-th and for the last of each stage; 0 for none.
fn due(plan: &Plan, every: usize) -> u64 {
    if every == 0 {
        return 0;
    }
    // State 0.
    let (mut number, mut count) = (0, 1);
    for stage in &plan.stages {
        for step in 1..=stage.steps {
            number += 1;
            count += u64::from(step == stage.steps || number % every == 0);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::super::clear::files;
    use super::super::{RunDirectory, run, scratch};
    use super::*;
    use std::fs;
    use std::path::Path;

    /// Returns the bytes of a file, or of the files in a folder.
    fn bytes(path: &Path) -> u64 {
        match path.is_dir() {
            true => files(path).map(|file| bytes(&file)).sum(),
            false => fs::metadata(path).unwrap().len(),
        }
    }

    #[test]
    fn the_forecast_room_is_that_of_the_files() {
        for symmetry in ["'axisymmetric'", "{ fold = 4 }"] {
            let text = format!(
                "symmetry = {symmetry}\n[tube]\nlength = 1.0\n\
                 [mesh]\ncontrol_points = {{ axial = 8, around = 12, thickness = 4 }}\n\
                 [[stages]]\nsteps = 3\ndrive.ileum.displacement = 0.01\n\
                 [[stages]]\nsteps = 2\ndrive.ileum.displacement = 0.0\n\
                 [output]\npictures = false\nstates_every = 2\n"
            );
            let plan = crate::case::read(&text, "case").unwrap();
            assert_eq!((due(&plan, 2), due(&plan, 1), due(&plan, 0)), (5, 6, 0));
            let path = scratch("disk").join("run");
            let mut directory = RunDirectory::create(&path, &text, "case", false).unwrap();
            run(&plan, &mut directory, &mut ()).unwrap();
            let forecast = DiskUse::of(&plan);
            for (begin, expected) in [
                ("states", forecast.states),
                ("profiles", forecast.profiles),
                ("history.csv", forecast.history),
            ] {
                let ratio = bytes(&path.join(begin)) as f64 / expected as f64;
                assert!((0.7..1.4).contains(&ratio), "{symmetry} {begin}: {ratio}");
            }
            fs::remove_dir_all(path).unwrap();
        }
    }
}
