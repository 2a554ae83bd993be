//! A spline tube as the solver sees it.

use crate::assembly::{Inverted, SplineTube};
use crate::matrix::BlockBanded;
use crate::solve::{Balance, Direct, Equilibrium};
use crate::tube::{Load, Tube};
use std::f64::consts::PI;
use std::sync::Arc;

/// The equilibrium of a spline tube under muscles and moved ends.
#[derive(Clone, Debug)]
pub struct TubeProblem {
    /// The tube.
    pub tube: SplineTube,
    drag: Arc<BlockBanded>,
    given: Arc<[bool]>,
    /// Reference volume of the sector.
    volume: f64,
    /// Forces in play that a tube at rest is credited with, so that what rounding leaves of it
    /// (some 1e-17 times the stiffness of the wall) is small against them.
    at_rest: f64,
}

impl TubeProblem {
    /// Puts a tube before the solver.
    pub fn new(tube: SplineTube) -> Self {
        let at_rest = 3e-11 * tube.tube.material.longitudinal_modulus();
        let (outer, inner) = (Tube::OUTER_RADIUS, tube.tube.inner_radius());
        Self {
            drag: Arc::new(tube.drag()),
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
    type Tangent = Direct;

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
        let forces = self.tube.forces(load, u)?;
        // The solver sees one sector: its energy is that whose derivative the residual is.
        let energy = forces.energy / self.tube.sector.repeats();
        Ok(Balance {
            energy,
            residual: forces.residual,
            in_play: forces.in_play.max(self.at_rest),
            // Every point adds an energy density of rounding size.
            rounding: 4.0 * f64::EPSILON * self.volume + 1e-13 * energy.abs(),
        })
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> Direct {
        let stiffness = self.tube.tangent(load, u);
        Direct::new(stiffness, self.drag.clone(), self.given.clone())
    }
    fn drag(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.drag.multiply_add(factor, v, y);
    }
}
