//! What happened while a validation was recorded: a socket that moved there, or a base that
//! drifted, is no error of the robot.
//!
//! The validation is diagnosed as a campaign of its own, with the calibrated robot as it is known.

use nalgebra::Vector3;

use super::one_number::{CURED, changed};
use crate::calibration::campaign::{Campaign, ParameterConstraints, Recording, Refit, Targets};
use crate::calibration::{Calibration, Mode, Options, Summary, Validation, Warning, validate};
use crate::diagnosis::calibration::{CalibrationDiagnosis, Neighbours, OwnDiagnosis, mend};
use crate::error::Result;
use crate::inference::{Discrepancy, Finding, Location, WrittenTo};
use crate::spatial::Pose;

/// Without it the error is so many times smaller, or it is not what makes the error.
const HELPS: f64 = 1.2;
/// So many rivals of a cause are said.
const RIVALS_SAID: usize = 2;

/// What the validation of `campaign`, which `calibration` has calibrated, shows by itself; `None`
/// where it has too few poses to show anything.
///
/// # Errors
/// As [`validate`].
pub fn own_diagnosis(campaign: &Campaign, calibration: &Calibration) -> Result<Option<OwnDiagnosis>> {
    let Some(recording) = &campaign.validation else { return Ok(None) };
    let before = validate(&calibration.setup, recording, campaign.refit)?;
    let (placed, elsewhere) = placed(campaign, calibration, recording, &before)?;
    let changed = changed(&calibration.setup, recording, placed.refit, &placed)?;
    let mut events: Vec<String> = elsewhere.map(str::to_owned).into_iter().collect();
    let (mut calibration, mut placed, mut own) = (calibration.clone(), placed, campaign.clone());
    if let Some(changed) = changed {
        events.push(changed.cause(&calibration));
        placed = validate(&changed.setup, &changed.recording, placed.refit)?;
        calibration.setup = changed.setup;
        own.validation = Some(changed.recording);
    }
    let Some(own) = of_validation(own, &calibration, placed.placement) else { return Ok(None) };
    let (none, options) = (Neighbours::default(), Options::default());
    let Ok(mended) = mend(&own, Mode::None, &none, &options) else { return Ok(None) };
    let Ok(found) = mended.diagnose() else { return Ok(None) };
    // what would belong to the robot is an error of the calibrated one
    let is_of_robot = |own: &&Finding| own.written_to == WrittenTo::Model && own.is_of_model();
    let (of_robot, of_poses): (Vec<_>, Vec<_>) = found.diagnosis.findings.iter().partition(is_of_robot);
    events.extend(of_poses.iter().map(|finding| cause(finding)));
    let mut moved = displacement(&found, &of_poses);
    let mut unexplained = unexplained(&found);
    // nor does what follows the time alone belong to it
    if let Some(left) = found.diagnosis.discrepancy.as_ref().filter(|left| is_of_time(left))
        && let Some(of_time) = unexplained.take()
    {
        events.push(format!("an unexplained error, which {of_time}"));
        moved.iter_mut().zip(found.model.by_row(&left.shape)).for_each(|(sum, own)| *sum += own);
    }
    let errors = errors_without(&mended.campaign.measurements, &moved, &calibration, placed.refit)?;
    let is_less = before.summary.mean > HELPS * Summary::of(&errors).mean;
    let (events, errors) = if is_less { (events, errors) } else { (Vec::new(), before.errors) };
    let of_robot = of_robot.iter().map(|finding| cause(finding)).collect();
    let scatter = found.diagnosis.noise;
    Ok(Some(OwnDiagnosis { events, errors, of_robot, unexplained, scatter }))
}

/// The validation with base and tool fitted again, and in words why, where the calibrated robot
/// predicts it far worse without.
fn placed(
    campaign: &Campaign,
    calibration: &Calibration,
    recording: &Recording,
    before: &Validation,
) -> Result<(Validation, Option<&'static str>)> {
    if (campaign.refit, matches!(recording.targets, Targets::Points(_))) != (Refit::Nothing, true) {
        return Ok((before.clone(), None));
    }
    let again = validate(&calibration.setup, recording, Refit::BaseTool)?;
    let is_moved = |warning: &Warning| matches!(warning, Warning::ValidationMoved { .. });
    let elsewhere = match calibration.warnings.iter().any(is_moved) {
        true => "another place of tracker or base",
        false => "another tool",
    };
    match before.summary.rms > CURED * again.summary.rms {
        true => Ok((again, Some(elsewhere))),
        false => Ok((before.clone(), None)),
    }
}

/// What an error without a name follows.
fn unexplained(found: &CalibrationDiagnosis) -> Option<String> {
    let left = found.diagnosis.discrepancy.as_ref()?;
    Some(match &left.location {
        Some(Location::Curve { follows, .. }) => follows.clone(),
        _ => String::new(),
    })
}

fn is_of_time(left: &Discrepancy) -> bool {
    matches!(&left.location, Some(Location::Curve { along: Some(along), .. }) if along.is_of_time())
}

/// A finding with what the poses cannot distinguish from it, in words.
fn cause(finding: &Finding) -> String {
    let own = (finding.effect.cause_at)(&finding.location);
    let mut said = finding.other_causes();
    said.truncate(RIVALS_SAID);
    // elsewhere too, as signs of other axes beside one
    if finding.others().len() > said.len() {
        said.push("others".into());
    }
    std::iter::once(own).chain(said).collect::<Vec<_>>().join(", or ")
}

/// What findings do to each row, m.
fn displacement(found: &CalibrationDiagnosis, findings: &[&Finding]) -> Vec<Vector3<f64>> {
    let model = &found.model;
    let mut moved = vec![Vector3::zeros(); model.campaign.measurements.len()];
    for finding in findings.iter().filter(|finding| finding.is_of_model()) {
        let own = model.by_row(&model.response_of(finding));
        moved.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
    }
    moved
}

/// Errors of the calibrated robot at the poses of a recording, m, without what `moved` each row.
fn errors_without(
    recording: &Recording,
    moved: &[Vector3<f64>],
    calibration: &Calibration,
    refit: Refit,
) -> Result<Vec<f64>> {
    let mut recording = recording.clone();
    if let Targets::Points(points) = &mut recording.targets {
        points.iter_mut().zip(moved).for_each(|(point, moved)| *point -= moved);
        return Ok(validate(&calibration.setup, &recording, refit)?.errors);
    }
    // of a socket nothing was measured: its tips are where it was less what it moved
    let tips = validate(&calibration.setup, &recording, refit)?.tips;
    let tips: Vec<_> = tips.iter().zip(moved).map(|(tip, moved)| tip + moved).collect();
    Ok(recording.minus_group_means(&tips).iter().map(|off| off.norm()).collect())
}

/// The validation's poses as a recording of the calibrated robot: without rod and clamps, and with
/// its numbers as uncertain as the calibration has left them.
fn of_validation(
    mut own: Campaign,
    calibration: &Calibration,
    placement: Option<(Pose, Vector3<f64>)>,
) -> Option<Campaign> {
    own.measurements = own.validation.take()?;
    own.robot = calibration.setup.calibrated();
    (own.rod, own.readings, own.contact_force, own.clamps) = (None, None, None, Vec::new());
    (own.noise, own.clamp_uncertainty) = (None, None);
    own.warnings.clear();
    let (base, tool) = placement.unwrap_or((calibration.setup.base(), calibration.setup.tool));
    let [roll, pitch, yaw] = base.roll_pitch_yaw();
    own.base = [base.origin.x, base.origin.y, base.origin.z, roll, pitch, yaw];
    (own.base_is_given, own.tool, own.tool_is_given) = (true, tool, true);
    own.constraints = ParameterConstraints::default();
    for estimate in &calibration.parameters {
        let (parameter, value) = (estimate.parameter, estimate.value);
        if parameter.is_placement() && placement.is_some() {
            continue;
        }
        match estimate.std_error.filter(|error| *error > 0.0) {
            Some(error) => own.constraints.priors.push((parameter, value, error)),
            None => own.constraints.fixed.push(parameter),
        }
    }
    Some(own)
}
