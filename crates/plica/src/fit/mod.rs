//! Fits the parameters of a law to tension tests.
//!
//! The material is taken as incompressible, as in most publications: its volume is constant, and a pressure takes the place of
//! the volumetric energy. Squares of differences of stress, all with the same weight, are minimised by the method of Levenberg
//! and Marquardt from several starts.
#![allow(non_snake_case)] // the formulas keep the letters of their sources

mod fitted_law;
mod least_squares;
mod measurement;

pub use fitted_law::{FittedLaw, ParameterUnit};
pub use least_squares::{Fit, Parameter, fit};
pub use measurement::{Measurement, Measurements, StressKind};

/// Errors of a fit.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The table cannot be read.
    #[error("{0}")]
    Table(#[from] csv::Error),
    /// A header that is not that of a table of tests.
    #[error(
        "column `{name}`: the columns are stretch_along, stretch_around, and nominal_stress_along, \
         nominal_stress_around, cauchy_stress_along and cauchy_stress_around, each with the unit _Pa, _kPa, _MPa or none"
    )]
    Column {
        /// The name.
        name: String,
    },
    /// A table without a column that it needs.
    #[error("the table has no column of a {what}")]
    Missing {
        /// The missing quantity.
        what: &'static str,
    },
    /// Stresses in several units.
    #[error("the stresses are in several units: use one")]
    Units,
    /// A cell that is not a number that can be used.
    #[error("line {line}, {column}: `{cell}` {rule}")]
    Cell {
        /// Line in the file.
        line: u64,
        /// Name of the column.
        column: String,
        /// Its content.
        cell: String,
        /// The rule that it breaks.
        rule: &'static str,
    },
    /// A row without a stretch, or without a stress that belongs to one.
    #[error("line {line}: a row needs a stretch and a stress in the same direction")]
    Row {
        /// Line in the file.
        line: u64,
    },
    /// Fewer stresses than are needed.
    #[error("{stresses} stresses cannot determine {parameters} parameters: at least {} are needed", parameters + 1)]
    TooFew {
        /// Stresses in the table.
        stresses: usize,
        /// Parameters of the law.
        parameters: usize,
    },
    /// No start led to a minimum.
    #[error("no parameters were found with which the law describes the tests")]
    NoMinimum,
}

#[cfg(test)]
mod tests;
