//! How the data scatter: heavy tails, single readings far off, and whether stated noise is met.
//!
//! Residuals over their scale are taken for Student's t of ν degrees of freedom, ν and scale by
//! maximum likelihood; each datum then counts
//!
//! ```text
//! w = (ν + 1)/(ν + (r/σ)²)
//! ```
//!
//! (K. L. Lange, R. J. A. Little, J. M. G. Taylor, *JASA* 84 (1989) 881–896). With normal noise all
//! weights are one.

use nalgebra::DVector;

use crate::inference::Evidence;
use crate::inference::model::evidence::rms;
use crate::statistics::ln_gamma;

/// Degrees of freedom that are tried; infinity is the normal distribution.
const TAILS: [f64; 8] = [1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 20.0];
/// Ln of the likelihood ratio from which on tails are heavier than normal.
const HEAVY: f64 = 3.0;
/// Fewer data say nothing of tails.
const FEWEST: usize = 10;
/// What a datum counts that is far off.
pub const OFF: f64 = 1e-6;
/// Data far off are single ones up to this share of all, or this number.
const FEW: usize = 30;
pub const MOST_ALONE: usize = 3;
/// A single datum so many scales out is a suspect.
pub const SUSPECT: f64 = 5.0;

/// A single datum far off.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Suspect {
    /// Index of the datum.
    pub datum: usize,
    /// How far, in standard deviations of the others.
    pub sigma: f64,
}

/// A noise that somebody stated, against what is left.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct NoiseTest {
    /// Stated standard deviation of a datum; `None` where nobody stated one.
    pub stated: Option<f64>,
    /// The scatter that is left.
    pub estimated: f64,
    /// Probability of as much scatter if the stated noise were right (χ²).
    pub p_value: Option<f64>,
}

/// A stated noise is contradicted below this probability.
const CONTRADICTED: f64 = 1e-3;

impl NoiseTest {
    /// True where the stated noise does not explain what is left.
    pub fn is_contradicted(&self) -> bool {
        self.p_value.is_some_and(|p| p < CONTRADICTED)
    }
}

/// Scale and tails of residuals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tails {
    /// σ of the t distribution; of the normal one its standard deviation.
    pub scale: f64,
    /// ν; infinity for normal tails.
    pub freedom: f64,
    /// Standard deviation that rounding makes by itself.
    rounding: f64,
}

impl Tails {
    /// The likeliest; normal ones where the data do not say otherwise. `rounding` is the standard
    /// deviation that rounding makes by itself: residuals that a coarse display shows as none are
    /// no smaller.
    pub fn of(residual: &DVector<f64>, rounding: f64) -> Tails {
        let residual = &residual.map(|r| r.hypot(rounding));
        let normal = Tails { scale: rms(residual), freedom: f64::INFINITY, rounding };
        if residual.len() < FEWEST || normal.scale <= 0.0 {
            return normal;
        }
        let fitted = TAILS.map(|freedom| {
            let scale = scale(residual, freedom);
            let tails = Tails { scale, freedom, rounding };
            (tails, tails.log_likelihood(residual))
        });
        let best = fitted.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        match best {
            Some((tails, likelihood))
                if likelihood > normal.log_likelihood(residual) + HEAVY && tails.scale > 0.0 =>
            {
                tails
            }
            _ => normal,
        }
    }

    fn log_likelihood(&self, residual: &DVector<f64>) -> f64 {
        let (n, nu) = (residual.len() as f64, self.freedom);
        if nu.is_infinite() {
            return -n * (self.scale.ln() + 0.5 * (2.0 * std::f64::consts::PI).ln() + 0.5);
        }
        let constant = ln_gamma(0.5 * (nu + 1.0))
            - ln_gamma(0.5 * nu)
            - 0.5 * (nu * std::f64::consts::PI).ln()
            - self.scale.ln();
        let tail = |r: &f64| -0.5 * (nu + 1.0) * ((r / self.scale).powi(2) / nu).ln_1p();
        n * constant + residual.iter().map(tail).sum::<f64>()
    }

    /// The likeliest scale of other residuals with the same tails.
    pub fn scale_of(&self, residual: &DVector<f64>) -> f64 {
        let residual = &residual.map(|r| r.hypot(self.rounding));
        if self.freedom.is_infinite() { rms(residual) } else { scale(residual, self.freedom) }
    }

    /// How much each datum counts.
    fn weights(&self, residual: &DVector<f64>) -> Vec<f64> {
        let weight = |r: &f64| match self.freedom.is_infinite() {
            true => 1.0,
            false => (self.freedom + 1.0) / (self.freedom + (r / self.scale).powi(2)),
        };
        residual.iter().map(weight).collect()
    }

    /// What a datum says of a place, over what it would say were the distribution normal with this
    /// scale: (ν + 1)/(ν + 3) (Lange, Little & Taylor, §2). Weights alone make data that agree too
    /// sure.
    fn information(&self) -> f64 {
        if self.freedom.is_infinite() { 1.0 } else { (self.freedom + 1.0) / (self.freedom + 3.0) }
    }

    /// Single data that are far off. Beside a few of them the others are normal; where most show
    /// none at all on a coarse display, one of its digits is not far.
    pub fn suspects(&self, residual: &DVector<f64>) -> Vec<Suspect> {
        // half the width that holds 68 % of the data, were they normal: 1.4826 × the median size
        let mut sizes: Vec<f64> = residual.iter().map(|r| r.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
        let core = (1.4826 * median).max(0.2 * self.scale).max(self.rounding);
        let far = |(datum, r): (usize, &f64)| {
            let sigma = r / core;
            (core > 0.0 && sigma.abs() > SUSPECT).then_some(Suspect { datum, sigma })
        };
        residual.iter().enumerate().filter_map(far).collect()
    }
}

/// How much each datum of an evidence counts that leaves `residual`, and what it then says over
/// what a normal one does.
pub fn weighted(evidence: &Evidence, residual: &DVector<f64>) -> (Vec<f64>, f64) {
    let (weights, information) = weighted_alike(&in_spread(evidence, residual), evidence.rounding());
    let spread = weights.iter().zip(&evidence.spread);
    (spread.map(|(weight, spread)| weight / spread.powi(2)).collect(), information)
}

/// Residuals as if all data had the usual noise.
pub fn in_spread(evidence: &Evidence, residual: &DVector<f64>) -> DVector<f64> {
    DVector::from_iterator(residual.len(), residual.iter().zip(&evidence.spread).map(|(r, s)| r / s))
}

/// Of data whose noise is alike. A few data far off beside normal ones are no heavy tails: they
/// hardly count, and the others all alike.
fn weighted_alike(residual: &DVector<f64>, rounding: f64) -> (Vec<f64>, f64) {
    let tails = Tails::of(residual, rounding);
    if tails.freedom.is_infinite() {
        return (vec![1.0; residual.len()], 1.0);
    }
    let far: Vec<usize> = tails.suspects(residual).iter().map(|suspect| suspect.datum).collect();
    let few = (residual.len() / FEW).max(MOST_ALONE);
    if far.len() <= few {
        let kept: Vec<usize> = (0..residual.len()).filter(|i| !far.contains(i)).collect();
        if Tails::of(&residual.select_rows(&kept), rounding).freedom.is_infinite() {
            let mut weights = vec![1.0; residual.len()];
            far.iter().for_each(|&i| weights[i] = OFF);
            return (weights, 1.0);
        }
    }
    (tails.weights(residual), tails.information())
}

/// The scale of the t distribution that is likeliest, by its fixed point σ² = Σ w·r²/n.
fn scale(residual: &DVector<f64>, nu: f64) -> f64 {
    let n = residual.len() as f64;
    let mut square = residual.norm_squared() / n;
    for _ in 0..50 {
        let weighted = |r: &f64| (nu + 1.0) / (nu + r * r / square.max(f64::MIN_POSITIVE)) * r * r;
        let next = residual.iter().map(weighted).sum::<f64>() / n;
        let has_arrived = (next - square).abs() <= 1e-6 * square;
        square = next;
        if has_arrived {
            break;
        }
    }
    square.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn noise(outliers: &[(usize, f64)]) -> DVector<f64> {
        let mut random = Random::seeded(11, 0);
        let mut noise = DVector::from_fn(200, |_, _| random.normal());
        outliers.iter().for_each(|&(row, value)| noise[row] = value);
        noise
    }

    #[test]
    fn a_digit_of_a_coarse_display_is_not_far_off() {
        let mut random = Random::seeded(12, 0);
        // two of three channels do not move; the third trembles by a third of a digit
        let shown =
            |k: usize| if k.is_multiple_of(3) { (0.5 + 0.3 * random.normal()).round() - 0.5 } else { 1e-3 };
        let residual = DVector::from_iterator(300, (0..300).map(shown));
        let rounding = 1.0 / 12.0f64.sqrt();
        assert!(Tails::of(&residual, rounding).suspects(&residual).is_empty());
        let mut with = residual.clone();
        with[40] = 3.0;
        let suspects = Tails::of(&with, rounding).suspects(&with);
        assert_eq!(suspects.iter().map(|s| s.datum).collect::<Vec<_>>(), [40]);
    }

    #[test]
    fn normal_noise_has_normal_tails_and_no_suspects() {
        let tails = Tails::of(&noise(&[]), 0.0);
        assert!(tails.freedom.is_infinite() && (tails.scale - 1.0).abs() < 0.1, "{tails:?}");
        assert!(tails.suspects(&noise(&[])).is_empty());
        assert!(weighted_alike(&noise(&[]), 0.0) == (vec![1.0; 200], 1.0));
    }

    #[test]
    fn the_mean_of_heavy_tails_is_as_sure_as_its_information_says() {
        // the estimate that the weights make of 0, over its error by weights and information
        let mut random = Random::seeded(12, 0);
        let (mut squares, count, n) = (0.0, 300, 100);
        for _ in 0..count {
            let mut t3 =
                || random.normal() / ((0..3).map(|_| random.normal().powi(2)).sum::<f64>() / 3.0).sqrt();
            let sample = DVector::from_fn(n, |_, _| t3());
            // the likeliest mean, by weights about it
            let (mut mean, mut total, mut tails) =
                (0.0, 0.0, Tails { freedom: 3.0, scale: 1.0, rounding: 0.0 });
            for _ in 0..50 {
                let left = sample.add_scalar(-mean);
                tails.scale = scale(&left, 3.0);
                let weights = tails.weights(&left);
                total = weights.iter().sum();
                mean = weights.iter().zip(sample.iter()).map(|(w, x)| w * x).sum::<f64>() / total;
            }
            squares += mean * mean * total * tails.information() / tails.scale.powi(2);
        }
        // χ² of 300 degrees of freedom, three standard deviations
        assert!(
            (squares / f64::from(count) - 1.0).abs() < 3.0 * (2.0 / f64::from(count)).sqrt(),
            "{squares}"
        );
    }

    #[test]
    fn a_misread_datum_is_a_suspect_and_hardly_counts() {
        let with = noise(&[(7, 30.0), (90, -12.0)]);
        let tails = Tails::of(&with, 0.0);
        let suspects = tails.suspects(&with);
        assert_eq!(suspects.iter().map(|s| s.datum).collect::<Vec<_>>(), [7, 90]);
        let (weights, information) = weighted_alike(&with, 0.0);
        assert!(weights[7] < 0.02 && weights[8] == 1.0 && information == 1.0, "{:?}", weights[7]);
        assert!((tails.scale - 1.0).abs() < 0.15, "{tails:?}");
    }
}
