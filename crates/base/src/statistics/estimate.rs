//! A number with its standard error.

use super::{student_t_quantile, student_t_two_sided_p};
use crate::units::with_uncertainty;

/// An estimated quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Its standard error in the same unit; `None` where the data give none.
    pub std_error: Option<f64>,
    /// Degrees of freedom behind the standard error.
    pub dof: usize,
}

impl Estimate {
    /// The quantity times a number that is known exactly.
    pub fn times(self, factor: f64) -> Self {
        Estimate {
            value: self.value * factor,
            std_error: self.std_error.map(|error| error * factor.abs()),
            dof: self.dof,
        }
    }

    /// Sum of independent quantities: variances add, the degrees of freedom by Welch and
    /// Satterthwaite, ν = (Σ sᵢ²)² / Σ sᵢ⁴/νᵢ (F. E. Satterthwaite, *Biometrics Bulletin* 2 (1946)
    /// 110–114), rounded down.
    pub fn sum(terms: &[Estimate]) -> Self {
        let variances: Option<Vec<f64>> = terms.iter().map(|term| Some(term.std_error?.powi(2))).collect();
        let value = terms.iter().map(|term| term.value).sum();
        let Some(variances) = variances else { return Estimate { value, std_error: None, dof: 0 } };
        let total: f64 = variances.iter().sum();
        let spread: f64 = variances.iter().zip(terms).map(|(v, term)| v * v / term.dof.max(1) as f64).sum();
        let dof = if spread > 0.0 {
            total * total / spread
        } else {
            terms.iter().map(|t| t.dof).sum::<usize>() as f64
        };
        // a hair above a whole number that rounding has put just below it
        Estimate { value, std_error: Some(total.sqrt()), dof: (dof + 1e-9) as usize }
    }

    /// Independent estimates of one quantity as one: weighted by 1/s², or their mean where a weight
    /// is missing or infinite. `None` without any.
    pub fn pooled(estimates: &[Estimate]) -> Option<Self> {
        let weight = |e: &Estimate| e.std_error.map(|s| 1.0 / (s * s)).filter(|w| w.is_finite());
        let weights: Option<Vec<f64>> = estimates.iter().map(weight).collect();
        let weights = weights.unwrap_or_else(|| vec![1.0; estimates.len()]);
        let total: f64 = weights.iter().sum();
        let terms: Vec<Estimate> = estimates.iter().zip(&weights).map(|(e, w)| e.times(w / total)).collect();
        (!terms.is_empty()).then(|| Estimate::sum(&terms))
    }

    /// Half width of the 95 % interval, t·s.
    pub fn half_width_95(&self) -> Option<f64> {
        let t = student_t_quantile(0.975, self.dof as f64).ok()?;
        Some(t * self.std_error?)
    }

    /// True where the value differs from zero with a two-sided p below `level`; never without a
    /// standard error.
    pub fn is_significant(&self, level: f64) -> bool {
        match self.std_error {
            Some(error) if error > 0.0 => {
                student_t_two_sided_p(self.value / error, self.dof as f64).is_ok_and(|p| p < level)
            }
            Some(_) => self.value != 0.0,
            None => false,
        }
    }

    /// "33.02 ± 0.18" in `unit` (the SI value of one of it): half of the 95 % interval, as ± is
    /// wherever people read it.
    pub fn show(&self, unit: f64) -> String {
        with_uncertainty(self.value / unit, self.half_width_95().unwrap_or(0.0) / unit, 5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn estimate(value: f64, std_error: f64, dof: usize) -> Estimate {
        Estimate { value, std_error: Some(std_error), dof }
    }

    #[test]
    fn a_sum_adds_variances_and_pools_degrees_of_freedom() {
        let sum = Estimate::sum(&[estimate(1.0, 3.0, 4), estimate(2.0, 4.0, 4)]);
        assert_eq!((sum.value, sum.std_error), (3.0, Some(5.0)));
        // (9 + 16)² / ((81 + 256)/4) = 7.4
        assert_eq!(sum.dof, 7);
    }

    #[test]
    fn pooling_trusts_the_better_one_and_falls_back_to_the_mean() {
        let pooled = Estimate::pooled(&[estimate(1.0, 1.0, 9), estimate(2.0, 0.5, 9)]).unwrap();
        assert!((pooled.value - 1.8).abs() < 1e-12);
        assert!((pooled.std_error.unwrap() - 0.2f64.sqrt()).abs() < 1e-12);
        let unknown = Estimate { value: 4.0, std_error: None, dof: 0 };
        assert_eq!(Estimate::pooled(&[estimate(1.0, 1.0, 9), unknown]).unwrap().value, 2.5);
        assert_eq!(Estimate::pooled(&[]), None);
    }

    #[test]
    fn significance_needs_a_standard_error() {
        assert!(estimate(10.0, 1.0, 10).is_significant(0.01));
        assert!(!estimate(1.0, 1.0, 10).is_significant(0.01));
        assert!(!Estimate { value: 10.0, std_error: None, dof: 0 }.is_significant(0.01));
    }

    #[test]
    fn the_error_decides_how_many_digits_are_shown() {
        // t = 2.571
        assert_eq!(estimate(33.0213, 0.0712, 5).show(1.0), "33.02 ± 0.18");
        assert_eq!(estimate(1234.5, 71.2, 5).show(1.0), "1234 ± 183");
        assert_eq!(estimate(33.0213e-6, 0.0712e-6, 5).show(1e-6), "33.02 ± 0.18");
    }

    /// t(0.975, 4) = 2.776 (any table of Student's t).
    #[test]
    fn the_interval_is_students() {
        assert!((estimate(0.0, 1.0, 4).half_width_95().unwrap() - 2.776).abs() < 5e-4);
    }
}
