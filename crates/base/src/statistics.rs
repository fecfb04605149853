//! Distributions, quantiles, robust summaries and resampling: what a fit needs to be judged.
//!
//! Tail probabilities are computed as tails, never as 1 − p, so that 1e-60 is 1e-60 and not 0.

mod bartlett;
mod bootstrap;
mod estimate;
mod normal;
mod random;
mod unrounded;

pub use bartlett::bartlett;
pub use bootstrap::percentile_interval;
pub use estimate::Estimate;
pub use normal::ln_normal_mass;
pub use random::Random;
pub use unrounded::{one_clock, unrounded};

use statrs::function::beta::beta_reg;
use statrs::function::gamma::gamma_ur;
pub use statrs::function::gamma::ln_gamma;

use crate::error::{Error, Result};

/// Factor that makes the median absolute deviation of normal data estimate their standard
/// deviation: 1/Φ⁻¹(3/4), here to full precision (quoted as 1.4826).
pub const MAD_TO_SD: f64 = 1.482_602_218_505_602;

/// Half of a 95 % interval of a normal number, in standard deviations: Φ⁻¹(0.975).
pub const HALF_95: f64 = 1.959964;

/// The t below which Student's t with `dof` degrees of freedom falls with the probability `p`.
///
/// # Errors
/// [`Error::Argument`] unless 0 < p < 1 and dof > 0.
pub fn student_t_quantile(p: f64, dof: f64) -> Result<f64> {
    require("p", p, "a probability between 0 and 1", p > 0.0 && p < 1.0)?;
    require_positive("dof", dof)?;
    let tail = p.min(1.0 - p);
    if tail == 0.5 {
        return Ok(0.0);
    }
    // bracket the upper tail, then bisect: log-scale halving reaches the last digit for every tail
    // and dof
    let upper = |t: f64| 0.5 * two_sided(t, dof);
    let (mut low, mut high) = (f64::MIN_POSITIVE, 1.0);
    while upper(high) > tail && high < f64::MAX / 2.0 {
        (low, high) = (high, 2.0 * high);
    }
    while high / low > 2.0 {
        let middle = low.sqrt() * high.sqrt();
        if upper(middle) > tail { low = middle } else { high = middle }
    }
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = 0.5 * (low + high);
        if upper(middle) > tail { low = middle } else { high = middle }
    }
    let t = 0.5 * (low + high);
    Ok(if p < 0.5 { -t } else { t })
}

/// Probability that Student's t with `dof` degrees of freedom lies farther from 0 than `t`, on
/// either side.
///
/// P(|T| > |t|) = I(ν/2, ½; ν/(ν + t²)), the regularised incomplete beta function (Abramowitz &
/// Stegun 26.7.1).
///
/// # Errors
/// [`Error::Argument`] unless dof > 0 and t is a number.
pub fn student_t_two_sided_p(t: f64, dof: f64) -> Result<f64> {
    require("t", t, "a number", !t.is_nan())?;
    require_positive("dof", dof)?;
    Ok(two_sided(t, dof))
}

/// Probability that F with (`dof_1`, `dof_2`) degrees of freedom exceeds `f`.
///
/// P(F > f) = I(ν₂/2, ν₁/2; ν₂/(ν₂ + ν₁·f)) (Abramowitz & Stegun 26.6.2); accurate far into the
/// tail.
///
/// # Errors
/// [`Error::Argument`] unless both degrees of freedom are > 0 and f is a number.
pub fn f_survival(f: f64, dof_1: f64, dof_2: f64) -> Result<f64> {
    require("f", f, "a number", !f.is_nan())?;
    require_positive("dof_1", dof_1)?;
    require_positive("dof_2", dof_2)?;
    if f <= 0.0 {
        return Ok(1.0);
    }
    // ν₂/(ν₂ + ν₁·f), written so that neither a huge f nor a tiny one rounds to nothing
    Ok(beta_reg(dof_2 / 2.0, dof_1 / 2.0, 1.0 / (1.0 + f * (dof_1 / dof_2))))
}

/// Probability that χ² with `dof` degrees of freedom exceeds `x`.
///
/// P(χ² > x) = Q(ν/2, x/2), the regularised upper incomplete gamma function (Abramowitz & Stegun
/// 26.4.19).
///
/// # Errors
/// [`Error::Argument`] unless dof > 0 and x is a number.
pub fn chi_squared_survival(x: f64, dof: f64) -> Result<f64> {
    require("x", x, "a number", !x.is_nan())?;
    require_positive("dof", dof)?;
    Ok(match x {
        _ if x <= 0.0 => 1.0,
        _ if x.is_infinite() => 0.0,
        _ => gamma_ur(dof / 2.0, x / 2.0),
    })
}

/// The x below which χ² with `dof` degrees of freedom falls with the probability `p`.
///
/// # Errors
/// [`Error::Argument`] unless 0 < p < 1 and dof > 0.
pub fn chi_squared_quantile(p: f64, dof: f64) -> Result<f64> {
    require("p", p, "a probability between 0 and 1", p > 0.0 && p < 1.0)?;
    require_positive("dof", dof)?;
    let (mut low, mut high) = (0.0, dof.max(1.0));
    while gamma_ur(dof / 2.0, high / 2.0) > 1.0 - p && high < f64::MAX / 2.0 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..2 * f64::MANTISSA_DIGITS {
        let middle = 0.5 * (low + high);
        if gamma_ur(dof / 2.0, middle / 2.0) > 1.0 - p { low = middle } else { high = middle }
    }
    Ok(0.5 * (low + high))
}

/// Arithmetic mean; `None` for no values.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Standard deviation s = √(Σ(x − x̄)²/(n − 1)); `None` for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let mean = mean(values)?;
    let sum: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    Some((sum / (values.len() - 1) as f64).sqrt())
}

/// The value below which the fraction `p` of the values lies, with linear interpolation between
/// order statistics: definition 7 of Hyndman & Fan, *The American Statistician* 50 (1996) 361–365.
///
/// `None` for no values, a NaN among them, or p outside [0, 1].
pub fn quantile(values: &[f64], p: f64) -> Option<f64> {
    if values.is_empty() || values.iter().any(|x| x.is_nan()) || !(0.0..=1.0).contains(&p) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    Some(quantile_of_sorted(&sorted, p))
}

/// The same of values in ascending order, at least one, for p in [0, 1].
fn quantile_of_sorted(sorted: &[f64], p: f64) -> f64 {
    let place = p * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    // equal neighbours need no interpolation, and infinite ones would not survive it
    if below == above { below } else { below + place.fract() * (above - below) }
}

/// The middle value; `None` for no values or a NaN among them.
pub fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// Standard deviation by the median absolute deviation: [`MAD_TO_SD`] · median |x − median x|.
///
/// Up to half of the values may be wrong without ruining it. `None` for no values or a NaN among
/// them.
pub fn mad(values: &[f64]) -> Option<f64> {
    let middle = median(values)?;
    let deviations: Vec<f64> = values.iter().map(|x| (x - middle).abs()).collect();
    Some(MAD_TO_SD * median(&deviations)?)
}

/// P(|T| > |t|) for a valid `dof`.
fn two_sided(t: f64, dof: f64) -> f64 {
    let x = (t / dof.sqrt()).powi(2);
    if !x.is_finite() {
        // beyond the square root of the largest number: the leading term of the tail, in logarithms
        let ln_beta = ln_gamma(dof / 2.0) + ln_gamma(0.5) - ln_gamma(dof / 2.0 + 0.5);
        return (dof * (0.5 * dof.ln() - t.abs().ln()) - ln_beta - (dof / 2.0).ln()).exp();
    }
    match x {
        0.0 => 1.0,
        // near t = 0 the tail is 1 less a small centre
        _ if x < 1e-8 => 1.0 - beta_reg(0.5, dof / 2.0, x / (1.0 + x)),
        _ => beta_reg(dof / 2.0, 0.5, 1.0 / (1.0 + x)),
    }
}

fn require(name: &'static str, value: f64, expected: &str, holds: bool) -> Result<()> {
    if holds {
        return Ok(());
    }
    Err(Error::Argument { name, found: value.to_string(), expected: expected.into() })
}

fn require_positive(name: &'static str, value: f64) -> Result<()> {
    require(name, value, "a finite number > 0", value > 0.0 && value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn quantiles_of_t_are_those_of_the_tables() {
        // NIST/SEMATECH e-Handbook of Statistical Methods, §1.3.6.7.2, table of t: three decimals
        for (p, dof, t) in [
            (0.975, 1.0, 12.706),
            (0.975, 10.0, 2.228),
            (0.95, 30.0, 1.697),
            (0.999, 5.0, 5.893),
            (0.995, 100.0, 2.626),
        ] {
            assert_relative_eq!(student_t_quantile(p, dof).unwrap(), t, epsilon = 5e-4);
            assert_relative_eq!(student_t_quantile(1.0 - p, dof).unwrap(), -t, epsilon = 5e-4);
        }
        // ν = 1 is the Cauchy distribution: t = tan(π(p − ½)); ν = 2: t = (2p − 1)/√(2p(1 − p))
        let cauchy = (std::f64::consts::PI * 0.49).tan();
        assert_relative_eq!(student_t_quantile(0.99, 1.0).unwrap(), cauchy, max_relative = 1e-12);
        let two: f64 = 0.8 / (2.0 * 0.9 * 0.1f64).sqrt();
        assert_relative_eq!(student_t_quantile(0.9, 2.0).unwrap(), two, max_relative = 1e-12);
        assert_eq!(student_t_quantile(0.5, 3.0).unwrap(), 0.0);
    }

    #[test]
    fn p_of_t_inverts_the_quantile_and_holds_in_the_far_tail() {
        let t = student_t_quantile(0.975, 7.0).unwrap();
        assert_relative_eq!(student_t_two_sided_p(t, 7.0).unwrap(), 0.05, max_relative = 1e-12);
        // ν = 1: P(|T| > t) = 1 − (2/π)·arctan t = (2/π)·arctan(1/t)
        let expected = std::f64::consts::FRAC_2_PI * (1e-30f64).atan();
        assert_relative_eq!(student_t_two_sided_p(-1e30, 1.0).unwrap(), expected, max_relative = 1e-12);
        assert_eq!(student_t_two_sided_p(0.0, 4.0).unwrap(), 1.0);
    }

    #[test]
    fn the_tail_of_f_is_that_of_the_tables_and_of_closed_forms() {
        // NIST/SEMATECH e-Handbook, §1.3.6.7.3: upper 5 % and 1 % points, three decimals
        for (f, d1, d2, p) in [(4.965, 1.0, 10.0, 0.05), (2.711, 5.0, 20.0, 0.05), (3.699, 5.0, 30.0, 0.01)] {
            assert_relative_eq!(f_survival(f, d1, d2).unwrap(), p, max_relative = 1e-3);
        }
        // ν₁ = 2: P(F > f) = (1 + 2f/ν₂)^(−ν₂/2), exactly; here far below what 1 − p can show
        for f in [1e-12, 0.3, 40.0, 1e8] {
            let exact = (1.0f64 + 2.0 * f / 30.0).powf(-15.0);
            assert_relative_eq!(f_survival(f, 2.0, 30.0).unwrap(), exact, max_relative = 1e-11);
        }
        // F(1, ν) is the square of t
        assert_relative_eq!(
            f_survival(2.5f64.powi(2), 1.0, 12.0).unwrap(),
            student_t_two_sided_p(2.5, 12.0).unwrap(),
            max_relative = 1e-12
        );
    }

    #[test]
    fn the_tail_of_chi_squared_is_that_of_the_tables_and_of_closed_forms() {
        // NIST/SEMATECH e-Handbook, §1.3.6.7.4: upper critical values, three decimals
        for (x, dof, p) in [(3.841, 1.0, 0.05), (18.307, 10.0, 0.05), (135.807, 100.0, 0.01)] {
            assert_relative_eq!(chi_squared_survival(x, dof).unwrap(), p, max_relative = 1e-3);
        }
        assert_relative_eq!(chi_squared_quantile(0.95, 10.0).unwrap(), 18.307, epsilon = 5e-4);
        let x = chi_squared_quantile(1e-3, 3.0).unwrap();
        assert_relative_eq!(chi_squared_survival(x, 3.0).unwrap(), 0.999, max_relative = 1e-12);
        // ν = 2: P(χ² > x) = exp(−x/2)
        for x in [0.1f64, 5.0, 900.0] {
            let exact = (-x / 2.0).exp();
            assert_relative_eq!(chi_squared_survival(x, 2.0).unwrap(), exact, max_relative = 1e-12);
        }
        assert_eq!(chi_squared_survival(-1.0, 3.0).unwrap(), 1.0);
    }

    #[test]
    fn summaries_of_a_small_sample() {
        let values = [1.0, 1.0, 2.0, 2.0, 4.0, 6.0, 9.0];
        assert_eq!(median(&values), Some(2.0));
        assert_relative_eq!(mad(&values).unwrap(), 1.4826, epsilon = 1e-5);
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.25), Some(1.75));
        assert_eq!(quantile(&values, 1.0), Some(9.0));
        // 2, 4, 4, 4, 5, 5, 7, 9 has mean 5 and Σ(x − x̄)² = 32
        let textbook = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
        assert_eq!(mean(&textbook), Some(5.0));
        assert_relative_eq!(standard_deviation(&textbook).unwrap(), (32.0f64 / 7.0).sqrt());
    }

    #[test]
    fn nothing_and_nan_have_no_summary() {
        assert_eq!(mean(&[]), None);
        assert_eq!(standard_deviation(&[1.0]), None);
        assert_eq!(median(&[1.0, f64::NAN]), None);
        assert_eq!(mad(&[]), None);
    }

    #[test]
    fn arguments_out_of_their_domain_are_named() {
        let error = student_t_quantile(1.5, 3.0).unwrap_err();
        assert_eq!(error.to_string(), "`p` is 1.5, expected a probability between 0 and 1");
        assert!(f_survival(1.0, 0.0, 3.0).is_err());
        assert!(chi_squared_survival(f64::NAN, 3.0).is_err());
    }
}
