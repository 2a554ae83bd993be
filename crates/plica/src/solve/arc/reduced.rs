//! The force on the critical mode, by the reduction of Lyapunov and Schmidt, computed instead of expanded.
//!
//! Near a singular point with K v ≈ 0 the states with a given part ε of v,
//!
//! R(u, λ) + η c = 0, c · (u − u*) = ε c · v, c = C v,
//!
//! are smooth functions of (ε, λ), since the bordered matrix [K c; cᵀ 0] is regular there. The equilibria are the zeros of
//! η(ε, λ), so −η is the force of one degree of freedom: a fold is η = η_ε = 0, a branch point η = η_ε = η_λ = 0. This is the
//! minimally augmented system (Govaerts 2000, section 3.3): η_ε is the number that vanishes with the lowest eigenvalue of K.
//!
//! With the derivatives of the state, [K c; cᵀ 0] [u_ε; η_ε] = [0; c·v] and [K c; cᵀ 0] [u_λ; η_λ] = [−R_λ; 0], and as the
//! bordered matrix is symmetric,
//!
//! η_εε c·v = −u_ε · D²R[u_ε, u_ε], η_ελ c·v = −u_ε · D²R[u_ε, (u_λ, 1)], η_λλ c·v = −u_ε · D²R[(u_λ, 1), (u_λ, 1)],
//! η_εεε c·v = −u_ε · (D³R[u_ε, u_ε, u_ε] + 3 D²R[u_ε, u_εε]),
//!
//! They are differences of residuals: no third derivative of the energy is needed.

use super::super::line_search::largest;
use super::super::operator::{add, dot};
use super::bordered::Border;
use super::corrector::{Plane, Scalar};
use super::curve::{Curve, Failure, Point};
use super::family::Family;
use crate::monitor::Monitor;

/// Largest displacement in second differences, where the largest entry of v is one.
const SECOND: f64 = 1e-4;
/// Largest displacement in third differences.
const THIRD: f64 = 1e-3;
/// Change of the parameter in second differences, in multiples of that in first differences.
const PARAMETER: f64 = 10.0;

/// The force on a mode near a point.
pub struct Reduced<'c, 'f, F: Family> {
    pub(super) curve: &'c Curve<'f, F>,
    /// u*.
    origin: Vec<f64>,
    /// v.
    mode: Vec<f64>,
    /// c.
    force: Vec<f64>,
    /// c · v.
    norm: f64,
}

/// A state with a given part ε of the mode.
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedPoint {
    /// ε.
    pub epsilon: f64,
    /// λ.
    pub parameter: f64,
    /// Unknowns.
    pub u: Vec<f64>,
    /// η.
    pub eta: f64,
    /// u_ε and η_ε.
    pub by_epsilon: (Vec<f64>, f64),
    /// u_λ and η_λ.
    pub by_parameter: (Vec<f64>, f64),
}

/// Second derivatives of η.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Second {
    pub epsilon: f64,
    pub mixed: f64,
    pub parameter: f64,
}

impl<'c, 'f, F: Family> Reduced<'c, 'f, F> {
    /// Takes a point and a mode, whose largest entry should be one.
    pub fn new(curve: &'c Curve<'f, F>, at: &Point, mode: &[f64]) -> Self {
        let force = curve.metric.dual(mode);
        Self {
            curve,
            origin: at.u.clone(),
            norm: dot(&force, mode),
            mode: mode.to_vec(),
            force,
        }
    }

    /// Returns the mode v.
    pub fn mode(&self) -> &[f64] {
        &self.mode
    }

    /// Solves for the state at (ε, λ) from a start.
    ///
    /// # Errors
    /// [`super::ArcFailure`] if it is not found.
    pub fn solve(
        &self,
        epsilon: f64,
        parameter: f64,
        start: Vec<f64>,
        monitor: &mut dyn Monitor,
    ) -> Result<ReducedPoint, Failure<F>> {
        let mut origin = self.origin.clone();
        add(epsilon, &self.mode, &mut origin);
        let plane = Plane {
            row: self.force.clone(),
            corner: 0.0,
            origin: (&origin, 0.0),
            scale: self.norm * epsilon.abs().max(1e-3),
        };
        let scalar = Scalar::Force {
            parameter,
            force: &self.force,
        };
        let found = self.curve.correct(scalar, &plane, (start, 0.0), monitor)?;
        let border = Border {
            column: &self.force,
            row: &self.force,
            corner: 0.0,
        };
        let zero = vec![0.0; origin.len()];
        let slope = self.curve.slope(&found.u, parameter)?;
        let minus: Vec<f64> = slope.iter().map(|r| -r).collect();
        Ok(ReducedPoint {
            epsilon,
            parameter,
            eta: found.scalar,
            by_epsilon: found.linear.solve(&border, &zero, self.norm)?,
            by_parameter: found.linear.solve(&border, &minus, 0.0)?,
            u: found.u,
        })
    }

    /// Solves for the state at (ε, λ) from one nearby.
    pub(super) fn from(
        &self,
        near: &ReducedPoint,
        epsilon: f64,
        parameter: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<ReducedPoint, Failure<F>> {
        let mut start = near.u.clone();
        add(epsilon - near.epsilon, &near.by_epsilon.0, &mut start);
        add(parameter - near.parameter, &near.by_parameter.0, &mut start);
        self.solve(epsilon, parameter, start, monitor)
    }

    /// Returns the residual at a displacement, and a change of the parameter, from a point.
    fn residual(&self, at: &ReducedPoint, displacement: &[f64], parameter: f64) -> ResidualOf<F> {
        let mut u = at.u.clone();
        add(1.0, displacement, &mut u);
        let forces = self.curve.forces(at.parameter + parameter, &mut u)?;
        Ok(forces.residual)
    }

    /// Returns the second derivatives of η at a point.
    pub(super) fn second(&self, at: &ReducedPoint) -> Result<Second, Failure<F>> {
        let (w, along) = (&at.by_epsilon.0, &at.by_parameter.0);
        let h = SECOND / largest(w);
        let d = PARAMETER * self.curve.settings.difference;
        let force = |e: f64, l: f64| -> Result<f64, Failure<F>> {
            let displacement: Vec<f64> = w
                .iter()
                .zip(along)
                .map(|(w, v)| e * h * w + l * d * v)
                .collect();
            Ok(dot(w, &self.residual(at, &displacement, l * d)?))
        };
        let middle = force(0.0, 0.0)?;
        let epsilon = (force(1.0, 0.0)? - 2.0 * middle + force(-1.0, 0.0)?) / (h * h);
        let parameter = (force(0.0, 1.0)? - 2.0 * middle + force(0.0, -1.0)?) / (d * d);
        let mixed = force(1.0, 1.0)? - force(1.0, -1.0)? - force(-1.0, 1.0)? + force(-1.0, -1.0)?;
        Ok(Second {
            epsilon: -epsilon / self.norm,
            mixed: -mixed / (4.0 * h * d * self.norm),
            parameter: -parameter / self.norm,
        })
    }

    /// Returns η_εεε at a point with η_ε = 0.
    pub(super) fn third(&self, at: &ReducedPoint) -> Result<f64, Failure<F>> {
        let w = &at.by_epsilon.0;
        let h = SECOND / largest(w);
        let step = |e: f64| -> Vec<f64> { w.iter().map(|w| e * w).collect() };
        // D²R[u_ε, u_ε], which gives u_εε.
        let mut bent = vec![0.0; w.len()];
        for (factor, e) in [(1.0, h), (-2.0, 0.0), (1.0, -h)] {
            add(
                -factor / (h * h),
                &self.residual(at, &step(e), 0.0)?,
                &mut bent,
            );
        }
        let linear = self.curve.linear(&at.u, at.parameter)?;
        let border = Border {
            column: &self.force,
            row: &self.force,
            corner: 0.0,
        };
        let (curvature, _) = linear.solve(&border, &bent, 0.0)?;
        // Third difference along the parabola of the states.
        let h = THIRD / largest(w);
        let mut third = 0.0;
        for (factor, e) in [(0.5, 2.0), (-1.0, 1.0), (1.0, -1.0), (-0.5, -2.0)] {
            let e = e * h;
            let mut displacement = step(e);
            add(0.5 * e * e, &curvature, &mut displacement);
            third += factor * dot(w, &self.residual(at, &displacement, 0.0)?);
        }
        Ok(-third / (h * h * h * self.norm))
    }
}

type ResidualOf<F> = Result<Vec<f64>, Failure<F>>;
