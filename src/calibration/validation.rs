//! How well a calibrated robot predicts poses that it was not calibrated on.

use nalgebra::Vector3;

use super::campaign::{Recording, Refit, Targets};
use super::compensation::Compensation;
use super::problem::{Pass, Residuals};
use super::start::rough_start;
use crate::error::Result;
use crate::least_squares;
use crate::robot::{Kinematics, Parameter, Setup};
use crate::spatial::Pose;
use crate::statistics;

/// Errors of the poses of a validation recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Validation {
    /// Distance of each pose from where it was measured, or from its socket's mean, m.
    pub errors: Vec<f64>,
    /// Where the tip was, in {W} (or {0} for sockets), m.
    pub tips: Vec<Vector3<f64>>,
    /// Predicted less measured, or less the socket's mean, m.
    pub deviations: Vec<Vector3<f64>>,
    /// What was fitted again.
    pub refit: Refit,
    /// Base and tool (m, in {T}) after that, where they were.
    pub placement: Option<(Pose, Vector3<f64>)>,
    /// False where that fit did not converge.
    pub is_converged: bool,
    /// Mean, maximum, median and standard deviation.
    pub summary: Summary,
}

/// What the errors of many poses are summed up to, m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Mean.
    pub mean: f64,
    /// Maximum.
    pub max: f64,
    /// Median.
    pub median: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Root mean square.
    pub rms: f64,
}

/// Errors of the nominal robot at the poses of a campaign.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Before {
    /// Of the calibration's poses: only where the robot stands and where its tip is (or where the
    /// sockets are) was fitted to them.
    pub residual: Summary,
    /// The same, one by one, m.
    pub residuals: Vec<f64>,
    /// Of the validation's poses; `None` without a validation.
    pub validation: Option<Summary>,
    /// The same, one by one, m; empty without a validation.
    pub validation_errors: Vec<f64>,
}

impl Summary {
    /// Of lengths, m; zeros for none.
    ///
    /// ```
    /// use rodcal::calibration::Summary;
    ///
    /// let summary = Summary::of(&[3.0, 4.0, 5.0]);
    /// assert_eq!((summary.mean, summary.max, summary.median, summary.sd), (4.0, 5.0, 4.0, 1.0));
    /// assert!((summary.rms - (50.0f64 / 3.0).sqrt()).abs() < 1e-12);
    /// ```
    pub fn of(lengths: &[f64]) -> Summary {
        let squares: f64 = lengths.iter().map(|x| x * x).sum();
        Summary {
            mean: statistics::mean(lengths).unwrap_or(0.0),
            max: lengths.iter().fold(0.0, |a, &b| a.max(b)),
            median: statistics::median(lengths).unwrap_or(0.0),
            sd: statistics::standard_deviation(lengths).unwrap_or(0.0),
            rms: (squares / lengths.len().max(1) as f64).sqrt(),
        }
    }
}

/// Predicts `recording` with the calibrated `setup`, with base and tool fitted again where `refit`
/// says so. It was measured with a short rigid rod and without contact: links weigh on the joints,
/// nothing bends.
///
/// ```
/// use rodcal::calibration::validate;
/// use rodcal::prelude::*;
///
/// let joint = |a| Joint::new("one", Motion::Revolute, Hayati { a, ..Hayati::default() });
/// let (drawn, built) = (Robot::new("arm", vec![joint(0.5)]), Robot::new("arm", vec![joint(0.501)]));
/// let mut recording = Recording::new(1);
/// for q in [0.0, 1.0, 2.0] {
///     recording.add(&[q], built.flange_at(&[q]).origin)?;
/// }
/// let setup = Setup::new(&drawn, Pose::IDENTITY, [0.0; 3].into());
/// // with nothing fitted again, a link that is 1 mm longer shows as 1 mm at every pose
/// let validation = validate(&setup, &recording, Refit::Nothing)?;
/// assert!(validation.errors.iter().all(|error| (error - 1e-3).abs() < 1e-12));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// What the fit refuses.
pub fn validate(setup: &Setup, recording: &Recording, refit: Refit) -> Result<Validation> {
    validate_from(setup, recording, refit, None)
}

/// As [`validate`], with a first guess of base and tool in place of a rough start.
///
/// # Errors
/// As [`validate`].
pub(super) fn validate_from(
    setup: &Setup,
    recording: &Recording,
    refit: Refit,
    guess: Option<(Pose, Vector3<f64>)>,
) -> Result<Validation> {
    let n = recording.joint_count;
    let bare = Compensation::bare();
    let mut pass = Pass::at_rest(recording);
    let mut setup = setup.clone();
    let mut is_converged = true;
    let mut placement = None;
    let mut motions = vec![Pose::IDENTITY; recording.stations.len()];
    if let (Targets::Points(_), Refit::BaseTool) = (&recording.targets, refit) {
        let (base, tool) = match guess {
            Some(guess) => guess,
            None => rough_start(&setup.calibrated(), recording, setup.base(), setup.tool)?,
        };
        setup.base_guess = base;
        setup.base_position = base.origin;
        setup.base_turn = Vector3::zeros();
        setup.tool = tool;
        let free: Vec<Parameter> = Parameter::all(n).into_iter().filter(|p| p.is_placement()).collect();
        // torques depend a little on where the base stands
        for _ in 0..3 {
            bare.update(&setup, recording, &mut pass);
            let problem = Residuals { setup: setup.clone(), free: &free, recording, pass: &pass, held: &[] };
            let options = least_squares::Options::default();
            let fit = least_squares::search(&problem, &problem.start(), &options)?;
            is_converged = fit.is_converged();
            motions = problem.motions(fit.parameters());
            for (k, &parameter) in free.iter().enumerate() {
                setup.set(parameter, fit.parameters()[k]);
            }
        }
        placement = Some((setup.base(), setup.tool));
    }
    bare.update(&setup, recording, &mut pass);
    let mut kinematics = Kinematics::new(&setup);
    let tips: Vec<Vector3<f64>> = (0..recording.len())
        .map(|row| {
            pass.deflect(&mut kinematics, recording, row);
            kinematics.tip
        })
        .collect();
    let deviations: Vec<Vector3<f64>> = match &recording.targets {
        Targets::Points(points) => {
            let targets = points.iter().zip(&recording.rows);
            let targets = targets.map(|(point, row)| motions[row.station].point(point));
            tips.iter().zip(targets).map(|(tip, x)| tip - x).collect()
        }
        Targets::Sockets(_) => recording.minus_group_means(&tips),
    };
    let errors: Vec<f64> = deviations.iter().map(|d| d.norm()).collect();
    Ok(Validation { summary: Summary::of(&errors), errors, tips, deviations, refit, placement, is_converged })
}
