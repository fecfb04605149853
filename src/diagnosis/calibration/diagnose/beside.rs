//! The robot about which effects are linear: calibrated beside what was found.
//!
//! A calibration that knows of no effect puts it into its parameters as well as it can: a heavier
//! tip becomes a softer wrist, a slipped tool turns joints by milliradians. Columns that are made
//! there are those of another robot. So the campaign is calibrated once more with what was found
//! taken out of its rows, and the search begins anew about that robot, of which nothing is taken
//! out then.

use nalgebra::DVector;

use super::super::model::context::{Context, plausible};
use super::prepared::Prepared;
use crate::calibration::{Calibration, Compensation, Noise, Robust, calibrate_from};
use crate::error::Result;
use crate::inference::{Hypothesis, rms};
use crate::units::URAD;

/// A turn of a joint under its largest torque that changes columns, rad.
const TURNED: f64 = 20.0 * URAD;
/// Share by which the residual of a robot that is calibrated again may differ from what the linear
/// model says of it.
const LINEAR: f64 = 0.1;

/// That robot, the rows as if nothing had been found; `None` where it is the same for all that its
/// columns show.
pub fn calibrated_beside<'c>(
    prepared: &Prepared<'c>,
    hypothesis: &Hypothesis,
    by_linear_model: &DVector<f64>,
) -> Result<Option<Calibration<'c>>> {
    let model = &prepared.model;
    if hypothesis.terms.is_empty() {
        return Ok(None);
    }
    let (campaign, known) = (model.campaign, &model.calibration);
    let found = model.by_row(&model.terms.response(&hypothesis.terms));
    let compensation = Compensation { displaced: found.clone(), ..Compensation::new(campaign, known.mode)? };
    let free: Vec<_> = known.parameters.iter().map(|estimate| estimate.parameter).collect();
    let start = known.start.clone();
    let recording = &campaign.measurements;
    let mut beside = calibrate_from(campaign, recording, start, &free, &compensation, &known.options)?;
    let residual = |row: usize| -beside.deviations[row] * model.scale(row);
    let left = (0..recording.len()).flat_map(|row| <[f64; 3]>::from(residual(row)));
    let left = rms(&DVector::from_iterator(3 * recording.len(), left));
    let expected = rms(&by_linear_model.rows(0, prepared.evidence.recorded).into_owned());
    if !turns(&prepared.context, &beside) && (left - expected).abs() <= LINEAR * expected {
        return Ok(None);
    }
    for (row, found) in found.into_iter().enumerate() {
        beside.deviations[row] -= found;
        beside.deflections[row] -= found;
    }
    Ok(beside.is_converged.then_some(beside))
}

/// True where its drives are otherwise compliant than those that the columns were made with.
fn turns(context: &Context, beside: &Calibration) -> bool {
    let Some(there) = context.configurations.first() else { return false };
    let own = plausible(&beside.setup, &context.softest);
    own.iter()
        .zip(&there.compliance)
        .enumerate()
        .any(|(j, (own, used))| (own - used).abs() * context.largest(|there| there.torque[j]) > TURNED)
}

/// Noise of each clamp's or placement's rows in what a hypothesis leaves, where they scatter
/// unequally.
pub fn unequal(prepared: &Prepared, hypothesis: &Hypothesis, left: &DVector<f64>) -> Result<Option<Noise>> {
    let recording = &prepared.model.campaign.measurements;
    let left = prepared.model.by_row(left);
    let known = Noise { is_stated: false, ..prepared.model.calibration.noise.clone() };
    let rank = prepared.model.calibration.fit.covariance.rank + hypothesis.determined.round() as usize;
    let noise = known.estimate(recording, &left, rank.min(3 * recording.len() - 1), Robust::Huber)?;
    let first = noise.of_group.first().copied().unwrap_or_default();
    Ok(noise.of_group.iter().any(|sd| *sd != first).then_some(noise))
}
