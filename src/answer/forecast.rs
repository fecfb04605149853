//! What is to be expected of rods and modes before anything is recorded?

use super::{Answer, provenance};
use crate::calibration::{Campaign, planned_setup};
use crate::design::{Budget, Forecaster, Where, rods_and_modes};
use crate::error::Result;
use crate::report;
use crate::report::forecast::Basis;
use crate::rod::Rod;

/// The error budget of the calibrated robot `at` unseen poses, for `rods` (the campaign's own where
/// there are none) and every mode. `count` poses are chosen by O1; without it those of the
/// recording are taken.
///
/// ```
/// use rodcal::answer::forecast;
/// use rodcal::design::{Budget, Where};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
/// let answer = forecast(&campaign, &[], budget, &Where::Validation, None)?;
/// assert_eq!(answer.json["forecasts"][0]["modes"].as_array().map(Vec::len), Some(4));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`rods_and_modes`] and [`Forecaster::new`].
pub fn forecast(
    campaign: &Campaign,
    rods: &[Rod],
    budget: Budget,
    at: &Where,
    count: Option<usize>,
) -> Result<Answer> {
    let rods = rods_and_modes(campaign, rods, &budget, at, count)?;
    let unseen = Forecaster::new(campaign, planned_setup(campaign)?, budget.clone(), at)?.unseen;
    let basis = Basis {
        budget,
        unseen: unseen.description,
        is_aligned: unseen.is_aligned,
        has_clamps: !campaign.clamps.is_empty(),
    };
    let mut report = report::forecast::comparison(campaign, &rods, &basis);
    report.provenance = provenance(campaign);
    Ok(Answer::new(report::forecast::comparison_json(campaign, &rods, &basis), report))
}
