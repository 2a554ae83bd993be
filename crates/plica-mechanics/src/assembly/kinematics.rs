//! Elastic deformation gradient from displacement gradients, and the transposed map for stresses.

use super::stress_free::ImperfectionMap;
use super::tables::CircumferentialPoint;
use crate::rings::RingValues;
use crate::tensor::{Real, Tensor2};

/// Components of a displacement in the frame of an element: (axial, outwards, around).
pub type Vector<S> = [S; 3];

/// Linear map from gradients over the parameters (ζ, s, R) to the columns (along, outwards, around)
/// of Fe = F Fp⁻¹ at a point. With the growth stretches θζ, θη and ∂X/∂s = R (outwards a + across
/// b):
///
/// - Fe along    = ∂x/∂ζ / θζ
/// - Fe around   = (∂x/∂s / (R b) − ∂x/∂R a / (b |C|)) / θη
/// - Fe outwards = ∂x/∂R / |C|
///
/// In an imperfect or patched wall an [`ImperfectionMap`] follows.
#[derive(Clone, Copy)]
pub struct GradientMap<S> {
    along: S,
    around: S,
    across: S,
    outwards: S,
    imperfection_map: Option<ImperfectionMap<S>>,
}

impl<S: Real> GradientMap<S> {
    /// Returns the map at reference radius R of a perfect wall, given 1/θζ and 1/θη of the muscles, and of the
    /// residual stretch.
    #[inline(always)]
    pub fn new(
        point: &CircumferentialPoint,
        radius: f64,
        [inverse_along, inverse_around]: [S; 2],
        residual: [f64; 2],
    ) -> Self {
        let b = point.across;
        Self {
            along: inverse_along.times(residual[0]),
            around: inverse_around.times(residual[1] / (radius * b)),
            across: inverse_around.times(-residual[1] * point.outwards / (b * point.radius)),
            outwards: inverse_along.like(1.0 / point.radius),
            imperfection_map: None,
        }
    }

    /// Returns the map with the correction for an imperfect wall.
    #[inline(always)]
    pub fn with_imperfection(mut self, imperfection_map: Option<ImperfectionMap<S>>) -> Self {
        self.imperfection_map = imperfection_map;
        self
    }

    /// Converts a volume dV₀ of the perfect tube to the stress-free shape of the wall, and multiplies it by the factor of
    /// patches on the energy.
    #[inline(always)]
    pub fn stress_free_volume(&self, volume: S) -> S {
        match &self.imperfection_map {
            Some(map) => map.volume(volume),
            None => volume,
        }
    }

    /// Converts a volume grown by the muscles to that grown by patches too.
    #[inline(always)]
    pub fn grown_volume(&self, volume: S) -> S {
        match &self.imperfection_map {
            Some(map) => map.grown(volume),
            None => volume,
        }
    }

    /// Returns Fe from the displacement gradients over ζ, s and R. The reference gradients are
    /// added here, so that a tube at rest has Fe = Fp⁻¹ to rounding.
    #[inline(always)]
    pub fn elastic_gradient(
        &self,
        point: &CircumferentialPoint,
        radius: f64,
        [zeta, s, r]: [Vector<S>; 3],
    ) -> Tensor2<S> {
        let plain = |x: f64| self.along.like(x);
        let zeta = [zeta[0] + plain(1.0), zeta[1], zeta[2]];
        let (slope, circle) = (point.circle_slope, point.circle);
        let s = [
            s[0],
            s[1] + plain(radius * slope.0),
            s[2] + plain(radius * slope.1),
        ];
        let r = [r[0], r[1] + plain(circle.0), r[2] + plain(circle.1)];
        self.elastic_gradient_change([zeta, s, r])
    }

    /// Returns the change of Fe for a change of the gradients over ζ, s and R.
    #[inline(always)]
    pub fn elastic_gradient_change(&self, [zeta, s, r]: [Vector<S>; 3]) -> Tensor2<S> {
        let mut Fe = [[self.along; 3]; 3];
        for i in 0..3 {
            Fe[i][0] = zeta[i] * self.along;
            Fe[i][1] = r[i] * self.outwards;
            Fe[i][2] = s[i].mul_add(self.around, r[i] * self.across);
        }
        match &self.imperfection_map {
            Some(map) => map.apply(Tensor2(Fe)),
            None => Tensor2(Fe),
        }
    }

    /// Transpose of [`GradientMap::elastic_gradient_change`]: maps a stress on Fe to gradients over
    /// ζ, s and R.
    #[inline(always)]
    pub fn pull_back(&self, P: &Tensor2<S>) -> [Vector<S>; 3] {
        let P = match &self.imperfection_map {
            Some(map) => map.apply_transpose(*P).0,
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

    /// Maps moduli on Fe to gradients over ζ, s and R: returns the 3×3 blocks (ζ,ζ), (ζ,s), (ζ,R),
    /// (s,s), (s,R), (R,R), each times `weight`.
    #[inline(always)]
    pub fn pull_back_moduli(&self, A: &crate::material::Moduli<S>, weight: S) -> [[[S; 3]; 3]; 6] {
        let pulled_back;
        let A = match &self.imperfection_map {
            Some(map) => {
                pulled_back = map.pull_back_moduli(A);
                &pulled_back
            }
            None => A,
        };
        let (z, e, x, o) = (self.along, self.around, self.across, self.outwards);
        let (wz, we, wx, wo) = (weight * z, weight * e, weight * x, weight * o);
        let mut blocks = [[[weight; 3]; 3]; 6];
        for j in 0..3 {
            for i in 0..3 {
                // A stores only the columns (along, outwards, around) in the order j ≤ i.
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

/// Adds the displacement `u` of a ring, in (axial, radial, circumferential) components, to a sum in
/// the element's frame. `d` is 0 for the value, 1 for the slope around.
#[inline(always)]
pub fn to_element_frame<S: Real>(
    ring: &RingValues,
    d: usize,
    u: Vector<S>,
    sum: Vector<S>,
) -> Vector<S> {
    let (g, (re, im)) = (u[0].like(ring.axial[d]), ring.rotated[d]);
    let (re, im, minus_im) = (u[0].like(re), u[0].like(im), u[0].like(-im));
    [
        g.mul_add(u[0], sum[0]),
        re.mul_add(u[1], minus_im.mul_add(u[2], sum[1])),
        im.mul_add(u[1], re.mul_add(u[2], sum[2])),
    ]
}

/// Transpose of [`to_element_frame`]: adds a force in the element's frame to the components of a
/// ring.
#[inline(always)]
pub fn to_ring_frame<S: Real>(
    ring: &RingValues,
    d: usize,
    f: Vector<S>,
    sum: Vector<S>,
) -> Vector<S> {
    let (g, (re, im)) = (f[0].like(ring.axial[d]), ring.rotated[d]);
    let (re, im, minus_im) = (f[0].like(re), f[0].like(im), f[0].like(-im));
    [
        g.mul_add(f[0], sum[0]),
        re.mul_add(f[1], im.mul_add(f[2], sum[1])),
        minus_im.mul_add(f[1], re.mul_add(f[2], sum[2])),
    ]
}
