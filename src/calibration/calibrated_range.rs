//! Where a robot was calibrated, to be written beside what was found.

use super::campaign::Recording;
use super::extrapolation::{Known, sd};
use super::result::Calibration;
use crate::robot::{CalibratedRange, Parameter};

/// The poses of a calibration, for those who ask for others.
pub(super) fn calibrated_range(calibration: &Calibration, recording: &Recording) -> CalibratedRange {
    let free: Vec<Parameter> = calibration.parameters.iter().map(|p| p.parameter).collect();
    let known =
        Known { setup: &calibration.setup, free: &free, covariance: &calibration.fit.covariance.matrix };
    let range = |joint: usize| {
        let values = (0..recording.len()).map(|row| recording.joints(row)[joint]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)))
    };
    let joints = (0..calibration.setup.robot.joints.len()).map(range).collect();
    CalibratedRange { joints, sd: sd(&known, recording) }
}
