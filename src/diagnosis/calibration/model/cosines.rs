//! Smooth curves: the leading eigenfunctions of a Gaussian process over an interval.
//!
//! ```text
//! f(x) = Σ_k a_k·cos(π k (x − low)/L)     a_k ~ N(0, s_k²)
//! s_k² ∝ exp(−½·(ω_k·ℓ)²), s₀² half of it     ω_k = π k/L
//! ```
//!
//! is the process with squared-exponential kernel of length scale ℓ and variance 1 (A. Solin, S.
//! Särkkä, *Statistics and Computing* 30 (2020) 419–446, with cosines for a curve that is free at
//! its ends). The interval reaches beyond the data by ℓ, so that their ends are no turning points.

use std::f64::consts::PI;

/// ω·ℓ beyond which a cosine is left out: the curve would have 4 % of its weight there.
const CUT: f64 = 2.5;

/// The cosines of an interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Cosines {
    low: f64,
    length: f64,
    /// s_k, from k = 0.
    pub sizes: Vec<f64>,
}

impl Cosines {
    /// Over data from `low` to `high`; a `scale` ℓ of less than the whole.
    pub fn new((low, high): (f64, f64), scale: f64) -> Self {
        let length = high - low + 2.0 * scale;
        let weights: Vec<f64> = (0..)
            .map(|k| PI * f64::from(k) / length * scale)
            .take_while(|&x| x <= CUT)
            .map(|x| (-0.5 * x * x).exp())
            .collect();
        // a cosine has the mean square ½; the constant counts half, as an end of the integral
        let total = 0.5 * (weights.iter().sum::<f64>() - 0.5 * weights[0]);
        let share = |k: usize| if k == 0 { 0.5 } else { 1.0 };
        let sizes =
            weights.iter().enumerate().map(|(k, weight)| (share(k) * weight / total).sqrt()).collect();
        Cosines { low: low - scale, length, sizes }
    }

    /// Angular frequency of the `k`th, π k/L.
    pub fn frequency(&self, k: usize) -> f64 {
        PI * k as f64 / self.length
    }

    /// The `k`th at x.
    pub fn value(&self, k: usize, x: f64) -> f64 {
        (self.frequency(k) * (x - self.low)).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_process_has_variance_one_and_the_kernel_of_its_scale() {
        let cosines = Cosines::new((0.0, 1.0), 0.05);
        let covariance = |x: f64, y: f64| -> f64 {
            let sizes = cosines.sizes.iter().enumerate();
            sizes.map(|(k, s)| s * s * cosines.value(k, x) * cosines.value(k, y)).sum()
        };
        assert!((covariance(0.5, 0.5) - 1.0).abs() < 0.03, "{}", covariance(0.5, 0.5));
        let (near, expected) = (covariance(0.5, 0.55), (-0.5f64).exp());
        assert!((near - expected).abs() < 0.05, "{near} instead of {expected}");
        assert!(covariance(0.3, 0.7).abs() < 0.05);
    }
}
