//! Friction in a load step of a tube.

use crate::assembly::{Friction, ObstacleFriction, SplineTube, StepStart};
use crate::tube::Load;

/// A load step with friction: the state from which it begins, and the friction of a state.
#[derive(Clone, Debug)]
pub struct FrictionStep {
    start: StepStart,
    /// Energy that friction on each obstacle has dissipated up to the start.
    dissipated: Vec<f64>,
    friction: Friction,
}

impl FrictionStep {
    /// Begins a step at a state with its history, which is empty at the first state.
    pub fn begin(tube: &SplineTube, load: &Load, u: &[f64], history: &[f64]) -> Self {
        let obstacles = tube.tube.obstacles.len();
        let (dissipated, slips) = history.split_at_checked(obstacles).unwrap_or_default();
        let start = StepStart {
            load: load.clone(),
            u: u.to_vec(),
            slips: slips.to_vec(),
        };
        let mut all = dissipated.to_vec();
        all.resize(obstacles, 0.0);
        Self {
            friction: tube.friction(&start, load, u),
            dissipated: all,
            start,
        }
    }

    /// Takes the normal forces and tangent planes from a state.
    pub fn update(&mut self, tube: &SplineTube, load: &Load, u: &[f64]) {
        self.friction = tube.friction(&self.start, load, u);
    }

    /// Returns the history of a state that ends the step: the energy dissipated on each obstacle, and the elastic slips.
    pub fn history(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Vec<f64> {
        let on = self.on_obstacles(tube, load, u);
        let mut history: Vec<f64> = on.iter().map(|friction| friction.dissipated).collect();
        history.extend(tube.elastic_slips(&self.friction, load, u));
        history
    }

    /// Returns the friction of a state on each obstacle, with the energy that it has dissipated since the first state.
    pub fn on_obstacles(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> Vec<ObstacleFriction> {
        let mut on = tube.friction_on_obstacles(&self.friction, load, u);
        for (friction, before) in on.iter_mut().zip(&self.dissipated) {
            friction.dissipated += before;
        }
        on
    }

    /// Returns the friction.
    pub fn friction(&self) -> &Friction {
        &self.friction
    }
}
