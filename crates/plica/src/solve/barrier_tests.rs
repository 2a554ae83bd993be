//! The path of a spring in front of a pushed end, which a barrier keeps apart.

use super::tests::{BehindTheWall, matrix};
use super::*;
use crate::matrix::BlockBanded;
use std::sync::Arc;

/// Range of the barrier.
const RANGE: f64 = 0.1;

/// An end at u₀ = load, and a unit spring at u₁ that is at ease at 1. A barrier of the gap g = |u₁ − u₀| keeps them
/// apart; beyond its range neither feels the other, on whichever side it is.
struct PushedEnd {
    damping: Arc<BlockBanded>,
}

impl PushedEnd {
    fn new() -> Self {
        Self {
            damping: Arc::new(matrix([[1.0, 0.0], [0.0, 1.0]])),
        }
    }

    /// Returns value, slope and curvature of the barrier −(g − d)² ln(g/d).
    fn barrier(gap: f64) -> [f64; 3] {
        if gap >= RANGE {
            return [0.0; 3];
        }
        let (rest, ln) = (gap - RANGE, (gap / RANGE).ln());
        [
            -rest * rest * ln,
            -2.0 * rest * ln - rest * rest / gap,
            -2.0 * ln - 4.0 * rest / gap + rest * rest / (gap * gap),
        ]
    }
}

impl Equilibrium for PushedEnd {
    type Load = f64;
    type EvaluationError = BehindTheWall;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &[true, false]
    }
    fn apply_prescribed(&self, load: &f64, u: &mut [f64]) {
        u[0] = *load;
    }
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, _: &f64, u: &[f64]) -> Result<ResidualEvaluation, BehindTheWall> {
        let (stretch, gap) = (u[1] - 1.0, u[1] - u[0]);
        let [value, slope, _] = Self::barrier(gap.abs());
        let push = slope * gap.signum();
        Ok(ResidualEvaluation {
            energy: 0.5 * stretch * stretch + value,
            residual: vec![-push, stretch + push],
            residual_scale: 1.0,
            rounding: 1e-15,
        })
    }
    fn tangent(&self, _: &f64, u: &[f64]) -> Direct {
        let [_, _, k] = Self::barrier((u[1] - u[0]).abs());
        Direct::new(
            matrix([[k, -k], [-k, 1.0 + k]]),
            self.damping.clone(),
            self.prescribed().into(),
        )
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }
    /// A tenth of the gap must remain.
    fn longest_step(&self, u: &[f64], step: &[f64]) -> f64 {
        let (gap, closes) = (u[1] - u[0], step[0] - step[1]);
        if closes <= 0.9 * gap {
            1.0
        } else {
            (0.9 * gap / closes).max(0.0)
        }
    }
}

fn pushed(problem: &PushedEnd, settings: Settings) -> Path<&PushedEnd> {
    let mut path = Path::begin(problem, 0.0, vec![0.0, 1.0], settings).unwrap();
    path.begin_segment(2.0);
    path
}

/// Checks that the end holds the spring in front of it, at unit force.
fn assert_in_front(u: &[f64]) {
    let gap = u[1] - u[0];
    assert!(u[0] == 2.0 && gap > 0.0 && gap < RANGE, "{u:?}");
    let [_, slope, _] = PushedEnd::barrier(gap);
    assert!((u[1] - 1.0 + slope).abs() < 1e-7, "{u:?}");
}

#[test]
fn a_pushed_end_does_not_jump_over_what_is_in_front_of_it() {
    let problem = PushedEnd::new();
    let mut path = pushed(&problem, Settings::default());
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
    assert_in_front(&path.state().u);
}

#[test]
fn a_path_whose_steps_may_not_be_halved_ends_at_a_barrier() {
    let problem = PushedEnd::new();
    let settings = Settings {
        max_step_halvings: 0,
        ..Settings::default()
    };
    let mut path = pushed(&problem, settings);
    path.advance(0.4, &mut ()).unwrap();
    let error = path.advance(1.0, &mut ()).unwrap_err();
    let failures: Vec<_> = error.attempts.iter().map(|(_, failed)| failed).collect();
    assert_eq!(failures, [&Failure::Blocked; 2]);
    assert_eq!(
        (path.reached(), &path.state().u[..]),
        (0.4, &[0.8, 1.0][..])
    );
}

#[test]
fn a_pseudo_time_step_moves_what_is_prescribed_in_parts() {
    let problem = PushedEnd::new();
    for (integrator, equilibrate) in [
        (Integrator::BackwardEuler, true),
        (Integrator::BackwardEuler, false),
        (Integrator::Newmark, true),
    ] {
        let scheme = PseudoTime {
            integrator,
            equilibrate,
            ramp: 15,
            damping: 1.0,
            tolerance: 1e-9,
            max_steps: 5000,
        };
        let settings = Settings {
            scheme: Scheme::PseudoTime(scheme),
            ..Settings::default()
        };
        let mut path = pushed(&problem, settings);
        path.advance(1.0, &mut ()).unwrap();
        assert_in_front(&path.state().u);
    }
}
