//! A spline tube as the solver sees it.

use super::harmonic_tangent::{HarmonicSystem, HarmonicTangent, HarmonicTube};
use crate::assembly::{Inverted, SplineTube};
use crate::matrix::{BlockBanded, Factor, Singular};
use crate::solve::{
    Balance, Direct, Equilibrium, NegativeCurvature, Solved, Solver, Tangent, Watch,
};
use crate::tube::{Load, Tube};
use std::f64::consts::PI;
use std::sync::Arc;

/// The equilibrium of a spline tube under muscles and moved ends.
#[derive(Clone, Debug)]
pub struct TubeProblem {
    /// The tube.
    pub tube: Arc<SplineTube>,
    rings: Rings,
    given: Arc<[bool]>,
    /// Reference volume of the sector.
    volume: f64,
    /// Forces in play that a tube at rest is credited with, so that what rounding leaves of it
    /// (some 1e-17 times the stiffness of the wall) is small against them.
    at_rest: f64,
}

/// The drag matrix of one ring, assembled as its tangents are; or what the tangents of many share.
#[derive(Clone, Debug)]
enum Rings {
    One(Arc<BlockBanded>),
    Many(Arc<HarmonicTube>),
}

/// The tangent stiffness of a tube: assembled and factored for one ring, without a matrix for more.
#[derive(Clone, Debug)]
pub enum TubeTangent {
    /// For one ring.
    Direct(Direct),
    /// For more.
    Harmonic(HarmonicTangent),
}

/// What solves with a [`TubeTangent`].
#[derive(Debug)]
pub enum TubeSolver {
    /// For one ring.
    Direct(Factor),
    /// For more.
    Harmonic(HarmonicSystem),
}

impl TubeProblem {
    /// Puts a tube before the solver.
    pub fn new(tube: SplineTube) -> Self {
        let at_rest = 3e-11 * tube.tube.material.longitudinal_modulus();
        let (outer, inner) = (Tube::OUTER_RADIUS, tube.tube.inner_radius());
        let tube = Arc::new(tube);
        Self {
            rings: if tube.sector.rings == 1 {
                Rings::One(Arc::new(tube.drag()))
            } else {
                Rings::Many(Arc::new(HarmonicTube::new(tube.clone())))
            },
            given: tube.given().into(),
            volume: PI * (outer * outer - inner * inner) * tube.tube.length / tube.sector.repeats(),
            at_rest,
            tube,
        }
    }
}

impl Equilibrium for TubeProblem {
    type Load = Load;
    type Broken = Inverted;
    type Tangent = TubeTangent;

    fn given(&self) -> &[bool] {
        &self.given
    }
    fn impose(&self, load: &Load, u: &mut [f64]) {
        self.tube.impose(load, u);
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        from.towards(to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<Balance, Inverted> {
        let mut forces = self.tube.forces(load, u)?;
        self.tube.take_out_pins(&mut forces.residual);
        // The solver sees one sector: its energy is that whose derivative the residual is.
        let [strain, energy] =
            [forces.energy, forces.potential].map(|x| x / self.tube.sector.repeats());
        Ok(Balance {
            energy,
            residual: forces.residual,
            in_play: forces.in_play.max(self.at_rest),
            // Every point adds an energy density of rounding size.
            rounding: 4.0 * f64::EPSILON * self.volume + 1e-13 * strain.abs().max(energy.abs()),
        })
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> TubeTangent {
        match &self.rings {
            Rings::One(drag) => {
                let stiffness = self.tube.tangent(load, u);
                TubeTangent::Direct(Direct::new(stiffness, drag.clone(), self.given.clone()))
            }
            Rings::Many(tube) => TubeTangent::Harmonic(tube.tangent(load, u)),
        }
    }
    fn drag(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        match &self.rings {
            Rings::One(drag) => drag.multiply_add(factor, v, y),
            Rings::Many(tube) => {
                let mut force = vec![0.0; v.len()];
                tube.drag(factor, v, &mut force);
                self.tube.take_out_pins(&mut force);
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
    fn leads_away(&self) -> bool {
        match self {
            Self::Direct(factor) => factor.leads_away(),
            Self::Harmonic(system) => system.leads_away(),
        }
    }
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        watch: &mut dyn Watch,
    ) -> Result<Solved, NegativeCurvature> {
        match self {
            Self::Direct(factor) => Solver::solve(factor, b, accuracy, watch),
            Self::Harmonic(system) => system.solve(b, accuracy, watch),
        }
    }
}
