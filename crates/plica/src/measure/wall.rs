//! A meridian of one face of the wall, as a curve in (z, ρ).

use super::Side;
use crate::tube::{Outline, Tube};

/// A face of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Reference radius D/2.
    Outer,
    /// Reference radius D/2 − H.
    Inner,
}

impl Face {
    /// Returns the reference radius of the face.
    pub(super) fn radius(self, tube: &Tube) -> f64 {
        match self {
            Self::Outer => Tube::OUTER_RADIUS,
            Self::Inner => tube.inner_radius(),
        }
    }
}

/// A meridian of a face.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Reference angle of the meridian, in radians.
    pub angle: f64,
    /// Axial reference positions of its points, in D.
    pub reference_z: Vec<f64>,
    /// Current positions (z, ρ) of its points, in D, colon to ileum; ρ is negative past the axis.
    pub points: Vec<(f64, f64)>,
}

impl Wall {
    /// Returns a meridian of the outer face of a tube whose diameter varies, with its radii changed by as much as the
    /// diameter at rest differs from that of a cylinder.
    pub(super) fn on_cylinder(&self, outline: &Outline) -> Self {
        let mut wall = self.clone();
        for (point, z) in wall.points.iter_mut().zip(&self.reference_z) {
            point.1 += Tube::OUTER_RADIUS - 0.5 * outline.diameter_at(*z);
        }
        wall
    }

    /// Returns the point (z, ρ) with the smallest radius; NaN if the wall has no points.
    pub fn narrowest(&self) -> (f64, f64) {
        let nearest = self.points.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// Returns the largest wall angle, in degrees, from 0 to 180.
    pub fn steepest_angle_deg(&self) -> f64 {
        let angle = |w: &[(f64, f64)]| (w[1].1 - w[0].1).abs().atan2(w[1].0 - w[0].0);
        self.points
            .windows(2)
            .map(angle)
            .fold(0.0, f64::max)
            .to_degrees()
    }

    /// Returns the overhang, an axial distance in D, and the side of the larger overhang.
    pub fn overhang(&self) -> (f64, Side) {
        let narrowest = self
            .points
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let middle = narrowest.map_or(0, |(i, _)| i);
        let (colon, ileum) = (
            overhang_of(&self.points[..=middle]),
            overhang_of(&self.points[middle..]),
        );
        let side = match colon.max(ileum) {
            most if most <= 0.0 || (colon - ileum).abs() < 1e-6 => Side::None,
            most if most == colon => Side::Colon,
            _ => Side::Ileum,
        };
        (overhang_of(&self.points), side)
    }

    /// Returns the flatness of the narrowed region: ⅓ for a V with straight flanks, ½ for a raised cosine, 1 for a
    /// square. It has no meaning for a wall that is nowhere narrower than at rest.
    pub fn flatness(&self) -> f64 {
        let depth = Tube::OUTER_RADIUS - self.narrowest().1;
        let extent = |part: f64| self.extent_below(Tube::OUTER_RADIUS - part * depth);
        let (bottom, top) = (extent(0.75), extent(0.25));
        if top > 0.0 { bottom / top } else { 0.0 }
    }

    /// Returns the axial extent of the part whose radius is at most `radius`.
    fn extent_below(&self, radius: f64) -> f64 {
        let below = self.points.iter().filter(|p| p.1 <= radius);
        let (low, high) = below.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p.0), high.max(p.0))
        });
        (high - low).max(0.0)
    }
}

/// Returns the largest axial distance from a point back to a later one.
fn overhang_of(points: &[(f64, f64)]) -> f64 {
    let (mut furthest, mut back) = (f64::NEG_INFINITY, 0.0_f64);
    for &(z, _) in points {
        furthest = furthest.max(z);
        back = back.max(furthest - z);
    }
    back
}
