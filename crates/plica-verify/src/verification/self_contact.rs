//! Contact of the wall with itself: a ring that flattens under pressure, and a fold of one ring and of many.

use super::VerificationError;
use super::elastica::{flat_load, touching_load};
use super::report::Recorder;
use super::tube_model::{TubeModel, tight_settings};
use plica::assembly::{Barrier, Point, SplineTube};
use plica::contact::FaceContact;
use plica::equilibrium::TubeProblem;
use plica::solve::Path;
use plica::tube::{Axial, Imperfection, Load, Part, Shape, Wave};
use std::f64::consts::PI;

/// Returns the problem with contact of a range, in D.
fn touching(problem: &TubeProblem, range: f64) -> TubeProblem {
    let barrier = Barrier {
        range,
        ..*problem.tube.barrier()
    };
    TubeProblem::new((*problem.tube).clone().with_barrier(barrier)).with_contact()
}

/// A thin ring under outer pressure, flattened to an oval.
struct FlatRing {
    model: TubeModel,
    problem: TubeProblem,
    path: Path<TubeProblem>,
    /// Pressure of p R³/EI = 1.
    unit: f64,
    /// Radius of the middle surface at rest.
    middle: f64,
}

impl FlatRing {
    /// Range of contact, in D.
    const RANGE: f64 = 1e-4;

    /// Makes a ring with a thickness, in D, and flattens it.
    fn new(thickness: f64) -> Result<Self, VerificationError> {
        let (poisson_ratio, middle) = (0.3, 0.5 - 0.5 * thickness);
        let mut model = TubeModel::new(0.05, thickness, poisson_ratio, [1, 96, 1]);
        model.tube.imperfections.push(Imperfection {
            of: Part::Geometry,
            amplitude: 2e-4,
            shape: Shape::Wave(Wave::new(2, 0.0, Axial::Uniform)),
        });
        // A sector of half the ring.
        let problem = touching(&model.problem(48), Self::RANGE);
        let bending = thickness.powi(3) / 12.0 / (1.0 - poisson_ratio * poisson_ratio);
        let start = problem.tube.initial_guess();
        let rest = model.tube.rest();
        let mut ring = Self {
            path: Path::begin(problem.clone(), rest, start, tight_settings())?,
            model,
            problem,
            // The pressure acts on the outer circle.
            unit: bending / (0.5 * middle * middle),
            middle,
        };
        ring.advance(2.8, 2)?;
        ring.advance(3.2, 8)?;
        Ok(ring)
    }

    /// Follows the ring to a pressure p R³/EI.
    fn advance(&mut self, pressure: f64, steps: usize) -> Result<(), VerificationError> {
        let load = self.model.under_pressure([0.0, pressure * self.unit]);
        self.path.begin_segment(load);
        for n in 1..=steps {
            self.path.advance(n as f64 / steps as f64, &mut ())?;
        }
        Ok(())
    }

    /// Returns the position across the axis of a point of a circle, at an angle from the place of contact.
    fn position(&self, radius: f64, angle: f64) -> [f64; 2] {
        let state = self.path.state();
        let at = Point {
            z: 0.5 * self.model.tube.length,
            radius,
            angle: 0.5 * PI + angle,
        };
        let [_, x, y] = self.problem.tube.sample(&state.load, &state.u, at).position;
        [x, y]
    }

    /// Returns the distance of the opposite walls beyond the range of contact.
    fn gap(&self) -> f64 {
        2.0 * self.position(self.model.tube.inner_radius(), 0.0)[1] - Self::RANGE
    }

    /// Returns the curvature of the middle surface times its radius at rest; positive for a circle.
    fn curvature(&self, angle: f64) -> f64 {
        let h = 0.01;
        let [a, b, c] = [-h, 0.0, h].map(|d| self.position(self.middle, angle + d));
        let slope = [0, 1].map(|i| (c[i] - a[i]) / (2.0 * h));
        let second = [0, 1].map(|i| (c[i] - 2.0 * b[i] + a[i]) / (h * h));
        let size = slope[0].hypot(slope[1]);
        self.middle * (slope[0] * second[1] - slope[1] * second[0]) / size.powi(3)
    }

    /// Returns the curvature at the place of contact, extrapolated by a parabola from beside it: contact at a distance
    /// spreads the force over a small length, which rounds off the kink that a force at one point gives the curvature.
    fn curvature_at_contact(&self) -> f64 {
        let [near, middle, far] = [1.0, 2.0, 3.0].map(|n| self.curvature(0.15 * n));
        3.0 * (near - middle) + far
    }

    /// Follows the ring until a quantity is zero, by the secant method from two pressures. Returns p R³/EI there.
    fn zero(
        &mut self,
        mut p: [f64; 2],
        of: impl Fn(&Self) -> f64,
    ) -> Result<f64, VerificationError> {
        self.advance(p[0], 7)?;
        let first = of(self);
        self.advance(p[1], 2)?;
        let mut values = [first, of(self)];
        for _ in 0..8 {
            let next = p[1] - values[1] * (p[1] - p[0]) / (values[1] - values[0]);
            self.advance(next, 1)?;
            (p, values) = ([p[1], next], [values[1], of(self)]);
            if (p[1] - p[0]).abs() < 1e-4 {
                break;
            }
        }
        Ok(p[1])
    }
}

/// Returns p R³/EI of a ring without thickness, extrapolated from two.
fn extrapolated(
    of_ring: impl Fn(&mut FlatRing) -> Result<f64, VerificationError>,
) -> Result<f64, VerificationError> {
    let load = |thickness: f64| of_ring(&mut FlatRing::new(thickness)?);
    Ok(2.0 * load(0.005)? - load(0.01)?)
}

/// Records the pressure at which opposite walls of a thin ring touch.
pub fn flat_ring(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("ring that flattens under outer pressure")?;
    recorder.relative(
        2e-3,
        "p R³/EI at which opposite walls touch, extrapolated to no thickness from H = 0.01 and 0.005 D",
        extrapolated(|ring| ring.zero([4.6, 4.9], FlatRing::gap))?,
        (touching_load()?, "elastica"),
    );
    Ok(())
}

/// Records the pressure at which opposite walls of a thin ring are flat where they touch.
pub fn flat_contact(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("ring that is flat where its walls touch")?;
    let load = extrapolated(|ring| {
        for pressure in [4.6, 5.2, 5.4] {
            ring.advance(pressure, 4)?;
        }
        ring.zero([9.4, 9.9], FlatRing::curvature_at_contact)
    })?;
    recorder.relative(
        5e-3,
        "p R³/EI at which their curvature is zero there, extrapolated to no thickness",
        load,
        (flat_load()?, "elastica"),
    );
    Ok(())
}

/// A fold that touches: its state, and the strain energy and contact of the outer wall on the whole tube.
struct Fold {
    load: Load,
    u: Vec<f64>,
    energy: f64,
    contact: FaceContact,
}

/// Records a fold that touches itself on sectors of several rings against that of one ring.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let text = include_str!("../../../../cases/invagination.toml");
    let plan = plica::case::read(text, "fold");
    let mut plan = plan.map_err(|error| VerificationError::Solve(error.to_string()))?;
    (plan.mesh.axial, plan.mesh.around, plan.mesh.thickness) = (70, 32, 4);
    let problem = |rings: usize| {
        let tube = SplineTube::new(&plan.tube, &plan.mesh, rings);
        touching(&TubeProblem::new(tube), 0.03)
    };
    let fold =
        |problem: &TubeProblem, path: &Path<TubeProblem>| -> Result<Fold, VerificationError> {
            let (load, u) = (path.state().load.clone(), path.state().u.clone());
            let report = problem.contact_report(&load, &u);
            let contact = report.and_then(|report| report.faces[0]);
            Ok(Fold {
                energy: problem.tube.forces(&load, &u)?.energy,
                contact: contact
                    .ok_or_else(|| VerificationError::Solve("the fold touches nowhere".into()))?,
                load,
                u,
            })
        };
    let ring = problem(1);
    let rest = vec![0.0; ring.tube.unknowns()];
    let mut path = Path::begin(ring.clone(), plan.tube.rest(), rest, tight_settings())?;
    let mut load = plan.tube.rest();
    for (muscle, target, steps) in [(0, 0.25, 5), (1, 1.45, 15)] {
        load.muscles[muscle] = target;
        path.begin_segment(load.clone());
        for step in 1..=steps {
            path.advance(f64::from(step) / f64::from(steps), &mut ())?;
        }
    }
    let one = fold(&ring, &path)?;
    for rings in [4, 32] {
        recorder.case(format!(
            "fold that touches itself, {rings} of 32 control rings"
        ))?;
        let problem = problem(rings);
        let of_ring = one.u.iter().flat_map(|x| std::iter::repeat_n(*x, rings));
        let start = of_ring.collect();
        let mut path = Path::begin(problem.clone(), one.load.clone(), start, tight_settings())?;
        path.begin_segment(one.load.clone());
        path.advance(1.0, &mut ())?;
        let found = fold(&problem, &path)?;
        let source = "one control ring";
        recorder.relative(1e-8, "W", found.energy, (one.energy, source));
        let (own, of_ring) = (found.contact, one.contact);
        recorder.relative(1e-3, "contact force", own.force, (of_ring.force, source));
        recorder.relative(1e-3, "smallest gap", own.gap, (of_ring.gap, source));
    }
    Ok(())
}
