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
//!
//! Nobody knows beforehand how large an effect is within a factor of ten. The prior of each effect is therefore κ times as wide
//! as its usual size, where κ is what makes the evidence largest (empirical Bayes, by expectation–maximisation), at the price
//! of ½·(log₁₀ κ)².

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::statistics::ln_normal_mass;

/// Least noise variance relative to that of the residual.
const LEAST: f64 = 1e-12;

/// Least and largest κ.
const SCALES: (f64, f64) = (1.0 / 30.0, 30.0);
/// Steps of expectation–maximisation to κ: one settles what the data determine well.
const SCALE_STEPS: usize = 6;

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
    /// How many parameters each effect has; those before the first effect keep their size.
    pub effects: Vec<usize>,
    /// ν.
    pub freedom: usize,
    /// Least noise: what rounding alone makes.
    pub floor: f64,
}

/// Columns that may be added to those of a story.
#[derive(Debug, Clone)]
pub struct More<'a> {
    /// Their inner products with each other.
    pub gram: &'a DMatrix<f64>,
    /// Those of the story's columns (rows) with them (columns).
    pub cross: DMatrix<f64>,
    /// Those with r.
    pub product: DVector<f64>,
    /// Bounds of the scaled parameters.
    pub bounds: Vec<(f64, f64)>,
}

/// A score in units of κ times the sizes.
struct Scaled {
    log_evidence: f64,
    variance: f64,
    mean: DVector<f64>,
    spread: DMatrix<f64>,
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
    /// How many parameters the data determine, Σλ/(λ + σ²).
    pub determined: f64,
}

impl Moments {
    /// Of the residual `r` and `columns`, with bounds of their factors and the sizes of the effects, the last of the columns.
    pub fn new(
        r: &DVector<f64>,
        columns: &DMatrix<f64>,
        bounds: Vec<(f64, f64)>,
        effects: Vec<usize>,
        freedom: usize,
        floor: f64,
    ) -> Self {
        let (gram, product) = (columns.tr_mul(columns), columns.tr_mul(r));
        Moments { square: r.norm_squared(), gram, product, bounds, effects, freedom, floor }
    }

    /// The score.
    pub fn score(&self) -> Score {
        let p = self.gram.ncols();
        let mut scales = vec![1.0; self.effects.len()];
        let mut step = self.scaled(&scales);
        for _ in 0..SCALE_STEPS {
            let mut first = p - self.effects.iter().sum::<usize>();
            let mut moved: f64 = 0.0;
            for (scale, &count) in scales.iter_mut().zip(&self.effects) {
                let own = first..first + count;
                let square: f64 = own.map(|k| step.mean[k].powi(2) + step.spread[(k, k)]).sum();
                let next = (*scale * (square / count as f64).sqrt()).clamp(SCALES.0, SCALES.1);
                moved = moved.max((next / *scale).ln().abs());
                *scale = next;
                first += count;
            }
            if moved < 0.02 {
                break;
            }
            step = self.scaled(&scales);
        }
        let price: f64 = scales.iter().map(|scale| 0.5 * scale.log10().powi(2)).sum();
        let sizes = DVector::from_vec(self.sizes(&scales));
        let by_sizes = DMatrix::from_diagonal(&sizes);
        Score {
            log_evidence: step.log_evidence - price,
            sigma: step.variance.sqrt(),
            determined: p as f64 - step.spread.trace(),
            estimate: step.mean.component_mul(&sizes),
            covariance: &by_sizes * step.spread * &by_sizes,
        }
    }

    /// κ of every parameter.
    fn sizes(&self, scales: &[f64]) -> Vec<f64> {
        let fixed = self.gram.ncols() - self.effects.iter().sum::<usize>();
        let of_effect = |(scale, &count): (&f64, &usize)| std::iter::repeat_n(*scale, count);
        std::iter::repeat_n(1.0, fixed).chain(scales.iter().zip(&self.effects).flat_map(of_effect)).collect()
    }

    /// Evidence, noise and posterior in units of κ times the sizes.
    fn scaled(&self, scales: &[f64]) -> Scaled {
        let p = self.gram.ncols();
        let sizes = self.sizes(scales);
        let gram = DMatrix::from_fn(p, p, |i, j| self.gram[(i, j)] * sizes[i] * sizes[j]);
        let product = DVector::from_fn(p, |i, _| self.product[i] * sizes[i]);
        let eigen = match p {
            0 => SymmetricEigen { eigenvectors: DMatrix::zeros(0, 0), eigenvalues: DVector::zeros(0) },
            _ => SymmetricEigen::new(gram),
        };
        let lambda = eigen.eigenvalues.map(|l| l.max(0.0));
        let b = eigen.eigenvectors.tr_mul(&product);
        let s = self.variance(&lambda, &b);
        let shrunk = DVector::from_fn(p, |k, _| b[k] / (lambda[k] + s));
        let spread = DMatrix::from_diagonal(&lambda.map(|l| s / (l + s)));
        let mean = &eigen.eigenvectors * shrunk;
        let spread = &eigen.eigenvectors * spread * eigen.eigenvectors.transpose();
        let room: f64 = (0..p)
            .map(|k| {
                let (low, high) = self.bounds[k];
                room((low / sizes[k], high / sizes[k]), mean[k], spread[(k, k)].sqrt())
            })
            .sum();
        Scaled { log_evidence: self.log_evidence(&lambda, &b, s) + room, variance: s, mean, spread }
    }

    /// About the log evidence that `more` columns add to a story of this score: the noise follows what they explain.
    ///
    /// With the story's columns out of them (G' = Gₘ − X(G + σ²)⁻¹Xᵀ, b' = bₘ − X(G + σ²)⁻¹b, X the cross products) they explain
    /// Δ = b'ᵀ(G' + σ²)⁻¹b', which leaves s' = σ²·(1 − Δ/νσ²), and
    ///
    /// gain ≈ −½·ν·ln(1 − Δ/νσ²) − ½·ln|1 + G'/s'| + ln(room)
    pub fn about(&self, score: &Score, more: &More) -> f64 {
        let s = score.sigma.powi(2);
        // (G + σ²)⁻¹ is the posterior covariance over σ²
        let reduced = &score.covariance * &more.cross / s;
        let gram = more.gram - more.cross.tr_mul(&reduced);
        let product = &more.product - reduced.tr_mul(&self.product);
        let k = gram.ncols();
        let nu = (self.freedom as f64).max(1.0);
        let (eigen, lambda, b) = beyond_rounding(gram, &product, more);
        // σ²/κ² on the diagonal
        let (mut scale, mut left, mut explained) = (1.0f64, s, 0.0);
        for _ in 0..SCALE_STEPS {
            let ridge = left / scale.powi(2);
            let (mut square, mut along) = (0.0, 0.0);
            for (l, b) in lambda.iter().zip(&b) {
                square += (b / (l + ridge)).powi(2) + left / (l + ridge);
                along += b * b / (l + ridge);
            }
            let next = (square / k as f64).sqrt().clamp(SCALES.0, SCALES.1);
            explained = (along / (nu * s)).clamp(0.0, 1.0 - 1e-12);
            let less = (s * (1.0 - explained)).max(self.floor.powi(2)).max(f64::MIN_POSITIVE.sqrt());
            let moved = (next / scale).ln().abs().max((less / left).ln().abs());
            (scale, left) = (next, less);
            if moved < 0.05 {
                break;
            }
        }
        let ridge = left / scale.powi(2);
        let determinant: f64 = lambda.iter().map(|l| (l / ridge).ln_1p()).sum();
        let is_bounded = |(low, high): &(f64, f64)| low.is_finite() || high.is_finite();
        let room: f64 = (0..k)
            .filter(|&i| is_bounded(&more.bounds[i]))
            .map(|i| {
                let (mut mean, mut variance) = (0.0, 0.0);
                for m in 0..k {
                    let v = eigen.eigenvectors[(i, m)];
                    mean += v * b[m] / (lambda[m] + ridge);
                    variance += v * v * left / (lambda[m] + ridge);
                }
                let (low, high) = more.bounds[i];
                room((low / scale, high / scale), mean / scale, variance.sqrt() / scale)
            })
            .sum();
        -0.5 * (nu * (-explained).ln_1p() + determinant + scale.log10().powi(2)) + room
    }

    /// What a story of this score leaves, as a problem of its own: its columns are taken out with the uncertainty that they have
    /// now, and so are the degrees of freedom that they determine.
    pub fn rest(&self, score: &Score) -> Moments {
        Moments {
            square: (self.square - self.product.dot(&score.estimate)).max(0.0),
            gram: DMatrix::zeros(0, 0),
            product: DVector::zeros(0),
            bounds: Vec::new(),
            effects: Vec::new(),
            freedom: self.freedom.saturating_sub(score.determined.round() as usize),
            floor: self.floor,
        }
    }

    /// `more` columns in what a story leaves: an eigenvalue problem of theirs only, not of the story's besides.
    pub fn beyond(&self, score: &Score, more: &More) -> Moments {
        let reduced = &score.covariance * &more.cross / score.sigma.powi(2);
        let gram = more.gram - more.cross.tr_mul(&reduced);
        let product = &more.product - reduced.tr_mul(&self.product);
        let (eigen, lambda, b) = beyond_rounding(gram, &product, more);
        let vectors = &eigen.eigenvectors;
        Moments {
            gram: vectors * DMatrix::from_diagonal(&lambda) * vectors.transpose(),
            product: vectors * b,
            bounds: more.bounds.clone(),
            effects: vec![more.gram.ncols()],
            ..self.rest(score)
        }
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

/// What is left of columns once a story's are taken out of them: eigenvectors and eigenvalues of `gram` and `product` along
/// them, both 0 where nothing but rounding is left, as of a curve whose joint has a curve already.
fn beyond_rounding(
    gram: DMatrix<f64>,
    product: &DVector<f64>,
    more: &More,
) -> (SymmetricEigen<f64, nalgebra::Dyn>, DVector<f64>, DVector<f64>) {
    const ROUNDING: f64 = 1e-9;
    let least = ROUNDING * more.gram.diagonal().amax();
    let eigen = SymmetricEigen::new(gram);
    let lambda = eigen.eigenvalues.map(|l| if l > least { l } else { 0.0 });
    let along = eigen.eigenvectors.tr_mul(product);
    let b = along.zip_map(&lambda, |b, l| if l > 0.0 { b } else { 0.0 });
    (eigen, lambda, b)
}

/// Ln of the posterior mass within the bounds over the prior mass there.
fn room((low, high): (f64, f64), mean: f64, sd: f64) -> f64 {
    if low == f64::NEG_INFINITY && high == f64::INFINITY {
        return 0.0;
    }
    let sd = sd.max(f64::MIN_POSITIVE);
    ln_normal_mass((low - mean) / sd, (high - mean) / sd) - ln_normal_mass(low, high)
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
        Moments::new(r, columns, vec![FREE; columns.ncols()], Vec::new(), r.len(), 0.0).score()
    }

    #[test]
    fn the_noise_is_where_the_evidence_is_largest() {
        let (r, c) = (noise(30, 2), noise(30, 3));
        let r = r + &c * 0.8;
        let columns = DMatrix::from_columns(&[c.clone(), noise(30, 5) * 40.0]);
        let moments = Moments::new(&r, &columns, vec![FREE; 2], Vec::new(), 30, 0.0);
        let eigen = SymmetricEigen::new(moments.gram.clone());
        let b = eigen.eigenvectors.tr_mul(&moments.product);
        let best = moments.score();
        for factor in [0.9, 0.99, 1.01, 1.1] {
            let there = moments.log_evidence(&eigen.eigenvalues, &b, best.sigma.powi(2) * factor);
            assert!(there < best.log_evidence, "{factor}");
        }
    }

    #[test]
    fn an_effect_is_as_large_as_it_is_and_screening_says_so_too() {
        let (r, c) = (noise(80, 2), noise(80, 3));
        for size in [0.2, 1.0, 5.0, 50.0] {
            // the true factor, in sizes, is 3/size
            let recorded = &r + &c * 3.0;
            let columns = DMatrix::from_columns(&[&c * size]);
            let wide = Moments::new(&recorded, &columns, vec![FREE], vec![1], 80, 0.0).score();
            let narrow = score(&recorded, &columns);
            assert!(wide.log_evidence >= narrow.log_evidence - 1.2, "size {size}");
            let fitted = c.dot(&recorded) / c.norm_squared();
            assert!(
                (wide.estimate[0] * size / fitted - 1.0).abs() < 0.05,
                "size {size}: {}",
                wide.estimate[0]
            );
            let none = Moments::new(&recorded, &DMatrix::zeros(80, 0), vec![], vec![], 80, 0.0);
            let (gram, product) = (columns.tr_mul(&columns), columns.tr_mul(&recorded));
            let more = More { gram: &gram, cross: DMatrix::zeros(0, 1), product, bounds: vec![FREE] };
            let before = none.score();
            let about = none.about(&before, &more);
            let exact = none.beyond(&before, &more).score().log_evidence - before.log_evidence;
            assert!((about - exact).abs() < 0.1 * exact.abs() + 0.5, "size {size}: {about} for {exact}");
        }
    }

    #[test]
    fn what_is_out_of_bounds_is_no_explanation() {
        let (r, c) = (noise(60, 4), noise(60, 5));
        let r = r - &c * 2.0;
        let columns = DMatrix::from_columns(&[c]);
        let of = |bounds| Moments::new(&r, &columns, vec![bounds], Vec::new(), 60, 0.0).score().log_evidence;
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
