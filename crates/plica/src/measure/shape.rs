//! Classification of the contracting region: V, U, square, invaginated, and tubes without contraction.

use super::Wall;
use crate::tube::Tube;
use std::fmt;

/// Side towards which a tube invaginates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Towards z = 0.
    Colon,
    /// Towards z = L.
    Ileum,
    /// No overhang, or equal overhangs on both sides.
    None,
}

/// Shape of the contracting region.
///
/// Okino et al. (2025), Fig. 4, name the first shapes without a measure; the thresholds are Plica's.
/// V, U, square and invaginated describe a tube narrowed by its circular muscles, or by anything else in one round neck
/// without a bulge. Any other tube that leaves its cylinder is swollen, with a single outward bulge, or else collapsed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// The outer face stays within 2 % of D of the cylinder.
    Straight,
    /// Narrowed, with a flatness below 0.5, that of a raised cosine.
    #[serde(rename = "V")]
    V,
    /// Narrowed, with a flatness of 0.5 or more.
    #[serde(rename = "U")]
    U,
    /// Narrowed, with a wall angle of 78° or more.
    Square,
    /// Narrowed, with a wall angle of 90° or more: the wall overhangs.
    Invaginated,
    /// Wider than the cylinder by 2 % of D or more in one bulge, and nowhere narrower by as much.
    Swollen,
    /// Buckled out of the cylinder by 2 % of D or more without contraction; or the lumen is closed.
    Collapsed,
}

impl Shape {
    /// All shapes.
    pub const ALL: [Self; 7] = [
        Self::Straight,
        Self::V,
        Self::U,
        Self::Square,
        Self::Invaginated,
        Self::Swollen,
        Self::Collapsed,
    ];
    /// Depth or bulge, in D, below which a tube is straight; also the least contraction 1 − Dmin/D.
    pub const MIN_DEPTH: f64 = 0.02;
    /// Flatness from which a narrowed region is a U.
    const U_FLATNESS: f64 = 0.5;
    /// Wall angle from which a narrowed region is square, in degrees.
    const SQUARE_ANGLE_DEG: f64 = 78.0;

    /// Classifies a tube by its narrowest outer meridian, the inner meridian there, its largest wall angle in degrees,
    /// whether a circular muscle contracts, and the amplitude of its asymmetry in D.
    pub fn of(
        outer: &Wall,
        inner: &Wall,
        wall_angle_deg: f64,
        contracted: bool,
        asymmetry: f64,
    ) -> Self {
        let depth = Tube::OUTER_RADIUS - outer.narrowest().1;
        let widest = outer.points.iter().map(|p| p.1).fold(0.0, f64::max);
        let bulge = widest - Tube::OUTER_RADIUS;
        let is_one_neck =
            bulge < Self::MIN_DEPTH && asymmetry < Self::MIN_DEPTH && narrows_once(outer);
        if inner.narrowest().1 <= 0.0 {
            Self::Collapsed
        } else if depth.max(bulge) < Self::MIN_DEPTH {
            Self::Straight
        } else if !contracted && depth < Self::MIN_DEPTH && bulges_once(outer, bulge) {
            Self::Swollen
        } else if !contracted && !is_one_neck {
            Self::Collapsed
        } else if wall_angle_deg >= 90.0 {
            Self::Invaginated
        } else if wall_angle_deg >= Self::SQUARE_ANGLE_DEG {
            Self::Square
        } else if outer.flatness() < Self::U_FLATNESS {
            Self::V
        } else {
            Self::U
        }
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Colon => "colon",
            Self::Ileum => "ileum",
            Self::None => "none",
        })
    }
}

/// Rise of the radius after a fall, in D, from which a wall rises again.
const MIN_RISE: f64 = 1e-3;

/// The same, in heights of the largest bulge: beside a bulge a thin wall dips below its radius and rises back.
const SECOND_BULGE: f64 = 0.1;

/// Returns whether the radius rises along the wall at most once before it falls for good, to a bulge of that height.
fn bulges_once(wall: &Wall, bulge: f64) -> bool {
    let rise = MIN_RISE.max(SECOND_BULGE * bulge);
    rises_once(wall.points.iter().map(|p| p.1), rise)
}

/// Returns whether the radius falls along the wall at most once before it rises for good.
fn narrows_once(wall: &Wall) -> bool {
    rises_once(wall.points.iter().map(|p| -p.1), MIN_RISE)
}

/// Returns whether values rise at most once, but for rises below a limit, before they fall for good.
fn rises_once(mut values: impl Iterator<Item = f64>, rise: f64) -> bool {
    let (mut highest, mut lowest_since) = (f64::NEG_INFINITY, f64::INFINITY);
    values.all(|r| {
        if r > highest {
            (highest, lowest_since) = (r, r);
        }
        lowest_since = lowest_since.min(r);
        r <= lowest_since + rise
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a wall through 100 points on each straight line between corners (z, r).
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

    /// Classifies a tube of thickness 0.06 by its outer wall.
    fn shape(corners: &[(f64, f64)], diameter_ratio: f64) -> Shape {
        let outer = wall(corners);
        let mut inner = outer.clone();
        for p in &mut inner.points {
            p.1 -= 0.06;
        }
        Shape::of(
            &outer,
            &inner,
            outer.steepest_angle_deg(),
            diameter_ratio <= 1.0 - Shape::MIN_DEPTH,
            0.0,
        )
    }

    /// Returns a notch of radius `bottom` whose corners have the given axial positions.
    fn notch([a, b, c, d]: [f64; 4], bottom: f64) -> [(f64, f64); 6] {
        [
            (0.0, 0.5),
            (a, 0.5),
            (b, bottom),
            (c, bottom),
            (d, 0.5),
            (3.0, 0.5),
        ]
    }

    #[test]
    fn notches_are_classified_with_their_side() {
        for (z, expected) in [
            ([0.5, 0.75, 0.75, 1.0], (Shape::V, Side::None)),
            ([0.5, 0.6, 0.9, 1.0], (Shape::U, Side::None)),
            ([0.5, 0.53, 0.97, 1.0], (Shape::Square, Side::None)),
            ([0.5, 0.4, 0.9, 1.0], (Shape::Invaginated, Side::Colon)),
            ([0.5, 0.6, 1.1, 1.0], (Shape::Invaginated, Side::Ileum)),
            ([0.5, 0.4, 1.1, 1.0], (Shape::Invaginated, Side::None)),
        ] {
            let corners = notch(z, 0.2);
            let found = (shape(&corners, 0.25), wall(&corners).overhang().1);
            assert_eq!(found, expected, "{z:?}");
        }
    }

    #[test]
    fn a_wall_angle_of_78_degrees_is_square_and_one_of_90_invaginated() {
        let outer = wall(&notch([0.5, 0.75, 0.75, 1.0], 0.2));
        let mut inner = outer.clone();
        inner.points.iter_mut().for_each(|p| p.1 -= 0.06);
        for (angle, expected) in [
            (77.9, Shape::V),
            (78.0, Shape::Square),
            (89.9, Shape::Square),
            (90.0, Shape::Invaginated),
        ] {
            let found = Shape::of(&outer, &inner, angle, true, 0.0);
            assert_eq!(found, expected, "{angle}");
        }
    }

    #[test]
    fn a_flatness_of_one_half_separates_v_from_u() {
        // Flanks of axial length 0.4 and a flat bottom w have the flatness (w + 0.2)/(w + 0.6).
        for (w, expected) in [(0.17, Shape::V), (0.23, Shape::U)] {
            let corners = notch([0.5, 0.9, 0.9 + w, 1.3 + w], 0.2);
            let flatness = wall(&corners).flatness();
            assert!((flatness - (w + 0.2) / (w + 0.6)).abs() < 0.01);
            assert_eq!(shape(&corners, 0.25), expected, "{flatness}");
        }
    }

    #[test]
    fn a_depth_of_two_percent_is_no_longer_straight() {
        for (depth, expected) in [(0.0199, Shape::Straight), (0.0201, Shape::V)] {
            let corners = notch([0.5, 0.75, 0.75, 1.0], 0.5 - depth);
            assert_eq!(shape(&corners, 0.25), expected, "{depth}");
        }
        for (bulge, expected) in [(0.0199, Shape::Straight), (0.0201, Shape::Swollen)] {
            let corners = notch([0.5, 0.75, 0.75, 1.0], 0.5 + bulge);
            assert_eq!(shape(&corners, 1.0), expected, "{bulge}");
        }
    }

    #[test]
    fn one_round_neck_is_narrowed_whatever_drives_it() {
        let neck = notch([0.5, 0.75, 0.75, 1.0], 0.2);
        let overhanging = notch([0.5, 0.4, 0.9, 1.0], 0.2);
        for diameter_ratio in [0.25, 1.0, 1.03] {
            assert_eq!(shape(&neck, diameter_ratio), Shape::V);
            assert_eq!(shape(&overhanging, diameter_ratio), Shape::Invaginated);
        }
        let outer = wall(&neck);
        let mut inner = outer.clone();
        inner.points.iter_mut().for_each(|p| p.1 -= 0.06);
        for (asymmetry, expected) in [(0.0199, Shape::V), (0.0201, Shape::Collapsed)] {
            let found = Shape::of(&outer, &inner, 30.0, false, asymmetry);
            assert_eq!(found, expected, "{asymmetry}");
        }
    }

    #[test]
    fn only_a_contraction_of_two_percent_narrows_a_tube_with_bulges_or_two_necks() {
        let neck = notch([0.5, 0.75, 0.75, 1.0], 0.2);
        let mut bulging = neck.to_vec();
        bulging.push((3.5, 0.53));
        let mut twice = neck.to_vec();
        twice.extend([(3.5, 0.4), (4.0, 0.5)]);
        for corners in [bulging, twice] {
            for (diameter_ratio, expected) in [
                (0.9799, Shape::V),
                (0.9801, Shape::Collapsed),
                (1.0, Shape::Collapsed),
                (1.1, Shape::Collapsed),
            ] {
                let found = shape(&corners, diameter_ratio);
                assert_eq!(found, expected, "{diameter_ratio}");
            }
        }
    }

    #[test]
    fn a_widened_tube_is_swollen() {
        let bulge = notch([0.5, 0.75, 0.75, 1.0], 0.53);
        assert_eq!(shape(&bulge, 1.06), Shape::Swollen);
    }

    #[test]
    fn a_closed_lumen_is_collapsed() {
        for (bottom, expected) in [(0.0601, Shape::V), (0.06, Shape::Collapsed)] {
            let corners = notch([0.5, 0.99, 1.01, 1.5], bottom);
            assert_eq!(shape(&corners, 0.25), expected, "{bottom}");
        }
    }

    #[test]
    fn a_tube_with_one_bulge_is_swollen_and_one_with_two_collapsed() {
        let swollen = [(0.0, 0.5), (0.5, 0.56), (1.5, 0.7), (2.5, 0.56), (3.0, 0.5)];
        assert_eq!(shape(&swollen, 1.0), Shape::Swollen);
        assert_eq!(shape(&[(0.0, 0.6), (3.0, 0.6)], 1.0), Shape::Swollen);
        for (rise, expected) in [(5.9e-3, Shape::Swollen), (6.1e-3, Shape::Collapsed)] {
            let rings = [
                (0.0, 0.5),
                (0.5, 0.56),
                (1.0, 0.53),
                (1.5, 0.53 + rise),
                (3.0, 0.5),
            ];
            assert_eq!(shape(&rings, 1.0), expected, "{rise}");
        }
        for (depth, expected) in [(0.0199, Shape::Swollen), (0.0201, Shape::Collapsed)] {
            let necked = [(0.0, 0.5), (1.5, 0.6), (3.0, 0.5 - depth)];
            assert_eq!(shape(&necked, 1.0), expected, "{depth}");
        }
    }

    #[test]
    fn overhang_is_an_axial_distance_independent_of_the_depth() {
        for bottom in [0.4, 0.2] {
            let (overhang, side) = wall(&notch([0.5, 0.4, 0.9, 1.0], bottom)).overhang();
            assert!((overhang - 0.1).abs() < 1e-12 && side == Side::Colon);
        }
    }

    #[test]
    fn wall_angles_are_those_of_the_drawn_lines() {
        let angle = |z: f64, r: f64| wall(&[(0.0, 0.5), (z, 0.5 - r)]).steepest_angle_deg();
        assert!((angle(0.3, 0.3) - 45.0).abs() < 1e-9);
        assert!((angle(-0.3, 0.3) - 135.0).abs() < 1e-9);
    }
}
