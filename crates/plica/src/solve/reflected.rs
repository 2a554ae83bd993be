//! An operator with a prescribed spectrum, to test the iterative methods with.

use super::operator::{Operator, add, dot};

/// An operator made of reflections H and scales s: with B = diag(s) H₀ it has C = Bᵀ B,
/// A = Bᵀ H₁ diag(ν) H₁ B and M = Bᵀ H₂ diag(m) H₂ B. Hence A x = ν C x has the eigenvalues ν, and M is
/// close to A if m is close to |ν|, but has other eigenvectors.
pub struct Reflected {
    pub prescribed: Vec<bool>,
    /// A constrained combination of unknowns, of length one.
    pub pinned: Option<Vec<f64>>,
    spectrum: Vec<f64>,
    scales: Vec<f64>,
    /// Unit normals of the reflections.
    normals: [Vec<f64>; 3],
    /// m.
    near: Vec<f64>,
}

impl Reflected {
    /// Takes the spectrum ν; |ν|/factor ≤ m ≤ factor·|ν|, and m = 1 for ν = 0.
    pub fn new(spectrum: &[f64], factor: f64) -> Self {
        let near = |(i, &value): (usize, &f64)| {
            let size = if value == 0.0 { 1.0 } else { value.abs() };
            size * factor.powf((3.1 * i as f64).sin())
        };
        let near = spectrum.iter().enumerate().map(near).collect();
        Self::with_preconditioner(spectrum, near)
    }

    /// Takes the spectrum ν and m.
    pub fn with_preconditioner(spectrum: &[f64], near: Vec<f64>) -> Self {
        let n = spectrum.len();
        let normal = |k: usize| {
            // The last is close to the one before, so that M is close to A.
            let phase = [0.3, 1.1, 1.1][k];
            let tilt = [0.0, 0.0, 1e-3][k];
            let normal = (0..n).map(|i| (phase * (i * i) as f64).sin() + tilt * (i as f64).cos());
            let normal: Vec<f64> = normal.collect();
            let size = dot(&normal, &normal).sqrt();
            normal.iter().map(|x| x / size).collect()
        };
        Self {
            prescribed: vec![false; n],
            pinned: None,
            spectrum: spectrum.to_vec(),
            scales: (0..n).map(|i| 1.0 + 0.5 * (2.0 * i as f64).sin()).collect(),
            normals: std::array::from_fn(normal),
            near,
        }
    }

    fn reflect(&self, reflection: usize, v: &mut [f64]) {
        let normal = &self.normals[reflection];
        let part = dot(normal, v);
        add(-2.0 * part, normal, v);
    }

    /// Replaces v by H diag(factors) H v.
    fn scale(&self, reflection: usize, factors: impl Fn(usize) -> f64, v: &mut [f64]) {
        self.reflect(reflection, v);
        for (i, x) in v.iter_mut().enumerate() {
            *x *= factors(i);
        }
        self.reflect(reflection, v);
    }
}

impl Operator for Reflected {
    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn project_out_constraints(&self, v: &mut [f64]) {
        if let Some(pinned) = &self.pinned {
            let part = dot(pinned, v);
            add(-part, pinned, v);
        }
    }
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        self.reflect(0, out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x *= s);
        self.scale(1, |i| self.spectrum[i], out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x *= s);
        self.reflect(0, out);
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(r);
        self.reflect(0, out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x /= s);
        self.scale(2, |i| 1.0 / self.near[i], out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x /= s);
        self.reflect(0, out);
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        self.scale(0, |i| self.scales[i] * self.scales[i], out);
    }
}
