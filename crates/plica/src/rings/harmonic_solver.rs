//! The inverse of a matrix that is the same at every ring, harmonic by harmonic.

use super::{Transform, Wave};
use crate::matrix::{BlockBanded, Factor, Singular};
use rayon::prelude::*;

/// The factored blocks of all circumferential harmonics of a sector.
#[derive(Clone, Debug)]
pub struct HarmonicSolver {
    transform: Transform,
    factors: Vec<(Wave, Factor)>,
}

impl HarmonicSolver {
    /// For k rings. `block` gives the block of a harmonic of the sector (0 to k/2), with its given
    /// unknowns constrained; it is called once for each, by several threads.
    pub fn new(
        rings: usize,
        block: impl Fn(usize) -> BlockBanded + Sync,
    ) -> Result<Self, Singular> {
        let transform = Transform::new(rings);
        let waves: Vec<Wave> = transform.harmonics().collect();
        let factors = waves
            .into_par_iter()
            .map(|wave| block(wave.harmonic).factor().map(|factor| (wave, factor)))
            .collect::<Result<_, _>>()?;
        Ok(Self { transform, factors })
    }

    /// Negative eigenvalues, harmonic by harmonic of the sector; a harmonic that comes as cosine
    /// and sine has each twice and is counted once.
    pub fn negative_pivots(&self) -> Vec<usize> {
        self.factors
            .iter()
            .map(|(_, factor)| factor.negative_pivots())
            .collect()
    }

    /// The same with the signs of all pivots made positive, so that it can stand for the inverse of
    /// a positive definite matrix.
    pub fn made_positive(mut self) -> Self {
        for (_, factor) in &mut self.factors {
            factor.make_positive();
        }
        self
    }

    /// Solves for the unknowns of all rings.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut coefficients = self.transform.forward(b);
        let lines = b.len() / self.transform.rings();
        let mut rest = &mut coefficients[..];
        let mut work = vec![];
        for (wave, factor) in &self.factors {
            let columns = if wave.sine.is_some() { 2 } else { 1 };
            let (own, others) = rest.split_at_mut(columns * lines);
            work.push((factor, own));
            rest = others;
        }
        work.into_par_iter().for_each(|(factor, own)| {
            if own.len() == lines {
                factor.solve(own);
            } else {
                let (cosine, sine) = own.split_at_mut(lines);
                // A wave is (z cos, r cos, −θ sin), and a quarter on (z sin, r sin, θ cos).
                for (c, s) in circumferential(cosine, sine) {
                    (*c, *s) = (-*s, *c);
                }
                factor.solve_pair([cosine, sine]);
                for (c, s) in circumferential(cosine, sine) {
                    (*c, *s) = (*s, -*c);
                }
            }
        });
        self.transform.back(&coefficients)
    }
}

/// The circumferential unknowns of two columns.
fn circumferential<'a>(
    a: &'a mut [f64],
    b: &'a mut [f64],
) -> impl Iterator<Item = (&'a mut f64, &'a mut f64)> {
    a.iter_mut().zip(b).skip(2).step_by(3)
}
