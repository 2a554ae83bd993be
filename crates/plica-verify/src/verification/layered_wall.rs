//! Independent reference solution: an axisymmetric tube of layers with fibres, uniform along its axis, inflated, stretched
//! and twisted. It is integrated outwards from the inner radius.
//!
//! Nothing of the rest of the library is used here: no spline, no kernel, no law, no solver.
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | R, r | radius of a point at rest and now | any length |
//! | ℓ, τ | axial stretch; twist, an angle per length at rest | –, 1/length |
//! | θ | stress-free over resting length around and along (residual stretch), and through the layer | – |
//! | β | angle of fibres from the circumference toward the axis | radians |
//! | p | pressure on the inner wall | any stress |
//! | k | stiffness of radial springs on the outer wall, per area at rest | stress/length |
//!
//! A point moves from (R, Φ, Z) to (r(R), Φ + τ Z, ℓ Z), so that Fe, its rows and columns outwards, around and along, is
//! diagonal but for the shear rτ/θζ. Of the law
//!
//! w = f(I₁ − 3) − c ln J + K/4 (J² − 1 − 2 ln J) + Σ k₁/(2 k₂) (exp(k₂ ⟨E⟩²) − 1),  E = κ (I₁ − 3) + (1 − 3κ)(I₄ − 1)
//!
//! only the first derivatives are needed. Equilibrium is dσ_r/dr = (σ_θ − σ_r)/r, and dr/dR follows from σ_r by Newton's
//! method. Both r and σ_r are continuous at interfaces.

use super::one_dimension::NoEquilibrium;

/// Steps of the fourth-order Runge–Kutta method through a layer.
const STEPS: usize = 100;
/// Limit of iterations.
const ITERATIONS: usize = 100;

/// The slope f′(x) of an isotropic law of x = I₁ − 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Neo-Hookean: c/2.
    Linear(f64),
    /// Yeoh: c₁ + 2 c₂ x + 3 c₃ x².
    Polynomial([f64; 3]),
    /// Demiray: c/2 exp(b x), with c and b.
    Exponential(f64, f64),
    /// Gent: c/2 / (1 − x/j), with c and j.
    Limited(f64, f64),
    /// None: Fung's law instead, c/2 (exp(Q) − 1) with Q = a_z E_z² + a_θ E_θ² + 2 b E_z E_θ + (a_z + a_θ − 2 b) E_θz², with
    /// c, a_z, a_θ and b.
    Orthotropic([f64; 4]),
}

/// A family of fibres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Family {
    /// k₁ and k₂.
    pub k: [f64; 2],
    /// κ.
    pub dispersion: f64,
    /// β.
    pub angle: f64,
}

/// A layer.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its outer radius at rest.
    pub outer: f64,
    /// Its isotropic law.
    pub shape: Shape,
    /// K.
    pub bulk: f64,
    /// Its fibres.
    pub fibres: Vec<Family>,
    /// θ around at the inner and the outer face, linear in between.
    pub around: [f64; 2],
    /// θ along, likewise.
    pub along: [f64; 2],
    /// T, λM and λ0 of a tension around the tube, T (1 − ((λM − λ)/(λM − λ0))²) where that is positive.
    pub tone: Option<[f64; 3]>,
    /// θ through the layer.
    pub through: f64,
}

/// A tube.
#[derive(Clone, Debug, PartialEq)]
pub struct LayeredWall {
    /// Its inner radius at rest.
    pub inner: f64,
    /// Its layers, from the inside out.
    pub layers: Vec<Layer>,
    /// ℓ.
    pub stretch: f64,
}

/// Equilibrium of a tube without torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflated {
    /// Current inner radius, radii of interfaces, and outer radius.
    pub radii: Vec<f64>,
    /// τ.
    pub twist: f64,
    /// Cauchy stresses σ_r, σ_θ and σ_z at the inner face of each layer.
    pub stresses: Vec<[f64; 3]>,
}

/// Cauchy stresses σ_r, σ_θ, σ_z and σ_θz.
type Stresses = [f64; 4];

impl Shape {
    fn slope(self, x: f64) -> f64 {
        match self {
            Self::Linear(c) => 0.5 * c,
            Self::Polynomial([c1, c2, c3]) => c1 + 2.0 * c2 * x + 3.0 * c3 * x * x,
            Self::Exponential(c, b) => 0.5 * c * (b * x).exp(),
            Self::Limited(c, j) => 0.5 * c / (1.0 - x / j),
            Self::Orthotropic(_) => 0.0,
        }
    }
}

impl Layer {
    /// Creates a neo-Hookean layer without fibres and residual stretch.
    pub fn new(outer: f64, c: f64, bulk: f64) -> Self {
        Self {
            outer,
            shape: Shape::Linear(c),
            bulk,
            fibres: vec![],
            around: [1.0; 2],
            along: [1.0; 2],
            tone: None,
            through: 1.0,
        }
    }

    /// Adds a pair of families at ±β.
    pub fn with_pair(mut self, k: [f64; 2], dispersion: f64, angle: f64) -> Self {
        for angle in [angle, -angle] {
            self.fibres.push(Family {
                k,
                dispersion,
                angle,
            });
        }
        self
    }

    /// Returns the stresses for Fe = [s_r, s_θ, s_z] on the diagonal and a shear.
    fn stresses(&self, [sr, st, sz]: [f64; 3], shear: f64) -> Stresses {
        let J = sr * st * sz;
        let x = sr * sr + st * st + sz * sz + shear * shear - 3.0;
        // The squares of Fe Feᵀ.
        let left = [sr * sr, st * st + shear * shear, sz * sz, shear * sz];
        let isotropic = 0.5 * self.bulk * (J * J - 1.0) - 2.0 * self.shape.slope(0.0);
        let mut tau = left.map(|b| 2.0 * self.shape.slope(x) * b);
        tau.iter_mut().take(3).for_each(|t| *t += isotropic);
        if let Shape::Orthotropic([c, az, at, b]) = self.shape {
            let Ez = 0.5 * (sz * sz + shear * shear - 1.0);
            let (Et, Ezt) = (0.5 * (st * st - 1.0), 0.5 * st * shear);
            let both = az + at - 2.0 * b;
            let Q = az * Ez * Ez + at * Et * Et + 2.0 * b * Ez * Et + both * Ezt * Ezt;
            // The second Piola–Kirchhoff stress.
            let stiffness = c * Q.exp();
            let Sz = stiffness * (az * Ez + b * Et);
            let St = stiffness * (at * Et + b * Ez);
            let Szt = 0.5 * stiffness * both * Ezt;
            tau[1] += st * st * St + 2.0 * st * shear * Szt + shear * shear * Sz;
            tau[2] += sz * sz * Sz;
            tau[3] += sz * (st * Szt + shear * Sz);
        }
        for family in &self.fibres {
            let (sin, cos) = family.angle.sin_cos();
            let [around, along] = [st * cos + shear * sin, sz * sin]; // Fe a
            let kappa = family.dispersion;
            let I4 = around * around + along * along;
            let E = (kappa * x + (1.0 - 3.0 * kappa) * (I4 - 1.0)).max(0.0);
            let slope = family.k[0] * E * (family.k[1] * E * E).exp();
            let fibre = [0.0, around * around, along * along, around * along];
            for i in 0..4 {
                tau[i] += 2.0 * slope * (kappa * left[i] + (1.0 - 3.0 * kappa) * fibre[i]);
            }
        }
        if let Some([tension, most, least]) = self.tone {
            let x = (most - st) / (most - least);
            tau[1] += st * tension * (1.0 - x * x).max(0.0);
        }
        tau.map(|t| t / J)
    }
}

impl LayeredWall {
    /// Returns Fe without its radial stretch at R, and the shear.
    fn stretches(&self, layer: usize, R: f64, r: f64, twist: f64) -> ([f64; 2], f64) {
        let inner = match layer {
            0 => self.inner,
            _ => self.layers[layer - 1].outer,
        };
        let layer = &self.layers[layer];
        let depth = (R - inner) / (layer.outer - inner);
        let [around, along] =
            [layer.around, layer.along].map(|[inner, outer]| inner + depth * (outer - inner));
        ([r / (R * around), self.stretch / along], r * twist / along)
    }

    /// Returns the radial stretch at which σ_r has a value, and the stresses.
    fn radial(
        &self,
        layer: usize,
        (R, r, twist): (f64, f64, f64),
        sigma: f64,
    ) -> Result<(f64, Stresses), NoEquilibrium> {
        let ([around, along], shear) = self.stretches(layer, R, r, twist);
        let stresses = |s: f64| self.layers[layer].stresses([s, around, along], shear);
        let excess = |s: f64| stresses(s)[0] - sigma;
        let guess = 1.0 / (around * along);
        let s = secant(guess, guess * 1.0001, excess)?;
        Ok((s, stresses(s)))
    }

    /// Integrates outwards from an inner radius: returns the radii and the stresses at the faces, σ_r at the outer radius,
    /// and the torque over 2π.
    fn integrate(&self, r: f64, twist: f64, p: f64) -> Result<(Inflated, [f64; 2]), NoEquilibrium> {
        let (mut radii, mut inside) = (vec![r], vec![]);
        let (mut state, mut from) = ([r, -p, 0.0], self.inner);
        for (layer, Layer { outer, .. }) in self.layers.iter().enumerate() {
            let h = (outer - from) / STEPS as f64;
            let slope = |R: f64, [r, sigma, _]: [f64; 3]| {
                let (s, stresses) = self.radial(layer, (R, r, twist), sigma)?;
                let s = s * self.layers[layer].through;
                let [_, around, _, shear] = stresses;
                Ok([s, (around - sigma) / r * s, shear * r * r * s])
            };
            let (_, [radial, around, along, _]) =
                self.radial(layer, (from, state[0], twist), state[1])?;
            inside.push([radial, around, along]);
            let moved = |by: f64, along: [f64; 3], from: [f64; 3]| {
                [0, 1, 2].map(|i| from[i] + by * along[i])
            };
            for n in 0..STEPS {
                let R = from + h * n as f64;
                let a = slope(R, state)?;
                let b = slope(R + 0.5 * h, moved(0.5 * h, a, state))?;
                let c = slope(R + 0.5 * h, moved(0.5 * h, b, state))?;
                let d = slope(R + h, moved(h, c, state))?;
                let mean = [0, 1, 2].map(|i| (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0);
                state = moved(h, mean, state);
            }
            radii.push(state[0]);
            from = *outer;
        }
        let solution = Inflated {
            radii,
            twist,
            stresses: inside,
        };
        Ok((solution, [state[1], state[2]]))
    }

    /// Solves for the state under an internal pressure, without torque; `steps` parts of the pressure are applied one after
    /// the other.
    ///
    /// # Errors
    /// [`NoEquilibrium`] if an iteration does not converge.
    pub fn inflate(&self, p: f64, steps: usize) -> Result<Inflated, NoEquilibrium> {
        self.inflate_on(0.0, p, steps)
    }

    /// The same with springs of stiffness k on the outer wall.
    ///
    /// # Errors
    /// As [`LayeredWall::inflate`].
    pub fn inflate_on(&self, k: f64, p: f64, steps: usize) -> Result<Inflated, NoEquilibrium> {
        let outer = self.layers[self.layers.len() - 1].outer;
        let (mut r, mut twist) = (self.inner / self.stretch.sqrt(), 0.0);
        let of_one_hand = {
            let families = self.layers.iter().flat_map(|layer| &layer.fibres);
            families.map(|family| family.angle).sum::<f64>().abs() > 1e-12
        };
        for step in 0..=steps {
            let p = p * step as f64 / steps as f64;
            let radius = |twist: f64, guess: f64| {
                let outside = |r: f64| {
                    // The springs pull at the area at rest.
                    let end = |(inflated, [sigma, _]): (Inflated, [f64; 2])| {
                        let now = inflated.radii[inflated.radii.len() - 1];
                        sigma + k * (now - outer) * outer / (now * self.stretch)
                    };
                    self.integrate(r, twist, p).map_or(f64::NAN, end)
                };
                secant(guess, guess * 1.0001, outside)
            };
            if of_one_hand {
                let torque = |twist: f64| -> Result<f64, NoEquilibrium> {
                    let r = radius(twist, r)?;
                    Ok(self.integrate(r, twist, p)?.1[1])
                };
                let torque = |twist| torque(twist).unwrap_or(f64::NAN);
                twist = secant(twist, twist + 1e-4 / self.inner, torque)?;
            }
            r = radius(twist, r)?;
        }
        Ok(self.integrate(r, twist, p)?.0)
    }
}

impl LayeredWall {
    /// Returns the radius now of the point at R, of a state under the internal pressure p.
    ///
    /// # Errors
    /// [`NoEquilibrium`] if an iteration does not converge.
    pub fn radius_at(&self, state: &Inflated, p: f64, R: f64) -> Result<f64, NoEquilibrium> {
        // Only the wall inside the point matters, as the integration begins at the inner face.
        let inside = self
            .layers
            .iter()
            .take_while(|layer| layer.outer < R)
            .count();
        let mut within = self.clone();
        within.layers.truncate(inside + 1);
        within.layers[inside].outer = R;
        let (state, _) = within.integrate(state.radii[0], state.twist, p)?;
        Ok(state.radii[inside + 1])
    }

    /// Returns the internal pressure at which the inner radius now has a value, of a tube that does not twist.
    ///
    /// # Errors
    /// [`NoEquilibrium`] if an iteration does not converge.
    pub fn pressure_at(&self, inner_radius: f64) -> Result<f64, NoEquilibrium> {
        let outside = |p: f64| {
            let state = self.integrate(inner_radius, 0.0, p);
            state.map_or(f64::NAN, |(_, end)| end[0])
        };
        secant(0.0, 1e-3, outside)
    }
}

/// Finds a zero by the secant method, to rounding.
fn secant(mut a: f64, mut b: f64, f: impl Fn(f64) -> f64) -> Result<f64, NoEquilibrium> {
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..ITERATIONS {
        if fb == 0.0 || fa == fb {
            return Ok(b);
        }
        let mut step = -fb * (b - a) / (fb - fa);
        if !step.is_finite() {
            return Err(NoEquilibrium);
        }
        // Steps into states without an energy are halved.
        let mut next = f(b + step);
        while next.is_nan() && step.abs() > 1e-12 * b.abs() {
            step *= 0.5;
            next = f(b + step);
        }
        (a, fa, b, fb) = (b, fb, b + step, next);
        if step.abs() <= 1e-15 * (b.abs() + 1e-3) {
            return Ok(b);
        }
    }
    // Rounding may keep the last digit from settling.
    if (b - a).abs() < 1e-12 * (b.abs() + 1e-3) {
        Ok(b)
    } else {
        Err(NoEquilibrium)
    }
}

#[cfg(test)]
mod tests {
    use super::super::one_dimension::{VolumetricEnergy, Wall};
    use super::*;

    /// Media and adventitia of a carotid artery (Holzapfel, Gasser and Ogden 2000), in mm and kPa.
    pub(in crate::verification) fn carotid([inner, middle, outer]: [f64; 3]) -> LayeredWall {
        let degrees = f64::to_radians;
        let media = Layer::new(middle, 3.0, 1000.0);
        let adventitia = Layer::new(outer, 0.3, 1000.0);
        LayeredWall {
            inner,
            layers: vec![
                media.with_pair([2.3632, 0.8393], 0.0, degrees(29.0)),
                adventitia.with_pair([0.5620, 0.7112], 0.0, degrees(62.0)),
            ],
            stretch: 1.7,
        }
    }

    #[test]
    fn a_carotid_artery_has_the_radii_of_another_integration() {
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
        };
        let wall = carotid([0.71, 0.97, 1.10]);
        for (p, inner, outer) in [
            (5.0, 1.06225501, 1.24248370),
            (13.33, 1.18939766, 1.35261592),
        ] {
            let state = wall.inflate(p, 8).unwrap();
            near(state.radii[0], inner);
            near(state.radii[2], outer);
            assert_eq!(state.twist, 0.0);
        }
        // With the residual stress of an opening angle of 160°: the open sector has 200° of a whole circle.
        let mut wall = carotid([1.43, 1.69, 1.82]);
        for layer in &mut wall.layers {
            layer.around = [5.0 / 9.0; 2];
        }
        let state = wall.inflate(13.33, 8).unwrap();
        near(state.radii[0], 1.27455486);
        near(state.radii[2], 1.42755714);
    }

    #[test]
    fn an_active_media_has_the_radius_of_an_incompressible_one() {
        let mut wall = carotid([0.71, 0.97, 1.10]);
        wall.layers[0].tone = Some([50.0, 1.4, 0.8]);
        let radius = |bulk: f64| {
            let mut wall = wall.clone();
            wall.layers.iter_mut().for_each(|layer| layer.bulk = bulk);
            wall.inflate(13.33, 8).unwrap().radii[0]
        };
        // The error of the compressible wall is linear in 1/K.
        let limit = 2.0 * radius(2e5) - radius(1e5);
        assert!((limit / 1.1095284 - 1.0).abs() < 1e-7, "{limit}");
    }

    #[test]
    fn one_layer_agrees_with_the_polynomials_through_the_wall() {
        let [a, b, mu, bulk] = [0.44, 0.5, 0.4, 20.0];
        let polynomial = Wall {
            shear: [mu, 0.0],
            lambda: bulk,
            volumetric: VolumetricEnergy::Quadratic,
            stretch: 1.2,
            pressures: [0.03, 0.0],
            ..Wall::new([a, b], 0.3)
        };
        let polynomial = polynomial.solve(4).unwrap();
        let wall = LayeredWall {
            inner: a,
            layers: vec![Layer::new(b, mu, bulk)],
            stretch: 1.2,
        };
        let state = wall.inflate(0.03, 4).unwrap();
        for (found, expected) in [state.radii[0], state.radii[1]]
            .iter()
            .zip(polynomial.radii())
        {
            assert!((found / expected - 1.0).abs() < 1e-9);
        }
        // The polynomials have their stresses outwards, around and along.
        for (found, expected) in state.stresses[0].iter().zip(polynomial.stress()[0]) {
            assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
        }
    }

    #[test]
    fn fibres_of_one_hand_twist_a_tube_and_pairs_do_not() {
        let mut wall = LayeredWall {
            inner: 0.44,
            layers: vec![Layer::new(0.5, 0.4, 20.0)],
            stretch: 1.1,
        };
        wall.layers[0].fibres.push(Family {
            k: [0.5, 1.0],
            dispersion: 0.0,
            angle: 0.6,
        });
        let twist = wall.inflate(0.03, 4).unwrap().twist;
        assert!(twist.abs() > 0.01, "{twist}");
        wall.layers[0].fibres[0].angle = -0.6;
        let mirrored = wall.inflate(0.03, 4).unwrap().twist;
        assert!((twist + mirrored).abs() < 1e-9 * twist.abs());
    }
}
