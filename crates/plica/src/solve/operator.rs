//! What the iterations see of a matrix that is never assembled.

/// A symmetric operator A on the free unknowns, with a preconditioner and a metric.
///
/// Vectors hold every unknown; they come in with zeros where a support gives one and without what is
/// pinned, and what is written there does not count.
pub trait Operator {
    /// For every unknown, whether a support gives it.
    fn prescribed(&self) -> &[bool];
    /// Takes out of `v` what else must not move, by orthogonal projection: combinations of unknowns
    /// that supports pin.
    fn take_out_pins(&self, _v: &mut [f64]) {}
    /// `out` = A v.
    fn apply(&self, v: &[f64], out: &mut [f64]);
    /// `out` = M⁻¹ r with a symmetric, positive definite M that is near A.
    fn precondition(&self, r: &[f64], out: &mut [f64]);
    /// `out` = C v with a symmetric, positive definite C.
    fn metric(&self, v: &[f64], out: &mut [f64]);
}

/// Takes out of `v` all that supports max_steps: the unknowns that they give, and what they pin.
pub(super) fn hold<O: Operator>(operator: &O, v: &mut [f64]) {
    for (x, _) in v
        .iter_mut()
        .zip(operator.prescribed())
        .filter(|(_, prescribed)| **prescribed)
    {
        *x = 0.0;
    }
    operator.take_out_pins(v);
}

/// a · b, summed in order, so that it does not depend on threads.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// y += factor · x.
pub(super) fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
