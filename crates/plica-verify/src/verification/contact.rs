//! Contact with rigid obstacles: rings on rods, in sheaths and between plates.

use super::VerificationError;
use super::one_dimension::{Solution, Wall};
use super::report::Recorder;
use super::tube_model::{TubeModel, radial_displacement, solve_from_rest, tight_settings};
use plica::activation::Direction;
use plica::assembly::{Barrier, ObstacleContact};
use plica::equilibrium::TubeProblem;
use plica::solve::{Path, State};
use plica::tube::{Load, Obstacle, ObstacleShape, Placement};
use std::f64::consts::PI;

const A: f64 = 0.44;
const B: f64 = 0.5;
const NU: f64 = 0.495;
const STIFFNESS: f64 = 0.1;
const ENDLESS: ObstacleShape = ObstacleShape::Rod {
    half_length: f64::INFINITY,
};

/// A ring that an even circular muscle brings into contact with a rod or a sheath.
struct Case {
    shape: ObstacleShape,
    radius: f64,
    growth: f64,
    range: f64,
}

/// Quantities of such a ring, per length: contact pressure per current area, radius of the free surface, strain energy.
type Numbers = [f64; 3];

const NAMES: [&str; 3] = [
    "contact pressure",
    "radius of the free surface",
    "W per length",
];

impl Case {
    fn model(&self) -> TubeModel {
        let mut model = TubeModel::ring(B - A, NU, 8).with_uniform_muscle(Direction::Circular);
        model.tube.obstacles.push(Obstacle {
            name: "obstacle".into(),
            shape: self.shape,
            rest: Placement {
                radius: self.radius,
                position: [0.0; 3],
            },
            friction: 0.0,
        });
        model
    }

    fn is_rod(&self) -> bool {
        self.shape == ENDLESS
    }

    /// Solves the ring with Plica, with a number of control rings.
    fn solve(
        &self,
        model: &TubeModel,
        rings: usize,
    ) -> Result<(TubeProblem, State<Load>), VerificationError> {
        let problem = with_range(&model.problem(rings), self.range);
        let load = Load {
            muscles: vec![self.growth],
            ..model.tube.rest()
        };
        let state = solve_from_rest(&problem, &load, 10)?;
        Ok((problem, state))
    }

    fn numbers(&self) -> Result<Numbers, VerificationError> {
        let (problem, state) = self.solve(&self.model(), 1)?;
        let length = problem.tube.tube.length;
        let contact = contact(&problem, &state);
        let [touching, free] = if self.is_rod() { [A, B] } else { [B, A] };
        let radius = |R: f64| R + radial_displacement(&problem, &state, R);
        let area = 2.0 * PI * radius(touching) * length;
        Ok([
            contact.force / area,
            radius(free),
            problem.tube.forces(&state.load, &state.u)?.energy / length,
        ])
    }

    /// Solves the one-dimensional wall with the surface in contact at a gap from the obstacle. The gap is zero, or that
    /// at which the barrier gives the contact pressure.
    fn reference(&self, with_gap: bool) -> Result<Numbers, VerificationError> {
        let side = usize::from(!self.is_rod());
        let at_rest = [A, B][side];
        let solve = |p: f64| -> Result<Solution, VerificationError> {
            let mut wall = Wall::new([A, B], NU);
            wall.growth = [self.growth, 1.0];
            wall.pressures[side] = p;
            Ok(wall.solve(8)?)
        };
        // Force of the barrier per area at rest: kappa [2 (s - 1) ln s + (s - 1)^2 / s], s = g / range.
        let gap_of = |p: f64, r: f64| -> f64 {
            let force = |s: f64| STIFFNESS * (2.0 * (s - 1.0) * s.ln() + (s - 1.0) * (s - 1.0) / s);
            let (mut low, mut high) = (1e-6, 1.0);
            for _ in 0..100 {
                let s = 0.5 * (low + high);
                if force(s) > p * r / at_rest {
                    low = s
                } else {
                    high = s
                }
            }
            low * self.range
        };
        let (mut low, mut high) = (0.0, 0.3);
        for _ in 0..50 {
            let p = 0.5 * (low + high);
            // A wall under far too much pressure has no equilibrium.
            let Ok(solution) = solve(p) else {
                high = p;
                continue;
            };
            let r = solution.radii()[side];
            let gap = if with_gap { gap_of(p, r) } else { 0.0 };
            // Positive while the pressure is too small.
            let overlap = match self.is_rod() {
                true => self.radius + gap - r,
                false => r - (self.radius - gap),
            };
            if overlap > 0.0 { low = p } else { high = p }
        }
        let solution = solve(low)?;
        Ok([low, solution.radii()[1 - side], solution.energy()])
    }
}

/// Returns the contact pressure, per current area, of a wall that grows around by 1.2 into a sheath of radius 0.55, by the
/// one-dimensional solution held at the gap of the barrier.
pub(super) fn pressure_in_sheath(range: f64) -> Result<f64, VerificationError> {
    let case = Case {
        shape: ObstacleShape::Sheath,
        radius: 0.55,
        growth: 1.2,
        range,
    };
    Ok(case.reference(true)?[0])
}

/// Returns the problem with another range of contact.
fn with_range(problem: &TubeProblem, range: f64) -> TubeProblem {
    let barrier = Barrier {
        range,
        stiffness: STIFFNESS,
    };
    TubeProblem::new((*problem.tube).clone().with_barrier(barrier))
}

/// Returns the contact with the only obstacle.
fn contact(problem: &TubeProblem, state: &State<Load>) -> ObstacleContact {
    problem
        .tube
        .obstacle_contacts(&state.load, &state.u)
        .remove(0)
}

/// Records contact pressure, radius and energy of a ring that contracts onto a rod, and of one that grows into a sheath.
pub fn rings(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let rod = |range: f64| Case {
        shape: ENDLESS,
        radius: 0.2,
        growth: 0.4,
        range,
    };
    let sheath = |range: f64| Case {
        shape: ObstacleShape::Sheath,
        radius: 0.55,
        growth: 1.2,
        range,
    };
    // The rod: an independent code; the sheath: the one-dimensional solution.
    let known = [0.05420757, 0.25021923, 1.607037e-3];
    let exact = sheath(1e-3).reference(false)?;
    for (name, case, limit, source) in [
        (
            "ring that contracts onto a rod",
            &rod as &dyn Fn(f64) -> Case,
            known,
            "independent code",
        ),
        (
            "ring that grows into a sheath",
            &sheath,
            exact,
            "one-dimensional solution",
        ),
    ] {
        recorder.case(name)?;
        let ranges = [1e-3, 5e-4, 2.5e-4];
        let mut found = vec![];
        for range in ranges {
            found.push(case(range).numbers()?);
        }
        let reference = case(ranges[0]).reference(true)?;
        for (i, name) in NAMES.iter().enumerate() {
            let with_gap = format!("{name}, range 0.001");
            let source = "one-dimensional solution with the gap";
            recorder.relative(1e-6, with_gap, found[0][i], (reference[i], source));
        }
        for (i, name) in NAMES.iter().enumerate() {
            // Quadratic in the range.
            let [a, b, c] = [0, 1, 2].map(|k| found[k][i]);
            let (ab, bc) = (2.0 * b - a, 2.0 * c - b);
            let extrapolated = (4.0 * bc - ab) / 3.0;
            recorder.relative(
                1e-6,
                format!("{name}, extrapolated to no gap"),
                extrapolated,
                (limit[i], source),
            );
        }
    }
    Ok(())
}

/// Records the contact of a whole tube in three dimensions against that of one ring.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let case = Case {
        shape: ENDLESS,
        radius: 0.2,
        growth: 0.4,
        range: 1e-2,
    };
    let mut model = case.model();
    model.elements = [2, 24, 2];
    let (problem, one) = case.solve(&model, 1)?;
    let strain = |problem: &TubeProblem, state: &State<Load>| -> Result<f64, VerificationError> {
        Ok(problem.tube.forces(&state.load, &state.u)?.energy)
    };
    let (energy, force) = (strain(&problem, &one)?, contact(&problem, &one).force);
    for rings in [12, 24] {
        recorder.case(format!("ring on a rod, {rings} of 24 control rings"))?;
        let (problem, state) = case.solve(&model, rings)?;
        recorder.relative(
            1e-8,
            "W",
            strain(&problem, &state)?,
            (energy, "one control ring"),
        );
        let found = contact(&problem, &state).force;
        recorder.relative(1e-8, "contact force", found, (force, "one control ring"));
    }
    Ok(())
}

/// Records the height of a thin ring between two plates at two forces.
pub fn plates(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let thickness = 0.005;
    let middle = B - 0.5 * thickness;
    let mut model = TubeModel::new(0.05, thickness, 0.3, [1, 64, 1]);
    let plate = |x: f64| Placement {
        radius: 0.0,
        position: [0.0, x, 0.0],
    };
    model.tube.obstacles.push(Obstacle {
        name: "plate".into(),
        shape: ObstacleShape::Plate {
            normal: [0.0, -1.0, 0.0],
        },
        rest: plate(0.502),
        friction: 0.0,
    });
    // A sector of half the ring: the plate stands for two.
    let problem = with_range(&model.problem(32), 1e-3);
    let bending = (1.0 / (1.0 - 0.3 * 0.3)) * thickness.powi(3) / 12.0;
    let unit = bending * model.tube.length / (middle * middle);
    let u = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(&problem, model.tube.rest(), u, tight_settings())?;
    let mut advance = |x: f64, steps: usize| -> Result<[f64; 2], VerificationError> {
        let load = Load {
            obstacles: vec![plate(x)],
            ..model.tube.rest()
        };
        path.begin_segment(load);
        for n in 1..=steps {
            path.advance(n as f64 / steps as f64, &mut ())?;
        }
        let state = path.state();
        let force = contact(&problem, state).reaction[1] / unit;
        let at = plica::assembly::Point {
            z: 0.5 * model.tube.length,
            radius: middle,
            angle: 0.0,
        };
        let height = problem.tube.sample(&state.load, &state.u, at).position[1] / middle;
        Ok([force, height])
    };
    recorder.case("thin ring between plates, H/R = 0.01")?;
    for (target, height) in [(1.0, 0.91653), (2.0, 0.81324)] {
        let offset = B - middle;
        let mut x = [middle * height + offset, middle * height + offset - 2e-3];
        let mut at = [advance(x[0], 8)?, advance(x[1], 1)?];
        for _ in 0..3 {
            let next = x[1] + (target - at[1][0]) * (x[1] - x[0]) / (at[1][0] - at[0][0]);
            (x, at) = ([x[1], next], [at[1], advance(next, 1)?]);
        }
        recorder.relative(
            1e-6,
            format!("F R²/EI reached by moving the plate, {target}"),
            at[1][0],
            (target, "target"),
        );
        recorder.relative(
            5e-4,
            format!("half-height/R at F R²/EI = {target}"),
            at[1][1],
            (height, "elastica, thin limit"),
        );
    }
    Ok(())
}
