//! Special points of branches.

use crate::saved_state::SavedState;
use crate::solve::arc::NormalForm;

/// A special point of a branch.
#[derive(Clone, Debug)]
pub struct SpecialPoint {
    /// Its label, such as `LP1` or `BP0-1`.
    pub label: String,
    /// Its kind.
    pub kind: PointKind,
    /// The number of the branch on which it was found.
    pub branch: usize,
    /// Arc length on that branch.
    pub s: f64,
    /// The parameter.
    pub parameter: f64,
    /// Values of the parameter at two points of the branch that bracket it.
    pub bracket: [f64; 2],
    /// Numbers of negative eigenvalues of the modes before and behind it.
    pub negative: [Vec<usize>; 2],
    /// Its state.
    pub state: SavedState,
    /// The critical mode of a fold or a branch point: the circumferential mode, and the amplitudes (z, r, θ) of the control
    /// points, the largest of which is one.
    pub mode: Option<(usize, Vec<f64>)>,
}

/// The kind of a special point.
#[derive(Clone, Debug, PartialEq)]
pub enum PointKind {
    /// The parameter has an extreme value; with d²λ/dε² along the mode, if it is known.
    Fold(Option<f64>),
    /// Axisymmetric branches cross; with the force on the mode and the gap between the branches
    /// ([`crate::solve::arc::BranchPoint::gap`]), if they were computed.
    BranchPoint(Option<(NormalForm, f64)>),
    /// Stability to a circumferential mode from 1 on changes; with the rate of its eigenvalue in the parameter.
    Mode(usize, f64),
    /// The wall begins to touch itself, or ceases to.
    Contact(bool),
    /// The energy has a minimum (true) or a maximum.
    Energy(bool),
    /// A column of the history takes a value.
    Column(String, f64),
    /// Several events that could not be separated.
    Unresolved,
}

impl PointKind {
    /// Returns the beginning of the label of such a point.
    pub fn prefix(&self) -> String {
        match self {
            Self::Fold(_) => "LP".into(),
            Self::BranchPoint(_) => "BP0-".into(),
            Self::Mode(mode, _) => format!("BP{mode}-"),
            _ => "EV".into(),
        }
    }
}

impl SpecialPoint {
    /// Describes the point, for example `minimum of the energy`.
    pub fn describe(&self) -> String {
        let [before, behind] = self.negative.each_ref();
        let count = |all: &[usize], mode: usize| all.get(mode).copied().unwrap_or(0);
        let verb = |mode: usize| match count(behind, mode) > count(before, mode) {
            true => "loses",
            false => "regains",
        };
        match &self.kind {
            PointKind::Fold(None) => "fold".into(),
            PointKind::Fold(Some(curvature)) if *curvature < 0.0 => {
                "fold, maximum of the parameter".into()
            }
            PointKind::Fold(_) => "fold, minimum of the parameter".into(),
            PointKind::BranchPoint(None) => "branch point of mode 0".into(),
            PointKind::BranchPoint(Some((form, _))) => {
                match (form.is_pitchfork(), form.is_supercritical()) {
                    (true, true) => "supercritical pitchfork of mode 0".into(),
                    (true, false) => "subcritical pitchfork of mode 0".into(),
                    (false, _) => "transcritical branch point of mode 0".into(),
                }
            }
            PointKind::Mode(mode, _) => format!("{} stability to mode {mode}", verb(*mode)),
            PointKind::Contact(true) => "the wall begins to touch itself".into(),
            PointKind::Contact(false) => "the wall ceases to touch itself".into(),
            PointKind::Energy(true) => "minimum of the energy".into(),
            PointKind::Energy(false) => "maximum of the energy".into(),
            PointKind::Column(name, value) => format!("{name} = {value}"),
            PointKind::Unresolved => {
                "several events at once, or one that could not be located".into()
            }
        }
    }
}
