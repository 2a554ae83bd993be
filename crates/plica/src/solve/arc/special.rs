//! Folds and branch points, their normal forms, and the branches that leave a branch point.

use super::curve::{Failure, Point};
use super::error::ArcFailure;
use super::family::Family;
use super::reduced::{Reduced, ReducedPoint, Second};
use crate::monitor::Monitor;

/// Largest number of Newton's iterations for a special point.
const ITERATIONS: usize = 12;
/// Change of ε, and of λ relative to the range of its first differences, at which a special point is found.
const ACCURACY: f64 = 1e-10;
/// Amplitude, as a largest displacement in D, at which the cubic term of a pitchfork outweighs what is left of a quadratic
/// one.
const PITCHFORK: f64 = 0.01;

/// A fold: the parameter has an extreme value along the branch.
#[derive(Clone, Debug, PartialEq)]
pub struct Fold {
    /// λ.
    pub parameter: f64,
    /// Unknowns.
    pub u: Vec<f64>,
    /// v: the tangent of the branch; its largest entry is about one.
    pub mode: Vec<f64>,
    /// d²λ/dε² with u = u* + ε v: below 0 where λ has a maximum.
    pub curvature: f64,
}

/// A point at which two branches cross.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchPoint {
    /// λ*.
    pub parameter: f64,
    /// Unknowns u*.
    pub u: Vec<f64>,
    /// v: K v = 0; its largest entry is about one.
    pub mode: Vec<f64>,
    /// Force on the mode.
    pub form: NormalForm,
    /// η: zero where the branches cross; else the force by which they miss each other, as those of an imperfect tube do.
    pub imperfection: f64,
    pub(super) second: Second,
}

/// The force on the mode at the amplitude ε, −η = α (λ − λ*) ε + γ ε² + β ε³ + …, with the force β ε³ C v on the tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalForm {
    /// Rate at which the eigenvalue ν of the mode, K v = ν C v, changes with the parameter: below 0 where the first branch
    /// becomes unstable.
    pub alpha: f64,
    /// Quadratic coefficient; zero at a pitchfork.
    pub gamma: f64,
    /// Cubic coefficient.
    pub beta: f64,
}

impl NormalForm {
    /// Returns whether the branches form a pitchfork, as a symmetry demands, rather than a transcritical point.
    pub fn is_pitchfork(&self) -> bool {
        self.gamma.abs() <= PITCHFORK * self.beta.abs()
    }

    /// Returns whether the bifurcated branch of a pitchfork lies where the first one is unstable to the mode: it is stable
    /// there if the first one was before.
    pub fn is_supercritical(&self) -> bool {
        self.beta > 0.0
    }

    /// Returns c of λ − λ* = c ε² on the bifurcated branch of a pitchfork.
    pub fn curvature(&self) -> f64 {
        -self.beta / self.alpha
    }
}

impl BranchPoint {
    /// Returns the distance in λ from the point to the fold of the branch that an imperfection disconnects from the others, at
    /// a pitchfork: 3 (β η²/4)^(1/3) / |α|. It is of rounding errors where the branches cross.
    pub fn gap(&self) -> f64 {
        let force = 0.25 * self.form.beta.abs() * self.imperfection * self.imperfection;
        3.0 * force.cbrt() / self.form.alpha.abs()
    }

    /// Returns dλ/dε of the branch with the smaller one: the root m of η_εε + 2 η_ελ m + η_λλ m² = 0.
    fn slope(&self) -> f64 {
        let Second {
            epsilon,
            mixed,
            parameter,
        } = self.second;
        let root = (mixed * mixed - epsilon * parameter).max(0.0).sqrt();
        -epsilon / (mixed + root.copysign(mixed))
    }
}

impl<F: Family> Reduced<'_, '_, F> {
    /// Solves for the fold near a point.
    ///
    /// # Errors
    /// [`ArcFailure::NoPoint`] if Newton's method leaves the neighbourhood, or the failure of a state.
    pub fn fold(&self, near: &Point, monitor: &mut dyn Monitor) -> Result<Fold, Failure<F>> {
        let start = self.solve(0.0, near.parameter, near.u.clone(), monitor)?;
        let found = self.newton(start, monitor, |at, second| {
            let [a, b] = [at.by_epsilon.1, at.by_parameter.1];
            ([[a, b], [second.epsilon, second.mixed]], [at.eta, a])
        })?;
        let second = self.second(&found)?;
        Ok(Fold {
            parameter: found.parameter,
            curvature: -second.epsilon / found.by_parameter.1,
            mode: found.by_epsilon.0,
            u: found.u,
        })
    }

    /// Solves for the branch point near a point.
    ///
    /// # Errors
    /// As [`Reduced::fold`].
    pub fn branch_point(
        &self,
        near: &Point,
        monitor: &mut dyn Monitor,
    ) -> Result<BranchPoint, Failure<F>> {
        let start = self.solve(0.0, near.parameter, near.u.clone(), monitor)?;
        let found = self.newton(start, monitor, |at, second| {
            let force = [at.by_epsilon.1, at.by_parameter.1];
            let Second {
                epsilon,
                mixed,
                parameter,
            } = *second;
            ([[epsilon, mixed], [mixed, parameter]], force)
        })?;
        let second = self.second(&found)?;
        Ok(BranchPoint {
            parameter: found.parameter,
            form: NormalForm {
                alpha: -second.mixed,
                gamma: -0.5 * second.epsilon,
                beta: -self.third(&found)? / 6.0,
            },
            imperfection: found.eta,
            mode: found.by_epsilon.0,
            u: found.u,
            second,
        })
    }

    /// Solves two equations in (ε, λ), given with their Jacobian.
    fn newton(
        &self,
        mut at: ReducedPoint,
        monitor: &mut dyn Monitor,
        equations: impl Fn(&ReducedPoint, &Second) -> ([[f64; 2]; 2], [f64; 2]),
    ) -> Result<ReducedPoint, Failure<F>> {
        let unit = self.curve.settings.difference;
        let reach = self.curve.settings.longest_step;
        let start = at.parameter;
        for _ in 0..ITERATIONS {
            let (J, f) = equations(&at, &self.second(&at)?);
            let determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
            let epsilon = (J[0][1] * f[1] - J[1][1] * f[0]) / determinant;
            let parameter = (J[1][0] * f[0] - J[0][0] * f[1]) / determinant;
            let to = [at.epsilon + epsilon, at.parameter + parameter];
            if !(to[0].abs() < 1.0 && (to[1] - start).abs() <= reach) {
                return Err(ArcFailure::NoPoint);
            }
            at = self.from(&at, to[0], to[1], monitor)?;
            // λ in units in which R_λ is known to about 1e-10.
            if epsilon.abs() <= 1e3 * ACCURACY && parameter.abs() <= 1e5 * unit * ACCURACY {
                return Ok(at);
            }
        }
        Err(ArcFailure::NoPoint)
    }

    /// Returns the points of the other branch at a branch point of this mode, at the amplitudes ε and −ε from this point, with
    /// tangents that lead away from it.
    ///
    /// # Errors
    /// [`ArcFailure`] if one is not found.
    pub fn switch(
        &self,
        from: &BranchPoint,
        amplitude: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<[Point; 2], Failure<F>> {
        let at = self.solve(0.0, from.parameter, from.u.clone(), monitor)?;
        let [plus, minus] =
            [amplitude, -amplitude].map(|step| self.other((from, &at), step, monitor));
        Ok([plus?, minus?])
    }

    fn other(
        &self,
        (from, near): (&BranchPoint, &ReducedPoint),
        step: f64,
        monitor: &mut dyn Monitor,
    ) -> Result<Point, Failure<F>> {
        let form = &from.form;
        let mut parameter = from.parameter
            + match form.is_pitchfork() {
                true => form.curvature() * step * step,
                false => from.slope() * step,
            };
        let mut at = self.from(near, step, parameter, monitor)?;
        let close = self.curve.settings.difference * 1e-6;
        for _ in 0..ITERATIONS {
            let change = -at.eta / at.by_parameter.1;
            parameter += change;
            if (parameter - from.parameter).abs() > self.curve.settings.longest_step * 10.0 {
                return Err(ArcFailure::NoPoint);
            }
            at = self.from(&at, step, parameter, monitor)?;
            if change.abs() <= close {
                break;
            }
        }
        let away: Vec<f64> = at.u.iter().zip(&from.u).map(|(a, b)| a - b).collect();
        let away = self.curve.unit(away, parameter - from.parameter);
        let found = (self.curve).in_plane(&away, (at.u, parameter), step.abs(), monitor)?;
        self.curve.point(found, 0.0, &away)
    }
}
