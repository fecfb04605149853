//! What happened while a validation was recorded: a socket that moved there, or a base that
//! drifted, is no error of the robot.
//!
//! The validation is diagnosed as a campaign of its own, with the calibrated robot as it is known.

use nalgebra::Vector3;

use crate::calibration::campaign::{Campaign, ParameterConstraints, Refit, Targets};
use crate::calibration::{Calibration, Mode, Options, Summary, validate};
use crate::diagnosis::calibration::OwnEvents;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Neighbours, mend};
use crate::error::Result;
use crate::inference::{Finding, WrittenTo};

/// Without it the error is so many times smaller, or it is not what makes the error.
const HELPS: f64 = 1.2;
/// So many rivals of a cause are said.
const RIVALS_SAID: usize = 2;

/// Events of the validation of `campaign`, which `calibration` has calibrated; `None` where there
/// is none that makes a difference.
///
/// # Errors
/// As [`mend`].
pub fn own_events(campaign: &Campaign, calibration: &Calibration) -> Result<Option<OwnEvents>> {
    let Some((recording, own)) = campaign.validation.as_ref().zip(of_validation(campaign, calibration))
    else {
        return Ok(None);
    };
    // too few poses for a diagnosis show no event
    let Ok(mended) = mend(&own, Mode::None, &Neighbours::default(), &Options::default()) else {
        return Ok(None);
    };
    let Ok(mut found) = mended.diagnose() else { return Ok(None) };
    // what would belong to the robot is an error of the calibrated one
    found.diagnosis.findings.retain(|own| own.written_to != WrittenTo::Model || !own.is_of_model());
    let causes = found.diagnosis.findings.iter().map(cause).collect::<Vec<_>>();
    let before = validate(&calibration.setup, recording, campaign.refit)?.summary.mean;
    let errors = errors_without(&found, calibration, campaign.refit)?;
    let is_less = before > HELPS * Summary::of(&errors).mean;
    Ok((!causes.is_empty() && is_less).then_some(OwnEvents { causes, errors }))
}

/// A finding with what the poses cannot distinguish from it, in words.
fn cause(finding: &Finding) -> String {
    let others = finding.other_effects().into_iter().take(RIVALS_SAID);
    let others = others.map(|(effect, place)| (effect.cause_at)(&place));
    let all: Vec<String> =
        std::iter::once((finding.effect.cause_at)(&finding.location)).chain(others).collect();
    all.join(", or ")
}

/// Errors of the calibrated robot at its validation, m, without what was `found` there.
fn errors_without(found: &CalibrationDiagnosis, calibration: &Calibration, refit: Refit) -> Result<Vec<f64>> {
    let model = &found.model;
    let mut recording = model.campaign.measurements.clone();
    let mut moved = vec![Vector3::zeros(); recording.len()];
    for finding in found.diagnosis.findings.iter().filter(|finding| finding.is_of_model()) {
        let own = model.by_row(&model.response_of(finding));
        moved.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }
    if let Targets::Points(points) = &mut recording.targets {
        points.iter_mut().zip(&moved).for_each(|(point, moved)| *point -= moved);
        return Ok(validate(&calibration.setup, &recording, refit)?.errors);
    }
    // of a socket nothing was measured: its tips are where it was less what it moved
    let tips = validate(&calibration.setup, &recording, refit)?.tips;
    let tips: Vec<_> = tips.iter().zip(&moved).map(|(tip, moved)| tip + moved).collect();
    Ok(recording.minus_group_means(&tips).iter().map(|off| off.norm()).collect())
}

/// The validation's poses as a recording of the calibrated robot: without rod and clamps, and with
/// its numbers as uncertain as the calibration has left them.
fn of_validation(campaign: &Campaign, calibration: &Calibration) -> Option<Campaign> {
    let mut own = campaign.clone();
    own.measurements = own.validation.take()?;
    own.robot = calibration.setup.calibrated();
    (own.rod, own.readings, own.contact_force, own.clamps) = (None, None, None, Vec::new());
    (own.noise, own.clamp_uncertainty) = (None, None);
    own.warnings.clear();
    let validation = calibration.validation.as_ref()?;
    let (base, tool) = validation.placement.unwrap_or((calibration.setup.base(), calibration.setup.tool));
    let [roll, pitch, yaw] = base.roll_pitch_yaw();
    own.base = [base.origin.x, base.origin.y, base.origin.z, roll, pitch, yaw];
    (own.base_is_given, own.tool, own.tool_is_given) = (true, tool, true);
    own.constraints = ParameterConstraints::default();
    for estimate in &calibration.parameters {
        let (parameter, value) = (estimate.parameter, estimate.value);
        if parameter.is_placement() && validation.placement.is_some() {
            continue;
        }
        match estimate.std_error.filter(|error| *error > 0.0) {
            Some(error) => own.constraints.priors.push((parameter, value, error)),
            None => own.constraints.fixed.push(parameter),
        }
    }
    Some(own)
}
