//! Stability test of an axisymmetric state by circumferential mode.

use super::mass::harmonic_mass;
use crate::equilibrium::TubeProblem;
use crate::matrix::{
    BlockBanded, CoupledBanded, Eigenpair, NoEigenpairs, lowest_eigenpairs,
    lowest_eigenpairs_excluding,
};
use crate::tube::Load;
use rayon::prelude::*;

/// An axisymmetric tube, with its contact if it has that, and the mass matrices and constraints of its circumferential modes.
#[derive(Clone, Debug)]
pub struct Harmonics {
    problem: TubeProblem,
    harmonics: Vec<Harmonic>,
}

#[derive(Clone, Debug)]
struct Harmonic {
    mass: BlockBanded,
    /// Degrees of freedom prescribed by the ends or by rigid-body constraints.
    prescribed: Vec<bool>,
}

/// Relative force up to which a rigid-body motion is neutral.
const NEUTRAL: f64 = 1e-7;

/// Stability of a state to one circumferential mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeStability {
    /// Number of negative eigenvalues: 0 if the state is stable. A singular block counts as one.
    pub negative: usize,
    /// Lowest eigenvalue with the mass of unit density, in E/D², without neutral rigid-body motions.
    pub lowest: f64,
}

impl Harmonics {
    /// Prepares modes 0 to `highest` of a tube of one ring, or as many as its control points around resolve.
    pub fn new(problem: &TubeProblem, highest: usize) -> Self {
        let tube = &problem.tube;
        let highest = highest.min((tube.sector.around - 1) / 2);
        let harmonic = |n| Harmonic {
            mass: harmonic_mass(tube, n),
            prescribed: tube.prescribed_in_harmonic(n),
        };
        Self {
            problem: problem.clone(),
            harmonics: (0..=highest).into_par_iter().map(harmonic).collect(),
        }
    }

    /// Returns the number of modes, including mode 0.
    pub fn count(&self) -> usize {
        self.harmonics.len()
    }

    /// Returns the number of negative eigenvalues of every mode at a state without twist.
    pub fn negative(&self, load: &Load, u: &[f64]) -> Vec<usize> {
        self.negative_from(0, load, u)
    }

    /// Returns the number of negative eigenvalues of every mode from the mode `first` on.
    pub fn negative_from(&self, first: usize, load: &Load, u: &[f64]) -> Vec<usize> {
        let harmonics = self.harmonics.par_iter().enumerate().skip(first);
        harmonics
            .map(|(n, harmonic)| harmonic.negative(self.block(n, load, u)))
            .collect()
    }

    /// Tests a state without twist for every mode.
    ///
    /// # Errors
    /// [`NoEigenpairs`] if a lowest eigenvalue is not found.
    pub fn test(&self, load: &Load, u: &[f64]) -> Result<Vec<ModeStability>, NoEigenpairs> {
        let test = |(n, harmonic): (usize, &Harmonic)| {
            let pairs = self.lowest(n, load, u, 1)?;
            Ok(ModeStability {
                negative: harmonic.negative(self.block(n, load, u)),
                lowest: pairs.first().map_or(f64::INFINITY, |pair| pair.value),
            })
        };
        self.harmonics.par_iter().enumerate().map(test).collect()
    }

    /// Returns the lowest eigenpairs of mode n at a state without twist, orthogonal to neutral rigid-body motions. A vector
    /// holds per control point the amplitudes (z, r, θ) of the displacement (z cos nφ, r cos nφ, −θ sin nφ); for
    /// n = 0 the displacement (z, r, θ) itself.
    ///
    /// # Errors
    /// [`NoEigenpairs`] if they are not found.
    pub fn lowest(
        &self,
        n: usize,
        load: &Load,
        u: &[f64],
        count: usize,
    ) -> Result<Vec<Eigenpair>, NoEigenpairs> {
        let Harmonic { mass, prescribed } = &self.harmonics[n];
        let block = self.block(n, load, u);
        let motions = self.problem.tube.rigid_motions_in_harmonic(u, n);
        let fixed = self.problem.tube.prescribed_at_ends();
        if motions
            .iter()
            .all(|motion| is_neutral(&block, &fixed, motion))
        {
            lowest_eigenpairs_excluding(&block, mass, &fixed, count, &motions)
        } else {
            lowest_eigenpairs(&block, mass, prescribed, count)
        }
    }

    fn block(&self, n: usize, load: &Load, u: &[f64]) -> CoupledBanded {
        self.problem.ring_tangent(load, u, n)
    }
}

/// Returns whether a rigid-body motion meets no force.
fn is_neutral(block: &CoupledBanded, fixed: &[bool], motion: &[f64]) -> bool {
    let mut force = vec![0.0; motion.len()];
    block.multiply_add(1.0, motion, &mut force);
    let (mut forces, mut size) = (0.0, 0.0);
    for i in (0..motion.len()).filter(|&i| !fixed[i]) {
        forces += force[i] * force[i];
        size += (block.band.entry(i, i) * motion[i]).powi(2);
    }
    forces <= NEUTRAL * NEUTRAL * size
}

impl Harmonic {
    /// Returns the number of negative eigenvalues of a block of the tangent.
    fn negative(&self, mut block: CoupledBanded) -> usize {
        block.constrain(&self.prescribed);
        block.factor().map_or(1, |factor| factor.negative_pivots())
    }
}
