//! How probable a recording is under a story: the evidence of a Gaussian linear model, in closed form.
//!
//! With r the whitened and projected residual (ν degrees of freedom), the columns C of the story's parameters, scaled so
//! that their prior is the standard normal, G = CᵀC and b = Cᵀr:
//!
//! ln p(r) = −½·ν·ln σ² − ½·ln|1 + G/σ²| − (rᵀr − bᵀ(G + σ²·1)⁻¹b) / 2σ² + constant
//!
//! at the σ that makes it largest. The determinant is the price of parameters: one that the data pin down a thousand times
//! better than its prior costs ln 1000. A parameter with a bound has the part of the normal prior within it; the evidence
//! then gains ln(posterior mass within the bound / prior mass within it), parameter by parameter: a friction that comes out
//! negative has no mass where friction is possible.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::statistics::ln_normal_mass;

/// Least noise variance relative to that of the residual.
const LEAST: f64 = 1e-12;

/// What a story's evidence is computed from: inner products of whitened and projected vectors.
#[derive(Debug, Clone)]
pub struct Moments {
    /// rᵀr.
    pub square: f64,
    /// G.
    pub gram: DMatrix<f64>,
    /// b.
    pub product: DVector<f64>,
    /// Bounds of the scaled parameters.
    pub bounds: Vec<(f64, f64)>,
    /// ν.
    pub freedom: usize,
    /// Least noise: what rounding alone makes.
    pub floor: f64,
}

/// What a fit of a story comes to.
#[derive(Debug, Clone)]
pub struct Score {
    /// ln p(r), less a constant that is the same for all stories of one evidence and whitening.
    pub log_evidence: f64,
    /// Noise of a datum.
    pub sigma: f64,
    /// Estimates of the scaled parameters: posterior means without regard to bounds.
    pub estimate: DVector<f64>,
    /// Their posterior covariance.
    pub covariance: DMatrix<f64>,
}

/// What a story leaves to others, with its own uncertainty at its own noise.
pub struct Rest {
    /// Of the residual, without columns.
    pub moments: Moments,
    /// R: takes the inner products of the story's columns with others to those whose products are to be taken off,
    /// CᵀC − (R·UᵀC)ᵀ(R·UᵀC).
    pub root: DMatrix<f64>,
    /// R·b.
    pub product: DVector<f64>,
}

impl Moments {
    /// The story's columns U taken out of everything else: with G = V·Λ·Vᵀ and R = (Λ + σ²)^(−½)·Vᵀ,
    /// (1 + U·Uᵀ/σ²)⁻¹ = 1 − U·Rᵀ·R·Uᵀ. Of the degrees of freedom those are left that the story does not determine.
    pub fn rest(&self) -> Rest {
        let eigen = match self.gram.ncols() {
            0 => SymmetricEigen { eigenvectors: DMatrix::zeros(0, 0), eigenvalues: DVector::zeros(0) },
            _ => SymmetricEigen::new(self.gram.clone()),
        };
        let lambda = eigen.eigenvalues.map(|l| l.max(0.0));
        let s = self.variance(&lambda, &eigen.eigenvectors.tr_mul(&self.product));
        let mut root = eigen.eigenvectors.transpose();
        for (mut row, l) in root.row_iter_mut().zip(&lambda) {
            row /= (l + s).sqrt();
        }
        let product = &root * &self.product;
        let determined: f64 = lambda.iter().map(|l| l / (l + s)).sum();
        let moments = Moments {
            square: (self.square - product.norm_squared()).max(0.0),
            gram: DMatrix::zeros(0, 0),
            product: DVector::zeros(0),
            bounds: Vec::new(),
            freedom: self.freedom - (determined.round() as usize).min(self.freedom),
            floor: self.floor,
        };
        Rest { moments, root, product }
    }

    /// Of the residual `r` and `columns`, with bounds of their factors.
    pub fn new(
        r: &DVector<f64>,
        columns: &DMatrix<f64>,
        bounds: Vec<(f64, f64)>,
        freedom: usize,
        floor: f64,
    ) -> Self {
        let (gram, product) = (columns.tr_mul(columns), columns.tr_mul(r));
        Moments { square: r.norm_squared(), gram, product, bounds, freedom, floor }
    }

    /// The score.
    pub fn score(&self) -> Score {
        let p = self.gram.ncols();
        let eigen = match p {
            0 => SymmetricEigen { eigenvectors: DMatrix::zeros(0, 0), eigenvalues: DVector::zeros(0) },
            _ => SymmetricEigen::new(self.gram.clone()),
        };
        let lambda = eigen.eigenvalues.map(|l| l.max(0.0));
        let b = eigen.eigenvectors.tr_mul(&self.product);
        let s = self.variance(&lambda, &b);
        let shrunk = DVector::from_fn(p, |k, _| b[k] / (lambda[k] + s));
        let spread = DMatrix::from_diagonal(&lambda.map(|l| s / (l + s)));
        let estimate = &eigen.eigenvectors * shrunk;
        let covariance = &eigen.eigenvectors * spread * eigen.eigenvectors.transpose();
        let room: f64 = (0..p).map(|k| self.room(k, estimate[k], covariance[(k, k)].sqrt())).sum();
        Score {
            log_evidence: self.log_evidence(&lambda, &b, s) + room,
            sigma: s.sqrt(),
            estimate,
            covariance,
        }
    }

    /// Ln of the posterior mass within the bounds over the prior mass there.
    fn room(&self, k: usize, mean: f64, sd: f64) -> f64 {
        let (low, high) = self.bounds[k];
        if low == f64::NEG_INFINITY && high == f64::INFINITY {
            return 0.0;
        }
        let sd = sd.max(f64::MIN_POSITIVE);
        ln_normal_mass((low - mean) / sd, (high - mean) / sd) - ln_normal_mass(low, high)
    }

    fn log_evidence(&self, lambda: &DVector<f64>, b: &DVector<f64>, s: f64) -> f64 {
        let mut quadratic = self.square;
        let mut determinant = 0.0;
        for (l, b) in lambda.iter().zip(b) {
            quadratic -= b * b / (l + s);
            determinant += (l / s).ln_1p();
        }
        -0.5 * (self.freedom as f64 * s.ln() + determinant + quadratic.max(0.0) / s)
    }

    /// σ² where the evidence is largest: between the floor and what the residual has without any story. Far below the
    /// latter, columns that are nearly the same would explain their own rounding.
    ///
    /// D. J. C. MacKay's fixed point (Neural Computation 4 (1992) 415–447, §4): σ² = |r − C·x|² / (ν − γ), where
    /// γ = Σλ/(λ + σ²) parameters are determined by the data. It comes from above and settles in a few steps; where it
    /// does not, the last of them stands.
    fn variance(&self, lambda: &DVector<f64>, b: &DVector<f64>) -> f64 {
        const STEPS: usize = 60;
        const SETTLED: f64 = 1e-9;
        let nu = (self.freedom as f64).max(1.0);
        let all = self.square / nu;
        let lowest = self.floor.powi(2).max(LEAST * all).max(f64::MIN_POSITIVE.sqrt());
        let mut s = all.max(lowest);
        for _ in 0..STEPS {
            let (mut left, mut determined) = (self.square, 0.0);
            for (l, b) in lambda.iter().zip(b) {
                // |r − Cx|² = rᵀr − 2bᵀx + xᵀGx at x = b/(λ + σ²)
                left -= b * b * (l + 2.0 * s) / (l + s).powi(2);
                determined += l / (l + s);
            }
            let next =
                (left.max(0.0) / (nu - determined).max(1e-3 * nu)).clamp(lowest, all.max(lowest) * 2.0);
            let moved = (next / s - 1.0).abs();
            s = next;
            if moved < SETTLED {
                break;
            }
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    fn noise(n: usize, seed: u64) -> DVector<f64> {
        let mut random = Random::seeded(seed, 0);
        DVector::from_fn(n, |_, _| random.normal())
    }

    fn score(r: &DVector<f64>, columns: &DMatrix<f64>) -> Score {
        Moments::new(r, columns, vec![FREE; columns.ncols()], r.len(), 0.0).score()
    }

    #[test]
    fn the_noise_is_where_the_evidence_is_largest() {
        let (r, c) = (noise(30, 2), noise(30, 3));
        let r = r + &c * 0.8;
        let columns = DMatrix::from_columns(&[c.clone(), noise(30, 5) * 40.0]);
        let moments = Moments::new(&r, &columns, vec![FREE; 2], 30, 0.0);
        let eigen = SymmetricEigen::new(moments.gram.clone());
        let b = eigen.eigenvectors.tr_mul(&moments.product);
        let best = moments.score();
        for factor in [0.9, 0.99, 1.01, 1.1] {
            let there = moments.log_evidence(&eigen.eigenvalues, &b, best.sigma.powi(2) * factor);
            assert!(there < best.log_evidence, "{factor}");
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_no_explanation() {
        let (r, c) = (noise(60, 4), noise(60, 5));
        let r = r - &c * 2.0;
        let columns = DMatrix::from_columns(&[c]);
        let of = |bounds| Moments::new(&r, &columns, vec![bounds], 60, 0.0).score().log_evidence;
        let without = score(&r, &DMatrix::zeros(60, 0)).log_evidence;
        assert!(of(FREE) > without + 20.0);
        assert!(of((0.0, f64::INFINITY)) < without);
        // the other half of the prior is twice as dense
        assert!((of((f64::NEG_INFINITY, 0.0)) - of(FREE) - std::f64::consts::LN_2).abs() < 1e-6);
    }

    #[test]
    fn without_columns_it_is_the_likelihood_of_the_best_noise() {
        let r = noise(200, 1) * 3.0;
        let score = score(&r, &DMatrix::zeros(200, 0));
        let s = r.norm_squared() / 200.0;
        assert!((score.sigma - s.sqrt()).abs() < 1e-5 * s.sqrt());
        assert!((score.log_evidence + 0.5 * 200.0 * (s.ln() + 1.0)).abs() < 1e-8);
    }

    #[test]
    fn it_is_the_gaussian_integral_over_the_parameters() {
        // one column: ln ∫ N(r; c·x, σ²)·N(x; 0, 1) dx, by the trapezoidal rule, against none
        let (r, c) = (noise(30, 2), noise(30, 3));
        let r = r + &c * 0.8;
        let scored = score(&r, &DMatrix::from_columns(std::slice::from_ref(&c)));
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
            let without = score(&r, &DMatrix::zeros(100, 0));
            let with = score(&r, &DMatrix::from_columns(&[c * 10.0]));
            favours += usize::from(with.log_evidence > without.log_evidence + 3.0);
        }
        assert!(favours <= 1, "{favours} of 200 clean recordings favour it by 20 to 1");
    }
}
