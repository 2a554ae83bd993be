//! V, U, square or invaginated?

use super::Wall;
use crate::tube::Tube;

/// The side a tube invaginates to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Toward z = 0.
    Colon,
    /// Toward z = L.
    Ileum,
    /// It does not.
    None,
}

/// What the contracting region looks like (Okino et al. 2025, Fig. 4, name the shapes but give no
/// measure; these thresholds are ours).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Narrowed by less than 2 % of D.
    Straight,
    /// Narrowed, with a pointed bottom: flatness below 0.5, that of a raised cosine.
    V,
    /// Narrowed, with a rounded bottom.
    U,
    /// Narrowed, with a wall steeper than 78°.
    Square,
    /// Narrowed, with a wall that overhangs.
    Invaginated,
    /// Not narrowed by its muscles but buckled: the outer face bulges by more than 2 % of D, or
    /// the lumen is closed.
    Collapsed,
}

impl Shape {
    /// Depth, in D, below which a tube counts as straight.
    pub const NARROWED: f64 = 0.02;
    /// Flatness that parts V from U.
    pub const FLAT: f64 = 0.5;
    /// Wall angle from which a narrowed region is square, in degrees.
    pub const STEEP_DEG: f64 = 78.0;

    /// Names the shape of a tube, from the meridian of its outer face that goes deepest, that of
    /// its inner face, and its steepest wall angle in degrees.
    pub fn of(outer: &Wall, inner: &Wall, steepest_angle_deg: f64) -> Self {
        let depth = Tube::OUTER_RADIUS - outer.narrowest().1;
        let widest = outer.points.iter().map(|p| p.1).fold(0.0, f64::max);
        let bulge = widest - Tube::OUTER_RADIUS;
        if inner.narrowest().1 <= 0.0 || bulge > depth.max(Self::NARROWED) {
            Self::Collapsed
        } else if depth < Self::NARROWED {
            Self::Straight
        } else if steepest_angle_deg >= 90.0 {
            Self::Invaginated
        } else if steepest_angle_deg >= Self::STEEP_DEG {
            Self::Square
        } else if flatness(outer, depth) < Self::FLAT {
            Self::V
        } else {
            Self::U
        }
    }
}

/// Axial extent of the wall deeper than ¾ of the depth, over that deeper than ¼.
fn flatness(wall: &Wall, depth: f64) -> f64 {
    let extent = |part: f64| wall.extent_below(Tube::OUTER_RADIUS - part * depth);
    extent(0.75) / extent(0.25)
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Colon => "colon",
            Self::Ileum => "ileum",
            Self::None => "none",
        })
    }
}

impl std::fmt::Display for Shape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Straight => "straight",
            Self::V => "V",
            Self::U => "U",
            Self::Square => "square",
            Self::Invaginated => "invaginated",
            Self::Collapsed => "collapsed",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall drawn through corners (z, r).
    fn wall(corners: &[(f64, f64)]) -> Wall {
        let mut points = vec![corners[0]];
        for w in corners.windows(2) {
            for i in 1..=100 {
                let t = f64::from(i) / 100.0;
                points.push((
                    w[0].0 + t * (w[1].0 - w[0].0),
                    w[0].1 + t * (w[1].1 - w[0].1),
                ));
            }
        }
        Wall {
            angle: 0.0,
            reference_z: vec![0.0; points.len()],
            points,
        }
    }

    fn named(corners: &[(f64, f64)]) -> (Shape, Side) {
        let outer = wall(corners);
        let mut inner = outer.clone();
        for p in &mut inner.points {
            p.1 -= 0.06;
        }
        (
            Shape::of(&outer, &inner, outer.steepest_angle_deg()),
            outer.overhang().1,
        )
    }

    #[test]
    fn synthetic_walls_are_named() {
        let v = [(0.0, 0.5), (0.5, 0.5), (0.75, 0.2), (1.0, 0.5), (3.0, 0.5)];
        assert_eq!(named(&v), (Shape::V, Side::None));
        let u = [
            (0.0, 0.5),
            (0.5, 0.5),
            (0.6, 0.2),
            (0.9, 0.2),
            (1.0, 0.5),
            (3.0, 0.5),
        ];
        assert_eq!(named(&u), (Shape::U, Side::None));
        let square = [
            (0.0, 0.5),
            (0.5, 0.5),
            (0.53, 0.2),
            (0.97, 0.2),
            (1.0, 0.5),
            (3.0, 0.5),
        ];
        assert_eq!(named(&square), (Shape::Square, Side::None));
        let colon = [
            (0.0, 0.5),
            (0.5, 0.5),
            (0.4, 0.2),
            (0.9, 0.2),
            (1.0, 0.5),
            (3.0, 0.5),
        ];
        assert_eq!(named(&colon), (Shape::Invaginated, Side::Colon));
        let ileum = [
            (0.0, 0.5),
            (0.5, 0.5),
            (0.6, 0.2),
            (1.1, 0.2),
            (1.0, 0.5),
            (3.0, 0.5),
        ];
        assert_eq!(named(&ileum), (Shape::Invaginated, Side::Ileum));
        assert_eq!(
            named(&[(0.0, 0.5), (3.0, 0.5)]),
            (Shape::Straight, Side::None)
        );
        let bulging = [(0.0, 0.5), (0.5, 0.6), (1.0, 0.48), (3.0, 0.5)];
        assert_eq!(named(&bulging), (Shape::Collapsed, Side::None));
    }

    #[test]
    fn overhang_is_how_far_the_wall_runs_back() {
        let (overhang, _) =
            wall(&[(0.0, 0.5), (0.5, 0.5), (0.4, 0.2), (0.9, 0.2), (1.0, 0.5)]).overhang();
        assert!((overhang - 0.1).abs() < 1e-12);
    }

    #[test]
    fn angles_are_those_of_the_wall() {
        let angle = |z: f64, r: f64| wall(&[(0.0, 0.5), (z, 0.5 - r)]).steepest_angle_deg();
        assert!((angle(0.3, 0.3) - 45.0).abs() < 1e-9);
        assert!((angle(-0.3, 0.3) - 135.0).abs() < 1e-9);
    }
}
