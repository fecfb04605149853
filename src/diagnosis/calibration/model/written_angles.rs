//! To how many digits joint angles are written.

use crate::calibration::campaign::Recording;
use crate::robot::Motion;
use crate::units::DEG;

/// The step that the angles of each joint are written in, rad; 0 where it is too fine to be seen,
/// where a joint slides, and where it hardly moves: then it is off by the same everywhere.
pub fn written_steps(recording: &Recording, motions: &[Motion]) -> Vec<f64> {
    /// Coarsest and finest last digit that is looked for: powers of ten of a degree, of a radian.
    const DIGITS: std::ops::RangeInclusive<i32> = -5..=0;
    const OF_RADIANS: std::ops::RangeInclusive<i32> = -6..=-2;
    /// The file's decimals are not exact in binary.
    const INEXACT: f64 = 1e-6;
    /// So many steps are a move.
    const MOVES: f64 = 4.0;
    let read = recording.joints_read.as_ref().unwrap_or(&recording.joint_values);
    let of_joint = |(joint, motion): (usize, &Motion)| {
        let angles = || read.chunks(recording.joint_count).map(|row| row[joint]);
        let (least, most) =
            angles().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)));
        let is_step =
            |step: &f64| angles().map(|q| q / step).all(|steps| (steps - steps.round()).abs() < INEXACT);
        let digit =
            |unit: f64| move |digit: i32| [5.0, 2.0, 1.0].map(|count| count * 10f64.powi(digit) * unit);
        let turns = *motion == Motion::Revolute;
        let mut steps = DIGITS.rev().flat_map(digit(DEG)).chain(OF_RADIANS.rev().flat_map(digit(1.0)));
        let step = steps.find(|step| turns && is_step(step)).unwrap_or_default();
        if most - least > MOVES * step { step } else { 0.0 }
    };
    motions.iter().enumerate().map(of_joint).collect()
}
