//! Zeros of joints that are off by any angle, in all rows.
//!
//! A fit that begins with the file's zero ends in another minimum where that is off by more than
//! some ten degrees. So every joint's zero is turned once round, base and tip placed anew each
//! time, and the angle with which the nominal robot leaves least is a mistake that may have been
//! made.

use std::f64::consts::{PI, TAU};

use super::super::draft::{Draft, DraftChange};
use super::loaded_robot::LoadedRobot;
use super::rough::{has_failed, left_by};
use crate::parallel::in_parallel;
use crate::robot::Motion;
use crate::units::DEG;

/// Angles that are tried of each joint, and how finely the best is sought, rad.
const TURNS: usize = 24;
const WITHIN: f64 = 0.05 * DEG;
/// What the nominal robot leaves must become so much less.
const LESS: f64 = 0.5;
/// A zero that is off by less, rad, a calibration finds by itself; and one so near to a quarter
/// turn is that.
const LEAST: f64 = 3.0 * DEG;

/// Joints with what their angles lack, rad; none where the nominal robot is near enough.
pub fn zeros(draft: &Draft, body: &LoadedRobot) -> Vec<(usize, f64)> {
    if !has_failed(draft, body) {
        return Vec::new();
    }
    let left = |joint: usize, by: f64| {
        left_by(&draft.with(&DraftChange::Zero { joint, by }), body.robot, body.reach)
    };
    let before = left(0, 0.0);
    let best = |joint: usize| {
        let grid = (0..TURNS).map(|k| k as f64 * TAU / TURNS as f64 - PI).map(|by| (by, left(joint, by)));
        let better = |a: (f64, f64), b: (f64, f64)| if b.1 < a.1 { b } else { a };
        let mut best = grid.reduce(better)?;
        let mut step = 0.5 * TAU / TURNS as f64;
        while step > WITHIN {
            let beside = [best.0 - step, best.0 + step].map(|by| (by, left(joint, by)));
            best = beside.into_iter().fold(best, better);
            step *= 0.5;
        }
        // as somebody would type it
        let by = (best.0 / DEG * 10.0).round() / 10.0 * DEG;
        let off_quarter = (by - (by / (0.5 * PI)).round() * 0.5 * PI).abs();
        (best.1 < LESS * before && off_quarter > LEAST).then_some((joint, by))
    };
    let joints: Vec<usize> =
        (0..draft.joint_count).filter(|&j| body.robot.joints[j].motion == Motion::Revolute).collect();
    in_parallel(joints.len(), |k| best(joints[k])).into_iter().flatten().collect()
}
