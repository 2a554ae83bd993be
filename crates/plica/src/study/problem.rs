//! A spline tube as the solver sees it.

use crate::assembly::{Inverted, SplineTube};
use crate::matrix::BlockBanded;
use crate::solve::{Equilibrium, Forces};
use crate::tube::Load;

/// The equilibrium of a spline tube under muscles and moved ends.
#[derive(Clone, Debug)]
pub struct TubeProblem {
    /// The tube.
    pub tube: SplineTube,
    drag: BlockBanded,
}

impl TubeProblem {
    /// Puts a tube before the solver.
    pub fn new(tube: SplineTube) -> Self {
        Self {
            drag: tube.drag(),
            tube,
        }
    }
}

impl Equilibrium for TubeProblem {
    type Load = Load;
    type Broken = Inverted;

    fn given(&self) -> &[bool] {
        self.tube.given()
    }
    fn impose(&self, load: &Load, u: &mut [f64]) {
        self.tube.impose(load, u);
    }
    fn between(&self, from: &Load, to: &Load, t: f64) -> Load {
        from.towards(to, t)
    }
    fn forces(&self, load: &Load, u: &[f64]) -> Result<Forces, Inverted> {
        let forces = self.tube.forces(load, u)?;
        Ok(Forces {
            energy: forces.energy,
            residual: forces.residual,
            in_play: forces.in_play,
        })
    }
    fn tangent(&self, load: &Load, u: &[f64]) -> BlockBanded {
        self.tube.tangent(load, u)
    }
    fn drag(&self) -> &BlockBanded {
        &self.drag
    }
}
