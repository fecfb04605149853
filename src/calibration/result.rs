//! A calibrated robot and how well it is known, as data.

use nalgebra::Vector3;

use super::campaign::Recording;
use super::compensation::Mode;
use super::extrapolation::Extrapolation;
use super::identifiability::{MOST_SCATTER, UnidentifiedDirection};
use super::noise::Noise;
use super::observability::Observability;
use super::options::Options;
use super::passes::PassRecord;
use super::validation::{Before, Validation};
use super::warning::Warning;
use crate::least_squares::{Fit, Prior};
use crate::robot::{Parameter, Setup};
use crate::spatial::Pose;

/// A calibrated robot and how well it is known.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Calibration<'c> {
    /// How the rod's deflection was compensated.
    pub mode: Mode,
    /// How it was calibrated: a diagnosis calibrates again in the same way.
    pub options: Options,
    /// Base, links, compliances and tool before the first fit: the nominal robot where the rough
    /// start puts it.
    pub start: Setup<'c>,
    /// Base, links, compliances and tool as found.
    pub setup: Setup<'c>,
    /// The free parameters.
    pub parameters: Vec<Estimated>,
    /// Where the sockets were found, m, with their standard errors; in {0}. Empty for measured
    /// points.
    pub sockets: Vec<[(f64, Option<f64>); 3]>,
    /// For each station what brings its points, as the recording has them, into {W}: the identity
    /// for the first.
    pub stations: Vec<Pose>,
    /// Combinations of the free parameters that the data do not identify: held where the
    /// nominal robot has them.
    pub held: Vec<UnidentifiedDirection>,
    /// What was known of the free parameters before the data: by the robot file, times
    /// `drawing_scale`, and by the user.
    pub priors: Vec<Prior>,
    /// How many times farther from its drawing the robot is, by the data, than its file's standard
    /// uncertainties say.
    pub drawing_scale: f64,
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
    /// The last fit; its parameters are the free ones, then the sockets, or the stations' frames.
    pub fit: Fit,
    /// Every pass of the compensation loop.
    pub passes: Vec<PassRecord>,
    /// True where the loop and its last fit converged.
    pub is_converged: bool,
    /// How well the poses show the parameters.
    pub observability: Observability,
    /// How accurate the nominal robot is at the same poses; `None` for folds and bootstrap samples.
    pub before: Option<Before>,
    /// The validation's poses against those of the calibration.
    pub extrapolation: Option<Extrapolation>,
    /// How well the calibrated robot predicts, where the campaign can say it.
    pub validation: Option<Validation>,
    /// Largest distance of the nominal tip from the first joint over the recording, m.
    pub reach: f64,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// A free parameter.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Estimated {
    /// The parameter of robot, base or tool.
    pub parameter: Parameter,
    /// Its nominal value or first guess, SI.
    pub nominal: f64,
    /// Its estimate, SI.
    pub value: f64,
    /// Its standard error, SI, with what directions that are held may hide of it; `None` where it
    /// is not identified.
    pub std_error: Option<f64>,
    /// False where the data do not determine it.
    pub identifiable: bool,
}

impl Estimated {
    /// True where the data support that the number differs from its nominal value: by more than its
    /// standard error.
    pub fn is_supported(&self) -> bool {
        self.std_error.is_some_and(|error| (self.value - self.nominal).abs() > error)
    }
}

impl Calibration<'_> {
    /// Pairs of free parameters whose estimates correlate, Cᵢⱼ/√(Cᵢᵢ·Cⱼⱼ), by more than `limit` in
    /// size, strongest first: dimensionless, −1 to 1.
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

    /// What brings the points of each station of another `recording` into {W}, by the stations of
    /// the same name in that which was calibrated on; the identity for a station that is not there.
    pub fn motions(&self, calibrated: &Recording, recording: &Recording) -> Vec<Pose> {
        let of_name = |name: &str| {
            let known = calibrated.stations.iter().position(|known| known.name == name);
            known.and_then(|known| self.stations.get(known).copied()).unwrap_or(Pose::IDENTITY)
        };
        recording.stations.iter().map(|station| of_name(&station.name)).collect()
    }

    /// False for a fit that did not converge, or that leaves more than a robot's error can be:
    /// [`MOST_SCATTER`] of the reach. Something is wrong then that no calibration corrects.
    pub fn is_plausible(&self) -> bool {
        self.is_converged && self.rms() <= MOST_SCATTER * self.reach
    }

    /// Root mean square of the lengths of the deviations, m.
    pub fn rms(&self) -> f64 {
        let squares: f64 = self.deviations.iter().map(|d| d.norm_squared()).sum();
        (squares / self.deviations.len().max(1) as f64).sqrt()
    }

    /// Lengths of the deviations, m, one per row.
    pub fn residuals(&self) -> Vec<f64> {
        self.deviations.iter().map(|d| d.norm()).collect()
    }
}
