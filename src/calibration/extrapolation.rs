//! Where a calibrated robot is asked for poses that the calibration has not seen.
//!
//! ```text
//! variance of a predicted tip    tr(J·Σ·Jᵀ)    J = ∂tip/∂ρ of the robot's own parameters, Σ their covariance
//! ```
//!
//! and its mean over the poses asked for, beside that over the calibration's own. Base and tool are
//! left out: whoever aligns the robot anew fits them again.

use nalgebra::{DMatrix, Matrix3xX};

use super::campaign::Recording;
use crate::robot::{Kinematics, Motion, Parameter, Setup};

/// Poses asked for, against those of the calibration.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Extrapolation {
    /// Standard deviation of a predicted tip by the parameters' uncertainty, root mean square over
    /// the poses asked for, m.
    pub sd: f64,
    /// The same over the calibration's own poses, m.
    pub sd_calibrated: f64,
    /// For each joint the range of the poses asked for and that of the calibration, rad or m.
    pub ranges: Vec<[(f64, f64); 2]>,
    /// Motion of each joint.
    pub motions: Vec<Motion>,
    /// For each joint the share of the poses asked for that lie beyond the calibration's range.
    pub beyond: Vec<f64>,
}

/// A joint beyond its calibrated range: number from 0, range asked for, range calibrated, rad or m.
pub type JointBeyond = (usize, (f64, f64), (f64, f64));

/// A calibrated robot as far as it is asked here.
pub(super) struct Known<'a> {
    pub setup: &'a Setup<'a>,
    pub free: &'a [Parameter],
    /// Of the free parameters first, SI.
    pub covariance: &'a DMatrix<f64>,
}

impl Extrapolation {
    /// `asked` against the `recording` of a calibration.
    pub(super) fn new(known: &Known, recording: &Recording, asked: &Recording) -> Self {
        let joints = known.setup.robot.joints.len();
        let range = |poses: &Recording, joint: usize| {
            let values = (0..poses.len()).map(|row| poses.joints(row)[joint]);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)))
        };
        let ranges: Vec<_> = (0..joints).map(|j| [range(asked, j), range(recording, j)]).collect();
        let beyond = |joint: usize| {
            let (low, high) = ranges[joint][1];
            let is_beyond = |row: &usize| !(low..=high).contains(&asked.joints(*row)[joint]);
            (0..asked.len()).filter(is_beyond).count() as f64 / asked.len().max(1) as f64
        };
        Extrapolation {
            sd: sd(known, asked),
            sd_calibrated: sd(known, recording),
            beyond: (0..joints).map(beyond).collect(),
            motions: known.setup.robot.joints.iter().map(|joint| joint.motion).collect(),
            ranges,
        }
    }

    /// How many times more uncertain the robot's own numbers make it there.
    pub fn ratio(&self) -> f64 {
        self.sd / self.sd_calibrated.max(f64::MIN_POSITIVE)
    }

    /// Joints of which more than a tenth of the poses asked for lie beyond the calibration's range,
    /// by more than a tenth of that range: number from 0, range asked for, range calibrated.
    pub fn joints_beyond(&self) -> Vec<JointBeyond> {
        let is_beyond = |(joint, [asked, own]): &(usize, &[(f64, f64); 2])| {
            let margin = 0.1 * (own.1 - own.0);
            self.beyond[*joint] > 0.1 && (asked.0 < own.0 - margin || asked.1 > own.1 + margin)
        };
        let all = self.ranges.iter().enumerate().filter(is_beyond);
        all.map(|(joint, [asked, own])| (joint, *asked, *own)).collect()
    }
}

/// Root mean square of √tr(J·Σ·Jᵀ) over a recording, m.
pub(super) fn sd(known: &Known, recording: &Recording) -> f64 {
    let own: Vec<usize> = (0..known.free.len())
        .filter(|&k| !known.free[k].is_placement() && known.covariance[(k, k)].is_finite())
        .collect();
    if own.is_empty() || recording.is_empty() {
        return 0.0;
    }
    let covariance = DMatrix::from_fn(own.len(), own.len(), |i, j| known.covariance[(own[i], own[j])]);
    let mut kinematics = Kinematics::new(known.setup);
    // where the arm stands is what counts, and weights hardly move it
    let torque = vec![0.0; known.setup.robot.joints.len()];
    let variance = |row: usize| {
        kinematics.update(recording.joints(row), &torque);
        let columns: Vec<_> = own.iter().map(|&k| kinematics.column(known.free[k], &torque)).collect();
        let jacobian = Matrix3xX::from_columns(&columns);
        (&jacobian * &covariance * jacobian.transpose()).trace()
    };
    let total: f64 = (0..recording.len()).map(variance).sum();
    (total / recording.len() as f64).max(0.0).sqrt()
}

/// `220° against 23°`.
pub(super) fn ranges(asked: (f64, f64), own: (f64, f64), motion: Motion) -> String {
    let (unit, si) = match motion {
        Motion::Revolute => ("°", crate::units::DEG),
        Motion::Prismatic => (" mm", crate::units::MM),
    };
    let size = |(low, high): (f64, f64)| crate::units::significant((high - low) / si, 3);
    format!("{}{unit} against {}{unit}", size(asked), size(own))
}
