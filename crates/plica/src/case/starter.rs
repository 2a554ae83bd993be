//! The case that a new user starts from.

/// A commented case file: the tube of Okino et al. (2025), which invaginates.
pub const STARTER: &str = include_str!("starter.toml");
