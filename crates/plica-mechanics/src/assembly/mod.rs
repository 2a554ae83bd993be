//! Finite element assembly: energy, residual and tangent stiffness of a tube discretised by splines.
//!
//! With u = N u_cp, F = I + ∂u/∂X and Fe = F Fp⁻¹ (Okino et al. 2025, Eqs. (1)–(12)), a
//! [`SplineTube`] assembles
//!
//! - the energy    W = ∫ w(Fe) det Fp dV₀, over the grown volume;
//! - the residual  R = ∂W/∂u_cp = ∫ ∂N : P Fp⁻ᵀ det Fp dV₀;
//! - the tangent   K = ∂²W/∂u_cp² = ∫ ∂N : A : ∂N det Fp dV₀;
//!
//! and adds the contributions of pressure on the walls, and of their contact with obstacles (`walls`).
//!
//! The basis is a tensor product of splines along the tube, through the wall and around it. Every
//! element around the tube is the same element, rotated, so each element works in a frame of its
//! own, whose axes at the middle of the element are (axial, outwards, around), and all elements
//! around the tube share the same tables of basis functions (`tables`).
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | ζ, s, R | parameters: z, the fraction of an element around the tube, the radius | – |
//! | X, x | reference and current position, in the frame of the element | – |
//! | C | spline circle, C(s) = Σ N_b exp(i φ_b), scaled to unit radius | `tables` |
//! | Fe | columns along, outwards, around at the point; rows as x | `Fe` |
//!
//! The kernels process eight elements at once, one per SIMD lane. An *axial batch* (`axial`) holds
//! eight neighbours along the tube; sectors of one ring and assembled matrices use it. A
//! *circumferential batch* (`circumferential`) holds all elements around the tube at one axial
//! position; sectors of many rings use it. Both factorise the sums over the tensor-product basis:
//! along the tube, then through the wall, then around it. Batches run in parallel, and their results
//! are added in the order of the batches, so results do not depend on the number of threads.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod axial;
mod barrier;
mod batch_input;
mod blocks;
mod boundary_conditions;
mod circumferential;
mod coulomb;
mod damping;
mod dispatch;
mod forces;
mod imperfect_tube;
mod imperfection;
mod kinematics;
mod low_harmonic_tangent;
mod low_harmonics;
mod matrix_free_tangent;
mod modified_wall;
mod place;
mod positions;
mod reference;
mod ring_damping;
mod sample;
mod spline_tube;
mod stress_free;
mod surface;
mod tables;
mod tangent;
#[cfg(test)]
mod tests;
mod walls;

pub use barrier::{Barrier, BarrierJet};
pub use coulomb::Slip;
pub use forces::{Forces, Inverted};
pub use low_harmonics::LowHarmonics;
pub use matrix_free_tangent::MatrixFreeTangent;
pub use place::Place;
pub use reference::{ReferenceForces, ReferenceTube};
pub use ring_damping::RingDamping;
pub use sample::{Point, Sample};
pub use spline_tube::SplineTube;
pub use surface::SurfacePoint;
pub use walls::{Friction, ObstacleContact, ObstacleFriction, StepStart};
