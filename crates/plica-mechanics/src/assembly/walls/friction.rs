//! Friction of the walls on rigid obstacles.
//!
//! A point x of a wall that touches an obstacle at q is tied to a place on it, the anchor a, by a slip
//!
//! s = T (x − q − a), T = 1 − n ⊗ n,
//!
//! with the friction force μλ f₁(|s|) along s per area at rest ([`Slip`]): at most μλ, with λ the normal force. When a step
//! is accepted, the anchors of points that slide follow them, so that no slip exceeds its elastic part ε. This is the
//! elastic-plastic form of friction (Wriggers 2006). Slips from the last accepted state alone, as in incremental potential
//! contact (Li et al. 2020), would creep by up to ε in every step, and a result would depend on the number of steps.
//!
//! For the λ and T of some state the forces have a potential, ∫ μλ f₀(|s|) dA₀. To solve, to take λ and T of the solution,
//! and to solve again leads to the forces of Coulomb's law, which has no potential.

use super::super::SplineTube;
use super::super::coulomb::Slip;
use super::super::kinematics::Vector;
use super::PointContact;
use super::obstacles::{Copy, PlacedObstacle};
use crate::tube::{Load, turned};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The state from which a load step begins.
#[derive(Clone, Debug, PartialEq)]
pub struct StepStart {
    /// Its load.
    pub load: Load,
    /// Its unknowns.
    pub u: Vec<f64>,
    /// Its elastic slips, as [`SplineTube::elastic_slips`] returns them.
    pub slips: Vec<f64>,
}

/// Friction in a load step: limits of the forces, tangent planes and anchors.
#[derive(Clone, Debug)]
pub struct Friction {
    /// Of the inner and the outer wall.
    pub(super) walls: [Arc<WallFriction>; 2],
}

/// Friction on one wall.
#[derive(Debug)]
pub(super) struct WallFriction {
    /// The first contact of each quadrature point, and the number of contacts.
    first: Vec<usize>,
    contacts: Vec<FrictionContact>,
    /// ε.
    elastic: f64,
}

/// Friction of a point of a wall on a copy of an obstacle; vectors in the frame of the sector.
#[derive(Clone, Copy, Debug)]
struct FrictionContact {
    /// Number of the copy among the copies of all obstacles.
    copy: usize,
    normal: Vector<f64>,
    /// μλ per area at rest.
    limit: f64,
    /// The same at the start of the step.
    limit_at_start: f64,
    /// From the position of the copy.
    anchor: Vector<f64>,
}

/// Friction on a wall with the positions of the copies of the obstacles.
#[derive(Clone, Debug)]
pub struct PlacedFriction {
    pub(super) friction: Arc<WallFriction>,
    pub(super) positions: Vec<Vector<f64>>,
}

/// Friction of a tube on one obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ObstacleFriction {
    /// Sum of the sizes of the friction forces, in E·D².
    pub force: f64,
    /// Resultant of the friction forces on the obstacle, (z, x, y), in E·D²; on one of its copies, as
    /// [`ObstacleContact::reaction`](super::ObstacleContact::reaction).
    pub reaction: [f64; 3],
    /// Energy that has been dissipated since the start of the step, in E·D³.
    pub dissipated: f64,
}

impl SplineTube {
    /// Returns whether an obstacle of the tube has friction.
    pub fn has_friction(&self) -> bool {
        let mut obstacles = self.tube.obstacles.iter();
        obstacles.any(|obstacle| obstacle.friction > 0.0)
    }

    /// Returns the friction in a step from its start, with the normal forces and tangent planes of a state.
    pub fn friction(&self, start: &StepStart, load: &Load, u: &[f64]) -> Friction {
        let slips = start.slips.as_chunks::<5>().0.iter();
        let slips: BTreeMap<[usize; 2], Vector<f64>> = slips
            .map(|[point, copy, z, x, y]| ([*point as usize, *copy as usize], [*z, *x, *y]))
            .collect();
        let [before, now] = [&start.load, load].map(|load| self.placed_obstacles(load));
        let (before, now) = (copies(&before), copies(&now));
        let limit = |(obstacle, copy): (&PlacedObstacle, &Copy), x: Vector<f64>| {
            let coefficient = self.tube.obstacles[obstacle.number].friction;
            let distance = copy.shape.distance(&copy.placement, x);
            let pressed = coefficient > 0.0 && distance.gap < self.barrier.range;
            let force = pressed.then(|| -coefficient * self.barrier.continued(distance.gap).slope);
            (force, distance.normal)
        };
        let walls = self.friction_walls(None, load);
        let of_wall = |number: usize| {
            let (mut first, mut contacts) = (vec![], vec![]);
            self.visit_wall(
                &walls[number],
                [u, &start.u],
                |point, [x, x_at_start], _| {
                    first.push(contacts.len());
                    let place = number * self.points_of_wall() + point.number;
                    for (copy, (before, now)) in before.iter().zip(&now).enumerate() {
                        let ((own, normal), (at_start, _)) =
                            (limit(*now, x), limit(*before, x_at_start));
                        // A point that parts from the obstacle has dissipated energy, too.
                        if own.is_none() && at_start.is_none() {
                            continue;
                        }
                        let slip = slips.get(&[place, copy]).copied().unwrap_or_default();
                        let from = before.1.placement.position;
                        contacts.push(FrictionContact {
                            copy,
                            normal,
                            limit: own.unwrap_or(0.0),
                            limit_at_start: at_start.unwrap_or(0.0),
                            anchor: std::array::from_fn(|i| x_at_start[i] - from[i] - slip[i]),
                        });
                    }
                },
            );
            first.push(contacts.len());
            Arc::new(WallFriction {
                first,
                contacts,
                elastic: self.elastic_slip(),
            })
        };
        Friction {
            walls: [of_wall(0), of_wall(1)],
        }
    }

    /// Returns the elastic slips of a state at the end of a step, from which the next step begins: for each point that has
    /// one its number, that of the copy of the obstacle, and the slip (z, x, y).
    pub fn elastic_slips(&self, friction: &Friction, load: &Load, u: &[f64]) -> Vec<f64> {
        let mut slips = vec![];
        for (number, wall) in self.friction_walls(Some(friction), load).iter().enumerate() {
            let Some(friction) = &wall.friction else {
                continue;
            };
            self.visit_wall(wall, [u], |point, [x], _| {
                for contact in friction.contacts(point.number) {
                    let slip = friction.slip(contact, x);
                    let size = length(slip);
                    let kept = (friction.friction.elastic / size).min(1.0);
                    if size > 0.0 && contact.limit > 0.0 {
                        let place = number * self.points_of_wall() + point.number;
                        slips.extend([place as f64, contact.copy as f64]);
                        slips.extend(slip.map(|s| kept * s));
                    }
                }
            });
        }
        slips
    }

    /// Returns the friction of a state on each obstacle of the tube.
    pub fn friction_on_obstacles(
        &self,
        friction: &Friction,
        load: &Load,
        u: &[f64],
    ) -> Vec<ObstacleFriction> {
        let mut found = vec![ObstacleFriction::default(); self.tube.obstacles.len()];
        let placed = self.placed_obstacles(load);
        let copies = copies(&placed);
        for wall in self.friction_walls(Some(friction), load) {
            let Some(friction) = &wall.friction else {
                continue;
            };
            self.visit_wall(&wall, [u], |point, [x], area| {
                for contact in friction.contacts(point.number) {
                    let (obstacle, copy) = copies[contact.copy];
                    let slip = friction.slip(contact, x);
                    let size = length(slip);
                    let force =
                        area * contact.limit * Slip::at(size, friction.friction.elastic).secant;
                    let sum = &mut found[obstacle.number];
                    sum.force += force * size;
                    sum.dissipated += area
                        * 0.5
                        * (contact.limit_at_start + contact.limit)
                        * (size - friction.friction.elastic).max(0.0);
                    let own = obstacle.on_first_copy(copy, slip);
                    for (sum, slip) in sum.reaction.iter_mut().zip(own) {
                        *sum += force * slip;
                    }
                }
            });
        }
        found
    }
}

impl PlacedFriction {
    fn contacts(&self, point: usize) -> &[FrictionContact] {
        let first = &self.friction.first;
        &self.friction.contacts[first[point]..first[point + 1]]
    }

    /// Returns the slip of a point at x.
    fn slip(&self, contact: &FrictionContact, x: Vector<f64>) -> Vector<f64> {
        let (q, n) = (&self.positions[contact.copy], &contact.normal);
        let from: Vector<f64> = std::array::from_fn(|i| x[i] - q[i] - contact.anchor[i]);
        let normal: f64 = (0..3).map(|i| from[i] * n[i]).sum();
        std::array::from_fn(|i| from[i] - normal * n[i])
    }

    /// Returns the friction at a point of a wall, by its number and its position in the frame of an element; none where
    /// nothing touches it.
    pub(super) fn at(
        &self,
        point: usize,
        position: Vector<f64>,
        turn: (f64, f64),
    ) -> Option<PointContact> {
        let contacts = self.contacts(point);
        if contacts.is_empty() {
            return None;
        }
        let x = turned(position, turn);
        let mut found = PointContact::default();
        for contact in contacts {
            let (slip, n) = (self.slip(contact, x), contact.normal);
            let law = Slip::at(length(slip), self.friction.elastic);
            let slope = slip.map(|s| contact.limit * law.secant * s);
            let curvature = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    let identity = if i == j { 1.0 } else { 0.0 };
                    let along = law.second * slip[i] * slip[j];
                    contact.limit * (law.secant * (identity - n[i] * n[j]) + along)
                })
            });
            found.add(contact.limit * law.energy, slope, curvature, turn);
        }
        Some(found)
    }
}

/// Returns the copies of all obstacles.
pub(super) fn copies(obstacles: &[PlacedObstacle]) -> Vec<(&PlacedObstacle, &Copy)> {
    let of = |obstacle| PlacedObstacle::copies(obstacle).map(move |copy| (obstacle, copy));
    obstacles.iter().flat_map(of).collect()
}

fn length(v: Vector<f64>) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
