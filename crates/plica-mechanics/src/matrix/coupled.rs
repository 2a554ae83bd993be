//! A symmetric block matrix that consists of a band, blocks outside it, and a term of rank one.

use super::{BlockBanded, Factor, FarBlocks, RankOne, RankOneFactor, Singular, SparseFactor};

/// A symmetric block matrix: a band, and blocks outside it and a term of rank one, if there are any.
#[derive(Clone, Debug)]
pub struct CoupledBanded {
    /// The band.
    pub band: BlockBanded,
    /// The blocks outside.
    pub far: FarBlocks,
    /// The term of rank one.
    pub term: Option<RankOne>,
}

/// The factorisation of a [`CoupledBanded`] matrix: that of the band where there are no blocks outside it.
#[derive(Clone, Debug)]
pub enum CoupledFactor {
    /// The band alone.
    Banded(Factor),
    /// With blocks outside the band.
    Sparse(SparseFactor),
    /// With a term of rank one.
    RankOne(Box<RankOneFactor>),
}

impl From<BlockBanded> for CoupledBanded {
    fn from(band: BlockBanded) -> Self {
        let far = FarBlocks::new(band.size(), band.band());
        Self {
            band,
            far,
            term: None,
        }
    }
}

impl From<Factor> for CoupledFactor {
    fn from(factor: Factor) -> Self {
        Self::Banded(factor)
    }
}

impl CoupledBanded {
    /// Returns the number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.band.unknowns()
    }

    /// Adds to an entry on or below the diagonal and, as the matrix is symmetric, to its mirror image.
    pub fn add_at(&mut self, row: usize, column: usize, value: f64) {
        let m = self.band.size();
        let (i, j) = (row / m, column / m);
        if i - j > self.band.band() {
            self.far.add_at(row, column, value);
        } else {
            self.band.add_at(j, i - j, row % m, column % m, value);
        }
    }

    /// Adds `factor` times a matrix with the same band.
    pub fn add_scaled(&mut self, factor: f64, other: &BlockBanded) {
        self.band.add_scaled(factor, other);
    }

    /// Adds `factor` · A x to `y`.
    pub fn multiply_add(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        self.band.multiply_add(factor, x, y);
        self.far.multiply_add(factor, x, y);
        if let Some(term) = &self.term {
            term.multiply_add(factor, x, y);
        }
    }

    /// Replaces rows and columns of prescribed unknowns by those of the unit matrix.
    pub fn constrain(&mut self, prescribed: &[bool]) {
        self.band.constrain(prescribed);
        self.far.constrain(prescribed);
        if let Some(term) = &mut self.term {
            term.constrain(prescribed);
        }
    }

    /// Factors the matrix.
    ///
    /// # Errors
    ///
    /// If a pivot is zero or NaN.
    pub fn factor(mut self) -> Result<CoupledFactor, Singular> {
        if let Some(term) = self.term.take() {
            let factor = RankOneFactor::new(self.factor()?, term)?;
            return Ok(CoupledFactor::RankOne(Box::new(factor)));
        }
        if self.far.is_empty() {
            return self.band.factor().map(CoupledFactor::Banded);
        }
        SparseFactor::of(&self.band, &self.far).map(CoupledFactor::Sparse)
    }
}

impl CoupledFactor {
    /// Returns the number of negative pivots, which is that of the negative eigenvalues.
    pub fn negative_pivots(&self) -> usize {
        match self {
            Self::Banded(factor) => factor.negative_pivots(),
            Self::Sparse(factor) => factor.negative_pivots(),
            Self::RankOne(factor) => factor.negative_pivots(),
        }
    }

    /// Solves A x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        match self {
            Self::Banded(factor) => factor.solve(b),
            Self::Sparse(factor) => factor.solve(b),
            Self::RankOne(factor) => factor.solve(b),
        }
    }

    /// Solves A x = b in place for two right-hand sides at once.
    pub fn solve_pair(&self, b: [&mut [f64]; 2]) {
        match self {
            Self::Banded(factor) => factor.solve_pair(b),
            Self::Sparse(factor) => factor.solve_pair(b),
            Self::RankOne(factor) => factor.solve_pair(b),
        }
    }

    /// Replaces every pivot by its size. The result is positive definite, and unchanged if the factored matrix was.
    pub fn make_positive(&mut self) {
        match self {
            Self::Banded(factor) => factor.make_positive(),
            Self::Sparse(factor) => factor.make_positive(),
            Self::RankOne(factor) => factor.make_positive(),
        }
    }

    /// Returns the memory of a banded factor for another matrix; its entries are meaningless.
    pub fn into_memory(self) -> Option<BlockBanded> {
        match self {
            Self::Banded(factor) => Some(factor.into_memory()),
            Self::Sparse(_) => None,
            Self::RankOne(factor) => factor.into_matrix().into_memory(),
        }
    }
}
