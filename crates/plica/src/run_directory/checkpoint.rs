//! Checkpoints: all that it takes to resume a run after a state.
//!
//! A checkpoint is a saved state with the state of the continuation: stage, completed fraction, previous point, pseudo-time
//! velocity, history of friction. It carries the record of the run up to its row, from which a damaged history is restored, and so that it is
//! never used with another history.

use super::Record;
use crate::saved_state::{Array, FRICTION, SavedState, SavedStateError};
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
    /// The rows of the history up to that of the state, and the files of these states.
    pub record: Record,
}

/// Names of its arrays beside `u`.
const PATH: &str = "path";
const HISTORY: &str = "history";
const FILES: &str = "files";
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
            record,
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
        let [history, files] = record.arrays();
        let mut arrays = BTreeMap::from([
            (PATH.to_owned(), row(numbers)),
            (HISTORY.to_owned(), history),
            (FILES.to_owned(), files),
        ]);
        if let Some(PreviousPoint { u, tangent, .. }) = path.previous {
            arrays.insert(PREVIOUS.into(), like_u(u));
            arrays.insert(TANGENT.into(), like_u(tangent));
        }
        if path.velocity.iter().any(|v| *v != 0.0) {
            arrays.insert(VELOCITY.into(), like_u(path.velocity));
        }
        if !path.history.is_empty() {
            arrays.insert(FRICTION.into(), row(path.history));
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
        let history = take(HISTORY).ok_or_else(|| wrong(HISTORY, missing))?;
        let files = take(FILES).ok_or_else(|| wrong(FILES, missing))?;
        let record = Record::from_arrays([&history, &files]);
        let record = record.ok_or_else(|| wrong(HISTORY, "is not the record of a run"))?;
        let long = |name: &str, values: Vec<f64>| match values.len() == state.u.len() {
            true => Ok(values),
            false => Err(wrong(name, "is not as long as u")),
        };
        let velocity = match take(VELOCITY) {
            Some(velocity) => long(VELOCITY, velocity)?,
            None => vec![0.0; state.u.len()],
        };
        let history = take(FRICTION).unwrap_or_default();
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
                history,
            },
            record,
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

    /// Returns the rows up to its state, with the wall times of the recorded rows, and the numbers of the states whose rows
    /// are not among the recorded ones.
    ///
    /// # Errors
    /// The reason, in words, why the checkpoint does not belong to the plan or to the recorded rows.
    pub fn rows(&self, plan: &Plan, recorded: &[Row]) -> Result<(Vec<Row>, Vec<usize>), String> {
        plan.accepts(&self.state).map_err(|e| e.to_string())?;
        let own = self
            .record
            .rows()
            .filter(|own| own.len() == self.state.row + 1);
        let own = own.ok_or("its copy of history.csv has other columns or rows")?;
        let (own, lost) = with_recorded(own, recorded);
        let present = recorded.iter().filter(|row| row.step < own.len()).count();
        // A few damaged rows are restored; a table of which most differ is that of another run.
        if 2 * (own.len() - lost.len()) < present {
            return Err("it was written with another history.csv".into());
        }
        let Some(segment) = self.clone().into_continuation().segment(plan) else {
            return Err("the case has no such stage".into());
        };
        let [from, to] = &segment.loads;
        let expected = from.towards(to, segment.fraction(self.path.reached));
        if self.state.load.clone().without_multiplier() != expected.without_multiplier() {
            return Err("its load is not on the path of the case".into());
        }
        Ok((own, lost))
    }
}

/// Returns rows with the wall times of recorded rows, and the numbers of those that are not recorded as they are.
pub(super) fn with_recorded(mut rows: Vec<Row>, recorded: &[Row]) -> (Vec<Row>, Vec<usize>) {
    let recorded: BTreeMap<usize, &Row> = recorded.iter().map(|row| (row.step, row)).collect();
    let mut lost = vec![];
    for row in &mut rows {
        match recorded.get(&row.step) {
            Some(found) if agree(found, row) => row.seconds = found.seconds,
            _ => lost.push(row.step),
        }
    }
    (rows, lost)
}

/// Returns whether two rows agree, apart from wall times; absent pressures count as zero.
fn agree(a: &Row, b: &Row) -> bool {
    let has_lumen = a.lumen_pressure.is_some() || b.lumen_pressure.is_some();
    let is_sideways = [a, b].iter().any(|row| row.ends[0].sideways.is_some());
    let [a, b] = [a, b].map(|row| {
        let row = row.clone().with_pressures();
        let mut row = if has_lumen {
            row.with_lumen_pressure()
        } else {
            row
        };
        if is_sideways {
            row = row.with_sideways_ends();
        }
        Row {
            seconds: 0.0,
            ..row
        }
    });
    a == b
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
                history: if previous {
                    vec![0.5, 1e-9, 7.0]
                } else {
                    vec![]
                },
            },
            record: Record::default(),
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
        broken(|state| state.arrays.get_mut(HISTORY).unwrap().values[0] = 256.0);
        broken(|state| {
            state.arrays.remove(FILES);
        });
        broken(|state| {
            state.arrays.get_mut(PREVIOUS).unwrap().values.pop();
        });
        broken(|state| {
            state.arrays.remove(TANGENT);
        });
    }
}
