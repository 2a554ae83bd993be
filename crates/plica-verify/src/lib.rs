//! Verification of Plica against reference values, and reproduction of the figures of Okino et al. (2025).
//!
//! ```no_run
//! let verification = plica_verify::verification::verify(false, &|_| true, &mut ()).unwrap();
//! assert_eq!(verification.failed(), 0);
//! ```

pub mod reproduction;
pub mod verification;
