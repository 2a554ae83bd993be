//! Checkpoints: all that it takes to resume a run after a state.
//!
//! A checkpoint is a saved state with the state of the continuation: stage, completed fraction, previous point, pseudo-time
//! velocity. It carries a digest of the history up to its row, so that it is never used with another history.

use super::write::table_of;
use crate::saved_state::{Array, SavedState, SavedStateError};
use crate::solve::{ContinuationState, PreviousPoint};
use crate::study::{Continuation, Plan, Row};
use std::collections::BTreeMap;

/// A state to resume a run from.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The state.
    pub state: SavedState,
    /// Stage that the path is in, from 0; none before the first.
    pub stage: Option<usize>,
    /// State of the continuation.
    pub path: ContinuationState,
    /// Digest of the rows of the history up to that of the state.
    pub history: [u8; 32],
}

/// Names of its arrays beside `u`.
const PATH: &str = "path";
const HISTORY: &str = "history";
const PREVIOUS: &str = "previous";
const TANGENT: &str = "previous_tangent";
const VELOCITY: &str = "velocity";
/// Number that stands for no value among the numbers of the path.
const NONE: f64 = -1.0;

impl Checkpoint {
    /// Converts the checkpoint to a saved state with further arrays, for its file.
    pub fn into_state(self) -> SavedState {
        let Self {
            mut state,
            stage,
            path,
            history,
        } = self;
        let shape = state.layout.shape().to_vec();
        let like_u = |values| Array {
            shape: shape.clone(),
            values,
        };
        let row = |values: Vec<f64>| Array {
            shape: vec![values.len()],
            values,
        };
        let previous = path.previous.as_ref().map_or(NONE, |previous| previous.t);
        let stage = stage.map_or(NONE, |stage| stage as f64);
        let numbers = vec![stage, path.reached, path.halving_level as f64, previous];
        let mut arrays = BTreeMap::from([
            (PATH.to_owned(), row(numbers)),
            (
                HISTORY.to_owned(),
                row(history.iter().map(|byte| f64::from(*byte)).collect()),
            ),
        ]);
        if let Some(PreviousPoint { u, tangent, .. }) = path.previous {
            arrays.insert(PREVIOUS.into(), like_u(u));
            arrays.insert(TANGENT.into(), like_u(tangent));
        }
        if path.velocity.iter().any(|v| *v != 0.0) {
            arrays.insert(VELOCITY.into(), like_u(path.velocity));
        }
        state.arrays = arrays;
        state
    }

    /// Makes a checkpoint from the content of its file.
    ///
    /// # Errors
    /// [`SavedStateError::Array`] if an array is missing or invalid.
    pub fn from_state(mut state: SavedState) -> Result<Self, SavedStateError> {
        let mut arrays = std::mem::take(&mut state.arrays);
        let mut take = |name: &str| arrays.remove(name).map(|array| array.values);
        let wrong = |name: &str, what: &str| SavedStateError::Array {
            name: name.into(),
            what: what.into(),
        };
        let missing = "is missing: this is not a checkpoint";
        let path = take(PATH).ok_or_else(|| wrong(PATH, missing))?;
        let [stage, reached, halving_level, previous]: [f64; 4] =
            (path.try_into()).map_err(|_| wrong(PATH, "does not have four numbers"))?;
        let whole = |x: f64, most: f64| x == x.trunc() && (NONE..=most).contains(&x);
        let sound = whole(stage, 1e6) && whole(halving_level, 60.0) && halving_level >= 0.0;
        if !sound || !(0.0..=1.0).contains(&reached) || (previous != NONE && previous >= reached) {
            return Err(wrong(PATH, "is invalid"));
        }
        let bytes = take(HISTORY).ok_or_else(|| wrong(HISTORY, missing))?;
        let byte = |x: &f64| (*x == x.trunc() && (0.0..256.0).contains(x)).then_some(*x as u8);
        let bytes: Option<Vec<u8>> = bytes.iter().map(byte).collect();
        let history = bytes.and_then(|bytes| bytes.try_into().ok());
        let history = history.ok_or_else(|| wrong(HISTORY, "is not a digest"))?;
        let long = |name: &str, values: Vec<f64>| match values.len() == state.u.len() {
            true => Ok(values),
            false => Err(wrong(name, "is not as long as u")),
        };
        let velocity = match take(VELOCITY) {
            Some(velocity) => long(VELOCITY, velocity)?,
            None => vec![0.0; state.u.len()],
        };
        let mut needed = |name: &str| {
            let values = take(name).ok_or_else(|| wrong(name, missing))?;
            long(name, values)
        };
        let previous = match previous {
            NONE => None,
            t => Some(PreviousPoint {
                t,
                u: needed(PREVIOUS)?,
                tangent: needed(TANGENT)?,
            }),
        };
        Ok(Self {
            stage: (stage >= 0.0).then_some(stage as usize),
            path: ContinuationState {
                reached,
                halving_level: halving_level as usize,
                previous,
                velocity,
            },
            history,
            state,
        })
    }

    /// Converts the checkpoint to a continuation of a study.
    pub fn into_continuation(self) -> Continuation {
        Continuation {
            number: self.state.row,
            stage: self.stage,
            load: self.state.load,
            unknowns: self.state.u,
            path: self.path,
        }
    }

    /// Checks that the checkpoint belongs to a plan and to the rows up to its state.
    ///
    /// # Errors
    /// The reason, in words.
    pub fn fits(&self, plan: &Plan, rows: &[Row]) -> Result<(), String> {
        plan.accepts(&self.state).map_err(|e| e.to_string())?;
        let Some(own) = rows.get(..=self.state.row) else {
            return Err(format!(
                "it is of state {}, and history.csv ends with state {}",
                self.state.row,
                rows.len() as i64 - 1
            ));
        };
        if Digest::of(own).finish() != self.history {
            return Err("it was written with another history.csv".into());
        }
        let Some([from, to]) = self.clone().into_continuation().segment(plan) else {
            return Err("the case has no such stage".into());
        };
        if self.state.load != from.towards(&to, self.path.reached) {
            return Err("its load is not on the path of the case".into());
        }
        Ok(())
    }
}

/// A digest of rows, without their wall times; absent pressures count as zero.
#[derive(Clone, Debug, Default)]
pub struct Digest(blake3::Hasher);

impl Digest {
    /// Returns the digest of rows.
    pub fn of(rows: &[Row]) -> Self {
        let mut digest = Self::default();
        rows.iter().for_each(|row| digest.add(row));
        digest
    }

    /// Adds a row.
    pub fn add(&mut self, row: &Row) {
        let row = Row {
            seconds: 0.0,
            ..row.clone().with_pressures()
        };
        // Writing to memory cannot fail.
        let table = table_of(&[row]).unwrap_or_default();
        self.0.update(&table);
    }

    /// Returns the digest.
    pub fn finish(&self) -> [u8; 32] {
        *self.0.finalize().as_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture::{plan, state};
    use crate::tube::Symmetry;

    fn checkpoint(previous: bool) -> Checkpoint {
        let state = state(&plan(Symmetry::Axisymmetric), 3);
        let like_u = |x: f64| vec![x; state.u.len()];
        Checkpoint {
            stage: previous.then_some(1),
            path: ContinuationState {
                reached: if previous { 0.4 } else { 0.0 },
                halving_level: 2,
                previous: previous.then(|| PreviousPoint {
                    t: 0.2,
                    u: like_u(0.5),
                    tangent: like_u(-1.5),
                }),
                velocity: like_u(if previous { 0.0 } else { 0.25 }),
            },
            history: std::array::from_fn(|i| 7 * i as u8),
            state,
        }
    }

    #[test]
    fn a_checkpoint_is_read_as_it_was_written_to_the_bit() {
        for previous in [true, false] {
            let mine = checkpoint(previous);
            let bytes = mine.clone().into_state().to_bytes().unwrap();
            let back = SavedState::from_bytes(&bytes).unwrap();
            assert_eq!(Checkpoint::from_state(back).unwrap(), mine);
        }
    }

    #[test]
    fn states_and_invalid_checkpoints_are_refused() {
        let bare = state(&plan(Symmetry::Axisymmetric), 3);
        assert!(Checkpoint::from_state(bare).is_err());
        let broken = |change: fn(&mut SavedState)| {
            let mut state = checkpoint(true).into_state();
            change(&mut state);
            assert!(Checkpoint::from_state(state).is_err());
        };
        broken(|state| state.arrays.get_mut(PATH).unwrap().values[0] = 0.5);
        broken(|state| state.arrays.get_mut(PATH).unwrap().values[1] = 1.5);
        broken(|state| state.arrays.get_mut(PATH).unwrap().values[3] = 0.9);
        broken(|state| {
            state.arrays.insert(VELOCITY.into(), Array::default());
        });
        broken(|state| state.arrays.get_mut(HISTORY).unwrap().values[5] = 256.0);
        broken(|state| {
            state.arrays.get_mut(PREVIOUS).unwrap().values.pop();
        });
        broken(|state| {
            state.arrays.remove(TANGENT);
        });
    }
}
