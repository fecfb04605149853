//! Compliances as numbers in µm.

use nalgebra::Matrix3;

use crate::units::{UM, significant};

/// Digits of a compliance in a table.
pub(super) const DIGITS: usize = 5;

/// A matrix as JSON rows in the unit.
pub fn rows(matrix: &Matrix3<f64>, unit: f64) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().map(|x| x / unit).collect()).collect()
}

/// A compliance in µm; what symmetry makes zero is shown as 0.
pub fn number(value: f64) -> String {
    significant(in_um(value), DIGITS)
}

/// In µm, without the rounding (1e-14) of what is zero by symmetry.
pub(in crate::report) fn in_um(value: f64) -> f64 {
    if value.abs() < 1e-9 * UM { 0.0 } else { value / UM }
}
