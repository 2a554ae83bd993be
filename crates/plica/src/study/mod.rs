//! A study: a tube led through stages of load, state by accepted state.

mod history;
mod observer;
mod plan;
mod problem;

pub use history::Row;
pub use observer::Observer;
pub use plan::{Output, Plan, Stage, Units};
pub use problem::TubeProblem;
