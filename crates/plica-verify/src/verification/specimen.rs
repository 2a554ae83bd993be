//! Short tubes between sliding ends, which are rings in plane strain, and longer ones: Plica's side of
//! the comparisons.

use super::found::Trouble;
use plica::activation::{Direction, Muscle, Profile};
use plica::assembly::{Point, SplineTube};
use plica::equilibrium::TubeProblem;
use plica::material::{Law, Material, NeoHookean};
use plica::solve::{Path, Settings, State};
use plica::stability::Harmonics;
use plica::tube::{Integration, Load, Mesh, Pressure, Support, Tube};

/// A tube, and the elements along, around and through it.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// The tube.
    pub tube: Tube,
    /// Elements along, around and through the wall.
    pub elements: [usize; 3],
    /// p.
    pub degree: usize,
    /// How the resistance to a change of volume is integrated.
    pub volumetric: Integration,
}

/// Newton as exact as rounding lets it be.
pub fn tight() -> Settings {
    Settings {
        tolerance: 1e-10,
        ..Settings::default()
    }
}

impl Specimen {
    /// A perfect tube of E = 1 between sliding ends, outer radius ½, of cubics.
    pub fn new(length: f64, thickness: f64, poisson_ratio: f64, elements: [usize; 3]) -> Self {
        let tube = Tube {
            length,
            thickness,
            material: Material::NeoHookean(NeoHookean::new(1.0, poisson_ratio)),
            muscles: vec![],
            ends: [Support::Sliding; 2],
            imperfections: vec![],
        };
        Self {
            tube,
            elements,
            degree: 3,
            volumetric: Integration::Full,
        }
    }

    /// A ring in plane strain: a tenth of a diameter long, one element along.
    pub fn ring(thickness: f64, poisson_ratio: f64, through: usize) -> Self {
        Self::new(0.1, thickness, poisson_ratio, [1, 120, through])
    }

    /// With a muscle over more than all of the tube, the same everywhere.
    pub fn with_even_muscle(mut self, direction: Direction) -> Self {
        self.tube.muscles.push(Muscle {
            name: "even".into(),
            direction,
            zone: [0.0, self.tube.length],
            profile: Profile::Table(vec![(0.0, 1.0), (1.0, 1.0)]),
        });
        self
    }

    /// Laid out in splines, `rings` to solve for.
    pub fn problem(&self, rings: usize) -> TubeProblem {
        let p = self.degree;
        let [along, around, through] = self.elements;
        let mesh = Mesh {
            axial: along + p,
            around,
            thickness: through + p,
            degree: p,
            refinements: vec![],
            volumetric: self.volumetric,
        };
        TubeProblem::new(SplineTube::new(&self.tube, &mesh, rings))
    }

    /// Rest with true pressure on the inner wall and the outer wall.
    pub fn pressed(&self, [inner, outer]: [f64; 2]) -> Load {
        let true_pressure = |follower| Pressure {
            follower,
            dead: 0.0,
        };
        Load {
            pressures: [true_pressure(inner), true_pressure(outer)],
            ..self.tube.rest()
        }
    }
}

/// The state under a load, from rest in equal steps.
///
/// # Errors
/// [`Trouble::Path`] where the path ends before.
pub fn under(problem: &TubeProblem, load: &Load, steps: usize) -> Result<State<Load>, Trouble> {
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, problem.tube.tube.rest(), u, tight())?;
    path.begin_segment(load.clone());
    for n in 1..=steps {
        path.advance(n as f64 / steps as f64, &mut ())?;
    }
    Ok(path.state().clone())
}

/// Energy of the whole tube.
pub fn energy(problem: &TubeProblem, state: &State<Load>) -> f64 {
    state.energy * problem.tube.sector.repeats()
}

/// A point of the wall away from ends; angle 0 is the middle of an element, where outwards is outwards.
fn point(problem: &TubeProblem, radius: f64) -> Point {
    Point {
        z: 0.3 * problem.tube.tube.length,
        radius,
        angle: 0.0,
    }
}

/// How far the wall at a radius has moved away from the axis.
pub fn swelling(problem: &TubeProblem, state: &State<Load>, radius: f64) -> f64 {
    // Where the spline circle crosses the exact one.
    let at = Point {
        angle: 0.3,
        ..point(problem, radius)
    };
    let sample = problem.tube.sample(&state.load, &state.u, at);
    let away = |[_, x, y]: [f64; 3]| x.hypot(y);
    away(sample.position) - away(sample.reference)
}

/// Cauchy stress along, outwards and around at a radius.
pub fn stress(problem: &TubeProblem, state: &State<Load>, radius: f64) -> [f64; 3] {
    let at = point(problem, radius);
    let Fe = problem.tube.sample(&state.load, &state.u, at).elastic;
    let sigma = problem.tube.tube.material.stress(&Fe).times(Fe.transpose());
    [0, 1, 2].map(|i| sigma.0[i][i] / Fe.determinant())
}

/// Where the lowest eigenvalue of a harmonic is zero on the way from rest to a load, as a fraction of
/// it: by secants from two guesses.
///
/// # Errors
/// [`Trouble`] where there is no state or no eigenvalue.
pub fn lost(
    problem: &TubeProblem,
    load: &Load,
    harmonic: usize,
    [mut from, mut to]: [f64; 2],
) -> Result<f64, Trouble> {
    let harmonics = Harmonics::new(&problem.tube, harmonic);
    let lowest = |t: f64| -> Result<f64, Trouble> {
        let state = under(problem, &problem.tube.tube.rest().towards(load, t), 1)?;
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
    // Found, and not lost long before.
    let halfway = lowest(0.5 * to)?;
    if values[1].abs() > 1e-5 * halfway.abs() || halfway <= 0.0 {
        let what = format!(
            "lowest eigenvalue {:.1e} where it should be zero, {halfway:.1e} halfway",
            values[1]
        );
        return Err(Trouble::Solve(what));
    }
    Ok(to)
}
