//! Coulomb friction on obstacles: a tube in a sheath that is pushed to and fro, and one that is pulled out of it.

use super::VerificationError;
use super::report::Recorder;
use super::tube_model::{TubeModel, tight_settings};
use plica::assembly::{Barrier, Point};
use plica::equilibrium::TubeProblem;
use plica::material::Law;
use plica::measure::Reaction;
use plica::solve::Path;
use plica::tube::{EndMotion, Load, Obstacle, ObstacleShape, Placement, Support, Tube};
use std::f64::consts::PI;

const BARRIER: Barrier = Barrier {
    range: 1e-3,
    stiffness: 0.1,
};

/// A tube in a sheath with friction.
struct Sheathed {
    problem: TubeProblem,
    path: Path<TubeProblem>,
    coefficient: f64,
}

impl Sheathed {
    /// Begins at rest; the largest elastic slip is in ranges of contact.
    fn new(
        mut model: TubeModel,
        coefficient: f64,
        elastic_slip: f64,
        rings: usize,
    ) -> Result<Self, VerificationError> {
        model.tube.obstacles.push(Obstacle {
            name: "sheath".into(),
            shape: ObstacleShape::Sheath,
            rest: Placement {
                radius: 0.51,
                position: [0.0; 3],
            },
            friction: coefficient,
        });
        let tube = (*model.problem(rings).tube).clone();
        let tube = tube.with_barrier(BARRIER).with_elastic_slip(elastic_slip);
        let problem = TubeProblem::new(tube);
        let u = vec![0.0; problem.tube.unknowns()];
        let rest = problem.tube.tube.rest();
        let path = Path::begin(problem.clone(), rest, u, tight_settings())?;
        Ok(Self {
            problem,
            path,
            coefficient,
        })
    }

    /// Goes to a radius and a place of the sheath, and a displacement of the end at z = 0, and returns the work on the
    /// sheath.
    fn go(&mut self, [radius, z, end]: [f64; 3], steps: usize) -> Result<f64, VerificationError> {
        let mut load = self.problem.tube.tube.rest();
        load.obstacles[0] = Placement {
            radius,
            position: [z, 0.0, 0.0],
        };
        load.ends[0] = EndMotion {
            displacement: end,
            ..EndMotion::default()
        };
        self.path.begin_segment(load);
        let mut work = 0.0;
        for n in 1..=steps {
            let at = |own: &Self| (own.place(), own.reaction());
            let before = at(self);
            self.path.advance(n as f64 / steps as f64, &mut ())?;
            let after = at(self);
            work -= 0.5 * (before.1 + after.1) * (after.0 - before.0);
        }
        Ok(work)
    }

    fn state(&self) -> (&Load, &[f64]) {
        let state = self.path.state();
        (&state.load, &state.u)
    }

    fn place(&self) -> f64 {
        self.path.state().load.obstacles[0].position[0]
    }

    fn contact(&self) -> plica::assembly::ObstacleContact {
        let (load, u) = self.state();
        self.path.problem().obstacle_contacts(load, u).remove(0)
    }

    /// Returns the axial force on the sheath.
    fn reaction(&self) -> f64 {
        self.contact().reaction[0]
    }

    /// Returns μN.
    fn limit(&self) -> f64 {
        self.coefficient * self.contact().force
    }

    fn dissipated(&self) -> f64 {
        let friction = self.contact().friction;
        friction.map_or(0.0, |friction| friction.dissipated)
    }

    /// Returns the forces of the supports along z.
    fn supports(&self) -> Result<f64, VerificationError> {
        let (load, u) = self.state();
        let forces = self.path.problem().forces_on_tube(load, u)?;
        let reactions = Reaction::of(&self.problem.tube, load, u, &forces.residual);
        Ok(reactions[0].axial_force() - reactions[1].axial_force())
    }

    /// Returns the tension of the wall at a section, from the stresses.
    fn tension(&self, z: f64) -> f64 {
        let (load, u) = self.state();
        let tube = &self.problem.tube.tube;
        let (inner, thickness) = (tube.inner_radius(), tube.thickness);
        let at = |x: f64| {
            let radius = inner + thickness * x;
            let point = Point {
                z,
                radius,
                angle: 0.0,
            };
            let Fe = self.problem.tube.sample(load, u, point).elastic;
            2.0 * PI * radius * thickness * tube.layers[0].material.stress(&Fe).0[0][0]
        };
        gauss([0.0, 1.0], 4, at)
    }

    /// Returns μ times the contact force of a part of the tube, from the gaps.
    fn limit_between(&self, part: [f64; 2]) -> f64 {
        let (load, u) = self.state();
        let at = |z: f64| {
            let point = Point {
                z,
                radius: Tube::OUTER_RADIUS,
                angle: 0.3,
            };
            let [_, x, y] = self.problem.tube.sample(load, u, point).position;
            let gap = load.obstacles[0].radius - x.hypot(y);
            let force = match gap < BARRIER.range {
                true => -BARRIER.continued(gap).slope,
                false => 0.0,
            };
            self.coefficient * force * 2.0 * PI * Tube::OUTER_RADIUS
        };
        gauss(part, 200, at)
    }
}

/// Integrates by two Gauss points on each of n parts.
fn gauss([from, to]: [f64; 2], n: usize, f: impl Fn(f64) -> f64) -> f64 {
    let h = (to - from) / n as f64;
    let part = |i: usize| {
        let middle = from + (i as f64 + 0.5) * h;
        let away = 0.5 * h / 3.0_f64.sqrt();
        0.5 * h * (f(middle - away) + f(middle + away))
    };
    (0..n).map(part).sum()
}

/// Records forces and work of a tube in a sheath that is pushed to and fro.
pub fn sliding(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("tube in a sheath that is pushed")?;
    let model = TubeModel::new(0.6, 0.06, 0.4, [24, 120, 2]);
    let mut tube = Sheathed::new(model, 0.2, 0.1, 1)?;
    tube.go([0.48, 0.0, 0.0], 5)?;
    tube.go([0.48, 0.02, 0.0], 4)?;
    recorder.relative(
        1e-9,
        "friction on the sheath",
        -tube.reaction(),
        (tube.limit(), "μN"),
    );
    recorder.relative(
        1e-6,
        "force of the supports",
        tube.supports()?,
        (tube.limit(), "μN"),
    );
    let part = [0.15, 0.45];
    let change = tube.tension(part[0]) - tube.tension(part[1]);
    let limit = tube.limit_between(part);
    recorder.relative(
        1e-3,
        "change of the tension, from stresses",
        change,
        (limit, "∫ μ p dA, from gaps"),
    );
    let begin = (tube.dissipated(), tube.limit());
    tube.go([0.48, 0.07, 0.0], 5)?;
    let work = tube.dissipated() - begin.0;
    recorder.relative(
        1e-6,
        "energy dissipated while all slides",
        work,
        (0.05 * begin.1, "μN times the slip"),
    );
    // To and fro: short steps where the friction turns.
    let start = tube.dissipated();
    let mut work = 0.0;
    for (z, steps) in [(0.06, 40), (0.0, 3), (0.01, 40), (0.07, 3)] {
        work += tube.go([0.48, z, 0.0], steps)?;
    }
    let lost = tube.dissipated() - start;
    recorder.relative(
        5e-3,
        "work on the sheath in a cycle",
        work,
        (lost, "energy dissipated"),
    );
    Ok(())
}

/// Records the force that pulls a tube out of a sheath against the closed form of a bar.
pub fn pull_out(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let (length, thickness, pull) = (1.0, 0.03, 2.5e-4);
    let find = |elastic: f64| -> Result<[f64; 5], VerificationError> {
        let mut model = TubeModel::new(length, thickness, 0.0, [80, 120, 1]);
        model.tube.ends = [Support::Sliding, Support::Free];
        let mut tube = Sheathed::new(model, 0.3, elastic, 1)?;
        tube.go([0.4975, 0.0, 0.0], 5)?;
        let limit = tube.limit();
        tube.go([0.4975, 0.0, -pull], 5)?;
        let partial = tube.reaction().abs();
        tube.go([0.4975, 0.0, -16.0 * pull], 5)?;
        Ok([
            limit,
            partial,
            tube.reaction().abs(),
            tube.limit(),
            tube.supports()?.abs(),
        ])
    };
    recorder.case("tube pulled out of a sheath")?;
    let found = [find(4e-3)?, find(2e-3)?, find(1e-3)?];
    let [limit, partial, all, limit_at_end, supports] = found[2];
    // The wall slides over a length l with q l = F and δ = q l²/(2 E A), q = μN/L.
    let section = PI * (1.0 - thickness) * thickness;
    let exact = (2.0 * section * limit / length * pull).sqrt();
    recorder.relative(
        2e-2,
        "force at δ, part of the tube sliding",
        partial,
        (exact, "√(2 E A μN δ/L)"),
    );
    recorder.relative(1e-6, "force when all slides", all, (limit_at_end, "μN"));
    recorder.relative(1e-5, "force of the support", supports, (limit_at_end, "μN"));
    let [a, b, c] = [0, 1, 2].map(|i| found[i][1]);
    recorder.relative(
        5e-3,
        "partial sliding, elastic slip halved",
        b,
        (a, "elastic slip ε"),
    );
    recorder.relative(
        2.5e-3,
        "partial sliding, halved again",
        c,
        (b, "elastic slip ε/2"),
    );
    Ok(())
}

/// Records friction in a sector and in the whole tube against that of one ring.
pub fn symmetries(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let find = |rings: usize| -> Result<[f64; 3], VerificationError> {
        let model = TubeModel::new(0.3, 0.06, 0.4, [6, 24, 1]);
        let mut tube = Sheathed::new(model, 0.2, 0.1, rings)?;
        tube.go([0.49, 0.0, 0.0], 4)?;
        tube.go([0.49, 2e-4, 0.0], 1)?;
        let part = tube.reaction();
        tube.go([0.49, 0.02, 0.0], 2)?;
        Ok([part, tube.reaction(), tube.dissipated()])
    };
    let one = find(1)?;
    for rings in [12, 24] {
        recorder.case(format!("tube in a sheath, {rings} of 24 control rings"))?;
        let found = find(rings)?;
        let names = [
            "friction, part sliding",
            "friction, all sliding",
            "energy dissipated",
        ];
        for ((name, found), one) in names.iter().zip(found).zip(one) {
            recorder.relative(1e-6, *name, found, (one, "one control ring"));
        }
    }
    Ok(())
}
