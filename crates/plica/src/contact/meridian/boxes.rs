//! A tree of boxes around the elements of a curve.

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

    fn and(self, other: Self) -> Self {
        Self {
            low: [0, 1].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1].map(|i| self.high[i].max(other.high[i])),
        }
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
}
