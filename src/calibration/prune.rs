//! Numbers of the robot that the data do not support are held where the drawing has them.
//!
//! A correction that is smaller than its standard error improves no prediction: what it takes out
//! of the bias it adds, and more, in variance. The least supported go first, for what is held
//! decides what the others are worth.

use super::calibrate_from::calibrate_from;
use super::campaign::Campaign;
use super::compensation::Compensation;
use super::options::Options;
use super::result::{Calibration, Estimated};
use crate::error::Result;
use crate::robot::Parameter;

/// Of the numbers that are not supported so many go at a time.
const SHARE: f64 = 1.0 / 3.0;

/// `calibration` with all that its data do not support held at nominal values.
///
/// # Errors
/// As [`calibrate_from`].
pub(super) fn pruned<'c>(
    campaign: &'c Campaign,
    mut calibration: Calibration<'c>,
    compensation: &Compensation,
    options: &Options,
) -> Result<Calibration<'c>> {
    loop {
        let support = |p: &Estimated| match p.std_error {
            Some(error) => (p.value - p.nominal).abs() / error.max(f64::MIN_POSITIVE),
            None => 0.0,
        };
        let own = calibration.parameters.iter().filter(|p| !p.parameter.is_placement());
        let mut unsupported: Vec<(f64, Parameter)> =
            own.filter(|p| !p.is_supported()).map(|p| (support(p), p.parameter)).collect();
        if unsupported.is_empty() {
            return Ok(calibration);
        }
        unsupported.sort_by(|a, b| a.0.total_cmp(&b.0));
        unsupported.truncate((SHARE * unsupported.len() as f64).ceil() as usize);
        let is_held = |parameter: &Parameter| unsupported.iter().any(|(_, held)| held == parameter);
        let free: Vec<Parameter> =
            calibration.parameters.iter().map(|p| p.parameter).filter(|p| !is_held(p)).collect();
        let start = calibration.start.clone();
        calibration = calibrate_from(campaign, &campaign.measurements, start, &free, compensation, options)?;
    }
}
