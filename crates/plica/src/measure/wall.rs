//! One meridian of the wall, as a curve in (z, ρ).

use super::Side;
use crate::tube::Tube;

/// A face of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Reference radius D/2.
    Outer,
    /// Reference radius D/2 − H.
    Inner,
}

/// A meridian of a face.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Reference angle of the meridian, in radians.
    pub angle: f64,
    /// Reference position of its points along the tube, in D.
    pub reference_z: Vec<f64>,
    /// Current (z, ρ) of its points, in D, colon to ileum. ρ is negative past the axis.
    pub points: Vec<(f64, f64)>,
}

impl Wall {
    /// The point that lies deepest: (z, ρ).
    pub fn narrowest(&self) -> (f64, f64) {
        let nearest = self.points.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.copied().unwrap_or((f64::NAN, f64::NAN))
    }

    /// The steepest angle to the axis, in degrees, from 0 to 180.
    pub fn steepest_angle_deg(&self) -> f64 {
        let angle = |w: &[(f64, f64)]| (w[1].1 - w[0].1).abs().atan2(w[1].0 - w[0].0);
        self.points
            .windows(2)
            .map(angle)
            .fold(0.0, f64::max)
            .to_degrees()
    }

    /// How far the wall runs back along the axis, and on which side it does so more.
    pub fn overhang(&self) -> (f64, Side) {
        let narrowest = self
            .points
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let middle = narrowest.map_or(0, |(i, _)| i);
        let (colon, ileum) = (
            runs_back(&self.points[..=middle]),
            runs_back(&self.points[middle..]),
        );
        let side = match colon.max(ileum) {
            // Nowhere, or on both sides alike.
            most if most <= 0.0 || (colon - ileum).abs() < 1e-6 => Side::None,
            most if most == colon => Side::Colon,
            _ => Side::Ileum,
        };
        (runs_back(&self.points), side)
    }

    /// Axial extent of the wall deeper than ¾ of the depth, over that deeper than ¼: ⅓ of a V with straight
    /// flanks, ½ of a raised cosine, 1 of a square. Of a wall that is nowhere narrower than at rest it says nothing.
    pub fn flatness(&self) -> f64 {
        let depth = Tube::OUTER_RADIUS - self.narrowest().1;
        let extent = |part: f64| self.extent_below(Tube::OUTER_RADIUS - part * depth);
        let (deep, wide) = (extent(0.75), extent(0.25));
        if wide > 0.0 { deep / wide } else { 0.0 }
    }

    /// Axial extent of the part that lies deeper than a radius.
    pub fn extent_below(&self, radius: f64) -> f64 {
        let below = self.points.iter().filter(|p| p.1 <= radius);
        let (low, high) = below.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p.0), high.max(p.0))
        });
        (high - low).max(0.0)
    }
}

fn runs_back(points: &[(f64, f64)]) -> f64 {
    let (mut furthest, mut back) = (f64::NEG_INFINITY, 0.0_f64);
    for &(z, _) in points {
        furthest = furthest.max(z);
        back = back.max(furthest - z);
    }
    back
}
