//! The longest part of a step along which a curve does not pass through itself.
//!
//! Control points move in straight lines, so at the fraction t of a step a curve lies in the hull of its control points
//! at t. Two curves stay apart from 0 to t if a direction separates their hulls at 0 and at t: the distance along it is
//! concave in t. A curve, or two that share an end, does not meet itself if the differences of its control points lie in
//! an open half-plane at 0 and at t. Where neither holds, curves are halved; where halving cannot help, because they are
//! already small beside their distance, t is reduced (compare additive continuous collision detection, Li et al. 2021).

use super::bezier::{Bezier, Point, dot, length, minus};
use super::boxes::{Box2, BoxTree, Node};

/// Share of their distance that two curves must keep.
const KEPT: f64 = 0.1;

/// Factor by which the step is shortened when curves would meet.
const SHORTENING: f64 = 0.7;

/// Distance of two curves, in sizes of the larger one, from which on halving them cannot help.
const FAR: f64 = 3.0;

/// Shortest part of a step that is tried.
const SHORTEST: f64 = 1e-9;

/// Size, in D, below which curves that meet at the start count as touching.
const SMALLEST: f64 = 1e-12;

/// A curve and its motion along the whole step.
#[derive(Clone, Copy, Debug)]
struct Moving {
    curve: Bezier,
    motion: Bezier,
}

impl Moving {
    fn halves(&self) -> [Self; 2] {
        let (curves, motions) = (self.curve.halves(), self.motion.halves());
        [0, 1].map(|i| Self {
            curve: curves[i],
            motion: motions[i],
        })
    }

    /// Returns the control points at the fraction t.
    fn at(&self, t: f64) -> Bezier {
        let pairs = self.curve.points().iter().zip(self.motion.points());
        Bezier::new(pairs.map(|(p, v)| [p[0] + t * v[0], p[1] + t * v[1]]))
    }

    fn size(&self) -> f64 {
        let points = self.curve.points();
        let from_first = points.iter().map(|p| length(minus(*p, points[0])));
        from_first.fold(0.0, f64::max)
    }
}

/// The walk over pairs of curves, with the longest step so far.
struct Walk<'a> {
    curves: &'a [Moving],
    tree: BoxTree,
    /// Derivatives at the start, and at the end of the whole step.
    slopes: [BoxTree; 2],
    step: f64,
}

/// Returns the longest fraction of a step, at most 1, along which neighbouring curves of a chain meet nowhere but at
/// their common ends; 0 if they meet at the start.
pub fn longest_step(curves: &[Bezier], motions: &[Bezier]) -> f64 {
    let moving: Vec<Moving> = curves
        .iter()
        .zip(motions)
        .map(|(curve, motion)| Moving {
            curve: *curve,
            motion: *motion,
        })
        .collect();
    let at_end: Vec<Bezier> = moving.iter().map(|curve| curve.at(1.0)).collect();
    let tree = BoxTree::new(moving.len(), |e| {
        let ends = [moving[e].curve, at_end[e]];
        Box2::around(ends.iter().flat_map(|curve| curve.points().to_vec()))
    });
    let mut walk = Walk {
        step: 1.0,
        curves: &moving,
        tree,
        slopes: [BoxTree::of_slopes(curves), BoxTree::of_slopes(&at_end)],
    };
    if !moving.is_empty() {
        walk.within(walk.tree.root());
    }
    walk.step
}

/// Returns whether a chain of curves meets itself other than at common ends.
pub fn crosses_itself(curves: &[Bezier]) -> bool {
    let at_rest: Vec<Bezier> = curves
        .iter()
        .map(|curve| Bezier::new(curve.points().iter().map(|_| [0.0; 2])))
        .collect();
    longest_step(curves, &at_rest) < 1.0
}

impl Walk<'_> {
    /// Returns whether a direction exists along which all curves of a run of neighbours run forward at the start and at the end
    /// of the whole step, so that they do so in between.
    fn runs_forward(&self, nodes: &[Node]) -> bool {
        let [start, end] = [0, 1].map(|i| {
            let boxes = nodes.iter().map(|node| *self.slopes[i].around(*node));
            boxes.fold(Box2::around([]), Box2::and)
        });
        start.run_forward(&end)
    }

    fn within(&mut self, node: Node) {
        if self.runs_forward(&[node]) {
            return;
        }
        if node.is_element() {
            let curves = self.curves;
            self.alone(&curves[node.first]);
        } else {
            let [left, right] = node.halves();
            self.within(left);
            self.within(right);
            self.between(left, right);
        }
    }

    fn between(&mut self, a: Node, b: Node) {
        if !self.tree.around(a).is_within(0.0, self.tree.around(b))
            || (a.end == b.first && self.runs_forward(&[a, b]))
        {
            return;
        }
        if a.is_element() && b.is_element() {
            let curves = self.curves;
            self.pair(&curves[a.first], &curves[b.first], a.end == b.first);
        } else if b.is_element() || (!a.is_element() && a.end - a.first >= b.end - b.first) {
            for half in a.halves() {
                self.between(half, b);
            }
        } else {
            for half in b.halves() {
                self.between(a, half);
            }
        }
    }

    /// Shortens the step until a curve does not meet itself.
    fn alone(&mut self, curve: &Moving) {
        loop {
            if self.step == 0.0 || stays_monotone(&[curve], self.step) {
                return;
            }
            if !self.must_shorten(&[curve], curve.size()) {
                break;
            }
        }
        let [left, right] = curve.halves();
        self.alone(&left);
        self.alone(&right);
        self.pair(&left, &right, true);
    }

    /// Shortens the step until two curves do not meet, other than at the end of the first and start of the second if
    /// they share it.
    fn pair(&mut self, a: &Moving, b: &Moving, share_end: bool) {
        let [size_a, size_b] = [a.size(), b.size()];
        loop {
            if self.step == 0.0 {
                return;
            }
            if share_end {
                if stays_monotone(&[a, b], self.step) {
                    return;
                }
                if !self.must_shorten(&[a, b], size_a.max(size_b)) {
                    break;
                }
            } else {
                let distance = separation(a, b, self.step);
                if distance.stays {
                    return;
                }
                if distance.at_start > FAR * size_a.max(size_b) {
                    self.shorten();
                } else if size_a.max(size_b) < SMALLEST {
                    self.step = 0.0;
                } else {
                    break;
                }
            }
        }
        if size_a >= size_b {
            let [left, right] = a.halves();
            self.pair(&left, b, false);
            self.pair(&right, b, share_end);
        } else {
            let [left, right] = b.halves();
            self.pair(a, &left, share_end);
            self.pair(a, &right, false);
        }
    }

    /// Shortens the step, and returns true, if curves that are not monotone along the whole step would not become so by
    /// halving: they are nearly straight at the start, or as small as can be.
    fn must_shorten(&mut self, curves: &[&Moving], size: f64) -> bool {
        if size < SMALLEST {
            self.step = 0.0;
            return true;
        }
        let straight = is_nearly_straight(curves);
        if straight {
            self.shorten();
        }
        straight
    }

    fn shorten(&mut self) {
        self.step *= SHORTENING;
        if self.step < SHORTEST {
            self.step = 0.0;
        }
    }
}

/// Returns whether a direction exists along which all curves run forward at the start and at t, so that they run forward
/// in between.
fn stays_monotone(curves: &[&Moving], t: f64) -> bool {
    let ends: Vec<Point> = curves
        .iter()
        .flat_map(|curve| [curve.curve, curve.at(t)])
        .flat_map(|curve| curve.differences().collect::<Vec<_>>())
        .collect();
    let mean = sum_of_directions(&ends);
    ends.iter().all(|d| dot(*d, mean) > 0.0)
}

/// Cosine of the largest angle, 11°, by which the directions of a nearly straight curve differ from their mean.
const STRAIGHT: f64 = 0.98;

/// Returns whether the directions of curves at the start hardly differ.
fn is_nearly_straight(curves: &[&Moving]) -> bool {
    let directions: Vec<Point> = curves
        .iter()
        .flat_map(|curve| curve.curve.differences().collect::<Vec<_>>())
        .collect();
    let mean = sum_of_directions(&directions);
    let limit = STRAIGHT * length(mean);
    directions
        .iter()
        .all(|d| dot(*d, mean) > limit * length(*d))
}

fn sum_of_directions(directions: &[Point]) -> Point {
    directions.iter().fold([0.0; 2], |sum, d| {
        let size = length(*d).max(f64::MIN_POSITIVE);
        [sum[0] + d[0] / size, sum[1] + d[1] / size]
    })
}

/// Distance of two curves along the best of some directions.
struct Separation {
    /// Largest distance at the start; not positive if no direction separates the hulls.
    at_start: f64,
    /// True if a direction separates them at the start and, with a part of that distance, at t.
    stays: bool,
}

fn separation(a: &Moving, b: &Moving, t: f64) -> Separation {
    let (a_end, b_end) = (a.at(t), b.at(t));
    let ends = |curve: &Bezier| {
        let points = curve.points();
        (points[0], points[points.len() - 1])
    };
    let middle = |curve: &Bezier| {
        let (first, last) = ends(curve);
        [0, 1].map(|i| f64::midpoint(first[i], last[i]))
    };
    let across = |curve: &Bezier| {
        let (first, last) = ends(curve);
        let chord = minus(last, first);
        [-chord[1], chord[0]]
    };
    let towards = minus(middle(&b.curve), middle(&a.curve));
    let directions = [
        towards,
        across(&a.curve),
        across(&b.curve),
        across(&a_end),
        [1.0, 0.0],
        [0.0, 1.0],
    ];
    let mut best = Separation {
        at_start: f64::NEG_INFINITY,
        stays: false,
    };
    for direction in directions {
        let size = length(direction);
        if size == 0.0 {
            continue;
        }
        let sign = if dot(direction, towards) < 0.0 {
            -1.0
        } else {
            1.0
        };
        let unit = direction.map(|d| sign * d / size);
        let at_start = distance_along(unit, &a.curve, &b.curve);
        best.at_start = best.at_start.max(at_start);
        best.stays |= at_start > 0.0 && distance_along(unit, &a_end, &b_end) >= KEPT * at_start;
    }
    best
}

/// Returns by how much b lies ahead of a along a direction.
fn distance_along(direction: Point, a: &Bezier, b: &Bezier) -> f64 {
    let along = |curve: &Bezier| {
        let places = curve.points().iter().map(move |p| dot(*p, direction));
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    };
    along(b).0 - along(a).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Basis;

    /// Returns the curves of a cubic spline with these control points.
    fn chain(points: &[Point]) -> Vec<Bezier> {
        let elements = points.len() - 3;
        let breakpoints: Vec<f64> = (0..=elements).map(|e| e as f64).collect();
        let basis = Basis::open(3, &breakpoints);
        let curve = |e: usize| {
            let factors = basis.bezier_points(e);
            Bezier::new(factors.iter().map(|factors| {
                let terms = factors.iter().zip(&points[e..]);
                terms.fold([0.0; 2], |sum, (f, p)| {
                    [sum[0] + f * p[0], sum[1] + f * p[1]]
                })
            }))
        };
        (0..elements).map(curve).collect()
    }

    /// Returns control points of a hairpin: two flanks of length 1 at a distance `gap`.
    fn hairpin(gap: f64) -> Vec<Point> {
        let flank = (0..20).map(|i| f64::from(i) / 20.0);
        let upper = flank.clone().map(|x| [x, 0.0]);
        let lower = flank.rev().map(|x| [x, -gap]);
        upper
            .chain([[1.0 + gap, -0.5 * gap]])
            .chain(lower)
            .collect()
    }

    #[test]
    fn a_straight_curve_may_move_as_far_as_it_likes() {
        let line: Vec<Point> = (0..30).map(|i| [f64::from(i), 0.5]).collect();
        let motion: Vec<Point> = (0..30)
            .map(|i| [100.0 - 0.5 * f64::from(i), -7.0])
            .collect();
        assert_eq!(longest_step(&chain(&line), &chain(&motion)), 1.0);
        assert!(!crosses_itself(&chain(&line)));
    }

    #[test]
    fn flanks_keep_a_tenth_of_their_distance() {
        for gap in [0.1, 1e-2, 1e-4] {
            let points = hairpin(gap);
            assert!(!crosses_itself(&chain(&points)));
            // The lower flank rises by twice the gap.
            let motion: Vec<Point> = points
                .iter()
                .map(|p| [0.0, if p[1] < -0.9 * gap { 2.0 * gap } else { 0.0 }])
                .collect();
            let step = longest_step(&chain(&points), &chain(&motion));
            assert!((0.2..=0.45).contains(&step), "{gap}: {step}");
        }
    }

    #[test]
    fn flanks_that_slide_or_move_together_are_not_stopped() {
        let points = hairpin(0.05);
        let slide: Vec<Point> = points.iter().map(|p| [0.6 * p[1], 0.0]).collect();
        assert_eq!(longest_step(&chain(&points), &chain(&slide)), 1.0);
        let together: Vec<Point> = points.iter().map(|p| [0.1 * p[1], 5.0 + p[0]]).collect();
        assert_eq!(longest_step(&chain(&points), &chain(&together)), 1.0);
    }

    #[test]
    fn crossings_of_any_size_are_seen() {
        for size in [1.0, 1e-3, 1e-6] {
            let turn = [
                [0.0, 0.0],
                [2.0, 2.0],
                [2.0, 0.0],
                [0.0, 2.0],
                [-1.0, 3.0],
                [-2.0, 4.0],
            ];
            let wall: Vec<Point> = turn.iter().map(|p| p.map(|x| size * x)).collect();
            assert!(crosses_itself(&chain(&wall)), "{size}");
        }
    }

    #[test]
    fn no_state_along_the_longest_step_crosses_itself() {
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut stopped = 0;
        for _ in 0..100 {
            let points: Vec<Point> = (0..14)
                .map(|i| [0.3 * f64::from(i) + 0.2 * random(), random()])
                .collect();
            let motion: Vec<Point> = (0..14).map(|_| [3.0 * random(), 3.0 * random()]).collect();
            let (start, moved) = (chain(&points), chain(&motion));
            if crosses_itself(&start) {
                continue;
            }
            let step = longest_step(&start, &moved);
            stopped += usize::from(step < 1.0);
            for part in 1..=20 {
                let t = step * f64::from(part) / 20.0;
                let at: Vec<Bezier> = start
                    .iter()
                    .zip(&moved)
                    .map(|(curve, motion)| {
                        Moving {
                            curve: *curve,
                            motion: *motion,
                        }
                        .at(t)
                    })
                    .collect();
                assert!(!polygon_crosses(&at), "{step} {t}");
            }
        }
        assert!(stopped > 30, "{stopped}");
    }

    /// Returns whether the polygon through 20 points of every curve crosses itself.
    fn polygon_crosses(curves: &[Bezier]) -> bool {
        let points: Vec<Point> = curves
            .iter()
            .flat_map(|curve| (0..20).map(|i| curve.at(f64::from(i) / 20.0).position))
            .collect();
        let turn = |a: Point, b: Point, c: Point| {
            let (u, v) = (minus(b, a), minus(c, a));
            u[0] * v[1] - u[1] * v[0]
        };
        let crosses = |i: usize, j: usize| {
            let [a, b, c, d] = [points[i], points[i + 1], points[j], points[j + 1]];
            turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
        };
        (0..points.len() - 1).any(|i| (i + 2..points.len() - 1).any(|j| crosses(i, j)))
    }
}
