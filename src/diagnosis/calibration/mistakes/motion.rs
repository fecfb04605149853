//! How far a frame moved: first as the search has it, then as the calibration measures it.

use nalgebra::Rotation3;

use super::moves::turn;
use crate::calibration::Calibration;
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::diagnose::beside::{Loads, calibrated_with};
use crate::diagnosis::calibration::effects::mounting::BASE_SHIFT;
use crate::diagnosis::calibration::model::CalibrationModel;
use crate::error::Result;
use crate::inference::{Estimate, Finding, Hypothesis, Location, Term};
use crate::spatial::Pose;
use crate::statistics::HALF_95;

/// True where a base that moved is among the findings.
pub fn has_moved(findings: &[Finding]) -> bool {
    findings.iter().any(|finding| finding.effect == &BASE_SHIFT.effect)
}

/// Calibrations beside what a diagnosis has found: the likeliest, then one for each direction in
/// which what was found is uncertain, a standard deviation farther; none where nothing was found,
/// or where the likeliest does not converge.
///
/// # Errors
/// As [`calibrated_with`].
pub fn beside_found<'c>(
    model: &CalibrationModel<'c>,
    hypothesis: &Hypothesis,
) -> Result<Vec<Calibration<'c>>> {
    if hypothesis.terms.is_empty() {
        return Ok(Vec::new());
    }
    let beside = |terms: &[Term]| -> Result<Option<Calibration<'c>>> {
        Ok(calibrated_with(model, &Loads::of(model, terms))?.map(|beside| beside.calibration))
    };
    let Some(likeliest) = beside(&hypothesis.terms)? else { return Ok(Vec::new()) };
    let mut all = vec![likeliest];
    let spread = hypothesis.covariance.clone().symmetric_eigen();
    for (variance, direction) in spread.eigenvalues.iter().zip(spread.eigenvectors.column_iter()) {
        let mut terms = hypothesis.terms.clone();
        let values = terms.iter_mut().flat_map(|term| &mut term.values);
        values.zip(&direction).for_each(|(value, along)| *value += variance.max(0.0).sqrt() * along);
        all.extend(beside(&terms)?);
    }
    Ok(all)
}

/// How far the base moved by the first of some calibrations of `recording`, with 95 % intervals:
/// the frame of a station is six of its unknowns. Of several moves the order is that of the rows.
///
/// The others are those beside what was found, as far off as that is uncertain:
///
/// var m = var m | found + Σₖ (mₖ − m)²
pub fn measure_moves(recording: &Recording, calibrations: &[&Calibration], findings: &mut [Finding]) {
    let rows = recording.rows.windows(2).filter(|pair| pair[0].station != pair[1].station);
    let places: Vec<(usize, usize)> = rows.map(|pair| (pair[0].station, pair[1].station)).collect();
    let row_of = |finding: &Finding| match (&finding.location, finding.effect == &BASE_SHIFT.effect) {
        (Location::Shift { row, .. }, true) => Some(*row),
        _ => None,
    };
    let mut moves: Vec<&mut Finding> =
        findings.iter_mut().filter(|finding| row_of(finding).is_some()).collect();
    moves.sort_by_key(|finding| row_of(finding));
    let Some((calibration, others)) = calibrations.split_first().filter(|_| moves.len() == places.len())
    else {
        return;
    };
    let base_at = |calibration: &Calibration, station: usize| {
        let frame = calibration.stations[station].then(&recording.stations[station].frame);
        frame.inverse().then(&calibration.setup.base())
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
        let moved = |own: &Calibration| motion_estimates(&base_at(own, before), &base_at(own, after));
        let mut estimates = moved(calibration);
        let others: Vec<Vec<Estimate>> = others.iter().map(|other| moved(other)).collect();
        for (k, estimate) in estimates.iter_mut().enumerate() {
            let apart = others.iter().map(|other| (other[k].value - estimate.value).powi(2));
            let variance = (variance(before, k) + variance(after, k)).max(0.0) + apart.sum::<f64>();
            let half = HALF_95 * variance.sqrt();
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
