//! Location of special points between two points of a branch.

use super::detect::{Change, above};
use super::follow::Follow;
use super::sample::Sample;
use super::special::PointKind;
use crate::assembly::Inverted;
use crate::equilibrium::TubeProblem;
use crate::monitor::Monitor;
use crate::solve::arc::{ArcFailure, BranchPoint, Curve, LoadFamily, Point, Reduced};

/// Largest length of a bracket that is left, as a fraction of the range of the parameter.
const WIDTH: f64 = 1e-7;
/// The same of a change without a function that has a zero there.
const OF_JUMP: f64 = 1e-5;

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
        let width = (to - from).abs()
            * match change {
                Change::Contact => OF_JUMP,
                _ => WIDTH,
            };
        let value = |sample: &Sample| self.value(curve, change, [a, b], sample);
        let ends = [value(a)?, value(b)?];
        let points = [&a.point, &b.point];
        let found = curve.locate::<Failed>(
            points,
            ends,
            width,
            |point| value(&self.sample(point.clone())),
            monitor,
        )?;
        let [low, high] = found;
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
                let lost = b.state.negative[*mode] > a.state.negative[*mode];
                let rise = if lost {
                    ends[0] - ends[1]
                } else {
                    ends[1] - ends[0]
                };
                let rate = rise / (b.point.parameter - a.point.parameter);
                located.kind = PointKind::Mode(*mode, rate);
            }
            Change::Contact => located.kind = PointKind::Contact(b.touches),
            Change::Energy => located.kind = PointKind::Energy(ends[0] < 0.0),
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
        at: &Sample,
    ) -> Result<f64, Failed> {
        Ok(match change {
            Change::Fold => at.point.tangent.1,
            Change::Mode(mode) => {
                let [before, behind] = [a, b].map(|sample| sample.state.negative[*mode]);
                let count = at.state.negative.get(*mode).copied();
                let is_behind = count.is_some_and(|count| {
                    if behind > before {
                        count > before
                    } else {
                        count <= behind
                    }
                });
                let size = match mode {
                    0 => curve.critical(&at.point, None)?.value.abs(),
                    mode => self.lowest_of(*mode, before.min(behind), at),
                };
                if is_behind { size } else { -size }
            }
            Change::Contact if at.touches == b.touches => 1.0,
            Change::Contact => -1.0,
            Change::Energy => self.slope_of_energy(at),
            Change::Column(name, value) => above(at, name, *value),
        })
    }

    /// Returns the size of the eigenvalue of a mode, counted from 0; 1 if it is not found.
    fn lowest_of(&self, mode: usize, index: usize, at: &Sample) -> f64 {
        let load = self.load(at.point.parameter);
        let pairs = self.harmonics.lowest(mode, &load, &at.point.u, index + 1);
        let pair = pairs.ok().and_then(|mut pairs| pairs.pop());
        pair.map_or(1.0, |pair| pair.value.abs())
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
        located.kind = PointKind::BranchPoint(point.as_ref().map(|point| point.form));
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
