//! The driver: runs the stages up to the state where the branch begins, follows it, and switches to others.

use super::detect::Change;
use super::locate::{Located, TubeCurve};
use super::sample::Sample;
use super::special::{PointKind, SpecialPoint};
use super::{Branch, BranchEnd, BranchError, BranchState, Branches};
use crate::equilibrium::TubeProblem;
use crate::monitor::{Monitor, Part};
use crate::saved_state::SavedState;
use crate::solve::arc::{self, ArcFailure, ArcSettings, Curve, LoadFamily, Point, Reduced};
use crate::stability::Harmonics;
use crate::study::{Following, Plan, Scale, Stage, Study, Switch};
use crate::tube::Load;
use std::collections::{BTreeMap, VecDeque};

/// Largest number of branches.
const BRANCHES: usize = 12;
/// Largest number of halvings that separate events.
const HALVINGS: usize = 14;
/// Distance of two branch points that count as the same, as a fraction of the range of the parameter, and in D.
const SAME: [f64; 2] = [1e-5, 1e-4];

/// Follows the branches of a plan.
pub struct Follow {
    pub(super) plan: Plan,
    pub(super) following: Following,
    pub(super) problem: TubeProblem,
    pub(super) family: LoadFamily<TubeProblem>,
    pub(super) harmonics: Harmonics,
    pub(super) scale: Scale,
}

/// Progress of the following, for a sink.
pub enum Progress<'a> {
    /// A branch begins.
    Begin(&'a Branch),
    /// A state was found.
    State(&'a BranchState),
    /// A special point was located.
    Point(&'a SpecialPoint),
    /// A branch ends.
    End(&'a Branch),
}

/// A sink of progress.
pub type Sink<'a> = dyn FnMut(Progress<'_>) + 'a;

/// A branch that is still to be followed.
struct Start {
    point: Point,
    from: Option<String>,
}

/// The results so far, while branches are followed.
struct Found<'s, 'k> {
    branches: Branches,
    labels: BTreeMap<String, usize>,
    waiting: VecDeque<Start>,
    /// Branch points of mode 0.
    known: Vec<(f64, Vec<f64>)>,
    sink: &'s mut Sink<'k>,
}

impl Follow {
    /// Prepares the branches of a plan.
    ///
    /// # Errors
    /// [`BranchError::NoBranch`] if it has none.
    pub fn new(plan: &Plan) -> Result<Self, BranchError> {
        let following = plan.following.clone().ok_or(BranchError::NoBranch)?;
        let mut plan = plan.clone();
        plan.stages.truncate(following.after + 1);
        // The columns of a row are those of a study that drives the parameter.
        let [_, to] = &following.loads;
        let stages = plan.stages.clone();
        plan.stages.push(Stage::new("branch".into(), to.clone(), 1));
        let problem = plan.problem().without_friction();
        let highest = plan.output.stability_modes;
        let harmonics = Harmonics::new(&problem, highest);
        let family = LoadFamily {
            problem: problem.clone(),
            loads: following.loads.clone(),
            range: following.range,
        };
        debug_assert!(stages.len() + 1 == plan.stages.len());
        Ok(Self {
            scale: Scale::of(plan.units.as_ref()),
            plan,
            following,
            problem,
            family,
            harmonics,
        })
    }

    /// Returns the plan, whose stages are those before the branch and the branch itself.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Follows all branches. A cancellation ends them with what was found.
    ///
    /// # Errors
    /// [`BranchError`] if there is no first state.
    pub fn run(
        &self,
        monitor: &mut dyn Monitor,
        sink: &mut Sink<'_>,
    ) -> Result<Branches, BranchError> {
        let (load, u) = self.first_state(monitor)?;
        let (parameter, _) = self.following.parameter_of(&load);
        let [from, to] = self.following.range;
        let (low, high) = (from.min(to), from.max(to));
        let room = 1e-6 * (high - low);
        if !(low - room..=high + room).contains(&parameter) {
            return Err(BranchError::Outside {
                of: self.following.of.clone(),
                parameter,
                from,
                to,
            });
        }
        let parameter = parameter.clamp(low, high);
        let longest = self.following.longest_step * (high - low);
        let settings = ArcSettings {
            tolerance: self.plan.solver.tolerance,
            longest_step: longest,
            first_step: 0.5 * longest,
            ..ArcSettings::for_range(self.following.range)
        };
        let begun = Curve::begin(&self.family, settings, parameter, u, monitor);
        let (curve, first) = begun.map_err(|failed| match failed {
            ArcFailure::Cancelled => BranchError::Cancelled,
            failed => BranchError::Begin(failed.to_string()),
        })?;
        let mut found = Found {
            branches: Branches {
                parameter: self.following.of.clone(),
                branches: vec![],
                points: vec![],
                cancelled: false,
            },
            labels: BTreeMap::new(),
            waiting: VecDeque::new(),
            known: vec![],
            sink,
        };
        let rising = to > from;
        for upward in [rising, !rising] {
            let at_end = if upward {
                parameter >= high
            } else {
                parameter <= low
            };
            if !at_end {
                let point = if upward {
                    first.clone()
                } else {
                    first.reversed()
                };
                found.waiting.push_back(Start { point, from: None });
            }
        }
        while let Some(start) = found.waiting.pop_front() {
            if found.branches.branches.len() == BRANCHES {
                break;
            }
            self.branch(&curve, start, &mut found, monitor);
            if monitor.is_cancelled() {
                found.branches.cancelled = true;
                break;
            }
        }
        Ok(found.branches)
    }

    /// Runs the stages to the state where the branch begins.
    fn first_state(&self, monitor: &mut dyn Monitor) -> Result<(Load, Vec<f64>), BranchError> {
        let mut plan = self.plan.clone();
        plan.stages.pop();
        let mut study = Study::new(&plan)?;
        let mut last = None;
        while let Some(state) = study.next_state(&mut Part::new(monitor, "stages", 0.0, 0.0)) {
            let state = state?;
            last = Some((state.load.clone(), state.unknowns));
        }
        match last {
            Some(last) if !monitor.is_cancelled() => Ok(last),
            _ => Err(BranchError::Cancelled),
        }
    }

    /// Follows one branch to its end.
    fn branch(
        &self,
        curve: &TubeCurve<'_>,
        start: Start,
        found: &mut Found<'_, '_>,
        monitor: &mut dyn Monitor,
    ) {
        let number = found.branches.branches.len() + 1;
        let mut previous = self.sample(start.point.clone());
        let mut branch = Branch {
            number,
            from: start.from,
            states: vec![previous.state.clone()],
            end: BranchEnd::Range,
        };
        (found.sink)(Progress::Begin(&branch));
        (found.sink)(Progress::State(&previous.state));
        let mut points = arc::Branch::begin(curve, start.point, self.following.range);
        loop {
            if branch.states.len() >= self.following.points {
                branch.end = BranchEnd::Points;
                break;
            }
            let next = {
                let at = format!(
                    "branch {number}, point {}, {} = {:.6}",
                    branch.states.len() + 1,
                    self.following.of,
                    previous.state.parameter
                );
                let monitor = &mut Part::new(monitor, at, 0.0, 0.0);
                points.advance(monitor).cloned()
            };
            let next = match next {
                Ok(next) => self.sample(next),
                Err(arc::BranchEnd::Range) => break,
                Err(arc::BranchEnd::Lost(ArcFailure::Cancelled)) => {
                    branch.end = BranchEnd::Cancelled;
                    break;
                }
                Err(arc::BranchEnd::Lost(failed)) => {
                    branch.end = BranchEnd::Lost(failed.to_string());
                    break;
                }
            };
            let mut located = vec![];
            self.examine(curve, [&previous, &next], 0, &mut located, monitor);
            located.sort_by(|a, b| a.sample.state.s.total_cmp(&b.sample.state.s));
            for located in located {
                self.record(curve, located, &mut branch, found, monitor);
            }
            (found.sink)(Progress::State(&next.state));
            branch.states.push(next.state.clone());
            previous = next;
            if monitor.is_cancelled() {
                branch.end = BranchEnd::Cancelled;
                break;
            }
        }
        (found.sink)(Progress::End(&branch));
        found.branches.branches.push(branch);
    }

    /// Locates all events between two points.
    fn examine(
        &self,
        curve: &TubeCurve<'_>,
        [a, b]: [&Sample; 2],
        halvings: usize,
        located: &mut Vec<Located>,
        monitor: &mut dyn Monitor,
    ) {
        let changes = self.changes(a, b);
        if changes.all.is_empty() || monitor.is_cancelled() {
            return;
        }
        if changes.need_separation && halvings < HALVINGS {
            let middle = curve.between([&a.point, &b.point], 0.5, monitor);
            if let Ok(middle) = middle {
                let middle = self.sample(middle);
                self.examine(curve, [a, &middle], halvings + 1, located, monitor);
                self.examine(curve, [&middle, b], halvings + 1, located, monitor);
                return;
            }
        }
        for change in &changes.all {
            let found = match changes.need_separation && matches!(change, Change::Mode(_)) {
                true => Err(ArcFailure::NoPoint),
                false => self.locate(curve, change, [a, b], monitor),
            };
            match found {
                Ok(found) => located.push(found),
                Err(ArcFailure::Cancelled) => return,
                Err(_) => located.push(Located {
                    kind: PointKind::Unresolved,
                    sample: b.clone(),
                    bracket: [a.point.parameter, b.point.parameter],
                    negative: [a, b].map(|sample| sample.state.negative.clone()),
                    mode: None,
                    branch_point: None,
                }),
            }
        }
    }

    /// Adds a located point to the results, and the branches that leave it to those that wait.
    fn record(
        &self,
        curve: &TubeCurve<'_>,
        located: Located,
        branch: &mut Branch,
        found: &mut Found<'_, '_>,
        monitor: &mut dyn Monitor,
    ) {
        let Located {
            kind,
            mut sample,
            bracket,
            negative,
            mode,
            branch_point,
        } = located;
        let prefix = kind.prefix();
        let count = found.labels.entry(prefix.clone()).or_insert(0);
        *count += 1;
        let label = format!("{prefix}{count}");
        sample.state.label = Some(label.clone());
        let is_branch_point = matches!(kind, PointKind::BranchPoint(_));
        let point = SpecialPoint {
            label: label.clone(),
            kind,
            branch: branch.number,
            s: sample.state.s,
            parameter: sample.state.parameter,
            bracket,
            negative,
            state: self.saved(&sample, branch.states.len()),
            mode,
        };
        (found.sink)(Progress::Point(&point));
        branch.states.push(sample.state.clone());
        found.branches.points.push(point);
        if !is_branch_point {
            return;
        }
        let (parameter, u) = (sample.point.parameter, &sample.point.u);
        let is_known = found
            .known
            .iter()
            .any(|known| self.is_same(known, (parameter, u)));
        found.known.push((parameter, u.clone()));
        let switch = self.switch_to(0);
        let (Some(switch), Some(branch_point), false) = (switch, branch_point, is_known) else {
            return;
        };
        let reduced = Reduced::new(curve, &sample.point, &branch_point.mode);
        match reduced.switch(&branch_point, switch.amplitude, monitor) {
            Ok(starts) => {
                for (point, sign) in starts.into_iter().zip(["+", "-"]) {
                    let from = Some(format!("{label}{sign}"));
                    found.waiting.push_back(Start { point, from });
                }
            }
            Err(ArcFailure::Cancelled) => {}
            Err(failed) => monitor.notice(&format!(
                "warning: no point of the branch that crosses at {label} was found: {failed}"
            )),
        }
    }

    /// Returns the switch to the branches of a mode.
    pub fn switch_to(&self, mode: usize) -> Option<&Switch> {
        let mut switches = self.following.switches.iter();
        switches.find(|switch| switch.mode == mode)
    }

    fn is_same(&self, known: &(f64, Vec<f64>), other: (f64, &[f64])) -> bool {
        let [from, to] = self.following.range;
        let apart = known.1.iter().zip(other.1).map(|(a, b)| (a - b).abs());
        (known.0 - other.0).abs() <= SAME[0] * (to - from).abs()
            && apart.fold(0.0, f64::max) <= SAME[1]
    }

    fn saved(&self, sample: &Sample, number: usize) -> SavedState {
        let tube = &self.plan.tube;
        let muscles = tube.muscles.iter();
        SavedState {
            stage: "branch".into(),
            row: number,
            along: 0.0,
            muscles: muscles.map(|m| (m.name.clone(), m.target())).collect(),
            obstacles: tube.obstacles.iter().map(|o| o.name.clone()).collect(),
            patches: tube.patches.iter().map(|p| p.name.clone()).collect(),
            load: self.load(sample.point.parameter),
            layout: self.plan.layout(),
            u: sample.point.u.clone(),
            arrays: BTreeMap::new(),
        }
    }
}
