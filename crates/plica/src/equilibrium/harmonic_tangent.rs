//! The tangent of a tube of many rings: conjugate gradients around the harmonic solver.

use super::spare::Spare;
use crate::assembly::{LowHarmonics, MatrixFreeTangent, RingDamping, SplineTube};
use crate::matrix::{BlockBanded, Factor, Singular};
use crate::monitor::Monitor;
use crate::rings::{HarmonicSolver, LowHarmonicCorrection, Transform};
use crate::solve::{NegativeCurvature, Operator, Solved, Solver, Tangent, conjugate_gradients};
use crate::tube::Load;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Displacement from ring to ring, in D, up to which a state counts as the same at every ring.
const SYMMETRIC: f64 = 1e-9;

/// The same from which low harmonics are coupled.
const COUPLED: f64 = 1e-2;

/// The highest harmonics of the sector that may be coupled: four times the one that the state itself
/// has. An oval 0.24 D out of round takes 111, 94, 61, 36 and 20 iterations with 1, 2, 4, 6 and 8 coupled; a tilt
/// of 0.13 D 57, 36, 21, 20 and 20. The matrix costs the third power of the harmonic.
const HIGHEST: [usize; 2] = [4, 8];

/// The share of the waves in a state from which a harmonic counts as one that it has.
const SHARE: f64 = 0.1;

/// Iterations after which a solve is cut off; what there is still leads down.
const ITERATIONS: usize = 400;

/// A tube of many rings, and what its tangents share.
#[derive(Debug)]
pub struct HarmonicTube {
    tube: Arc<SplineTube>,
    damping: RingDamping,
    /// Low harmonics, as many as a state needs, once one does.
    low: [OnceLock<Arc<LowHarmonics>>; 2],
    /// Memory of tangents, of blocks of harmonics, and of matrices of low harmonics.
    linearised: Spare<MatrixFreeTangent>,
    blocks: Spare<BlockBanded>,
    coupled: Spare<BlockBanded>,
}

/// The tangent stiffness K of a state, without its matrix.
#[derive(Clone, Debug)]
pub struct HarmonicTangent {
    state: Arc<Linear>,
}

/// A linearised state; its memory goes back to its tube.
#[derive(Debug)]
struct Linear {
    tube: Arc<HarmonicTube>,
    at: MatrixFreeTangent,
    /// Whether the state is the same at every ring.
    symmetric: bool,
    /// The low harmonics that the state couples, if it does.
    low: Option<Arc<LowHarmonics>>,
    /// The tangent on them, unless it was used up.
    coupled: Option<BlockBanded>,
}

/// K + α C on the free unknowns.
#[derive(Debug)]
pub struct HarmonicSystem {
    state: Arc<Linear>,
    alpha: f64,
    /// None only while it is dropped.
    preconditioner: Option<HarmonicSolver>,
    /// Of the averaged block of each harmonic of the sector.
    negative_pivots: Vec<usize>,
}

impl Drop for Linear {
    fn drop(&mut self) {
        self.tube.linearised.give(std::mem::take(&mut self.at));
        if let Some(coupled) = self.coupled.take() {
            self.tube.coupled.give(coupled);
        }
    }
}

impl Drop for HarmonicSystem {
    fn drop(&mut self) {
        let tube = &self.state.tube;
        if let Some(preconditioner) = self.preconditioner.take() {
            let (factors, coupling) = preconditioner.into_factors();
            for factor in factors {
                tube.blocks.give(factor.into_memory());
            }
            if let Some(coupling) = coupling {
                tube.coupled.give(coupling.coupled.into_memory());
            }
        }
    }
}

impl HarmonicTube {
    /// Of a tube.
    pub fn new(tube: Arc<SplineTube>) -> Self {
        Self {
            damping: tube.ring_damping(),
            tube,
            low: Default::default(),
            linearised: Spare::default(),
            blocks: Spare::default(),
            coupled: Spare::default(),
        }
    }

    /// y += factor · C v.
    pub fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }

    /// The tangent stiffness at a state.
    pub fn tangent(self: &Arc<Self>, load: &Load, u: &[f64]) -> HarmonicTangent {
        let mut at = self.linearised.take().unwrap_or_default();
        self.tube.linearise_into(load, u, &mut at);
        let rings = u.chunks_exact(self.tube.sector.rings);
        let difference = |u: &[f64]| u.iter().fold(0.0_f64, |most, x| most.max((x - u[0]).abs()));
        let differs = rings.map(difference).fold(0.0, f64::max);
        let low = (differs > COUPLED).then(|| self.low_harmonics(u));
        let coupled = low.as_ref().map(|low| {
            let mut coupled = self.low_matrix(low);
            self.tube.low_harmonic_tangent(low, load, u, &mut coupled);
            coupled
        });
        HarmonicTangent {
            state: Arc::new(Linear {
                tube: self.clone(),
                at,
                symmetric: differs <= SYMMETRIC,
                low,
                coupled,
            }),
        }
    }

    /// The low harmonics that a state couples.
    fn low_harmonics(&self, u: &[f64]) -> Arc<LowHarmonics> {
        let mut shares = Transform::new(self.tube.sector.rings).dot_by_harmonic(u, u);
        shares[0] = 0.0;
        let all: f64 = shares.iter().sum();
        let own = shares.iter().rposition(|share| *share > SHARE * all);
        let which = usize::from(4 * own.unwrap_or(1) > HIGHEST[0]);
        let low = || Arc::new(LowHarmonics::new(&self.tube, HIGHEST[which]));
        self.low[which].get_or_init(low).clone()
    }

    /// Memory for a matrix of low harmonics.
    fn low_matrix(&self, low: &LowHarmonics) -> BlockBanded {
        let (rows, size, band) = (
            self.tube.axial.functions(),
            low.row_size(),
            self.tube.degree(),
        );
        let fits = self.coupled.take().filter(|matrix| matrix.size() == size);
        fits.unwrap_or_else(|| BlockBanded::zeros(rows, size, band))
    }

    /// Memory for the block of a harmonic.
    fn block(&self) -> BlockBanded {
        let (rows, points) = (self.tube.axial.functions(), self.tube.wall.functions());
        let new = || BlockBanded::zeros(rows, 3 * points, self.tube.degree());
        self.blocks.take().unwrap_or_else(new)
    }
}

impl HarmonicTangent {
    /// Unknowns to a row of the matrix of low harmonics, of k rings; where it is needed.
    pub fn low_row(rings: usize) -> usize {
        9 * (2 * HIGHEST[1].min(LowHarmonics::highest_resolved(rings)) + 1)
    }
}

impl Tangent for HarmonicTangent {
    type Solver = HarmonicSystem;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        let Linear { tube, at, .. } = &*self.state;
        tube.tube.add_tangent_product(at, factor, v, y);
    }

    fn shifted(&self, alpha: f64) -> Result<HarmonicSystem, Singular> {
        let Linear {
            tube, low, coupled, ..
        } = &*self.state;
        let copy = low.as_deref().zip(coupled.as_ref()).map(|(low, coupled)| {
            let mut matrix = tube.low_matrix(low);
            matrix.copy_from(coupled);
            matrix
        });
        self.system(alpha, copy)
    }

    fn into_shifted(mut self, alpha: f64) -> Result<HarmonicSystem, Singular> {
        match Arc::get_mut(&mut self.state) {
            Some(alone) => {
                let coupled = alone.coupled.take();
                self.system(alpha, coupled)
            }
            None => self.shifted(alpha),
        }
    }
}

impl HarmonicTangent {
    /// The system, and the tangent on low harmonics to make its own of.
    fn system(&self, alpha: f64, coupled: Option<BlockBanded>) -> Result<HarmonicSystem, Singular> {
        let tube = &self.state.tube;
        let rings = tube.tube.sector.rings;
        let blocks: Vec<Block> = (0..=rings / 2)
            .into_par_iter()
            .map(|n| self.state.block(n, alpha))
            .collect::<Result<_, _>>()?;
        let negative_pivots = blocks.iter().map(|block| block.negative_pivots).collect();
        let (factors, averaged): (Vec<_>, Vec<_>) = blocks
            .into_iter()
            .map(|block| (block.factor, block.averaged))
            .unzip();
        let mut preconditioner = HarmonicSolver::new(rings, factors);
        if let (Some(low), Some(mut matrix)) = (self.state.low.as_deref(), coupled) {
            if alpha != 0.0 {
                low.add_damping(&tube.tube, &tube.damping, alpha, &mut matrix);
            }
            matrix.constrain(&low.prescribed(&tube.tube));
            let mut coupled = matrix.factor()?;
            coupled.make_positive();
            preconditioner = preconditioner.with_correction(LowHarmonicCorrection {
                highest: low.highest,
                through: low.through.clone(),
                coupled,
                averaged: averaged.into_iter().flatten().collect(),
            });
        }
        Ok(HarmonicSystem {
            state: self.state.clone(),
            alpha,
            negative_pivots,
            preconditioner: Some(preconditioner),
        })
    }
}

/// The factored block of a harmonic, made positive definite by more drag if need be.
struct Block {
    factor: Factor,
    /// Of the block as it would be without that drag.
    negative_pivots: usize,
    /// The block on the functions through the wall that low harmonics have, for those that are coupled.
    averaged: Option<Factor>,
}

/// The first drag that is tried to make a block positive definite, and what it grows by.
const SHIFT: (f64, f64) = (1e-3, 4.0);

impl Linear {
    /// K_n + α C_n of the average, of harmonic n of the sector.
    fn block(&self, n: usize, alpha: f64) -> Result<Block, Singular> {
        let (tube, waves) = (&self.tube.tube, n * self.waves());
        let prescribed = tube.prescribed_in_harmonic(waves);
        let factored = |alpha: f64| {
            let mut block = self.tube.block();
            self.at.average.harmonic_into(waves, &mut block);
            if alpha != 0.0 {
                self.tube.damping.add_harmonic(alpha, waves, &mut block);
            }
            let averaged = self
                .low
                .as_deref()
                .filter(|low| n <= low.highest)
                .map(|low| self.averaged(low, n, &block))
                .transpose()?;
            block.constrain(&prescribed);
            Ok((block.factor()?, averaged))
        };
        let pivots = |factored: &Result<(Factor, _), Singular>| {
            factored
                .as_ref()
                .map_or(1, |(factor, _)| factor.negative_pivots())
        };
        let mut found = factored(alpha);
        // A singular block is at the edge of stability, and counts as lost; of a state that is not
        // symmetric it proves nothing.
        let negative_pivots = match &found {
            Err(_) if !self.symmetric => 0,
            found => pivots(found),
        };
        let mut shift = 0.0;
        while pivots(&found) > 0 && shift < 1e6 {
            if let Ok((factor, _)) = found {
                self.tube.blocks.give(factor.into_memory());
            }
            shift = f64::max(shift * SHIFT.1, SHIFT.0);
            found = factored(alpha + shift);
        }
        let (mut factor, averaged) = found?;
        // Whatever the drag left negative.
        factor.make_positive();
        Ok(Block {
            factor,
            negative_pivots,
            averaged,
        })
    }

    /// Waves around the whole tube of harmonic 1 of the sector.
    fn waves(&self) -> usize {
        let sector = &self.tube.tube.sector;
        sector.around / sector.rings
    }

    /// A block, every unknown free, on the functions through the wall that low harmonics have.
    fn averaged(
        &self,
        low: &LowHarmonics,
        n: usize,
        block: &BlockBanded,
    ) -> Result<Factor, Singular> {
        let mut matrix = BlockBanded::zeros(block.blocks(), 3 * low.functions(), block.band());
        let place = |(c, i): (usize, usize)| 3 * c + i;
        low.project(
            block,
            |row, column| (place(row), place(column)),
            &mut matrix,
        );
        matrix.constrain(&low.prescribed_in_harmonic(&self.tube.tube, n));
        matrix.factor()
    }
}

impl Operator for HarmonicSystem {
    fn prescribed(&self) -> &[bool] {
        self.state.tube.tube.prescribed()
    }
    fn project_out_constraints(&self, v: &mut [f64]) {
        self.state.tube.tube.project_out_constraints(v);
    }
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        let Linear { tube, at, .. } = &*self.state;
        out.fill(0.0);
        tube.tube.add_tangent_product(at, 1.0, v, out);
        if self.alpha != 0.0 {
            tube.damping(self.alpha, v, out);
        }
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        match &self.preconditioner {
            Some(preconditioner) => out.copy_from_slice(&preconditioner.solve(r)),
            None => out.copy_from_slice(r),
        }
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.state.tube.damping(1.0, v, out);
    }
}

impl HarmonicSystem {
    /// Negative eigenvalues of harmonics 0, 1, … of the sector, of a state that is the same at every
    /// ring; none of any other, whose tangent does not part into harmonics. Of a tube that is twisted,
    /// or imperfect in its geometry or its muscles, they are those of the average: if that has any,
    /// the tangent has one at least.
    pub fn negative_in_harmonics(&self) -> Option<&[usize]> {
        self.state.symmetric.then_some(&self.negative_pivots)
    }

    /// Whether the average of the tangent around the tube is indefinite. Then the tangent is, too: what
    /// the average makes of a displacement is the mean of what the tangent makes of it turned to every
    /// ring, and mirrored, and the supports are the same turned and mirrored.
    pub fn average_is_indefinite(&self) -> bool {
        self.negative_pivots.iter().any(|negative| *negative > 0)
    }
}

impl Solver for HarmonicSystem {
    fn negative_pivots(&self) -> usize {
        self.negative_in_harmonics()
            .map_or(0, |harmonics| harmonics[0])
    }

    /// A state that is the same at every ring stays so, whatever other harmonics it has lost.
    fn is_unstable(&self) -> bool {
        match self.negative_in_harmonics() {
            Some(harmonics) => harmonics[0] > 0,
            None => self.average_is_indefinite(),
        }
    }

    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        conjugate_gradients(self, b, accuracy, ITERATIONS, monitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Mesh, Support, Tube};

    #[test]
    fn memory_that_another_state_has_used_changes_nothing() {
        let tube = Tube {
            length: 1.0,
            thickness: 0.06,
            material: Material::NeoHookean(NeoHookean::new(1.0, 0.4)),
            muscles: vec![],
            ends: [Support::Fixed; 2],
            imperfections: vec![],
        };
        let mesh = Mesh {
            axial: 8,
            around: 36,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            volumetric: Default::default(),
        };
        let tube = Arc::new(SplineTube::new(&tube, &mesh, 36));
        let load = tube.tube.rest();
        let wave = |harmonic: f64| {
            tube.control_values_from(|z, _, ring| {
                let phi = harmonic * tube.sector.ring_angle(ring);
                let size = 0.03 * (std::f64::consts::PI * z).sin();
                [0.0, size * phi.cos(), -size * phi.sin() / harmonic]
            })
        };
        let solved = |on: &Arc<HarmonicTube>, u: &[f64]| {
            let tangent = on.tangent(&load, u);
            let coupled = tangent.state.low.as_ref().map(|low| low.highest);
            let mut b = wave(3.0);
            let solver = tangent.into_shifted(1.0).unwrap();
            let solved = solver.solve(&mut b, 1e-6, &mut ()).unwrap();
            assert!(solved.converged);
            (coupled, solved.iterations, b)
        };
        let shared = Arc::new(HarmonicTube::new(tube.clone()));
        let mut couplings = vec![];
        for harmonic in [2.0, 1.0, 0.0, 2.0, 1.0] {
            let u = match harmonic {
                0.0 => vec![0.0; tube.unknowns()],
                _ => wave(harmonic),
            };
            let alone = Arc::new(HarmonicTube::new(tube.clone()));
            let found = solved(&shared, &u);
            assert_eq!(found, solved(&alone, &u));
            couplings.push(found.0);
        }
        // A tilt needs fewer harmonics than an oval, a round tube none.
        assert_eq!(couplings, [Some(8), Some(4), None, Some(8), Some(4)]);
    }
}
