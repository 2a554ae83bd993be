//! The surfaces of a tube cut open along its axis, from any wall mapping.
//!
//! The wall is a function of ζ along the tube (0 colon to 1 ileum), the angle η around it and ξ through it (0 inner to
//! 1 outer). Seen by [`super::Cutaway`], x points up and y towards the viewer, so with x = r cos η, y = r sin η the
//! viewer faces η = π/2.

use std::f64::consts::{PI, TAU};

use super::light::{dot, minus};
use super::{Sides, Surface};

/// The part of the wall that stays, and how finely it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Opening {
    /// Angles η, in radians, between which the wall stays; a full turn or more keeps it closed.
    pub kept: (f64, f64),
    /// Points along the tube, around it and through the wall.
    pub points: [usize; 3],
}

impl Opening {
    /// The front half removed: both sections of the wall face the viewer.
    pub const HALF: Opening = Opening {
        kept: (PI, TAU),
        points: [401, 121, 9],
    };

    /// Outer and inner wall, the two ends, and the two sections unless the wall is closed.
    ///
    /// `wall(zeta, eta, xi)` gives the place in units of D and the value of the field there.
    pub fn surfaces(&self, wall: impl Fn(f64, f64, f64) -> ([f64; 3], f64)) -> Vec<Surface> {
        let [along, around, through] = self.points.map(|n| n.max(2));
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

/// A surface over the unit square, `columns` points along its first and `rows` along its second parameter.
pub fn grid(columns: usize, rows: usize, at: impl Fn(f64, f64) -> ([f64; 3], f64)) -> Surface {
    let (columns, rows) = (columns.max(2), rows.max(2));
    let mut points = Vec::with_capacity(columns * rows);
    let mut values = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let (s, t) = (
                column as f64 / (columns - 1) as f64,
                row as f64 / (rows - 1) as f64,
            );
            let (point, value) = at(s, t);
            points.push(point);
            values.push(value);
        }
    }
    Surface {
        columns,
        rows,
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
            Opening {
                kept: (0.0, TAU),
                points: [5, 9, 3]
            }
            .surfaces(tube)
            .len(),
            4
        );
        let half = Opening::HALF.surfaces(tube);
        assert_eq!(half.len(), 6);
        assert_eq!((half[0].sides, half[1].sides), (Sides::Back, Sides::Front));
        // Inside out, nothing is said.
        let turned = Opening::HALF.surfaces(|zeta, eta, xi| tube(zeta, eta, 1.0 - xi));
        assert_eq!(turned[0].sides, Sides::Both);
        assert!(half.iter().all(|s| s.check().is_ok()));
        assert!(
            half.iter().flat_map(|s| &s.points).all(|p| p[1] < 1e-12),
            "the front is gone"
        );
    }
}
