//! Is the robot accurate enough? Limits that a campaign states, against errors at poses that the
//! calibration has not seen.

use super::campaign::AccuracyLimits;
use super::{Calibration, CrossValidation, Summary};

/// What the limits come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum AccuracyVerdict {
    /// All stated limits are kept.
    Pass,
    /// One of them is not.
    Fail,
    /// No limit was stated, or no pose was left that the calibration had not seen.
    NotEvaluated,
}

impl AccuracyVerdict {
    /// As in JSON.
    pub fn name(self) -> &'static str {
        match self {
            AccuracyVerdict::Pass => "pass",
            AccuracyVerdict::Fail => "fail",
            AccuracyVerdict::NotEvaluated => "not_evaluated",
        }
    }
}

/// A verdict and what it stands on.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Accuracy {
    /// The verdict.
    pub verdict: AccuracyVerdict,
    /// Which poses it stands on: `validation` or `held_out`.
    pub judged_by: Option<&'static str>,
    /// Errors at these poses, m.
    pub errors: Option<Summary>,
}

/// Judges a calibration by its validation poses, else by its cross-validation, and never by the
/// poses that it was fitted to. A fit that did not converge or is not plausible does not pass.
///
/// ```
/// use rodcal::calibration::{AccuracyVerdict, accuracy};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// let judged = accuracy(None, &calibration, None); // no limit was stated
/// assert_eq!((judged.verdict, judged.judged_by), (AccuracyVerdict::NotEvaluated, Some("validation")));
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn accuracy(
    limits: Option<&AccuracyLimits>,
    calibration: &Calibration,
    cross_validation: Option<&CrossValidation>,
) -> Accuracy {
    let validation =
        calibration.validation.as_ref().map(|errors| ("validation", errors.summary, errors.is_converged));
    let held_out = cross_validation.map(|errors| ("held_out", errors.summary, true));
    let seen = validation.or(held_out);
    let is_fit = calibration.is_converged && calibration.is_plausible();
    let verdict = match (limits, seen) {
        (Some(limits), Some((_, summary, is_converged))) => match limits.are_kept(&summary) {
            true if is_fit && is_converged => AccuracyVerdict::Pass,
            _ => AccuracyVerdict::Fail,
        },
        _ => AccuracyVerdict::NotEvaluated,
    };
    Accuracy { verdict, judged_by: seen.map(|(by, ..)| by), errors: seen.map(|(_, summary, _)| summary) }
}

impl AccuracyLimits {
    fn are_kept(&self, errors: &Summary) -> bool {
        let is_kept = |error: f64, limit: Option<f64>| limit.is_none_or(|limit| error <= limit);
        is_kept(errors.mean, self.mean) && is_kept(errors.max, self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stated_limit_counts_and_one_that_is_not_stated_does_not() {
        let errors = Summary::of(&[100e-6, 300e-6]);
        let kept = |mean: Option<f64>, max: Option<f64>| AccuracyLimits { mean, max }.are_kept(&errors);
        assert!(kept(Some(200e-6), Some(300e-6)) && kept(None, Some(301e-6)) && kept(Some(201e-6), None));
        assert!(!kept(Some(199e-6), None) && !kept(Some(200e-6), Some(299e-6)));
    }
}
