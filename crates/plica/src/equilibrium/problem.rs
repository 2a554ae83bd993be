//! A spline tube as a problem for the solver.

use super::harmonic_tangent::{HarmonicSystem, HarmonicTangent, HarmonicTube};
use crate::assembly::{Inverted, SplineTube};
use crate::matrix::{BlockBanded, Factor, Singular};
use crate::monitor::Monitor;
use crate::solve::{
    Direct, Equilibrium, NegativeCurvature, ResidualEvaluation, Solved, Solver, Tangent,
};
use crate::tube::{Load, Tube};
use std::f64::consts::PI;
use std::sync::Arc;

/// The equilibrium of a spline tube under muscles, moved ends and pressures.
#[derive(Clone, Debug)]
pub struct TubeProblem {
    /// The tube.
    pub tube: Arc<SplineTube>,
    rings: Rings,
    prescribed: Arc<[bool]>,
    /// Reference volume of the cyclic sector.
    volume: f64,
    /// Smallest residual scale. The rounding errors of a tube at rest, about 1e-17 times the stiffness of the wall, are small
    /// relative to it.
    at_rest: f64,
}

/// The assembled damping matrix of one ring, or the shared data of the tangents of several rings.
#[derive(Clone, Debug)]
enum Rings {
    One(Arc<BlockBanded>),
    Many(Arc<HarmonicTube>),
}

/// The tangent stiffness of a tube: assembled for one ring, matrix-free for several.
#[derive(Clone, Debug)]
pub enum TubeTangent {
    /// One ring.
    Direct(Direct),
    /// Several rings.
    Harmonic(HarmonicTangent),
}

/// The solver of a [`TubeTangent`].
#[derive(Debug)]
pub enum TubeSolver {
    /// One ring.
    Direct(Factor),
    /// Several rings.
    Harmonic(HarmonicSystem),
}

impl TubeProblem {
    /// Makes the problem of a tube.
    pub fn new(tube: SplineTube) -> Self {
        let at_rest = 3e-11 * tube.tube.material.longitudinal_modulus();
        let (outer, inner) = (Tube::OUTER_RADIUS, tube.tube.inner_radius());
        let tube = Arc::new(tube);
        Self {
            rings: if tube.sector.rings == 1 {
                Rings::One(Arc::new(tube.damping()))
            } else {
                Rings::Many(Arc::new(HarmonicTube::new(tube.clone())))
            },
            prescribed: tube.prescribed().into(),
            volume: PI * (outer * outer - inner * inner) * tube.tube.length / tube.sector.repeats(),
            at_rest,
            tube,
        }
    }
}

impl Equilibrium for TubeProblem {
    type Load = Load;
    type EvaluationError = Inverted;
    type Tangent = TubeTangent;

    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn apply_prescribed(&self, load: &Load, u: &mut [f64]) {
        self.tube.apply_prescribed(load, u);
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        from.towards(to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<ResidualEvaluation, Inverted> {
        let mut forces = self.tube.forces(load, u)?;
        self.tube.project_out_constraints(&mut forces.residual);
        // The energy of one cyclic sector, whose derivative is the residual.
        let [strain, energy] =
            [forces.energy, forces.potential].map(|x| x / self.tube.sector.repeats());
        Ok(ResidualEvaluation {
            energy,
            residual: forces.residual,
            residual_scale: forces.residual_scale.max(self.at_rest),
            // Every quadrature point adds a rounding error of its energy density.
            rounding: 4.0 * f64::EPSILON * self.volume + 1e-13 * strain.abs().max(energy.abs()),
        })
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> TubeTangent {
        match &self.rings {
            Rings::One(damping) => {
                let stiffness = self.tube.tangent(load, u);
                TubeTangent::Direct(Direct::new(
                    stiffness,
                    damping.clone(),
                    self.prescribed.clone(),
                ))
            }
            Rings::Many(tube) => TubeTangent::Harmonic(tube.tangent(load, u)),
        }
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        match &self.rings {
            Rings::One(damping) => damping.multiply_add(factor, v, y),
            Rings::Many(tube) => {
                let mut force = vec![0.0; v.len()];
                tube.damping(factor, v, &mut force);
                self.tube.project_out_constraints(&mut force);
                y.iter_mut().zip(&force).for_each(|(y, f)| *y += f);
            }
        }
    }
}

impl Tangent for TubeTangent {
    type Solver = TubeSolver;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        match self {
            Self::Direct(tangent) => tangent.multiply_add(factor, v, y),
            Self::Harmonic(tangent) => tangent.multiply_add(factor, v, y),
        }
    }
    fn shifted(&self, alpha: f64) -> Result<TubeSolver, Singular> {
        match self {
            Self::Direct(tangent) => tangent.shifted(alpha).map(TubeSolver::Direct),
            Self::Harmonic(tangent) => tangent.shifted(alpha).map(TubeSolver::Harmonic),
        }
    }
    fn into_shifted(self, alpha: f64) -> Result<TubeSolver, Singular> {
        match self {
            Self::Direct(tangent) => tangent.into_shifted(alpha).map(TubeSolver::Direct),
            Self::Harmonic(tangent) => tangent.into_shifted(alpha).map(TubeSolver::Harmonic),
        }
    }
}

impl Solver for TubeSolver {
    fn negative_pivots(&self) -> usize {
        match self {
            Self::Direct(factor) => Solver::negative_pivots(factor),
            Self::Harmonic(system) => system.negative_pivots(),
        }
    }
    fn is_unstable(&self) -> bool {
        match self {
            Self::Direct(factor) => factor.is_unstable(),
            Self::Harmonic(system) => system.is_unstable(),
        }
    }
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        match self {
            Self::Direct(factor) => Solver::solve(factor, b, accuracy, monitor),
            Self::Harmonic(system) => system.solve(b, accuracy, monitor),
        }
    }
}
