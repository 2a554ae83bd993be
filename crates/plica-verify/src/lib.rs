//! Checks Plica against closed forms and independent solutions, and reproduces the figures of Okino et al. (2025).

pub mod reproduction;
pub mod verification;
