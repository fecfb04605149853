//! Where a slide was, as several readings say.

use nalgebra::DMatrix;

/// Displacements that were read one after the other, m, without the noise of each.
pub struct Estimate {
    /// Of each reading.
    pub values: Vec<f64>,
    /// What they are off by, readings × errors: for one standard deviation of each error.
    pub errors: DMatrix<f64>,
}
