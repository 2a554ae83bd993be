//! The tangent of a tube of several rings, without a matrix, and its solver: conjugate gradients with the harmonic
//! solver as preconditioner.

use super::buffers::Buffers;
use crate::assembly::{Friction, LowHarmonics, MatrixFreeTangent, RingDamping, SplineTube};
use crate::contact::{SelfContact, SurfaceContact, SurfaceTangent};
use crate::matrix::{BlockBanded, CoupledBanded, CoupledFactor, RankOne, Singular};
use crate::monitor::Monitor;
use crate::rings::{HarmonicSolver, LowHarmonicCorrection, Transform};
use crate::solve::{NegativeCurvature, Operator, Solved, Solver, Tangent, conjugate_gradients};
use crate::tube::Load;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Largest difference of displacements between rings of a state that counts as symmetric, in D.
const SYMMETRIC: f64 = 1e-9;

/// Smallest difference of displacements between rings from which low harmonics are coupled, in D.
const COUPLED: f64 = 1e-2;

/// The highest coupled harmonics of the cyclic sector, for states of mode 1 and of higher modes: four times the harmonic of
/// the state. An oval with an asymmetry of 0.24 D takes 111, 94, 61, 36 and 20 iterations with 1, 2, 4, 6 and 8
/// coupled harmonics; a tilt of 0.13 D takes 57, 36, 21, 20 and 20. The cost of the matrix grows with the third power.
const HIGHEST: [usize; 2] = [4, 8];

/// Smallest share of a harmonic in the waves of a state that counts as a harmonic of the state.
const SHARE: f64 = 0.1;

/// Largest number of iterations of a solve. The iterate reached then still is a descent direction.
const ITERATIONS: usize = 400;

/// A tube of several rings, and the data that its tangents share.
#[derive(Debug)]
pub struct HarmonicTube {
    tube: Arc<SplineTube>,
    contact: Option<Arc<SelfContact>>,
    damping: RingDamping,
    /// Low harmonics up to each of [`HIGHEST`], made when a state first needs them.
    low: [OnceLock<Arc<LowHarmonics>>; 2],
    /// Buffers of tangents, of blocks of harmonics, and of matrices of low harmonics.
    linearised: Buffers<MatrixFreeTangent>,
    blocks: Buffers<BlockBanded>,
    coupled: Buffers<BlockBanded>,
}

/// The tangent stiffness K of a state, without its matrix.
#[derive(Clone, Debug)]
pub struct HarmonicTangent {
    state: Arc<Linear>,
}

/// A linearised state. It returns its buffers to the tube when it is dropped.
#[derive(Debug)]
struct Linear {
    tube: Arc<HarmonicTube>,
    at: MatrixFreeTangent,
    /// Contact of the wall with itself, if it touches.
    contact: Option<SurfaceTangent>,
    /// The term of a driven volume of the lumen, and its average around the tube, of harmonic 0.
    term: Option<[RankOne; 2]>,
    /// True if the displacements are the same at every ring.
    symmetric: bool,
    /// The low harmonics that the state couples, if any.
    low: Option<Arc<LowHarmonics>>,
    /// The tangent on them, until a solver takes it.
    coupled: Option<CoupledBanded>,
}

/// K + α C on the free unknowns.
#[derive(Debug)]
pub struct HarmonicSystem {
    state: Arc<Linear>,
    alpha: f64,
    /// None only while `self` is dropped.
    preconditioner: Option<HarmonicSolver>,
    /// M⁻¹ g and 1 + κ g · M⁻¹ g of a driven volume, where the preconditioner M does not contain its term.
    beside: Option<(Vec<f64>, f64)>,
    /// Negative pivots of the averaged block of each harmonic of the cyclic sector.
    negative_pivots: Vec<usize>,
}

impl Drop for Linear {
    fn drop(&mut self) {
        self.tube.linearised.give(std::mem::take(&mut self.at));
        if let Some(coupled) = self.coupled.take() {
            self.tube.coupled.give(coupled.band);
        }
    }
}

impl Drop for HarmonicSystem {
    fn drop(&mut self) {
        let tube = &self.state.tube;
        if let Some(preconditioner) = self.preconditioner.take() {
            let (factors, coupling) = preconditioner.into_factors();
            for factor in factors {
                tube.blocks.give_some(factor.into_memory());
            }
            if let Some(coupling) = coupling {
                tube.coupled.give_some(coupling.coupled.into_memory());
            }
        }
    }
}

impl HarmonicTube {
    /// Prepares the tangents of a tube, with contact with itself if it has that.
    pub fn new(tube: Arc<SplineTube>, contact: Option<Arc<SelfContact>>) -> Self {
        Self {
            damping: tube.ring_damping(),
            tube,
            contact,
            low: Default::default(),
            linearised: Buffers::default(),
            blocks: Buffers::default(),
            coupled: Buffers::default(),
        }
    }

    /// Adds factor · C v to y.
    pub fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }

    /// Returns the tangent stiffness at a state, with friction if there is any.
    pub fn tangent(
        self: &Arc<Self>,
        load: &Load,
        u: &[f64],
        friction: Option<&Friction>,
        term: Option<RankOne>,
    ) -> HarmonicTangent {
        let mut at = self.linearised.take().unwrap_or_default();
        self.tube.linearise(load, u, &mut at);
        if let Some(friction) = friction {
            self.tube.add_friction_to(friction, load, u, &mut at);
        }
        let rings = u.chunks_exact(self.tube.sector.rings);
        let difference = |u: &[f64]| u.iter().fold(0.0_f64, |most, x| most.max((x - u[0]).abs()));
        let differs = rings.map(difference).fold(0.0, f64::max);
        // Sectors couple harmonics at axisymmetric states, too.
        let has_sectors = self.tube.tube.has_sectors();
        let low = (differs > COUPLED || has_sectors).then(|| self.low_harmonics(u));
        let touching = self.surface_contact();
        let touching = touching.and_then(|contact| Some((contact, contact.tangent(u)?)));
        let coupled = low.as_ref().map(|low| {
            let mut coupled = self.low_matrix(low);
            self.tube.low_harmonic_tangent(low, load, u, &mut coupled);
            if let Some(friction) = friction {
                self.tube
                    .add_low_harmonic_friction(low, friction, load, u, &mut coupled);
            }
            let mut coupled = CoupledBanded::from(coupled);
            if let Some((contact, _)) = &touching {
                contact.add_low_harmonics(u, low, &mut coupled);
            }
            coupled
        });
        HarmonicTangent {
            state: Arc::new(Linear {
                tube: self.clone(),
                at,
                contact: touching.map(|(_, tangent)| tangent),
                term: term.map(|term| {
                    let average = averaged(&term, self.tube.sector.rings);
                    [term, average]
                }),
                symmetric: differs <= SYMMETRIC && !has_sectors,
                low,
                coupled,
            }),
        }
    }

    fn surface_contact(&self) -> Option<&SurfaceContact> {
        match self.contact.as_deref() {
            Some(SelfContact::Surface(contact)) => Some(contact),
            _ => None,
        }
    }

    /// Returns the low harmonics that a state couples.
    fn low_harmonics(&self, u: &[f64]) -> Arc<LowHarmonics> {
        let mut shares = Transform::new(self.tube.sector.rings).dot_by_harmonic(u, u);
        shares[0] = 0.0;
        let all: f64 = shares.iter().sum();
        let own = shares.iter().rposition(|share| *share > SHARE * all);
        let which = usize::from(4 * own.unwrap_or(1) > HIGHEST[0]);
        let low = || Arc::new(LowHarmonics::new(&self.tube, HIGHEST[which]));
        self.low[which].get_or_init(low).clone()
    }

    /// Returns a buffer for a matrix of low harmonics.
    fn low_matrix(&self, low: &LowHarmonics) -> BlockBanded {
        let (rows, size, band) = (
            self.tube.axial.functions(),
            low.row_size(),
            self.tube.degree(),
        );
        let fits = self.coupled.take().filter(|matrix| matrix.size() == size);
        fits.unwrap_or_else(|| BlockBanded::zeros(rows, size, band))
    }

    /// Returns a buffer for the block of a harmonic.
    fn block(&self) -> BlockBanded {
        let (rows, points) = (self.tube.axial.functions(), self.tube.wall.functions());
        let new = || BlockBanded::zeros(rows, 3 * points, self.tube.degree());
        self.blocks.take().unwrap_or_else(new)
    }
}

impl HarmonicTangent {
    /// Returns the number of unknowns per row of the matrix of low harmonics, for a number of rings.
    pub fn low_row(rings: usize) -> usize {
        9 * (2 * HIGHEST[1].min(LowHarmonics::highest_resolved(rings)) + 1)
    }
}

impl Tangent for HarmonicTangent {
    type Solver = HarmonicSystem;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.state.add_product(factor, v, y);
    }

    fn shifted(&self, alpha: f64) -> Result<HarmonicSystem, Singular> {
        let Linear {
            tube, low, coupled, ..
        } = &*self.state;
        let copy = low.as_deref().zip(coupled.as_ref()).map(|(low, coupled)| {
            let mut band = tube.low_matrix(low);
            band.copy_from(&coupled.band);
            let far = coupled.far.clone();
            let term = None;
            CoupledBanded { band, far, term }
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
    /// Prepares K + α C for solving, with the tangent on low harmonics if they are coupled.
    fn system(
        &self,
        alpha: f64,
        coupled: Option<CoupledBanded>,
    ) -> Result<HarmonicSystem, Singular> {
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
                low.add_damping(&tube.tube, &tube.damping, alpha, &mut matrix.band);
            }
            let prescribed = low.prescribed(&tube.tube);
            matrix.constrain(&prescribed);
            let mut coupled = matrix.factor()?;
            coupled.make_positive();
            preconditioner = preconditioner.with_correction(LowHarmonicCorrection {
                highest: low.highest,
                through: low.through.clone(),
                coupled,
                prescribed,
                averaged: averaged.into_iter().flatten().collect(),
            });
        }
        let term = self.state.term.as_ref();
        let beside = term.filter(|_| self.state.low.is_some()).map(|[term, _]| {
            let mut g = term.clone();
            g.constrain(tube.tube.prescribed());
            let solution = preconditioner.solve(&g.vector);
            let denominator = 1.0 + g.factor * dot(&g.vector, &solution);
            (solution, denominator)
        });
        Ok(HarmonicSystem {
            state: self.state.clone(),
            alpha,
            negative_pivots,
            beside,
            preconditioner: Some(preconditioner),
        })
    }
}

/// Returns harmonic 0 of the average of a term over the rotations and mirror images of k rings: k κ ḡ ḡᵀ with the mean ḡ of
/// the rings, without its circumferential components.
fn averaged(term: &RankOne, rings: usize) -> RankOne {
    let k = rings as f64;
    let mean = |(i, rings): (usize, &[f64])| match i % 3 {
        2 => 0.0,
        _ => rings.iter().sum::<f64>() / k,
    };
    RankOne {
        factor: k * term.factor,
        vector: term
            .vector
            .chunks_exact(rings)
            .enumerate()
            .map(mean)
            .collect(),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The factored block of a harmonic, made positive definite by additional damping if needed.
struct Block {
    factor: CoupledFactor,
    /// Negative pivots of the block without the additional damping.
    negative_pivots: usize,
    /// The block on the functions through the wall of the coupled harmonics, if the harmonic is coupled.
    averaged: Option<CoupledFactor>,
}

/// First additional damping to make a block positive definite, and its growth factor.
const SHIFT: (f64, f64) = (1e-3, 4.0);

impl Linear {
    /// Adds factor · K v to y.
    fn add_product(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        let tube = &self.tube;
        tube.tube.add_tangent_product(&self.at, factor, v, y);
        if let (Some(contact), Some(tangent)) = (tube.surface_contact(), &self.contact) {
            contact.add_product(tangent, factor, v, y);
        }
        if let Some([term, _]) = &self.term {
            term.multiply_add(factor, v, y);
        }
    }

    /// Factors K_n + α C_n of the averaged tangent, for harmonic n of the cyclic sector.
    fn block(&self, n: usize, alpha: f64) -> Result<Block, Singular> {
        let (tube, waves) = (&self.tube.tube, n * self.waves());
        let prescribed = tube.prescribed_in_harmonic(waves);
        let term = self
            .term
            .as_ref()
            .filter(|_| n == 0)
            .map(|[_, average]| average);
        let factored_with = |term: Option<&RankOne>, alpha: f64| {
            let mut block = self.tube.block();
            self.at.average.harmonic_into(waves, &mut block);
            if alpha != 0.0 {
                self.tube.damping.add_harmonic(alpha, waves, &mut block);
            }
            let mut block = CoupledBanded::from(block);
            if let Some(contact) = &self.contact {
                contact.add_harmonic(n, &mut block);
            }
            let averaged = self
                .low
                .as_deref()
                .filter(|low| n <= low.highest)
                .map(|low| self.averaged(low, n, &block))
                .transpose()?;
            block.term = term.cloned();
            block.constrain(&prescribed);
            Ok((block.factor()?, averaged))
        };
        let pivots = |factored: &Result<(CoupledFactor, _), Singular>| {
            factored
                .as_ref()
                .map_or(1, |(factor, _)| factor.negative_pivots())
        };
        let mut found = factored_with(term, alpha);
        // A singular block is at the limit of stability and counts as unstable; for a state that is not
        // symmetric it proves nothing.
        let negative_pivots = match &found {
            Err(_) if !self.symmetric => 0,
            found => pivots(found),
        };
        // The correction on low harmonics does not know the term, which is then added beside.
        let term = term.filter(|_| self.low.is_none());
        let factored = |alpha: f64| factored_with(term, alpha);
        if self.low.is_some() && n == 0 && self.term.is_some() {
            found = factored(alpha);
        }
        let mut shift = 0.0;
        while pivots(&found) > 0 && shift < 1e6 {
            if let Ok((factor, _)) = found {
                self.tube.blocks.give_some(factor.into_memory());
            }
            shift = f64::max(shift * SHIFT.1, SHIFT.0);
            found = factored(alpha + shift);
        }
        let (mut factor, averaged) = found?;
        // The pivots that are still negative.
        factor.make_positive();
        Ok(Block {
            factor,
            negative_pivots,
            averaged,
        })
    }

    /// Returns the circumferential mode of the whole tube of harmonic 1 of the cyclic sector.
    fn waves(&self) -> usize {
        let sector = &self.tube.tube.sector;
        sector.around / sector.rings
    }

    /// Projects a block without boundary conditions on the functions through the wall of the low harmonics, and factors it.
    fn averaged(
        &self,
        low: &LowHarmonics,
        n: usize,
        block: &CoupledBanded,
    ) -> Result<CoupledFactor, Singular> {
        let band = &block.band;
        let band = BlockBanded::zeros(band.blocks(), 3 * low.functions(), band.band());
        let mut matrix = CoupledBanded::from(band);
        let place = |(c, i): (usize, usize)| 3 * c + i;
        let places = |row, column| (place(row), place(column));
        low.project(&block.band, places, &mut matrix.band);
        low.project_far(&block.far, &mut matrix.far);
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
        let tube = &self.state.tube;
        out.fill(0.0);
        self.state.add_product(1.0, v, out);
        if self.alpha != 0.0 {
            tube.damping(self.alpha, v, out);
        }
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        match &self.preconditioner {
            Some(preconditioner) => out.copy_from_slice(&preconditioner.solve(r)),
            None => out.copy_from_slice(r),
        }
        if let (Some([term, _]), Some((solution, denominator))) = (&self.state.term, &self.beside) {
            // Sherman and Morrison (1950). Prescribed entries of r are zero.
            let part = term.factor * dot(solution, r) / denominator;
            out.iter_mut()
                .zip(solution)
                .for_each(|(x, w)| *x -= part * w);
        }
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.state.tube.damping(1.0, v, out);
    }
}

impl HarmonicSystem {
    /// Returns the number of negative eigenvalues of harmonics 0, 1, … of the cyclic sector for a symmetric state; none for any
    /// other, whose tangent does not separate into harmonics. For a twisted tube, or one with imperfect geometry or
    /// muscles, they are those of the averaged tangent: if it has any, the tangent has at least one.
    pub fn negative_in_harmonics(&self) -> Option<&[usize]> {
        self.state.symmetric.then_some(&self.negative_pivots)
    }

    /// Returns whether the average of the tangent around the tube is indefinite. Then the tangent is indefinite, too: the
    /// average is the mean of the tangents rotated to every ring and mirrored, and the boundary conditions do not
    /// change under rotation and mirroring.
    ///
    /// If the volume of the lumen is driven, only harmonic 0 of the average contains its term, and the others prove
    /// nothing if the state is not axisymmetric.
    pub fn average_is_indefinite(&self) -> bool {
        let proving = match self.state.term {
            Some(_) if !self.state.symmetric => 1,
            _ => self.negative_pivots.len(),
        };
        self.negative_pivots[..proving]
            .iter()
            .any(|negative| *negative > 0)
    }
}

impl Solver for HarmonicSystem {
    fn negative_pivots(&self) -> usize {
        self.negative_in_harmonics()
            .map_or(0, |harmonics| harmonics[0])
    }

    /// A symmetric state stays symmetric even if it is unstable to other harmonics.
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
    use crate::tube::{Mesh, Support, Tube, WallLayer};

    #[test]
    fn reused_buffers_do_not_change_results() {
        let tube = Tube {
            length: 1.0,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.4,
            )))],
            muscles: vec![],
            ends: [Support::Fixed; 2],
            imperfections: vec![],
            obstacles: vec![],
            patches: vec![],
            foundations: vec![],
        };
        let mesh = Mesh {
            axial: 8,
            around: 36,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
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
            let tangent = on.tangent(&load, u, None, None);
            let coupled = tangent.state.low.as_ref().map(|low| low.highest);
            let mut b = wave(3.0);
            let solver = tangent.into_shifted(1.0).unwrap();
            let solved = solver.solve(&mut b, 1e-6, &()).unwrap();
            assert!(solved.converged);
            (coupled, solved.iterations, b)
        };
        let shared = Arc::new(HarmonicTube::new(tube.clone(), None));
        let mut couplings = vec![];
        for harmonic in [2.0, 1.0, 0.0, 2.0, 1.0] {
            let u = match harmonic {
                0.0 => vec![0.0; tube.unknowns()],
                _ => wave(harmonic),
            };
            let alone = Arc::new(HarmonicTube::new(tube.clone(), None));
            let found = solved(&shared, &u);
            assert_eq!(found, solved(&alone, &u));
            couplings.push(found.0);
        }
        // A tilt needs fewer coupled harmonics than an oval, an axisymmetric tube none.
        assert_eq!(couplings, [Some(8), Some(4), None, Some(8), Some(4)]);
    }
}
