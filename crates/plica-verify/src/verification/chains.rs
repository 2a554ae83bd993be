//! Chains of elements with known branches: structures of text books, solved by the continuation that tubes use.

use plica::matrix::BlockBanded;
use plica::solve::{Direct, Equilibrium, ResidualEvaluation};
use std::sync::Arc;

/// Value, gradient and second derivatives of the energy of an element.
pub type Jet = (f64, [f64; 2], [[f64; 2]; 2]);

/// A chain of equal elements between neighbouring unknowns.
pub struct Chain {
    element: Box<dyn Fn(f64, [f64; 2]) -> Jet>,
    prescribed: Vec<bool>,
    damping: Arc<BlockBanded>,
}

/// The energy of a chain is defined everywhere.
#[derive(Clone, Debug, thiserror::Error)]
#[error("undefined")]
pub struct Never;

impl Chain {
    /// Makes a chain of elements with an energy(λ, u); some of its unknowns are zero.
    pub fn new(
        elements: usize,
        zero: &[usize],
        element: impl Fn(f64, [f64; 2]) -> Jet + 'static,
    ) -> Self {
        let unknowns = elements + 1;
        let mut damping = BlockBanded::zeros(unknowns, 1, 1);
        for i in 0..unknowns {
            damping.add_at(i, 0, 0, 0, 1.0);
        }
        Self {
            element: Box::new(element),
            prescribed: (0..unknowns).map(|i| zero.contains(&i)).collect(),
            damping: Arc::new(damping),
        }
    }
}

impl Equilibrium for Chain {
    type Load = f64;
    type EvaluationError = Never;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn apply_prescribed(&self, _: &f64, u: &mut [f64]) {
        for (u, prescribed) in u.iter_mut().zip(&self.prescribed) {
            if *prescribed {
                *u = 0.0;
            }
        }
    }
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, Never> {
        let mut energy = 0.0;
        let mut residual = vec![0.0; u.len()];
        for i in 0..u.len() - 1 {
            let (w, [a, b], _) = (self.element)(*load, [u[i], u[i + 1]]);
            energy += w;
            residual[i] += a;
            residual[i + 1] += b;
        }
        Ok(ResidualEvaluation {
            energy,
            residual,
            residual_scale: 1.0,
            rounding: 1e-15,
        })
    }
    fn tangent(&self, load: &f64, u: &[f64]) -> Direct {
        let mut K = BlockBanded::zeros(u.len(), 1, 1);
        for i in 0..u.len() - 1 {
            let (.., H) = (self.element)(*load, [u[i], u[i + 1]]);
            K.add_at(i, 0, 0, 0, H[0][0]);
            K.add_at(i, 1, 0, 0, H[1][0]);
            K.add_at(i + 1, 0, 0, 0, H[1][1]);
        }
        Direct::new(K, self.damping.clone(), self.prescribed.as_slice().into())
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }
}

/// Returns a truss of two bars (EA = 1, half-span 1, angle `first` at rest) under a force at its apex. The first unknown is
/// the angle of the bars; the second follows it.
pub fn truss(first: f64) -> Chain {
    Chain::new(1, &[], move |force, [a, b]| {
        let c0 = first.cos();
        let (sin, cos) = a.sin_cos();
        // The strain of a bar and its derivatives in the angle.
        let n = c0 / cos - 1.0;
        let n1 = c0 * sin / (cos * cos);
        let n2 = c0 * (1.0 + sin * sin) / cos.powi(3);
        let energy = n * n / c0 + force * a.tan();
        let slope = 2.0 * n * n1 / c0 + force / (cos * cos);
        let stiffness = 2.0 * (n1 * n1 + n * n2) / c0 + 2.0 * force * sin / cos.powi(3);
        let s = b - a;
        (
            energy + 0.5 * s * s,
            [slope - s, s],
            [[stiffness + 1.0, -1.0], [-1.0, 1.0]],
        )
    })
}

/// Returns Bratu's problem u″ + λ eᵘ = 0, u(0) = u(1) = 0, by linear elements with the trapezoidal rule.
pub fn bratu(elements: usize) -> Chain {
    let h = 1.0 / elements as f64;
    Chain::new(elements, &[0, elements], move |lambda, [a, b]| {
        let k = 1.0 / h;
        let [ea, eb] = [a, b].map(|u| 0.5 * h * lambda * u.exp());
        let s = b - a;
        (
            0.5 * k * s * s - ea - eb,
            [-k * s - ea, k * s - eb],
            [[k - ea, -k], [-k, k - eb]],
        )
    })
}

/// Returns a column of unit length and bending stiffness, clamped at its foot, under a force on its head; the unknowns are
/// angles.
pub fn column(elements: usize) -> Chain {
    let h = 1.0 / elements as f64;
    Chain::new(elements, &[0], move |force, [a, b]| {
        let (k, p, s) = (1.0 / h, 0.5 * h * force, b - a);
        (
            0.5 * k * s * s + p * (a.cos() + b.cos()),
            [-k * s - p * a.sin(), k * s - p * b.sin()],
            [[k - p * a.cos(), -k], [-k, k - p * b.cos()]],
        )
    })
}
