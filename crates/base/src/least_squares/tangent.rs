//! The tangent plane of the model at a point in its principal axes: rank, covariance and damped
//! steps.
//!
//! With the columns of J scaled by D, J·D⁻¹ = Q·R = (Q·U)·diag(σ)·Vᵀ. The plane is spanned by the
//! columns of Q·U with σ > tolerance·σ₁; in its coordinates the residual vector is c = (Q·U)ᵀr.
//! Normal equations are never formed.

use nalgebra::DVector;

use super::reduced::Reduced;
use crate::error::Result;
use crate::linalg::{Svd, thin_svd};

/// How much longer than the radius a step may be, relative to it: not worth another iteration for
/// the damping.
pub(super) const CLOSE_ENOUGH: f64 = 0.1;

/// Linearised residuals r + J·δ in the parameters that are free to move.
#[derive(Debug, Clone)]
pub(super) struct Tangent {
    /// Indices of the free parameters.
    pub free: Vec<usize>,
    /// D of the free parameters.
    pub scale: DVector<f64>,
    /// Of J·D⁻¹, free columns only; `u` is that of the triangle R.
    pub svd: Svd,
    /// Number of singular values that count.
    pub rank: usize,
    /// Coordinates of r along the left singular vectors.
    c: DVector<f64>,
}

impl Tangent {
    /// Of the `free` parameters, with their scales D.
    pub fn new(
        reduced: &Reduced,
        free: Vec<usize>,
        scale: DVector<f64>,
        rank_tolerance: f64,
    ) -> Result<Self> {
        let (triangle, qt_r) = reduced.columns(&free, &scale)?;
        let svd = thin_svd(&triangle)?;
        let rank = svd.rank(rank_tolerance);
        let c = svd.u.tr_mul(&qt_r);
        Ok(Tangent { free, scale, svd, rank, c })
    }

    /// Length of the residual vector's projection on the plane: what the parameters can still take
    /// away.
    pub fn projection(&self) -> f64 {
        self.c.rows(0, self.rank).norm()
    }

    /// The Gauss–Newton step of the free parameters, the shortest (in the scale D) of those that
    /// minimise ‖r + J·δ‖.
    pub fn full_step(&self) -> DVector<f64> {
        self.damped_step(0.0)
    }

    /// The step of the free parameters that minimises ‖r + J·δ‖ within ‖D·δ‖ ≤ `radius`.
    ///
    /// Its damping λ solves ‖D·δ(λ)‖ = radius by Newton's method on 1/‖D·δ‖, which from the left of
    /// the root climbs to it without overshoot (Moré, *Lecture Notes in Mathematics* 630 (1978)
    /// 105–116, §5).
    pub fn step_within(&self, radius: f64) -> DVector<f64> {
        let mut lambda = 0.0;
        for _ in 0..100 {
            let (length, slope) = self.length_and_slope(lambda);
            if length <= (1.0 + CLOSE_ENOUGH) * radius {
                break;
            }
            // λ ← λ + (‖Dδ‖/Δ − 1)·‖Dδ‖ / (−d‖Dδ‖/dλ)
            lambda += (length / radius - 1.0) * length / slope;
        }
        self.damped_step(lambda)
    }

    /// δ(λ) = −D⁻¹·V·diag(σ/(σ² + λ))·c.
    fn damped_step(&self, lambda: f64) -> DVector<f64> {
        let sigma = &self.svd.singular_values;
        let s = DVector::from_fn(self.rank, |k, _| -self.c[k] * sigma[k] / (sigma[k].powi(2) + lambda));
        let scaled = self.svd.v.columns(0, self.rank) * s;
        scaled.component_div(&self.scale)
    }

    /// ‖D·δ(λ)‖ and −d‖D·δ(λ)‖/dλ.
    fn length_and_slope(&self, lambda: f64) -> (f64, f64) {
        let (mut square, mut slope) = (0.0, 0.0);
        for k in 0..self.rank {
            let sigma = self.svd.singular_values[k];
            let damped = sigma.powi(2) + lambda;
            let s = self.c[k] * sigma / damped;
            square += s * s;
            slope += s * s / damped;
        }
        let length = square.sqrt();
        (length, slope / length)
    }
}
