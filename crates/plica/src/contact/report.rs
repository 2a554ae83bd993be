//! Contact of a state in numbers.

use super::{ContactState, Face, FaceFriction, FaceSurface, SelfContact};

/// Contact of a state, on the whole tube.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactReport {
    /// Energy of contact Π_c, in E·D³.
    pub energy: f64,
    /// Contact of the outer face and of the inner face; none where a face touches itself nowhere.
    pub faces: [Option<FaceContact>; 2],
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

impl SelfContact {
    /// Sums up the contact of a state, with its surfaces.
    pub fn report(
        &self,
        at: &ContactState,
        surfaces: [FaceSurface; 2],
        position: impl Fn(usize, f64) -> f64,
    ) -> ContactReport {
        let mut report = ContactReport {
            energy: 0.0,
            faces: [None; 2],
            surfaces,
            friction: None,
        };
        for ((curve, _), pairs) in self.faces.iter().zip(&at.0) {
            let mut sum: Option<FaceContact> = None;
            // A point may belong to several pairs; its area counts once.
            let mut last = None;
            for pair in pairs {
                let z = position(pair.x.0, pair.places[0]);
                let face = sum.get_or_insert(FaceContact {
                    area: 0.0,
                    force: 0.0,
                    gap: f64::INFINITY,
                    from_to: [f64::INFINITY, f64::NEG_INFINITY],
                });
                if last != Some(z) {
                    face.area += self.repeats * pair.area;
                    last = Some(z);
                }
                face.force -= 0.5 * self.repeats * pair.area * pair.barrier.slope;
                face.gap = face.gap.min(pair.gap);
                face.from_to = [face.from_to[0].min(z), face.from_to[1].max(z)];
                report.energy += 0.5 * self.repeats * pair.area * pair.barrier.value;
            }
            report.faces[usize::from(curve.face == Face::Inner)] = sum;
        }
        report
    }
}
