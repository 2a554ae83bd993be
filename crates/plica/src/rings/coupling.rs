//! Low harmonics as a state that is not axisymmetric couples them: what the average around the tube
//! does not see.
//!
//! With B the average, A = Eᵀ K E the tangent on low harmonics (see
//! [`crate::assembly::LowHarmonics`]) and B_E = Eᵀ B E,
//!
//! B⁻¹ + E (A⁻¹ − B_E⁻¹) Eᵀ
//!
//! replaces, on what E spans, the average by the tangent; what is B-orthogonal to it stays with the
//! average. It is positive definite if A and B are, since B⁻¹ − E B_E⁻¹ Eᵀ is never negative; and it
//! is B⁻¹ where A = B_E.

use crate::matrix::Factor;

/// The factored matrices of low harmonics.
#[derive(Clone, Debug)]
pub struct Coupling {
    /// H.
    pub highest: usize,
    /// The functions through the wall: control values, point by point.
    pub through: Vec<[f64; 3]>,
    /// A, rows numbered (function through the wall, mode, component), modes 1, cos φ, sin φ, ….
    pub coupled: Factor,
    /// B_E of each harmonic 0 to H, on one wave; rows numbered (function, component).
    pub averaged: Vec<Factor>,
}

/// Functions through the wall times components.
const PART: usize = 9;

impl Coupling {
    fn modes(&self) -> usize {
        2 * self.highest + 1
    }

    /// Eᵀ of the coefficients of waves, column by column of `lines`: mode by mode, numbered
    /// (row along the tube, function, component).
    pub(super) fn restricted(&self, coefficients: &[f64], lines: usize) -> Vec<f64> {
        let points = 3 * self.through.len();
        let mut low = Vec::with_capacity(self.modes() * lines / points * PART);
        for column in coefficients.chunks_exact(lines).take(self.modes()) {
            for row in column.chunks_exact(points) {
                let mut sum = [0.0; PART];
                for (point, through) in row.chunks_exact(3).zip(&self.through) {
                    for (c, t) in through.iter().enumerate() {
                        for (i, x) in point.iter().enumerate() {
                            sum[3 * c + i] += t * x;
                        }
                    }
                }
                low.extend(sum);
            }
        }
        low
    }

    /// (A⁻¹ − B_E⁻¹) of what [`Coupling::restricted`] gives, as coefficients of waves before they are
    /// scaled, of `rings` rings.
    pub(super) fn correction(&self, mut low: Vec<f64>, rings: f64) -> Vec<f64> {
        let modes = self.modes();
        let mode_len = low.len() / modes;
        let rows = mode_len / PART;
        let place = |mode: usize, row: usize, c: usize, i: usize| {
            (
                mode * mode_len + row * PART + 3 * c + i,
                ((row * 3 + c) * modes + mode) * 3 + i,
            )
        };
        let each = |f: &mut dyn FnMut(usize, usize, usize)| {
            for mode in 0..modes {
                for row in 0..rows {
                    for c in 0..3 {
                        for i in 0..3 {
                            let (from, to) = place(mode, row, c, i);
                            f(mode, from, to);
                        }
                    }
                }
            }
        };
        let mut coupled = vec![0.0; low.len()];
        each(&mut |_, from, to| coupled[to] = low[from]);
        self.coupled.solve(&mut coupled);
        for (mode, part) in low.chunks_exact_mut(mode_len).enumerate() {
            self.averaged[mode.div_ceil(2)].solve(part);
        }
        each(&mut |mode, from, to| {
            // The sum of the squares of a wave, by which its coefficients are divided afterwards.
            let squares = if mode == 0 { rings } else { 0.5 * rings };
            low[from] = squares * coupled[to] - low[from];
        });
        low
    }

    /// Adds E of a correction to the coefficients of waves.
    pub(super) fn add(&self, correction: &[f64], coefficients: &mut [f64], lines: usize) {
        let points = 3 * self.through.len();
        let columns = coefficients.chunks_exact_mut(lines);
        let parts = correction.chunks_exact(correction.len() / self.modes());
        for (column, part) in columns.zip(parts) {
            for (row, part) in column.chunks_exact_mut(points).zip(part.chunks_exact(PART)) {
                for (point, through) in row.chunks_exact_mut(3).zip(&self.through) {
                    for (c, t) in through.iter().enumerate() {
                        for (i, x) in point.iter_mut().enumerate() {
                            *x += t * part[3 * c + i];
                        }
                    }
                }
            }
        }
    }
}
