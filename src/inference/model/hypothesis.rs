//! What may be wrong, several effects together: a hypothesis and its terms.

use nalgebra::{DMatrix, DVector};

/// One term of a hypothesis: a candidate with values.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Index among the candidates of the forward model.
    pub candidate: usize,
    /// Values of its parameters, SI.
    pub values: Vec<f64>,
}

/// A hypothesis with what the recording says about it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Hypothesis {
    /// The effects, in the order in which they were found.
    pub terms: Vec<Term>,
    /// Ln of its probability, prior included, less a constant.
    pub log_probability: f64,
    /// Noise of a datum under it.
    pub sigma: f64,
    /// Posterior covariance of all its parameters, SI, in the order of `terms`, without regard to
    /// bounds.
    pub covariance: DMatrix<f64>,
    /// Factors of the evidence's background columns.
    pub background: DVector<f64>,
    /// Posterior covariance of these factors.
    pub background_covariance: DMatrix<f64>,
    /// How many parameters, background included, the data determine.
    pub determined: f64,
}

impl Hypothesis {
    /// Ln odds, about, that the factors of the background are not all zero: ½·zᵀ·C⁻¹·z less the
    /// price of the numbers that the data determine.
    pub fn background_worth(&self) -> f64 {
        let Some(root) = self.background_covariance.clone().cholesky() else { return 0.0 };
        0.5 * self.background.dot(&root.solve(&self.background))
            + root.l_dirty().diagonal().map(f64::ln).sum()
    }
}
