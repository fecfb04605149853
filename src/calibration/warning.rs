//! What the user of a calibration should know, as data; its `Display` is the advice.

use std::fmt;

use super::calibrate::Calibration;
use super::campaign::{Campaign, Recording};
use super::compensation::Compensation;

/// What the user of a calibration should know.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// The fit or the compensation loop did not come to rest.
    NotConverged(String),
    /// The robot's file has no masses.
    NoMasses,
}

/// All that apply.
pub(super) fn all(
    campaign: &Campaign,
    _recording: &Recording,
    calibration: &Calibration,
    _compensation: &Compensation,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if !calibration.is_converged {
        warnings.push(Warning::NotConverged(calibration.fit.reason.to_string()));
    }
    if !campaign.robot.has_masses() {
        warnings.push(Warning::NoMasses);
    }
    warnings
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::NotConverged(why) => write!(f, "the calibration did not come to rest ({why})"),
            Warning::NoMasses => write!(f, "the robot's file has no masses: joint compliances are off"),
        }
    }
}
