//! What a finished run looks like: charts of its path, its walls and its tube; and of what a test
//! of its stability found.

mod columns;
mod field;
mod modes;
mod opened;
mod pictures;
mod plots;
mod stability;
mod states;
mod story;
mod tolerance;
mod upright;
mod walls;

pub use columns::{Column, Role};
pub use field::Field;
pub use modes::mode_pictures;
pub use opened::{Look, Points, looked_at, opened};
pub use pictures::pictures;
pub use plots::{plot, plot_walls};
pub use stability::stability_pictures;
pub use states::{Appearance, Shown, animate, render};
pub use story::{Abscissa, Story};
pub use tolerance::Tolerance;
pub use upright::{VISIBLE, upright};
