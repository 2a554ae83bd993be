//! Work between two states: done by the muscles, the growth of patches, the pressures and the supports of the ends, and on the obstacles.
//!
//! Along a path of equilibria
//!
//! dW + dΠ_f + dΠ_c = Σ ∂W/∂t dt + p_i dV_i − p_o dV_o + (the same of dead loads) + Σ R · du + Σ ∂Π_c/∂q dq,
//!
//! where t is the target of a muscle or a patch at fixed displacements, R the residual at the prescribed displacements u of the
//! ends, and q the radius or a coordinate of an obstacle. The work changes the strain energy W and the energies of
//! foundations Π_f and of contact Π_c. The trapezoidal rule between accepted states integrates each term with an error of second order in the step.

use super::Plan;
use crate::assembly::{Forces, ObstacleContact, SplineTube};
use crate::equilibrium::TubeProblem;
use crate::tube::Load;

/// Work of one step on the whole tube, in E·D³.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Work {
    /// By each muscle, in the order of the tube.
    pub muscles: Vec<f64>,
    /// By the pressures on the inner and on the outer wall.
    pub walls: [f64; 2],
    /// By the supports of the ends at z = 0 and z = L.
    pub ends: [f64; 2],
    /// On each obstacle, to move it and to change its radius, in the order of the tube.
    pub obstacles: Vec<f64>,
    /// By the growth of each patch, in the order of the tube.
    pub patches: Vec<f64>,
}

impl Work {
    /// Returns no work under a load.
    pub(super) fn none(load: &Load) -> Self {
        Self {
            muscles: vec![0.0; load.muscles.len()],
            obstacles: vec![0.0; load.obstacles.len()],
            patches: vec![0.0; load.patches.len()],
            ..Self::default()
        }
    }
}

/// Load, forces and energy of a state, from which the work of the steps before and after it is computed.
#[derive(Clone, Debug)]
pub(super) struct WorkPoint {
    load: Load,
    u: Vec<f64>,
    /// ∂W/∂t and ∂W/∂c of each muscle whose target t or shift c has changed in the step before.
    muscle_forces: Vec<[Option<f64>; 2]>,
    /// ∂W/∂t of each patch likewise.
    patch_forces: Vec<Option<f64>>,
    /// For each wall, the work of a unit follower pressure and of a unit dead load since rest.
    unit_work: [[f64; 2]; 2],
    /// Displacement and residual at the prescribed unknowns of each end, of one sector.
    ends: [Vec<[f64; 2]>; 2],
    contacts: Vec<ObstacleContact>,
    sectors: f64,
}

/// Change of the extreme stretch of a muscle, relative to its smallest stretch, in central differences: their error is
/// about 1e-8, and the rounding of the energy adds about 1e-12.
const STRETCH_STEP: f64 = 1e-4;

/// Smallest change of a tension, in E.
const TENSION_STEP: f64 = 1e-2;

/// Change of the shift of a muscle, in lengths of its zone, in central differences.
const SHIFT_STEP: f64 = 1e-5;

impl WorkPoint {
    /// Evaluates a state, whose forces are known.
    pub fn of(
        plan: &Plan,
        problem: &TubeProblem,
        (load, u): (&Load, &[f64]),
        forces: &Forces,
    ) -> Self {
        let tube = &problem.tube;
        let k = tube.sector.rings;
        let at_ends = tube.prescribed_at_ends();
        let row = tube.row_size();
        let end = |first: usize| {
            let unknowns = (first..first + row).filter(|unknown| at_ends[unknown / k]);
            unknowns.map(|i| [u[i], forces.residual[i]]).collect()
        };
        Self {
            muscle_forces: vec![[None; 2]; load.muscles.len()],
            patch_forces: vec![None; load.patches.len()],
            unit_work: match plan.has_pressures() {
                true => tube.work_of_unit_pressures(u),
                false => [[0.0; 2]; 2],
            },
            ends: [end(0), end(u.len() - row)],
            contacts: problem.obstacle_contacts(load, u),
            load: load.clone(),
            u: u.to_vec(),
            sectors: tube.sector.repeats(),
        }
    }

    /// Returns the contact with each obstacle.
    pub fn contacts(&self) -> &[ObstacleContact] {
        &self.contacts
    }

    /// Returns ∂W/∂t of a muscle, or ∂W/∂c for its shift.
    fn muscle_force(&self, tube: &SplineTube, m: usize, drive: MuscleDrive) -> f64 {
        let known = self.muscle_forces[m][drive as usize];
        known.unwrap_or_else(|| muscle_force(tube, &self.load, &self.u, m, drive))
    }

    /// Returns ∂W/∂t of a patch.
    fn patch_force(&self, tube: &SplineTube, i: usize) -> f64 {
        let known = self.patch_forces[i];
        known.unwrap_or_else(|| patch_force(tube, &self.load, &self.u, i))
    }

    /// Returns the work on the way from this state to the next.
    pub fn work_to(&self, next: &mut Self, tube: &SplineTube) -> Work {
        let trapezoid = |force: [f64; 2], change: f64| 0.5 * (force[0] + force[1]) * change;
        let mut muscles = vec![0.0; self.load.muscles.len()];
        for (m, work) in muscles.iter_mut().enumerate() {
            for drive in [MuscleDrive::Target, MuscleDrive::Shift] {
                let change = drive.change(&self.load, &next.load, m);
                if change != 0.0 {
                    let from = self.muscle_force(tube, m, drive);
                    let to = next.muscle_force(tube, m, drive);
                    next.muscle_forces[m][drive as usize] = Some(to);
                    *work += trapezoid([from, to], change);
                }
            }
        }
        let mut patches = vec![0.0; self.load.patches.len()];
        for (i, work) in patches.iter_mut().enumerate() {
            let change = next.load.patches[i] - self.load.patches[i];
            if change != 0.0 {
                let (from, to) = (self.patch_force(tube, i), next.patch_force(tube, i));
                next.patch_forces[i] = Some(to);
                *work = trapezoid([from, to], change);
            }
        }
        let next = &*next;
        let wall = |i: usize| {
            let change = [0, 1].map(|kind| next.unit_work[i][kind] - self.unit_work[i][kind]);
            let [from, to] = [self, next].map(|point| point.load.pressures[i]);
            trapezoid([from.follower, to.follower], change[0])
                + trapezoid([from.dead, to.dead], change[1])
        };
        let end = |i: usize| {
            let pairs = self.ends[i].iter().zip(&next.ends[i]);
            let work = |([u, r], [next_u, next_r]): (&[f64; 2], &[f64; 2])| {
                trapezoid([*r, *next_r], next_u - u)
            };
            self.sectors * pairs.map(work).sum::<f64>()
        };
        let obstacle = |i: usize| {
            let [from, to] = [self, next].map(|point| &point.contacts[i]);
            let [before, after] = [self, next].map(|point| &point.load.obstacles[i]);
            let by_radius = trapezoid(
                [from.radius_force, to.radius_force],
                after.radius - before.radius,
            );
            // The wall pushes the obstacle, and its support holds against that.
            let by_position = |k: usize| {
                let change = after.position[k] - before.position[k];
                -trapezoid([from.reaction[k], to.reaction[k]], change)
            };
            let copies = to.copies as f64;
            by_radius + copies * (0..3).map(by_position).sum::<f64>()
        };
        Work {
            obstacles: (0..self.contacts.len()).map(obstacle).collect(),
            muscles,
            patches,
            walls: [0, 1].map(wall),
            ends: [0, 1].map(end),
        }
    }
}

/// A quantity that drives a muscle.
#[derive(Clone, Copy)]
enum MuscleDrive {
    /// Its target.
    Target = 0,
    /// The shift of its zone.
    Shift = 1,
}

impl MuscleDrive {
    fn of(self, load: &mut Load, m: usize) -> &mut f64 {
        match self {
            Self::Target => &mut load.muscles[m],
            Self::Shift => &mut load.shifts[m],
        }
    }

    /// Returns the change between two loads.
    fn change(self, from: &Load, to: &Load, m: usize) -> f64 {
        match self {
            Self::Target => to.muscles[m] - from.muscles[m],
            Self::Shift => to.shifts[m] - from.shifts[m],
        }
    }
}

/// Returns the derivative of the strain energy of the whole tube by the target or the shift of a muscle, at fixed
/// displacements.
fn muscle_force(tube: &SplineTube, load: &Load, u: &[f64], m: usize, drive: MuscleDrive) -> f64 {
    let (muscle, target, length) = (&tube.tube.muscles[m], load.muscles[m], tube.tube.length);
    let smallest = muscle.smallest_stretch(target, length);
    let h = match drive {
        // The energy is linear in a tension.
        MuscleDrive::Target if !muscle.grows() => target.max(TENSION_STEP),
        MuscleDrive::Target => {
            let slope = muscle.extreme_stretch(1.0, length) - muscle.extreme_stretch(0.0, length);
            STRETCH_STEP * smallest / slope
        }
        MuscleDrive::Shift => {
            let change = (muscle.extreme_stretch(target, length) - 1.0).abs();
            let zone = muscle.zone[1] - muscle.zone[0];
            SHIFT_STEP * zone * smallest / change.max(smallest)
        }
    };
    energy_slope(tube, (load, u), h, |load, h| *drive.of(load, m) += h)
}

/// Returns the derivative of the strain energy of the whole tube by the growth of a patch, at fixed displacements.
fn patch_force(tube: &SplineTube, load: &Load, u: &[f64], i: usize) -> f64 {
    let h = STRETCH_STEP * load.patches[i].min(1.0);
    energy_slope(tube, (load, u), h, |load, h| load.patches[i] += h)
}

/// Returns the central difference of the strain energy over a step h of a target.
fn energy_slope(
    tube: &SplineTube,
    (load, u): (&Load, &[f64]),
    h: f64,
    change: impl Fn(&mut Load, f64),
) -> f64 {
    let energy = |h: f64| {
        let mut load = load.clone();
        change(&mut load, h);
        // Growth does not change the sign of det Fe.
        let Ok(forces) = tube.forces(&load, u) else {
            unreachable!("an accepted state is not inverted")
        };
        forces.energy
    };
    (energy(h) - energy(-h)) / (2.0 * h)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::plan;
    use super::super::{Row, Scale, Stage, State, Study};
    use super::*;
    use crate::activation::{Direction, Muscle, Profile};
    use crate::tube::{EndMotion, Obstacle, ObstacleShape, Placement};
    use crate::tube::{Pressure, Support, Symmetry};

    /// A tube with two muscles, pressures on both walls and a pushed and twisted end, all driven at a time.
    fn driven(steps: usize) -> Plan {
        let mut plan = plan(Symmetry::Axisymmetric);
        let muscle = |name: &str, direction| {
            Muscle::new(name.into(), direction, [0.1, 0.8], Profile::RaisedCosine)
        };
        plan.tube.muscles = vec![
            muscle("circular", Direction::Circular),
            muscle("longitudinal", Direction::Longitudinal),
        ];
        plan.tube.ends = [Support::Fixed; 2];
        plan.mesh.axial = 9;
        plan.output.stability_modes = 0;
        plan.solver.tolerance = 1e-10;
        let pressure = |follower, dead| Pressure { follower, dead };
        let load = Load {
            muscles: vec![0.8, 1.1],
            shifts: vec![0.1, -0.05],
            ends: [
                EndMotion {
                    displacement: -0.05,
                    ..EndMotion::default()
                },
                EndMotion {
                    displacement: 0.02,
                    twist: 0.2,
                    ..EndMotion::default()
                },
            ],
            pressures: [pressure(0.01, 0.002), pressure(-0.005, 0.003)],
            lumen_volume: None,
            obstacles: vec![],
            patches: vec![],
        };
        let back = Load {
            muscles: vec![0.7, 1.0],
            ..load.clone()
        };
        let stage = |name: &str, load| Stage::new(name.into(), load, steps);
        plan.stages = vec![stage("all", load), stage("back", back)];
        plan
    }

    /// The same tube, which a sheath squeezes while a ball moves into its lumen.
    fn squeezed(steps: usize) -> Plan {
        let mut plan = driven(steps);
        let obstacle = |name: &str, shape, radius, z| Obstacle {
            name: name.into(),
            shape,
            rest: Placement {
                radius,
                position: [z, 0.0, 0.0],
            },
            friction: 0.0,
        };
        plan.tube.obstacles = vec![
            obstacle("sheath", ObstacleShape::Sheath, 0.58, 0.0),
            obstacle("ball", ObstacleShape::Ball, 0.4, -0.4),
        ];
        let [sheath, ball] = [0, 1].map(|i| plan.tube.obstacles[i].rest);
        for (stage, [radius, z]) in plan.stages.iter_mut().zip([[0.515, -0.1], [0.505, 0.4]]) {
            let sheath = Placement { radius, ..sheath };
            let position = [z, 0.0, 0.0];
            stage.load.obstacles = vec![sheath, Placement { position, ..ball }];
        }
        plan
    }

    /// The same tube, with friction.
    fn rubbed(steps: usize) -> Plan {
        let mut plan = squeezed(steps);
        for obstacle in &mut plan.tube.obstacles {
            obstacle.friction = 0.2;
        }
        plan
    }

    fn rows(plan: &Plan) -> Vec<Row> {
        let mut rows: Vec<Row> = vec![];
        for state in Study::new(plan).unwrap() {
            let row = Row::new(&state.unwrap(), &Scale::of(None), true, rows.last());
            rows.push(row);
        }
        rows
    }

    #[test]
    fn the_energy_balance_closes_with_second_order_in_the_step() {
        let gap = |steps: usize| {
            let rows = rows(&driven(steps));
            assert_eq!(rows.len(), 1 + 2 * steps);
            let last = rows.last().unwrap();
            let muscles: f64 = last.muscles.iter().map(|m| m.work).sum();
            let ends: f64 = last.ends.iter().map(|end| end.work).sum();
            let walls = last.inner_wall_work.unwrap() + last.outer_wall_work.unwrap();
            let parts = [muscles, ends, walls];
            // No part is too small to count.
            let all: f64 = parts.iter().map(|x| x.abs()).sum();
            assert!(parts.iter().all(|x| x.abs() > 0.01 * all), "{parts:?}");
            let gap = muscles + ends + walls - (last.energy - rows[0].energy);
            assert!((gap - last.released_energy).abs() < 1e-12 * all);
            (gap / all).abs()
        };
        let [coarse, fine] = [4, 8].map(gap);
        println!("{coarse:e} {fine:e}");
        assert!(coarse < 2e-2 && fine < coarse / 3.5, "{coarse} {fine}");
    }

    #[test]
    fn the_energy_balance_closes_with_obstacles_that_move() {
        let gap = |steps: usize| {
            let rows = rows(&squeezed(steps));
            assert_eq!(rows.len(), 1 + 2 * steps);
            let last = rows.last().unwrap();
            let obstacles: Vec<f64> = last.obstacles.iter().map(|o| o.work).collect();
            let muscles: f64 = last.muscles.iter().map(|m| m.work).sum();
            let ends: f64 = last.ends.iter().map(|end| end.work).sum();
            let walls = last.inner_wall_work.unwrap() + last.outer_wall_work.unwrap();
            let parts = [muscles, ends, walls, obstacles[0], obstacles[1]];
            let all: f64 = parts.iter().map(|x| x.abs()).sum();
            assert!(parts.iter().all(|x| x.abs() > 5e-4 * all), "{parts:?}");
            for obstacle in &last.obstacles {
                assert!(obstacle.gap > 0.0 && obstacle.force > 0.0, "{obstacle:?}");
                assert!(
                    0.0 < obstacle.from && obstacle.from < obstacle.to,
                    "{obstacle:?}"
                );
            }
            let contact: f64 = last.obstacles.iter().map(|o| o.energy).sum();
            let sum: f64 = parts.iter().sum();
            let gap = sum - (last.energy + contact - rows[0].energy);
            assert!((gap - last.released_energy).abs() < 1e-12 * all);
            (gap / all).abs()
        };
        let [coarse, fine] = [8, 16].map(gap);
        println!("{coarse:e} {fine:e}");
        assert!(coarse < 5e-2 && fine < coarse, "{coarse} {fine}");
    }

    #[test]
    fn the_energy_balance_closes_with_friction() {
        let gap = |steps: usize| {
            let rows = rows(&rubbed(steps));
            assert_eq!(rows.len(), 1 + 2 * steps);
            for pair in rows.windows(2) {
                let [before, after] = [0, 1].map(|i| pair[i].obstacles[1].friction_work.unwrap());
                assert!(before <= after && pair[1].residual <= 1e-6, "{:?}", pair[1]);
            }
            let last = rows.last().unwrap();
            let lost: f64 = last.obstacles.iter().filter_map(|o| o.friction_work).sum();
            let work = last.obstacles.iter().map(|o| o.work.abs()).sum::<f64>()
                + last.muscles.iter().map(|m| m.work.abs()).sum::<f64>();
            assert!(lost > 0.01 * work, "{lost} of {work}");
            for obstacle in &last.obstacles {
                let friction = obstacle.friction_force.unwrap();
                assert!(friction <= 0.2 * obstacle.force * (1.0 + 1e-12));
            }
            (last.released_energy / work).abs()
        };
        let [coarse, fine] = [8, 16].map(gap);
        println!("{coarse:e} {fine:e}");
        assert!(coarse < 5e-2 && fine < coarse, "{coarse} {fine}");
    }

    #[test]
    fn a_plate_that_the_symmetry_repeats_has_the_work_of_two() {
        let pressed = |symmetry, signs: &[f64]| {
            let mut plan = plan(symmetry);
            plan.tube.ends = [Support::Fixed; 2];
            plan.mesh.axial = 9;
            plan.output.stability_modes = 0;
            plan.solver.tolerance = 1e-9;
            let placement = |x: f64| Placement {
                radius: 0.0,
                position: [0.0, x, 0.0],
            };
            let plate = |sign: &f64| Obstacle {
                name: format!("plate{sign}"),
                shape: ObstacleShape::Plate {
                    normal: [0.0, -sign, 0.0],
                },
                rest: placement(0.6 * sign),
                friction: 0.0,
            };
            plan.tube.obstacles = signs.iter().map(plate).collect();
            let load = Load {
                obstacles: signs.iter().map(|sign| placement(0.515 * sign)).collect(),
                ..plan.tube.rest()
            };
            plan.stages = vec![Stage::new("press".into(), load, 3)];
            rows(&plan).pop().unwrap()
        };
        let half = pressed(Symmetry::Fold(2), &[1.0]);
        let whole = pressed(Symmetry::None, &[1.0, -1.0]);
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
        assert!(
            half.energy > 1e-9 && near(half.energy, whole.energy),
            "{half:?}\n{whole:?}"
        );
        let works: Vec<f64> = whole.obstacles.iter().map(|o| o.work).collect();
        assert!(works[0] > 0.0 && near(works[0], works[1]), "{works:?}");
        assert!(
            near(half.obstacles[0].work, works[0] + works[1]),
            "{works:?}"
        );
        let [x, _, _] = half.obstacles[0].reaction;
        assert!(x > 0.0 && near(x, whole.obstacles[0].reaction[0]), "{x}");
        assert!(near(-x, whole.obstacles[1].reaction[0]), "{x}");
        let force = |row: &Row| row.obstacles.iter().map(|o| o.force).sum::<f64>();
        assert!(near(force(&half), force(&whole)));
    }

    #[test]
    fn a_cyclic_sector_has_the_work_of_the_whole_tube() {
        use crate::solve::{Integrator, PseudoTime, Scheme};
        let mut plan = driven(1);
        plan.stages.truncate(1);
        plan.solver.scheme = Scheme::PseudoTime(PseudoTime {
            integrator: Integrator::BackwardEuler,
            damping: 1.0,
            ramp: 2,
            tolerance: 1e-4,
            ..PseudoTime::default()
        });
        let of_ring = rows(&plan);
        plan.symmetry = Symmetry::Fold(2);
        let of_half = rows(&plan);
        let mut compared = 0;
        for (ring, half) in of_ring.iter().zip(&of_half) {
            for (a, b) in ring.cells().iter().zip(half.cells()) {
                let is_work = ["work", "damping", "energy", "potential", "released"]
                    .iter()
                    .any(|name| a.name.starts_with(name));
                if !is_work {
                    continue;
                }
                let (a, b) = (a.number().unwrap(), b.number().unwrap());
                assert!(
                    (a - b).abs() < 1e-6 * ring.energy.max(1e-9),
                    "{a} {b} {ring:?}"
                );
                compared += usize::from(a.abs() > 1e-3 * ring.energy && ring.energy > 0.0);
            }
        }
        assert!(compared > 7, "{compared}");
        assert!(
            of_ring[1].damping_work > 0.01 * of_ring[1].energy,
            "{of_ring:?}"
        );
    }

    #[test]
    fn a_resumed_study_does_the_same_work_to_the_bit() {
        for plan in [squeezed(2), rubbed(2)] {
            let mut study = Study::new(&plan).unwrap();
            let (mut works, mut continuations) = (vec![], vec![]);
            let of = |state: State| (state.work, state.obstacles, state.unknowns);
            while let Some(state) = study.next() {
                works.push(of(state.unwrap()));
                continuations.push(study.continuation().unwrap());
            }
            for number in [0, 1, 2, 3] {
                let resumed = Study::resume(&plan, continuations[number].clone()).unwrap();
                let rest: Vec<_> = resumed.map(|state| of(state.unwrap())).collect();
                assert!(rest == works[number + 1..], "after state {number}");
            }
        }
    }

    #[test]
    fn every_column_scales_with_the_units_of_the_case() {
        use super::super::{LengthUnit, StressUnit, Units};
        let plan = driven(1);
        let scale = Scale::of(Some(&Units {
            length: LengthUnit::Millimetre,
            stress: StressUnit::Kilopascal,
            diameter: 25.0,
            youngs_modulus: 20.0,
        }));
        let (mut plain, mut scaled): (Vec<Row>, Vec<Row>) = (vec![], vec![]);
        for state in Study::new(&plan).unwrap() {
            let mut state = state.unwrap();
            // Lengths that are zero along this path.
            (state.measures.overhang, state.measures.asymmetry.amplitude) = (0.3, 0.2);
            plain.push(Row::new(&state, &Scale::of(None), true, plain.last()));
            scaled.push(Row::new(&state, &scale, true, scaled.last()));
        }
        let (length, stress) = (25.0_f64, 20.0);
        let factor = |name: &str| match name {
            _ if name.starts_with("displacement_") || name.starts_with("shift_") => length,
            "outer_radius_min" | "outer_radius_max" | "outer_radius_mid" => length,
            "z_at_min" | "overhang" | "gap" | "lumen" | "asymmetry" => length,
            "lumen_volume" => length.powi(3),
            "lumen_area_min" => length.powi(2),
            "inner_pressure" | "outer_pressure" | "inner_dead_load" | "outer_dead_load" => stress,
            // kPa mm² is mN; kPa mm³ is uN m and uJ.
            _ if name.contains("_force_") => stress * length.powi(2),
            "potential"
            | "energy"
            | "energy_ungrown_volume"
            | "damping_work"
            | "released_energy" => stress * length.powi(3),
            _ if name.starts_with("torque_") || name.starts_with("bending_moment_") => {
                stress * length.powi(3)
            }
            _ if name.starts_with("work_") => stress * length.powi(3),
            _ => 1.0,
        };
        assert_eq!(scale.unit(super::super::Quantity::Force), Some("mN"));
        assert_eq!(scale.unit(super::super::Quantity::Moment), Some("uN m"));
        let mut different = std::collections::BTreeSet::new();
        for (plain, scaled) in plain.iter().zip(&scaled) {
            for (a, b) in plain.cells().iter().zip(scaled.cells()) {
                let Some(x) = a.number() else {
                    assert_eq!(a.text, b.text);
                    continue;
                };
                let expected = factor(&a.name) * x;
                // Totals are sums of scaled numbers that nearly cancel.
                let rounding = 1e-12 * expected.abs() + 1e-16 * factor(&a.name);
                let found = b.number().unwrap();
                assert!(
                    (found - expected).abs() <= rounding,
                    "{}: {found} {expected}",
                    a.name
                );
                assert!((scale.factor(a.quantity) / factor(&a.name) - 1.0).abs() < 1e-12);
                if factor(&a.name) != 1.0 && x != 0.0 {
                    different.insert(a.name.clone());
                }
            }
        }
        // Every column with a unit but those of asymmetric tubes and of damping is compared at some state.
        let cells = plain[0].cells();
        let with_unit = cells.iter().map(|cell| cell.name.clone());
        let missing: Vec<String> = with_unit
            .filter(|name| factor(name) != 1.0 && !different.contains(name))
            .collect();
        let zero = |name: &String| {
            ["shear_force_", "bending_moment_", "damping_work"]
                .iter()
                .any(|zero| name.starts_with(zero))
        };
        assert!(missing.iter().all(zero), "{missing:?}");
    }
}
