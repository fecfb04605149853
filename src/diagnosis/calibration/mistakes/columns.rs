//! Columns without information: the same value in all rows, or the values of another column.

use super::super::effects::mistakes::{COPIED_COLUMN, STUCK_SENSOR};
use super::draft::Draft;
use super::names::{AXES, column};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Estimate, Key};
use crate::robot::Motion;
use crate::units::{DEG, MM, significant};

/// Fewest rows in which equal values are no accident.
const FEWEST: usize = 5;
/// Values that differ by less are the same, rad or m: below the last digit of any file.
pub(super) const SAME: f64 = 1e-12;

/// Something that is said of a column, and cannot be undone.
pub(super) struct Silent {
    pub effect: &'static Effect,
    pub location: Key,
    pub estimates: Vec<Estimate>,
    pub cure: String,
    pub why: String,
    /// Ln of the odds that so many numbers do not agree by chance.
    pub log_odds: f64,
    /// A joint that does not move may be meant not to: it counts where the fit fails.
    pub only_if_failed: bool,
}

/// Ln of the odds against the chance that so many numbers agree with others to the last digit,
/// which each of them does once in ten times.
pub(super) fn agreement(numbers: usize) -> f64 {
    numbers as f64 * std::f64::consts::LN_10
}

/// All columns that do not change, or stand twice.
pub(super) fn silent(campaign: &Campaign, draft: &Draft) -> Vec<Silent> {
    if draft.len() < FEWEST {
        return Vec::new();
    }
    let mut all = positions(draft);
    all.extend(joints(campaign, draft));
    all
}

pub(super) fn is_constant(values: &[f64]) -> bool {
    values.iter().all(|value| (value - values[0]).abs() <= SAME)
}

/// Positions have been turned into {W} and back.
fn are_same(first: &[f64], second: &[f64]) -> bool {
    first.iter().zip(second).all(|(first, second)| (first - second).abs() <= SAME)
}

fn positions(draft: &Draft) -> Vec<Silent> {
    if draft.has_sockets() {
        return Vec::new();
    }
    let names = AXES;
    let of_axis = |axis: usize| -> Vec<f64> { draft.seen.iter().map(|seen| seen[axis]).collect() };
    let columns: Vec<Vec<f64>> = (0..3).map(of_axis).collect();
    let still: Vec<usize> = (0..3).filter(|&axis| is_constant(&columns[axis])).collect();
    let shown = |axis: usize| columns[axis][0] / MM;
    let mut all = Vec::new();
    if still.len() == 3 {
        let is_zero = still.iter().all(|&axis| shown(axis) == 0.0);
        let what = if is_zero { "all of them are zero" } else { "they are the same in all rows" };
        let location = Key::new(AXES.join(", "));
        let log_odds = agreement(3 * (draft.len() - 1));
        all.push(Silent {
            log_odds,
            ..stuck(location, Vec::new(), "x_mm, y_mm and z_mm", what.into(), draft.len())
        });
    } else {
        for axis in still {
            let value = shown(axis);
            let estimate = Estimate::as_written("mm", value, value, value);
            let what = format!("it is {} mm in all rows", significant(value, 4));
            all.push(stuck(Key::new(names[axis]), vec![estimate], names[axis], what, draft.len()));
        }
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            if are_same(&columns[a], &columns[b]) && !is_constant(&columns[a]) {
                all.push(copied(names[a], names[b], draft.len()));
            }
        }
    }
    all
}

fn joints(campaign: &Campaign, draft: &Draft) -> Vec<Silent> {
    let count = draft.joint_count;
    let name = |joint: usize| column(&campaign.robot, joint);
    let of_joint =
        |joint: usize| -> Vec<f64> { draft.joints.iter().skip(joint).step_by(count).copied().collect() };
    let columns: Vec<Vec<f64>> = (0..count).map(of_joint).collect();
    let mut all = Vec::new();
    for a in 0..count {
        if is_constant(&columns[a]) {
            let (unit, symbol, key) = match campaign.robot.joints[a].motion {
                Motion::Revolute => (DEG, "°", "deg"),
                Motion::Prismatic => (MM, " mm", "mm"),
            };
            let value = columns[a][0] / unit;
            let estimate = Estimate::as_written(key, value, value, value);
            let what =
                format!("it is {}{symbol} in all rows, and the poses do not fit", significant(value, 4));
            let still = stuck(Key::new(name(a)), vec![estimate], &name(a), what, draft.len());
            all.push(Silent { only_if_failed: true, ..still });
            continue;
        }
        for b in a + 1..count {
            if are_same(&columns[a], &columns[b]) {
                all.push(copied(&name(a), &name(b), draft.len()));
            }
        }
    }
    all
}

pub(super) fn stuck(location: Key, estimates: Vec<Estimate>, what: &str, why: String, rows: usize) -> Silent {
    let cure = format!("Record {what} once more");
    let log_odds = agreement(rows - 1);
    Silent { effect: &STUCK_SENSOR, location, estimates, cure, why, log_odds, only_if_failed: false }
}

fn copied(first: &str, second: &str, rows: usize) -> Silent {
    Silent {
        effect: &COPIED_COLUMN,
        location: Key::new(format!("{first} and {second}")),
        estimates: Vec::new(),
        cure: format!("Put the right numbers into {first} or {second}"),
        why: "both columns hold the same".into(),
        log_odds: agreement(rows),
        only_if_failed: false,
    }
}
