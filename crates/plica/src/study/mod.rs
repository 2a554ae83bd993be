//! A study: a tube followed through stages of load, one accepted state after another, in memory.
//!
//! [`Study`] is an iterator of [`State`]s. It reads and writes no files; a run directory
//! ([`crate::run_directory`]), a progress bar or a plot consumes its states.
//!
//! - [`Plan`]: the checked, dimensionless content of a case;
//! - [`Study`] and [`State`]: the iterator and its items; [`Continuation`] resumes a study after a state;
//! - [`Lost`]: where and why a tube could not be followed further;
//! - [`Row`]: a state as a row of `history.csv`, in the units of the case; [`RowReader`] reads one back;
//! - [`Findings`]: statements about a whole path;
//! - [`Condition`]: a condition on a state, at which a run stops;
//! - [`forecast`]: size and cost of a study before it runs.

mod changes;
mod condition;
mod contact_range;
mod contact_row;
mod error;
pub mod findings;
#[cfg(test)]
pub(crate) mod fixture;
mod following;
mod forecast;
mod iterator;
mod limit_point;
mod lost;
mod obstacle_row;
mod patch_row;
mod plan;
mod row;
mod stage;
mod start;
mod state;
mod table;
mod units;
mod work;

pub use changes::forbidden_changes;
pub use condition::Condition;
pub use contact_range::{HalfRange, RangeChanges, half_range};
use contact_row::WALLS;
pub use contact_row::{ContactRow, RESOLVED_TURN_DEG, WallContactRow};
pub use error::StudyError;
pub use findings::Findings;
pub use following::{Event, Following, PARAMETER, Switch};
pub use forecast::{Forecast, available_memory, check_memory, forecast, memory_bytes};
pub use iterator::{Continuation, Ending, Study};
pub use limit_point::LimitPoint;
pub use lost::{Location, Lost, Phase};
pub use obstacle_row::ObstacleRow;
pub use patch_row::PatchRow;
pub use plan::{LengthUnit, MaterialFile, ModeShape, Output, Plan, Start, StressUnit, Units};
pub use row::{EndRow, MuscleRow, Row, SidewaysRow};
pub use stage::Stage;
pub use start::{inverted_by_imperfections, lumen_volume_at_rest};
pub use state::{MuscleState, ObstacleState, PatchState, State};
pub use table::{Cell, Quantity, RowReader};
pub use units::Scale;
pub use work::Work;
