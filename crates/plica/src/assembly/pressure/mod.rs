//! Pressure on the inner and the outer wall: its potential, its forces, its part of the tangent.
//!
//! A follower pressure p presses on the wall as it is, along its normal. Its work is p dV, with V
//! what the wall encloses; its potential is −p V on the inner wall and +p V on the outer one, and
//!
//! V = ∫ ½ (x × dx)_z ∧ dz = ∫∫ ½ [(a b_s − b a_s) z_ζ − (a b_ζ − b a_ζ) z_s] dζ ds
//!
//! over the wall alone, (z, a, b) the current position in the frame of the element: across planes
//! z = const the form is nothing. Where every point of a wall's edge is given, or kept in such a
//! plane, the forces ∂V/∂u are those of the pressure on the wall, and nothing acts at the edge.
//! (At an edge that moves along z, what a lid would carry is missing; there the force depends on the way,
//! and no V has it as its slope.)
//!
//! A dead pressure presses on the wall as it is at rest: its potential is ∓p ∫ N · u dA₀, for any
//! ends.
//!
//! A wall is one surface, so plain loops do. V is taken without what it is at rest, so that
//! nothing is lost to rounding.

mod average;
mod coupled;
#[cfg(test)]
mod tests;
mod volume;

use super::SplineTube;
use super::kinematics::{Vector, turn, turn_back};
use super::spline_tube::Forces;
use super::tables::{Around, Slab};
use super::tangent::{Block, add_turned};
use crate::matrix::BlockBanded;
use crate::rings::Turn;
use crate::tube::{Load, Tube};
use rayon::prelude::*;
use volume::{Surface, product, sum, volume_blocks, volume_change, volume_slopes};

/// A wall with a pressure on it.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// Its control point through the wall; the splines are one there, all others zero.
    point: usize,
    /// Its radius at rest.
    radius: f64,
    /// What pushes it outwards, following it.
    follower: f64,
    /// What pushes it outwards, as if it were at rest.
    dead: f64,
}

/// The part of a tangent that pressure has: a state, and the walls that are pressed there.
#[derive(Clone, Debug)]
pub struct Pressed {
    walls: Vec<Wall>,
    u: Vec<f64>,
}

/// What the elements at one place along the tube add to the forces on a wall.
struct Part {
    /// Of the sector.
    potential: f64,
    /// Sum of the squares of what the elements add.
    squares: f64,
    /// For p + 1 rows of control points, component and ring.
    force: Vec<f64>,
}

/// An element along the tube: slab and lane.
type Along<'a> = (&'a Slab, usize);

impl SplineTube {
    /// Adds what pressures do to the energy and the residual of a state.
    pub(in crate::assembly) fn add_pressure(&self, load: &Load, u: &[f64], forces: &mut Forces) {
        let mut squares = forces.residual_scale * forces.residual_scale;
        for wall in self.pressed_walls(load) {
            let parts = self.sum_over(&wall, [u], |[moved], point| {
                let rest = wall.at_rest(point);
                let place = sum(&rest, &moved);
                let volume = volume_slopes(&place);
                let area = [
                    0.0,
                    wall.radius * point.circle_slope.1,
                    -wall.radius * point.circle_slope.0,
                ];
                let dead = moved[2][1] * area[1] + moved[2][2] * area[2];
                let potential = -wall.follower * volume_change(&rest, &moved) - wall.dead * dead;
                let mut slopes = volume.map(|v| v.map(|x| -wall.follower * x));
                for i in 0..3 {
                    slopes[2][i] -= wall.dead * area[i];
                }
                (potential, slopes)
            });
            for part in &parts {
                forces.potential += self.sector.repeats() * part.potential;
                squares += part.squares;
            }
            self.add_parts(&wall, &parts, 1.0, &mut forces.residual);
            forces.residual_scale = squares.sqrt();
        }
    }

    /// The pressed walls of a state, if a follower pressure makes them part of the tangent.
    pub(in crate::assembly) fn pressed(&self, load: &Load, u: &[f64]) -> Option<Pressed> {
        let walls = self.following_walls(load);
        let u = u.to_vec();
        (!walls.is_empty()).then_some(Pressed { walls, u })
    }

    /// y += factor · K v, K the part of the tangent that pressures have.
    pub(in crate::assembly) fn pressure_product(
        &self,
        at: &Pressed,
        factor: f64,
        v: &[f64],
        y: &mut [f64],
    ) {
        for wall in &at.walls {
            let parts = self.sum_over(wall, [&at.u, v], |[moved, v], point| {
                let blocks = volume_blocks(&sum(&wall.at_rest(point), &moved), -wall.follower);
                (0.0, product(&blocks, &v))
            });
            self.add_parts(wall, &parts, factor, y);
        }
    }

    /// Adds the part of the tangent that pressures have; `turns` as in
    /// [`slab_tangent`](super::tangent::slab_tangent).
    pub(in crate::assembly) fn add_pressure_tangent(
        &self,
        load: &Load,
        u: &[f64],
        turns: &[Vec<Vec<Turn>>],
        matrix: &mut BlockBanded,
    ) {
        for wall in self.following_walls(load) {
            let place = |i: usize, ring: usize| (wall.point * 3 + i) * self.sector.rings + ring;
            for along @ (slab, lane) in self.elements_along() {
                for qz in 0..=self.degree() {
                    let rings = self.rings_at(&wall, u, along, qz);
                    for element in 0..self.sector.rings {
                        for (point, turns) in self.around.iter().zip(turns) {
                            let moved = self.surface(&rings, element, point);
                            let weight = slab.weight[qz].0[lane] * point.weight;
                            let place_now = sum(&wall.at_rest(point), &moved);
                            let blocks = volume_blocks(&place_now, -wall.follower * weight);
                            for slots in turns {
                                for (r, row) in slots.iter().enumerate() {
                                    for (s, column) in slots.iter().enumerate() {
                                        let [r, s] = [r, s].map(|r| self.sector.ring(element, r));
                                        let turned = turned(&blocks, row, column);
                                        self.add_along(along, qz, &turned, |a, b, i, j, x| {
                                            if a >= b {
                                                let first = slab.first + lane;
                                                let (row, column) = (place(i, r), place(j, s));
                                                matrix.add_at(first + b, a - b, row, column, x);
                                            }
                                        });
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// Walls under any pressure.
    fn pressed_walls(&self, load: &Load) -> Vec<Wall> {
        let [inner, outer] = load.pressures;
        let walls = [
            Wall {
                point: 0,
                radius: self.tube.inner_radius(),
                follower: inner.follower,
                dead: inner.dead,
            },
            Wall {
                point: self.wall.functions() - 1,
                radius: Tube::OUTER_RADIUS,
                follower: -outer.follower,
                dead: -outer.dead,
            },
        ];
        let pressed = |wall: &Wall| wall.follower != 0.0 || wall.dead != 0.0;
        walls.into_iter().filter(pressed).collect()
    }

    fn following_walls(&self, load: &Load) -> Vec<Wall> {
        let mut walls = self.pressed_walls(load);
        walls.retain(|wall| wall.follower != 0.0);
        walls
    }

    fn elements_along(&self) -> impl Iterator<Item = Along<'_>> {
        self.slabs
            .iter()
            .flat_map(|slab| (0..slab.elements).map(move |lane| (slab, lane)))
    }

    /// Sums what is found at the points of a wall over each place along the tube. `of` takes fields
    /// at a point to a potential and to its slopes.
    fn sum_over<const F: usize>(
        &self,
        wall: &Wall,
        fields: [&[f64]; F],
        of: impl Fn([Surface; F], &Around) -> (f64, Surface) + Sync,
    ) -> Vec<Part> {
        let (n, k, slots) = (self.degree() + 1, self.sector.rings, self.sector.slots());
        let elements: Vec<Along<'_>> = self.elements_along().collect();
        let part = |&along: &Along<'_>| {
            let (slab, lane) = along;
            let mut potential = 0.0;
            // Of each element around: per row and slot.
            let mut forces = vec![[0.0; 3]; k * n * slots];
            for qz in 0..n {
                let rings = fields.map(|field| self.rings_at(wall, field, along, qz));
                for (element, forces) in forces.chunks_exact_mut(n * slots).enumerate() {
                    // Per slot: on the value and on the slope along.
                    let mut slot_forces = vec![[[0.0; 3]; 2]; slots];
                    for point in &self.around {
                        let weight = slab.weight[qz].0[lane] * point.weight;
                        let fields =
                            std::array::from_fn(|f| self.surface(&rings[f], element, point));
                        let (density, slopes) = of(fields, point);
                        potential += weight * density;
                        let [zeta, s, value] = slopes.map(|v| v.map(|x| weight * x));
                        for (slot, f) in point.slots.iter().zip(&mut slot_forces) {
                            f[0] = turn_back(slot, 1, s, turn_back(slot, 0, value, f[0]));
                            f[1] = turn_back(slot, 0, zeta, f[1]);
                        }
                    }
                    for (a, forces) in forces.chunks_exact_mut(slots).enumerate() {
                        let (value, slope) = self.along(along, qz, a);
                        for (force, [on_value, on_slope]) in forces.iter_mut().zip(&slot_forces) {
                            for i in 0..3 {
                                force[i] += value * on_value[i] + slope * on_slope[i];
                            }
                        }
                    }
                }
            }
            // Ring by ring, so that every ring adds up its elements in the same order.
            let mut force = vec![0.0; n * 3 * k];
            for (a, force) in force.chunks_exact_mut(3 * k).enumerate() {
                for (at, force) in force.iter_mut().enumerate() {
                    let (i, ring) = (at / k, at % k);
                    for r in 0..slots {
                        let element = (ring + k - r) % k;
                        *force += forces[(element * n + a) * slots + r][i];
                    }
                }
            }
            Part {
                potential,
                squares: forces.as_flattened().iter().map(|x| x * x).sum(),
                force,
            }
        };
        elements.par_iter().map(part).collect()
    }

    /// Adds forces on a wall to those on the unknowns.
    fn add_parts(&self, wall: &Wall, parts: &[Part], factor: f64, y: &mut [f64]) {
        let (m, row) = (self.row_size(), 3 * self.sector.rings);
        for (first, part) in parts.iter().enumerate() {
            for (a, force) in part.force.chunks_exact(row).enumerate() {
                let to = &mut y[(first + a) * m + wall.point * row..][..row];
                for (y, x) in to.iter_mut().zip(force) {
                    *y += factor * x;
                }
            }
        }
    }

    /// Value and slope along the tube of a function of an element.
    fn along(&self, (slab, lane): Along<'_>, qz: usize, a: usize) -> (f64, f64) {
        let at = qz * (self.degree() + 1) + a;
        (slab.value[at].0[lane], slab.slope[at].0[lane])
    }

    /// The displacement of the rings of a wall and its slope along, at a point along the tube.
    fn rings_at(
        &self,
        wall: &Wall,
        u: &[f64],
        along: Along<'_>,
        qz: usize,
    ) -> Vec<[Vector<f64>; 2]> {
        let (m, k) = (self.row_size(), self.sector.rings);
        let mut rings = vec![[[0.0; 3]; 2]; k];
        for a in 0..=self.degree() {
            let (value, slope) = self.along(along, qz, a);
            let row = &u[(along.0.first + along.1 + a) * m + wall.point * 3 * k..][..3 * k];
            for (j, ring) in rings.iter_mut().enumerate() {
                for i in 0..3 {
                    ring[0][i] += value * row[i * k + j];
                    ring[1][i] += slope * row[i * k + j];
                }
            }
        }
        rings
    }

    /// The displacement at a point of an element around, and its slopes.
    fn surface(&self, rings: &[[Vector<f64>; 2]], element: usize, point: &Around) -> Surface {
        let mut surface = [[0.0; 3]; 3];
        for (r, slot) in point.slots.iter().enumerate() {
            let [value, along] = rings[self.sector.ring(element, r)];
            surface[0] = turn(slot, 0, along, surface[0]);
            surface[1] = turn(slot, 1, value, surface[1]);
            surface[2] = turn(slot, 0, value, surface[2]);
        }
        surface
    }

    /// Hands on φ_α(a) φ_β(b) T_αβ, summed over the slopes α and β, for all rows a and b of an element.
    fn add_along(
        &self,
        along: Along<'_>,
        qz: usize,
        turned: &[[Block<f64>; 3]; 3],
        mut add: impl FnMut(usize, usize, usize, usize, f64),
    ) {
        let n = self.degree() + 1;
        // N′ with the slope over ζ, N with that over s and with the value.
        let functions = |a: usize| {
            let (value, slope) = self.along(along, qz, a);
            [slope, value, value]
        };
        for a in 0..n {
            for b in 0..n {
                let (row, column) = (functions(a), functions(b));
                for i in 0..3 {
                    for j in 0..3 {
                        let mut x = 0.0;
                        for alpha in 0..3 {
                            for beta in 0..3 {
                                x += row[alpha] * column[beta] * turned[alpha][beta][i][j];
                            }
                        }
                        add(a, b, i, j, x);
                    }
                }
            }
        }
    }
}

impl Wall {
    /// Position across the axis, and its slopes, at rest.
    fn at_rest(&self, point: &Around) -> Surface {
        let across = |(re, im): (f64, f64)| [0.0, self.radius * re, self.radius * im];
        [
            [1.0, 0.0, 0.0],
            across(point.circle_slope),
            across(point.circle),
        ]
    }
}

/// Blocks on the slopes of two slots.
fn turned(blocks: &[Block<f64>; 6], row: &Turn, column: &Turn) -> [[Block<f64>; 3]; 3] {
    let mut turned = [[[[0.0; 3]; 3]; 3]; 3];
    add_turned(&mut turned, blocks, row, column, false);
    turned
}
