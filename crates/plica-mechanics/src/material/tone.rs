//! A constant active tension along the fibres of a muscle, a part of the energy of a [`Composite`](super::Composite).
//!
//! With the stretch λ = |Fe a| of the fibres and w(1) = 0:
//!
//! - constant tension: w′(λ) = T;
//! - with a length of maximum (Rachev and Hayashi 1999): w′(λ) = T (1 − ((λM − λ)/(λM − λ0))²) where this is positive, for
//!   λ0 < λ < 2 λM − λ0, and else zero.
//!
//! w′ is the nominal stress along the fibres. Beyond λM it falls, and w is not convex.

use super::Moduli;
use crate::tensor::{Real, Tensor2};

/// A constant active tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Tension T, with the unit of a stress.
    pub tension: f64,
    /// λM and λ0; none for a tension that does not depend on the stretch.
    pub stretches: Option<[f64; 2]>,
    /// Components of a along the tube and around it.
    direction: [f64; 2],
}

impl Tone {
    /// Creates a tension at an angle from the circumference toward the axis, in radians.
    pub fn new(tension: f64, stretches: Option<[f64; 2]>, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self {
            tension,
            stretches,
            direction: [sin, cos],
        }
    }

    /// Returns whether reflection in a plane through the axis leaves the direction unchanged.
    pub(super) fn is_mirror_symmetric(&self) -> bool {
        (self.direction[0] * self.direction[1]).abs() < 1e-9
    }

    /// Returns w, w′ and w″ at λ.
    #[inline(always)]
    fn energy_of<S: Real>(&self, stretch: S) -> [S; 3] {
        let T = self.tension;
        let Some([most, least]) = self.stretches else {
            let rise = stretch - stretch.like(1.0);
            return [rise.times(T), stretch.like(T), stretch.like(0.0)];
        };
        let range = most - least;
        // x = (λM − λ)/(λM − λ0) between −1 and 1, where the tension acts: w = T (λM − λ0) (2/3 − x + x³/3) from λ0 on.
        let one = stretch.like(1.0);
        let scaled = |stretch: S| (stretch.like(most) - stretch).times(1.0 / range);
        let clamped = |x: S| {
            let above = (x - one).when_positive(x - one);
            let below = (-one - x).when_positive(-one - x);
            x - above + below
        };
        let integral = |x: S| {
            let cube = x * x * x;
            (one.times(2.0 / 3.0) - x + cube.times(1.0 / 3.0)).times(T * range)
        };
        let x = scaled(stretch);
        let inside = (one - x * x).when_positive(one);
        let x = clamped(x);
        let rest = integral(clamped(scaled(one)));
        [
            integral(x) - rest,
            (one - x * x).times(T),
            inside * x.times(2.0 * T / range),
        ]
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
        let [w, slope, curvature] = self.energy_of(stretch);
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
