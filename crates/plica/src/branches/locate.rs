//! Location of special points between two points of a branch.

use super::detect::{Change, above};
use super::follow::Follow;
use super::sample::{BranchState, Sample};
use super::special::PointKind;
use crate::assembly::Inverted;
use crate::equilibrium::TubeProblem;
use crate::monitor::Monitor;
use crate::solve::arc::{Accuracy, ArcFailure, BranchPoint, Curve, LoadFamily, Point, Reduced};

/// Accuracy of events that are located by their function alone; the length is a fraction of the range of the parameter.
const EVENT: Accuracy = Accuracy {
    width: 1e-8,
    zero: 1e-9,
};
/// The same of a number that jumps.
const JUMP: Accuracy = Accuracy {
    width: 1e-5,
    zero: 0.0,
};
/// The same of folds and branch points, which Newton's method for the special point computes from there. On a branch that
/// another one crosses, points next to the crossing are known badly.
const SPECIAL: Accuracy = Accuracy {
    width: 1e-4,
    zero: 1e-2,
};

/// The curve of a tube.
pub(super) type TubeCurve<'f> = Curve<'f, LoadFamily<TubeProblem>>;
pub(super) type Failed = ArcFailure<Inverted>;

/// A located point.
pub(super) struct Located {
    pub kind: PointKind,
    pub sample: Sample,
    pub bracket: [f64; 2],
    pub negative: [Vec<usize>; 2],
    pub mode: Option<(usize, Vec<f64>)>,
    /// The branch point itself, for switching, with the point near it.
    pub branch_point: Option<BranchPoint>,
}

impl Follow {
    /// Locates a change between two points.
    pub(super) fn locate(
        &self,
        curve: &TubeCurve<'_>,
        change: &Change,
        [a, b]: [&Sample; 2],
        monitor: &mut dyn Monitor,
    ) -> Result<Located, Failed> {
        let [from, to] = self.following.range;
        let accuracy = match change {
            Change::Contact => JUMP,
            Change::Fold | Change::Mode(0) => SPECIAL,
            _ => EVENT,
        };
        let accuracy = Accuracy {
            width: accuracy.width * (to - from).abs(),
            ..accuracy
        };
        let value = |point: &Point| self.value(curve, change, [a, b], point);
        let points = [&a.point, &b.point];
        let ends = [value(points[0])?, value(points[1])?];
        let [low, high] = curve.locate::<Failed>(points, ends, accuracy, value, monitor)?;
        let bracket = [low.0.parameter, high.0.parameter];
        let near = if low.1.abs() <= high.1.abs() {
            low.0
        } else {
            high.0
        };
        let mut located = Located {
            kind: PointKind::Unresolved,
            sample: self.sample(near.clone()),
            bracket,
            negative: [a, b].map(|sample| sample.state.negative.clone()),
            mode: None,
            branch_point: None,
        };
        match change {
            Change::Fold => self.refine_fold(curve, near, &mut located, monitor)?,
            Change::Mode(0) => self.refine_branch_point(curve, near, &mut located, monitor)?,
            Change::Mode(mode) => {
                let index = a.state.negative[*mode].min(b.state.negative[*mode]);
                let load = self.load(near.parameter);
                let pairs = self.harmonics.lowest(*mode, &load, &near.u, index + 1);
                let pair = pairs.ok().and_then(|mut pairs| pairs.pop());
                located.mode = pair.map(|pair| (*mode, normalised(pair.vector)));
                let rate = (ends[1] - ends[0]) / (b.point.parameter - a.point.parameter);
                located.kind = PointKind::Mode(*mode, rate);
            }
            Change::Contact => located.kind = PointKind::Contact(b.touches),
            Change::Energy => {
                let rises = b.point.parameter > a.point.parameter;
                located.kind = PointKind::Energy((ends[0] < 0.0) == rises);
            }
            Change::Column(name, value) => {
                located.kind = PointKind::Column(name.clone(), *value);
            }
        }
        Ok(located)
    }

    /// Returns the value of the function of a change at a point. It has different signs at the ends `a` and `b`.
    fn value(
        &self,
        curve: &TubeCurve<'_>,
        change: &Change,
        [a, b]: [&Sample; 2],
        at: &Point,
    ) -> Result<f64, Failed> {
        let counts = |mode: usize| [a, b].map(|sample| sample.state.negative[mode]);
        Ok(match change {
            Change::Fold => at.tangent.1,
            // The eigenvalue nearest to zero is the one that passes it, next to that point.
            Change::Mode(0) => {
                let size = curve.critical(at, None)?.value.abs();
                let [before, behind] = counts(0);
                if at.negative > before.min(behind) {
                    -size
                } else {
                    size
                }
            }
            Change::Mode(mode) => {
                let [before, behind] = counts(*mode);
                let index = before.min(behind);
                let load = self.load(at.parameter);
                let pairs = self.harmonics.lowest(*mode, &load, &at.u, index + 1);
                let pair = pairs.ok().and_then(|mut pairs| pairs.pop());
                pair.ok_or(ArcFailure::NoPoint)?.value
            }
            Change::Contact if self.touches(at) => 1.0,
            Change::Contact => -1.0,
            Change::Energy => self.slope_of_energy(at),
            Change::Column(name, value) => {
                let load = self.load(at.parameter);
                let negative = vec![at.negative];
                let state = BranchState {
                    s: at.s,
                    parameter: at.parameter,
                    label: None,
                    row: self.row(&load, at, &negative),
                    negative,
                };
                above(&state, name, *value)
            }
        })
    }

    fn refine_fold(
        &self,
        curve: &TubeCurve<'_>,
        near: Point,
        located: &mut Located,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failed> {
        let critical = curve.critical(&near, Some(&near.tangent.0))?;
        let reduced = Reduced::new(curve, &near, &critical.vector);
        let fold = match reduced.fold(&near, monitor) {
            Err(ArcFailure::Cancelled) => return Err(ArcFailure::Cancelled),
            fold => fold.ok(),
        };
        located.kind = PointKind::Fold(fold.as_ref().map(|fold| fold.curvature));
        let mode = fold
            .as_ref()
            .map_or(critical.vector, |fold| fold.mode.clone());
        located.mode = Some((0, normalised(mode)));
        if let Some(fold) = fold {
            self.move_to(located, fold.parameter, fold.u);
        }
        Ok(())
    }

    fn refine_branch_point(
        &self,
        curve: &TubeCurve<'_>,
        near: Point,
        located: &mut Located,
        monitor: &mut dyn Monitor,
    ) -> Result<(), Failed> {
        let critical = curve.critical(&near, None)?;
        let reduced = Reduced::new(curve, &near, &critical.vector);
        let point = match reduced.branch_point(&near, monitor) {
            Err(ArcFailure::Cancelled) => return Err(ArcFailure::Cancelled),
            point => point.ok(),
        };
        let form = point.as_ref().map(|point| (point.form, point.gap()));
        located.kind = PointKind::BranchPoint(form);
        let mode = point
            .as_ref()
            .map_or(critical.vector, |point| point.mode.clone());
        located.mode = Some((0, normalised(mode)));
        if let Some(point) = &point {
            self.move_to(located, point.parameter, point.u.clone());
        }
        located.branch_point = point;
        Ok(())
    }

    /// Measures a located point again at the state that was computed for it.
    fn move_to(&self, located: &mut Located, parameter: f64, u: Vec<f64>) {
        let negative = located.sample.state.negative.clone();
        let mut point = located.sample.point.clone();
        (point.parameter, point.u) = (parameter, u);
        located.sample = self.sample(point);
        // At the point itself the count is one of rounding errors.
        located.sample.state.negative = negative;
    }
}

/// Returns a vector whose largest entry is one.
fn normalised(mut vector: Vec<f64>) -> Vec<f64> {
    let largest = vector
        .iter()
        .copied()
        .max_by(|x, y| x.abs().total_cmp(&y.abs()));
    let largest = largest.filter(|x| *x != 0.0).unwrap_or(1.0);
    vector.iter_mut().for_each(|x| *x /= largest);
    vector
}
