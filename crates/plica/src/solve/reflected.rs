//! An operator whose spectrum is chosen, to hold the iterations against.

use super::operator::{Operator, add, dot};

/// With reflections H and scales s, B = diag(s) H₀,
/// C = Bᵀ B, A = Bᵀ H₁ diag(ν) H₁ B, M = Bᵀ H₂ diag(m) H₂ B with m within a factor of |ν|, so that
/// A x = ν C x has the eigenvalues ν, and M is near A but has other eigenvectors.
pub struct Reflected {
    pub prescribed: Vec<bool>,
    /// A vector of length one.
    pub pinned: Option<Vec<f64>>,
    spectrum: Vec<f64>,
    scales: Vec<f64>,
    /// Normals of the mirrors.
    mirrors: [Vec<f64>; 3],
    /// m
    near: Vec<f64>,
}

impl Reflected {
    /// With |ν|/factor ≤ m ≤ factor·|ν|, and m = 1 for ν = 0.
    pub fn new(spectrum: &[f64], factor: f64) -> Self {
        let near = |(i, &value): (usize, &f64)| {
            let size = if value == 0.0 { 1.0 } else { value.abs() };
            size * factor.powf((3.1 * i as f64).sin())
        };
        let near = spectrum.iter().enumerate().map(near).collect();
        Self::with_preconditioner(spectrum, near)
    }

    /// With m = 1, M is C.
    pub fn with_preconditioner(spectrum: &[f64], near: Vec<f64>) -> Self {
        let n = spectrum.len();
        let mirror = |k: usize| {
            // The last is nearly that before it, lest M be far from A.
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
            mirrors: std::array::from_fn(mirror),
            near,
        }
    }

    fn reflect(&self, mirror: usize, v: &mut [f64]) {
        let normal = &self.mirrors[mirror];
        let part = dot(normal, v);
        add(-2.0 * part, normal, v);
    }

    /// v ← factors · v, entry by entry, seen in a mirror.
    fn between(&self, mirror: usize, factors: impl Fn(usize) -> f64, v: &mut [f64]) {
        self.reflect(mirror, v);
        for (i, x) in v.iter_mut().enumerate() {
            *x *= factors(i);
        }
        self.reflect(mirror, v);
    }
}

impl Operator for Reflected {
    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn take_out_pins(&self, v: &mut [f64]) {
        if let Some(pinned) = &self.pinned {
            let part = dot(pinned, v);
            add(-part, pinned, v);
        }
    }
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        self.reflect(0, out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x *= s);
        self.between(1, |i| self.spectrum[i], out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x *= s);
        self.reflect(0, out);
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(r);
        self.reflect(0, out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x /= s);
        self.between(2, |i| 1.0 / self.near[i], out);
        out.iter_mut().zip(&self.scales).for_each(|(x, s)| *x /= s);
        self.reflect(0, out);
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        self.between(0, |i| self.scales[i] * self.scales[i], out);
    }
}
