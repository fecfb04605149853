//! Weights and priors turned into plain least squares: rows scaled by √w, and one row per prior.

use nalgebra::{DMatrix, DVector};

use super::{Noise, Options, Prior, Problem};

/// The residual vector whose square is S(p): √wᵢ·rᵢ, then σ·(pⱼ − mⱼ)/sⱼ.
pub(super) struct Stacked<'a> {
    problem: &'a dyn Problem,
    root_weights: DVector<f64>,
    priors: &'a [Prior],
    /// σ, which brings a prior to the unit of the residuals.
    sigma: f64,
}

impl<'a> Stacked<'a> {
    pub fn new(problem: &'a dyn Problem, weights: DVector<f64>, options: &'a Options) -> Self {
        let sigma = match options.noise {
            Noise::Known(sigma) => sigma,
            Noise::Estimated => 1.0,
        };
        Stacked { problem, root_weights: weights.map(f64::sqrt), priors: &options.priors, sigma }
    }

    /// wᵢ, m.
    pub fn weights(&self) -> DVector<f64> {
        self.root_weights.map(|w| w * w)
    }

    /// m residuals, then the priors.
    pub fn residuals(&self, p: &DVector<f64>) -> DVector<f64> {
        let m = self.root_weights.len();
        let r = self.problem.residuals(p);
        DVector::from_fn(m + self.priors.len(), |i, _| match i.checked_sub(m) {
            None => self.root_weights[i] * r[i],
            Some(k) => {
                let prior = &self.priors[k];
                self.sigma * (p[prior.parameter] - prior.value) / prior.sd
            }
        })
    }

    /// Their derivatives.
    pub fn jacobian(&self, p: &DVector<f64>) -> DMatrix<f64> {
        let m = self.root_weights.len();
        let j = self.problem.jacobian(p);
        DMatrix::from_fn(m + self.priors.len(), p.len(), |row, column| match row.checked_sub(m) {
            None => self.root_weights[row] * j[(row, column)],
            Some(k) if self.priors[k].parameter == column => self.sigma / self.priors[k].sd,
            Some(_) => 0.0,
        })
    }

    /// Length of the rounding error of the residual vector, as the problem states it.
    pub fn rounding(&self) -> f64 {
        self.problem.residual_rounding() * (self.root_weights.len() as f64).sqrt()
    }
}
