//! The tangent of an axisymmetric state, harmonic by harmonic.

use super::mass::harmonic_mass;
use crate::assembly::SplineTube;
use crate::matrix::{
    BlockBanded, Eigenpair, NoEigenpairs, lowest_eigenpairs, lowest_eigenpairs_excluding,
};
use crate::tube::Load;
use rayon::prelude::*;

/// An axisymmetric tube and what its harmonics 0 to N weigh and where they are held.
#[derive(Clone, Debug)]
pub struct Harmonics<'a> {
    tube: &'a SplineTube,
    harmonics: Vec<Harmonic>,
}

#[derive(Clone, Debug)]
struct Harmonic {
    mass: BlockBanded,
    /// Held by the ends, or pinned against a rigid motion.
    prescribed: Vec<bool>,
}

/// Residual, over the mean size of the tangent, up to which a rigid motion meets no force.
const NEUTRAL: f64 = 1e-7;

/// What is known of one harmonic at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tested {
    /// Negative eigenvalues: 0 where the state is stable to it. A singular block counts as one.
    pub negative: usize,
    /// The lowest eigenvalue of the tangent over the mass of unit density, in E/D². Rigid motions
    /// that the ends leave, and that meet no force, are not counted.
    pub lowest: f64,
}

impl<'a> Harmonics<'a> {
    /// Of a tube that is solved for as one ring; harmonics beyond those that its rings can tell
    /// apart are left out.
    pub fn new(tube: &'a SplineTube, highest: usize) -> Self {
        let highest = highest.min((tube.sector.around - 1) / 2);
        let harmonic = |n| Harmonic {
            mass: harmonic_mass(tube, n),
            prescribed: tube.prescribed_in_harmonic(n),
        };
        Self {
            tube,
            harmonics: (0..=highest).into_par_iter().map(harmonic).collect(),
        }
    }

    /// How many there are, 0 included.
    pub fn count(&self) -> usize {
        self.harmonics.len()
    }

    /// Negative eigenvalues of every harmonic at a state without twist.
    pub fn negative(&self, load: &Load, u: &[f64]) -> Vec<usize> {
        let harmonics = self.harmonics.par_iter().enumerate();
        harmonics
            .map(|(n, harmonic)| harmonic.negative(self.block(n, load, u)))
            .collect()
    }

    /// Every harmonic at a state without twist.
    ///
    /// # Errors
    /// [`NoEigenpairs`] where a lowest eigenvalue cannot be found.
    pub fn test(&self, load: &Load, u: &[f64]) -> Result<Vec<Tested>, NoEigenpairs> {
        let test = |(n, harmonic): (usize, &Harmonic)| {
            let pairs = self.lowest(n, load, u, 1)?;
            Ok(Tested {
                negative: harmonic.negative(self.block(n, load, u)),
                lowest: pairs.first().map_or(f64::INFINITY, |pair| pair.value),
            })
        };
        self.harmonics.par_iter().enumerate().map(test).collect()
    }

    /// The lowest eigenpairs of harmonic n at a state without twist, beside rigid motions that the
    /// ends leave. A vector holds, for every
    /// control point, the amplitudes (z, r, θ) of a displacement (z cos nφ, r cos nφ, −θ sin nφ);
    /// for n = 0 the displacement (z, r, θ) itself.
    ///
    /// # Errors
    /// [`NoEigenpairs`] if they cannot be found.
    pub fn lowest(
        &self,
        n: usize,
        load: &Load,
        u: &[f64],
        count: usize,
    ) -> Result<Vec<Eigenpair>, NoEigenpairs> {
        let Harmonic { mass, prescribed } = &self.harmonics[n];
        let block = self.block(n, load, u);
        let motions = self.tube.rigid_motions_in_harmonic(u, n);
        let held = self.tube.prescribed_at_ends();
        if motions
            .iter()
            .all(|motion| is_neutral(&block, &held, motion))
        {
            lowest_eigenpairs_excluding(&block, mass, &held, count, &motions)
        } else {
            lowest_eigenpairs(&block, mass, prescribed, count)
        }
    }

    fn block(&self, n: usize, load: &Load, u: &[f64]) -> BlockBanded {
        match n {
            0 => self.tube.tangent(load, u),
            n => self.tube.tangent_in_harmonic(load, u, n),
        }
    }
}

/// Whether a motion meets no force.
fn is_neutral(block: &BlockBanded, held: &[bool], motion: &[f64]) -> bool {
    let mut force = vec![0.0; motion.len()];
    block.multiply_add(1.0, motion, &mut force);
    let (mut forces, mut size) = (0.0, 0.0);
    for i in (0..motion.len()).filter(|&i| !held[i]) {
        forces += force[i] * force[i];
        size += (block.entry(i, i) * motion[i]).powi(2);
    }
    forces <= NEUTRAL * NEUTRAL * size
}

impl Harmonic {
    /// Negative eigenvalues of its block of the tangent.
    fn negative(&self, mut block: BlockBanded) -> usize {
        block.constrain(&self.prescribed);
        block.factor().map_or(1, |factor| factor.negative_pivots())
    }
}
