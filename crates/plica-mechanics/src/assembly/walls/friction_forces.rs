//! Forces of friction on obstacles, and every form of their tangent.
//!
//! Friction is a wall of its own, without pressures, at whose points it has energy, slope and curvature.

use super::super::kinematics::Vector;
use super::super::low_harmonics::LowHarmonics;
use super::super::{Forces, MatrixFreeTangent, SplineTube};
use super::friction::{Friction, PlacedFriction, copies};
use super::low_harmonics::add_form;
use super::{LoadedWall, WallTangent};
use crate::matrix::BlockBanded;
use crate::rings::Rotation;
use crate::tube::Load;

impl SplineTube {
    /// Adds potential and forces of friction to those of a state.
    pub fn add_friction(&self, friction: &Friction, load: &Load, u: &[f64], forces: &mut Forces) {
        let mut squares = forces.residual_scale * forces.residual_scale;
        for wall in self.friction_walls(Some(friction), load) {
            for [_, energy, _] in self.add_wall(&wall, u, &mut squares, forces) {
                forces.friction += self.sector.repeats() * energy;
            }
        }
    }

    /// Adds friction to the assembled tangent of a state.
    pub fn add_friction_tangent(
        &self,
        friction: &Friction,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        let rotations: Vec<Vec<Vec<Rotation>>> = self
            .around
            .iter()
            .map(|at| vec![at.ring_values.iter().map(Rotation::from).collect()])
            .collect();
        let walls = self.friction_walls(Some(friction), load);
        self.add_tangent_of_walls(&walls, u, &rotations, matrix);
    }

    /// Adds friction to a matrix-free tangent at its state.
    pub fn add_friction_to(
        &self,
        friction: &Friction,
        load: &Load,
        u: &[f64],
        tangent: &mut MatrixFreeTangent,
    ) {
        let walls = WallTangent {
            walls: self.friction_walls(Some(friction), load).into(),
            u: u.to_vec(),
        };
        self.add_average_walls(&walls, &mut tangent.average);
        match &mut tangent.walls {
            Some(own) => own.walls.extend(walls.walls),
            none => *none = Some(walls),
        }
    }

    /// Adds friction to the tangent on low harmonics, at all quadrature points.
    pub fn add_low_harmonic_friction(
        &self,
        low: &LowHarmonics,
        friction: &Friction,
        load: &Load,
        u: &[f64],
        matrix: &mut BlockBanded,
    ) {
        let columns = 3 * low.modes();
        let waves: Vec<Vec<f64>> = self
            .around
            .iter()
            .map(|at| low.waves_at(self, at.s))
            .collect();
        for (number, wall) in self.friction_walls(Some(friction), load).iter().enumerate() {
            // 1, t, t² at the wall.
            let through = [1.0, if number == 0 { -1.0 } else { 1.0 }, 1.0];
            for along @ (batch, lane) in self.elements_along() {
                for qz in 0..=self.degree() {
                    let rings = self.rings_along(wall, u, along, qz);
                    let mut own = vec![0.0; columns * columns];
                    let mut is_loaded = false;
                    for element in 0..self.sector.rings {
                        for (a, around) in self.around.iter().enumerate() {
                            let at = self.wall_point(wall, along, qz, [element, a], around);
                            let moved = self.surface_displacement(&rings, element, around);
                            let weight = batch.weight[qz].0[lane] * around.weight;
                            let Some(blocks) = self.wall_blocks(wall, &moved, &at, weight) else {
                                continue;
                            };
                            is_loaded = true;
                            let value = &waves[a][3 * element * columns..][..3 * columns];
                            add_form(value, &blocks[5], value, &mut own);
                        }
                    }
                    if !is_loaded {
                        continue;
                    }
                    for b in 0..=self.degree() {
                        for a in b..=self.degree() {
                            let both = self.along(along, qz, a).0 * self.along(along, qz, b).0;
                            for (x, row) in own.chunks_exact(columns).enumerate() {
                                for (y, entry) in row.iter().enumerate() {
                                    for (c, f) in through.iter().enumerate() {
                                        for (d, g) in through.iter().enumerate() {
                                            matrix.add_at(
                                                batch.first + lane + b,
                                                a - b,
                                                c * columns + x,
                                                d * columns + y,
                                                f * g * both * entry,
                                            );
                                        }
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// Returns the inner and the outer wall with friction alone.
    pub(super) fn friction_walls(
        &self,
        friction: Option<&Friction>,
        load: &Load,
    ) -> [LoadedWall; 2] {
        let placed = self.placed_obstacles(load);
        let positions: Vec<Vector<f64>> = copies(&placed)
            .iter()
            .map(|(_, copy)| copy.placement.position)
            .collect();
        [0, 1].map(|number| LoadedWall {
            friction: friction.map(|friction| PlacedFriction {
                friction: friction.walls[number].clone(),
                positions: positions.clone(),
            }),
            ..self.bare_wall(number)
        })
    }
}
