//! Matrices that are never assembled, as the iterative methods see them.

/// A symmetric operator A on the free unknowns, with a preconditioner and a metric.
///
/// Vectors hold all unknowns. They come in with zeros for prescribed unknowns and orthogonal to
/// constrained combinations; what is written there is ignored.
pub trait Operator {
    /// Returns for every unknown whether a support prescribes it.
    fn prescribed(&self) -> &[bool];
    /// Projects `v` orthogonally to the combinations of unknowns that supports constrain.
    fn project_out_constraints(&self, _v: &mut [f64]) {}
    /// Writes A v into `out`.
    fn apply(&self, v: &[f64], out: &mut [f64]);
    /// Writes M⁻¹ r into `out`, with a symmetric, positive definite M close to A.
    fn precondition(&self, r: &[f64], out: &mut [f64]);
    /// Writes C v into `out`, with a symmetric, positive definite C.
    fn metric(&self, v: &[f64], out: &mut [f64]);
}

/// Sets prescribed unknowns to zero, and projects out constrained combinations.
pub(super) fn project<O: Operator>(operator: &O, v: &mut [f64]) {
    for (x, &prescribed) in v.iter_mut().zip(operator.prescribed()) {
        if prescribed {
            *x = 0.0;
        }
    }
    operator.project_out_constraints(v);
}

/// Returns a · b, summed in order, so that it does not depend on the number of threads.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds `factor` · x to `y`.
pub(super) fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
