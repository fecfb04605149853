//! The calibration itself: rough start, fit, compensation recomputed until it no longer changes
//! (Eqs 7–14).

use super::before::before;
use super::calibrate_from::calibrate_from;
use super::campaign::{Campaign, Refit, Targets};
use super::compensation::{Compensation, Mode};
use super::extrapolation::{Extrapolation, Known};
use super::options::Options;
use super::prune::pruned;
use super::result::Calibration;
use super::start::{first_guess, rough_start};
use super::validation::{Summary, Validation, validate};
use super::warning::Warning;
use crate::error::Result;
use crate::robot::{Parameter, Setup, minimal_parameters};
use crate::spatial::best_motion;

/// Calibrates the robot of a campaign.
///
/// ```
/// use rodcal::prelude::*;
///
/// // simulated: the robot repeats to 30 µm, and the scanner of the validation is good to 43 µm
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// assert!(calibration.is_converged);
/// let validation = calibration.validation.as_ref().expect("the campaign has validation poses");
/// let rms = validation.summary.rms / 1e-6;
/// assert!((rms - 30f64.hypot(43.0)).abs() < 5.0, "{rms}"); // nothing else is left
/// let a2 = calibration.parameters.iter().find(|p| p.parameter == Parameter::A(1));
/// assert!(a2.is_some_and(|a2| a2.identifiable && (a2.value - 0.425).abs() < 1e-3));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// What [`Compensation::new`] refuses; [`crate::Error::Input`] for fewer measurements than
/// parameters; what the fits refuse. A fit that does not converge is no error: see
/// [`Calibration::is_converged`].
pub fn calibrate<'c>(campaign: &'c Campaign, mode: Mode, options: &Options) -> Result<Calibration<'c>> {
    let compensation = Compensation::new(campaign, mode)?;
    let mut start = start(campaign)?;
    let free = free_parameters(campaign, &start, &compensation);
    // what is not free keeps its nominal value
    for axis in (0..3).filter(|&axis| !free.contains(&Parameter::Tool(axis))) {
        start.tool[axis] = campaign.tool[axis];
    }
    let recording = &campaign.measurements;
    let mut calibration = calibrate_from(campaign, recording, start, &free, &compensation, options)?;
    if options.prune {
        calibration = pruned(campaign, calibration, &compensation, options)?;
    }
    let laws = compensation.use_of_laws(&calibration.setup, recording);
    calibration.warnings.extend(laws.map(|(most, beyond)| Warning::RodLaws { most, beyond }));
    if let Some(recording) = &campaign.validation {
        let recording = match campaign.refit {
            Refit::Nothing => &recording.seen_from(&campaign.measurements, &calibration)?,
            Refit::BaseTool => recording,
        };
        let validation = validate(&calibration.setup, recording, campaign.refit)?;
        if campaign.refit == Refit::Nothing && matches!(recording.targets, Targets::Points(_)) {
            calibration.warnings.extend(seen_from_elsewhere(&validation)?);
        }
        calibration.validation = Some(validation);
        let free: Vec<Parameter> = calibration.parameters.iter().map(|p| p.parameter).collect();
        let covariance = &calibration.fit.covariance.matrix;
        let known = Known { setup: &calibration.setup, free: &free, covariance };
        let extrapolation = Extrapolation::new(&known, &campaign.measurements, recording);
        calibration.warnings.extend(super::checks::extrapolation(&extrapolation));
        calibration.extrapolation = Some(extrapolation);
        calibration.warnings.extend(super::checks::validation_far(&calibration));
    }
    calibration.before = Some(before(campaign, &calibration, &compensation, options)?);
    calibration.warnings.extend(super::checks::worse_than_nominal(&calibration));
    Ok(calibration)
}

/// The nominal robot where the rough start puts it.
///
/// ```
/// use rodcal::calibration::start;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let setup = start(&campaign)?;
/// // close enough for a fit: the campaign states where its base is
/// assert!((0..3).all(|axis| (setup.base().origin[axis] - campaign.base[axis]).abs() < 5e-3));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`crate::linalg::thin_svd`]; none in practice.
pub fn start(campaign: &Campaign) -> Result<Setup<'_>> {
    let (guess, tool) = first_guess(campaign);
    let (base, tool) = rough_start(&campaign.robot, &campaign.measurements, guess, tool)?;
    let mut setup = Setup::new(&campaign.robot, base, tool);
    // corrections are reported relative to the user's guess, unless that is far off
    let turn = nalgebra::Rotation3::from_matrix_unchecked(base.rotation * guess.rotation.transpose());
    if campaign.base_is_given && turn.angle() < 0.5 {
        setup.base_guess = guess;
        setup.base_turn = turn.scaled_axis();
    }
    Ok(setup)
}

/// The complete and minimal set of the robot, with the user's constraints.
///
/// ```
/// use rodcal::calibration::{free_parameters, start};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let compensation = Compensation::new(&campaign, Mode::Fea)?;
/// let free = free_parameters(&campaign, &start(&campaign)?, &compensation);
/// assert_eq!(free.len(), 32); // the paper's Table 1
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn free_parameters(campaign: &Campaign, start: &Setup, compensation: &Compensation) -> Vec<Parameter> {
    let has_world = matches!(campaign.measurements.targets, Targets::Points(_));
    let constraints = &campaign.constraints;
    let minimal = minimal_parameters(&campaign.robot, start.tool, campaign.tool, compensation.payload);
    Parameter::all(campaign.robot.joints.len())
        .into_iter()
        .filter(|p| (minimal.contains(p) && (has_world || !p.is_base())) || constraints.freed.contains(p))
        .filter(|p| !constraints.fixed.contains(p))
        // what is known exactly is no unknown
        .filter(|p| campaign.robot.standard_uncertainty.of(*p) != Some(0.0))
        .collect()
}

/// A warning where a rigid motion of all validation points cures most of their errors: the robot is
/// good, but tracker or base stood elsewhere.
fn seen_from_elsewhere(validation: &Validation) -> Result<Option<Warning>> {
    /// How many times smaller the errors become.
    const CURED: f64 = 3.0;
    /// Poses that a motion of six numbers leaves something of.
    const FEWEST: usize = 6;
    let tips = &validation.tips;
    let points: Vec<_> = tips.iter().zip(&validation.deviations).map(|(tip, off)| tip - off).collect();
    if points.len() < FEWEST {
        return Ok(None);
    }
    let motion = best_motion(&points, tips)?;
    let left: Vec<f64> =
        points.iter().zip(tips).map(|(point, tip)| (motion.point(point) - tip).norm()).collect();
    let (before, after) = (validation.summary.rms, Summary::of(&left).rms);
    Ok((before > CURED * after && before > 0.0).then_some(Warning::ValidationMoved { before, after }))
}
