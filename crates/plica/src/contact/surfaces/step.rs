//! The longest step along which a surface does not pass through itself.
//!
//! Two parts of the surface that do not touch at rest stay apart if a direction separates their control points at the start and,
//! with a share of that distance, at the end: control points move on straight lines. A part alone, or two parts that touch at
//! rest at an edge or a corner, do not meet elsewhere if the surface runs forward there, in this sense: with a and b the
//! derivatives along and around, and unit vectors e and f at right angles,
//!
//! a · e ≥ A > 0, b · f ≥ B > 0, (|a · f| + |b · e|)/2 ≤ C, A B > C².
//!
//! Then (P q − P p) · (q − p) > 0 for any two places p and q, with P the projection on e and f: one goes from p to q along
//! straight lines in the same quadrant. Both bounds hold in between if they hold at the start and at the end. Where neither test
//! decides, parts are halved, or the step is shortened.

use super::net::FaceNet;
use super::patch::Patch;
use super::tree::{Bounds, Box3, Node, NodeBounds, Tree};
use super::vector::{Vector, cross, dot, length, minus, plus};
use crate::contact::bernstein::MAX_POINTS;
use rayon::prelude::*;

/// Share of their distance that two parts must keep.
const KEPT: f64 = 0.1;

/// Factor by which the step is shortened when parts would meet.
const SHORTENING: f64 = 0.7;

/// Distance of two parts, in sizes of the larger one, from which on halving them cannot help.
const FAR: f64 = 3.0;

/// Shortest part of a step that is tried.
const SHORTEST: f64 = 1e-9;

/// Size, in D, below which parts that meet at the start count as touching.
const SMALLEST: f64 = 1e-9;

/// A part of a patch with its motion along the whole step, and its place.
#[derive(Clone)]
struct Part {
    patch: Patch,
    motion: Patch,
    /// Smallest and largest place along and around, in elements of the whole tube.
    from: [f64; 2],
    to: [f64; 2],
    /// Lengths at rest of its sides.
    sides: [f64; 2],
    bounds: Bounds,
    moves: Bounds,
}

impl Part {
    fn new(
        [patch, motion]: [Patch; 2],
        [from, to]: [[f64; 2]; 2],
        sides: [f64; 2],
        [bounds, moves]: [Bounds; 2],
    ) -> Self {
        Self {
            bounds,
            moves,
            patch,
            motion,
            from,
            to,
            sides,
        }
    }

    fn halves(&self) -> [Self; 2] {
        let size = |i: usize| length(self.bounds.slopes[i].middle()) * self.sides[i];
        let direction = usize::from(size(1) > size(0));
        let (patches, motions) = (self.patch.halves(direction), self.motion.halves(direction));
        let middle = f64::midpoint(self.from[direction], self.to[direction]);
        let mut sides = self.sides;
        sides[direction] *= 0.5;
        [0, 1].map(|i| {
            let mut ends = [self.from, self.to];
            ends[1 - i][direction] = middle;
            let both = [patches[i], motions[i]];
            Self::new(
                both,
                ends,
                sides,
                [0, 1].map(|k| Bounds::of(&both[k], sides)),
            )
        })
    }

    fn size(&self) -> f64 {
        self.bounds.points.size()
    }

    fn moving(&self) -> Moving<'_> {
        Moving {
            bounds: &self.bounds,
            moves: &self.moves,
        }
    }
}

/// The bounds of a part at the start, and of its motion.
#[derive(Clone, Copy)]
struct Moving<'a> {
    bounds: &'a Bounds,
    moves: &'a Bounds,
}

impl Moving<'_> {
    fn slopes(&self, direction: usize, t: f64) -> Box3 {
        self.bounds.slopes[direction].plus(t, &self.moves.slopes[direction])
    }
}

/// The surface along a step, with the longest step so far.
struct Walk<'a> {
    net: &'a FaceNet,
    tree: &'a Tree,
    patches: &'a [Patch],
    motions: &'a [Patch],
    bounds: NodeBounds,
    moves: NodeBounds,
    step: f64,
}

/// Returns the longest fraction of a step, at most 1, along which a face does not pass through itself; 0 if it does so at its
/// start.
pub fn longest_step(net: &FaceNet, tree: &Tree, positions: &[Vector], motions: &[Vector]) -> f64 {
    let (patches, motions) = (net.patches(positions), net.patches(motions));
    let bounds = |patches: &[Patch]| {
        let of = |(i, patch): (usize, &Patch)| Bounds::of(patch, sides(net, i));
        let all: Vec<Bounds> = patches.par_iter().enumerate().map(of).collect();
        tree.bounds(net.around, &all)
    };
    let mut walk = Walk {
        bounds: bounds(&patches),
        moves: bounds(&motions),
        net,
        tree,
        patches: &patches,
        motions: &motions,
        step: 1.0,
    };
    walk.within(tree.root());
    walk.step
}

fn sides(net: &FaceNet, patch: usize) -> [f64; 2] {
    [net.lengths[patch / net.around], net.element_angle()]
}

impl Walk<'_> {
    fn moving(&self, node: Node) -> Moving<'_> {
        Moving {
            bounds: self.bounds.of(node),
            moves: self.moves.of(node),
        }
    }

    fn part(&self, node: Node) -> Part {
        let (row, column) = (node.rows[0], node.columns[0]);
        let index = row * self.net.around + column;
        let from = [row as f64, column as f64];
        let to = from.map(|x| x + 1.0);
        Part::new(
            [self.patches[index], self.motions[index]],
            [from, to],
            sides(self.net, index),
            [*self.bounds.of(node), *self.moves.of(node)],
        )
    }

    fn within(&mut self, node: Node) {
        let moving = self.moving(node);
        if self.step == 0.0 || run_forward(&[moving], self.step) {
            return;
        }
        if node.is_patch() {
            let part = self.part(node);
            self.alone(&part);
            return;
        }
        let [a, b] = self.tree.halves(node);
        self.within(a);
        self.within(b);
        self.between(a, b);
    }

    fn between(&mut self, a: Node, b: Node) {
        let (own, other) = (self.moving(a), self.moving(b));
        let touch = self.touch(
            [a, b].map(|node| [node.rows[0] as f64, node.columns[0] as f64]),
            [a, b].map(|node| [node.rows[1] as f64, node.columns[1] as f64]),
        );
        if self.step == 0.0
            || (!touch && boxes_stay_apart(own, other, self.step))
            || (touch && run_forward(&[own, other], self.step))
        {
            return;
        }
        if a.is_patch() && b.is_patch() {
            let (a, b) = (self.part(a), self.part(b));
            self.pair(&a, &b);
            return;
        }
        let is_larger = own.bounds.points.size() >= other.bounds.points.size();
        let (whole, other) = match b.is_patch() || (!a.is_patch() && is_larger) {
            true => (a, b),
            false => (b, a),
        };
        for half in self.tree.halves(whole) {
            self.between(half, other);
        }
    }

    /// Returns whether two rectangles touch at rest.
    fn touch(&self, from: [[f64; 2]; 2], to: [[f64; 2]; 2]) -> bool {
        let along = from[0][0] <= to[1][0] && from[1][0] <= to[0][0];
        let around = self.net.around as f64;
        let turned = |shift: f64| from[0][1] + shift <= to[1][1] && from[1][1] <= to[0][1] + shift;
        along && [0.0, around, -around].into_iter().any(turned)
    }

    /// Shortens the step until a part does not meet itself.
    fn alone(&mut self, part: &Part) {
        loop {
            if self.step == 0.0 || run_forward(&[part.moving()], self.step) {
                return;
            }
            if !self.must_shorten(&[part]) {
                break;
            }
        }
        let [a, b] = part.halves();
        self.alone(&a);
        self.alone(&b);
        self.pair(&a, &b);
    }

    /// Shortens the step until two parts meet only where they touch at rest.
    fn pair(&mut self, a: &Part, b: &Part) {
        let touch = self.touch([a.from, b.from], [a.to, b.to]);
        let (size_a, size_b) = (a.size(), b.size());
        loop {
            if self.step == 0.0 {
                return;
            }
            if touch {
                if run_forward(&[a.moving(), b.moving()], self.step) {
                    return;
                }
                if !self.must_shorten(&[a, b]) {
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
        let (whole, other) = if size_a >= size_b { (a, b) } else { (b, a) };
        for half in whole.halves() {
            self.pair(&half, other);
        }
    }

    /// Shortens the step, and returns true, if parts that do not run forward along the whole step would not do so halved: they
    /// run forward at the start and are nearly flat, or they are as small as can be.
    fn must_shorten(&mut self, parts: &[&Part]) -> bool {
        if parts.iter().all(|part| part.size() < SMALLEST) {
            self.step = 0.0;
            return true;
        }
        let flat = are_nearly_flat(parts);
        if flat {
            self.shorten();
        }
        flat
    }

    fn shorten(&mut self) {
        self.step *= SHORTENING;
        if self.step < SHORTEST {
            self.step = 0.0;
        }
    }
}

/// Unit vectors along the means of derivatives along and around, at right angles, and the length of each mean.
fn frame(slopes: [Box3; 2]) -> Option<([Vector; 2], [f64; 2])> {
    let means = slopes.map(|of| of.middle());
    let sizes = means.map(length);
    if !(sizes[0] > 0.0 && sizes[1] > 0.0) {
        return None;
    }
    let units = [0, 1].map(|i| means[i].map(|x| x / sizes[i]));
    // The sum and the difference of the units are at right angles; so are these, as near to them as can be.
    let [sum, difference] = [1.0, -1.0].map(|sign| plus(units[0], sign, units[1]));
    let (long, short) = (length(sum), length(difference));
    if !(long > 0.0 && short > 0.0) {
        return None;
    }
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let [sum, difference] =
        [(sum, long), (difference, short)].map(|(v, l)| v.map(|x| half * x / l));
    Some((
        [plus(sum, 1.0, difference), plus(sum, -1.0, difference)],
        sizes,
    ))
}

/// Returns whether parts together run forward at the start and at t.
fn run_forward(parts: &[Moving<'_>], t: f64) -> bool {
    let slopes = |direction: usize, t: f64| {
        let boxes = parts.iter().map(|part| part.slopes(direction, t));
        boxes.fold(Box3::EMPTY, Box3::and)
    };
    let at = |t: f64| [slopes(0, t), slopes(1, t)];
    let ends = [at(0.0), at(t)];
    let both = [0, 1].map(|i| ends[0][i].and(ends[1][i]));
    let Some((units, sizes)) = frame(both) else {
        return false;
    };
    ends.iter().all(|[along, around]| {
        let (a, b) = (
            along.along(units[0]).0 / sizes[0],
            around.along(units[1]).0 / sizes[1],
        );
        let largest = |(low, high): (f64, f64)| low.abs().max(high.abs());
        let c = 0.5
            * (largest(along.along(units[1])) / sizes[0]
                + largest(around.along(units[0])) / sizes[1]);
        a > 0.0 && b > 0.0 && a * b > c * c
    })
}

/// Cosine of the largest angle, 11°, by which derivatives in a nearly flat part differ from their mean.
const FLAT: f64 = 0.98;

/// Returns whether the derivatives of parts at the start hardly differ in direction.
fn are_nearly_flat(parts: &[&Part]) -> bool {
    (0..2).all(|direction| {
        let all = parts
            .iter()
            .flat_map(|part| part.patch.differences(direction));
        let directions: Vec<Vector> = all
            .map(|d| {
                let size = length(d).max(f64::MIN_POSITIVE);
                d.map(|d| d / size)
            })
            .collect();
        let mean = directions
            .iter()
            .fold([0.0; 3], |sum, d| plus(sum, 1.0, *d));
        let limit = FLAT * length(mean);
        directions.iter().all(|d| dot(*d, mean) > limit)
    })
}

/// Returns whether an axis separates two boxes at the start and, with a share of that distance, at t.
fn boxes_stay_apart(a: Moving<'_>, b: Moving<'_>, t: f64) -> bool {
    let [start_a, start_b] = [a.bounds.points, b.bounds.points];
    let end_a = start_a.plus(t, &a.moves.points);
    let end_b = start_b.plus(t, &b.moves.points);
    (0..3).any(|i| {
        let apart = |a: &Box3, b: &Box3| [b.low[i] - a.high[i], a.low[i] - b.high[i]];
        let (start, end) = (apart(&start_a, &start_b), apart(&end_a, &end_b));
        (0..2).any(|side| start[side] > 0.0 && end[side] >= KEPT * start[side])
    })
}

/// Distance of two parts along the best of some directions.
struct Separation {
    /// Largest distance at the start; not positive if no direction separates the control points.
    at_start: f64,
    /// True if a direction separates them at the start and, with a part of that distance, at t.
    stays: bool,
}

/// The control points of a part at some time.
struct Points {
    all: [Vector; MAX_POINTS * MAX_POINTS],
    count: usize,
}

impl Points {
    fn of(part: &Part, t: f64) -> Self {
        let mut points = Self {
            all: [[0.0; 3]; MAX_POINTS * MAX_POINTS],
            count: 0,
        };
        for (x, v) in part.patch.all_points().zip(part.motion.all_points()) {
            points.all[points.count] = plus(x, t, v);
            points.count += 1;
        }
        points
    }

    fn middle(&self) -> Vector {
        let all = &self.all[..self.count];
        let sum = all.iter().fold([0.0; 3], |sum, x| plus(sum, 1.0, *x));
        sum.map(|x| x / self.count as f64)
    }

    /// Returns the smallest and the largest component along a direction.
    fn along(&self, direction: Vector) -> (f64, f64) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in &self.all[..self.count] {
            let x = dot(*x, direction);
            (low, high) = (low.min(x), high.max(x));
        }
        (low, high)
    }
}

fn separation(a: &Part, b: &Part, t: f64) -> Separation {
    let (start_a, start_b) = (Points::of(a, 0.0), Points::of(b, 0.0));
    let (end_a, end_b) = (Points::of(a, t), Points::of(b, t));
    let towards = minus(start_b.middle(), start_a.middle());
    let normal = |part: &Part, t: f64| {
        let [along, around] = [0, 1].map(|direction| part.moving().slopes(direction, t).middle());
        cross(along, around)
    };
    let directions = [
        towards,
        normal(a, 0.0),
        normal(b, 0.0),
        normal(a, t),
        normal(b, t),
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
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
        let at_start = start_b.along(unit).0 - start_a.along(unit).1;
        best.at_start = best.at_start.max(at_start);
        if at_start > 0.0 && end_b.along(unit).0 - end_a.along(unit).1 >= KEPT * at_start {
            best.stays = true;
            break;
        }
    }
    best
}
