//! A stage of a plan: its loads over its time.

use crate::solve::Segment;
use crate::tube::Load;

/// Distance from the end of a step, in steps, up to which a corner of the course lies at that end.
const ROUNDING: f64 = 1e-9;

/// A stage: the way of the load from the end of the stage before to its own end.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// The load at its end. It starts from the end of the previous stage; the first starts from rest or from the start state.
    pub load: Load,
    /// Loads on the way, each with the fraction of the stage at which it holds, rising between 0 and 1. The load is linear
    /// between them; without any it is linear over the whole stage.
    pub course: Vec<(f64, Load)>,
    /// Number of equal steps, at least one; each ends in an accepted state.
    pub steps: usize,
    /// Its duration, in the unit of time of the case; none in a study without times.
    pub duration: Option<f64>,
}

impl Stage {
    /// A stage whose load changes linearly, without duration.
    pub fn new(name: String, load: Load, steps: usize) -> Self {
        Self {
            name,
            load,
            course: vec![],
            steps,
            duration: None,
        }
    }

    /// Returns the load at a fraction of the stage, which begins at the load `begin`.
    pub fn load_at(&self, begin: &Load, fraction: f64) -> Load {
        // The load at which a stage begins may drive the pressure of the lumen, and the stage its volume.
        if fraction == 0.0 {
            return begin.clone();
        }
        let next = self.course.partition_point(|(at, _)| *at < fraction);
        let (to, after) = match self.course.get(next) {
            Some((at, load)) => (*at, load),
            None => (1.0, &self.load),
        };
        let (from, before) = match next.checked_sub(1) {
            Some(last) => (self.course[last].0, &self.course[last].1),
            None => (0.0, begin),
        };
        before.towards(after, (fraction - from) / (to - from))
    }

    /// Returns the loads at the corners of its course, the last one at its end.
    pub fn loads(&self) -> impl Iterator<Item = &Load> {
        let corners = self.course.iter().map(|(_, load)| load);
        corners.chain([&self.load])
    }

    /// Returns the segment in which a step lies, counted from 0, of a stage that begins at the load `begin`.
    ///
    /// Segments end where steps do. A step with a corner of the course inside is a segment of its own, in which the load is
    /// linear.
    pub fn segment(&self, begin: &Load, step: usize) -> Segment<Load> {
        let mut ends = [0, self.steps];
        for (fraction, _) in &self.course {
            let at = fraction * self.steps as f64;
            let nearest = at.round();
            let around = match (at - nearest).abs() < ROUNDING {
                true => [nearest; 2],
                false => [at.floor(), at.ceil()],
            };
            for end in around.map(|end| end as usize) {
                if end <= step {
                    ends[0] = ends[0].max(end);
                } else {
                    ends[1] = ends[1].min(end);
                }
            }
        }
        let range = ends.map(|end| end as f64 / self.steps as f64);
        Segment {
            range,
            loads: range.map(|fraction| self.load_at(begin, fraction)),
        }
    }

    /// Returns how many steps are completed at a fraction of the stage.
    pub fn completed_steps(&self, fraction: f64) -> usize {
        let completed = |n: &usize| *n as f64 / self.steps as f64 <= fraction;
        (1..=self.steps).take_while(completed).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fixture;
    use crate::tube::Symmetry;

    fn load(x: f64) -> Load {
        let mut load = fixture::plan(Symmetry::Axisymmetric).tube.rest();
        load.ends[0].twist = x;
        load
    }

    /// A stage from 0 over 2 at 0.25 and 3 at 0.7 to 1, in 8 steps.
    fn stage() -> Stage {
        Stage {
            course: vec![(0.25, load(2.0)), (0.7, load(3.0))],
            ..Stage::new("s".into(), load(1.0), 8)
        }
    }

    #[test]
    fn the_load_is_linear_between_the_corners() {
        let at = |t| stage().load_at(&load(0.0), t).ends[0].twist;
        for (t, twist) in [(0.0, 0.0), (0.125, 1.0), (0.25, 2.0), (0.475, 2.5)] {
            assert!((at(t) - twist).abs() < 1e-15, "{t}");
        }
        assert_eq!((at(0.7), at(1.0)), (3.0, 1.0));
        let straight = Stage::new("s".into(), load(1.0), 3);
        assert_eq!(straight.load_at(&load(0.0), 1.0), load(1.0));
    }

    #[test]
    fn a_step_with_a_corner_inside_is_its_own_segment() {
        // Corners after step 2, and between steps 5 and 6.
        let expected = [
            [0, 2],
            [0, 2],
            [2, 5],
            [2, 5],
            [2, 5],
            [5, 6],
            [6, 8],
            [6, 8],
        ];
        for (step, ends) in expected.into_iter().enumerate() {
            let segment = stage().segment(&load(0.0), step);
            assert_eq!(segment.range, ends.map(|end| end as f64 / 8.0), "{step}");
            let loads = segment.range.map(|t| stage().load_at(&load(0.0), t));
            assert_eq!(segment.loads, loads);
        }
        let straight = Stage::new("s".into(), load(1.0), 3);
        let segment = straight.segment(&load(0.5), 1);
        assert_eq!(segment, Segment::between(load(0.5), load(1.0)));
    }
}
