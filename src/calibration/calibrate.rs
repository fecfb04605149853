//! The calibration itself: rough start, fit, compensation recomputed until it stands still (Eqs 7–14).

use nalgebra::Vector3;

use super::campaign::{Campaign, Recording, Targets};
use super::compensation::{Compensation, Mode};
use super::identify::{self, Held};
use super::noise::{Noise, Robust};
use super::observability::Observability;
use super::passes::{PassRecord, Run};
use super::problem::Residuals;
use super::start::{first_guess, rough_start};
use super::validation::{Validation, validate};
use super::warning::Warning;
use crate::error::{Error, Place, Result};
use crate::least_squares::Fit;
use crate::robot::{Kinematics, Parameter, Setup, minimal_parameters};

/// How to calibrate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// What an outlier counts.
    pub robust: Robust,
}

/// A calibrated robot and how well it is known.
#[derive(Debug, Clone)]
pub struct Calibration<'c> {
    /// How the rod's deflection was compensated.
    pub mode: Mode,
    /// Base, links, compliances and tool before the first fit: the nominal robot where the rough start puts it.
    pub start: Setup<'c>,
    /// Base, links, compliances and tool as found.
    pub setup: Setup<'c>,
    /// The free parameters.
    pub parameters: Vec<Estimated>,
    /// Where the sockets were found, m, with their standard errors; in {0}. Empty for measured points.
    pub sockets: Vec<[(f64, Option<f64>); 3]>,
    /// Combinations of the free parameters that the data do not identify: held where the nominal robot has them.
    pub held: Vec<Held>,
    /// Deflected tip less measured point or socket, in {W}, m: one per row.
    pub deviations: Vec<Vector3<f64>>,
    /// What the rod's deflection added to each row, in {W}, m.
    pub deflections: Vec<Vector3<f64>>,
    /// The tip at each row, in {W}, m.
    pub tips: Vec<Vector3<f64>>,
    /// How much the recording scatters.
    pub noise: Noise,
    /// Rows that are no noise.
    pub outliers: Vec<usize>,
    /// The last fit; its parameters are the free ones, then the sockets.
    pub fit: Fit,
    /// Every pass of the compensation loop.
    pub passes: Vec<PassRecord>,
    /// True where the loop came to rest and its last fit converged.
    pub is_converged: bool,
    /// How well the poses show the parameters.
    pub observability: Observability,
    /// How well the calibrated robot predicts, where the campaign can tell.
    pub validation: Option<Validation>,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// A free parameter.
#[derive(Debug, Clone, Copy)]
pub struct Estimated {
    /// Which.
    pub parameter: Parameter,
    /// Its nominal value or first guess, SI.
    pub nominal: f64,
    /// Its estimate, SI.
    pub value: f64,
    /// Its standard error, SI, with what directions that are held may hide of it; `None` where it is not identified.
    pub std_error: Option<f64>,
    /// False where the data do not determine it.
    pub identifiable: bool,
}

impl Calibration<'_> {
    /// Pairs of free parameters whose estimates correlate by more than `limit` in size, strongest first.
    pub fn correlations_above(&self, limit: f64) -> Vec<(Parameter, Parameter, f64)> {
        let matrix = self.fit.covariance.correlation();
        let count = self.parameters.len();
        let mut pairs: Vec<(Parameter, Parameter, f64)> = (0..count)
            .flat_map(|i| (0..i).map(move |j| (j, i)))
            .filter(|&(j, i)| self.parameters[i].identifiable && self.parameters[j].identifiable)
            .map(|(j, i)| (self.parameters[j].parameter, self.parameters[i].parameter, matrix[(i, j)]))
            .filter(|(_, _, correlation)| correlation.abs() > limit)
            .collect();
        pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
        pairs
    }

    /// Lengths of the deviations, m, one per row.
    pub fn residuals(&self) -> Vec<f64> {
        self.deviations.iter().map(|d| d.norm()).collect()
    }
}

/// Calibrates the robot of a campaign.
///
/// # Errors
/// What [`Compensation::new`] refuses; [`Error::Input`] for fewer measurements than parameters; what the fits refuse.
/// A fit that does not converge is no error: see [`Calibration::is_converged`].
pub fn calibrate<'c>(campaign: &'c Campaign, mode: Mode, options: &Options) -> Result<Calibration<'c>> {
    let compensation = Compensation::new(campaign, mode)?;
    let mut start = start(campaign)?;
    let free = free_parameters(campaign, &start, &compensation);
    // what is not free stays as it is drawn
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

/// Calibrates `free` parameters on a recording, from a given start, without validation: for folds and recordings that
/// were drawn again.
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
    let identified = identify::identified(&held, free.len());
    let parameters = free
        .iter()
        .enumerate()
        .map(|(k, &parameter)| Estimated {
            parameter,
            nominal: nominal.get(parameter),
            value: setup.get(parameter),
            std_error: errors[k].filter(|_| identified[k]).map(|e| e.hypot(identify::unseen(&held, k))),
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
            (kinematics.tip, kinematics.flange.rotation * pass.bent[row])
        })
        .unzip();
    let observability = Observability::new(&problem, &fit.parameters)?;
    let outliers = noise.outliers(recording, &deviations)?;
    let mut calibration = Calibration {
        mode: compensation.mode,
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
    calibration.warnings = super::warning::all(campaign, recording, &calibration);
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
    // the user's own guess is what corrections are told against, unless it is another world
    let turn = nalgebra::Rotation3::from_matrix_unchecked(base.rotation * guess.rotation.transpose());
    if campaign.base_is_given && turn.angle() < 0.5 {
        setup.base_guess = guess;
        setup.base_turn = turn.scaled_axis();
    }
    Ok(setup)
}

/// The complete and minimal set of the robot, with the user's wishes.
pub fn free_parameters(campaign: &Campaign, start: &Setup, compensation: &Compensation) -> Vec<Parameter> {
    let has_world = matches!(campaign.measurements.targets, Targets::Points(_));
    let is_base = |p: &Parameter| matches!(p, Parameter::BasePosition(_) | Parameter::BaseRotation(_));
    let wishes = &campaign.wishes;
    let minimal = minimal_parameters(&campaign.robot, start.tool, campaign.tool, compensation.payload);
    Parameter::all(campaign.robot.joints.len())
        .into_iter()
        .filter(|p| (minimal.contains(p) && (has_world || !is_base(p))) || wishes.freed.contains(p))
        .filter(|p| !wishes.fixed.contains(p))
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
