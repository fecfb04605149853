//! How well the parameters are known at the end of a fit, and which of them not at all.
//!
//! With the Jacobian's columns scaled to norm 1, J·D⁻¹ = U·diag(σ)·Vᵀ, the covariance of the
//! estimates is
//!
//! C = s² · D⁻¹·V·diag(σ⁻²)·Vᵀ·D⁻¹   over the singular values that count,
//!
//! s the standard deviation of one residual. The remaining columns of V span the null space:
//! combinations of the parameters that no residual notices. A parameter that takes part in one has
//! no standard error; the others keep theirs. Parameters resting on a bound are constants to the
//! others: theirs are conditional on it.

use nalgebra::{DMatrix, DVector};

use super::tangent::Tangent;
use super::trust_region::Side;

/// Share of a parameter in a null direction above which it counts as not identified.
///
/// A null direction is known to about the rank tolerance over the gap between the singular values;
/// its entries below this are rounding.
const SHARE: f64 = 1e-6;

/// How a parameter came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// Determined by the data (and priors): it has a standard error.
    Estimated,
    /// Rests on its lower bound, the sum of squares still falling beyond it.
    AtLowerBound,
    /// Rests on its upper bound, the sum of squares still falling beyond it.
    AtUpperBound,
    /// Takes part in a combination that no residual notices.
    NotIdentified,
}

/// Covariance of the estimates of n parameters.
#[derive(Debug, Clone)]
pub struct Covariance {
    /// C, n × n. A parameter not identified has the variance ∞ and covariances NaN; one on a bound
    /// has zeros. All NaN where the residual standard deviation is unknown (no degrees of freedom).
    pub matrix: DMatrix<f64>,
    /// How each parameter came out, n.
    pub standing: Vec<Standing>,
    /// Number of combinations of the free parameters that the data determine.
    pub rank: usize,
    /// σ₁ ≥ σ₂ ≥ … of the Jacobian with columns scaled to norm 1, free parameters only.
    pub singular_values: DVector<f64>,
    /// σ₁/σₙ over all free parameters; infinite where one is exactly without influence.
    pub condition_number: f64,
    /// Combinations of the parameters that no residual notices, n × (free − rank), in the
    /// parameters' units. Times D (the norms of the Jacobian's columns, [`Covariance::scale`]) its
    /// columns are orthonormal.
    pub null_space: DMatrix<f64>,
    /// D, n: norms of the columns of the Jacobian (1 for a column of zeros or a parameter on a
    /// bound).
    pub scale: DVector<f64>,
}

impl Covariance {
    /// Standard error of each parameter, n; `None` where it is not [`Standing::Estimated`] or s is
    /// unknown.
    pub fn standard_errors(&self) -> Vec<Option<f64>> {
        (0..self.standing.len())
            .map(|j| {
                let variance = self.matrix[(j, j)];
                (self.standing[j] == Standing::Estimated && !variance.is_nan()).then(|| variance.sqrt())
            })
            .collect()
    }

    /// Correlations Cᵢⱼ/√(Cᵢᵢ·Cⱼⱼ), n × n; NaN for parameters without a standard error, whatever s
    /// is.
    pub fn correlation(&self) -> DMatrix<f64> {
        let sd = self.matrix.diagonal().map(f64::sqrt);
        DMatrix::from_fn(sd.len(), sd.len(), |i, j| self.matrix[(i, j)] / (sd[i] * sd[j]))
    }

    /// Of the tangent plane at the end, with its columns scaled to norm 1.
    pub(super) fn new(tangent: &Tangent, held: &[Option<Side>], residual_sd: Option<f64>) -> Self {
        let n = held.len();
        let (free, svd, rank) = (&tangent.free, &tangent.svd, tangent.rank);
        let mut scale = DVector::from_element(n, 1.0);
        let mut standing: Vec<Standing> = held
            .iter()
            .map(|side| match side {
                Some(Side::Lower) => Standing::AtLowerBound,
                Some(Side::Upper) => Standing::AtUpperBound,
                None => Standing::Estimated,
            })
            .collect();
        let mut null_space = DMatrix::zeros(n, free.len() - rank);
        for (k, &j) in free.iter().enumerate() {
            scale[j] = tangent.scale[k];
            let unnoticed = svd.v.row(k).columns_range(rank..).into_owned();
            if unnoticed.norm() > SHARE {
                standing[j] = Standing::NotIdentified;
            }
            null_space.row_mut(j).copy_from(&(unnoticed / scale[j]));
        }
        let s = residual_sd.unwrap_or(f64::NAN);
        // s·Vᵢₖ/σₖ
        let root = DMatrix::from_fn(rank, free.len(), |k, a| s * svd.v[(a, k)] / svd.singular_values[k]);
        let mut matrix = DMatrix::zeros(n, n);
        for (a, &i) in free.iter().enumerate() {
            for (b, &j) in free.iter().enumerate().take(a + 1) {
                let known = standing[i] == Standing::Estimated && standing[j] == Standing::Estimated;
                let covariance = match known {
                    // Cᵢⱼ = s²·Σₖ (Vᵢₖ/σₖ)·(Vⱼₖ/σₖ) / (Dᵢ·Dⱼ)
                    true => {
                        let (a, b) = (root.column(a), root.column(b));
                        a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>() / (scale[i] * scale[j])
                    }
                    false if i == j => f64::INFINITY,
                    false => f64::NAN,
                };
                (matrix[(i, j)], matrix[(j, i)]) = (covariance, covariance);
            }
        }
        Covariance {
            matrix,
            standing,
            rank,
            singular_values: svd.singular_values.clone(),
            condition_number: svd.condition_number(),
            null_space,
            scale,
        }
    }
}
