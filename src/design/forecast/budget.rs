//! What is wrong while a robot is calibrated and used, and where that is known from.

use crate::calibration::{Campaign, Options, calibrate, default_mode};
use crate::error::Result;
use crate::units::{UM, significant};

/// Noise of a displacement sensor and repeatability of the robot where nobody states them, m: the
/// paper's sensors, and the data sheet of the TX90.
const SENSORS: f64 = 3.0 * UM;
const REPEATABILITY: f64 = 30.0 * UM;

/// Sizes of what is wrong, m, standard deviations.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Budget {
    /// Of one measured coordinate: sensors and repeatability.
    pub noise: f64,
    /// Noise or scatter, and where it is known from: the beginning of a sentence.
    pub noise_source: String,
    /// Of a coordinate of each clamp's place.
    pub clamps: f64,
    /// Root mean square of the distance by which the robot misses a pose.
    pub repeatability: f64,
    /// The same of the instrument that measures the unseen poses; 0 forecasts the robot itself.
    pub instrument: f64,
    /// How many times farther from its drawing the robot is than its file's standard uncertainties
    /// say.
    pub drawing_scale: f64,
    /// Every random number comes from it.
    pub seed: u64,
}

impl Budget {
    /// Of a campaign: the noise that is given here, or that the file states, or that its recording
    /// shows, or else that of the paper; `repeatability` (m) likewise; and the `instrument` (m)
    /// that measures the unseen poses, 0 for none.
    ///
    /// # Errors
    /// What the calibration of a recording refuses.
    pub fn of(
        campaign: &Campaign,
        noise: Option<f64>,
        repeatability: Option<f64>,
        instrument: f64,
    ) -> Result<Budget> {
        let mut budget = Budget {
            noise: 0.0,
            noise_source: String::new(),
            clamps: campaign.clamp_uncertainty.unwrap_or(0.0),
            repeatability: repeatability.unwrap_or(REPEATABILITY),
            instrument,
            drawing_scale: 1.0,
            seed: 1,
        };
        let um = |size: f64| significant(size / UM, 3);
        if let Some(noise) = noise.or(campaign.noise) {
            budget.noise = noise;
            // a robot that repeats worse than what is measured of it would be no robot of that
            // noise
            budget.repeatability = repeatability.unwrap_or(REPEATABILITY.min(of_robot(noise)));
            budget.noise_source = format!("Noise {} µm per coordinate, stated", um(noise));
            return Ok(budget);
        }
        let mut unusable = String::new();
        if !campaign.measurements.is_empty() {
            let found = calibrate(campaign, default_mode(campaign), &Options::default())?;
            if found.is_plausible() {
                budget.noise = found.noise.pooled;
                budget.drawing_scale = found.drawing_scale;
                budget.noise_source = format!(
                    "Scatter {} µm per coordinate, that of {} after calibration",
                    um(found.noise.pooled),
                    campaign.measurements.file
                );
                // what scatters there scatters elsewhere
                budget.repeatability = repeatability.unwrap_or(of_robot(found.noise.pooled));
                return Ok(budget);
            }
            unusable = format!("; {} does not calibrate plausibly", campaign.measurements.file);
        }
        budget.noise = (budget.repeatability.powi(2) / 3.0 + SENSORS.powi(2)).sqrt();
        budget.noise_source = format!(
            "Scatter {} µm per coordinate, assumed (repeatability {} µm, sensors {} µm{unusable})",
            um(budget.noise),
            um(budget.repeatability),
            um(SENSORS)
        );
        Ok(budget)
    }

    /// With clamps whose places are known to this standard deviation of a coordinate, m.
    pub fn with_clamps(self, clamps: f64) -> Budget {
        Budget { clamps, ..self }
    }

    /// With every random number from this seed.
    pub fn with_seed(self, seed: u64) -> Budget {
        Budget { seed, ..self }
    }
}

/// Repeatability of a robot (rms of the distance) of which a coordinate is measured with this
/// noise, but for the sensors.
fn of_robot(noise: f64) -> f64 {
    (3.0 * (noise.powi(2) - SENSORS.powi(2))).max(0.0).sqrt()
}
