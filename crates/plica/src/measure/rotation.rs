//! Rotation of the flanks of a contraction.

use super::{Side, Wall};
use crate::tube::Tube;

/// Fractions of the depth at the ends of a flank.
const FLANK: [f64; 2] = [0.25, 0.75];

/// Flank of a narrowed tube: the straight line through the two points on one side of the narrowest point where the
/// wall is narrowed by a quarter and three quarters of the depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flank {
    /// Midpoint (z, ρ) of its two ends.
    pub middle: (f64, f64),
    /// Angle to the axis, measured from its own shoulder inwards: 0° along the tube, 90° radial, above 90° where it
    /// overhangs.
    pub angle_deg: f64,
    /// 1 on the colon side, −1 on the ileum side.
    side: f64,
}

/// Rotation of a flank over several states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// Centre (z, ρ): the point with the least squared distance from all the lines.
    pub centre: (f64, f64),
    /// Rotation from the first state to the last, in degrees; positive if the flank gets steeper.
    pub angle_deg: f64,
    /// Largest distance of a line from the centre, in D: 0 for a pure rotation.
    pub max_distance: f64,
}

impl Flank {
    /// Returns the flank of a wall on one side; none if the wall is nowhere narrower than at rest, or does not return
    /// to a quarter of the depth on that side.
    pub fn of(wall: &Wall, side: Side) -> Option<Self> {
        let points = &wall.points;
        let narrowest = (0..points.len()).min_by(|&a, &b| points[a].1.total_cmp(&points[b].1))?;
        let depth = Tube::OUTER_RADIUS - points[narrowest].1;
        if depth <= 0.0 {
            return None;
        }
        let half: Vec<(f64, f64)> = match side {
            Side::Colon => points[..=narrowest].iter().rev().copied().collect(),
            Side::Ileum => points[narrowest..].to_vec(),
            Side::None => return None,
        };
        let crossing = |part: f64| {
            let radius = Tube::OUTER_RADIUS - part * depth;
            let pair = half.windows(2).find(|p| p[1].1 >= radius)?;
            let [(z0, r0), (z1, r1)] = [pair[0], pair[1]];
            Some((z0 + (z1 - z0) * (radius - r0) / (r1 - r0), radius))
        };
        let ends = FLANK.map(crossing);
        let [Some(outer), Some(inner)] = ends else {
            return None;
        };
        let sign = if side == Side::Colon { 1.0 } else { -1.0 };
        Some(Self {
            middle: (0.5 * (outer.0 + inner.0), 0.5 * (outer.1 + inner.1)),
            angle_deg: (outer.1 - inner.1)
                .atan2(sign * (inner.0 - outer.0))
                .to_degrees(),
            side: sign,
        })
    }

    /// Returns the unit normal (z, ρ) of its line, whose direction is (side · cos, −sin).
    fn normal(&self) -> (f64, f64) {
        let (sin, cos) = self.angle_deg.to_radians().sin_cos();
        (sin, self.side * cos)
    }

    /// Returns the signed distance of a point from its line.
    fn distance(&self, (z, r): (f64, f64)) -> f64 {
        let (nz, nr) = self.normal();
        nz * (z - self.middle.0) + nr * (r - self.middle.1)
    }
}

impl Rotation {
    /// Returns the rotation of a flank over the walls of successive states; none for fewer than two walls, if a wall has
    /// no such flank, or if the lines are parallel.
    pub fn of(walls: &[&Wall], side: Side) -> Option<Self> {
        let flanks: Option<Vec<Flank>> = walls.iter().map(|wall| Flank::of(wall, side)).collect();
        let flanks = flanks?;
        let [first, .., last] = flanks.as_slice() else {
            return None;
        };
        // Least squares: Σ n (n · c − n · m) = 0 over the lines' unit normals n and midpoints m.
        let (mut zz, mut zr, mut rr, mut z, mut r) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for flank in &flanks {
            let (nz, nr) = flank.normal();
            let at = nz * flank.middle.0 + nr * flank.middle.1;
            (zz, zr, rr) = (zz + nz * nz, zr + nz * nr, rr + nr * nr);
            (z, r) = (z + nz * at, r + nr * at);
        }
        let det = zz * rr - zr * zr;
        // For two lines `det` is the squared sine of the angle between them.
        if det < 1e-6 {
            return None;
        }
        let centre = ((rr * z - zr * r) / det, (zz * r - zr * z) / det);
        let distances = flanks.iter().map(|flank| flank.distance(centre).abs());
        Some(Self {
            centre,
            angle_deg: last.angle_deg - first.angle_deg,
            max_distance: distances.fold(0.0, f64::max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a notch between (a, 0.5) and (b, 0.5), 0.3 deep, with flanks at the given angles.
    fn notch(a: f64, b: f64, [colon, ileum]: [f64; 2]) -> Wall {
        let run = |angle: f64| 0.3 / angle.to_radians().tan();
        let corners = [
            (0.0, 0.5),
            (a, 0.5),
            (a + run(colon), 0.2),
            (b - run(ileum), 0.2),
            (b, 0.5),
            (3.0, 0.5),
        ];
        let mut points = vec![corners[0]];
        for ends in corners.windows(2) {
            let [(z0, r0), (z1, r1)] = [ends[0], ends[1]];
            for i in 1..=50 {
                let t = f64::from(i) / 50.0;
                points.push((z0 + t * (z1 - z0), r0 + t * (r1 - r0)));
            }
        }
        Wall {
            angle: 0.0,
            reference_z: vec![0.0; points.len()],
            points,
        }
    }

    #[test]
    fn flanks_have_the_angles_of_the_wall() {
        let wall = notch(0.5, 1.5, [60.0, 100.0]);
        let [colon, ileum] = [Side::Colon, Side::Ileum].map(|side| Flank::of(&wall, side).unwrap());
        assert!((colon.angle_deg - 60.0).abs() < 1e-9, "{colon:?}");
        assert!((ileum.angle_deg - 100.0).abs() < 1e-9, "{ileum:?}");
        assert!((colon.middle.1 - 0.35).abs() < 1e-9);
        assert_eq!(Flank::of(&wall, Side::None), None);
        let cylinder = notch(0.5, 1.5, [60.0, 60.0]);
        let cylinder = Wall {
            points: cylinder.points.iter().map(|&(z, _)| (z, 0.5)).collect(),
            ..cylinder
        };
        assert_eq!(Flank::of(&cylinder, Side::Colon), None);
    }

    #[test]
    fn the_centre_of_a_flank_that_rotates_about_a_point_is_that_point() {
        // The line of the colon flank passes through (0.7, 0.4) at every angle.
        let through = |angle: f64| 0.7 - 0.1 / angle.to_radians().tan();
        let walls = [55.0, 85.0, 105.0].map(|angle| notch(through(angle), 1.9, [angle, 70.0]));
        let walls: Vec<&Wall> = walls.iter().collect();
        let rotation = Rotation::of(&walls, Side::Colon).unwrap();
        assert!((rotation.centre.0 - 0.7).abs() < 1e-9, "{rotation:?}");
        assert!((rotation.centre.1 - 0.4).abs() < 1e-9);
        assert!((rotation.angle_deg - 50.0).abs() < 1e-9 && rotation.max_distance < 1e-9);
        // The other flank does not rotate.
        assert_eq!(Rotation::of(&walls, Side::Ileum), None);
        assert_eq!(Rotation::of(&walls[..1], Side::Colon), None);
    }

    #[test]
    fn the_rotation_of_a_mirrored_wall_is_mirrored() {
        let walls = [55.0, 95.0].map(|angle| notch(0.6, 1.9, [angle, 70.0]));
        let mirrored = walls.clone().map(|wall| Wall {
            points: wall
                .points
                .iter()
                .rev()
                .map(|&(z, r)| (3.0 - z, r))
                .collect(),
            ..wall
        });
        let of = |walls: &[Wall; 2], side| Rotation::of(&[&walls[0], &walls[1]], side).unwrap();
        let (colon, ileum) = (of(&walls, Side::Colon), of(&mirrored, Side::Ileum));
        assert!((colon.angle_deg - ileum.angle_deg).abs() < 1e-9);
        assert!((colon.centre.0 - (3.0 - ileum.centre.0)).abs() < 1e-9);
        assert!((colon.centre.1 - ileum.centre.1).abs() < 1e-9);
    }

    #[test]
    fn a_translation_of_the_flank_increases_the_distance_from_the_centre() {
        let walls = [(0.0, 60.0), (0.02, 80.0), (0.0, 100.0)]
            .map(|(shift, angle)| notch(0.6 + shift, 1.9, [angle, 70.0]));
        let walls: Vec<&Wall> = walls.iter().collect();
        let distance = Rotation::of(&walls, Side::Colon).unwrap().max_distance;
        assert!((0.005..0.02).contains(&distance), "{distance}");
    }
}
