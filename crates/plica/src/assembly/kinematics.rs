//! From control points to the elastic deformation gradient, and back from its stress to forces.

use super::stress_free::Departure;
use super::tables::Around;
use crate::rings::SlotValues;
use crate::tensor::{Real, Tensor2};

/// Components of a displacement in the frame of an element: axial, outwards, around.
pub type Vector<S> = [S; 3];

/// The linear map from gradients over the parameters (ζ, s, R) to the columns (along,
/// outwards, around) of Fe = F Fp⁻¹ at a point. With θζ, θη grown and ∂X/∂s = R (outwards a + across b):
///
/// - Fe along    = ∂x/∂ζ / θζ
/// - Fe around   = (∂x/∂s / (R b) − ∂x/∂R a / (b |C|)) / θη
/// - Fe outwards = ∂x/∂R / |C|
///
/// An imperfect wall's departs from that, see [`Departure`].
#[derive(Clone, Copy)]
pub struct Columns<S> {
    along: S,
    around: S,
    across: S,
    outwards: S,
    imperfection_map: Option<Departure<S>>,
}

impl<S: Real> Columns<S> {
    /// At reference radius R, for 1/θζ and 1/θη.
    #[inline(always)]
    pub fn new(point: &Around, radius: f64, inverse_along: S, inverse_around: S) -> Self {
        let b = point.across;
        Self {
            along: inverse_along,
            around: inverse_around.times(1.0 / (radius * b)),
            across: inverse_around.times(-point.outwards / (b * point.radius)),
            outwards: inverse_along.like(1.0 / point.radius),
            imperfection_map: None,
        }
    }

    /// The same of an imperfect wall.
    #[inline(always)]
    pub fn measured_from(mut self, imperfection_map: Option<Departure<S>>) -> Self {
        self.imperfection_map = imperfection_map;
        self
    }

    /// A volume dV₀ of the perfect tube, as the wall has it where it is free of stress.
    #[inline(always)]
    pub fn volume(&self, volume: S) -> S {
        match &self.imperfection_map {
            Some(imperfection_map) => imperfection_map.volume(volume),
            None => volume,
        }
    }

    /// Fe from the displacement gradients over ζ, s and R: the reference gradients are added
    /// here, so that a tube at rest has Fe = Fp⁻¹ to rounding.
    #[inline(always)]
    pub fn elastic(&self, point: &Around, radius: f64, [zeta, s, r]: [Vector<S>; 3]) -> Tensor2<S> {
        let plain = |x: f64| self.along.like(x);
        let zeta = [zeta[0] + plain(1.0), zeta[1], zeta[2]];
        let (slope, circle) = (point.circle_slope, point.circle);
        let s = [
            s[0],
            s[1] + plain(radius * slope.0),
            s[2] + plain(radius * slope.1),
        ];
        let r = [r[0], r[1] + plain(circle.0), r[2] + plain(circle.1)];
        self.linear([zeta, s, r])
    }

    /// The change of Fe with the gradients over ζ, s and R.
    #[inline(always)]
    pub fn linear(&self, [zeta, s, r]: [Vector<S>; 3]) -> Tensor2<S> {
        let mut Fe = [[self.along; 3]; 3];
        for i in 0..3 {
            Fe[i][0] = zeta[i] * self.along;
            Fe[i][1] = r[i] * self.outwards;
            Fe[i][2] = s[i].mul_add(self.around, r[i] * self.across);
        }
        match &self.imperfection_map {
            Some(imperfection_map) => imperfection_map.onto(Tensor2(Fe)),
            None => Tensor2(Fe),
        }
    }

    /// The transpose of [`Columns::elastic`]: stresses on gradients over ζ, s and R.
    #[inline(always)]
    pub fn pulled_back(&self, P: &Tensor2<S>) -> [Vector<S>; 3] {
        let P = match &self.imperfection_map {
            Some(imperfection_map) => imperfection_map.back(*P).0,
            None => P.0,
        };
        let mut q = P;
        for i in 0..3 {
            let [along, outwards, around] = P[i];
            q[0][i] = along * self.along;
            q[1][i] = around * self.around;
            q[2][i] = around.mul_add(self.across, outwards * self.outwards);
        }
        q
    }

    /// Moduli on gradients over ζ, s and R: the blocks (ζ,ζ), (ζ,s), (ζ,R), (s,s), (s,R), (R,R)
    /// of 3×3 numbers, each scaled by `weight`.
    #[inline(always)]
    pub fn moduli(&self, A: &crate::material::Moduli<S>, weight: S) -> [[[S; 3]; 3]; 6] {
        let seen;
        let A = match &self.imperfection_map {
            Some(imperfection_map) => {
                seen = imperfection_map.moduli(A);
                &seen
            }
            None => A,
        };
        let (z, e, x, o) = (self.along, self.around, self.across, self.outwards);
        let (wz, we, wx, wo) = (weight * z, weight * e, weight * x, weight * o);
        let mut blocks = [[[weight; 3]; 3]; 6];
        for j in 0..3 {
            for i in 0..3 {
                // A holds the columns (along, outwards, around) in the order j ≤ i only.
                let (zz, zo, ze) = (A[j][i], A[j][3 + i], A[j][6 + i]);
                let (oo, oe, ee) = (A[3 + j][3 + i], A[3 + j][6 + i], A[6 + j][6 + i]);
                let eo = A[3 + i][6 + j];
                blocks[0][j][i] = wz * z * zz;
                blocks[1][j][i] = wz * e * ze;
                blocks[2][j][i] = wz * x.mul_add(ze, o * zo);
                blocks[3][j][i] = we * e * ee;
                blocks[4][j][i] = we * x.mul_add(ee, o * eo);
                blocks[5][j][i] = wx.mul_add(x.mul_add(ee, o * (eo + oe)), wo * o * oo);
            }
        }
        blocks
    }
}

/// A ring's (axial, radial, circumferential) displacement as one slot adds it in the element's
/// frame; `d` is 0 for the value, 1 for the slope around.
#[inline(always)]
pub fn turn<S: Real>(slot: &SlotValues, d: usize, u: Vector<S>, sum: Vector<S>) -> Vector<S> {
    let (g, (re, im)) = (u[0].like(slot.axial[d]), slot.turned[d]);
    let (re, im, minus_im) = (u[0].like(re), u[0].like(im), u[0].like(-im));
    [
        g.mul_add(u[0], sum[0]),
        re.mul_add(u[1], minus_im.mul_add(u[2], sum[1])),
        im.mul_add(u[1], re.mul_add(u[2], sum[2])),
    ]
}

/// The transpose of [`turn`]: a force in the element's frame on the components of a ring.
#[inline(always)]
pub fn turn_back<S: Real>(slot: &SlotValues, d: usize, f: Vector<S>, sum: Vector<S>) -> Vector<S> {
    let (g, (re, im)) = (f[0].like(slot.axial[d]), slot.turned[d]);
    let (re, im, minus_im) = (f[0].like(re), f[0].like(im), f[0].like(-im));
    [
        g.mul_add(f[0], sum[0]),
        re.mul_add(f[1], im.mul_add(f[2], sum[1])),
        minus_im.mul_add(f[1], re.mul_add(f[2], sum[2])),
    ]
}
