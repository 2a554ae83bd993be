//! The faces of a wall.

use std::fmt;

/// A face of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Reference radius D/2.
    Outer,
    /// Reference radius D/2 − H.
    Inner,
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Outer => "outer wall",
            Self::Inner => "inner wall",
        })
    }
}
