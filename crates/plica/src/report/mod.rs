//! What a finished run looks like: charts of its path, its walls and its tube; and of what a test
//! of its stability found.

mod modes;
mod opened;
mod pictures;
mod stability;
mod story;

pub use modes::mode_pictures;
pub use opened::opened;
pub use pictures::pictures;
pub use stability::stability_pictures;
pub use story::{Abscissa, Story};
