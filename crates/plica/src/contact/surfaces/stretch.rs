//! Stretch and turning of the faces.

use super::SurfaceContact;
use super::net::FaceNet;
use super::patch::Patch;
use super::vector::{Vector, cross, dot, length};
use crate::assembly::{Point, SplineTube};
use crate::contact::FaceSurface;
use crate::contact::stretch::{POINTS, may_be_lowest};
use crate::tube::Load;
use rayon::prelude::*;

impl SurfaceContact {
    /// Returns stretch and turning of each face, outer and inner, of a state.
    pub fn surfaces(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> [FaceSurface; 2] {
        [0, 1].map(|i| {
            let net = &self.faces[i].0;
            let patches = net.patches(&net.positions(u));
            let of_column = |around: usize| of_column(tube, net, (load, u), around, &patches);
            let columns = (0..net.rings).into_par_iter().map(of_column);
            let columns: Vec<FaceSurface> = columns.collect();
            let more = |a: FaceSurface, b: FaceSurface| {
                let (stretch, stretch_at) = match b.stretch < a.stretch {
                    true => (b.stretch, b.stretch_at),
                    false => (a.stretch, a.stretch_at),
                };
                let (turn, turn_at) = match b.turn > a.turn {
                    true => (b.turn, b.turn_at),
                    false => (a.turn, a.turn_at),
                };
                FaceSurface {
                    stretch,
                    stretch_at,
                    turn,
                    turn_at,
                }
            };
            columns.into_iter().fold(FaceSurface::FLAT, more)
        })
    }
}

/// Returns the surface of the elements of the sector at one place around, in their middles.
fn of_column(
    tube: &SplineTube,
    net: &FaceNet,
    (load, u): (&Load, &[f64]),
    around: usize,
    patches: &[Patch],
) -> FaceSurface {
    let mut surface = FaceSurface::FLAT;
    let mut see = |z: f64| {
        let at = Point {
            z,
            radius: net.radius,
            angle: around as f64 * net.element_angle(),
        };
        let stretch = stretch(tube, load, u, at);
        if stretch < surface.stretch {
            (surface.stretch, surface.stretch_at) = (stretch, z);
        }
        stretch
    };
    let middle = |e: usize| {
        let (from, to) = tube.axial.element(e);
        f64::midpoint(from, to)
    };
    let middles: Vec<f64> = (0..net.elements()).map(|e| see(middle(e))).collect();
    for e in may_be_lowest(&middles) {
        let (from, to) = tube.axial.element(e);
        for j in 0..POINTS {
            see(from + (to - from) * j as f64 / (POINTS - 1) as f64);
        }
    }
    for e in 0..net.elements() {
        let turn = turn(&patches[e * net.around + around]);
        if turn > surface.turn {
            (surface.turn, surface.turn_at) = (turn, middle(e));
        }
    }
    surface
}

/// Returns λ₁² λ₂ of the principal elastic stretches in the plane of a face, λ₁ the smaller one.
fn stretch(tube: &SplineTube, load: &Load, u: &[f64], at: Point) -> f64 {
    let elastic = tube.sample(load, u, at).elastic.0;
    let column = |j: usize| [0, 1, 2].map(|i| elastic[i][j]);
    let (along, around) = (column(0), column(2));
    let [a, b, c] = [dot(along, along), dot(along, around), dot(around, around)];
    // The squares of the stretches are the eigenvalues of [[a, b], [b, c]].
    let smaller = 0.5 * (a + c - (a - c).hypot(2.0 * b));
    let area = (a * c - b * b).max(0.0).sqrt();
    area * smaller.max(0.0).sqrt()
}

/// Returns the sum of the angles between the normals at successive points along the middle of a patch.
fn turn(patch: &Patch) -> f64 {
    let normal = |j: usize| -> Vector {
        let [along, around] = patch.at([j as f64 / (POINTS - 1) as f64, 0.5]).slopes;
        cross(along, around)
    };
    let angle = |a: Vector, b: Vector| length(cross(a, b)).atan2(dot(a, b));
    (1..POINTS).map(|j| angle(normal(j - 1), normal(j))).sum()
}
