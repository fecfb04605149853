//! Displays that stood still for a while, or are at the end of their range.
//!
//! Numbers that are the same to the last digit are no accident where others hardly ever are: with p
//! the share of neighbours that are equal elsewhere, k equal ones of n rows have
//!
//! ```text
//! ln odds = −(k − 1)·ln p − ln n
//! ```
//!
//! neighbours in the order of recording for a display that stood still, in the order of their size
//! for a limit. Such rows say nothing of the robot, so that nothing else is looked for in them;
//! they are spoken of where they do not fit what the others say (`slips/held.rs`).

use super::columns::{SAME, Silent, is_constant, stuck};
use super::draft::{Draft, DraftChange};
use super::names::AXES;
use crate::diagnosis::calibration::effects::mistakes::{SATURATED_SENSOR, STUCK_SENSOR};
use crate::inference::{Effect, Estimate, Key};
use crate::units::{MM, significant};

/// Fewest equal values that are looked at.
const FEWEST: usize = 5;
/// Ln of the odds from which on they are no accident: 1000.
const ODDS: f64 = 6.907_755;

/// Rows in which columns show what they have stopped at.
pub(super) struct Held {
    axes: Vec<usize>,
    /// By their numbers in the recording.
    pub rows: Vec<usize>,
    /// What each shows; of a limit one column's one or two.
    values: Vec<f64>,
    pub is_limit: bool,
    pub log_odds: f64,
}

/// All axes of devices or trackers that stood still for a while or were at their limits. A joint
/// that does not move may be intended.
pub(super) fn held(draft: &Draft) -> Vec<Held> {
    let of_axis = |axis: usize| -> Vec<f64> { draft.seen.iter().map(|seen| seen[axis]).collect() };
    let axes = 0..if draft.has_sockets() { 0 } else { 3 };
    let axes = axes.flat_map(|axis| {
        let values = of_axis(axis);
        let limits = at_limits(axis, &values);
        let mut all = still(axis, &values);
        let is_at_limit = |row: &usize| limits.as_ref().is_some_and(|limits| limits.rows.contains(row));
        all.retain(|held| !held.rows.iter().all(is_at_limit));
        all.extend(limits);
        all
    });
    let mut all: Vec<Held> = Vec::new();
    for held in axes {
        // all of a device stops at once
        match all.iter_mut().find(|known| known.is_as(&held)) {
            Some(known) => known.join(held),
            None => all.push(held),
        }
    }
    all
}

/// Stretches of equal values.
fn still(axis: usize, values: &[f64]) -> Vec<Held> {
    let stretch = |(rows, log_odds): (Vec<usize>, f64)| Held {
        axes: vec![axis],
        values: vec![values[rows[0]]],
        rows,
        is_limit: false,
        log_odds,
    };
    equal_neighbours(values, FEWEST).into_iter().map(stretch).collect()
}

/// Places of so many equal values or more, one after the other, that are no accident, and ln of
/// the odds that they are none; nothing where all are equal.
pub(super) fn equal_neighbours(values: &[f64], fewest: usize) -> Vec<(Vec<usize>, f64)> {
    if is_constant(values) {
        return Vec::new();
    }
    let rows: Vec<usize> = (0..values.len()).collect();
    let runs: Vec<&[usize]> = rows.chunk_by(|&a, &b| (values[a] - values[b]).abs() <= SAME).collect();
    let short = || runs.iter().filter(|run| run.len() < fewest);
    let equal: usize = short().map(|run| run.len() - 1).sum();
    let chance = share(equal, short().map(|run| run.len()).sum());
    let odds = |run: &&&[usize]| (run.to_vec(), ln_odds(run.len(), chance, values.len()));
    let long = runs.iter().filter(|run| run.len() >= fewest);
    long.map(|run| odds(&run)).filter(|(_, odds)| *odds > ODDS).collect()
}

/// The largest and the smallest value, where one of them stands in many rows.
fn at_limits(axis: usize, values: &[f64]) -> Option<Held> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let levels: Vec<&[usize]> = order.chunk_by(|&a, &b| (values[a] - values[b]).abs() <= SAME).collect();
    let [lowest, between @ .., highest] = &levels[..] else { return None };
    let equal: usize = between.iter().map(|level| level.len() - 1).sum();
    let chance = share(equal, between.iter().map(|level| level.len()).sum());
    // what stood still there is no limit
    let is_apart = |rows: &[usize]| {
        let mut rows = rows.to_vec();
        rows.sort_unstable();
        rows.windows(2).any(|pair| pair[1] > pair[0] + 1)
    };
    let odds = |level: &[usize]| ln_odds(level.len(), chance, values.len());
    let is_limit = |level: &&&[usize]| level.len() >= FEWEST && odds(level) > ODDS && is_apart(level);
    let limits: Vec<&[usize]> = [lowest, highest].into_iter().filter(is_limit).copied().collect();
    let mut rows: Vec<usize> = limits.concat();
    rows.sort_unstable();
    (!rows.is_empty()).then(|| Held {
        axes: vec![axis],
        rows,
        values: limits.iter().map(|level| values[level[0]]).collect(),
        is_limit: true,
        log_odds: limits.iter().map(|level| odds(level)).sum(),
    })
}

/// Share of equal neighbours, of some numbers: half of one at least.
fn share(equal: usize, numbers: usize) -> f64 {
    (equal as f64 + 0.5) / (numbers as f64 + 1.0)
}

fn ln_odds(equal: usize, chance: f64, rows: usize) -> f64 {
    -(equal as f64 - 1.0) * chance.ln() - (rows as f64).ln()
}

/// All of them, where fewer than half of the rows are none: of these nobody can see what is wrong
/// with the others.
pub(super) fn mostly_held(draft: &Draft, all: &[Held]) -> Vec<Silent> {
    if 2 * rows(all).len() <= draft.len() {
        return Vec::new();
    }
    let silent = |held: &Held| {
        let why = format!("it {}, in {} of {} rows", held.said(), held.rows.len(), draft.len());
        let (names, estimates) = (held.names(), held.estimates());
        let plain = stuck(Key::new(&names), estimates, &names, why, draft.len());
        let longer = if held.is_limit { ", with a sensor of a longer range" } else { "" };
        let cure = format!("{}{longer}", plain.cure);
        Silent { effect: held.effect(), log_odds: held.log_odds, cure, ..plain }
    };
    all.iter().map(silent).collect()
}

/// The other rows, where they are the half at least.
pub(super) fn without_held(draft: Draft, all: &[Held]) -> Draft {
    let rows = rows(all);
    match rows.is_empty() || 2 * rows.len() > draft.len() {
        true => draft,
        false => draft.with(&DraftChange::Without(rows)),
    }
}

/// The rows of all of them.
fn rows(all: &[Held]) -> Vec<usize> {
    let mut rows: Vec<usize> = all.iter().flat_map(|held| held.rows.iter().copied()).collect();
    rows.sort_unstable();
    rows.dedup();
    rows
}

impl Held {
    pub(super) fn effect(&self) -> &'static Effect {
        if self.is_limit { &SATURATED_SENSOR } else { &STUCK_SENSOR }
    }

    /// True for columns that have stopped in the same rows.
    fn is_as(&self, other: &Held) -> bool {
        !self.is_limit && !other.is_limit && self.rows == other.rows
    }

    fn join(&mut self, other: Held) {
        self.axes.extend(other.axes);
        self.values.extend(other.values);
        self.log_odds += other.log_odds;
    }

    /// `x_mm, y_mm`.
    pub(super) fn names(&self) -> String {
        self.axes.iter().map(|axis| AXES[*axis]).collect::<Vec<_>>().join(", ")
    }

    /// The one value that a column shows; of several there is no one number.
    pub(super) fn estimates(&self) -> Vec<Estimate> {
        let [value] = self.values[..] else { return Vec::new() };
        vec![Estimate::as_written("mm", value / MM, value / MM, value / MM)]
    }

    /// `stays at 0.137 mm`.
    pub(super) fn said(&self) -> String {
        let shown: Vec<String> = self.values.iter().map(|value| significant(value / MM, 4)).collect();
        match (self.is_limit, self.axes.len()) {
            (true, _) => format!("is cut off at {} mm", shown.join(" and ")),
            (false, 1) => format!("stays at {} mm", shown.join("")),
            (false, _) => "stay as they are".to_owned(),
        }
    }
}
