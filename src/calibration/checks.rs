//! What the user of a calibration should know: which warnings apply.

use super::campaign::{Campaign, Recording};
use super::extrapolation::{Extrapolation, ranges};
use super::identifiability::{MOST_SCATTER, UnidentifiedDirection, plausible_range};
use super::result::Calibration;
use super::validation::Summary;
use super::warning::Warning;
use crate::robot::{Effect, Parameter, ParameterGroup};
use crate::rod::Rod;

/// All that apply.
pub(super) fn all(campaign: &Campaign, recording: &Recording, calibration: &Calibration) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if !calibration.is_converged {
        warnings.push(Warning::NotConverged {
            reason: calibration.fit.reason.to_string(),
            passes: calibration.passes.len(),
        });
    }
    let rms = calibration.rms();
    if rms > MOST_SCATTER * calibration.reach {
        warnings.push(Warning::NotPlausible { rms, reach: calibration.reach });
    }
    if !campaign.robot.has_masses() {
        let has_effects = campaign.robot.effects.iter().any(Effect::follows_load);
        warnings.push(Warning::NoMasses { has_effects });
    }
    warnings.extend(not_identified(calibration));
    if !calibration.outliers.is_empty() {
        let mut poses: Vec<(String, f64)> = calibration
            .outliers
            .iter()
            .map(|&row| (recording.pose_name(row), calibration.deviations[row].norm()))
            .collect();
        poses.sort_by(|a, b| b.1.total_cmp(&a.1));
        let count_in_full = calibration.outliers.iter().all(|&row| calibration.noise.weights[row] == 1.0);
        warnings.push(Warning::Outliers { poses, count_in_full });
    }
    warnings.extend(unequal_noise(recording, calibration));
    let guessed = campaign.guessed();
    warnings.extend(calibration.parameters.iter().filter_map(|estimate| {
        let correction = estimate.value - estimate.nominal;
        let is_link = match estimate.parameter.group() {
            ParameterGroup::LinkLength | ParameterGroup::LinkTwist | ParameterGroup::JointZero => true,
            ParameterGroup::BasePosition
            | ParameterGroup::BaseRotation
            | ParameterGroup::Compliance
            | ParameterGroup::Tool => false,
        };
        let range = plausible_range(estimate.parameter, &[]);
        let is_link = is_link && guessed != Some(estimate.parameter);
        (is_link && estimate.identifiable && correction.abs() > range)
            .then_some(Warning::Implausible { parameter: estimate.parameter, correction })
    }));
    warnings.extend(far_from_drawing(calibration, guessed));
    warnings.extend(campaign.rod.as_ref().and_then(|rod| tip_elsewhere(rod, calibration)));
    warnings
}

/// A share of a rod's length by which no drawing and no mounting is off.
const OFF_TIP: f64 = 0.05;

/// Where the calibrated tip is not the rod's.
fn tip_elsewhere(rod: &Rod, calibration: &Calibration) -> Option<Warning> {
    let (calibrated, of_rod) = (calibration.setup.tool, rod.tip());
    let is_far = (calibrated - of_rod).norm() > OFF_TIP * rod.length().max(calibrated.norm());
    is_far.then_some(Warning::TipElsewhere { calibrated, of_rod })
}

/// So many standard uncertainties of the robot file are worth a word.
const FAR: f64 = 10.0;

/// Numbers that the data put far from where the robot file has them, but not farther than a robot
/// can be.
fn far_from_drawing(calibration: &Calibration, guessed: Option<Parameter>) -> impl Iterator<Item = Warning> {
    let known = &calibration.setup.robot.standard_uncertainty;
    calibration.parameters.iter().filter_map(move |estimate| {
        let parameter = estimate.parameter;
        let is_drawn = |sd: &f64| *sd > 0.0 && guessed != Some(parameter);
        let standard_uncertainty = known.of(parameter).filter(is_drawn)?;
        let correction = estimate.value - estimate.nominal;
        let is_far = correction.abs() > FAR * standard_uncertainty
            && correction.abs() <= plausible_range(parameter, &[]);
        (is_far && estimate.identifiable).then_some(Warning::FarFromDrawing {
            parameter,
            correction,
            standard_uncertainty,
        })
    })
}

/// A validation whose mean error is larger by this factor is worse, and not by chance.
const WORSE: f64 = 1.2;

/// Where the nominal robot predicts the validation better than the calibrated one.
pub(super) fn worse_than_nominal(calibration: &Calibration) -> Option<Warning> {
    let before = calibration.before.as_ref()?.validation?.mean;
    let after = calibration.validation.as_ref()?.summary.mean;
    (after > WORSE * before).then_some(Warning::WorseThanNominal { before, after })
}

/// A validation whose mean error is larger than that of the calibration's own poses by this factor
/// is not only measured less accurately.
const FAR_OFF: f64 = 3.0;

/// Where the validation is far worse than the poses of the calibration; not where it is known to be
/// seen from elsewhere.
pub(super) fn validation_far(calibration: &Calibration) -> Option<Warning> {
    let is_moved = |warning: &Warning| matches!(warning, Warning::ValidationMoved { .. });
    let there = calibration.validation.as_ref()?.summary.mean;
    let here = Summary::of(&calibration.residuals()).mean;
    let is_far = there > FAR_OFF * here && calibration.is_plausible();
    (is_far && !calibration.warnings.iter().any(is_moved)).then_some(Warning::ValidationFar { there, here })
}

/// Poses that make the robot so many times more uncertain than those of the calibration are worth a
/// word; where joints go beyond their range, so many.
const MORE_UNCERTAIN: f64 = 2.0;
const MORE_UNCERTAIN_BEYOND: f64 = 1.5;

/// Where poses are asked for that the calibration has not seen.
pub(super) fn extrapolation(extrapolation: &Extrapolation) -> Option<Warning> {
    let joints = extrapolation.joints_beyond();
    let most = if joints.is_empty() { MORE_UNCERTAIN } else { MORE_UNCERTAIN_BEYOND };
    let ratio = extrapolation.ratio();
    let beyond = |(joint, asked, own): (usize, (f64, f64), (f64, f64))| {
        (joint, ranges(asked, own, extrapolation.motions[joint]))
    };
    (ratio > most).then(|| Warning::Extrapolation { ratio, joints: joints.into_iter().map(beyond).collect() })
}

fn not_identified(calibration: &Calibration) -> Vec<Warning> {
    /// Combinations that are named one by one.
    const FEW: usize = 3;
    if calibration.held.len() > FEW {
        let parameters =
            calibration.parameters.iter().filter(|p| !p.identifiable).map(|p| p.parameter).collect();
        return vec![Warning::ManyNotIdentified { combinations: calibration.held.len(), parameters }];
    }
    let describe = |held: &UnidentifiedDirection| {
        let mut combination: Vec<(Parameter, f64)> = calibration
            .parameters
            .iter()
            .zip(&held.direction)
            .map(|(estimate, &coefficient)| (estimate.parameter, coefficient))
            .filter(|(_, coefficient)| coefficient.abs() > 0.1)
            .collect();
        combination.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        Warning::NotIdentified { combination, relative_error: held.relative_error }
    };
    calibration.held.iter().map(describe).collect()
}

fn unequal_noise(recording: &Recording, calibration: &Calibration) -> Option<Warning> {
    let noise = &calibration.noise;
    let p_value = noise.p_equal?;
    let named = recording.groups.iter().zip(&noise.of_group).map(|(group, &sd)| (group.name.to_string(), sd));
    let quietest = named.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let noisiest = named.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (noisiest.1 > quietest.1).then_some(Warning::UnequalNoise { quietest, noisiest, p_value })
}
