//! All modes of a campaign side by side, and whether they differ by more than chance.
//!
//! A paired bootstrap over poses: measurement poses are drawn again within every clamp, validation
//! poses likewise, every mode is calibrated on the same draw and judged by the same draw. What is
//! left of a difference between two modes is its uncertainty, measuring noise and choice of poses
//! included (B. Efron, R. Tibshirani, *An Introduction to the Bootstrap*, 1993, ch. 13). Without a
//! validation file the held-out errors of a cross-validation are compared.

use std::ops::Range;

use super::calibrate::calibrate;
use super::calibrate_from::setup_from;
use super::campaign::Campaign;
use super::compensation::{Compensation, Mode, modes};
use super::cross_validation::{CrossValidation, cross_validate};
use super::options::Options;
use super::result::Calibration;
use super::validation::{Summary, validate_from};
use crate::error::Result;
use crate::parallel::in_parallel;
use crate::statistics::{Random, mean, percentile_interval, standard_deviation};

/// How to compare.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct CompareOptions {
    /// How each mode is calibrated.
    pub calibration: Options,
    /// Draws of the bootstrap.
    pub draws: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Folds where there is no validation file.
    pub folds: usize,
}

impl Default for CompareOptions {
    fn default() -> Self {
        CompareOptions { calibration: Options::default(), draws: 200, seed: 1, folds: 5 }
    }
}

impl CompareOptions {
    /// With each mode calibrated so.
    pub fn with_calibration(self, calibration: Options) -> CompareOptions {
        CompareOptions { calibration, ..self }
    }

    /// With so many draws of the bootstrap.
    pub fn with_draws(self, draws: usize) -> CompareOptions {
        CompareOptions { draws, ..self }
    }

    /// With draws from this seed.
    pub fn with_seed(self, seed: u64) -> CompareOptions {
        CompareOptions { seed, ..self }
    }
}

/// All modes of a campaign.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Comparison<'c> {
    /// One calibration per mode that the files allow, in the paper's order.
    pub calibrations: Vec<Calibration<'c>>,
    /// Held-out errors of each, where there is no validation file.
    pub cross_validations: Option<Vec<CrossValidation>>,
    /// 95 % interval of each mode's mean error, m.
    pub intervals: Vec<(f64, f64)>,
    /// Every pair of modes.
    pub differences: Vec<Difference>,
    /// Draws that the intervals rest on.
    pub draws: usize,
}

/// Mean error of one mode less that of another.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Difference {
    /// The mode whose error is taken.
    pub mode: Mode,
    /// The mode it is compared with.
    pub against: Mode,
    /// Difference of the mean errors, m: negative where `mode` is better.
    pub mean: f64,
    /// Its 95 % interval, m.
    pub interval: (f64, f64),
    /// True where the difference is larger than chance would make the largest of so many
    /// differences, 19 times in 20.
    pub is_significant: bool,
}

impl Comparison<'_> {
    /// The errors that mode `index` is judged by, m, one per pose.
    pub fn errors(&self, index: usize) -> &[f64] {
        match (&self.cross_validations, &self.calibrations[index].validation) {
            (Some(cross_validations), _) => &cross_validations[index].errors,
            (None, Some(validation)) => &validation.errors,
            (None, None) => &[],
        }
    }

    /// What they sum up to.
    pub fn summary(&self, index: usize) -> Summary {
        Summary::of(self.errors(index))
    }
}

/// Calibrates in every mode that the campaign's files allow, and compares.
///
/// `progress` is called after each draw with the number of draws that are done.
///
/// ```
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let options = CompareOptions::default().with_draws(4);
/// let comparison = compare(&campaign, &options, &|_| {})?;
/// let modes: Vec<Mode> = comparison.calibrations.iter().map(|c| c.mode).collect();
/// assert_eq!(modes, Mode::ALL); // none, calc, fea, meas
/// assert_eq!(comparison.differences.len(), 6); // every pair of them
/// assert!(comparison.summary(3).mean < comparison.summary(0).mean);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibrate`] and [`cross_validate`].
pub fn compare<'c>(
    campaign: &'c Campaign,
    options: &CompareOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Comparison<'c>> {
    let draws = Draws::new(campaign, options)?;
    let drawn = draws.means(0..options.draws, progress);
    Ok(draws.comparison(drawn))
}

/// A comparison before its draws, which may be made in parts, by others: what a draw gives depends
/// on its number alone.
pub struct Draws<'c> {
    campaign: &'c Campaign,
    options: CompareOptions,
    compensations: Vec<Compensation>,
    comparison: Comparison<'c>,
}

impl<'c> Draws<'c> {
    /// Calibrates in every mode.
    ///
    /// # Errors
    /// As [`compare`].
    pub fn new(campaign: &'c Campaign, options: &CompareOptions) -> Result<Draws<'c>> {
        let modes = modes(campaign);
        let compensations =
            modes.iter().map(|&mode| Compensation::new(campaign, mode)).collect::<Result<Vec<_>>>()?;
        let calibrations = modes
            .iter()
            .map(|&mode| calibrate(campaign, mode, &options.calibration))
            .collect::<Result<Vec<_>>>()?;
        let cross_validations = match &campaign.validation {
            Some(_) => None,
            None => Some(
                calibrations
                    .iter()
                    .zip(&compensations)
                    .map(|(c, with)| cross_validate(campaign, c, with, options.folds, &options.calibration))
                    .collect::<Result<Vec<_>>>()?,
            ),
        };
        let comparison = Comparison {
            calibrations,
            cross_validations,
            intervals: Vec::new(),
            differences: Vec::new(),
            draws: options.draws,
        };
        Ok(Draws { campaign, options: *options, compensations, comparison })
    }

    /// Mean error of every mode in each of these draws, m; nothing of a draw in which a fit fails.
    /// `progress` is called after each with its number, from 1.
    pub fn means(&self, draws: Range<usize>, progress: &(dyn Fn(usize) + Sync)) -> Vec<Option<Vec<f64>>> {
        in_parallel(draws.len(), |k| {
            let draw = draws.start + k;
            let mut random = Random::seeded(self.options.seed, draw as u64);
            let means =
                mean_errors(self.campaign, &self.comparison, &self.compensations, &self.options, &mut random);
            progress(draw + 1);
            means.ok()
        })
    }

    /// The comparison by the means of all draws, in order.
    pub fn comparison(self, drawn: Vec<Option<Vec<f64>>>) -> Comparison<'c> {
        let mut comparison = self.comparison;
        // a draw in which a fit fails says nothing about any mode
        let drawn: Vec<Vec<f64>> = drawn.into_iter().flatten().collect();
        comparison.draws = drawn.len();
        let modes: Vec<Mode> = comparison.calibrations.iter().map(|calibration| calibration.mode).collect();
        comparison.intervals = (0..modes.len())
            .map(|m| {
                let samples = drawn.iter().filter_map(|means| means.get(m).copied()).collect();
                interval(comparison.summary(m).mean, samples).0
            })
            .collect();
        let pairs = modes.len() * modes.len().saturating_sub(1) / 2;
        for (m, &mode) in modes.iter().enumerate() {
            for (k, &against) in modes.iter().enumerate().take(m) {
                let difference = comparison.summary(m).mean - comparison.summary(k).mean;
                let of_draw = |means: &Vec<f64>| Some(means.get(m)? - means.get(k)?);
                let (interval, sd) = interval(difference, drawn.iter().filter_map(of_draw).collect());
                comparison.differences.push(Difference {
                    mode,
                    against,
                    mean: difference,
                    interval,
                    // two-sided 5 % over all pairs (Bonferroni), by the normal distribution of a
                    // mean of many errors
                    is_significant: sd > 0.0 && two_sided_normal(difference / sd) * pairs as f64 <= 0.05,
                });
            }
        }
        comparison
    }
}

/// Mean error of every mode in one draw, m.
fn mean_errors(
    campaign: &Campaign,
    comparison: &Comparison,
    compensations: &[Compensation],
    options: &CompareOptions,
    random: &mut Random,
) -> Result<Vec<f64>> {
    let Some(validation) = &campaign.validation else {
        // the folds are what they are: only the poses that are judged are drawn
        let rows = campaign.measurements.bootstrap_rows(random);
        let mean_error = |m: usize| {
            let errors = comparison.errors(m);
            mean(&rows.iter().map(|&row| errors[row]).collect::<Vec<_>>()).unwrap_or(0.0)
        };
        return Ok((0..compensations.len()).map(mean_error).collect());
    };
    let measured = campaign.measurements.subset(&campaign.measurements.bootstrap_rows(random));
    let judged = validation.subset(&validation.bootstrap_rows(random));
    comparison
        .calibrations
        .iter()
        .zip(compensations)
        .map(|(calibration, compensation)| {
            let free: Vec<_> = calibration.parameters.iter().map(|p| p.parameter).collect();
            let setup = setup_from(
                campaign,
                &measured,
                calibration.setup.clone(),
                &free,
                compensation,
                &options.calibration,
            )?;
            let start = calibration.validation.as_ref().and_then(|v| v.placement);
            Ok(validate_from(&setup, &judged, campaign.refit, start)?.summary.mean)
        })
        .collect()
}

/// The bootstrap's interval around an estimate, and the standard deviation of the draws.
///
/// The draws are centred on the estimate: their own mean carries the bias of drawing the same pose
/// twice.
fn interval(estimate: f64, mut samples: Vec<f64>) -> ((f64, f64), f64) {
    let shift = estimate - mean(&samples).unwrap_or(estimate);
    samples.iter_mut().for_each(|sample| *sample += shift);
    let sd = standard_deviation(&samples).unwrap_or(0.0);
    (percentile_interval(&mut samples, 0.95).unwrap_or((f64::NAN, f64::NAN)), sd)
}

/// P(|Z| > |z|) of a standard normal Z: χ² with one degree of freedom.
fn two_sided_normal(z: f64) -> f64 {
    crate::statistics::chi_squared_survival(z * z, 1.0).unwrap_or(1.0)
}
