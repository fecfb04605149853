//! Residuals by clamp or socket.

use crate::calibration::campaign::Recording;
use crate::calibration::{Calibration, Summary};

/// Name, number of poses and residuals of every clamp or socket.
pub(super) fn group_summaries(
    recording: &Recording,
    calibration: &Calibration,
) -> Vec<(String, usize, Summary)> {
    let residuals = calibration.residuals();
    recording
        .groups
        .iter()
        .enumerate()
        .map(|(index, group)| {
            let lengths: Vec<f64> = recording
                .rows
                .iter()
                .zip(&residuals)
                .filter(|(row, _)| row.group == index)
                .map(|(_, &residual)| residual)
                .collect();
            let name = if group.name.is_tracked() { "all poses".to_owned() } else { group.name.to_string() };
            (name, lengths.len(), Summary::of(&lengths))
        })
        .collect()
}
