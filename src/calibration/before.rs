//! How accurate the robot was before: the nominal one, placed as well as it can be.

use super::calibrate::calibrate_from;
use super::campaign::Campaign;
use super::compensation::Compensation;
use super::options::Options;
use super::result::Calibration;
use super::validation::{Summary, validate};
use crate::error::Result;
use crate::robot::Parameter;

/// Errors of the nominal robot at the poses of a campaign.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Before {
    /// Of the calibration's poses: only where the robot stands and where its tip is (or where the
    /// sockets are) was fitted to them.
    pub residual: Summary,
    /// Of the validation's poses; `None` without a validation.
    pub validation: Option<Summary>,
}

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
        calibration.parameters.iter().map(|p| p.parameter).filter(Parameter::is_placement).collect();
    let start = calibration.start.clone();
    let nominal = calibrate_from(campaign, &campaign.measurements, start, &placed, compensation, options)?;
    let validation = match &campaign.validation {
        Some(recording) => Some(validate(&nominal.setup, recording, campaign.refit)?.summary),
        None => None,
    };
    Ok(Before { residual: Summary::of(&nominal.residuals()), validation })
}
