//! The tangent of a tube of many rings: conjugate gradients around the harmonic solver.

use crate::assembly::{Linearised, RingDrag, SplineTube};
use crate::matrix::Singular;
use crate::rings::HarmonicSolver;
use crate::solve::{NegativeCurvature, Solver, Tangent};
use std::sync::Arc;

/// Displacement from ring to ring, in D, up to which a state counts as the same at every ring.
const SYMMETRIC: f64 = 1e-9;

/// Iterations after which a solve is cut off; what there is still leads down.
const ITERATIONS: usize = 400;

/// The tangent stiffness K of a state, without its matrix.
#[derive(Clone, Debug)]
pub struct HarmonicTangent {
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    tube: Arc<SplineTube>,
    drag: Arc<RingDrag>,
    at: Linearised,
    /// Whether the state is the same at every ring.
    symmetric: bool,
}

/// K + α C on the free unknowns.
#[derive(Clone, Debug)]
pub struct HarmonicSystem {
    shared: Arc<Shared>,
    alpha: f64,
    preconditioner: HarmonicSolver,
    negative_pivots: usize,
}

impl HarmonicTangent {
    /// At a state of a tube.
    pub fn new(tube: Arc<SplineTube>, drag: Arc<RingDrag>, at: Linearised, u: &[f64]) -> Self {
        let rings = u.chunks_exact(tube.sector.rings);
        let differ = |u: &[f64]| u.iter().any(|x| (x - u[0]).abs() > SYMMETRIC);
        let symmetric = !rings.into_iter().any(differ);
        Self {
            shared: Arc::new(Shared {
                tube,
                drag,
                at,
                symmetric,
            }),
        }
    }
}

impl Tangent for HarmonicTangent {
    type Solver = HarmonicSystem;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.shared.tube.product(&self.shared.at, factor, v, y);
    }

    fn shifted(&self, alpha: f64) -> Result<HarmonicSystem, Singular> {
        let Shared { tube, drag, at, .. } = &*self.shared;
        let repeats = tube.sector.around / tube.sector.rings;
        let solver = HarmonicSolver::new(tube.sector.rings, |n| {
            let n = n * repeats;
            let mut block = at.average.harmonic(n);
            if alpha != 0.0 {
                drag.add_harmonic(alpha, n, &mut block);
            }
            block.constrain(&tube.given_in_harmonic(n));
            block
        })?;
        let negative = solver.negative_pivots();
        Ok(HarmonicSystem {
            shared: self.shared.clone(),
            alpha,
            // Only where the blocks are the tangent itself do they tell.
            negative_pivots: if self.shared.symmetric { negative[0] } else { 0 },
            preconditioner: solver.made_positive(),
        })
    }
}

impl HarmonicSystem {
    fn apply(&self, v: &[f64]) -> Vec<f64> {
        let Shared { tube, drag, at, .. } = &*self.shared;
        let mut y = vec![0.0; v.len()];
        tube.product(at, 1.0, v, &mut y);
        if self.alpha != 0.0 {
            drag.multiply_add(self.alpha, v, &mut y);
        }
        self.free(&mut y);
        y
    }

    fn free(&self, v: &mut [f64]) {
        for (v, &given) in v.iter_mut().zip(self.shared.tube.given()) {
            if given {
                *v = 0.0;
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Solver for HarmonicSystem {
    fn negative_pivots(&self) -> usize {
        self.negative_pivots
    }

    fn solve(&self, b: &mut [f64], accuracy: f64) -> Result<usize, NegativeCurvature> {
        let mut r = b.to_vec();
        self.free(&mut r);
        let target = accuracy * dot(&r, &r).sqrt();
        let mut x = vec![0.0; b.len()];
        let mut d: Vec<f64> = vec![];
        let mut rz_before = 0.0;
        let mut iterations = 0;
        while dot(&r, &r).sqrt() > target && iterations < ITERATIONS {
            let mut z = self.preconditioner.solve(&r);
            self.free(&mut z);
            let rz = dot(&r, &z);
            let beta = if iterations == 0 { 0.0 } else { rz / rz_before };
            if iterations == 0 {
                d = z;
            } else {
                for (d, z) in d.iter_mut().zip(&z) {
                    *d = z + beta * *d;
                }
            }
            rz_before = rz;
            let q = self.apply(&d);
            let curvature = dot(&d, &q);
            iterations += 1;
            if curvature <= 0.0 || curvature.is_nan() {
                let mut metric = vec![0.0; d.len()];
                self.shared.drag.multiply_add(1.0, &d, &mut metric);
                let size = dot(&d, &metric);
                return Err(NegativeCurvature {
                    curvature: (curvature / size).min(0.0),
                    direction: d,
                    iterations,
                });
            }
            let step = rz / curvature;
            for i in 0..x.len() {
                x[i] += step * d[i];
                r[i] -= step * q[i];
            }
        }
        for ((b, x), &given) in b.iter_mut().zip(&x).zip(self.shared.tube.given()) {
            if !given {
                *b = *x;
            }
        }
        Ok(iterations)
    }
}
