//! What findings are worth at the validation of a campaign, of which no search has seen anything.

mod one_number;
mod own;

use self::own::own_diagnosis;
use super::CalibrationDiagnosis;
use super::model::validated::{Validated, mean};
use super::write_back::extended::Extended;
use crate::calibration::{Calibration, Options, calibrate};
use crate::error::Result;
use crate::inference::{Finding, Kind, WrittenTo};

/// Looks at the validation of a campaign that was diagnosed: its poses are predicted by the
/// calibration as it is, and by one with what was found. Where they are far from what the poses of
/// the recording lead to expect, they are diagnosed too. The answer is in
/// [`CalibrationModel::validated`](super::CalibrationModel::validated); nothing is looked at
/// without a validation, and where the calibration means nothing.
///
/// ```
/// use rodcal::diagnosis::calibration::{diagnose_as_recorded, look_at_validation};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let mut found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default())?;
/// look_at_validation(&mut found)?;
/// let validated = found.model.validated.expect("the campaign has validation poses");
/// assert!(!validated.is_far());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`validate`](crate::calibration::validate).
pub fn look_at_validation(found: &mut CalibrationDiagnosis) -> Result<()> {
    found.model.validated = validated(found)?;
    Ok(())
}

fn validated(found: &CalibrationDiagnosis) -> Result<Option<Validated>> {
    let calibration = &found.model.calibration;
    let is_spoilt = |own: &Finding| own.kind() == Kind::Mistake && own.written_to == WrittenTo::Nowhere;
    if found.is_implausible() || !calibration.is_converged || found.diagnosis.findings.iter().any(is_spoilt) {
        return Ok(None);
    }
    let Some(before) = errors(calibration) else { return Ok(None) };
    let extended = Extended::of(found);
    // one that cannot be calibrated is worth nothing there
    let again = extended
        .as_ref()
        .and_then(|own| calibrate(&own.campaign, calibration.mode, &Options::default()).ok());
    let after = again.as_ref().and_then(errors);
    let (expected, is_held_out) = expected(found);
    let mut validated = Validated { before, after, expected, is_held_out, own: None };
    if validated.is_far() {
        let campaign = extended.as_ref().map_or(found.model.campaign, |extended| &extended.campaign);
        validated.own = own_diagnosis(campaign, again.as_ref().unwrap_or(calibration))?;
    }
    Ok(Some(validated))
}

/// Mean error that the recording leads to expect, m, and whether it is of poses held out.
fn expected(found: &CalibrationDiagnosis) -> (f64, bool) {
    let held_out = found.diagnosis.held_out.as_ref().map(|held_out| &held_out.errors_after);
    let lengths = found.model.by_row(held_out.unwrap_or(&found.diagnosis.after)).into_iter();
    let lengths: Vec<f64> = lengths.map(|row| row.norm()).filter(|length| length.is_finite()).collect();
    (mean(&lengths), held_out.is_some())
}

fn errors(calibration: &Calibration) -> Option<Vec<f64>> {
    calibration.validation.as_ref().map(|validation| validation.errors.clone())
}
