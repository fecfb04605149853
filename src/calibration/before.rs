//! How accurate the robot was before: the nominal one, placed as well as it can be.

use super::calibrate_from::calibrate_from;
use super::campaign::Campaign;
use super::compensation::Compensation;
use super::options::Options;
use super::result::Calibration;
use super::validation::{Before, Summary, validate};
use crate::error::Result;
use crate::robot::Parameter;

/// The nominal robot of `calibration`, with base and tool fitted, the rod compensated in the same
/// way.
///
/// # Errors
/// As [`calibrate_from`].
pub(super) fn before(
    campaign: &Campaign,
    calibration: &Calibration,
    compensation: &Compensation,
    options: &Options,
) -> Result<Before> {
    let placed: Vec<Parameter> =
        calibration.parameters.iter().map(|p| p.parameter).filter(|p| p.is_placement()).collect();
    let start = calibration.start.clone();
    let nominal = calibrate_from(campaign, &campaign.measurements, start, &placed, compensation, options)?;
    let validation = match &campaign.validation {
        Some(recording) => Some(validate(&nominal.setup, recording, campaign.refit)?),
        None => None,
    };
    let residuals = nominal.residuals();
    Ok(Before {
        residual: Summary::of(&residuals),
        residuals,
        validation: validation.as_ref().map(|validation| validation.summary),
        validation_errors: validation.map_or_else(Vec::new, |validation| validation.errors),
    })
}
