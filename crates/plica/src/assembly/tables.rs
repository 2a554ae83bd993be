//! What the kernel needs to know of the splines, tabulated once.

use crate::rings::{Sector, SlotValues};
use crate::spline::{Basis, Circle, gauss_legendre, reduced_rule};
use crate::tensor::{LANES, Lanes};

/// A rule for every element of a basis: points on [0, 1] of it, and weights. Kernels read p + 1 points;
/// rules of fewer are filled up with places that have no weight.
pub type Rules = Vec<Vec<(f64, f64)>>;

/// p + 1 Gauss points on every element.
pub fn full_rules(basis: &Basis) -> Rules {
    vec![gauss_legendre(basis.degree() + 1); basis.elements()]
}

/// About one point on every element of a uniform basis, see [`reduced_rule`]. Panics where there is no
/// such rule.
pub fn reduced_rules(basis: &Basis) -> Rules {
    let (p, elements) = (basis.degree(), basis.elements());
    let rules = reduced_rule(p, elements);
    let mut rules = rules.unwrap_or_else(|| panic!("degree {p} has no reduced rule"));
    for rule in &mut rules {
        // An element between two points has one all the same, of no weight.
        let place = rule.first().map_or(0.5, |point| point.0);
        rule.resize(p + 1, (place, 0.0));
    }
    rules
}

/// Eight elements that are neighbours along the tube. The last slab may hold fewer: its spare
/// lanes repeat its last element with no weight.
#[derive(Clone, Debug)]
pub struct Slab {
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
    /// Where the quadrature points lie.
    pub z: Vec<Lanes>,
}

impl Slab {
    /// All slabs of an axial basis, with a rule of as many points for every element.
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
        let mut slab = Self {
            first,
            elements,
            value: zero(points * functions),
            slope: zero(points * functions),
            weight: zero(points),
            z: zero(points),
        };
        for l in 0..LANES {
            let e = first + slab.row(l);
            let (start, end) = basis.element(e);
            for (q, (x, w)) in rules[e].iter().enumerate() {
                let z = start + (end - start) * x;
                let v = basis.evaluate_in(e, z);
                slab.z[q].0[l] = z;
                slab.weight[q].0[l] = if l < elements { w * (end - start) } else { 0.0 };
                for a in 0..functions {
                    slab.value[q * functions + a].0[l] = v.value[a];
                    slab.slope[q * functions + a].0[l] = v.slope[a];
                }
            }
        }
        slab
    }

    /// The first row of a lane's element, counted from the slab's first.
    pub fn row(&self, lane: usize) -> usize {
        lane.min(self.elements - 1)
    }
}

/// One element through the wall.
#[derive(Clone, Debug)]
pub struct Layer {
    /// First control point.
    pub first: usize,
    /// N_c at quadrature point q, at `q * (p + 1) + c`.
    pub value: Vec<f64>,
    /// dN_c/dR, likewise.
    pub slope: Vec<f64>,
    /// Weights of the quadrature points.
    pub weight: Vec<f64>,
    /// Their reference radii R.
    pub radius: Vec<f64>,
}

impl Layer {
    /// All layers of a basis through the wall, with a rule for every element.
    pub fn all(basis: &Basis, rules: &Rules) -> Vec<Self> {
        let layer = |e: usize| {
            let rule = &rules[e];
            let (start, end) = basis.element(e);
            let points: Vec<f64> = rule
                .iter()
                .map(|(x, _)| start + (end - start) * x)
                .collect();
            let values: Vec<_> = points.iter().map(|&x| basis.evaluate_in(e, x)).collect();
            Self {
                first: e,
                value: values.iter().flat_map(|v| v.value.clone()).collect(),
                slope: values.iter().flat_map(|v| v.slope.clone()).collect(),
                weight: rule.iter().map(|(_, w)| w * (end - start)).collect(),
                radius: points,
            }
        };
        (0..basis.elements()).map(layer).collect()
    }

    /// So many Gauss points through the whole wall, each as a layer of its own.
    pub fn points(basis: &Basis, count: usize) -> Vec<Self> {
        let (inner, outer) = (basis.element(0).0, basis.element(basis.elements() - 1).1);
        let point = |(x, w): (f64, f64)| {
            let radius = inner + (outer - inner) * x;
            let v = basis.evaluate(radius);
            Self {
                first: v.element,
                value: v.value,
                slope: v.slope,
                weight: vec![w * (outer - inner)],
                radius: vec![radius],
            }
        };
        gauss_legendre(count).into_iter().map(point).collect()
    }
}

/// One quadrature point around an element; every element around the tube has the same.
#[derive(Clone, Debug)]
pub struct Around {
    /// Where along the element, 0 to 1.
    pub s: f64,
    /// What each slot contributes.
    pub slots: Vec<SlotValues>,
    /// Weight.
    pub weight: f64,
    /// C, real (outwards at the element's middle) and imaginary.
    pub circle: (f64, f64),
    /// dC/ds.
    pub circle_slope: (f64, f64),
    /// |C|.
    pub radius: f64,
    /// dC/ds along C.
    pub outwards: f64,
    /// dC/ds across C.
    pub across: f64,
}

impl Around {
    /// A point of an element around the tube, at `s` in [0, 1].
    pub fn at(sector: &Sector, circle: &Circle, s: f64, weight: f64) -> Self {
        // Every function of the element at the control radius: the sector of one ring adds up.
        let slots = sector.at(s);
        let scale = |d: usize| {
            let sum = slots.iter().fold((0.0, 0.0), |sum, slot| {
                (sum.0 + slot.turned[d].0, sum.1 + slot.turned[d].1)
            });
            (circle.control_radius * sum.0, circle.control_radius * sum.1)
        };
        let (c, slope) = (scale(0), scale(1));
        let radius = c.0.hypot(c.1);
        Self {
            s,
            slots,
            weight,
            circle: c,
            circle_slope: slope,
            radius,
            outwards: (slope.0 * c.0 + slope.1 * c.1) / radius,
            across: (slope.1 * c.0 - slope.0 * c.1) / radius,
        }
    }

    /// Reference volume per unit of z, R and s at a reference radius, times the weight:
    /// dV₀ = R b |C| dζ dR ds.
    #[inline(always)]
    pub fn volume(&self, radius: f64) -> f64 {
        self.weight * radius * self.across * self.radius
    }

    /// The quadrature points of an element around the tube.
    pub fn all(sector: &Sector, circle: &Circle, rule: &[(f64, f64)]) -> Vec<Self> {
        rule.iter()
            .map(|&(s, w)| Self::at(sector, circle, s, w))
            .collect()
    }
}
