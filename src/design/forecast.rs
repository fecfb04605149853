//! How accurate a robot will be once it is calibrated with planned poses, before anybody records
//! them.
//!
//! A calibration measures x = f(ρ) + R·Δx + ε and fits f(ρ) + R·Δx_mode. With the Jacobian A of the
//! planned poses, their noise σ and what is known before, Λ = diag 1/sd², it finds
//!
//! ```text
//! P = (AᵀA/σ² + Λ)⁻¹        ρ̂ − ρ = P·Aᵀ/σ²·(ε + δ + c) − P·Λ·t
//! ```
//!
//! - ε: sensors and the robot's repeatability
//! - δ: what the mode gets wrong of the rod's deflection; a bias that is known, and what nobody
//!   knows of the rod
//! - c: errors of the clamps' places, one for all poses of a clamp
//! - t: how far the robot is from its drawing, which the poses do not show entirely
//!
//! At unseen poses with the Jacobian B the tip is wrong by B·(ρ̂ − ρ) and by the robot's
//! repeatability. Where base and tool are aligned anew there, as in the paper's validation, what
//! they can take up is projected out.

mod budget;
mod fit;
mod rod;
mod unseen;

pub use budget::Budget;
pub use unseen::{Unseen, Where};

use fit::Fit;
use nalgebra::{DMatrix, DVector, Vector3};

use crate::calibration::campaign::{Campaign, Group, Recording};
use crate::calibration::{Compensation, Mode, Planned, free_parameters, known_before, places};
use crate::error::Result;
use crate::linalg::transposed_product;
use crate::parallel::in_parallel;
use crate::robot::{Parameter, Setup};
use crate::statistics::{Random, quantile, standard_deviation};

/// Draws of everything that is unknown.
const DRAWS: usize = 400;

/// A part of the error budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// Sensors and repeatability while the robot is calibrated.
    Noise,
    /// What the poses do not show of the robot.
    Undetermined,
    /// Places of the clamps.
    Clamps,
    /// What the mode leaves of the rod's deflection, as far as it is known.
    RodBias,
    /// What nobody knows of the rod.
    RodUncertainty,
    /// The robot's repeatability at the unseen pose.
    Repeatability,
    /// What measures the unseen pose.
    Instrument,
}

impl Part {
    /// All parts, in the order of [`Forecast::parts`].
    pub const ALL: [Part; 7] = [
        Part::Noise,
        Part::Undetermined,
        Part::Clamps,
        Part::RodBias,
        Part::RodUncertainty,
        Part::Repeatability,
        Part::Instrument,
    ];

    /// Its name in JSON, with the unit.
    pub fn key(self) -> &'static str {
        [
            "noise_um",
            "undetermined_um",
            "clamp_places_um",
            "rod_bias_um",
            "rod_uncertainty_um",
            "repeatability_um",
            "instrument_um",
        ][self as usize]
    }

    /// In tables and pictures.
    pub fn description(self) -> &'static str {
        [
            "noise of the calibration",
            "not shown by the poses",
            "clamp places",
            "deflection not compensated",
            "uncertainty of the rod",
            "repeatability at the pose",
            "instrument of the validation",
        ][self as usize]
    }
}

/// The errors that are to be expected.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Forecast {
    /// How the rod is compensated.
    pub mode: Mode,
    /// Mean length of the error over unseen poses, m.
    pub mean: f64,
    /// 95 % of unseen poses are better, m.
    pub p95: f64,
    /// Root mean square, m.
    pub rms: f64,
    /// Within it the mean of one campaign lies in 95 of 100, m.
    pub interval: [f64; 2],
    /// Root mean square of each part, m; their squares add up to that of the whole.
    pub parts: [f64; 7],
    /// The mean square of each draw, m²: those of two forecasts have their chance in common.
    pub(super) squares: Vec<f64>,
}

impl Forecast {
    /// Whether the draws do not distinguish the errors of two forecasts that were made with one
    /// seed: their mean squares differ by less than two standard errors of the difference.
    pub fn is_as_good_as(&self, other: &Forecast) -> bool {
        let apart: Vec<f64> = self.squares.iter().zip(&other.squares).map(|(a, b)| a - b).collect();
        let scatter = standard_deviation(&apart).unwrap_or(0.0);
        mean(&apart).abs() <= 2.0 * scatter / (apart.len().max(1) as f64).sqrt()
    }

    /// No errors at all.
    #[cfg(test)]
    pub(super) fn nothing(mode: Mode) -> Forecast {
        Forecast {
            mode,
            mean: 0.0,
            p95: 0.0,
            rms: 0.0,
            interval: [0.0; 2],
            parts: [0.0; 7],
            squares: Vec::new(),
        }
    }
}

/// Planned poses of one campaign, and all that a forecast needs beside the mode.
pub struct Forecaster<'c> {
    campaign: &'c Campaign,
    setup: Setup<'c>,
    free: Vec<Parameter>,
    places: Vec<Group>,
    are_unknown: bool,
    /// What is wrong, and by how much.
    pub budget: Budget,
    /// Where the robot will be used.
    pub unseen: Unseen,
}

impl<'c> Forecaster<'c> {
    /// For a campaign whose robot stands as in `setup`.
    ///
    /// # Errors
    /// What the places where the robot will be used are refused for.
    pub fn new(campaign: &'c Campaign, setup: Setup<'c>, budget: Budget, at: &Where) -> Result<Self> {
        let compensation = Compensation::new(campaign, Mode::None)?;
        let free = free_parameters(campaign, &setup, &compensation);
        let (places, are_unknown) = places(campaign, &setup);
        let unseen = Unseen::new(campaign, &setup, &free, at)?;
        Ok(Forecaster { campaign, setup, free, places, are_unknown, budget, unseen })
    }

    /// What is known of each free parameter before the calibration, SI.
    pub fn known_before(&self) -> Vec<f64> {
        let payload = Compensation::new(self.campaign, Mode::None).ok().and_then(|c| c.payload);
        known_before(self.campaign, &self.setup, &self.free, payload, self.budget.drawing_scale)
    }

    /// B′ᵀB′ per unseen pose in units of what is known before, so that tr(W·P) is the mean square
    /// of the tip's error, m².
    pub fn weight(&self, columns: usize) -> DMatrix<f64> {
        let known = self.known_before();
        let mut slopes = self.unseen.slopes.clone();
        for (k, sd) in known.iter().enumerate() {
            slopes.column_mut(k).scale_mut(*sd);
        }
        let own = transposed_product(&slopes, &slopes) / self.unseen.len().max(1) as f64;
        let mut weight = DMatrix::zeros(columns, columns);
        weight.view_mut((0, 0), own.shape()).copy_from(&own);
        weight
    }

    /// What is to be expected of a calibration with these poses in a mode.
    ///
    /// ```
    /// use rodcal::calibration::planned_setup;
    /// use rodcal::design::{Budget, Forecaster, Part, Where};
    /// use rodcal::prelude::*;
    ///
    /// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
    /// let recording = &campaign.measurements;
    /// let poses: Vec<_> =
    ///     (0..60).map(|row| (recording.rows[row].group, recording.joints(row).to_vec())).collect();
    /// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
    /// let setup = planned_setup(&campaign)?;
    /// let forecaster = Forecaster::new(&campaign, setup, budget, &Where::Validation)?;
    /// let forecast = forecaster.forecast(&poses, Mode::Meas)?;
    /// // 30 µm of repeatability, of which base and tool take up a tenth, and what is left of the noise
    /// let um = |part: Part| forecast.parts[part as usize] / 1e-6;
    /// assert!((um(Part::Repeatability) - 30.0 * (1.0 - 9.0 / 90.0f64).sqrt()).abs() < 0.3);
    /// assert!((5.0..20.0).contains(&um(Part::Noise)), "{}", um(Part::Noise));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::NotApplicable`] for a mode that the campaign's files do not allow; what the
    /// beam model refuses.
    pub fn forecast(&self, poses: &[(usize, Vec<f64>)], mode: Mode) -> Result<Forecast> {
        let loads = rod::Loads::new(self.campaign, mode)?;
        let (setup, free) = (self.setup.clone(), &self.free);
        let planned = Planned::new(setup, free, &loads.truth, &self.places, self.are_unknown, poses);
        let fit = Fit::new(&planned.rows(), &self.known_before(), &self.unseen.slopes)?;
        let deflected = loads.errors(&planned)?;
        let seen = Seen {
            bias: stacked(deflected.bias.into_iter()),
            unknown: deflected.unknown.into_iter().map(|shift| stacked(shift.into_iter())).collect(),
            recording: planned.recording().clone(),
        };
        let draws = in_parallel(DRAWS, |draw| {
            let mut random = Random::seeded(self.budget.seed, draw as u64);
            self.draw(&fit, &seen, &mut random)
        });
        let draws: Vec<Draw> = draws.into_iter().collect::<Result<_>>()?;
        let lengths: Vec<f64> = draws.iter().flat_map(|draw| draw.lengths.iter().copied()).collect();
        let means: Vec<f64> = draws.iter().map(|draw| mean(&draw.lengths)).collect();
        let part = |k: usize| (draws.iter().map(|draw| draw.squares[k]).sum::<f64>() / DRAWS as f64).sqrt();
        let parts: [f64; 7] = std::array::from_fn(part);
        Ok(Forecast {
            mode,
            mean: mean(&means),
            p95: quantile(&lengths, 0.95).unwrap_or(0.0),
            // independent parts: the sum of the squares has less chance in it than the square of
            // the sums
            rms: parts.iter().map(|part| part * part).sum::<f64>().sqrt(),
            interval: [0.025, 0.975].map(|p| quantile(&means, p).unwrap_or(0.0)),
            parts,
            squares: draws.iter().map(|draw| draw.squares.iter().sum()).collect(),
        })
    }

    fn draw(&self, fit: &Fit, seen: &Seen, random: &mut Random) -> Result<Draw> {
        let budget = &self.budget;
        let mut vector = |sd: f64| Vector3::from_fn(|_, _| sd * random.normal());
        let rows = &seen.recording.rows;
        let noise = stacked(rows.iter().map(|_| vector(budget.noise)));
        let of_clamps: Vec<Vector3<f64>> = self.places.iter().map(|_| vector(budget.clamps)).collect();
        let clamps = stacked(rows.iter().map(|row| of_clamps[row.group]));
        let per_axis = 3f64.sqrt().recip();
        let mut scatter = |length: f64| {
            let all = stacked((0..self.unseen.len()).map(|_| vector(length * per_axis)));
            self.unseen.aligned(all)
        };
        let (repeatability, instrument) = (scatter(budget.repeatability), scatter(budget.instrument));
        let robot = DVector::from_fn(fit.axes(), |_, _| random.normal());
        let mut rod = DVector::zeros(noise.len());
        for shift in &seen.unknown {
            rod += shift * random.normal();
        }
        let all = &noise + &clamps + &seen.bias + &rod;
        let weighed = fit.weighed(&seen.recording, &all, &robot, budget.noise, self.campaign.noise)?;
        let parts: [DVector<f64>; 7] = [
            weighed.correction(&noise),
            weighed.left_of(&robot),
            weighed.correction(&clamps),
            weighed.correction(&seen.bias),
            weighed.correction(&rod),
            repeatability,
            instrument,
        ];
        let poses = self.unseen.len().max(1) as f64;
        let total: DVector<f64> = parts.iter().sum();
        Ok(Draw {
            squares: parts.each_ref().map(|part| part.norm_squared() / poses),
            lengths: total
                .as_slice()
                .chunks_exact(3)
                .map(|e| e.iter().map(|x| x * x).sum::<f64>().sqrt())
                .collect(),
        })
    }
}

/// What the calibration will see that is not the robot, of every pose in {W}, m.
struct Seen {
    bias: DVector<f64>,
    /// One standard deviation of each thing that nobody knows of the rod.
    unknown: Vec<DVector<f64>>,
    /// The planned poses.
    recording: Recording,
}

struct Draw {
    /// Mean square of each part, m².
    squares: [f64; 7],
    /// Length of the error at each unseen pose, m.
    lengths: Vec<f64>,
}

fn stacked(vectors: impl Iterator<Item = Vector3<f64>>) -> DVector<f64> {
    DVector::from_vec(vectors.flat_map(<[f64; 3]>::from).collect())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
