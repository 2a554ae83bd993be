//! Harmonic solver: the inverse of a block-circulant matrix, harmonic by harmonic.

use super::{HarmonicColumns, LowHarmonicCorrection, Transform};
use crate::matrix::CoupledFactor;
use rayon::prelude::*;

/// Factorised blocks of all circumferential harmonics of a sector.
#[derive(Clone, Debug)]
pub struct HarmonicSolver {
    transform: Transform,
    factors: Vec<(HarmonicColumns, CoupledFactor)>,
    correction: Option<LowHarmonicCorrection>,
}

impl HarmonicSolver {
    /// Returns the solver for k rings from the factorised blocks of the harmonics of the sector, 0
    /// to k/2, with prescribed unknowns constrained.
    pub fn new(rings: usize, factors: Vec<CoupledFactor>) -> Self {
        let transform = Transform::new(rings);
        Self {
            factors: transform.harmonics().zip(factors).collect(),
            transform,
            correction: None,
        }
    }

    /// Adds a correction on low harmonics (see [`LowHarmonicCorrection`]).
    pub fn with_correction(mut self, correction: LowHarmonicCorrection) -> Self {
        self.correction = Some(correction);
        self
    }

    /// Returns the factors of all harmonics, and the correction.
    pub fn into_factors(
        self,
    ) -> (
        impl Iterator<Item = CoupledFactor>,
        Option<LowHarmonicCorrection>,
    ) {
        (
            self.factors.into_iter().map(|(_, factor)| factor),
            self.correction,
        )
    }

    /// Solves for the unknowns of all rings.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut coefficients = self.transform.forward(b);
        let lines = b.len() / self.transform.rings();
        for pair in self.pairs(&mut coefficients, lines) {
            // A wave is (z cos, r cos, −θ sin); a quarter period on it is (z sin, r sin, θ cos).
            for (c, s) in circumferential(pair) {
                (*c, *s) = (-*s, *c);
            }
        }
        let low = self.correction.as_ref().map(|low| {
            let rings = self.transform.rings() as f64;
            (low, low.restricted(&coefficients, lines), rings)
        });
        let mut work = vec![];
        let mut rest = &mut coefficients[..];
        for (wave, factor) in &self.factors {
            let columns = if wave.sine.is_some() { 2 } else { 1 };
            let (own, others) = rest.split_at_mut(columns * lines);
            work.push((factor, own));
            rest = others;
        }
        let (correction, ()) = rayon::join(
            || low.map(|(low, b, rings)| (low, low.correction(b, rings))),
            || {
                work.into_par_iter().for_each(|(factor, own)| {
                    if own.len() == lines {
                        factor.solve(own);
                    } else {
                        let (cosine, sine) = own.split_at_mut(lines);
                        factor.solve_pair([cosine, sine]);
                    }
                });
            },
        );
        if let Some((low, correction)) = correction {
            low.add(&correction, &mut coefficients, lines);
        }
        for pair in self.pairs(&mut coefficients, lines) {
            for (c, s) in circumferential(pair) {
                (*c, *s) = (*s, -*c);
            }
        }
        self.transform.inverse(&coefficients)
    }

    /// Returns the cosine and sine columns of every harmonic that has both.
    fn pairs<'a>(&self, coefficients: &'a mut [f64], lines: usize) -> Vec<[&'a mut [f64]; 2]> {
        let alone = self.factors.iter().filter(|(wave, _)| wave.sine.is_none());
        let last = usize::from(alone.count() > 1);
        let pairs = self.transform.rings() - 1 - last;
        let columns = coefficients[lines..].chunks_exact_mut(2 * lines);
        columns
            .take(pairs / 2)
            .map(|pair| pair.split_at_mut(lines).into())
            .collect()
    }
}

/// Returns the circumferential unknowns of two columns.
fn circumferential([a, b]: [&mut [f64]; 2]) -> impl Iterator<Item = (&mut f64, &mut f64)> {
    a.iter_mut().zip(b).skip(2).step_by(3)
}
