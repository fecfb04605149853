//! The calibration itself: rough start, fit, compensation recomputed until it no longer changes (Eqs
//! 7–14).

use super::campaign::{Campaign, Recording, Targets};
use super::compensation::{Compensation, Mode};
use super::identifiability;
use super::observability::Observability;
use super::options::Options;
use super::passes::Run;
use super::problem::Residuals;
use super::result::{Calibration, Estimated};
use super::start::{first_guess, rough_start};
use super::validation::validate;
use crate::error::{Error, Place, Result};
use crate::robot::{Kinematics, Parameter, Setup, minimal_parameters};

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
/// What [`Compensation::new`] refuses; [`Error::Input`] for fewer measurements than parameters;
/// what the fits refuse. A fit that does not converge is no error: see
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
    if let Some(recording) = &campaign.validation {
        calibration.validation = Some(validate(&calibration.setup, recording, campaign.refit)?);
    }
    Ok(calibration)
}

/// Calibrates `free` parameters on a recording, from a given start, without validation: for folds
/// and bootstrap samples.
///
/// # Errors
/// As [`calibrate`].
pub fn calibrate_from<'c>(
    campaign: &'c Campaign,
    recording: &Recording,
    start: Setup<'c>,
    free: &[Parameter],
    compensation: &Compensation,
    options: &Options,
) -> Result<Calibration<'c>> {
    check_count(recording, free)?;
    let nominal = start.clone();
    let mut run = Run::new(campaign, recording, start, free, compensation);
    run.fit_base_and_tool()?;
    let fit = run.compensate(options)?;
    let Run { setup, pass, noise, held, passes, is_converged, .. } = run;

    let problem = Residuals { setup: setup.clone(), free, recording, pass: &pass, held: &held };
    let deviations = problem.deviations(&fit.parameters);
    let errors = fit.standard_errors();
    let identified = identifiability::identified(&held, free.len());
    let parameters = free
        .iter()
        .enumerate()
        .map(|(k, &parameter)| Estimated {
            parameter,
            nominal: nominal.get(parameter),
            value: setup.get(parameter),
            std_error: errors[k]
                .filter(|_| identified[k])
                .map(|e| e.hypot(identifiability::unidentified_range(&held, k))),
            identifiable: identified[k] && errors[k].is_some(),
        })
        .collect();
    let sockets = (0..problem.socket_count())
        .map(|socket| {
            [0, 1, 2].map(|axis| {
                let k = free.len() + 3 * socket + axis;
                (fit.parameters[k], errors[k])
            })
        })
        .collect();
    let mut kinematics = Kinematics::new(&setup);
    let (tips, deflections) = (0..recording.len())
        .map(|row| {
            kinematics.update(recording.joints(row), pass.torque(recording, row));
            (kinematics.tip, kinematics.flange.rotation * pass.deflection[row])
        })
        .unzip();
    let observability = Observability::new(&problem, &fit.parameters)?;
    let outliers = noise.outliers(recording, &deviations)?;
    let mut calibration = Calibration {
        mode: compensation.mode,
        options: *options,
        parameters,
        sockets,
        held,
        deviations,
        deflections,
        tips,
        noise,
        outliers,
        fit,
        passes,
        is_converged,
        observability,
        validation: None,
        warnings: Vec::new(),
        start: nominal,
        setup,
    };
    calibration.warnings = super::checks::all(campaign, recording, &calibration);
    Ok(calibration)
}

/// The nominal robot where the rough start puts it.
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
pub fn free_parameters(campaign: &Campaign, start: &Setup, compensation: &Compensation) -> Vec<Parameter> {
    let has_world = matches!(campaign.measurements.targets, Targets::Points(_));
    let is_base = |p: &Parameter| matches!(p, Parameter::BasePosition(_) | Parameter::BaseRotation(_));
    let constraints = &campaign.wishes;
    let minimal = minimal_parameters(&campaign.robot, start.tool, campaign.tool, compensation.payload);
    Parameter::all(campaign.robot.joints.len())
        .into_iter()
        .filter(|p| (minimal.contains(p) && (has_world || !is_base(p))) || constraints.freed.contains(p))
        .filter(|p| !constraints.fixed.contains(p))
        .collect()
}

fn check_count(recording: &Recording, free: &[Parameter]) -> Result<()> {
    let unknown = match &recording.targets {
        Targets::Points(_) => free.len(),
        Targets::Sockets(distances) => {
            (free.len() + 3 * recording.groups.len()).saturating_sub(distances.len())
        }
    };
    // one pose more than it takes, for without a surplus nothing is known about the noise
    let needed = unknown / 3 + 1;
    if recording.len() >= needed {
        return Ok(());
    }
    Err(Error::Input {
        at: Place::whole_file(&recording.file),
        found: format!("{} poses for {unknown} unknown numbers", recording.len()),
        expected: format!("at least {needed}, better {}", 3 * needed),
        hint: Some("measure more poses, or fix parameters in the campaign's [parameters]".into()),
    })
}
