//! Pairs of points of a face of a three-dimensional tube that are in contact.

use super::nearest::local_minima;
use super::net::{FaceNet, Functions};
use super::patch::{Patch, PatchPoint};
use super::tree::{Bounds, Box3, Node, NodeBounds, Tree};
use super::vector::{Vector, cross, dot, length, minus};
use crate::assembly::Barrier;
use crate::spline::gauss_legendre;
use rayon::prelude::*;

/// Distance, over the places in elements, within which two minima are the same: one on the edge of two patches.
const SAME: f64 = 1e-7;

/// A quadrature point x of a face and a point y of the same face at which the distance from x has a local minimum below
/// the range.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Patches of x and y.
    pub patches: [usize; 2],
    /// Places of x and y in them.
    pub places: [[f64; 2]; 2],
    /// Number of the quadrature point x along its element.
    pub along: usize,
    /// Functions along and around at x, and at y.
    pub functions: [[Functions; 2]; 2],
    /// Area of x at rest.
    pub area: f64,
    /// g = |x − y|.
    pub gap: f64,
    /// n = (x − y)/g, normal to the face at y.
    pub normal: Vector,
    /// Second derivatives, times the area, of half the barrier over the relative displacement a = δx − δy and the two
    /// turns c_α = n · δy_α.
    pub stiffness: [[f64; 5]; 5],
    /// Energy ½ A b(g).
    pub energy: f64,
    /// Force of the energy on x: its derivative over a.
    pub force: Vector,
}

/// The quadrature of a face: points along and around an element, from 0 to 1, with their weights.
#[derive(Clone, Debug)]
pub struct Quadrature {
    /// Points along and around.
    pub points: [Vec<(f64, f64)>; 2],
}

impl Quadrature {
    /// Returns Gauss quadrature with this number of points along and around each element.
    pub fn new([along, around]: [usize; 2]) -> Self {
        Self {
            points: [gauss_legendre(along), gauss_legendre(around)],
        }
    }
}

/// A face in a state: its patches, and a tree over them.
#[derive(Clone, Debug)]
pub struct FaceState<'a> {
    pub net: &'a FaceNet,
    pub patches: Vec<Patch>,
    tree: &'a Tree,
    bounds: NodeBounds,
    /// Boxes around the points and the normals of each patch.
    boxes: Vec<[Box3; 2]>,
}

impl<'a> FaceState<'a> {
    /// Prepares the face in a state.
    pub fn new(net: &'a FaceNet, tree: &'a Tree, u: &[f64]) -> Self {
        let patches = net.patches(&net.positions(u));
        let of_patch: Vec<Bounds> = patches
            .par_iter()
            .enumerate()
            .map(|(i, patch)| Bounds::of(patch, [net.lengths[i / net.around], net.element_angle()]))
            .collect();
        let boxes = |bounds: &Bounds| [bounds.points, bounds.normals()];
        Self {
            net,
            patches,
            tree,
            bounds: tree.bounds(net.around, &of_patch),
            boxes: of_patch.iter().map(boxes).collect(),
        }
    }

    /// Returns all pairs of the quadrature points of the sector, in the order of their patches.
    pub fn pairs(&self, quadrature: &Quadrature, barrier: &Barrier) -> Vec<Pair> {
        let mut near = vec![];
        self.near_within(self.tree.root(), barrier.range, &mut near);
        near.sort_unstable();
        let first: Vec<usize> = (0..near.len())
            .filter(|&i| i == 0 || near[i - 1].0 != near[i].0)
            .collect();
        let of_patch = |&begin: &usize| {
            let own = near[begin].0;
            let others = near[begin..].iter().take_while(|(patch, _)| *patch == own);
            let others: Vec<usize> = others.map(|(_, other)| *other).collect();
            self.pairs_of_patch(own, &others, quadrature, barrier)
        };
        let by_patch: Vec<Vec<Pair>> = first.par_iter().map(of_patch).collect();
        by_patch.concat()
    }

    /// Adds the pairs of patches of a node, one of them in the sector, that are near each other and have normals more than 90°
    /// apart.
    fn near_within(&self, node: Node, range: f64, near: &mut Vec<(usize, usize)>) {
        let normals = self.bounds.of(node).normals();
        if normals.least_product(&normals) > 0.0 {
            return;
        }
        if node.is_patch() {
            // A patch that is curved by more than 90°.
            self.add_near(node, node, near);
            return;
        }
        let [a, b] = self.tree.halves(node);
        self.near_within(a, range, near);
        self.near_within(b, range, near);
        self.near_between(a, b, range, near);
    }

    fn near_between(&self, a: Node, b: Node, range: f64, near: &mut Vec<(usize, usize)>) {
        let bounds = [a, b].map(|node| self.bounds.of(node));
        if !bounds[0].points.is_within(range, &bounds[1].points)
            || bounds[0].normals().least_product(&bounds[1].normals()) > 0.0
        {
            return;
        }
        if a.is_patch() && b.is_patch() {
            self.add_near(a, b, near);
            self.add_near(b, a, near);
            return;
        }
        let (whole, other) = match a.is_patch()
            || (!b.is_patch() && bounds[1].points.size() > bounds[0].points.size())
        {
            true => (b, a),
            false => (a, b),
        };
        for half in self.tree.halves(whole) {
            self.near_between(half, other, range, near);
        }
    }

    fn add_near(&self, a: Node, b: Node, near: &mut Vec<(usize, usize)>) {
        let [a, b] = [a, b].map(|node| node.rows[0] * self.net.around + node.columns[0]);
        if a % self.net.around < self.net.rings {
            near.push((a, b));
        }
    }

    /// Returns the area of a patch at rest.
    pub fn area(&self, patch: usize) -> f64 {
        let net = self.net;
        net.lengths[patch / net.around] * net.radius * net.element_angle()
    }

    /// Returns the patches whose boxes are within a distance of a point.
    pub fn near_point(&self, (patch, place): (usize, [f64; 2]), distance: f64) -> Vec<usize> {
        let at = Box3::around([self.patches[patch].at(place).position]);
        let mut near = vec![];
        let mut nodes = vec![self.tree.root()];
        while let Some(node) = nodes.pop() {
            if !self.bounds.of(node).points.is_within(distance, &at) {
                continue;
            }
            if node.is_patch() {
                near.push(node.rows[0] * self.net.around + node.columns[0]);
            } else {
                nodes.extend(self.tree.halves(node));
            }
        }
        near.sort_unstable();
        near
    }

    fn pairs_of_patch(
        &self,
        own: usize,
        others: &[usize],
        quadrature: &Quadrature,
        barrier: &Barrier,
    ) -> Vec<Pair> {
        let mut pairs = vec![];
        let area = self.area(own);
        for (along, (v, weight_v)) in quadrature.points[0].iter().enumerate() {
            for (w, weight_w) in &quadrature.points[1] {
                let place = [*v, *w];
                let weight = weight_v * weight_w * area;
                self.pairs_of_point((own, place), others, barrier, &mut |y, own_point, other| {
                    let mut pair =
                        self.pair([(own, place), y], [own_point, other], weight, barrier);
                    pair.along = along;
                    pairs.push(pair);
                });
            }
        }
        pairs
    }

    /// Calls `found` with the points y, by patch and place, that a point x is in contact with.
    pub fn pairs_of_point(
        &self,
        (own, place): (usize, [f64; 2]),
        others: &[usize],
        barrier: &Barrier,
        found: &mut impl FnMut((usize, [f64; 2]), &PatchPoint, &PatchPoint),
    ) {
        let x = self.patches[own].at(place);
        let normal = |at: &PatchPoint| cross(at.slopes[0], at.slopes[1]);
        let own_normal = normal(&x);
        let mut seen: Vec<(usize, [f64; 2])> = vec![];
        let own_box = Box3::around([own_normal]);
        for &other in others {
            let [points, normals] = &self.boxes[other];
            if points.distance(x.position) >= barrier.range || normals.least_product(&own_box) > 0.0
            {
                continue;
            }
            let patch = &self.patches[other];
            local_minima(patch, x.position, barrier.range, &mut |place| {
                let y = patch.at(place);
                let (from_y, facing) = (minus(x.position, y.position), normal(&y));
                let gap = length(from_y);
                let faces =
                    dot(own_normal, facing) < 0.0 && self.net.free_side * dot(facing, from_y) > 0.0;
                if !(faces && gap < barrier.range && gap > 0.0) {
                    return;
                }
                if seen
                    .iter()
                    .any(|found| self.is_same(*found, (other, place)))
                {
                    return;
                }
                seen.push((other, place));
                found((other, place), &x, &y);
            });
        }
    }

    /// Returns whether two places are the same point.
    fn is_same(&self, a: (usize, [f64; 2]), b: (usize, [f64; 2])) -> bool {
        let around = self.net.around as f64;
        let coordinates = |(patch, place): (usize, [f64; 2])| {
            let [e, f] = self.net.elements_of(patch);
            [e as f64 + place[0], f as f64 + place[1]]
        };
        let (a, b) = (coordinates(a), coordinates(b));
        let turn = (a[1] - b[1]).abs();
        (a[0] - b[0]).abs() < SAME && turn.min(around - turn) < SAME
    }

    /// Returns the pair of two points. With t_α = y_α · a, c_α = n · δy_α, m_αβ = y_α · y_β, b_αβ = n · y_αβ and
    /// M = m − g b, where y stays the nearest point,
    ///
    /// δg = n · a, δ²g = −tᵀ m⁻¹ b M⁻¹ t − 2 tᵀ M⁻¹ c − g cᵀ M⁻¹ c.
    fn pair(
        &self,
        [x, y]: [(usize, [f64; 2]); 2],
        [at_x, at_y]: [&PatchPoint; 2],
        area: f64,
        barrier: &Barrier,
    ) -> Pair {
        let from_y = minus(at_x.position, at_y.position);
        let gap = length(from_y);
        let normal = from_y.map(|d| d / gap);
        let jet = barrier.at(gap);
        let share = 0.5 * area;
        let [v, w] = at_y.slopes;
        let m = [dot(v, v), dot(v, w), dot(w, w)];
        let b = at_y.curvatures.map(|c| dot(normal, c));
        let inverse = |[vv, vw, ww]: [f64; 3]| {
            let determinant = vv * ww - vw * vw;
            [ww, -vw, vv].map(|x| x / determinant)
        };
        let (m_inverse, big) = (inverse(m), inverse([0, 1, 2].map(|i| m[i] - gap * b[i])));
        let square = |[vv, vw, ww]: [f64; 3]| [[vv, vw], [vw, ww]];
        let (m_inverse, b, big) = (square(m_inverse), square(b), square(big));
        let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
            [0, 1].map(|i| [0, 1].map(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
        };
        // −m⁻¹ b M⁻¹, symmetric but for rounding.
        let q = product(product(m_inverse, b), big);
        let mut stiffness = [[0.0; 5]; 5];
        let slopes = at_y.slopes;
        for i in 0..3 {
            for j in 0..3 {
                let mut tangential = 0.0;
                for (alpha, slope) in slopes.iter().enumerate() {
                    for (beta, other) in slopes.iter().enumerate() {
                        let symmetric = 0.5 * (q[alpha][beta] + q[beta][alpha]);
                        tangential -= symmetric * slope[i] * other[j];
                    }
                }
                stiffness[i][j] =
                    share * (jet.curvature * normal[i] * normal[j] + jet.slope * tangential);
            }
            for beta in 0..2 {
                let mixed = slopes[0][i] * big[0][beta] + slopes[1][i] * big[1][beta];
                let value = -share * jet.slope * mixed;
                stiffness[i][3 + beta] = value;
                stiffness[3 + beta][i] = value;
            }
        }
        for alpha in 0..2 {
            for beta in 0..2 {
                stiffness[3 + alpha][3 + beta] = -share * jet.slope * gap * big[alpha][beta];
            }
        }
        Pair {
            patches: [x.0, y.0],
            places: [x.1, y.1],
            along: 0,
            functions: [self.net.functions(x.0, x.1), self.net.functions(y.0, y.1)],
            area,
            gap,
            normal,
            stiffness,
            energy: share * jet.value,
            force: normal.map(|n| share * jet.slope * n),
        }
    }
}
