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
mod rod;
mod unseen;

pub use budget::Budget;
pub use unseen::{Unseen, Where};

use nalgebra::{DMatrix, DVector, Vector3};

use crate::calibration::campaign::{Campaign, Group};
use crate::calibration::{Compensation, Mode, Planned, free_parameters, known_before, places};
use crate::error::{Error, Result};
use crate::linalg::{positive_definite_inverse, transposed_product};
use crate::parallel::in_parallel;
use crate::robot::{Parameter, Setup};
use crate::statistics::{Random, quantile};

/// Draws of everything that is unknown.
const DRAWS: usize = 400;

/// A part of the error budget.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    /// All.
    pub const ALL: [Part; 7] = [
        Part::Noise,
        Part::Undetermined,
        Part::Clamps,
        Part::RodBias,
        Part::RodUncertainty,
        Part::Repeatability,
        Part::Instrument,
    ];

    /// In JSON.
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
    /// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6))?;
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
    /// [`Error::NotApplicable`] for a mode that the campaign's files do not allow; what the beam
    /// model refuses.
    pub fn forecast(&self, poses: &[(usize, Vec<f64>)], mode: Mode) -> Result<Forecast> {
        let loads = rod::Loads::new(self.campaign, mode)?;
        let (setup, free) = (self.setup.clone(), &self.free);
        let planned = Planned::new(setup, free, &loads.truth, &self.places, self.are_unknown, poses);
        let fit = Fit::new(&planned, &self.known_before(), self.budget.noise).ok_or(Error::Numerical {
            what: "the forecast",
            why: "the information of the planned poses is not positive definite".into(),
        })?;
        let deflected = loads.errors(&planned)?;
        let bias = self.at_unseen(&fit.correction(&deflected.bias));
        let unknown: Vec<DVector<f64>> =
            deflected.unknown.iter().map(|shift| self.at_unseen(&fit.correction(shift))).collect();
        let groups: Vec<usize> = poses.iter().map(|(group, _)| *group).collect();
        let draws = in_parallel(DRAWS, |draw| {
            let mut random = Random::seeded(self.budget.seed, draw as u64);
            self.draw(&fit, &groups, &bias, &unknown, &mut random)
        });
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
        })
    }

    /// B′·δρ.
    fn at_unseen(&self, correction: &DVector<f64>) -> DVector<f64> {
        &self.unseen.slopes * correction.rows(0, self.free.len())
    }

    fn draw(
        &self,
        fit: &Fit,
        groups: &[usize],
        bias: &DVector<f64>,
        unknown: &[DVector<f64>],
        random: &mut Random,
    ) -> Draw {
        let budget = &self.budget;
        let mut vector = |sd: f64| Vector3::from_fn(|_, _| sd * random.normal());
        let noise: Vec<Vector3<f64>> = groups.iter().map(|_| vector(budget.noise)).collect();
        let of_clamps: Vec<Vector3<f64>> = self.places.iter().map(|_| vector(budget.clamps)).collect();
        let clamps: Vec<Vector3<f64>> = groups.iter().map(|&group| of_clamps[group]).collect();
        let per_axis = 3f64.sqrt().recip();
        let mut scatter = |length: f64| {
            let all: Vec<f64> =
                (0..self.unseen.len()).flat_map(|_| <[f64; 3]>::from(vector(length * per_axis))).collect();
            self.unseen.aligned(DVector::from_vec(all))
        };
        let (repeatability, instrument) = (scatter(budget.repeatability), scatter(budget.instrument));
        let drawn = DVector::from_fn(fit.known.len(), |_, _| random.normal());
        let mut rod = DVector::zeros(bias.len());
        for shift in unknown {
            rod += shift * random.normal();
        }
        let parts: [DVector<f64>; 7] = [
            self.at_unseen(&fit.correction(&noise)),
            self.at_unseen(&fit.left_of(&drawn)),
            self.at_unseen(&fit.correction(&clamps)),
            bias.clone(),
            rod,
            repeatability,
            instrument,
        ];
        let poses = self.unseen.len().max(1) as f64;
        let total: DVector<f64> = parts.iter().sum();
        Draw {
            squares: parts.each_ref().map(|part| part.norm_squared() / poses),
            lengths: total
                .as_slice()
                .chunks_exact(3)
                .map(|e| e.iter().map(|x| x * x).sum::<f64>().sqrt())
                .collect(),
        }
    }
}

struct Draw {
    /// Mean square of each part, m².
    squares: [f64; 7],
    /// Length of the error at each unseen pose, m.
    lengths: Vec<f64>,
}

/// The fit that the calibration will make, in units of what is known before.
struct Fit {
    /// Rows by columns, divided by the noise, times what is known before.
    rows: DMatrix<f64>,
    /// P.
    inverse: DMatrix<f64>,
    /// sd of every unknown; of places that nobody knows, a metre.
    known: Vec<f64>,
    noise: f64,
}

impl Fit {
    fn new(planned: &Planned, known: &[f64], noise: f64) -> Option<Fit> {
        let blocks = planned.rows();
        let columns = blocks.first().map_or(0, |block| block.ncols());
        let mut known = known.to_vec();
        known.resize(columns, 1.0);
        let rows = DMatrix::from_fn(3 * blocks.len(), columns, |row, k| {
            blocks[row / 3][(row % 3, k)] * known[k] / noise
        });
        let information = DMatrix::identity(columns, columns) + transposed_product(&rows, &rows);
        let (inverse, _) = positive_definite_inverse(&information)?;
        Some(Fit { rows, inverse, known, noise })
    }

    /// ρ̂ − ρ, SI, where the balls are seen by so much elsewhere, m.
    fn correction(&self, seen: &[Vector3<f64>]) -> DVector<f64> {
        let entries: Vec<f64> = seen.iter().flat_map(|e| <[f64; 3]>::from(e / self.noise)).collect();
        let scaled = &self.inverse * self.rows.tr_mul(&DVector::from_vec(entries));
        DVector::from_fn(scaled.len(), |k, _| scaled[k] * self.known[k])
    }

    /// What is left of a robot that is so many standard deviations from its drawing, SI.
    fn left_of(&self, drawn: &DVector<f64>) -> DVector<f64> {
        let scaled = -(&self.inverse * drawn);
        DVector::from_fn(scaled.len(), |k, _| scaled[k] * self.known[k])
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
