//! Contact of a state in numbers.

use super::{FaceFriction, FaceSurface};

/// Contact of a state, on the whole tube.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactReport {
    /// Energy of contact Π_c, in E·D³.
    pub energy: f64,
    /// Contact of the outer face and of the inner face; none where a face touches itself nowhere.
    pub faces: [Option<FaceContact>; 2],
    /// First and last angle at rest, in radians, of the shortest arc with all points of the outer and of the inner face in
    /// contact, modulo the angle of the sector, see [`shortest_arc`](crate::rings::shortest_arc); zero where a face touches
    /// itself nowhere. None of an axisymmetric tube.
    pub angles: Option<[[f64; 2]; 2]>,
    /// Stretch and turning of the outer and the inner face.
    pub surfaces: [FaceSurface; 2],
    /// Friction of the outer face and of the inner face with itself; none without friction.
    pub friction: Option<[FaceFriction; 2]>,
}

/// Contact of one face with itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceContact {
    /// Area at rest of both sides, in D².
    pub area: f64,
    /// Sum of the sizes of the forces between the two sides, in E·D².
    pub force: f64,
    /// Smallest gap, in D.
    pub gap: f64,
    /// Axial positions at rest of the first and the last point, in D.
    pub from_to: [f64; 2],
}

impl FaceContact {
    /// Contact without points.
    const NONE: Self = Self {
        area: 0.0,
        force: 0.0,
        gap: f64::INFINITY,
        from_to: [f64::INFINITY, f64::NEG_INFINITY],
    };

    /// Adds a pair of points to the contact of a face: the axial position at rest of the first, the force between them, and
    /// their gap. `area` is that of the first point; zero if it belongs to a pair already.
    pub(super) fn add(sum: &mut Option<Self>, z: f64, area: f64, force: f64, gap: f64) {
        let face = sum.get_or_insert(Self::NONE);
        face.area += area;
        face.force += force;
        face.gap = face.gap.min(gap);
        face.from_to = [face.from_to[0].min(z), face.from_to[1].max(z)];
    }
}
