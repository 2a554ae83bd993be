//! Presents what Plica computes: pictures, plots, animations, VTK files and HTML pages.

pub mod draw;
pub mod export;
pub mod page;
pub mod report;
pub mod vtk;

#[cfg(test)]
mod fixture;
