//! Pseudo-time with a drag that stays: the paper's scheme, and its backward Euler sister.

use super::newton::free_part;
use super::{Equilibrium, Failure, Forces, Found, Integrator, Method, PseudoTime, Settings, Watch};

/// Leads the problem from one load to another against a fixed drag and on until it hardly moves:
/// C u̇ + R(u) = 0 (Okino et al. 2025, Eqs. (15)–(18)).
///
/// Eliminating the acceleration from the Newmark recurrences with γ = ½, β = ¼ gives
/// u̇ₙ₊₁ = 2 (uₙ₊₁ − uₙ)/Δτ − u̇ₙ, so that each pseudo-time step solves R(u) + η C u̇(u) = 0 by
/// Newton with K + (2 η/Δτ) C; backward Euler has K + (η/Δτ) C. The pseudo-time step is Δτ = 1.
///
/// `velocity` is u̇ at the start and, on return, at the end.
pub fn pseudo_time<P: Equilibrium>(
    problem: &P,
    [from, target]: [&P::Load; 2],
    mut u: Vec<f64>,
    velocity: &mut Vec<f64>,
    scheme: &PseudoTime,
    settings: &Settings,
    watch: &mut dyn Watch,
) -> Result<Found, Failure<P::Broken>> {
    let (mut iterations, mut drag_work) = (0, 0.0);
    let mut moved = 0.0;
    for n in 1..=scheme.ramp + scheme.hold {
        let t = (n as f64 / scheme.ramp as f64).min(1.0);
        let load = problem.between(from, target, t);
        let (next, forces) = step(
            problem,
            &load,
            &u,
            velocity,
            scheme,
            settings,
            &mut iterations,
            watch,
        )?;
        moved = u
            .iter()
            .zip(&next)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        drag_work += work(problem, scheme, velocity, &u, &next);
        u = next;
        if n >= scheme.ramp && moved < scheme.tolerance {
            return Ok(Found {
                u,
                forces,
                drag_work,
                iterations,
            });
        }
    }
    Err(Failure::NotConverged {
        iterations,
        imbalance: moved,
    })
}

/// One pseudo-time step from `u`; updates the velocity.
#[allow(clippy::too_many_arguments)] // what a step reads and writes, no more
fn step<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: &[f64],
    velocity: &mut Vec<f64>,
    scheme: &PseudoTime,
    settings: &Settings,
    iterations: &mut usize,
    watch: &mut dyn Watch,
) -> Result<(Vec<f64>, Forces), Failure<P::Broken>> {
    let (given, C) = (problem.given(), problem.drag());
    // u̇ = rate (x − u) − kept u̇ₙ
    let (rate, kept) = match scheme.integrator {
        Integrator::Newmark => (2.0, 1.0),
        Integrator::BackwardEuler => (1.0, 0.0),
    };
    let mut x = u.to_vec();
    problem.impose(load, &mut x);
    for _ in 0..settings.newton_iterations {
        let forces = problem.forces(load, &x).map_err(Failure::Broken)?;
        let mut rhs: Vec<f64> = forces.residual.iter().map(|r| -r).collect();
        let at = |i: usize| rate * (x[i] - u[i]) - kept * velocity[i];
        let now: Vec<f64> = (0..u.len()).map(at).collect();
        C.multiply_add(-scheme.drag, &now, &mut rhs);
        let rhs = free_part(&rhs, given, 1.0);
        let size =
            rhs.iter().map(|r| r * r).sum::<f64>().sqrt() / forces.in_play.max(Forces::FLOOR);
        if size <= settings.tolerance {
            *velocity = now;
            return Ok((x, forces));
        }
        let mut A = problem.tangent(load, &x);
        A.add_scaled(rate * scheme.drag, C);
        A.constrain(given);
        let factor = A.factor()?;
        *iterations += 1;
        if !watch.solved(Method::PseudoTime, size) {
            return Err(Failure::Stopped);
        }
        let mut correction = rhs;
        factor.solve(&mut correction);
        for (x, c) in x.iter_mut().zip(&correction) {
            *x += c;
        }
    }
    Err(Failure::NotConverged {
        iterations: *iterations,
        imbalance: f64::NAN,
    })
}

/// What the drag took in a step: ∫ η u̇ᵀ C u̇ dτ by the force at its end.
fn work<P: Equilibrium>(
    problem: &P,
    scheme: &PseudoTime,
    velocity: &[f64],
    from: &[f64],
    to: &[f64],
) -> f64 {
    let mut force = vec![0.0; to.len()];
    problem
        .drag()
        .multiply_add(scheme.drag, velocity, &mut force);
    force
        .iter()
        .zip(from.iter().zip(to))
        .map(|(f, (a, b))| f * (b - a))
        .sum()
}
