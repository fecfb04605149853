//! Joint angles that are written to so few digits that the tip scatters by it.
//!
//! ```text
//! σ² = Σⱼ step²/12·|Jⱼ|²/3       of a coordinate, mean over the poses; rounding errors are uniform
//! ```
//!
//! Angles to which an arm was sent, and which it reached, are round without any error: then less is
//! left than rounding would leave.

use super::super::model::Context;
use crate::diagnosis::Limitation;
use crate::units::DEG;

/// Coarsest and finest last digit that is looked for: degrees to the power of ten.
const DIGITS: std::ops::RangeInclusive<i32> = -5..=0;
/// The file's decimals are not exact in binary.
const INEXACT: f64 = 1e-6;
/// Variance of rounding over that which is left: less is not worth a word, more is not there.
const SHARE: std::ops::RangeInclusive<f64> = 0.25..=2.0;

/// The remark where rounding is a large part of what is left, m per coordinate.
pub fn coarse_angles(context: &Context, left: f64) -> Option<Limitation> {
    let joints = context.revolute();
    let recording = context.recording;
    let read = recording.joints_read.as_ref().unwrap_or(&recording.joint_values);
    let is_step = |step: &f64| {
        read.chunks(recording.joint_count).all(|row| {
            joints.iter().map(|&j| row[j] / (step * DEG)).all(|steps| (steps - steps.round()).abs() < INEXACT)
        })
    };
    let step = DIGITS.rev().map(|digit| 10f64.powi(digit)).find(is_step)?;
    let of_pose = |lever: f64| lever * (step * DEG).powi(2) / 36.0;
    let squares = context
        .configurations
        .iter()
        .map(|there| of_pose(joints.iter().map(|&j| there.tip_jacobian[j].norm_squared()).sum()));
    let variance = squares.sum::<f64>() / context.configurations.len().max(1) as f64;
    SHARE.contains(&(variance / left.powi(2))).then(|| Limitation::CoarseAngles(step, variance.sqrt()))
}
