//! The lowest eigenpairs of the tangent of a tube of several rings.

use super::TubeProblem;
use super::problem::TubeSolver;
use crate::monitor::Monitor;
use crate::solve::{Equilibrium, Lowest, Operator, Search, Tangent, lowest};
use crate::tube::Load;

impl TubeProblem {
    /// Returns the lowest eigenpairs of K x = ν C x on the free unknowns, with the tangent K of a state that is not
    /// inverted and the mass C of unit density (`RingDamping`), ν in E/D².
    ///
    /// Searches for `block` eigenpairs together, which should be more than wanted: the search slows down if the next
    /// eigenvalue is close, and nearly axisymmetric tubes have pairs of eigenvalues. It starts from smooth noise with a fixed
    /// seed, so that no symmetry hides a mode.
    ///
    /// Returns none for a tube of one ring, or if the preconditioner is singular.
    pub fn lowest_modes(
        &self,
        load: &Load,
        u: &[f64],
        block: usize,
        search: &Search,
        monitor: &mut dyn Monitor,
    ) -> Option<Lowest> {
        let system = self.tangent(load, u).into_shifted(0.0);
        let Ok(TubeSolver::Harmonic(system)) = system else {
            return None;
        };
        let mut noise = Noise::default();
        let mut seed = || {
            let force: Vec<f64> = u.iter().map(|_| noise.next()).collect();
            let mut smooth = vec![0.0; u.len()];
            system.precondition(&force, &mut smooth);
            smooth
        };
        let seeds: Vec<Vec<f64>> = (0..block).map(|_| seed()).collect();
        Some(lowest(&*system, &seeds, search, monitor))
    }
}

/// Pseudo-random numbers from −1 to 1, always the same (SplitMix64, Steele et al. 2014).
#[derive(Debug, Default)]
pub(super) struct Noise(u64);

impl Noise {
    /// Returns the next number.
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / (1_u64 << 63) as f64 - 1.0
    }
}
