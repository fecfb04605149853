//! Loads that were others in one trial alone: a hanger that nobody counted.
//!
//! A single line of a trial shows nothing that its zero does not: a load that was forgotten is
//! looked for where two lines at least show it.

use std::collections::BTreeMap;

use super::entry::Entry;
use crate::diagnosis::rig::mechanics::action::Weights;
use crate::diagnosis::rig::recording::columns::{load_column, trial_name};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Key;
use crate::rig::readings::LoadColumn;

/// Of fewer trials nobody knows which one is off; of more nobody looks.
const FEWEST: usize = 3;
const MOST: usize = 100;
/// A line shows a load by so much of what the largest does.
const SHOWN: f64 = 0.05;
/// Lines that must show it.
const LINES: usize = 2;

/// What `make` makes of each trial, by the rows that it is, with what a newton more does to its
/// readings, m: together as likely as one of all trials.
pub(super) fn of_trials(
    data: &[Datum],
    column: LoadColumn,
    make: impl Fn(Key, Weights) -> Entry,
) -> Vec<Entry> {
    let per_newton = |datum: &Datum| datum.predicted / datum.load;
    let mut trials: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, datum) in data.iter().enumerate() {
        if datum.load > 0.0 && datum.imposed.is_none() {
            trials.entry(datum.trial_number).or_default().push(i);
        }
    }
    if !(FEWEST..=MOST).contains(&trials.len()) {
        return Vec::new();
    }
    let largest = trials.values().flatten().fold(0.0, |most: f64, &i| most.max(per_newton(&data[i]).abs()));
    let is_shown = |own: &Vec<usize>| {
        let shown = own.iter().filter(|&&i| per_newton(&data[i]).abs() > SHOWN * largest);
        let mut lines: Vec<_> =
            shown.map(|&i| (data[i].direction.axis.index(), data[i].channel.index())).collect();
        lines.sort_unstable();
        lines.dedup();
        lines.len() >= LINES
    };
    trials.retain(|_, own| is_shown(own));
    let count = trials.len() as f64;
    let of_trial = |(number, own): (usize, Vec<usize>)| {
        let name = trial_name(&data[own[0]]).unwrap_or_else(|| (number + 1).to_string());
        let trial = Key::new(load_column(column)).rows(format!("trial {name}"));
        let weights = own.into_iter().map(|i| (i, per_newton(&data[i]))).collect();
        let (mut candidate, actions) = make(trial, weights);
        candidate.weight = 1.0 / count;
        (candidate, actions)
    };
    trials.into_iter().map(of_trial).collect()
}
