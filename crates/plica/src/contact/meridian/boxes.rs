//! Trees of boxes around the elements of a curve, and around their derivatives.

use super::bezier::{Bezier, Point};

/// A box with sides along z and r; empty if `low` is above `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box2 {
    low: Point,
    high: Point,
}

impl Box2 {
    /// Returns the box around some points.
    pub fn around(points: impl IntoIterator<Item = Point>) -> Self {
        let empty = Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        points.into_iter().fold(empty, |sum, point| {
            sum.and(Self {
                low: point,
                high: point,
            })
        })
    }

    /// Returns the smallest box around two.
    pub fn and(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Returns the smallest product of a vector of one box with one of the other; infinite if one is empty.
    pub fn least_product(&self, other: &Self) -> f64 {
        (0..2)
            .map(|i| {
                let [a, b] = [[self.low[i], self.high[i]], [other.low[i], other.high[i]]];
                let products = a.into_iter().flat_map(|a| b.map(|b| a * b));
                products.fold(f64::INFINITY, f64::min)
            })
            .sum()
    }

    /// Returns whether all vectors of two boxes have a positive product with the sum of their middles.
    pub fn run_forward(&self, other: &Self) -> bool {
        let middle = |of: &Self| [0, 1].map(|i| 0.5 * (of.low[i] + of.high[i]));
        let [a, b] = [middle(self), middle(other)];
        let direction = Self::around([[a[0] + b[0], a[1] + b[1]]]);
        [self, other]
            .iter()
            .all(|of| of.least_product(&direction) > 0.0)
    }

    /// Returns whether two boxes are at most `distance` apart along each axis.
    pub fn is_within(&self, distance: f64, other: &Self) -> bool {
        (0..2).all(|i| {
            self.low[i] <= other.high[i] + distance && other.low[i] <= self.high[i] + distance
        })
    }
}

/// Boxes around runs of neighbouring elements: a binary tree, in an array whose node i has the children 2i + 1 and
/// 2i + 2.
#[derive(Clone, Debug)]
pub struct BoxTree {
    nodes: Vec<Box2>,
    elements: usize,
}

/// A node of a tree: its index, and the run of elements that it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    index: usize,
    /// First element.
    pub first: usize,
    /// The element after the last.
    pub end: usize,
}

impl Node {
    /// Returns the halves of a node with more than one element.
    pub fn halves(self) -> [Self; 2] {
        let middle = usize::midpoint(self.first, self.end);
        let half = |index, first, end| Self { index, first, end };
        [
            half(2 * self.index + 1, self.first, middle),
            half(2 * self.index + 2, middle, self.end),
        ]
    }

    /// Returns whether the node is one element.
    pub fn is_element(self) -> bool {
        self.end - self.first == 1
    }
}

impl BoxTree {
    /// Makes the tree of one box per element.
    pub fn new(elements: usize, of: impl Fn(usize) -> Box2) -> Self {
        let mut tree = Self {
            nodes: vec![Box2::around([]); 4 * elements.max(1).next_power_of_two()],
            elements,
        };
        if elements > 0 {
            tree.fill(tree.root(), &of);
        }
        tree
    }

    /// Makes the tree of the control points of curves.
    pub fn of_curves(curves: &[Bezier]) -> Self {
        Self::new(curves.len(), |e| {
            Box2::around(curves[e].points().iter().copied())
        })
    }

    /// Makes the tree of the differences of the control points of curves, in which their derivatives lie.
    pub fn of_slopes(curves: &[Bezier]) -> Self {
        Self::new(curves.len(), |e| Box2::around(curves[e].differences()))
    }

    fn fill(&mut self, node: Node, of: &impl Fn(usize) -> Box2) -> Box2 {
        self.nodes[node.index] = if node.is_element() {
            of(node.first)
        } else {
            let [left, right] = node.halves();
            self.fill(left, of).and(self.fill(right, of))
        };
        self.nodes[node.index]
    }

    /// Returns the node of all elements.
    pub fn root(&self) -> Node {
        Node {
            index: 0,
            first: 0,
            end: self.elements,
        }
    }

    /// Returns the box of a node.
    pub fn around(&self, node: Node) -> &Box2 {
        &self.nodes[node.index]
    }

    /// Calls `found` with the elements whose box is at most `distance` from a box, in order.
    pub fn near(&self, place: &Box2, distance: f64, found: &mut impl FnMut(usize)) {
        if self.elements > 0 {
            self.near_in(self.root(), place, distance, found);
        }
    }

    fn near_in(&self, node: Node, place: &Box2, distance: f64, found: &mut impl FnMut(usize)) {
        if !self.around(node).is_within(distance, place) {
            return;
        }
        if node.is_element() {
            found(node.first);
        } else {
            for half in node.halves() {
                self.near_in(half, place, distance, found);
            }
        }
    }
}

/// Returns the elements of curves, each with another or itself, whose boxes are at most `distance` apart and whose normals may be
/// 90° apart or more, in order.
pub fn near_and_turned(curves: &[Bezier], distance: f64) -> Vec<(usize, usize)> {
    let search = Search {
        points: BoxTree::of_curves(curves),
        slopes: BoxTree::of_slopes(curves),
        distance,
    };
    let mut found = vec![];
    if !curves.is_empty() {
        search.within(search.points.root(), &mut found);
    }
    found.sort_unstable();
    found
}

/// A search for pairs of elements.
struct Search {
    points: BoxTree,
    slopes: BoxTree,
    distance: f64,
}

impl Search {
    fn are_turned(&self, a: Node, b: Node) -> bool {
        let [a, b] = [a, b].map(|node| self.slopes.around(node));
        a.least_product(b) <= 0.0
    }

    fn within(&self, node: Node, found: &mut Vec<(usize, usize)>) {
        if !self.are_turned(node, node) {
            return;
        }
        if node.is_element() {
            found.push((node.first, node.first));
            return;
        }
        let [left, right] = node.halves();
        self.within(left, found);
        self.within(right, found);
        self.between(left, right, found);
    }

    fn between(&self, a: Node, b: Node, found: &mut Vec<(usize, usize)>) {
        let [near, other] = [a, b].map(|node| self.points.around(node));
        if !near.is_within(self.distance, other) || !self.are_turned(a, b) {
            return;
        }
        if a.is_element() && b.is_element() {
            found.extend([(a.first, b.first), (b.first, a.first)]);
            return;
        }
        let (whole, other) = match a.end - a.first >= b.end - b.first {
            true => (a, b),
            false => (b, a),
        };
        for half in whole.halves() {
            self.between(half, other, found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_finds_the_elements_that_a_loop_finds() {
        let place = |e: usize| {
            let x = e as f64;
            [(0.7 * x).sin(), (0.31 * x * x).cos()]
        };
        for count in [0, 1, 2, 3, 7, 64, 100] {
            let of = |e: usize| Box2::around([place(e), place(e + 1)]);
            let tree = BoxTree::new(count, of);
            for (at, distance) in [([0.2, 0.3], 0.0), ([-0.5, 0.5], 0.1), ([3.0, 0.0], 1.0)] {
                let at = Box2::around([at]);
                let mut found = vec![];
                tree.near(&at, distance, &mut |e| found.push(e));
                let expected: Vec<usize> = (0..count)
                    .filter(|&e| of(e).is_within(distance, &at))
                    .collect();
                assert_eq!(found, expected, "{count}");
            }
        }
    }

    #[test]
    fn the_search_finds_the_pairs_that_a_loop_finds() {
        for (waves, height) in [(0.0, 0.0), (1.0, 0.2), (5.0, 0.4), (9.0, 2.0)] {
            let point = |x: f64| [x, height * (waves * x).sin()];
            let curve = |e: usize| {
                let at = |i: usize| point(0.1 * (e as f64 + i as f64 / 3.0));
                Bezier::new((0..4).map(at))
            };
            let curves: Vec<Bezier> = (0..61).map(curve).collect();
            let around = |e: usize| Box2::around(curves[e].points().iter().copied());
            let slopes = |e: usize| Box2::around(curves[e].differences());
            for distance in [0.0, 0.05, 0.5] {
                let of = |e: usize| {
                    let (around, slopes) = (&around, &slopes);
                    (0..61).filter_map(move |f| {
                        let is_near = around(e).is_within(distance, &around(f));
                        (is_near && slopes(e).least_product(&slopes(f)) <= 0.0).then_some((e, f))
                    })
                };
                let expected: Vec<(usize, usize)> = (0..61).flat_map(of).collect();
                assert_eq!(near_and_turned(&curves, distance), expected);
                // Neighbours of a crest are not turned enough; elements on either side of it are.
                if distance == 0.5 {
                    assert_eq!(expected.is_empty(), height * waves < 0.5, "{waves}");
                }
            }
        }
    }
}
