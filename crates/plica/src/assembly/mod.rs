//! The discretised tube: its energy, residual and tangent stiffness, exactly differentiated.
//!
//! With u = N u_cp, F = I + ∂u/∂X and Fe = F Fp⁻¹ (Okino et al. 2025, Eqs. (1)–(12)):
//!
//! - energy    W = ∫ w(Fe) det Fp dV₀, over the grown volume;
//! - residual  R = ∂W/∂u_cp = ∫ ∂N : P Fp⁻ᵀ det Fp dV₀;
//! - tangent   K = ∂²W/∂u_cp² = ∫ ∂N : A : ∂N det Fp dV₀;
//!
//! and to each what pressures on the walls add (`pressure`).
//!
//! | letter | meaning | Rust |
//! |---|---|---|
//! | ζ, s, R | parameters: z, the fraction of an element around, the radius | – |
//! | X, x | reference and current position, in the frame of the element: (z, outwards, around) | – |
//! | C | spline circle, C(s) = Σ N_b exp(i φ_b), scaled to unit radius | `tables` |
//! | Fe | columns along, outwards, around at the point; rows as x | `Fe` |
//!
//! Elements are taken eight at a time, one per lane: a *slab* holds eight neighbours along the
//! tube, and everything around and through the wall. Sums are factorised: along the tube, then
//! through the wall, then around it. Slabs may be worked on in any order by any number of
//! threads; what they leave is added up in the order of the slabs, so that results do not depend
//! on the threads.

#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod coupling;
mod damping;
mod forces;
mod imperfection;
mod kinematics;
mod linearised;
mod pencil;
mod place;
mod pressure;
mod reference;
mod ring_damping;
mod sample;
mod slab;
mod spline_tube;
mod stress_free;
mod supports;
mod tables;
mod tangent;
#[cfg(test)]
mod tests;

pub use coupling::LowHarmonics;
pub use linearised::Linearised;
pub use place::Place;
pub use reference::{ReferenceForces, ReferenceTube};
pub use ring_damping::RingDamping;
pub use sample::{Point, Sample};
pub use spline_tube::{Forces, Inverted, SplineTube};
