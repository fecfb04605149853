//! Columns without information: the same value in all rows, or the values of another column.

use super::super::effects::mistakes::{COPIED_COLUMN, STUCK_SENSOR};
use super::draft::Draft;
use super::names::{AXES, column};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Estimate};
use crate::robot::Motion;
use crate::units::{DEG, MM, significant};

/// Fewest rows in which equal values are no accident.
const FEWEST: usize = 5;
/// Values that differ by less are the same, rad or m: below the last digit of any file.
const SAME: f64 = 1e-12;

/// Something that is said of a column, and cannot be undone.
pub(super) struct Silent {
    pub effect: &'static Effect,
    pub location: String,
    pub estimates: Vec<Estimate>,
    pub cure: String,
    pub why: String,
    /// A joint that does not move may be meant not to: it counts where the fit fails.
    pub only_if_failed: bool,
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

fn is_constant(values: &[f64]) -> bool {
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
        all.push(stuck("x_mm, y_mm, z_mm".into(), Vec::new(), "x_mm, y_mm and z_mm", what.into(), false));
    } else {
        for axis in still {
            let value = shown(axis);
            let estimate = Estimate { name: "mm".into(), unit: 1.0, value, low: value, high: value };
            let what = format!("it is {} mm in all rows", significant(value, 4));
            all.push(stuck(names[axis].into(), vec![estimate], names[axis], what, false));
        }
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            if are_same(&columns[a], &columns[b]) && !is_constant(&columns[a]) {
                all.push(copied(names[a], names[b]));
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
            let estimate = Estimate { name: key.into(), unit: 1.0, value, low: value, high: value };
            let what =
                format!("it is {}{symbol} in all rows, and the poses do not fit", significant(value, 4));
            all.push(stuck(name(a), vec![estimate], &name(a), what, true));
            continue;
        }
        for b in a + 1..count {
            if are_same(&columns[a], &columns[b]) {
                all.push(copied(&name(a), &name(b)));
            }
        }
    }
    all
}

fn stuck(
    location: String,
    estimates: Vec<Estimate>,
    what: &str,
    why: String,
    only_if_failed: bool,
) -> Silent {
    let cure = format!("Record {what} once more");
    Silent { effect: &STUCK_SENSOR, location, estimates, cure, why, only_if_failed }
}

fn copied(first: &str, second: &str) -> Silent {
    Silent {
        effect: &COPIED_COLUMN,
        location: format!("{first} and {second}"),
        estimates: Vec::new(),
        cure: format!("Put the right numbers into {first} or {second}"),
        why: "both columns hold the same".into(),
        only_if_failed: false,
    }
}
