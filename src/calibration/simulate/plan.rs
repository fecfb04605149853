//! What is simulated, and with which errors.

use crate::units::{DEG, MM, UM};

/// What is simulated. The defaults are the paper's experiment.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// Every random number comes from it.
    pub seed: u64,
    /// Poses on every clamp.
    pub poses_per_clamp: usize,
    /// Poses in place of chosen ones: index of the clamp and joint values, rad or m; empty to
    /// choose.
    pub planned: Vec<(usize, Vec<f64>)>,
    /// Poses of the validation.
    pub validation_poses: usize,
    /// The true rod's compliance over that of its model.
    pub rod_factor: f64,
    /// Errors of the true robot.
    pub errors: RobotErrors,
    /// Standard deviation of a displacement sensor, m.
    pub sensor_noise: f64,
    /// Root mean square of the distance by which the robot misses a pose that it takes again, m.
    pub repeatability: f64,
    /// Root mean square of the distance by which the scanner misses the ball in the validation, m.
    pub scanner_noise: f64,
    /// Root mean square of the error of each clamp's position in the campaign file, m; 0 in the
    /// paper's list of noises.
    pub clamp_error: f64,
}

/// Standard deviations of the differences between the true and the nominal robot.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct RobotErrors {
    /// Of d and a, m.
    pub length: f64,
    /// Of θ, rad.
    pub offset: f64,
    /// Of α and β, rad.
    pub tilt: f64,
    /// Angle by which each joint deflects, on average, under its largest torque, rad.
    pub joint_turn: f64,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            seed: 1,
            poses_per_clamp: 30,
            planned: Vec::new(),
            validation_poses: 100,
            rod_factor: 1.0,
            errors: RobotErrors { length: 0.3 * MM, offset: 1e-3, tilt: 0.3e-3, joint_turn: 0.5e-3 },
            sensor_noise: 3.0 * UM,
            repeatability: 30.0 * UM,
            scanner_noise: 43.0 * UM,
            clamp_error: 0.0,
        }
    }
}

impl Plan {
    /// The paper's experiment with so many poses on every clamp, and so many of the validation.
    pub fn of_poses(per_clamp: usize, validation: usize) -> Plan {
        Plan { poses_per_clamp: per_clamp, validation_poses: validation, ..Plan::default() }
    }

    /// With all random numbers from this seed.
    pub fn with_seed(self, seed: u64) -> Plan {
        Plan { seed, ..self }
    }

    /// With a true rod that is so many times as compliant as its model.
    pub fn with_rod_factor(self, rod_factor: f64) -> Plan {
        Plan { rod_factor, ..self }
    }

    /// With clamps that stand so far from where the campaign has them, m (root mean square).
    pub fn with_clamp_error(self, clamp_error: f64) -> Plan {
        Plan { clamp_error, ..self }
    }
}

/// How far from the middle of the sensors' range the ball comes to rest, m.
pub(super) const AIM: f64 = 0.2 * MM;

/// Where the clamps of the paper's fixture could be (500 × 300 × 151 mm, § 5.2; their places are
/// not published), position in {W} (m) and turn about the vertical (rad). {W} stands upright in the
/// third clamp.
pub(super) const CLAMPS: [([f64; 3], f64); 5] = [
    ([0.10, 0.20, 0.10], 20.0 * DEG),
    ([-0.12, 0.12, 0.0], 95.0 * DEG),
    ([0.0, 0.0, 0.0], 0.0),
    ([-0.12, -0.12, 0.15], -80.0 * DEG),
    ([0.10, -0.20, 0.05], 40.0 * DEG),
];
