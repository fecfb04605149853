//! How far a frame moved: first as the search has it, then as the calibration measures it.

use nalgebra::Rotation3;

use super::moves::turn;
use crate::calibration::Calibration;
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::effects::mounting::BASE_SHIFT;
use crate::inference::{Estimate, Finding, Location};
use crate::spatial::Pose;
use crate::statistics::HALF_95;

/// How far the base moved by the calibration of `recording`, with 95 % intervals: the frame of a
/// station is six of its unknowns. Of several moves the order is that of the rows.
pub fn measure_moves(recording: &Recording, calibration: &Calibration, findings: &mut [Finding]) {
    let rows = recording.rows.windows(2).filter(|pair| pair[0].station != pair[1].station);
    let places: Vec<(usize, usize)> = rows.map(|pair| (pair[0].station, pair[1].station)).collect();
    let row_of = |finding: &Finding| match (&finding.location, finding.effect == &BASE_SHIFT.effect) {
        (Location::Shift { row, .. }, true) => Some(*row),
        _ => None,
    };
    let mut moves: Vec<&mut Finding> =
        findings.iter_mut().filter(|finding| row_of(finding).is_some()).collect();
    moves.sort_by_key(|finding| row_of(finding));
    if moves.len() != places.len() {
        return;
    }
    let base = calibration.setup.base();
    let base_at = |station: usize| {
        let frame = calibration.stations[station].then(&recording.stations[station].frame);
        frame.inverse().then(&base)
    };
    let free = calibration.parameters.len();
    let variance = |station: usize, k: usize| match station {
        0 => 0.0,
        station => {
            let at = free + 6 * (station - 1) + k;
            calibration.fit.covariance.matrix.get((at, at)).copied().unwrap_or(0.0)
        }
    };
    for (finding, (before, after)) in moves.into_iter().zip(places) {
        let mut estimates = motion_estimates(&base_at(before), &base_at(after));
        for (k, estimate) in estimates.iter_mut().enumerate() {
            let half = HALF_95 * (variance(before, k) + variance(after, k)).max(0.0).sqrt();
            (estimate.low, estimate.high) = (estimate.value - half, estimate.value + half);
        }
        finding.estimates = estimates;
    }
}

/// The way from one pose to another, and the turn.
pub fn motion_estimates(from: &Pose, to: &Pose) -> Vec<Estimate> {
    let way = to.origin - from.origin;
    let turn = Rotation3::from_matrix_unchecked(to.rotation * from.rotation.transpose()).scaled_axis();
    let names = ["dx_um", "dy_um", "dz_um", "rx_urad", "ry_urad", "rz_urad"];
    let values = [way.x, way.y, way.z, turn.x, turn.y, turn.z];
    let estimate = |(k, name): (usize, &&str)| Estimate::new(*name, values[k], values[k], values[k]);
    names.iter().enumerate().map(estimate).collect()
}

/// How far, m, and by which angle, rad, a base moved.
pub fn moved(from: &Pose, to: &Pose) -> (f64, f64) {
    ((to.origin - from.origin).norm(), turn(&from.rotation, &to.rotation))
}
