//! Stretch and turning of a face: signs that it creases, and that the mesh resolves the crease.

use super::MeridianContact;
use super::bezier::{Bezier, Point, dot};
use crate::assembly::{Point as MaterialPoint, SplineTube};
use crate::contact::FaceSurface;
use crate::contact::stretch::{POINTS, may_be_lowest};
use crate::tube::Load;

impl MeridianContact {
    /// Returns stretch and turning of each face, outer and inner, of a state of a tube of one ring without twist.
    pub fn surfaces(&self, tube: &SplineTube, load: &Load, u: &[f64]) -> [FaceSurface; 2] {
        [0, 1].map(|i| {
            let curve = &self.faces[i].0;
            let mut surface = FaceSurface::FLAT;
            let mut see = |z: f64| {
                let at = MaterialPoint {
                    z,
                    radius: curve.radius,
                    angle: 0.0,
                };
                let s = stretch(tube, load, u, at);
                if s < surface.stretch {
                    (surface.stretch, surface.stretch_at) = (s, z);
                }
                s
            };
            let curves = curve.curves(u);
            let middle = |e: usize| {
                let (from, to) = tube.axial.element(e);
                f64::midpoint(from, to)
            };
            let middles: Vec<f64> = (0..curves.len()).map(|e| see(middle(e))).collect();
            for e in may_be_lowest(&middles) {
                let (from, to) = tube.axial.element(e);
                for j in 0..POINTS {
                    see(from + (to - from) * j as f64 / (POINTS - 1) as f64);
                }
            }
            for (e, of_element) in curves.iter().enumerate() {
                let turn = turn(of_element);
                if turn > surface.turn {
                    (surface.turn, surface.turn_at) = (turn, middle(e));
                }
            }
            surface
        })
    }
}

/// Returns λ₁² λ₂ of the elastic stretches along and around, which are principal without twist.
fn stretch(tube: &SplineTube, load: &Load, u: &[f64], at: MaterialPoint) -> f64 {
    let elastic = tube.sample(load, u, at).elastic.0;
    let column = |j: usize| {
        (0..3)
            .map(|i| elastic[i][j] * elastic[i][j])
            .sum::<f64>()
            .sqrt()
    };
    let (along, around) = (column(0), column(2));
    along * around * along.min(around)
}

/// Returns the sum of the angles between successive tangents of a curve.
fn turn(curve: &Bezier) -> f64 {
    let slope = |j: usize| curve.at(j as f64 / (POINTS - 1) as f64).slope;
    let angle = |a: Point, b: Point| (a[0] * b[1] - a[1] * b[0]).atan2(dot(a, b)).abs();
    (1..POINTS).map(|j| angle(slope(j - 1), slope(j))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_turns_by_the_angle_between_its_ends() {
        for height in [0.1, 1.0, 10.0] {
            let curve = Bezier::new([[0.0, 0.0], [1.0, height], [2.0, 0.0]]);
            assert!((turn(&curve) - 2.0 * f64::atan(height)).abs() < 1e-12);
        }
    }
}
