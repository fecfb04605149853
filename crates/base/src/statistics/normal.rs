//! The normal distribution's tails.

use statrs::function::erf::erfc;

/// Where erfc underflows: beyond it the tail's asymptotic series is exact to 1e-4.
const FAR: f64 = 25.0;

/// Ln of the probability that a standard normal number lies between `low` and `high`; −∞ where
/// there is no room.
///
/// ln Q(z) is computed as such, so that 1e-400 is not 0: Q(z) = ½·erfc(z/√2), far out
/// exp(−z²/2)/(z·√2π) (Abramowitz & Stegun 26.2.12).
pub fn ln_normal_mass(low: f64, high: f64) -> f64 {
    if low.is_nan() || high.is_nan() || low >= high {
        return f64::NEG_INFINITY;
    }
    // both on the side where the tail is small
    if low + high < 0.0 {
        return ln_normal_mass(-high, -low);
    }
    if low < 0.0 {
        return (-upper_tail(-low) - upper_tail(high)).ln_1p();
    }
    let (a, b) = (ln_upper_tail(low), ln_upper_tail(high));
    a + (-(b - a).exp()).ln_1p()
}

fn upper_tail(z: f64) -> f64 {
    0.5 * erfc(z / std::f64::consts::SQRT_2)
}

fn ln_upper_tail(z: f64) -> f64 {
    match z < FAR {
        true => upper_tail(z).ln(),
        false => -0.5 * z * z - (z * (2.0 * std::f64::consts::PI).sqrt()).ln(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Against scipy 1.16: norm.logsf, norm.logcdf and log(norm.sf(3) − norm.sf(4)).
    #[test]
    fn mass_is_right_in_the_middle_and_far_out() {
        const INF: f64 = f64::INFINITY;
        for (low, high, expected) in [
            (-INF, INF, 0.0),
            (0.0, INF, -std::f64::consts::LN_2),
            (-1.0, 1.0, -0.381_715_146_302_1),
            (10.0, INF, -53.231_285_150_512),
            (-INF, -40.0, -804.608_442_013_75),
            (3.0, 4.0, -6.631_467_786_538),
        ] {
            assert_relative_eq!(ln_normal_mass(low, high), expected, max_relative = 1e-6, epsilon = 1e-15);
        }
        assert_eq!(ln_normal_mass(1.0, 1.0), -INF);
    }
}
