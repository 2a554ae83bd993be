//! Coarse-space correction of the harmonic solver on low harmonics, for states that are not
//! axisymmetric.
//!
//! With B the average around the tube, A = Eᵀ K E the tangent on low harmonics (see
//! [`crate::assembly::LowHarmonics`]) and B_E = Eᵀ B E,
//!
//! B⁻¹ + E (A⁻¹ − B_E⁻¹) Eᵀ
//!
//! replaces the average by the tangent on the span of E; the B-orthogonal complement keeps the
//! average. It is positive definite if A and B are, since B⁻¹ − E B_E⁻¹ Eᵀ is positive
//! semidefinite, and it equals B⁻¹ if A = B_E.

use crate::matrix::CoupledFactor;

/// Factorised matrices of the low harmonics.
#[derive(Clone, Debug)]
pub struct LowHarmonicCorrection {
    /// H.
    pub highest: usize,
    /// Control values of the functions through the wall, point by point.
    pub through: Vec<[f64; 3]>,
    /// A, with rows numbered (function through the wall, mode, component), modes 1, cos φ, sin φ,
    /// ….
    pub coupled: CoupledFactor,
    /// For every row of A, whether its function is prescribed; E has the others.
    pub prescribed: Vec<bool>,
    /// B_E of each harmonic 0 to H, for one wave; rows numbered (function, component).
    pub averaged: Vec<CoupledFactor>,
}

/// Functions through the wall times components.
const PART: usize = 9;

impl LowHarmonicCorrection {
    fn modes(&self) -> usize {
        2 * self.highest + 1
    }

    /// Returns Eᵀ times the coefficients of waves (columns of `lines`): mode by mode, numbered (row
    /// along the tube, function, component).
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

    /// Returns (A⁻¹ − B_E⁻¹) times the result of [`LowHarmonicCorrection::restricted`] for `rings`
    /// rings, as coefficients of waves before scaling.
    pub(super) fn correction(&self, mut low: Vec<f64>, rings: f64) -> Vec<f64> {
        let modes = self.modes();
        let mode_len = low.len() / modes;
        let rows = mode_len / PART;
        let index = |mode: usize, row: usize, c: usize, i: usize| {
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
                            let (from, to) = index(mode, row, c, i);
                            f(mode, from, to);
                        }
                    }
                }
            }
        };
        // A prescribed row of A and B_E is that of the identity, and has no part in the correction.
        each(&mut |_, from, to| {
            if self.prescribed[to] {
                low[from] = 0.0;
            }
        });
        let mut coupled = vec![0.0; low.len()];
        each(&mut |_, from, to| coupled[to] = low[from]);
        self.coupled.solve(&mut coupled);
        for (mode, part) in low.chunks_exact_mut(mode_len).enumerate() {
            self.averaged[mode.div_ceil(2)].solve(part);
        }
        each(&mut |mode, from, to| {
            // Sum of the squares of a wave, by which the inverse transform divides.
            let squares = if mode == 0 { rings } else { 0.5 * rings };
            low[from] = squares * coupled[to] - low[from];
        });
        low
    }

    /// Adds E times a correction to the coefficients of waves.
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
