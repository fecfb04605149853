//! Weights that keep outliers from ruling a fit.
//!
//! An M-estimate minimises Σρ(rᵢ/τ) instead of Σrᵢ²; it is the least-squares fit with the weights
//! w(u) = ρ′(u)/u, u = r/τ, evaluated at its own residuals. With ψ(r) = w·r, its covariance is
//! that of least squares with s² replaced by (Huber, *Robust Statistics*, 1981, Eq. 6.5 of §7.6)
//!
//! s² = K² · [Σψ(rᵢ)²/(m − n)] / ψ̄′²,   K = 1 + (n/m)·var(ψ′)/ψ̄′²
//!
//! and J without weights. It holds for errors of one and the same distribution, outliers included.

use nalgebra::DVector;

use crate::statistics::{MAD_TO_SD, median};

/// Which weights.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Robust {
    /// Least squares: all weights 1.
    #[default]
    None,
    /// w(u) = min(1, k/|u|): influence grows no further beyond k. k = 1.345 loses 5 % on normal
    /// data.
    Huber {
        /// Where the influence stops growing, in units of the scale.
        k: f64,
        /// What residuals are compared to.
        scale: RobustScale,
    },
    /// w(u) = (1 − (u/c)²)² for |u| < c, else 0: gross outliers lose all influence. c = 4.685 loses
    /// 5 % on normal data. The sum to be minimised has more than one minimum; Huber's fit (k =
    /// 1.345) is the start.
    Tukey {
        /// Where the influence ends, in units of the scale.
        c: f64,
        /// What residuals are compared to.
        scale: RobustScale,
    },
}

/// The scale τ residuals are compared to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RobustScale {
    /// 1.4826 · median |rᵢ|, from the residuals themselves.
    Mad,
    /// Given, > 0, in the unit of the residuals.
    Given(f64),
}

/// Huber's k with 95 % efficiency on normal data, where Tukey's fit starts.
const HUBER_K: f64 = 1.345;

impl Robust {
    /// The fits to go through, in turn.
    pub(super) fn stages(self) -> Vec<Robust> {
        match self {
            Robust::None => vec![],
            Robust::Huber { .. } => vec![self],
            Robust::Tukey { scale, .. } => vec![Robust::Huber { k: HUBER_K, scale }, self],
        }
    }

    /// τ; `None` where there is none (no residuals).
    pub(super) fn scale_of(self, residuals: &DVector<f64>) -> Option<f64> {
        match self {
            Robust::None => None,
            Robust::Huber { scale: RobustScale::Given(scale), .. }
            | Robust::Tukey { scale: RobustScale::Given(scale), .. } => Some(scale),
            _ => median(residuals.abs().as_slice()).map(|m| MAD_TO_SD * m),
        }
    }

    /// w(r/τ) of every residual.
    pub(super) fn weights(self, residuals: &DVector<f64>, scale: f64) -> DVector<f64> {
        residuals.map(|r| self.weight(r / scale))
    }

    /// s of the module's formula, for `n` parameters; `None` for plain least squares or without a
    /// scale.
    pub(super) fn residual_sd(self, residuals: &DVector<f64>, scale: f64, n: usize) -> Option<f64> {
        let m = residuals.len() as f64;
        let u = residuals.map(|r| r / scale);
        let psi_squares: f64 = u.iter().map(|&u| (self.weight(u) * u).powi(2)).sum();
        let slopes = u.map(|u| self.slope(u));
        let mean = slopes.mean();
        let k = 1.0 + n as f64 / m * slopes.variance() / mean.powi(2);
        (m > n as f64 && mean > 0.0).then(|| scale * k * (psi_squares / (m - n as f64)).sqrt() / mean)
    }

    fn weight(self, u: f64) -> f64 {
        match self {
            Robust::None => 1.0,
            Robust::Huber { k, .. } => (k / u.abs()).min(1.0),
            Robust::Tukey { c, .. } => (1.0 - (u / c).powi(2)).max(0.0).powi(2),
        }
    }

    /// ψ′(u).
    fn slope(self, u: f64) -> f64 {
        match self {
            Robust::None => 1.0,
            Robust::Huber { k, .. } => f64::from(u8::from(u.abs() <= k)),
            Robust::Tukey { c, .. } => {
                let v = (u / c).powi(2);
                if v < 1.0 { (1.0 - v) * (1.0 - 5.0 * v) } else { 0.0 }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TUKEY: Robust = Robust::Tukey { c: 4.685, scale: RobustScale::Mad };
    const HUBER: Robust = Robust::Huber { k: 1.345, scale: RobustScale::Mad };

    #[test]
    fn weights_fall_from_one_to_their_limit() {
        assert_eq!(HUBER.weight(0.0), 1.0);
        assert_eq!(HUBER.weight(-2.69), 0.5);
        assert_eq!(TUKEY.weight(0.0), 1.0);
        assert_eq!(TUKEY.weight(4.685 / 2.0), 0.5625);
        assert_eq!(TUKEY.weight(5.0), 0.0);
    }

    #[test]
    fn slopes_are_the_derivatives_of_the_influence() {
        for robust in [HUBER, TUKEY] {
            for u in [0.3, 1.2, 2.0, 4.0, 6.0] {
                let psi = |u: f64| robust.weight(u) * u;
                let slope = (psi(u + 1e-6) - psi(u - 1e-6)) / 2e-6;
                assert!((robust.slope(u) - slope).abs() < 1e-8, "{robust:?} at {u}");
            }
        }
    }
}
