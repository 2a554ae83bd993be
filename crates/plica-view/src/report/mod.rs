//! Pictures, plots and animations of a run and of its stability analysis.

mod branches;
mod columns;
mod field;
mod field_scale;
mod labels;
mod manometry;
mod modes;
mod obstacles;
mod orientation;
mod pictures;
mod plots;
mod render;
mod sampling;
mod selection;
mod stability;
mod surfaces;
mod walls;

pub use branches::branch_diagrams;
pub use columns::{Column, Role};
pub use field::Field;
pub use field_scale::FieldScales;
pub use modes::mode_pictures;
pub(crate) use orientation::{VISIBLE_ASYMMETRY, upward_angle};
pub use pictures::pictures;
pub use plots::{plot, plot_walls};
pub use render::{Appearance, ColourScale, Shown, animate, render};
pub use selection::Excerpt;
pub use stability::stability_pictures;
pub use surfaces::open_tube_surfaces;
