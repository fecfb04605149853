//! Errors that neighbours in the order of a recording have in common, beside those of their own.
//!
//! Along a course the error of a datum is a slow part and a part of its own, of the variance σ²
//! together,
//!
//! ```text
//! cov(i, k) = σ²·(a·e^(−|tᵢ − tₖ|/l) + (1 − a)·δᵢₖ)
//! ```
//!
//! a the share of the slow part, l its length in the places t of the course (G. E. Uhlenbeck, L. S.
//! Ornstein, *Phys. Rev.* 36 (1930) 823–841; with a = 1 at equal distances a first-order
//! autoregression). Its whitening is what a Kalman filter is surprised by (R. E. Kalman, *J. Basic
//! Eng.* 82 (1960) 35–45), so that n data need n steps. With m what the past says of the slow part
//! and p the variance of that,
//!
//! ```text
//! S = p + 1 − a   K = p/S   (W·v)ₜ = (vₜ − m)/√S   m ← f·(m + K·(vₜ − m))   p ← f²·(1 − K)·p + a·(1 − f²)
//! ```
//!
//! f = e^(−Δt/l) to the next datum, from m = 0 and p = a on.

use std::collections::BTreeMap;

/// The errors that neighbours have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrelatedNoise {
    /// a, their share of the variance.
    pub share: f64,
    /// l, how far they reach along the course.
    pub length: f64,
}

/// Whitens data along their courses.
#[derive(Debug, Clone, Default)]
pub struct Filter {
    courses: Vec<Vec<Step>>,
}

#[derive(Debug, Clone, Copy)]
struct Step {
    datum: usize,
    /// f from the datum before; 0 for the first.
    carried: f64,
    /// Kalman gain K: what of the innovation is carried on.
    gain: f64,
    /// Standard deviation √S of the innovation, over that of a datum.
    sd: f64,
}

impl Filter {
    /// Of data whose course and place in it are given; `None` for a datum of no course.
    pub fn new(correlated_noise: CorrelatedNoise, places: &[Option<(usize, f64)>]) -> Filter {
        let mut courses: BTreeMap<usize, Vec<(f64, usize)>> = BTreeMap::new();
        for (datum, place) in places.iter().enumerate() {
            if let Some((course, at)) = place {
                courses.entry(*course).or_default().push((*at, datum));
            }
        }
        let filtered = |mut data: Vec<(f64, usize)>| {
            data.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (a, mut last, mut known) = (correlated_noise.share, None, 0.0);
            let step = |(at, datum): (f64, usize)| {
                let carried =
                    last.replace(at).map_or(0.0, |last: f64| (-(at - last) / correlated_noise.length).exp());
                let predicted = carried * carried * known + a * (1.0 - carried * carried);
                let square = predicted + 1.0 - a;
                let gain = if square > 0.0 { predicted / square } else { 0.0 };
                known = (1.0 - gain) * predicted;
                Step { datum, carried, gain, sd: square.max(f64::MIN_POSITIVE).sqrt() }
            };
            data.into_iter().map(step).collect()
        };
        Filter { courses: courses.into_values().map(filtered).collect() }
    }

    /// W·v.
    pub fn whiten(&self, v: &mut [f64]) {
        for course in &self.courses {
            let mut slow = 0.0;
            for step in course {
                slow *= step.carried;
                let surprise = v[step.datum] - slow;
                slow += step.gain * surprise;
                v[step.datum] = surprise / step.sd;
            }
        }
    }

    /// Wᵀ·v: the same steps backwards, g what a datum counts through m of the next one.
    pub fn transpose(&self, v: &mut [f64]) {
        for course in &self.courses {
            let mut through_next = 0.0;
            for step in course.iter().rev() {
                let own = v[step.datum] / step.sd;
                v[step.datum] = own + step.gain * through_next;
                through_next = step.carried * ((1.0 - step.gain) * through_next - own);
            }
        }
    }

    /// ln |W|.
    pub fn log_determinant(&self) -> f64 {
        -self.courses.iter().flatten().map(|step| step.sd.ln()).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Two courses that alternate, with a gap and a datum of none.
    fn places() -> Vec<Option<(usize, f64)>> {
        let course_of = |k: usize| (k != 5).then_some((k % 2, if k > 7 { k as f64 + 4.5 } else { k as f64 }));
        (0..14).map(course_of).collect()
    }

    fn covariance(correlated_noise: CorrelatedNoise) -> DMatrix<f64> {
        let places = places();
        let slow = |i: usize, k: usize| match (places[i], places[k]) {
            (Some((a, s)), Some((b, t))) if a == b => {
                correlated_noise.share * (-(s - t).abs() / correlated_noise.length).exp()
            }
            _ => 0.0,
        };
        let own = |i: usize| if places[i].is_some() { 1.0 - correlated_noise.share } else { 1.0 };
        DMatrix::from_fn(14, 14, |i, k| slow(i, k) + if i == k { own(i) } else { 0.0 })
    }

    #[test]
    fn what_surprises_the_filter_is_white() {
        for (share, length) in [(0.6, 3.0), (1.0, 1.5), (0.2, 40.0)] {
            let correlated_noise = CorrelatedNoise { share, length };
            let filter = Filter::new(correlated_noise, &places());
            let mut w = DMatrix::identity(14, 14);
            w.column_iter_mut().for_each(|mut column| filter.whiten(column.as_mut_slice()));
            let white = &w * covariance(correlated_noise) * w.transpose();
            assert!((white - DMatrix::identity(14, 14)).amax() < 1e-12, "{share} {length}");
            assert!((filter.log_determinant() - w.determinant().ln()).abs() < 1e-12);
            let v = DVector::from_fn(14, |k, _| (1.3 * k as f64).sin());
            let mut transposed = v.clone();
            filter.transpose(transposed.as_mut_slice());
            assert!((transposed - w.transpose() * v).amax() < 1e-12, "{share} {length}");
        }
    }
}
