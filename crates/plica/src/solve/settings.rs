//! Settings of the solvers.

/// Settings of the solvers, as a case file chooses them.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The method that leads from one state to the next.
    pub scheme: Scheme,
    /// Largest relative residual, without damping, of a state in equilibrium.
    pub tolerance: f64,
    /// Linear solves of Newton's method before relaxation takes over.
    pub newton_iterations: usize,
    /// Linear solves of relaxation before a step is halved.
    pub relaxation_steps: usize,
    /// Damping at which relaxation begins, in E/D² per unit volume.
    pub relaxation_damping: f64,
    /// Halvings of a step before the path ends.
    pub max_step_halvings: usize,
}

/// The method that leads from one state to the next.
#[derive(Clone, Debug, PartialEq)]
pub enum Scheme {
    /// Newton's method along the tangent of the path; where that fails, relaxation.
    Static,
    /// Pseudo-time with constant damping.
    PseudoTime(PseudoTime),
}

impl Scheme {
    /// Returns the name in a case file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Static => "static",
            Self::PseudoTime(p) => match p.integrator {
                Integrator::Newmark => "newmark",
                Integrator::BackwardEuler => "backward-euler",
            },
        }
    }
}

impl std::fmt::Display for Scheme {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())?;
        match self {
            Self::Static => Ok(()),
            Self::PseudoTime(p) => write!(f, ", damping {}", p.damping),
        }
    }
}

/// Pseudo-time with constant damping: C u̇ + R(u) = 0 (Okino et al. 2025, Eqs. (15)–(18)).
#[derive(Clone, Debug, PartialEq)]
pub struct PseudoTime {
    /// Time integration.
    pub integrator: Integrator,
    /// ηD/(EΔτ); 100 in the paper.
    pub damping: f64,
    /// Pseudo-time steps over which the load of each step of a stage is ramped.
    pub ramp: usize,
    /// Largest displacement of a control point, in D, in the last pseudo-time step after the ramp; 1e-5
    /// in the paper.
    pub tolerance: f64,
    /// Pseudo-time steps after the ramp before the path ends.
    pub max_steps: usize,
    /// True if the state is then taken to equilibrium without damping. If not, states are accepted as
    /// in the paper, and their relative residual says how far from equilibrium they are.
    pub equilibrate: bool,
}

/// Time integration of the velocity u̇.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Newmark with γ = ½, β = ¼, as in the paper: u̇ₙ₊₁ = 2 (uₙ₊₁ − uₙ)/Δτ − u̇ₙ.
    Newmark,
    /// u̇ₙ₊₁ = (uₙ₊₁ − uₙ)/Δτ.
    BackwardEuler,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            scheme: Scheme::Static,
            tolerance: 1e-8,
            newton_iterations: 12,
            relaxation_steps: 200,
            relaxation_damping: 1.0,
            max_step_halvings: 8,
        }
    }
}

impl Default for PseudoTime {
    fn default() -> Self {
        Self {
            integrator: Integrator::Newmark,
            damping: 100.0,
            ramp: 10,
            tolerance: 1e-5,
            max_steps: 2000,
            equilibrate: true,
        }
    }
}
