//! The tangent of a tube of many rings: conjugate gradients around the harmonic solver.

use crate::assembly::{Linearised, LowHarmonics, RingDrag, SplineTube};
use crate::matrix::{BlockBanded, Factor, Singular};
use crate::rings::{Coupling, HarmonicSolver};
use crate::solve::{NegativeCurvature, Operator, Solver, Tangent, conjugate_gradients};
use crate::tube::Load;
use rayon::prelude::*;
use std::sync::Arc;

/// Displacement from ring to ring, in D, up to which a state counts as the same at every ring.
const SYMMETRIC: f64 = 1e-9;

/// The same from which low harmonics are coupled.
const COUPLED: f64 = 1e-2;

/// The highest harmonic of the sector that is coupled. With 0, 2, 4, 6, 8 and 10 an oval 0.28 D deep
/// took 109, 85, 56, 29, 20 and 15 iterations; the matrix costs the third power of the harmonic.
const HIGHEST: usize = 6;

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
    /// Low harmonics and the tangent on them, where the state couples them.
    low: Option<(LowHarmonics, BlockBanded)>,
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
    /// Unknowns to a row of the matrix of low harmonics, of k rings; where it is needed.
    pub fn low_row(rings: usize) -> usize {
        9 * (2 * HIGHEST.min((rings - 1) / 2) + 1)
    }

    /// At a state of a tube.
    pub fn new(tube: Arc<SplineTube>, drag: Arc<RingDrag>, load: &Load, u: &[f64]) -> Self {
        let at = tube.linearised(load, u);
        let rings = u.chunks_exact(tube.sector.rings);
        let difference = |u: &[f64]| u.iter().fold(0.0_f64, |most, x| most.max((x - u[0]).abs()));
        let differs = rings.map(difference).fold(0.0, f64::max);
        let symmetric = differs <= SYMMETRIC;
        let low = (differs > COUPLED).then(|| {
            let low = LowHarmonics::new(&tube, HIGHEST);
            let coupled = tube.coupled_tangent(&low, load, u);
            (low, coupled)
        });
        Self {
            shared: Arc::new(Shared {
                tube,
                drag,
                at,
                symmetric,
                low,
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
        let Shared {
            tube,
            symmetric,
            low,
            ..
        } = &*self.shared;
        let rings = tube.sector.rings;
        let blocks: Vec<Block> = (0..=rings / 2)
            .into_par_iter()
            .map(|n| self.block(n, alpha))
            .collect::<Result<_, _>>()?;
        let negative_pivots = if *symmetric {
            blocks[0].negative_pivots
        } else {
            0
        };
        let averaged: Vec<Factor> = match low {
            Some((low, _)) => blocks[..=low.highest]
                .par_iter()
                .enumerate()
                .map(|(n, block)| self.averaged(low, n, alpha + block.shift))
                .collect::<Result<_, _>>()?,
            None => vec![],
        };
        let factors = blocks.into_iter().map(|block| block.factor).collect();
        let mut preconditioner = HarmonicSolver::new(rings, factors);
        if let Some((low, coupled)) = low {
            let mut coupled = coupled.clone();
            if alpha != 0.0 {
                low.add_drag(tube, &self.shared.drag, alpha, &mut coupled);
            }
            coupled.constrain(&low.given(tube));
            let mut coupled = coupled.factor()?;
            coupled.make_positive();
            preconditioner = preconditioner.coupled(Coupling {
                highest: low.highest,
                through: low.through.clone(),
                coupled,
                averaged,
            });
        }
        Ok(HarmonicSystem {
            shared: self.shared.clone(),
            alpha,
            negative_pivots,
            preconditioner,
        })
    }
}

/// The factored block of a harmonic, made positive definite by more drag if need be.
struct Block {
    factor: Factor,
    /// Drag that was added.
    shift: f64,
    /// Without it.
    negative_pivots: usize,
}

/// The first drag that is tried to make a block positive definite, and what it grows by.
const SHIFT: (f64, f64) = (1e-3, 4.0);

impl HarmonicTangent {
    /// K_n + α C_n of the average, of harmonic n of the sector; every unknown is free.
    fn matrix(&self, n: usize, alpha: f64) -> BlockBanded {
        let Shared { tube, drag, at, .. } = &*self.shared;
        let n = n * (tube.sector.around / tube.sector.rings);
        let mut block = at.average.harmonic(n);
        if alpha != 0.0 {
            drag.add_harmonic(alpha, n, &mut block);
        }
        block
    }

    fn block(&self, n: usize, alpha: f64) -> Result<Block, Singular> {
        let tube = &self.shared.tube;
        let given = tube.given_in_harmonic(n * (tube.sector.around / tube.sector.rings));
        let factored = |alpha: f64| {
            let mut block = self.matrix(n, alpha);
            block.constrain(&given);
            block.factor()
        };
        let first = factored(alpha);
        let negative_pivots = first.as_ref().map_or(1, Factor::negative_pivots);
        let mut block = (first, 0.0);
        while block.0.as_ref().map_or(1, Factor::negative_pivots) > 0 && block.1 < 1e6 {
            let shift = (block.1 * SHIFT.1).max(SHIFT.0);
            block = (factored(alpha + shift), shift);
        }
        Ok(Block {
            factor: block.0?,
            shift: block.1,
            negative_pivots,
        })
    }

    /// The same on the functions through the wall that low harmonics have.
    fn averaged(&self, low: &LowHarmonics, n: usize, alpha: f64) -> Result<Factor, Singular> {
        let tube = &self.shared.tube;
        let block = self.matrix(n, alpha);
        let mut matrix = BlockBanded::zeros(block.blocks(), 3 * low.functions(), block.band());
        let place = |(c, i): (usize, usize)| 3 * c + i;
        low.project(
            &block,
            |row, column| (place(row), place(column)),
            &mut matrix,
        );
        matrix.constrain(&low.given_in_harmonic(tube, n));
        matrix.factor()
    }
}

impl Operator for HarmonicSystem {
    fn given(&self) -> &[bool] {
        self.shared.tube.given()
    }
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        let Shared { tube, drag, at, .. } = &*self.shared;
        out.fill(0.0);
        tube.product(at, 1.0, v, out);
        if self.alpha != 0.0 {
            drag.multiply_add(self.alpha, v, out);
        }
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.preconditioner.solve(r));
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.shared.drag.multiply_add(1.0, v, out);
    }
}

impl Solver for HarmonicSystem {
    fn negative_pivots(&self) -> usize {
        self.negative_pivots
    }

    fn solve(&self, b: &mut [f64], accuracy: f64) -> Result<usize, NegativeCurvature> {
        conjugate_gradients(self, b, accuracy, ITERATIONS)
    }
}
