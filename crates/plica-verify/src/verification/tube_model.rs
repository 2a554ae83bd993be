//! Tubes between sliding ends, as short rings in plane strain and longer, that the checks solve with Plica.

use super::VerificationError;
use plica::activation::{Direction, Muscle, Profile};
use plica::assembly::{Point, SplineTube};
use plica::equilibrium::TubeProblem;
use plica::material::{Law, Material, NeoHookean};
use plica::solve::{Path, Settings, State};
use plica::stability::Harmonics;
use plica::tube::{Integration, Load, Mesh, MeshLayer, Pressure, Support, Tube, WallLayer};

/// A tube and its discretisation.
#[derive(Clone, Debug)]
pub struct TubeModel {
    /// The tube.
    pub tube: Tube,
    /// Elements along, around and through the wall.
    pub elements: [usize; 3],
    /// Degree p of the splines.
    pub degree: usize,
    /// Integration of the volumetric energy.
    pub volumetric: Integration,
    /// Elements of the layers; none for a wall of one layer.
    pub layers: Vec<MeshLayer>,
}

/// Returns solver settings with a tolerance near rounding.
pub fn tight_settings() -> Settings {
    Settings {
        tolerance: 1e-10,
        ..Settings::default()
    }
}

impl TubeModel {
    /// Creates a perfect cubic tube with E = 1 between sliding ends.
    pub fn new(length: f64, thickness: f64, poisson_ratio: f64, elements: [usize; 3]) -> Self {
        let tube = Tube {
            length,
            thickness,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0,
                poisson_ratio,
            )))],
            muscles: vec![],
            ends: [Support::Sliding; 2],
            imperfections: vec![],
            obstacles: vec![],
            patches: vec![],
            foundations: vec![],
        };
        Self {
            tube,
            elements,
            degree: 3,
            volumetric: Integration::Full,
            layers: vec![],
        }
    }

    /// Creates a ring in plane strain, 0.1 D long, with one element along.
    pub fn ring(thickness: f64, poisson_ratio: f64, through: usize) -> Self {
        Self::new(0.1, thickness, poisson_ratio, [1, 120, through])
    }

    /// Adds a muscle of uniform activation along the whole tube.
    pub fn with_uniform_muscle(mut self, direction: Direction) -> Self {
        self.tube.muscles.push(Muscle::new(
            "even".into(),
            direction,
            [0.0, self.tube.length],
            Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]),
        ));
        self
    }

    /// Returns the discretised tube with `rings` control rings.
    pub fn problem(&self, rings: usize) -> TubeProblem {
        let p = self.degree;
        let [along, around, through] = self.elements;
        let mesh = Mesh {
            axial: along + p,
            around,
            thickness: match &self.layers[..] {
                [] => through + p,
                layers => Mesh::points_through(p, layers),
            },
            degree: p,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: self.volumetric,
            layers: self.layers.clone(),
        };
        TubeProblem::new(SplineTube::new(&self.tube, &mesh, rings))
    }

    /// Returns the load of follower pressures on the inner and the outer wall.
    pub fn under_pressure(&self, [inner, outer]: [f64; 2]) -> Load {
        let pressure = |follower| Pressure {
            follower,
            dead: 0.0,
        };
        Load {
            pressures: [pressure(inner), pressure(outer)],
            ..self.tube.rest()
        }
    }
}

/// Solves for the state under a load, which is applied from rest in equal steps.
///
/// # Errors
/// [`VerificationError::Path`] if a step fails.
pub fn solve_from_rest(
    problem: &TubeProblem,
    load: &Load,
    steps: usize,
) -> Result<State<Load>, VerificationError> {
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, problem.tube.tube.rest(), u, tight_settings())?;
    path.begin_segment(load.clone());
    for n in 1..=steps {
        path.advance(n as f64 / steps as f64, &mut ())?;
    }
    Ok(path.state().clone())
}

/// Returns the energy of the whole tube.
pub fn energy(problem: &TubeProblem, state: &State<Load>) -> f64 {
    state.energy * problem.tube.sector.repeats()
}

/// Returns a point away from the ends. At angle 0, the middle of an element, the radial direction is exact.
fn point(problem: &TubeProblem, radius: f64) -> Point {
    Point {
        z: 0.3 * problem.tube.tube.length,
        radius,
        angle: 0.0,
    }
}

/// Returns the radial displacement of the wall at a reference radius.
pub fn radial_displacement(problem: &TubeProblem, state: &State<Load>, radius: f64) -> f64 {
    // The spline circle intersects the exact one near this angle.
    let at = Point {
        angle: 0.3,
        ..point(problem, radius)
    };
    let sample = problem.tube.sample(&state.load, &state.u, at);
    let radius = |[_, x, y]: [f64; 3]| x.hypot(y);
    radius(sample.position) - radius(sample.reference)
}

/// Returns the Cauchy stresses along, outwards and around at a reference radius.
pub fn stress(problem: &TubeProblem, state: &State<Load>, radius: f64) -> [f64; 3] {
    let at = point(problem, radius);
    let Fe = problem.tube.sample(&state.load, &state.u, at).elastic;
    let sigma = problem.tube.tube.layers[0]
        .material
        .stress(&Fe)
        .times(Fe.transpose());
    [0, 1, 2].map(|i| sigma.0[i][i] / Fe.determinant())
}

/// Returns the fraction of a load at which the lowest eigenvalue of a circumferential mode is zero, by the secant
/// method from two guesses.
///
/// # Errors
/// [`VerificationError`] if a state or an eigenvalue is not found, or the eigenvalue changes its sign earlier.
pub fn critical_fraction(
    problem: &TubeProblem,
    load: &Load,
    harmonic: usize,
    [mut from, mut to]: [f64; 2],
) -> Result<f64, VerificationError> {
    let harmonics = Harmonics::new(problem, harmonic);
    let lowest = |t: f64| -> Result<f64, VerificationError> {
        let state = solve_from_rest(problem, &problem.tube.tube.rest().towards(load, t), 1)?;
        Ok(harmonics
            .lowest(harmonic, &state.load, &state.u, 1)?
            .first()
            .map_or(f64::INFINITY, |pair| pair.value))
    };
    let mut values = [lowest(from)?, lowest(to)?];
    for _ in 0..3 {
        let next = from - values[0] * (to - from) / (values[1] - values[0]);
        (from, to, values) = (to, next, [values[1], lowest(next)?]);
    }
    // The method has converged, and the eigenvalue is positive halfway.
    let halfway = lowest(0.5 * to)?;
    if values[1].abs() > 1e-5 * halfway.abs() || halfway <= 0.0 {
        let message = format!(
            "lowest eigenvalue {:.1e} where it should be zero, {halfway:.1e} halfway",
            values[1]
        );
        return Err(VerificationError::Solve(message));
    }
    Ok(to)
}
