//! The tangent plane of the model at a point: all that linearisation can say, from one QR and one SVD.
//!
//! With the columns of J scaled by D, J·D⁻¹ = Q·R = (Q·U)·diag(σ)·Vᵀ. The plane is spanned by the columns of Q·U
//! with σ > tolerance·σ₁; in its coordinates the residual vector is c = (Q·U)ᵀr. Normal equations are never formed.

use nalgebra::{DMatrix, DVector};

use crate::error::Result;
use crate::linalg::{Svd, thin_svd, triangular};

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
    parameter_count: usize,
}

impl Tangent {
    /// Of the residuals `r` and their Jacobian `j` (full width), with the scales D (full length).
    pub fn new(
        j: &DMatrix<f64>,
        r: &DVector<f64>,
        free: Vec<usize>,
        scale: &DVector<f64>,
        rank_tolerance: f64,
    ) -> Result<Self> {
        let scale = DVector::from_fn(free.len(), |k, _| scale[free[k]]);
        let scaled = DMatrix::from_fn(j.nrows(), free.len(), |i, k| j[(i, free[k])] / scale[k]);
        let (triangle, qt_r) = triangular(&scaled, r)?;
        let svd = thin_svd(&triangle)?;
        let rank = svd.rank(rank_tolerance);
        let c = svd.u.tr_mul(&qt_r);
        Ok(Tangent { free, scale, svd, rank, c, parameter_count: j.ncols() })
    }

    /// The tangent of a point nothing is known about: rank 0.
    pub fn unknown(parameter_count: usize) -> Self {
        Tangent {
            free: (0..parameter_count).collect(),
            scale: DVector::from_element(parameter_count, 1.0),
            svd: Svd {
                u: DMatrix::identity(parameter_count, parameter_count),
                singular_values: DVector::zeros(parameter_count),
                v: DMatrix::identity(parameter_count, parameter_count),
            },
            rank: 0,
            c: DVector::zeros(parameter_count),
            parameter_count,
        }
    }

    /// Length of the residual vector's projection on the plane: what the parameters can still take away.
    pub fn projection(&self) -> f64 {
        self.c.rows(0, self.rank).norm()
    }

    /// The Gauss–Newton step, the shortest (in the scale D) of those that minimise ‖r + J·δ‖.
    pub fn full_step(&self) -> DVector<f64> {
        self.damped_step(0.0)
    }

    /// The step that minimises ‖r + J·δ‖ within ‖D·δ‖ ≤ `radius`.
    ///
    /// Its damping λ solves ‖D·δ(λ)‖ = radius by Newton's method on 1/‖D·δ‖, which from the left of the root
    /// climbs to it without overshoot (Moré, *Lecture Notes in Mathematics* 630 (1978) 105–116, §5).
    pub fn step_within(&self, radius: f64) -> DVector<f64> {
        const CLOSE_ENOUGH: f64 = 0.1;
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

    /// ‖D·δ‖ of a full-length step.
    pub fn scaled_length(&self, step: &DVector<f64>) -> f64 {
        self.free.iter().zip(self.scale.iter()).map(|(&j, d)| (d * step[j]).powi(2)).sum::<f64>().sqrt()
    }

    /// ‖r‖² − ‖r + J·δ‖² of a full-length step, without the cancellation of the difference.
    pub fn predicted_reduction(&self, step: &DVector<f64>) -> f64 {
        let scaled = DVector::from_fn(self.free.len(), |k, _| self.scale[k] * step[self.free[k]]);
        let s = self.svd.v.tr_mul(&scaled).component_mul(&self.svd.singular_values);
        // −2·(J·δ)ᵀr − ‖J·δ‖²
        -s.dot(&(&s + 2.0 * &self.c))
    }

    /// δ(λ) = −D⁻¹·V·diag(σ/(σ² + λ))·c.
    fn damped_step(&self, lambda: f64) -> DVector<f64> {
        let sigma = &self.svd.singular_values;
        let s = DVector::from_fn(self.rank, |k, _| -self.c[k] * sigma[k] / (sigma[k].powi(2) + lambda));
        let scaled = self.svd.v.columns(0, self.rank) * s;
        let mut step = DVector::zeros(self.parameter_count);
        for (k, &j) in self.free.iter().enumerate() {
            step[j] = scaled[k] / self.scale[k];
        }
        step
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
