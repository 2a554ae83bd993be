//! The path of a spring that drags a slider: its energy changes from step to step.

use super::tests::{BehindTheWall, matrix};
use super::*;
use crate::assembly::Slip;
use crate::matrix::BlockBanded;
use std::sync::Arc;

/// Largest elastic slip.
const ELASTIC: f64 = 1e-3;

/// A unit spring from a slider at u to an end at the load. The friction of the slider has the limit 0.2 + 0.1 u.
#[derive(Clone)]
struct Slider {
    unit: Arc<BlockBanded>,
    /// Place that the slider is tied to, and limit of the step.
    anchor: f64,
    limit: f64,
}

impl Slider {
    fn new() -> Self {
        Self {
            unit: Arc::new(matrix([[1.0]])),
            anchor: 0.0,
            limit: 0.0,
        }
    }

    fn slip(&self, u: &[f64]) -> f64 {
        u[0] - self.anchor
    }
}

impl Equilibrium for Slider {
    type Load = f64;
    type EvaluationError = BehindTheWall;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &[false]
    }
    fn apply_prescribed(&self, _: &f64, _: &mut [f64]) {}
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, BehindTheWall> {
        let (stretch, slip) = (u[0] - load, self.slip(u));
        let law = Slip::at(slip.abs(), ELASTIC);
        Ok(ResidualEvaluation {
            energy: 0.5 * stretch * stretch + self.limit * law.energy,
            residual: vec![stretch + self.limit * law.secant * slip],
            residual_scale: 1.0,
            rounding: 1e-15,
        })
    }
    fn tangent(&self, _: &f64, u: &[f64]) -> Direct {
        let slip = self.slip(u);
        let law = Slip::at(slip.abs(), ELASTIC);
        let k = self.limit * (law.secant + slip * slip * law.second);
        let prescribed = self.prescribed().into();
        Direct::new(matrix([[1.0 + k]]), self.unit.clone(), prescribed)
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.unit.multiply_add(factor, v, y);
    }
    fn begin_step(&mut self, load: &f64, u: &[f64], history: &[f64]) {
        self.anchor = u[0] - history.first().unwrap_or(&0.0);
        self.update(load, u);
    }
    fn update(&mut self, _: &f64, u: &[f64]) -> bool {
        self.limit = 0.2 + 0.1 * u[0];
        true
    }
    fn history(&self, _: &f64, u: &[f64]) -> Vec<f64> {
        vec![self.slip(u).clamp(-ELASTIC, ELASTIC)]
    }
}

/// Returns the states of a path there and back, and of one that is resumed after each of them.
fn there_and_back(settings: &Settings) -> Vec<f64> {
    let mut path = Path::begin(Slider::new(), 0.0, vec![0.0], settings.clone()).unwrap();
    let (mut states, mut from) = (vec![], 0.0);
    for to in [1.0, -1.0] {
        path.begin_segment(to);
        for n in 1..=8 {
            let t = f64::from(n) / 8.0;
            let mut resumed = Path::resume(
                Slider::new(),
                Segment::between(from, to),
                path.state().load,
                path.state().u.clone(),
                path.continuation_state(),
                settings.clone(),
            )
            .unwrap();
            path.advance(t, &mut ()).unwrap();
            resumed.advance(t, &mut ()).unwrap();
            assert_eq!(path.state().u, resumed.state().u);
            assert!(path.state().in_equilibrium());
            states.push(path.state().u[0]);
        }
        from = to;
    }
    states
}

#[test]
fn a_slider_sticks_and_slides_with_the_friction_of_its_own_place() {
    let pseudo_time = Settings {
        scheme: Scheme::PseudoTime(PseudoTime {
            integrator: Integrator::BackwardEuler,
            damping: 1.0,
            ramp: 2,
            tolerance: 1e-9,
            max_steps: 200,
            equilibrate: true,
        }),
        ..Settings::default()
    };
    for settings in [Settings::default(), pseudo_time] {
        let states = there_and_back(&settings);
        // load − u = ±(0.2 + 0.1 u) where it slides; else it stays.
        let ahead = |load: f64| (load - 0.2) / 1.1;
        let back = |load: f64| (load + 0.2) / 0.9;
        assert!(states[0] > 0.0 && states[0] < ELASTIC, "{states:?}");
        for (i, u) in states.iter().enumerate() {
            let load = if i < 8 {
                (i + 1) as f64 / 8.0
            } else {
                1.0 - (i - 7) as f64 / 4.0
            };
            let expected = match i {
                0 => continue,
                1..8 => ahead(load),
                // It sticks while the force turns.
                8 | 9 => {
                    assert!((u - states[7]).abs() < 2.0 * ELASTIC);
                    continue;
                }
                _ => back(load),
            };
            assert!((u - expected).abs() < 2e-6, "{i}: {u} {expected}");
        }
    }
}
