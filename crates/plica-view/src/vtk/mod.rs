//! VTK files for ParaView and PyVista: volume grids, surfaces, time series.
//!
//! | file | content |
//! |---|---|
//! | `column` | an array of numbers, compressed in blocks |
//! | `lagrange` | node numbering of Lagrange hexahedra |
//! | `lattice` | cells of a structured grid that is periodic in one direction |
//! | `document` | an XML file with appended arrays (`.vtu`, `.vtp`) |
//! | `hdf` | a time series of a surface in one VTKHDF file |
//! | `collection` | a list of files, one per step (`.pvd`) |
//!
//! The XML files have version 2.2 (which defines the numbering of Lagrange hexahedra), little-endian raw appended data and zlib
//! compression; the VTKHDF files have version 2.0.

mod collection;
mod column;
mod document;
mod hdf;
mod lagrange;
mod lattice;

pub use collection::collection;
pub use column::{Column, Number};
pub use document::Document;
pub use hdf::Series;
pub use lattice::{Cells, Lattice};
