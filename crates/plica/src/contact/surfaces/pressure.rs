//! The pressure of contact at points of a face.

use super::SurfaceContact;
use super::pairs::FaceState;
use super::patch::PatchPoint;
use super::vector::{cross, length, minus};
use crate::contact::{Face, PressedPoint};

/// The pressure of contact in a state of a tube of many rings.
pub struct SurfacePressure<'a> {
    contact: &'a SurfaceContact,
    faces: Vec<FaceState<'a>>,
}

impl SurfacePressure<'_> {
    /// Returns the pressure at a place (v, w) of an element along and around a face: force per current area, in E.
    pub fn at(&self, face: Face, [e, f]: [usize; 2], place: [f64; 2]) -> f64 {
        let state = &self.faces[usize::from(face == Face::Inner)];
        let x = (e * state.net.around + f, place);
        let barrier = &self.contact.barrier;
        let mut sum = 0.0;
        state.pairs_of_point(
            x,
            &state.near_point(x, barrier.range),
            barrier,
            &mut |y, at_x, at_y| {
                let gap = length(minus(at_x.position, at_y.position));
                let areas = rest_area(state, x.0, at_x) + rest_area(state, y.0, at_y);
                sum -= 0.5 * barrier.at(gap).slope * areas;
            },
        );
        sum
    }
}

/// Returns dA₀/da at a point of a patch.
fn rest_area(state: &FaceState<'_>, patch: usize, at: &PatchPoint) -> f64 {
    state.area(patch) / length(cross(at.slopes[0], at.slopes[1]))
}

impl SurfaceContact {
    /// Returns the pressure of contact in a state.
    pub fn pressure(&self, u: &[f64]) -> SurfacePressure<'_> {
        SurfacePressure {
            contact: self,
            faces: self
                .faces
                .iter()
                .map(|(net, tree)| FaceState::new(net, tree, u))
                .collect(),
        }
    }

    /// Returns the quadrature points of a face that are under pressure, with the area of all sectors.
    pub fn pressed_points(&self, u: &[f64], face: Face) -> Vec<PressedPoint> {
        let pressure = self.pressure(u);
        let state = &pressure.faces[usize::from(face == Face::Inner)];
        let mut places: Vec<(usize, [f64; 2])> = vec![];
        for pair in state.pairs(&self.quadrature, &self.barrier) {
            let place = (pair.patches[0], pair.places[0]);
            if places.last() != Some(&place) {
                places.push(place);
            }
        }
        let [along, around] = &self.quadrature.points;
        let weight = |points: &[(f64, f64)], x: f64| {
            let own = points.iter().find(|(at, _)| *at == x);
            own.map_or(0.0, |(_, weight)| *weight)
        };
        let point = |&(patch, place): &(usize, [f64; 2])| {
            let at = state.patches[patch].at(place);
            let size = length(cross(at.slopes[0], at.slopes[1]));
            PressedPoint {
                z: at.position[0],
                area: self.repeats * weight(along, place[0]) * weight(around, place[1]) * size,
                pressure: pressure.at(face, state.net.elements_of(patch), place),
            }
        };
        places.iter().map(point).collect()
    }
}
