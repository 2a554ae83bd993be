//! Finding equilibria.

mod settings;

pub use settings::{Integrator, PseudoTime, Scheme, Settings};
