//! Targets of a stage over its time: numbers, and vectors of them.

use super::key::{Key, Kind};
use super::problem::Problems;
use super::read::{Read, Value, in_range, wrong_type};

/// A target of a stage as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Course {
    /// The value at the end of the stage.
    Value(f64),
    /// Points (time, value), with times from the start of the stage.
    Points(Vec<[f64; 2]>),
}

impl Course {
    /// Returns its values, the one at the end last.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        let (value, points) = match self {
            Self::Value(value) => (Some(*value), &[][..]),
            Self::Points(points) => (None, &points[..]),
        };
        value.into_iter().chain(points.iter().map(|point| point[1]))
    }

    /// Returns the same with another function of the values.
    pub fn map(&self, of: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Value(value) => Self::Value(of(*value)),
            Self::Points(points) => Self::Points(points.iter().map(|&[t, x]| [t, of(x)]).collect()),
        }
    }

    /// Returns the rule that its times break in a stage of a duration, with the help.
    pub fn broken_by(&self, duration: f64) -> Option<(String, String)> {
        let Self::Points(points) = self else {
            return None;
        };
        let times = || points.iter().map(|point| point[0]);
        if points.is_empty() {
            Some(("must have at least one point".into(), String::new()))
        } else if points.len() > LARGEST_COUNT {
            let rule = format!("must have at most {LARGEST_COUNT} points");
            Some((rule, String::new()))
        } else if let Some(at) = (1..points.len()).find(|&i| points[i][0] <= points[i - 1][0]) {
            let rule = format!(
                "its times must rise, and {} follows {}",
                points[at][0],
                points[at - 1][0]
            );
            Some((rule, "sort the points by time".into()))
        } else if times().any(|t| !(0.0..=duration).contains(&t)) {
            let rule = format!("its times must lie in the stage, from 0 to {duration}");
            Some((
                rule,
                "times are counted from the start of the stage; see `duration`".into(),
            ))
        } else {
            None
        }
    }

    /// Returns the points (fraction of the stage, value) from its start to its end, in a stage of a duration that begins at
    /// a value.
    pub fn fractions(&self, begin: f64, duration: f64) -> Vec<[f64; 2]> {
        let mut all = vec![[0.0, begin]];
        match self {
            Self::Value(value) => all.push([1.0, *value]),
            Self::Points(points) => {
                let later = points.iter().filter(|point| point[0] > 0.0);
                all.extend(later.map(|[t, x]| [t / duration, *x]));
                if let Some(&[last, value]) = all.last()
                    && last < 1.0
                {
                    all.push([1.0, value]);
                }
            }
        }
        all
    }
}

/// A target of a stage with N components, as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum VectorCourse<const N: usize> {
    /// The value at the end of the stage.
    Value([f64; N]),
    /// Points (time, value), with times from the start of the stage.
    Points(Vec<(f64, [f64; N])>),
}

impl<const N: usize> VectorCourse<N> {
    /// Returns its values, the one at the end last.
    pub fn values(&self) -> Vec<[f64; N]> {
        match self {
            Self::Value(value) => vec![*value],
            Self::Points(points) => points.iter().map(|point| point.1).collect(),
        }
    }

    /// Returns the same with another function of the values.
    pub fn map(&self, of: impl Fn([f64; N]) -> [f64; N]) -> Self {
        match self {
            Self::Value(value) => Self::Value(of(*value)),
            Self::Points(points) => Self::Points(points.iter().map(|&(t, x)| (t, of(x))).collect()),
        }
    }

    /// Returns component i.
    pub fn component(&self, i: usize) -> Course {
        match self {
            Self::Value(value) => Course::Value(value[i]),
            Self::Points(points) => {
                Course::Points(points.iter().map(|(t, x)| [*t, x[i]]).collect())
            }
        }
    }
}

/// Largest number of points.
const LARGEST_COUNT: usize = 100_000;

/// Returns the value at a fraction of a stage, linear between the points (fraction, value).
pub(super) fn value_at(points: &[[f64; 2]], fraction: f64) -> f64 {
    let next = points.partition_point(|point| point[0] < fraction);
    match (next.checked_sub(1), points.get(next)) {
        (Some(before), Some(&[to, b])) => {
            let [from, a] = points[before];
            if fraction == to {
                b
            } else {
                a + (b - a) * ((fraction - from) / (to - from))
            }
        }
        (None, Some(point)) => point[1],
        (_, None) => points.last().map_or(0.0, |point| point[1]),
    }
}

impl Read for Course {
    const KIND: Kind = Kind::Course;

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        if value.get_ref().as_array().is_none() {
            let number = Key {
                kind: Kind::Number,
                ..*key
            };
            return match super::read::number(value) {
                Some(_) => f64::read(problems, &number, path, value).map(Self::Value),
                None => wrong_type(problems, key, path, value),
            };
        }
        let points = Vec::<[f64; 2]>::read(problems, key, path, value)?;
        for &[_, x] in &points {
            in_range(problems, key, path, x)?;
        }
        Some(Self::Points(points))
    }
}

impl<const N: usize> Read for VectorCourse<N> {
    const KIND: Kind = Kind::VectorCourse(N);

    fn read(problems: &mut Problems, key: &Key, path: &str, value: &Value) -> Option<Self> {
        let vector = |x: &[f64]| std::array::from_fn(|i| x[i]);
        let list = value.get_ref().as_array();
        let points = list.filter(|list| list.iter().all(|point| point.get_ref().is_array()));
        let Some(points) = points else {
            let read = super::read::numbers(problems, key, path, (value, value), N)?;
            return Some(Self::Value(vector(&read)));
        };
        let mut all = vec![];
        for point in points {
            let read = super::read::numbers(problems, key, path, (point, value), N + 1)?;
            all.push((read[0], vector(&read[1..])));
        }
        Some(Self::Points(all))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_has_a_course_of_each_component() {
        let points = VectorCourse::Points(vec![(1.0, [2.0, 3.0]), (2.0, [4.0, 5.0])]);
        let twice = points.map(|x| x.map(|x| 2.0 * x));
        assert_eq!(
            twice.component(1),
            Course::Points(vec![[1.0, 6.0], [2.0, 10.0]])
        );
        assert_eq!(points.values(), [[2.0, 3.0], [4.0, 5.0]]);
        let value = VectorCourse::Value([1.0, 2.0]);
        assert_eq!(value.component(0), Course::Value(1.0));
    }

    #[test]
    fn a_course_begins_where_the_stage_does_and_stays_at_its_last_value() {
        let number = Course::Value(3.0);
        assert_eq!(number.fractions(1.0, 5.0), [[0.0, 1.0], [1.0, 3.0]]);
        let table = Course::Points(vec![[1.0, 3.0], [2.0, 4.0]]);
        let points = table.fractions(1.0, 4.0);
        assert_eq!(points, [[0.0, 1.0], [0.25, 3.0], [0.5, 4.0], [1.0, 4.0]]);
        for (fraction, value) in [(0.0, 1.0), (0.125, 2.0), (0.25, 3.0), (0.9, 4.0)] {
            assert_eq!(value_at(&points, fraction), value);
        }
        let from_start = Course::Points(vec![[0.0, 1.0], [4.0, 2.0]]);
        assert_eq!(from_start.fractions(1.0, 4.0), [[0.0, 1.0], [1.0, 2.0]]);
    }
}
