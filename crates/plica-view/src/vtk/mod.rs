//! Files of VTK, as ParaView and PyVista read them: grids, surfaces, collections.
//!
//! | file | holds |
//! |---|---|
//! | `column` | an array of numbers as it stands in a file: blocks, compressed one by one |
//! | `lagrange` | the order of the nodes of a cell of any degree |
//! | `lattice` | cells between points that lie in rows, rows in layers |
//! | `document` | the file: a head in XML, then the columns as raw bytes |
//! | `hdf` | one file of a surface that moves, as VTKHDF |
//! | `collection` | a file that names others, one per step |
//!
//! Format: VTK's XML files, version 2.2 (in which the nodes of a Lagrange hexahedron stand in the order that is
//! used here), little-endian, appended raw data, zlib; and VTKHDF 2.0.

mod collection;
mod column;
mod document;
mod hdf;
mod lagrange;
mod lattice;

pub use collection::collection;
pub use column::{Column, Number};
pub use document::Document;
pub use hdf::Movie;
pub use lagrange::hexahedron;
pub use lattice::{Cells, Lattice};
