//! The pressure of contact at points of a face.

use super::bezier::{Bezier, Point};
use super::boxes::{Box2, BoxTree};
use super::curve::FaceCurve;
use super::pairs::{FaceQuadrature, pairs_of_point};
use super::{Face, MeridianContact, bezier};
use crate::contact::PressedPoint;
use std::f64::consts::TAU;

/// The pressure of contact in a state.
pub struct MeridianPressure<'a> {
    contact: &'a MeridianContact,
    /// The curves of each face and the tree of their boxes.
    faces: Vec<(Vec<Bezier>, BoxTree)>,
}

impl MeridianPressure<'_> {
    /// Returns the pressure at a place of a face, given as an element and a position from 0 to 1 in it: force per current
    /// area, in E.
    pub fn at(&self, face: Face, (e, xi): (usize, f64)) -> f64 {
        let index = usize::from(face == Face::Inner);
        let contact = self.contact;
        let (face, quadrature) = &contact.faces[index];
        let (curves, tree) = &self.faces[index];
        // dA₀/da of a point of an element with the derivative x′ over the position in it.
        let rest_area = |element: usize, radius: f64, slope: Point| {
            contact.repeats * quadrature.area(element) / (TAU * radius * bezier::length(slope))
        };
        let at = curves[e].at(xi);
        let mut pairs = vec![];
        let place = Box2::around([at.position]);
        tree.near(&place, contact.barrier.range, &mut |other| {
            let (x, y) = ((e, &curves[e], xi), (other, &curves[other]));
            pairs_of_point(face, x, y, &contact.barrier, 1.0, &mut pairs);
        });
        let here = rest_area(e, at.position[1], at.slope);
        let of_pair = |pair: &super::Pair| {
            let there = rest_area(pair.y.0, pair.radii[1], pair.slope);
            -0.5 * pair.barrier.slope * (here + there)
        };
        pairs.iter().map(of_pair).sum()
    }
}

impl MeridianContact {
    /// Returns the pressure of contact in a state.
    pub fn pressure(&self, u: &[f64]) -> MeridianPressure<'_> {
        let of_face = |(curve, _): &(FaceCurve, FaceQuadrature)| {
            let curves = curve.curves(u);
            let tree = BoxTree::of_curves(&curves);
            (curves, tree)
        };
        MeridianPressure {
            contact: self,
            faces: self.faces.iter().map(of_face).collect(),
        }
    }

    /// Returns the quadrature points of a face that are under pressure. The sum of pressure times area is twice the force
    /// between the two sides of the contact.
    pub fn pressed_points(&self, u: &[f64], face: Face) -> Vec<PressedPoint> {
        let field = self.pressure(u);
        let index = usize::from(face == Face::Inner);
        let (curves, points) = (&field.faces[index].0, self.faces[index].1.points());
        let places = (0..curves.len()).flat_map(|e| points.iter().map(move |&of| (e, of)));
        let pressed = |(e, (xi, weight)): (usize, (f64, f64))| {
            let at = curves[e].at(xi);
            let point = PressedPoint {
                z: at.position[0],
                area: weight * TAU * at.position[1] * bezier::length(at.slope),
                pressure: field.at(face, (e, xi)),
            };
            (point.pressure > 0.0).then_some(point)
        };
        places.filter_map(pressed).collect()
    }
}
