//! What the information of a choice shall be good for.

use nalgebra::{DMatrix, Matrix3};

use super::measurements::Measurements;
use crate::linalg::positive_definite_inverse;

/// What makes one choice better than another.
#[derive(Debug, Clone)]
pub enum Criterion {
    /// The largest |M|: the smallest ellipsoid of all unknowns.
    Determinant,
    /// The smallest tr(W·M⁻¹): the mean variance of whatever W stands for.
    Trace(DMatrix<f64>),
    /// The largest λₘ/√λ₁, the least and the greatest eigenvalue of M: O4 = σₘ²/σ₁.
    Smallest,
}

/// What a choice is worth, the more the better: ln |M|, −tr(W·M⁻¹), or λₘ/√λ₁. `None` where M is
/// not positive definite.
pub fn value(
    all: &Measurements,
    chosen: &[usize],
    before: &DMatrix<f64>,
    criterion: &Criterion,
) -> Option<f64> {
    let information = all.information(chosen, before);
    match criterion {
        Criterion::Determinant => positive_definite_inverse(&information).map(|(_, ln)| ln),
        Criterion::Trace(weight) => {
            positive_definite_inverse(&information).map(|(inverse, _)| -inverse.dot(weight))
        }
        Criterion::Smallest => balance(information),
    }
}

/// λₘ/√λ₁ of a symmetric matrix; `None` where it is not positive definite.
pub(super) fn balance(information: DMatrix<f64>) -> Option<f64> {
    let eigenvalues = information.symmetric_eigenvalues();
    let (least, greatest) = (eigenvalues.min(), eigenvalues.max());
    (least > 0.0).then(|| least / greatest.sqrt())
}

/// What one more measurement adds: |M + JᵀJ|/|M| = |1 + J·P·Jᵀ|, or by how much tr(W·P) falls,
/// tr((1 + J·P·Jᵀ)⁻¹·J·PWP·Jᵀ). The determinant stands for [`Criterion::Smallest`].
pub(super) fn gain(spread: &Matrix3<f64>, weighted: Option<&Matrix3<f64>>) -> f64 {
    let grown = Matrix3::identity() + spread;
    match weighted {
        None => grown.determinant(),
        Some(weighted) => grown.try_inverse().map_or(0.0, |inverse| (inverse * weighted).trace()),
    }
}
