//! A tree of rectangles of patches: boxes around their points and their derivatives.

use super::patch::Patch;
use super::vector::Vector;

/// A box with sides along z, x and y; empty if `low` is above `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box3 {
    /// Smallest coordinates.
    pub low: Vector,
    /// Largest coordinates.
    pub high: Vector,
}

impl Box3 {
    /// The box without points.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Returns the box around some points.
    pub fn around(points: impl IntoIterator<Item = Vector>) -> Self {
        let mut sum = Self::EMPTY;
        for point in points {
            for i in 0..3 {
                sum.low[i] = sum.low[i].min(point[i]);
                sum.high[i] = sum.high[i].max(point[i]);
            }
        }
        sum
    }

    /// Returns the box around two boxes.
    pub fn and(self, other: Self) -> Self {
        Self {
            low: [0, 1, 2].map(|i| self.low[i].min(other.low[i])),
            high: [0, 1, 2].map(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Returns the box around a + t b for points a of this box and b of another.
    pub fn plus(&self, t: f64, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|i| self.low[i] + t * other.low[i]),
            high: [0, 1, 2].map(|i| self.high[i] + t * other.high[i]),
        }
    }

    /// Returns whether two boxes are at most `distance` apart along each axis.
    pub fn is_within(&self, distance: f64, other: &Self) -> bool {
        (0..3).all(|i| {
            self.low[i] <= other.high[i] + distance && other.low[i] <= self.high[i] + distance
        })
    }

    /// Returns the distance of a point from the box.
    pub fn distance(&self, x: Vector) -> f64 {
        let outside = [0, 1, 2].map(|i| (self.low[i] - x[i]).max(x[i] - self.high[i]).max(0.0));
        super::vector::length(outside)
    }

    /// Returns the smallest a · b for points a of this box and b of another.
    pub fn least_product(&self, other: &Self) -> f64 {
        (0..3)
            .map(|i| {
                let (a, b) = ([self.low[i], self.high[i]], [other.low[i], other.high[i]]);
                (a[0] * b[0])
                    .min(a[0] * b[1])
                    .min(a[1] * b[0])
                    .min(a[1] * b[1])
            })
            .sum()
    }

    /// Returns a box around a × b for points a of this box and b of another.
    pub fn cross(&self, other: &Self) -> Self {
        let product = |i: usize, j: usize| {
            let (a, b) = ([self.low[i], self.high[i]], [other.low[j], other.high[j]]);
            let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
            all.into_iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                    (low.min(x), high.max(x))
                })
        };
        let component = |i: usize, j: usize| {
            let (first, second) = (product(i, j), product(j, i));
            (first.0 - second.1, first.1 - second.0)
        };
        let all = [component(1, 2), component(2, 0), component(0, 1)];
        Self {
            low: all.map(|(low, _)| low),
            high: all.map(|(_, high)| high),
        }
    }

    /// Returns the smallest and the largest component of its points along a direction.
    pub fn along(&self, direction: Vector) -> (f64, f64) {
        let (mut low, mut high) = (0.0, 0.0);
        for i in 0..3 {
            let (a, b) = (direction[i] * self.low[i], direction[i] * self.high[i]);
            low += a.min(b);
            high += a.max(b);
        }
        (low, high)
    }

    /// Returns the middle.
    pub fn middle(&self) -> Vector {
        [0, 1, 2].map(|i| f64::midpoint(self.low[i], self.high[i]))
    }

    /// Returns the length of the diagonal.
    pub fn size(&self) -> f64 {
        super::vector::length(super::vector::minus(self.high, self.low))
    }
}

/// Boxes around the points of patches and around their derivatives along and around the tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Around the control points.
    pub points: Box3,
    /// Around the derivatives over z and over the angle at rest.
    pub slopes: [Box3; 2],
}

impl Bounds {
    const EMPTY: Self = Self {
        points: Box3::EMPTY,
        slopes: [Box3::EMPTY; 2],
    };

    /// Returns the bounds of a patch whose sides at rest are `sizes` long.
    pub fn of(patch: &Patch, sizes: [f64; 2]) -> Self {
        let slopes = [0, 1].map(|direction| {
            let scale = 1.0 / sizes[direction];
            Box3::around(patch.differences(direction).map(|d| d.map(|d| scale * d)))
        });
        Self {
            points: Box3::around(patch.all_points()),
            slopes,
        }
    }

    /// Returns the bounds of two patches.
    pub fn and(self, other: Self) -> Self {
        Self {
            points: self.points.and(other.points),
            slopes: [0, 1].map(|i| self.slopes[i].and(other.slopes[i])),
        }
    }

    /// Returns a box around the products of the derivatives, which are normal to the surface.
    pub fn normals(&self) -> Box3 {
        self.slopes[0].cross(&self.slopes[1])
    }
}

/// A rectangle of patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// First row and the row after the last.
    pub rows: [usize; 2],
    /// First column and the column after the last.
    pub columns: [usize; 2],
    index: usize,
    /// Index of the first half; the other follows it. Zero for one patch.
    halves: usize,
}

impl Node {
    /// Returns whether the node is one patch.
    pub fn is_patch(&self) -> bool {
        self.halves == 0
    }
}

/// A tree over the patches of a face: a rectangle of rows along the tube and columns around it, halved again and again.
/// Rows and columns of two nodes are nested or apart.
#[derive(Clone, Debug)]
pub struct Tree {
    nodes: Vec<Node>,
}

impl Tree {
    /// Makes the tree of `rows` × `columns` patches whose sides at rest have about the given lengths.
    pub fn new([rows, columns]: [usize; 2], sizes: [f64; 2]) -> Self {
        let root = Node {
            rows: [0, rows],
            columns: [0, columns],
            index: 0,
            halves: 0,
        };
        let mut nodes = vec![root];
        let mut next = 0;
        while next < nodes.len() {
            let Node { rows, columns, .. } = nodes[next];
            let counts = [rows, columns].map(|[from, to]| to - from);
            if counts != [1, 1] {
                let first = nodes.len();
                nodes[next].halves = first;
                let [along, around] = [0, 1].map(|i| counts[i] as f64 * sizes[i]);
                let by_rows = counts[1] == 1 || (counts[0] > 1 && along >= around);
                for part in 0..2 {
                    let half = |[from, to]: [usize; 2]| {
                        let middle = usize::midpoint(from, to);
                        [[from, middle], [middle, to]][part]
                    };
                    nodes.push(Node {
                        rows: if by_rows { half(rows) } else { rows },
                        columns: if by_rows { columns } else { half(columns) },
                        index: first + part,
                        halves: 0,
                    });
                }
            }
            next += 1;
        }
        Self { nodes }
    }

    /// Returns the node of all patches.
    pub fn root(&self) -> Node {
        self.nodes[0]
    }

    /// Returns the halves of a node with more than one patch.
    pub fn halves(&self, node: Node) -> [Node; 2] {
        [self.nodes[node.halves], self.nodes[node.halves + 1]]
    }

    /// Returns the bounds of all nodes from those of the patches, numbered by row and column.
    pub fn bounds(&self, columns: usize, of_patch: &[Bounds]) -> NodeBounds {
        let mut bounds = vec![Bounds::EMPTY; self.nodes.len()];
        for node in self.nodes.iter().rev() {
            bounds[node.index] = if node.is_patch() {
                of_patch[node.rows[0] * columns + node.columns[0]]
            } else {
                bounds[node.halves].and(bounds[node.halves + 1])
            };
        }
        NodeBounds(bounds)
    }
}

/// The bounds of the nodes of a tree.
#[derive(Clone, Debug)]
pub struct NodeBounds(Vec<Bounds>);

impl NodeBounds {
    /// Returns the bounds of a node.
    pub fn of(&self, node: Node) -> &Bounds {
        &self.0[node.index]
    }
}
