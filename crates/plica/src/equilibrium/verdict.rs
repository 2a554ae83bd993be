//! The verdict on the stability of a state.

use crate::tube::Symmetry;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Stability of a state, by the signs of the eigenvalues of its tangent.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Stability {
    /// No tested mode has a negative eigenvalue. Written `none`.
    Stable,
    /// The modes with negative eigenvalues. Written `mode:count`, separated by spaces.
    Unstable(Vec<Instability>),
    /// The sign of the lowest eigenvalue was not determined. Written `unknown`.
    Unknown,
}

/// A mode with negative eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instability {
    /// The mode.
    pub mode: UnstableMode,
    /// Number of negative eigenvalues.
    pub eigenvalues: usize,
}

/// A mode that a state is unstable to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum UnstableMode {
    /// A circumferential mode of the whole tube, by its wave number. Written as the number.
    Circumferential(usize),
    /// The lowest mode of a state that is not axisymmetric. Written `any`.
    Lowest,
}

impl Stability {
    /// Returns the modes that the state is unstable to; none if it is stable or not known.
    pub fn unstable_modes(&self) -> impl Iterator<Item = UnstableMode> + '_ {
        let instabilities: &[Instability] = match self {
            Self::Unstable(instabilities) => instabilities,
            Self::Stable | Self::Unknown => &[],
        };
        instabilities.iter().map(|instability| instability.mode)
    }

    /// Returns whether a mode has a negative eigenvalue.
    pub fn is_unstable(&self) -> bool {
        matches!(self, Self::Unstable(_))
    }
}

impl UnstableMode {
    /// Returns whether a run of a symmetry can follow the mode. The lowest mode of a state is one of the run itself.
    pub fn is_admitted_by(self, symmetry: Symmetry) -> bool {
        match (symmetry, self) {
            (_, Self::Lowest | Self::Circumferential(0)) | (Symmetry::None, _) => true,
            (Symmetry::Axisymmetric, _) => false,
            (Symmetry::Fold(m), Self::Circumferential(n)) => n.is_multiple_of(m),
        }
    }

    /// Describes the mode, for example `circumferential mode 2 (turns oval)`.
    pub fn describe(self) -> String {
        match self {
            Self::Circumferential(n) => format!("circumferential mode {n} ({})", mode_effect(n)),
            Self::Lowest => "its own lowest mode".into(),
        }
    }
}

/// Describes what a circumferential mode does to a tube, by its wave number.
pub fn mode_effect(n: usize) -> String {
    match n {
        0 => "buckles axisymmetrically".into(),
        1 => "tilts sideways".into(),
        2 => "turns oval".into(),
        n => format!("folds into {n} lobes"),
    }
}

impl fmt::Display for UnstableMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Circumferential(n) => write!(f, "{n}"),
            Self::Lowest => f.write_str("any"),
        }
    }
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stable => f.write_str("none"),
            Self::Unknown => f.write_str("unknown"),
            Self::Unstable(instabilities) => {
                for (i, Instability { mode, eigenvalues }) in instabilities.iter().enumerate() {
                    let space = if i > 0 { " " } else { "" };
                    write!(f, "{space}{mode}:{eigenvalues}")?;
                }
                Ok(())
            }
        }
    }
}

impl FromStr for Stability {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => return Ok(Self::Stable),
            "unknown" => return Ok(Self::Unknown),
            _ => {}
        }
        let instability = |word: &str| {
            let (mode, eigenvalues) = word.split_once(':')?;
            let mode = match mode {
                "any" => UnstableMode::Lowest,
                n => UnstableMode::Circumferential(n.parse().ok()?),
            };
            let eigenvalues = eigenvalues.parse().ok().filter(|n| *n > 0)?;
            Some(Instability { mode, eigenvalues })
        };
        let all: Option<Vec<Instability>> = text.split(' ').map(instability).collect();
        all.map(Self::Unstable).ok_or_else(|| {
            format!("`{text}` is not a list of unstable modes `mode:count`, `none` or `unknown`")
        })
    }
}

impl TryFrom<String> for Stability {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Stability> for String {
    fn from(stability: Stability) -> Self {
        stability.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_read_as_it_is_written() {
        for text in ["none", "unknown", "any:1", "0:1", "1:2 2:1"] {
            let verdict: Stability = text.parse().unwrap();
            assert_eq!(verdict.to_string(), text);
        }
        for text in ["", "1", "1:0", "x:1", "1:2  2:1", "any"] {
            assert!(text.parse::<Stability>().is_err(), "{text}");
        }
    }
}
