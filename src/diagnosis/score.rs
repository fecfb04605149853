//! How probable a recording is under a story: the evidence of a Gaussian linear model, in closed form.
//!
//! With r the whitened and projected residual (ν degrees of freedom), the columns C of the story's parameters, scaled so
//! that their prior is the standard normal, G = CᵀC and b = Cᵀr:
//!
//! ln p(r) = −½·ν·ln σ² − ½·ln|1 + G/σ²| − (rᵀr − bᵀ(G + σ²·1)⁻¹b) / 2σ² + constant
//!
//! at the σ that makes it largest. The determinant is the price of parameters: one that the data pin down a thousand times
//! better than its prior costs ln 1000.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Least noise variance relative to that of the residual.
const LEAST: f64 = 1e-12;

/// What a fit of a story comes to.
#[derive(Debug, Clone)]
pub struct Score {
    /// ln p(r), less a constant that is the same for all stories of one evidence and whitening.
    pub log_evidence: f64,
    /// Noise of a datum.
    pub sigma: f64,
    /// Estimates of the scaled parameters: posterior means.
    pub estimate: DVector<f64>,
    /// Their posterior covariance.
    pub covariance: DMatrix<f64>,
}

/// Scores the residual `r` against `columns` (both whitened and projected, columns scaled by the prior sizes), with
/// `freedom` degrees of freedom and a noise not below `floor`.
pub fn score(r: &DVector<f64>, columns: &DMatrix<f64>, freedom: usize, floor: f64) -> Score {
    let square = r.norm_squared();
    let p = columns.ncols();
    let eigen = match p {
        0 => SymmetricEigen { eigenvectors: DMatrix::zeros(0, 0), eigenvalues: DVector::zeros(0) },
        _ => SymmetricEigen::new(columns.tr_mul(columns)),
    };
    let lambda = eigen.eigenvalues.map(|l| l.max(0.0));
    let b = eigen.eigenvectors.tr_mul(&columns.tr_mul(r));
    let nu = freedom as f64;
    let log_evidence = |s: f64| {
        let mut quadratic = square;
        let mut determinant = 0.0;
        for k in 0..p {
            quadratic -= b[k] * b[k] / (lambda[k] + s);
            determinant += (lambda[k] / s).ln_1p();
        }
        -0.5 * (nu * s.ln() + determinant + quadratic.max(0.0) / s)
    };
    // between the floor and what the residual has without any story; far below it columns that are nearly the same would
    // explain their own rounding
    let all = square / nu.max(1.0);
    let lowest = floor.powi(2).max(LEAST * all).max(f64::MIN_POSITIVE.sqrt());
    let highest = all.max(lowest) * 2.0;
    let s = largest(&|t: f64| log_evidence(t.exp()), lowest.ln(), highest.ln()).exp();
    let shrunk = DVector::from_fn(p, |k, _| b[k] / (lambda[k] + s));
    let spread = DMatrix::from_diagonal(&lambda.map(|l| s / (l + s)));
    Score {
        log_evidence: log_evidence(s),
        sigma: s.sqrt(),
        estimate: &eigen.eigenvectors * shrunk,
        covariance: &eigen.eigenvectors * spread * eigen.eigenvectors.transpose(),
    }
}

/// Where a function of one hump is largest in [low, high]: golden section, to 1e-6.
fn largest(f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fa, mut fb) = (f(a), f(b));
    while high - low > 1e-6 {
        if fa < fb {
            (low, a, fa) = (a, b, fb);
            b = low + GOLDEN * (high - low);
            fb = f(b);
        } else {
            (high, b, fb) = (b, a, fa);
            a = high - GOLDEN * (high - low);
            fa = f(a);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn noise(n: usize, seed: u64) -> DVector<f64> {
        let mut random = Random::seeded(seed, 0);
        DVector::from_fn(n, |_, _| random.normal())
    }

    #[test]
    fn without_columns_it_is_the_likelihood_of_the_best_noise() {
        let r = noise(200, 1) * 3.0;
        let score = score(&r, &DMatrix::zeros(200, 0), 200, 0.0);
        let s = r.norm_squared() / 200.0;
        assert!((score.sigma - s.sqrt()).abs() < 1e-5 * s.sqrt());
        assert!((score.log_evidence + 0.5 * 200.0 * (s.ln() + 1.0)).abs() < 1e-8);
    }

    #[test]
    fn it_is_the_gaussian_integral_over_the_parameters() {
        // one column: ln ∫ N(r; c·x, σ²)·N(x; 0, 1) dx, by the trapezoidal rule, against none
        let (r, c) = (noise(30, 2), noise(30, 3));
        let r = r + &c * 0.8;
        let scored = score(&r, &DMatrix::from_columns(std::slice::from_ref(&c)), 30, 0.0);
        let s = scored.sigma.powi(2);
        let density = |x: f64| {
            (-0.5 * ((&r - &c * x).norm_squared() / s + x * x)).exp() / (2.0 * std::f64::consts::PI).sqrt()
        };
        let step = 1e-3;
        let integral: f64 = (-6000..6000).map(|i| density(f64::from(i) * step) * step).sum();
        let expected = integral.ln() - 0.5 * 30.0 * s.ln();
        assert!((scored.log_evidence - expected).abs() < 1e-9, "{} {expected}", scored.log_evidence);
    }

    #[test]
    fn a_column_that_explains_nothing_costs() {
        let mut favours = 0;
        for seed in 0..200 {
            let (r, c) = (noise(100, 2 * seed + 10), noise(100, 2 * seed + 11));
            let without = score(&r, &DMatrix::zeros(100, 0), 100, 0.0);
            let with = score(&r, &DMatrix::from_columns(&[c * 10.0]), 100, 0.0);
            favours += usize::from(with.log_evidence > without.log_evidence + 3.0);
        }
        assert!(favours <= 1, "{favours} of 200 clean recordings favour it by 20 to 1");
    }
}
