//! The surfaces of a tube that is cut open along its axis.
//!
//! A wall is a function of ζ along the tube (0 at the colon, 1 at the ileum), the angle η around it and ξ through the wall
//! (0 inside, 1 outside). In a [`super::Cutaway`], x points up and y towards the viewer; with x = r cos η and y = r sin η
//! the viewer faces η = π/2.

use std::f64::consts::{PI, TAU};

use super::vec3::{dot, minus};
use super::{Sides, Surface};

/// Angles η of the half of the wall away from the viewer; both cut faces are towards the viewer.
pub const REAR_HALF: (f64, f64) = (PI, TAU);

/// The part of a wall that is kept, and the parameters at which it is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Range of angles η that is kept, in radians; 2π or more keeps the whole wall.
    pub kept: (f64, f64),
    /// Increasing parameters from 0 to 1 along the tube, around the kept part and through the wall. A list with fewer
    /// than two entries stands for 0 and 1.
    pub parameters: [Vec<f64>; 3],
}

impl Opening {
    /// Returns an opening with equally spaced parameters: `points` along the tube, around it and through the wall.
    pub fn uniform(kept: (f64, f64), points: [usize; 3]) -> Self {
        Self {
            kept,
            parameters: points.map(linspace),
        }
    }

    /// Returns the outer and the inner face, the two ends, and the two cut faces unless the wall is closed.
    ///
    /// `wall(zeta, eta, xi)` returns a position in units of D and the value of the field there.
    pub fn surfaces(&self, wall: impl Fn(f64, f64, f64) -> ([f64; 3], f64)) -> Vec<Surface> {
        let ends = [0.0, 1.0];
        let [along, around, through] = [0, 1, 2].map(|i| match &self.parameters[i][..] {
            [] | [_] => &ends[..],
            parameters => parameters,
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
            hide_inside(outer, inner);
        }
        if last - first < TAU - 1e-9 {
            surfaces.push(grid(along, through, |s, t| wall(s, first, t)));
            surfaces.push(grid(along, through, |s, t| wall(s, last, t)));
        }
        surfaces
    }
}

/// Returns `count` equally spaced numbers from 0 to 1, at least two.
pub(crate) fn linspace(count: usize) -> Vec<f64> {
    let count = count.max(2);
    (0..count).map(|i| i as f64 / (count - 1) as f64).collect()
}

/// Samples a surface at the parameters `columns` and `rows`.
fn grid(columns: &[f64], rows: &[f64], at: impl Fn(f64, f64) -> ([f64; 3], f64)) -> Surface {
    let parameters = rows
        .iter()
        .flat_map(|&t| columns.iter().map(move |&s| (s, t)));
    let (points, values) = parameters.map(|(s, t)| at(s, t)).unzip();
    Surface {
        columns: columns.len(),
        rows: rows.len(),
        points,
        values,
        sides: Sides::Both,
    }
}

/// Limits outer and inner face to the sides that are outside the wall, unless the wall is inverted at one of their points.
fn hide_inside(outer: &mut Surface, inner: &mut Surface) {
    // The cross product of the directions along and around points inwards.
    let is_valid = |surface: &Surface| {
        let through = outer.points.iter().zip(&inner.points);
        let mut normals = through.zip(surface.normals());
        normals.all(|((outer, inner), normal)| dot(minus(*outer, *inner), normal) < 0.0)
    };
    if is_valid(outer) && is_valid(inner) {
        (outer.sides, inner.sides) = (Sides::Back, Sides::Front);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_an_open_tube_has_cut_faces() {
        let tube = |zeta: f64, eta: f64, xi: f64| {
            let r = 0.44 + 0.06 * xi;
            ([r * eta.cos(), r * eta.sin(), 3.0 * zeta], zeta)
        };
        assert_eq!(
            Opening::uniform((0.0, TAU), [5, 9, 3]).surfaces(tube).len(),
            4
        );
        let half = Opening::uniform(REAR_HALF, [401, 121, 9]);
        let half = half.surfaces(tube);
        assert_eq!(half.len(), 6);
        assert_eq!((half[0].sides, half[1].sides), (Sides::Back, Sides::Front));
        // Both sides of an inverted wall are visible.
        let inverted = Opening::uniform(REAR_HALF, [401, 121, 9]);
        let inverted = inverted.surfaces(|zeta, eta, xi| tube(zeta, eta, 1.0 - xi));
        assert_eq!(inverted[0].sides, Sides::Both);
        assert!(half.iter().all(|s| s.check().is_ok()));
        assert!(
            half.iter().flat_map(|s| &s.points).all(|p| p[1] < 1e-12),
            "the near half is removed"
        );
    }
}
