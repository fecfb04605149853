//! The calibration itself: rough start, fit, compensation recomputed until it stands still (Eqs 7–14).

use nalgebra::Vector3;

use super::campaign::{Campaign, Recording, Targets};
use super::compensation::{Compensation, Mode};
use super::identify::{self, Held};
use super::noise::{Noise, Robust};
use super::observability::Observability;
use super::problem::{Pass, Residuals};
use super::start::{first_guess, rough_start};
use super::validation::{Validation, validate};
use super::warning::Warning;
use crate::error::{Error, Place, Result};
use crate::least_squares::{self, Fit, Problem as _};
use crate::robot::{Kinematics, Parameter, Setup, minimal_parameters};

/// Noise of a coordinate that is assumed until the residuals tell, m.
const ASSUMED_NOISE: f64 = 1e-4;
/// Change of a deflection from one pass to the next below which the compensation stands still, m.
const STILL: f64 = 1e-9;
/// Relative change of noise and weights below which they stand still: far below their own uncertainty.
const STILL_RELATIVE: f64 = 1e-3;
/// Most passes of the compensation loop.
const MOST_PASSES: usize = 60;

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

/// One pass of the compensation loop.
#[derive(Debug, Clone, Copy)]
pub struct PassRecord {
    /// Largest change of a rod deflection against the pass before, m.
    pub change: f64,
    /// Root mean square of the deviations' lengths after the fit, m.
    pub rms: f64,
    /// Noise of a coordinate, m.
    pub noise: f64,
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
/// As [`rough_start`].
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

/// A calibration under way.
struct Run<'a, 'c> {
    campaign: &'c Campaign,
    recording: &'a Recording,
    free: &'a [Parameter],
    compensation: &'a Compensation,
    /// Where it began.
    start: Setup<'c>,
    setup: Setup<'c>,
    pass: Pass,
    noise: Noise,
    held: Vec<Held>,
    passes: Vec<PassRecord>,
    is_converged: bool,
}

impl<'a, 'c> Run<'a, 'c> {
    fn new(
        campaign: &'c Campaign,
        recording: &'a Recording,
        setup: Setup<'c>,
        free: &'a [Parameter],
        compensation: &'a Compensation,
    ) -> Self {
        let noise = match campaign.noise {
            Some(sd) => Noise::assumed(sd, recording, true),
            None => Noise::assumed(ASSUMED_NOISE, recording, false),
        };
        let pass = Pass { weight: noise.row_weights(recording), ..Pass::at_rest(recording) };
        Run {
            campaign,
            recording,
            free,
            compensation,
            start: setup.clone(),
            setup,
            pass,
            noise,
            held: Vec::new(),
            passes: Vec::new(),
            is_converged: false,
        }
    }

    /// The rough calibration: only where the robot stands and where the tip is.
    fn fit_base_and_tool(&mut self) -> Result<()> {
        let placed: Vec<Parameter> = self.free.iter().copied().filter(|&p| is_placement(p)).collect();
        if placed.is_empty() || matches!(self.recording.targets, Targets::Sockets(_)) {
            return Ok(());
        }
        let problem = Residuals {
            setup: self.setup.clone(),
            free: &placed,
            recording: self.recording,
            pass: &self.pass,
            held: &[],
        };
        let fit = least_squares::fit(&problem, &problem.start(), &known_noise())?;
        if fit.is_converged() {
            let found = problem.setup_at(&fit.parameters);
            for &parameter in &placed {
                self.setup.set(parameter, found.get(parameter));
            }
        }
        Ok(())
    }

    /// Fits and recomputes deflections, torques, noise and weights until they stand still.
    fn compensate(&mut self, options: &Options) -> Result<Fit> {
        loop {
            let change = self.compensation.update(&self.setup, self.recording, &mut self.pass);
            // at the start, where the noise is a guess, and then where it is known
            if self.passes.len() < 2 {
                self.hold_unidentified()?;
            }
            let fit = self.fit()?;
            for (k, &parameter) in self.free.iter().enumerate() {
                self.setup.set(parameter, fit.parameters[k]);
            }
            let problem = self.problem();
            let deviations = problem.deviations(&fit.parameters);
            let rank = fit.covariance.rank.saturating_sub(self.held.len());
            // one weighting as least squares first, so that the robust ones start from a fit
            let robust = if self.passes.is_empty() { Robust::None } else { options.robust };
            let noise = self.noise.estimate(self.recording, &deviations, rank, robust)?;
            let squares: f64 = deviations.iter().map(|d| d.norm_squared()).sum();
            let rms = (squares / self.recording.len() as f64).sqrt();
            self.passes.push(PassRecord { change, rms, noise: noise.pooled });
            let weight = noise.row_weights(self.recording);
            let scale = largest(weight.iter().copied());
            let moved = largest(weight.iter().zip(&self.pass.weight).map(|(a, b)| a - b));
            let stands_still = change < STILL && moved <= STILL_RELATIVE * scale && self.passes.len() > 1;
            self.is_converged = stands_still && fit.is_converged();
            if stands_still || self.passes.len() >= MOST_PASSES || !fit.is_converged() {
                return Ok(fit);
            }
            self.noise = noise;
            self.pass.weight = weight;
        }
    }

    fn problem(&self) -> Residuals<'_> {
        Residuals {
            setup: self.setup.clone(),
            free: self.free,
            recording: self.recording,
            pass: &self.pass,
            held: &self.held,
        }
    }

    fn fit(&self) -> Result<Fit> {
        let problem = self.problem();
        let mut options = known_noise();
        for &(parameter, value, sd) in &self.campaign.wishes.priors {
            if let Some(index) = self.free.iter().position(|&p| p == parameter) {
                options.priors.push(least_squares::Prior { parameter: index, value, sd });
            }
        }
        least_squares::fit(&problem, &problem.start(), &options)
    }

    /// Finds the directions that the data do not identify where the robot stands now.
    fn hold_unidentified(&mut self) -> Result<()> {
        self.held.clear();
        let problem = self.problem();
        let p = problem.start();
        let mut corner = problem.information_root(&p);
        // before the first fit it is the nominal robot's misfit that parameters have to be told from, not the noise
        if self.passes.is_empty() {
            let squares = problem.residuals(&p).norm_squared();
            corner /= (squares / problem.residual_count() as f64).sqrt().max(1.0);
        }
        // what the user knows beforehand identifies too
        for &(parameter, _, sd) in &self.campaign.wishes.priors {
            if let Some(k) = self.free.iter().position(|&p| p == parameter) {
                let last = corner.nrows();
                corner = corner.insert_row(last, 0.0);
                corner[(last, k)] = 1.0 / sd;
            }
        }
        let torque = self.largest_torques();
        let ranges: Vec<f64> = self
            .free
            .iter()
            .map(|&p| {
                identify::plausible_range(p, if let Parameter::Compliance(j) = p { torque[j] } else { 0.0 })
            })
            .collect();
        self.held = identify::unidentified(&corner, &ranges, &self.start, self.free)?;
        Ok(())
    }

    /// Largest torque on each joint over the recording, N·m.
    fn largest_torques(&self) -> Vec<f64> {
        let n = self.recording.joint_count;
        let of_joint = |j: usize| largest(self.pass.torque.iter().skip(j).step_by(n).copied());
        (0..n).map(of_joint).collect()
    }
}

pub(super) fn is_placement(parameter: Parameter) -> bool {
    matches!(parameter, Parameter::BasePosition(_) | Parameter::BaseRotation(_) | Parameter::Tool(_))
}

/// Residuals come divided by their noise. A cosine of 1e-6 leaves every parameter within 1e-6·√dof of its standard errors,
/// which is no error at all: the loop around the fit needs no more.
fn known_noise() -> least_squares::Options {
    least_squares::Options {
        noise: least_squares::Noise::Known(1.0),
        gradient_tolerance: 1e-6,
        to_the_last_digit: false,
        ..least_squares::Options::default()
    }
}

/// Largest size; zero for no values.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a: f64, b| a.max(b.abs()))
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
