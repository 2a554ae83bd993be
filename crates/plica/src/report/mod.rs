//! What a finished run looks like: charts of its path, its walls and its tube.

mod pictures;
mod story;

pub use pictures::pictures;
pub use story::{Abscissa, Story};
