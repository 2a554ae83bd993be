//! What a case may choose about the solver.

/// How states are found and when they are accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// How the tube gets from one state to the next.
    pub scheme: Scheme,
    /// A state is in equilibrium when its residual without drag, over the forces in play, is at
    /// most this.
    pub tolerance: f64,
    /// Newton iterations before a step is given to relaxation.
    pub newton_iterations: usize,
    /// Relaxation steps before a step is halved.
    pub relaxation_steps: usize,
    /// Drag at which relaxation starts, in E/D² per unit volume.
    pub relaxation_damping: f64,
    /// How often a step may be halved before the run stops.
    pub max_step_halvings: usize,
}

/// How the tube gets from one state to the next.
#[derive(Clone, Debug, PartialEq)]
pub enum Scheme {
    /// Newton from the path's tangent; where that fails, relaxation with a drag that shrinks.
    Static,
    /// A pseudo-time with a drag that stays.
    PseudoTime(PseudoTime),
}

impl Scheme {
    /// What a case file calls it.
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

/// Pseudo-time with a fixed drag: C u̇ + R(u) = 0 (Okino et al. 2025, Eqs. (15)–(18)).
#[derive(Clone, Debug, PartialEq)]
pub struct PseudoTime {
    /// How the velocity follows from the displacements.
    pub integrator: Integrator,
    /// ηD/(EΔτ); the paper's is 100.
    pub damping: f64,
    /// Pseudo-time steps over which each step of a stage is ramped.
    pub ramp: usize,
    /// After the ramp, pseudo-time goes on until no control point moves more than this in a step,
    /// in D; the paper's is 1e-5.
    pub tolerance: f64,
    /// Pseudo-time steps after the ramp before the run stops.
    pub max_steps: usize,
    /// Whether the state is then taken to equilibrium without drag. If not, states are accepted
    /// as the paper accepts them, and say how far from equilibrium they are.
    pub equilibrate: bool,
}

/// How the velocity follows from the displacements.
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
