//! Tabulated basis functions and quadrature points: along the tube, through the wall and around it.

use crate::rings::{RingValues, Sector};
use crate::spline::{Basis, Circle, gauss_legendre, reduced_rule};
use crate::tensor::{LANES, Lanes};
use crate::tube::{Mesh, Tube};
use std::ops::Range;

/// Returns the basis along a tube, over z, and through its wall, over the reference radius.
pub fn bases(tube: &Tube, mesh: &Mesh) -> [Basis; 2] {
    let breakpoints = mesh.breakpoints_along(tube.length);
    let radii = mesh.breakpoints_through(tube.thickness);
    let radii: Vec<f64> = radii.iter().map(|h| tube.inner_radius() + h).collect();
    [
        Basis::open(mesh.degree, &breakpoints),
        Basis::with_multiplicities(mesh.degree, &radii, &mesh.multiplicities_through()),
    ]
}

/// A quadrature rule for every element of a basis: points on [0, 1] of the element, and weights.
/// Kernels read p + 1 points; shorter rules are padded with points of zero weight.
pub type Rules = Vec<Vec<(f64, f64)>>;

/// Returns p + 1 Gauss points on every element.
pub fn full_rules(basis: &Basis) -> Rules {
    vec![gauss_legendre(basis.degree() + 1); basis.elements()]
}

/// Returns about one point on every element of a uniform layer, see [`reduced_rule`]. Panics if the
/// degree has no such rule.
pub fn reduced_rules(p: usize, elements: usize) -> Rules {
    let rules = reduced_rule(p, elements);
    let mut rules = rules.unwrap_or_else(|| panic!("degree {p} has no reduced rule"));
    for rule in &mut rules {
        // An element without a quadrature point gets one of zero weight.
        let place = rule.first().map_or(0.5, |point| point.0);
        rule.resize(p + 1, (place, 0.0));
    }
    rules
}

/// Eight elements that are neighbours along the tube. The last batch may hold fewer: its unused
/// lanes repeat its last element with zero weight.
#[derive(Clone, Debug)]
pub struct AxialBatch {
    /// First row of control points.
    pub first: usize,
    /// Elements, at most eight.
    pub elements: usize,
    /// N_a at quadrature point q, at `q * (p + 1) + a`.
    pub value: Vec<Lanes>,
    /// dN_a/dz, likewise.
    pub slope: Vec<Lanes>,
    /// Weights of the quadrature points.
    pub weight: Vec<Lanes>,
    /// Axial positions of the quadrature points.
    pub z: Vec<Lanes>,
}

impl AxialBatch {
    /// Returns the batches of an axial basis; every element has as many quadrature points.
    pub fn all(basis: &Basis, rules: &Rules) -> Vec<Self> {
        (0..basis.elements())
            .step_by(LANES)
            .map(|first| Self::new(basis, first, rules))
            .collect()
    }

    fn new(basis: &Basis, first: usize, rules: &Rules) -> Self {
        let (points, functions) = (rules[0].len(), basis.degree() + 1);
        let elements = (basis.elements() - first).min(LANES);
        let zero = |n: usize| vec![Lanes::default(); n];
        let mut batch = Self {
            first,
            elements,
            value: zero(points * functions),
            slope: zero(points * functions),
            weight: zero(points),
            z: zero(points),
        };
        for l in 0..LANES {
            let e = first + batch.row(l);
            let (start, end) = basis.element(e);
            for (q, (x, w)) in rules[e].iter().enumerate() {
                let z = start + (end - start) * x;
                let v = basis.evaluate_in(e, z);
                batch.z[q].0[l] = z;
                batch.weight[q].0[l] = if l < elements { w * (end - start) } else { 0.0 };
                for a in 0..functions {
                    batch.value[q * functions + a].0[l] = v.value[a];
                    batch.slope[q * functions + a].0[l] = v.slope[a];
                }
            }
        }
        batch
    }

    /// Returns the first row of a lane's element, counted from the first row of the batch.
    pub fn row(&self, lane: usize) -> usize {
        lane.min(self.elements - 1)
    }
}

/// One element through the wall.
#[derive(Clone, Debug)]
pub struct Layer {
    /// Its number from the inside.
    pub element: usize,
    /// First control point.
    pub first: usize,
    /// N_c at quadrature point q, at `q * (p + 1) + c`.
    pub value: Vec<f64>,
    /// dN_c/dR, likewise.
    pub slope: Vec<f64>,
    /// Weights of the quadrature points at rest.
    pub weight_at_rest: Vec<f64>,
    /// Weights of the quadrature points, times the volume of the wall free of residual stress over that at rest.
    pub weight: Vec<f64>,
    /// Their reference radii R.
    pub radius: Vec<f64>,
    /// One over the residual stretches along and around at the quadrature points.
    pub inverse_residual: Vec<[f64; 2]>,
}

impl Layer {
    /// Returns the elements from `first` on through the wall, each with a quadrature rule.
    pub fn all(basis: &Basis, first: usize, rules: &[Vec<(f64, f64)>]) -> Vec<Self> {
        let layer = |(e, rule): (usize, &Vec<(f64, f64)>)| {
            let e = first + e;
            let (start, end) = basis.element(e);
            let points: Vec<f64> = rule
                .iter()
                .map(|(x, _)| start + (end - start) * x)
                .collect();
            let values: Vec<_> = points.iter().map(|&x| basis.evaluate_in(e, x)).collect();
            let weight: Vec<f64> = rule.iter().map(|(_, w)| w * (end - start)).collect();
            Self {
                element: e,
                first: basis.first(e),
                value: values.iter().flat_map(|v| v.value.clone()).collect(),
                slope: values.iter().flat_map(|v| v.slope.clone()).collect(),
                weight_at_rest: weight.clone(),
                weight,
                inverse_residual: vec![[1.0; 2]; points.len()],
                radius: points,
            }
        };
        rules.iter().enumerate().map(layer).collect()
    }

    /// Returns `count` Gauss points through some elements of the wall, each as an element of its own.
    pub fn points(basis: &Basis, elements: Range<usize>, count: usize) -> Vec<Self> {
        let (inner, outer) = (
            basis.element(elements.start).0,
            basis.element(elements.end - 1).1,
        );
        let point = |(x, w): (f64, f64)| {
            let radius = inner + (outer - inner) * x;
            let v = basis.evaluate(radius);
            let weight = vec![w * (outer - inner)];
            Self {
                element: v.element,
                first: v.first,
                value: v.value,
                slope: v.slope,
                weight_at_rest: weight.clone(),
                weight,
                radius: vec![radius],
                inverse_residual: vec![[1.0; 2]],
            }
        };
        gauss_legendre(count).into_iter().map(point).collect()
    }

    /// Adds the residual stretches along and around that `stretch` returns at a reference radius.
    pub fn with_residual(mut self, stretch: impl Fn(f64) -> [f64; 2]) -> Self {
        for (q, &radius) in self.radius.iter().enumerate() {
            let [along, around] = stretch(radius);
            self.inverse_residual[q] = [1.0 / along, 1.0 / around];
            self.weight[q] = self.weight_at_rest[q] * (along * around);
        }
        self
    }
}

/// A quadrature point around an element. The points are the same for every element around the tube.
#[derive(Clone, Debug)]
pub struct CircumferentialPoint {
    /// Position in the element, from 0 to 1.
    pub s: f64,
    /// Basis functions of the distinct rings of an element, by local index.
    pub ring_values: Vec<RingValues>,
    /// Weight.
    pub weight: f64,
    /// C, real (outwards at the element's middle) and imaginary.
    pub circle: (f64, f64),
    /// dC/ds.
    pub circle_slope: (f64, f64),
    /// |C|.
    pub radius: f64,
    /// Component of dC/ds along C.
    pub outwards: f64,
    /// Component of dC/ds perpendicular to C.
    pub across: f64,
}

impl CircumferentialPoint {
    /// Returns the point at `s` in [0, 1] of an element.
    pub fn at(sector: &Sector, circle: &Circle, s: f64, weight: f64) -> Self {
        // With every control point at the control radius, the ring values add up to C.
        let ring_values = sector.at(s);
        let scale = |d: usize| {
            let sum = ring_values.iter().fold((0.0, 0.0), |sum, ring| {
                (sum.0 + ring.rotated[d].0, sum.1 + ring.rotated[d].1)
            });
            (circle.control_radius * sum.0, circle.control_radius * sum.1)
        };
        let (c, slope) = (scale(0), scale(1));
        let radius = c.0.hypot(c.1);
        Self {
            s,
            ring_values,
            weight,
            circle: c,
            circle_slope: slope,
            radius,
            outwards: (slope.0 * c.0 + slope.1 * c.1) / radius,
            across: (slope.1 * c.0 - slope.0 * c.1) / radius,
        }
    }

    /// Returns the weighted reference volume per unit of z, R and s at a reference radius: dV₀ = R
    /// b |C| dζ dR ds.
    #[inline(always)]
    pub fn volume(&self, radius: f64) -> f64 {
        self.weight * radius * self.across * self.radius
    }

    /// Returns the quadrature points of an element around the tube.
    pub fn all(sector: &Sector, circle: &Circle, rule: &[(f64, f64)]) -> Vec<Self> {
        rule.iter()
            .map(|&(s, w)| Self::at(sector, circle, s, w))
            .collect()
    }
}
