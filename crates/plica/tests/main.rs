//! Tests of the library through its public interface.

mod imperfections;
mod loads;
mod rigid_body_motions;
mod study;
mod tangents;
mod three_dimensions;
