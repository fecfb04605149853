//! Where a slide was, as several readings say.

use nalgebra::DMatrix;

/// Errors that a hypothesis holds besides its own numbers, at most, and numbers of all their
/// columns.
const MOST: usize = 160;
const NUMBERS: usize = 2_000_000;

/// How many errors these readings may have at most: each is a column of every hypothesis.
pub fn most_errors(readings: usize) -> usize {
    MOST.min(NUMBERS / readings.max(1))
}

/// Displacements that were read one after the other, m, without the noise of each.
pub struct Estimate {
    /// Of each reading.
    pub values: Vec<f64>,
    /// What they are off by, readings × errors: for one standard deviation of each error.
    pub errors: DMatrix<f64>,
}
