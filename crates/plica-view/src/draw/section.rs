//! The surfaces of a tube cut open along its axis, from any wall mapping.
//!
//! The wall is a function of ζ along the tube (0 colon to 1 ileum), the angle η around it and ξ through it (0 inner to
//! 1 outer). Seen by [`super::Cutaway`], x points up and y towards the viewer, so with x = r cos η, y = r sin η the
//! viewer faces η = π/2.

use std::f64::consts::{PI, TAU};

use super::light::{dot, minus};
use super::{Sides, Surface};

/// The near half taken away, as angles η between which the wall stays: both sections of it face the viewer.
pub const HALF: (f64, f64) = (PI, TAU);

/// The part of the wall that stays, and where it is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Angles η, in radians, between which the wall stays; a full turn or more keeps it closed.
    pub kept: (f64, f64),
    /// Where along the tube, around the part that stays, and through the wall; each from 0 to 1, rising. Fewer than two
    /// stand for both ends.
    pub places: [Vec<f64>; 3],
}

impl Opening {
    /// So many points along the tube, around it and through the wall, two at least, evenly.
    pub fn evenly(kept: (f64, f64), points: [usize; 3]) -> Self {
        Self {
            kept,
            places: points.map(evenly),
        }
    }

    /// Outer and inner wall, the two ends, and the two sections unless the wall is closed.
    ///
    /// `wall(zeta, eta, xi)` gives the place in units of D and the value of the field there.
    pub fn surfaces(&self, wall: impl Fn(f64, f64, f64) -> ([f64; 3], f64)) -> Vec<Surface> {
        let ends = [0.0, 1.0];
        let [along, around, through] = [0, 1, 2].map(|i| match &self.places[i][..] {
            [] | [_] => &ends[..],
            places => places,
        });
        let (first, last) = self.kept;
        let eta = |t: f64| first + t * (last - first);
        let mut surfaces = vec![
            grid(along, around, |s, t| wall(s, eta(t), 1.0)),
            grid(along, around, |s, t| wall(s, eta(t), 0.0)),
            grid(around, through, |s, t| wall(0.0, eta(s), t)),
            grid(around, through, |s, t| wall(1.0, eta(s), t)),
        ];
        if let [outer, inner, ..] = &mut surfaces[..] {
            face_outwards(outer, inner);
        }
        if last - first < TAU - 1e-9 {
            surfaces.push(grid(along, through, |s, t| wall(s, first, t)));
            surfaces.push(grid(along, through, |s, t| wall(s, last, t)));
        }
        surfaces
    }
}

/// So many numbers from 0 to 1, two at least.
pub fn evenly(count: usize) -> Vec<f64> {
    let count = count.max(2);
    (0..count).map(|i| i as f64 / (count - 1) as f64).collect()
}

/// A surface over two parameters: `columns` are the places along its first, `rows` along its second.
fn grid(columns: &[f64], rows: &[f64], at: impl Fn(f64, f64) -> ([f64; 3], f64)) -> Surface {
    let places = rows
        .iter()
        .flat_map(|&t| columns.iter().map(move |&s| (s, t)));
    let (points, values) = places.map(|(s, t)| at(s, t)).unzip();
    Surface {
        columns: columns.len(),
        rows: rows.len(),
        points,
        values,
        sides: Sides::Both,
    }
}

/// Outer and inner wall are seen from outside the wall alone, unless it is turned over at a point of theirs.
fn face_outwards(outer: &mut Surface, inner: &mut Surface) {
    // Along × around points inwards.
    let is_sound = |surface: &Surface| {
        let through = outer.points.iter().zip(&inner.points);
        let mut normals = through.zip(surface.normals());
        normals.all(|((outer, inner), normal)| dot(minus(*outer, *inner), normal) < 0.0)
    };
    if is_sound(outer) && is_sound(inner) {
        (outer.sides, inner.sides) = (Sides::Back, Sides::Front);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_tube_has_no_sections() {
        let tube = |zeta: f64, eta: f64, xi: f64| {
            let r = 0.44 + 0.06 * xi;
            ([r * eta.cos(), r * eta.sin(), 3.0 * zeta], zeta)
        };
        assert_eq!(
            Opening::evenly((0.0, TAU), [5, 9, 3]).surfaces(tube).len(),
            4
        );
        let half = Opening::evenly(HALF, [401, 121, 9]);
        let half = half.surfaces(tube);
        assert_eq!(half.len(), 6);
        assert_eq!((half[0].sides, half[1].sides), (Sides::Back, Sides::Front));
        // Inside out, nothing is said.
        let turned = Opening::evenly(HALF, [401, 121, 9]);
        let turned = turned.surfaces(|zeta, eta, xi| tube(zeta, eta, 1.0 - xi));
        assert_eq!(turned[0].sides, Sides::Both);
        assert!(half.iter().all(|s| s.check().is_ok()));
        assert!(
            half.iter().flat_map(|s| &s.points).all(|p| p[1] < 1e-12),
            "the front is gone"
        );
    }
}
