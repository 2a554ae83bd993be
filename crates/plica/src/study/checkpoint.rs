//! What a run leaves after every state so that it can be taken up again there.
//!
//! A checkpoint is a saved state with what the path keeps beside it: how far along which stage, how the state before lay, how
//! fast pseudo-time moved. It carries the digest of the history up to its row, so that it goes on with no other.

use super::{Array, Plan, Row, SavedState, SavedStateError};
use crate::solve::{ContinuationState, PreviousPoint};
use crate::tube::Load;
use std::collections::BTreeMap;

/// A state to go on from.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// The state.
    pub state: SavedState,
    /// The stage that the path is in, from 0; none before the first.
    pub stage: Option<usize>,
    /// What the path keeps.
    pub memory: ContinuationState,
    /// Digest of the rows of the history up to that of the state.
    pub history: [u8; 32],
}

/// Names of its arrays beside `u`.
const PATH: &str = "path";
const HISTORY: &str = "history";
const PREVIOUS: &str = "previous";
const TANGENT: &str = "behind_tangent";
const VELOCITY: &str = "velocity";
/// What stands for none among the numbers of the path.
const NONE: f64 = -1.0;

impl Checkpoint {
    /// As a state with more arrays, for its file.
    pub fn into_state(self) -> SavedState {
        let Self {
            mut state,
            stage,
            memory,
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
        let previous = memory.previous.as_ref().map_or(NONE, |previous| previous.t);
        let stage = stage.map_or(NONE, |stage| stage as f64);
        let path = vec![stage, memory.reached, memory.halving_level as f64, previous];
        let mut arrays = BTreeMap::from([
            (PATH.to_owned(), row(path)),
            (
                HISTORY.to_owned(),
                row(history.iter().map(|byte| f64::from(*byte)).collect()),
            ),
        ]);
        if let Some(PreviousPoint { u, tangent, .. }) = memory.previous {
            arrays.insert(PREVIOUS.into(), like_u(u));
            arrays.insert(TANGENT.into(), like_u(tangent));
        }
        if memory.velocity.iter().any(|v| *v != 0.0) {
            arrays.insert(VELOCITY.into(), like_u(memory.velocity));
        }
        state.arrays = arrays;
        state
    }

    /// From what its file holds.
    ///
    /// # Errors
    /// [`SavedStateError::Array`] if an array is not as it must be: it is a state, and no checkpoint.
    pub fn from_state(mut state: SavedState) -> Result<Self, SavedStateError> {
        let mut arrays = std::mem::take(&mut state.arrays);
        let mut take = |name: &str| arrays.remove(name).map(|array| array.values);
        let wrong = |name: &str, what: &str| SavedStateError::Array {
            name: name.into(),
            what: what.into(),
        };
        let missing = "is missing, so that this is no checkpoint";
        let path = take(PATH).ok_or_else(|| wrong(PATH, missing))?;
        let [stage, reached, halving_level, previous]: [f64; 4] =
            (path.try_into()).map_err(|_| wrong(PATH, "does not have four numbers"))?;
        let whole = |x: f64, most: f64| x == x.trunc() && (NONE..=most).contains(&x);
        let sound = whole(stage, 1e6) && whole(halving_level, 60.0) && halving_level >= 0.0;
        if !sound || !(0.0..=1.0).contains(&reached) || (previous != NONE && previous >= reached) {
            return Err(wrong(PATH, "makes no sense"));
        }
        let bytes = take(HISTORY).ok_or_else(|| wrong(HISTORY, missing))?;
        let byte = |x: &f64| (*x == x.trunc() && (0.0..256.0).contains(x)).then_some(*x as u8);
        let bytes: Option<Vec<u8>> = bytes.iter().map(byte).collect();
        let history = bytes.and_then(|bytes| bytes.try_into().ok());
        let history = history.ok_or_else(|| wrong(HISTORY, "is no digest"))?;
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
            memory: ContinuationState {
                reached,
                halving_level: halving_level as usize,
                previous,
                velocity,
            },
            history,
            state,
        })
    }

    /// Whether it is one of a plan's, and goes on where these rows end or before.
    ///
    /// # Errors
    /// Why not, in words.
    pub fn fits(&self, plan: &Plan, rows: &[Row]) -> Result<(), String> {
        self.state.belongs_to(plan).map_err(|e| e.to_string())?;
        let Some(own) = rows.get(..=self.state.row) else {
            return Err(format!(
                "it is of state {}, and history.csv ends with state {}",
                self.state.row,
                rows.len() as i64 - 1
            ));
        };
        if Digest::of(own).finish() != self.history {
            return Err("history.csv is not the one that it was written beside".into());
        }
        let Some([from, to]) = self.segment(plan) else {
            return Err("its stage is none of the case's".into());
        };
        if self.state.load != from.towards(&to, self.memory.reached) {
            return Err("its load is not on the way of the case".into());
        }
        Ok(())
    }

    /// The loads between which it is on its way by a plan; none if the plan has no such stage.
    pub fn segment(&self, plan: &Plan) -> Option<[Load; 2]> {
        let first = match &plan.start {
            Some(start) => start.load.clone(),
            None => plan.tube.rest(),
        };
        let end = |stage: usize| Some(plan.stages.get(stage)?.load.clone());
        match self.stage {
            None => Some([first.clone(), first]),
            Some(0) => Some([first, end(0)?]),
            Some(stage) => Some([end(stage - 1)?, end(stage)?]),
        }
    }
}

/// A digest of rows, their wall times aside, and whether they tell of pressures that are none.
#[derive(Clone, Debug, Default)]
pub struct Digest(blake3::Hasher);

impl Digest {
    /// Of some rows.
    pub fn of(rows: &[Row]) -> Self {
        let mut digest = Self::default();
        rows.iter().for_each(|row| digest.add(row));
        digest
    }

    /// With one more.
    pub fn add(&mut self, row: &Row) {
        let row = Row {
            seconds: 0.0,
            ..row.clone().pressed()
        };
        let mut line = csv::Writer::from_writer(vec![]);
        // Writing to memory does not fail.
        let _ = line.serialize(row);
        self.0.update(&line.into_inner().unwrap_or_default());
    }

    /// What it comes to.
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
            memory: ContinuationState {
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
    fn a_checkpoint_comes_back_from_its_file_to_the_bit() {
        for previous in [true, false] {
            let mine = checkpoint(previous);
            let bytes = mine.clone().into_state().to_bytes().unwrap();
            let back = SavedState::from_bytes(&bytes).unwrap();
            assert_eq!(Checkpoint::from_state(back).unwrap(), mine);
        }
    }

    #[test]
    fn a_state_is_no_checkpoint_and_nonsense_is_refused() {
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
