//! Presents results of Plica: pictures, plots, animations, VTK files and HTML pages.
//!
//! | module | content |
//! |---|---|
//! | [`draw`] | charts and shaded cutaways as PNG or SVG, from plain data |
//! | [`report`] | pictures, plots and animations of a run |
//! | [`page`] | one or several runs as an HTML page |
//! | [`export`] | states as VTK files for ParaView and PyVista |
//! | [`obstacle_shapes`] | surfaces and sections of rigid obstacles |
//! | [`vtk`] | writers for VTK files |
//! | [`law_chart`] | curves of mechanical tests of laws |
//!
//! # Quick start
//! A picture of a neck in a tube, cut open and coloured by the radius:
//!
//! ```
//! use plica_view::draw::{Cutaway, Opening, Panel, REAR_HALF};
//!
//! let opening = Opening::uniform(REAR_HALF, [81, 33, 5]);
//! let surfaces = opening.surfaces(|zeta, eta, xi| {
//!     let z = 3.0 * zeta;
//!     let r = 0.44 + 0.06 * xi - 0.2 * (-20.0 * (z - 1.0).powi(2)).exp();
//!     ([r * eta.cos(), r * eta.sin(), z], r)
//! });
//! let picture = Cutaway {
//!     panels: vec![Panel { surfaces, ..Panel::default() }],
//!     value_label: "radius *r*/*D*".into(),
//!     ..Cutaway::default()
//! };
//! std::fs::write(std::env::temp_dir().join("neck.png"), picture.png(900)?)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod draw;
pub mod export;
pub mod law_chart;
pub mod obstacle_shapes;
pub mod page;
pub mod report;
pub mod sampled_tube;
pub mod vtk;

#[cfg(test)]
mod fixture;
