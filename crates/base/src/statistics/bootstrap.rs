//! Intervals from resampled estimates.

use super::quantile_of_sorted;

/// The interval that leaves (1 − level)/2 of the `samples` out on either side: the percentile
/// interval of the bootstrap (Efron & Tibshirani, *An Introduction to the Bootstrap*, 1993, ch.
/// 13), quantiles as in [`quantile`](super::quantile). Sorts the samples.
///
/// `None` for no samples, a NaN among them, or a level outside [0, 1].
pub fn percentile_interval(samples: &mut [f64], level: f64) -> Option<(f64, f64)> {
    if samples.is_empty() || samples.iter().any(|x| x.is_nan()) || !(0.0..=1.0).contains(&level) {
        return None;
    }
    samples.sort_by(f64::total_cmp);
    let tail = 0.5 * (1.0 - level);
    Some((quantile_of_sorted(samples, tail), quantile_of_sorted(samples, 1.0 - tail)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{Random, quantile};

    #[test]
    fn the_interval_is_that_of_the_quantiles() {
        // 0 … 100 shuffled: the quantile p is 100·p
        let mut samples: Vec<f64> = (0..101).map(|i| f64::from(37 * i % 101)).collect();
        let (low, high) = percentile_interval(&mut samples, 0.9).unwrap();
        assert!((low - 5.0).abs() < 1e-12 && (high - 95.0).abs() < 1e-12);
        assert_eq!(quantile(&samples, 0.5), Some(50.0));
        assert_eq!(percentile_interval(&mut samples, 1.0), Some((0.0, 100.0)));
        assert_eq!(percentile_interval(&mut samples, 0.0), Some((50.0, 50.0)));
    }

    #[test]
    fn normal_samples_have_the_normal_interval() {
        let mut random = Random::seeded(1, 0);
        let mut samples: Vec<f64> = (0..40_000).map(|_| random.normal()).collect();
        let (low, high) = percentile_interval(&mut samples, 0.95).unwrap();
        // ±1.96 with a standard error of 0.013
        assert!((low + 1.96).abs() < 0.05 && (high - 1.96).abs() < 0.05, "{low} {high}");
    }

    #[test]
    fn what_has_no_interval() {
        assert_eq!(percentile_interval(&mut [], 0.9), None);
        assert_eq!(percentile_interval(&mut [1.0, f64::NAN], 0.9), None);
        assert_eq!(percentile_interval(&mut [1.0], 1.5), None);
    }
}
