//! Tests of the library through its public interface.

mod active_stress;
mod common;

mod contact;
mod contact_cases;
mod contact_surfaces;
mod equilibrium;
mod examples;
mod fuzz;
mod imperfections;
mod layers;
mod loads;
mod lowest_modes;
mod lumen;
mod patches;
mod rigid_body_motions;
mod shape;
mod stability;
mod study;
mod tangents;
mod three_dimensions;
mod waves;
