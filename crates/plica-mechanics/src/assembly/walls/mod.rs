//! Pressure on the inner and the outer wall, foundations of the outer wall, contact with obstacles and friction on them:
//! energy, forces and tangent.
//!
//! A follower pressure p acts on the deformed wall, along its normal. Its work is p dV, with V the
//! volume that the wall encloses; its potential is −p V on the inner wall and +p V on the outer
//! one, and
//!
//! V = ∫ ½ (x × dx)_z ∧ dz = ∫∫ ½ [(a b_s − b a_s) z_ζ − (a b_ζ − b a_ζ) z_s] dζ ds
//!
//! over the wall alone, with (z, a, b) the current position in the frame of the element: on planes
//! z = const the integrand vanishes. If every point of a wall's edge is prescribed, or stays in
//! such a plane, the forces ∂V/∂u are those of the pressure on the wall, and none act at the edge.
//! (At an edge that moves along z, the force on a lid would be missing; the force then depends on
//! the path, and has no potential.)
//!
//! A dead load acts on the wall at rest: its potential is ∓p ∫ N · u dA₀, for any ends. Area and normal are those of the
//! cylinder or, where the diameter or the thickness varies along the tube, of that shape.
//!
//! A wall is one surface, so plain loops are fast enough, compiled for processors with fused
//! multiply-add. V is computed relative to its value at rest, which avoids rounding.

mod average;
mod foundation;
#[cfg(test)]
mod foundation_tests;
mod friction;
mod friction_forces;
#[cfg(test)]
mod friction_tests;
mod low_harmonics;
mod lumen;
#[cfg(test)]
mod obstacle_tests;
mod obstacles;
#[cfg(test)]
mod tests;
mod volume;

pub use friction::{Friction, ObstacleFriction, StepStart};
pub use obstacles::ObstacleContact;

use super::Forces;
use super::SplineTube;
use super::barrier::Barrier;
use super::blocks::{Block, add_rotated};
use super::kinematics::{Vector, to_element_frame, to_ring_frame};
use super::tables::{AxialBatch, CircumferentialPoint};
use crate::matrix::BlockBanded;
use crate::rings::Rotation;
use crate::tensor::with_vectors;
use crate::tube::{Load, Pressure, Tube, turned};
use friction::PlacedFriction;
use obstacles::{PlacedObstacle, PointContact};
use rayon::prelude::*;
use volume::{Surface, product, sum, volume_blocks, volume_change, volume_slopes};

/// A wall under pressure, on a foundation, or near obstacles.
#[derive(Clone, Debug)]
pub struct LoadedWall {
    /// Its control point through the wall: there its basis function is one, all others zero.
    point: usize,
    /// Radius at rest.
    radius: f64,
    /// Outward follower pressure.
    follower: f64,
    /// Outward dead load.
    dead: f64,
    /// True if the foundations of the tube act on it.
    has_foundations: bool,
    /// True if its shape at rest varies along the tube by design. Areas and normals at rest are then those of that shape,
    /// not those of the cylinder of constant diameter.
    is_outlined: bool,
    obstacles: Vec<PlacedObstacle>,
    barrier: Barrier,
    friction: Option<PlacedFriction>,
}

/// Contribution of the walls to a tangent: those under follower pressure, on foundations or near obstacles, and the state.
#[derive(Clone, Debug)]
pub struct WallTangent {
    walls: Vec<LoadedWall>,
    u: Vec<f64>,
}

/// Contribution of the elements at one axial position to the forces on a wall.
struct WallForces {
    /// Energies of the sector.
    energies: Energies,
    /// Sum of the squares of the element contributions.
    squares: f64,
    /// Forces on p + 1 rows of control points, by component and ring.
    force: Vec<f64>,
}

/// Potential of the pressures, energy of contact and energy of the foundations.
type Energies = [f64; 3];

/// A quadrature point of a wall.
#[derive(Clone, Copy)]
struct WallPoint<'a> {
    /// Element around the sector.
    element: usize,
    /// Number among the quadrature points of the wall; of no meaning without friction.
    number: usize,
    /// Axial position at rest.
    z: f64,
    around: &'a CircumferentialPoint,
    /// Displacement of the stress-free shape in the frame of the element, and its slopes; zero on a wall on which neither
    /// foundations nor dead loads act.
    shape: Surface,
}

/// An element along the tube: axial batch and lane.
type Along<'a> = (&'a AxialBatch, usize);

impl SplineTube {
    /// Adds energies and forces of pressure, foundations and contact with obstacles to those of a state.
    pub(in crate::assembly) fn add_walls(&self, load: &Load, u: &[f64], forces: &mut Forces) {
        let mut squares = forces.residual_scale * forces.residual_scale;
        for wall in self.loaded_walls(load) {
            let energies = self.add_wall(&wall, u, &mut squares, forces);
            for [potential, contact, foundation] in energies {
                forces.potential += self.sector.repeats() * (potential + foundation);
                forces.contact += self.sector.repeats() * contact;
                forces.foundation += self.sector.repeats() * foundation;
            }
        }
    }

    /// Adds the forces on a wall to those of a state, and its squares to those of the residual scale. Returns the energies
    /// of the sector, by element along.
    fn add_wall(
        &self,
        wall: &LoadedWall,
        u: &[f64],
        squares: &mut f64,
        forces: &mut Forces,
    ) -> Vec<Energies> {
        let parts = self.integrate_over_wall(wall, [u], |[moved], point| {
            let position = sum(&wall.at_rest(point), &moved);
            let volume = volume_slopes(&position);
            let area = wall.area_at_rest(point);
            let potential = wall.potential(&moved, point);
            let mut slopes = volume.map(|v| v.map(|x| -wall.follower * x));
            for i in 0..3 {
                slopes[2][i] -= wall.dead * area[i];
            }
            let mut contact = 0.0;
            if let Some(at) = self.contact_at(wall, &position, point) {
                let area = wall.area(point);
                contact = area * at.energy;
                for i in 0..3 {
                    slopes[2][i] += area * at.slope[i];
                }
            }
            let mut foundation = 0.0;
            if let Some(at) = self.foundation_at(wall, moved[2], point) {
                let area = wall.foundation_area(point);
                foundation = area * at.energy;
                for i in 0..3 {
                    slopes[2][i] += area * at.slope[i];
                }
            }
            ([potential, contact, foundation], slopes)
        });
        *squares = parts.iter().fold(*squares, |sum, part| sum + part.squares);
        self.add_wall_forces(wall, &parts, 1.0, &mut forces.residual);
        forces.residual_scale = squares.sqrt();
        parts.iter().map(|part| part.energies).collect()
    }

    /// Returns the work since rest, on the whole tube, of a unit follower pressure and of a unit
    /// dead load on the inner wall and on the outer wall.
    pub fn work_of_unit_pressures(&self, u: &[f64]) -> [[f64; 2]; 2] {
        let unit = |follower: f64, dead: f64| Pressure { follower, dead };
        let [follower, dead] = [unit(1.0, 0.0), unit(0.0, 1.0)].map(|pressure| {
            let load = Load {
                pressures: [pressure; 2],
                obstacles: vec![],
                ..self.tube.rest()
            };
            let work = |wall: &LoadedWall| {
                let parts = self.integrate_over_wall(wall, [u], |[moved], point| {
                    ([wall.potential(&moved, point), 0.0, 0.0], [[0.0; 3]; 3])
                });
                let potential: f64 = parts.iter().map(|part| part.energies[0]).sum();
                -self.sector.repeats() * potential
            };
            let walls = self.loaded_walls(&load);
            [work(&walls[0]), work(&walls[1])]
        });
        [0, 1].map(|wall| [follower[wall], dead[wall]])
    }

    /// Returns the contribution of the walls to the tangent at a state; none without follower
    /// pressure, foundations and obstacles.
    pub(in crate::assembly) fn wall_tangent(&self, load: &Load, u: &[f64]) -> Option<WallTangent> {
        let walls = self.walls_with_tangent(load);
        let u = u.to_vec();
        (!walls.is_empty()).then_some(WallTangent { walls, u })
    }

    /// Computes y += factor · K v, with K the contribution of the walls to the tangent.
    pub(in crate::assembly) fn add_wall_product(
        &self,
        at: &WallTangent,
        factor: f64,
        v: &[f64],
        y: &mut [f64],
    ) {
        for wall in &at.walls {
            let parts = self.integrate_over_wall(wall, [&at.u, v], |[moved, v], point| {
                let blocks = self.wall_blocks(wall, &moved, point, 1.0);
                let nil = [[0.0; 3]; 3];
                ([0.0; 3], blocks.map_or(nil, |blocks| product(&blocks, &v)))
            });
            self.add_wall_forces(wall, &parts, factor, y);
        }
    }

    /// Adds the contribution of the walls to the tangent; `rotations` as in the axial kernel
    /// [`tangent`](super::axial::tangent).
    pub(in crate::assembly) fn add_wall_tangent(
        &self,
        load: &Load,
        u: &[f64],
        rotations: &[Vec<Vec<Rotation>>],
        matrix: &mut BlockBanded,
    ) {
        self.add_tangent_of_walls(&self.walls_with_tangent(load), u, rotations, matrix);
    }

    fn add_tangent_of_walls(
        &self,
        walls: &[LoadedWall],
        u: &[f64],
        rotations: &[Vec<Vec<Rotation>>],
        matrix: &mut BlockBanded,
    ) {
        with_vectors!(simd => self.add_tangent_of_walls_in(walls, u, rotations, matrix));
    }

    #[inline(always)]
    fn add_tangent_of_walls_in(
        &self,
        walls: &[LoadedWall],
        u: &[f64],
        rotations: &[Vec<Vec<Rotation>>],
        matrix: &mut BlockBanded,
    ) {
        for wall in walls {
            let index = |i: usize, ring: usize| (wall.point * 3 + i) * self.sector.rings + ring;
            for along @ (batch, lane) in self.elements_along() {
                for qz in 0..=self.degree() {
                    let rings = self.rings_along(wall, u, along, qz);
                    for element in 0..self.sector.rings {
                        let points = self.around.iter().zip(rotations).enumerate();
                        for (number, (point, rotations)) in points {
                            let moved = self.surface_displacement(&rings, element, point);
                            let weight = batch.weight[qz].0[lane] * point.weight;
                            let at = self.wall_point(wall, along, qz, [element, number], point);
                            let Some(blocks) = self.wall_blocks(wall, &moved, &at, weight) else {
                                continue;
                            };
                            for set in rotations {
                                for (r, row) in set.iter().enumerate() {
                                    for (s, column) in set.iter().enumerate() {
                                        let [r, s] = [r, s].map(|r| self.sector.ring(element, r));
                                        let rotated = rotated(&blocks, row, column);
                                        self.add_along_tube(
                                            along,
                                            qz,
                                            &rotated,
                                            |a, b, i, j, x| {
                                                if a >= b {
                                                    let first = batch.first + lane;
                                                    let (row, column) = (index(i, r), index(j, s));
                                                    matrix.add_at(first + b, a - b, row, column, x);
                                                }
                                            },
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

    /// Returns the walls under any pressure or on foundations, or both if there are obstacles.
    fn loaded_walls(&self, load: &Load) -> Vec<LoadedWall> {
        let [inner, outer] = load.pressures;
        let obstacles = self.placed_obstacles(load);
        let walls = [
            LoadedWall {
                follower: inner.follower,
                dead: inner.dead,
                obstacles: obstacles.clone(),
                ..self.bare_wall(0)
            },
            LoadedWall {
                follower: -outer.follower,
                dead: -outer.dead,
                has_foundations: !self.tube.foundations.is_empty(),
                obstacles,
                ..self.bare_wall(1)
            },
        ];
        let is_loaded = |wall: &LoadedWall| wall.has_tangent() || wall.dead != 0.0;
        walls.into_iter().filter(is_loaded).collect()
    }

    /// Returns the inner (0) or the outer wall (1) without loads.
    fn bare_wall(&self, number: usize) -> LoadedWall {
        let (point, radius) = match number {
            0 => (0, self.tube.inner_radius()),
            _ => (self.wall.functions() - 1, Tube::OUTER_RADIUS),
        };
        LoadedWall {
            point,
            radius,
            follower: 0.0,
            dead: 0.0,
            has_foundations: false,
            is_outlined: self.tube.outline().is_some(),
            obstacles: vec![],
            barrier: self.barrier,
            friction: None,
        }
    }

    fn walls_with_tangent(&self, load: &Load) -> Vec<LoadedWall> {
        let mut walls = self.loaded_walls(load);
        walls.retain(LoadedWall::has_tangent);
        walls
    }

    /// Returns the contact with obstacles, or the friction, at a position in the frame of an element; none where no obstacle
    /// is near.
    fn contact_at(
        &self,
        wall: &LoadedWall,
        position: &Surface,
        point: &WallPoint<'_>,
    ) -> Option<PointContact> {
        if let Some(friction) = &wall.friction {
            let turn = self.element_turn(point.element);
            return friction.at(point.number, position[2], turn);
        }
        if wall.obstacles.is_empty() {
            return None;
        }
        wall.contact(position[2], self.element_turn(point.element))
    }

    /// Returns the number of quadrature points of a wall.
    fn points_of_wall(&self) -> usize {
        self.axial.elements() * (self.degree() + 1) * self.sector.rings * self.around.len()
    }

    /// Returns the number of a quadrature point: of an element along, point along, element and point around.
    fn point_number(
        &self,
        (batch, lane): Along<'_>,
        qz: usize,
        [element, point]: [usize; 2],
    ) -> usize {
        let along = (batch.first + lane) * (self.degree() + 1) + qz;
        (along * self.sector.rings + element) * self.around.len() + point
    }

    /// Visits the quadrature points of a wall in the order of their numbers, with the positions in the frame of the sector
    /// that fields of displacements give, and the area at rest on the whole tube.
    fn visit_wall<const F: usize>(
        &self,
        wall: &LoadedWall,
        fields: [&[f64]; F],
        mut visit: impl FnMut(&WallPoint<'_>, [Vector<f64>; F], f64),
    ) {
        let repeats = self.sector.repeats();
        for along @ (batch, lane) in self.elements_along() {
            for qz in 0..=self.degree() {
                let weight = batch.weight[qz].0[lane];
                let rings = fields.map(|u| self.rings_along(wall, u, along, qz));
                for element in 0..self.sector.rings {
                    let turn = self.element_turn(element);
                    for (point, around) in self.around.iter().enumerate() {
                        let at = self.wall_point(wall, along, qz, [element, point], around);
                        let position = |f: usize| {
                            let moved = self.surface_displacement(&rings[f], element, around);
                            turned(sum(&wall.at_rest(&at), &moved)[2], turn)
                        };
                        let area = repeats * weight * around.weight * wall.area(&at);
                        visit(&at, std::array::from_fn(position), area);
                    }
                }
            }
        }
    }

    /// Returns the second derivatives of the energies of a wall at a point of an element around, times a factor, in the
    /// order of [`volume_blocks`]; none where they are zero.
    fn wall_blocks(
        &self,
        wall: &LoadedWall,
        moved: &Surface,
        point: &WallPoint<'_>,
        factor: f64,
    ) -> Option<[Block<f64>; 6]> {
        let position = sum(&wall.at_rest(point), moved);
        let contact = self.contact_at(wall, &position, point);
        let foundation = self.foundation_at(wall, moved[2], point);
        if contact.is_none() && foundation.is_none() && wall.follower == 0.0 {
            return None;
        }
        let mut blocks = volume_blocks(&position, -wall.follower * factor);
        if let Some(contact) = contact {
            let area = factor * wall.area(point);
            blocks[5] = contact.curvature.map(|row| row.map(|x| area * x));
        }
        if let Some(foundation) = foundation {
            let area = factor * wall.foundation_area(point);
            for i in 0..3 {
                for j in 0..3 {
                    blocks[5][i][j] += area * foundation.curvature[i][j];
                }
            }
        }
        Some(blocks)
    }

    fn elements_along(&self) -> impl Iterator<Item = Along<'_>> {
        self.batches
            .iter()
            .flat_map(|batch| (0..batch.elements).map(move |lane| (batch, lane)))
    }

    /// Integrates over the elements around a wall, for each element along the tube. `of` returns
    /// the energies at a point, and their derivatives, from the displacement fields there.
    fn integrate_over_wall<const F: usize>(
        &self,
        wall: &LoadedWall,
        fields: [&[f64]; F],
        of: impl Fn([Surface; F], &WallPoint<'_>) -> (Energies, Surface) + Sync,
    ) -> Vec<WallForces> {
        let elements: Vec<Along<'_>> = self.elements_along().collect();
        let part = |&along: &Along<'_>| with_vectors!(simd => self.integrate_around(wall, fields, &of, along));
        elements.par_iter().map(part).collect()
    }

    /// Integrates over the elements around a wall at one axial position.
    #[inline(always)]
    fn integrate_around<const F: usize>(
        &self,
        wall: &LoadedWall,
        fields: [&[f64]; F],
        of: &(impl Fn([Surface; F], &WallPoint<'_>) -> (Energies, Surface) + Sync),
        along: Along<'_>,
    ) -> WallForces {
        let (n, k, local_rings) = (
            self.degree() + 1,
            self.sector.rings,
            self.sector.local_rings(),
        );
        let (batch, lane) = along;
        let mut energies = [0.0; 3];
        // Per element around, row and local ring.
        let mut forces = vec![[0.0; 3]; k * n * local_rings];
        for qz in 0..n {
            let rings = fields.map(|field| self.rings_along(wall, field, along, qz));
            for (element, forces) in forces.chunks_exact_mut(n * local_rings).enumerate() {
                // Per local ring: forces on the value and on the slope along.
                let mut ring_forces = vec![[[0.0; 3]; 2]; local_rings];
                for (number, point) in self.around.iter().enumerate() {
                    let weight = batch.weight[qz].0[lane] * point.weight;
                    let fields = std::array::from_fn(|f| {
                        self.surface_displacement(&rings[f], element, point)
                    });
                    let at = self.wall_point(wall, along, qz, [element, number], point);
                    let (densities, slopes) = of(fields, &at);
                    for (energy, density) in energies.iter_mut().zip(densities) {
                        *energy += weight * density;
                    }
                    let [zeta, s, value] = slopes.map(|v| v.map(|x| weight * x));
                    for (ring, f) in point.ring_values.iter().zip(&mut ring_forces) {
                        f[0] = to_ring_frame(ring, 1, s, to_ring_frame(ring, 0, value, f[0]));
                        f[1] = to_ring_frame(ring, 0, zeta, f[1]);
                    }
                }
                for (a, forces) in forces.chunks_exact_mut(local_rings).enumerate() {
                    let (value, slope) = self.along(along, qz, a);
                    for (force, [on_value, on_slope]) in forces.iter_mut().zip(&ring_forces) {
                        for i in 0..3 {
                            force[i] += value * on_value[i] + slope * on_slope[i];
                        }
                    }
                }
            }
        }
        // Ring by ring, so that every ring sums its elements in the same order.
        let mut force = vec![0.0; n * 3 * k];
        for (a, force) in force.chunks_exact_mut(3 * k).enumerate() {
            for (at, force) in force.iter_mut().enumerate() {
                let (i, ring) = (at / k, at % k);
                for r in 0..local_rings {
                    let element = (ring + k - r) % k;
                    *force += forces[(element * n + a) * local_rings + r][i];
                }
            }
        }
        WallForces {
            energies,
            squares: forces.as_flattened().iter().map(|x| x * x).sum(),
            force,
        }
    }

    /// Adds forces on a wall to the vector of all unknowns.
    fn add_wall_forces(&self, wall: &LoadedWall, parts: &[WallForces], factor: f64, y: &mut [f64]) {
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

    /// Returns value and slope along the tube of function `a` of an element.
    fn along(&self, (batch, lane): Along<'_>, qz: usize, a: usize) -> (f64, f64) {
        let at = qz * (self.degree() + 1) + a;
        (batch.value[at].0[lane], batch.slope[at].0[lane])
    }

    /// Returns the displacement of the rings of a wall, and its slope along, at a point along the
    /// tube.
    #[inline(always)]
    fn rings_along(
        &self,
        wall: &LoadedWall,
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

    /// Returns the displacement at a point of an element around, and its slopes.
    #[inline(always)]
    fn surface_displacement(
        &self,
        rings: &[[Vector<f64>; 2]],
        element: usize,
        point: &CircumferentialPoint,
    ) -> Surface {
        let mut surface = [[0.0; 3]; 3];
        for (r, ring) in point.ring_values.iter().enumerate() {
            let [value, along] = rings[self.sector.ring(element, r)];
            surface[0] = to_element_frame(ring, 0, along, surface[0]);
            surface[1] = to_element_frame(ring, 1, value, surface[1]);
            surface[2] = to_element_frame(ring, 0, value, surface[2]);
        }
        surface
    }

    /// Calls `add` with φ_α(a) φ_β(b) T_αβ, summed over the slopes α and β, for all rows a and b of
    /// an element.
    #[inline(always)]
    fn add_along_tube(
        &self,
        along: Along<'_>,
        qz: usize,
        rotated: &[[Block<f64>; 3]; 3],
        mut add: impl FnMut(usize, usize, usize, usize, f64),
    ) {
        let n = self.degree() + 1;
        // N′ for the slope over ζ, N for the slope over s and the value.
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
                                x += row[alpha] * column[beta] * rotated[alpha][beta][i][j];
                            }
                        }
                        add(a, b, i, j, x);
                    }
                }
            }
        }
    }
}

impl LoadedWall {
    /// Returns true if its energy is not linear in the displacement.
    fn has_tangent(&self) -> bool {
        self.follower != 0.0 || self.has_foundations || !self.obstacles.is_empty()
    }

    /// Returns the position at rest in the frame of the element, and its slopes.
    fn at_rest(&self, point: &WallPoint<'_>) -> Surface {
        let at = |z: f64, (re, im): (f64, f64)| [z, self.radius * re, self.radius * im];
        [
            [1.0, 0.0, 0.0],
            at(0.0, point.around.circle_slope),
            at(point.z, point.around.circle),
        ]
    }

    /// Returns the potential of the pressures at a point that has moved, per dζ ds.
    fn potential(&self, moved: &Surface, point: &WallPoint<'_>) -> f64 {
        let area = self.area_at_rest(point);
        let mut dead = moved[2][1] * area[1] + moved[2][2] * area[2];
        if self.is_outlined {
            // From the shape at rest on.
            let along = moved[2][0] * area[0];
            let shape: f64 = (0..3).map(|i| point.shape[2][i] * area[i]).sum();
            dead += along - shape;
        }
        -self.follower * volume_change(&self.at_rest(point), moved) - self.dead * dead
    }

    /// Returns the area of the cylinder of constant diameter, per dζ ds.
    fn area(&self, point: &WallPoint<'_>) -> f64 {
        let (re, im) = point.around.circle_slope;
        self.radius * re.hypot(im)
    }

    /// Returns the area at rest on which foundations act, per dζ ds.
    fn foundation_area(&self, point: &WallPoint<'_>) -> f64 {
        match self.is_outlined {
            true => self
                .area_at_rest(point)
                .iter()
                .map(|x| x * x)
                .sum::<f64>()
                .sqrt(),
            false => self.area(point),
        }
    }

    /// Returns the outward element of area at rest, per dζ ds: that of the cylinder, or of the wall whose diameter or
    /// thickness varies.
    fn area_at_rest(&self, point: &WallPoint<'_>) -> Vector<f64> {
        if self.is_outlined {
            let [along, around, _] = sum(&self.at_rest(point), &point.shape);
            return [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                around[j] * along[k] - around[k] * along[j]
            });
        }
        let (re, im) = point.around.circle_slope;
        [0.0, self.radius * im, -self.radius * re]
    }
}

/// Returns blocks rotated to two rings.
#[inline(always)]
fn rotated(blocks: &[Block<f64>; 6], row: &Rotation, column: &Rotation) -> [[Block<f64>; 3]; 3] {
    let mut rotated = [[[[0.0; 3]; 3]; 3]; 3];
    add_rotated(&mut rotated, blocks, row, column, false);
    rotated
}
