//! The full step, and how far the residual vector still is from orthogonal on what the parameters
//! can do to it.
//!
//! Where R·D⁻¹ is evidently of full rank, the step is a back-substitution, the plane has all n
//! dimensions and the projection is ‖c‖; the singular values are asked for only where the rank is
//! in doubt. Evident is
//!
//! σ₁/σₙ ≤ ‖R·D⁻¹‖ · ‖(R·D⁻¹)⁻¹‖ < 1/tolerance   (Frobenius norms).

use nalgebra::{DMatrix, DVector};

use super::reduced::Reduced;
use super::tangent::Tangent;
use crate::error::Result;

/// What a linearisation proposes.
pub(super) struct GaussNewton {
    /// Of the free parameters; the shortest in the scale D where several minimise ‖r + J·δ‖.
    pub step: DVector<f64>,
    /// Length of the residual vector's projection on the tangent plane.
    pub projection: f64,
    /// Number of singular values of J·D⁻¹ that count.
    pub rank: usize,
}

impl GaussNewton {
    /// For the `free` parameters, with their scales D.
    pub fn new(reduced: &Reduced, free: &[usize], scale: &DVector<f64>, rank_tolerance: f64) -> Result<Self> {
        let (triangle, c) = reduced.columns(free, scale)?;
        if has_full_rank(&triangle, rank_tolerance)
            && let Some(scaled) = triangle.solve_upper_triangular(&-&c)
        {
            return Ok(GaussNewton {
                step: scaled.component_div(scale),
                projection: c.norm(),
                rank: free.len(),
            });
        }
        let tangent = Tangent::new(reduced, free.to_vec(), scale.clone(), rank_tolerance)?;
        Ok(GaussNewton { step: tangent.full_step(), projection: tangent.projection(), rank: tangent.rank })
    }
}

/// True only where all singular values of an upper triangle are above `tolerance` times the
/// largest.
fn has_full_rank(triangle: &DMatrix<f64>, tolerance: f64) -> bool {
    let n = triangle.nrows();
    let inverse = triangle.solve_upper_triangular(&DMatrix::identity(n, n));
    inverse.is_some_and(|inverse| triangle.norm() * inverse.norm() * tolerance < 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::dmatrix;

    #[test]
    fn both_ways_to_the_step_agree() {
        let reduced = Reduced::new(&dmatrix![
            2.0, 1.0, -1.0, 3.0;
            0.0, 1e-3, 0.5, -2.0;
            0.0, 0.0, 4.0, 1.0;
            0.0, 0.0, 0.0, 7.0]);
        for free in [vec![0, 1, 2], vec![0, 2], vec![1]] {
            let scale = DVector::from_element(free.len(), 2.0);
            let quick = GaussNewton::new(&reduced, &free, &scale, 1e-12).unwrap();
            let tangent = Tangent::new(&reduced, free, scale, 1e-12).unwrap();
            assert!((&quick.step - tangent.full_step()).norm() < 1e-12 * quick.step.norm());
            assert!((quick.projection - tangent.projection()).abs() < 1e-14 * quick.projection);
            assert_eq!(quick.rank, tangent.rank);
        }
    }

    #[test]
    fn a_doubtful_rank_is_not_taken_for_full() {
        assert!(has_full_rank(&dmatrix![1.0, 1.0; 0.0, 1e-11], 1e-12));
        assert!(!has_full_rank(&dmatrix![1.0, 1.0; 0.0, 1e-13], 1e-12));
        assert!(!has_full_rank(&dmatrix![1.0, 0.0; 0.0, 0.0], 1e-12));
        assert!(has_full_rank(&DMatrix::zeros(0, 0), 1e-12));
    }
}
