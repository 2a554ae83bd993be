//! An active tension along the fibres of a muscle, a part of the energy of a [`Composite`](super::Composite).
//!
//! With the stretch λ = |Fe a| of the fibres, w(1) = 0 and w′(λ) = T f(λ): the nominal stress along the fibres is the tension
//! T times the fraction f of a [`LengthTension`]. Where f falls, w is not convex.

use super::invariant_tangent::Structure;
use super::{LengthTension, Moduli};
use crate::tensor::{Real, Tensor2};

/// An active tension.
#[derive(Clone, Debug, PartialEq)]
pub struct Tone {
    /// Tension T, with the unit of a stress.
    pub tension: f64,
    /// Dependence on the stretch.
    pub relation: LengthTension,
    /// Components of a along the tube and around it.
    direction: [f64; 2],
}

impl Tone {
    /// Creates a tension at an angle from the circumference toward the axis, in radians.
    pub fn new(tension: f64, relation: LengthTension, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            tension,
            relation,
            direction: [sin, cos],
        }
    }

    /// Returns whether reflection in a plane through the axis leaves the direction unchanged.
    pub fn is_mirror_symmetric(&self) -> bool {
        (self.direction[0] * self.direction[1]).abs() < 1e-9
    }

    /// Returns a ⊗ a.
    #[inline(always)]
    pub(super) fn structure(&self) -> Structure {
        Structure {
            isotropic: 0.0,
            directed: 1.0,
            direction: self.direction,
        }
    }

    /// Returns (w″ − w′/λ)/λ² and w′/λ.
    #[inline(always)]
    pub(super) fn derivatives<S: Real>(&self, F: &Tensor2<S>) -> [S; 2] {
        let [_, over, curvature] = self.stretched(F).1;
        [curvature, over]
    }

    /// Returns Fe a, and w, w′/λ and (w″ − w′/λ)/λ².
    #[inline(always)]
    fn stretched<S: Real>(&self, F: &Tensor2<S>) -> ([S; 3], [S; 3]) {
        let [along, around] = self.direction;
        let mut Fa = F.0[0];
        let mut square = Fa[0].like(0.0);
        for i in 0..3 {
            Fa[i] = F.0[i][0].times(along) + F.0[i][2].times(around);
            square = Fa[i].mul_add(Fa[i], square);
        }
        let stretch = square.ln().times(0.5).exp();
        let own = self.relation.at(stretch);
        let [w, slope, curvature] = own.map(|x| x.times(self.tension));
        let over = slope / stretch;
        (Fa, [w, over, (curvature - over) / square])
    }

    /// Returns the energy.
    #[inline(always)]
    pub(super) fn energy<S: Real>(&self, F: &Tensor2<S>) -> S {
        self.stretched(F).1[0]
    }

    /// Adds the stress w′/λ Fe a ⊗ a.
    #[inline(always)]
    pub(super) fn add_stress<S: Real>(&self, F: &Tensor2<S>, P: &mut Tensor2<S>) {
        let (Fa, [_, slope, _]) = self.stretched(F);
        let [along, around] = self.direction;
        for i in 0..3 {
            let f = Fa[i] * slope;
            P.0[i][0] += f.times(along);
            P.0[i][2] += f.times(around);
        }
    }

    /// Adds the moduli a_k a_l (w′/λ δ_ij + (w″ − w′/λ)/λ² Fa_i Fa_j).
    #[inline(always)]
    pub(super) fn add_moduli<S: Real>(&self, F: &Tensor2<S>, A: &mut Moduli<S>) {
        let (Fa, [_, slope, curvature]) = self.stretched(F);
        let a = [self.direction[0], 0.0, self.direction[1]];
        for k in 0..3 {
            for l in k..3 {
                for j in 0..3 {
                    for i in 0..3 {
                        let entry = curvature * Fa[j] * Fa[i];
                        let entry = if i == j { entry + slope } else { entry };
                        A[3 * k + j][3 * l + i] += entry.times(a[k] * a[l]);
                    }
                }
            }
        }
    }
}
