//! A study: a tube led through stages of load, state by accepted state, into a run directory.

mod checkpoint;
mod directory;
mod error;
mod findings;
#[cfg(test)]
pub(crate) mod fixture;
mod forecast;
mod harmonics;
mod history;
mod kept;
mod layout;
mod lock;
mod manifest;
mod mode;
mod observer;
mod plan;
mod record;
mod run;
mod saved_state;
mod summary;
mod units;

pub use checkpoint::Checkpoint;
pub use directory::RunDirectory;
pub use error::StudyError;
pub use findings::Findings;
pub use forecast::{Forecast, fits, forecast};
pub use harmonics::{effect, named};
pub use history::Row;
pub use kept::kept;
pub use layout::Layout;
pub use mode::NamedMode;
pub use observer::Observer;
pub use plan::{LengthUnit, Output, Plan, Stage, Start, StressUnit, Units};
pub use run::{folded, resume, run};
pub use saved_state::{Array, SavedState, SavedStateError};
pub use summary::{Ending, Phase, Snapshot, Summary, Whereabouts};
pub use units::Scale;
