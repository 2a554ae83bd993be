//! V, U, square or invaginated?

use super::Wall;
use crate::tube::Tube;

/// The side a tube invaginates to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Toward z = 0.
    Colon,
    /// Toward z = L.
    Ileum,
    /// It does not, or to both sides alike.
    None,
}

/// What the contracting region looks like (Okino et al. 2025, Fig. 4, name the shapes but give no
/// measure; these thresholds are ours). V, U, square and invaginated are shapes of a tube that its
/// circular muscles narrow; without them a tube that leaves its cylinder has
/// swollen, in one bulge outwards, or else collapsed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The outer face stays within 2 % of D of the cylinder, or its circular muscles widen it.
    Straight,
    /// Narrowed, with a pointed bottom: flatness below 0.5, that of a raised cosine.
    #[serde(rename = "V")]
    V,
    /// Narrowed, with a rounded bottom.
    #[serde(rename = "U")]
    U,
    /// Narrowed, with a wall steeper than 78°.
    Square,
    /// Narrowed, with a wall that overhangs.
    Invaginated,
    /// Wider than the cylinder by more than 2 % of D in one bulge, nowhere narrower by as much, without
    /// a muscle that narrows it.
    Swollen,
    /// Buckled out of the cylinder by more than 2 % of D without a muscle that narrows it, or the
    /// lumen is closed.
    Collapsed,
}

impl Shape {
    /// Depth or bulge, in D, below which a tube counts as straight.
    pub const LEAVES: f64 = 0.02;
    /// Flatness that parts V from U.
    pub const FLAT: f64 = 0.5;
    /// Wall angle from which a narrowed region is square, in degrees.
    pub const STEEP_DEG: f64 = 78.0;

    /// Names the shape of a tube, from the meridian of its outer face that goes deepest, that of
    /// its inner face, its steepest wall angle in degrees, and its diameter ratio Dmin/D.
    pub fn of(outer: &Wall, inner: &Wall, steepest_angle_deg: f64, diameter_ratio: f64) -> Self {
        let depth = Tube::OUTER_RADIUS - outer.narrowest().1;
        let widest = outer.points.iter().map(|p| p.1).fold(0.0, f64::max);
        let bulge = widest - Tube::OUTER_RADIUS;
        let contracted = diameter_ratio <= 1.0 - Self::LEAVES;
        if inner.narrowest().1 <= 0.0 {
            Self::Collapsed
        } else if depth.max(bulge) < Self::LEAVES || diameter_ratio > 1.0 {
            Self::Straight
        } else if !contracted && depth < Self::LEAVES && bulges_once(outer) {
            Self::Swollen
        } else if !contracted {
            Self::Collapsed
        } else if steepest_angle_deg >= 90.0 {
            Self::Invaginated
        } else if steepest_angle_deg >= Self::STEEP_DEG {
            Self::Square
        } else if outer.flatness() < Self::FLAT {
            Self::V
        } else {
            Self::U
        }
    }
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

/// Rise of the radius after a fall, in D, from which a wall counts as rising again.
const FALL: f64 = 1e-3;

/// Whether the radius rises along the wall at most once before it falls for good.
fn bulges_once(wall: &Wall) -> bool {
    let (mut highest, mut lowest_since) = (f64::NEG_INFINITY, f64::INFINITY);
    wall.points.iter().all(|&(_, r)| {
        if r > highest {
            (highest, lowest_since) = (r, r);
        }
        lowest_since = lowest_since.min(r);
        // Once fallen from its highest it must not rise again.
        r <= lowest_since + FALL
    })
}

impl std::fmt::Display for Shape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Straight => "straight",
            Self::V => "V",
            Self::U => "U",
            Self::Square => "square",
            Self::Invaginated => "invaginated",
            Self::Swollen => "swollen",
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

    fn shape(corners: &[(f64, f64)], diameter_ratio: f64) -> Shape {
        let outer = wall(corners);
        let mut inner = outer.clone();
        for p in &mut inner.points {
            p.1 -= 0.06;
        }
        Shape::of(&outer, &inner, outer.steepest_angle_deg(), diameter_ratio)
    }

    fn named(corners: &[(f64, f64)]) -> (Shape, Side) {
        (shape(corners, 0.25), wall(corners).overhang().1)
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
    }

    #[test]
    fn without_a_muscle_that_narrows_it_a_tube_collapses() {
        let buckled = [(0.0, 0.5), (0.5, 0.6), (0.4, 0.3), (1.0, 0.5), (3.0, 0.5)];
        assert_eq!(shape(&buckled, 1.0), Shape::Collapsed);
        assert_eq!(shape(&buckled, 0.25), Shape::Invaginated);
        assert_eq!(
            shape(&[(0.0, 0.5), (0.5, 0.51), (3.0, 0.5)], 1.0),
            Shape::Straight
        );
        assert_eq!(
            shape(&[(0.0, 0.5), (0.5, 0.05), (3.0, 0.5)], 0.25),
            Shape::Collapsed
        );
    }

    #[test]
    fn a_tube_that_is_wider_in_one_bulge_is_swollen() {
        let swollen = [(0.0, 0.5), (0.5, 0.56), (1.5, 0.7), (2.5, 0.56), (3.0, 0.5)];
        assert_eq!(shape(&swollen, 1.0), Shape::Swollen);
        assert_eq!(shape(&[(0.0, 0.6), (3.0, 0.6)], 1.0), Shape::Swollen);
        let rings = [(0.0, 0.5), (0.5, 0.56), (1.0, 0.5), (1.5, 0.56), (3.0, 0.5)];
        assert_eq!(shape(&rings, 1.0), Shape::Collapsed);
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
