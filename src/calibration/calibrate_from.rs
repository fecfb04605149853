//! One calibration from a given start: fit and compensation until neither changes, and what is
//! known then.

use super::campaign::{Campaign, Recording, Targets};
use super::compensation::Compensation;
use super::identifiability;
use super::observability::Observability;
use super::options::Options;
use super::passes::Run;
use super::problem::Residuals;
use super::result::{Calibration, Estimated};
use crate::error::{Error, Place, Result};
use crate::least_squares::Fit;
use crate::robot::{Kinematics, Parameter, Setup};

/// Calibrates `free` parameters on a recording, from a given start, without validation: for folds
/// and bootstrap samples.
///
/// ```
/// use rodcal::calibration::{calibrate_from, free_parameters, start};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let compensation = Compensation::new(&campaign, Mode::Fea)?;
/// let start = start(&campaign)?;
/// let free = free_parameters(&campaign, &start, &compensation);
/// // every second pose
/// let half = campaign.measurements.subset(&(0..60).step_by(2).collect::<Vec<_>>());
/// let found = calibrate_from(&campaign, &half, start, &free, &compensation, &Options::default())?;
/// assert!(found.is_converged && found.residuals().len() == 30 && found.validation.is_none());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`super::calibrate()`].
pub fn calibrate_from<'c>(
    campaign: &'c Campaign,
    recording: &Recording,
    start: Setup<'c>,
    free: &[Parameter],
    compensation: &Compensation,
    options: &Options,
) -> Result<Calibration<'c>> {
    let nominal = start.clone();
    let (run, fit) = fitted(campaign, recording, start, free, compensation, options)?;
    let (priors, drawing_scale) = (run.priors(), run.drawing.scale);
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
    let stations = problem.motions(&fit.parameters);
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
        stations,
        held,
        priors,
        drawing_scale,
        deviations,
        deflections,
        tips,
        noise,
        outliers,
        fit,
        passes,
        is_converged,
        observability,
        before: None,
        validation: None,
        extrapolation: None,
        reach: reach(campaign, recording),
        warnings: Vec::new(),
        start: nominal,
        setup,
    };
    calibration.warnings = super::checks::all(campaign, recording, &calibration);
    Ok(calibration)
}

/// The calibrated robot alone, for draws that ask for nothing else.
///
/// # Errors
/// As [`calibrate_from`].
pub(super) fn setup_from<'c>(
    campaign: &'c Campaign,
    recording: &Recording,
    start: Setup<'c>,
    free: &[Parameter],
    compensation: &Compensation,
    options: &Options,
) -> Result<Setup<'c>> {
    Ok(fitted(campaign, recording, start, free, compensation, options)?.0.setup)
}

fn fitted<'a, 'c>(
    campaign: &'c Campaign,
    recording: &'a Recording,
    start: Setup<'c>,
    free: &'a [Parameter],
    compensation: &'a Compensation,
    options: &Options,
) -> Result<(Run<'a, 'c>, Fit)> {
    check_count(recording, free)?;
    let mut run = Run::new(campaign, recording, start, free, compensation);
    run.fit_base_and_tool()?;
    let fit = run.compensate(options)?;
    Ok((run, fit))
}

/// Largest distance of the nominal tip from the first joint, m.
fn reach(campaign: &Campaign, recording: &Recording) -> f64 {
    let (robot, from) = (&campaign.robot, campaign.robot.root.origin);
    let distance = |row: usize| (robot.flange_at(recording.joints(row)).point(&campaign.tool) - from).norm();
    (0..recording.len()).map(distance).fold(0.0, f64::max)
}

fn check_count(recording: &Recording, free: &[Parameter]) -> Result<()> {
    let unknown = match &recording.targets {
        Targets::Points(_) => free.len() + 6 * recording.stations.len().saturating_sub(1),
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
