//! One weight that is not what it is said to be: all its rows show another load.
//!
//! ```text
//! m_k = Σ w·(F − F_k)/Σ w      over the rows of the load F_k, F by their readings, w = 1/σ²
//! ```
//!
//! A weight is wrong where m_k is far beyond its own error and beyond all other m, and every row of
//! it shows that, in every run and along every axis. What bends a line moves the loads beside it
//! too, and the least and the largest load more than others (play, a stop): of these two nothing is
//! said.

use std::collections::{BTreeMap, BTreeSet};

use super::super::effects::mistakes::WEIGHT_MISTAKE;
use super::lines::{Line, fit};
use super::part::Part;
use super::shown_loads::{AGREE, LoadByReadings, SCATTERS, ShownLoads};
use crate::diagnosis::rig::recording::columns::{columns, load_column, number_in_file, unit_of_loads};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Estimate, Key};
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::statistics::HALF_95;
use crate::units::with_uncertainty;

/// So many loads show which one of them is off, and so many runs that it is so in each.
const LEVELS: usize = 5;
/// Loads that are measured are all different.
const MOST_LEVELS: usize = 60;
const RUNS: usize = 2;
/// A wrong weight is so many times as far off as the farthest of the others.
const ALONE: f64 = 5.0;
/// By how much a row may be off what the others of the load show, as a share of that.
const ALIKE: f64 = 0.5;

/// The rows of one load.
struct Level {
    load: f64,
    /// What hung there beyond that by the readings, N, with its standard error.
    beyond: f64,
    error: f64,
    /// True where rows of several runs show that, and none contradicts it.
    is_repeated: bool,
    data: Vec<usize>,
    /// True where two channels of a row show it, or rows of two axes.
    is_shown_twice: bool,
}

/// The weight that is another one, if there is just one.
pub(super) fn found(data: &[Datum], lines: &[Line], unit: LoadColumn) -> Option<Part> {
    if data.iter().any(|datum| datum.imposed.is_some()) {
        return None;
    }
    let first = levels(&ShownLoads::of(data, lines));
    if !(LEVELS..=MOST_LEVELS).contains(&first.len()) {
        return None;
    }
    let within = &first[1..first.len() - 1];
    let farthest = within.iter().max_by(|a, b| a.beyond.abs().total_cmp(&b.beyond.abs()))?;
    // lines that this load does not draw to itself
    let without = |line: &Line| {
        let others = line.data.iter().map(|&i| &data[i]).filter(|datum| datum.load != farthest.load);
        let points: Vec<(f64, f64)> = others.map(|datum| (datum.signed_load(), datum.measured)).collect();
        Line { fit: fit(&points), ..line.clone() }
    };
    let known = ShownLoads::of(data, &lines.iter().map(without).collect::<Vec<_>>());
    let levels = levels(&known);
    let wrong = levels.iter().find(|level| level.load == farthest.load)?;
    let others = levels.iter().filter(|level| level.load != wrong.load);
    let farthest = others.fold(0.0, |most: f64, level| most.max(level.beyond.abs()));
    let apart = wrong.beyond.abs();
    let is_wrong = wrong.is_repeated && apart > SCATTERS * wrong.error && apart > ALONE * farthest;
    is_wrong.then(|| part(&known, wrong, unit))
}

/// All loads but none, the least first.
fn levels(known: &ShownLoads) -> Vec<Level> {
    let data = known.data;
    let mut rows: BTreeMap<u64, Vec<(&[usize], LoadByReadings)>> = BTreeMap::new();
    for (own, shown) in known.all() {
        let datum = &data[own[0]];
        if datum.load > 0.0 {
            // positive numbers are in the order of their bits
            rows.entry(datum.load.to_bits()).or_default().push((own, shown));
        }
    }
    rows.into_iter().map(|(bits, rows)| level(data, f64::from_bits(bits), &rows)).collect()
}

/// What the rows of one load show together.
fn level(data: &[Datum], load: f64, rows: &[(&[usize], LoadByReadings)]) -> Level {
    let first = |own: &[usize]| &data[own[0]];
    let of_row = |(own, shown): &(&[usize], LoadByReadings)| {
        (f64::from(first(own).direction.sign) * shown.load - load, shown.error)
    };
    let beyond: Vec<(f64, f64)> = rows.iter().map(of_row).collect();
    let weight: f64 = beyond.iter().map(|(_, error)| error.powi(-2)).sum();
    let all = beyond.iter().map(|(beyond, error)| beyond / error.powi(2)).sum::<f64>() / weight;
    // they scatter by more than their errors where zeros differ from run to run
    let chi = beyond.iter().map(|(beyond, error)| ((beyond - all) / error).powi(2)).sum::<f64>();
    let scatter = (chi / (beyond.len() - 1).max(1) as f64).sqrt().max(1.0);
    let is_like_all =
        |(beyond, error): &(f64, f64)| (beyond - all).abs() < (ALIKE * all.abs()).max(AGREE * error);
    let showing = || rows.iter().filter(|(_, shown)| AGREE * shown.error < all.abs());
    let runs = different(showing().map(|(own, _)| first(own).run));
    let axes = different(showing().map(|(own, _)| first(own).direction.axis));
    Level {
        load,
        beyond: all,
        error: weight.powf(-0.5) * scatter,
        is_repeated: runs >= RUNS && beyond.iter().all(is_like_all),
        data: rows.iter().flat_map(|(own, _)| own.iter().copied()).collect(),
        is_shown_twice: axes > 1 || rows.iter().any(|(_, shown)| shown.against[1] > AGREE),
    }
}

fn different<T: Ord>(all: impl Iterator<Item = T>) -> usize {
    all.collect::<BTreeSet<T>>().len()
}

/// What is said of a weight; its rows are left out.
fn part(known: &ShownLoads, wrong: &Level, unit: LoadColumn) -> Part {
    let data = known.data;
    let (in_file, unit_name) = unit_of_loads(unit);
    let (is, half) = (wrong.load + wrong.beyond, HALF_95 * wrong.error);
    let stated = format!("{} {unit_name}", number_in_file(wrong.load / in_file));
    let rows = different(wrong.data.iter().map(|&i| data[i].order));
    // the channel that moves most
    let moves = |&i: &usize| known.line(i).map_or(0.0, |line| line.fit.slope.abs());
    let most = wrong.data.iter().max_by(|a, b| moves(a).total_cmp(&moves(b)));
    let channels: Vec<Axis> = most.iter().map(|&&i| data[i].channel).collect();
    let or = match wrong.is_shown_twice {
        true => String::new(),
        false => format!(", unless {} errs there", columns(&channels)),
    };
    let location = Key::new(load_column(unit)).rows(format!("all rows of {stated}"));
    Part {
        effect: &WEIGHT_MISTAKE,
        observed: format!(
            "The weight of {stated} is {} {unit_name} by the readings of all its {rows} rows{or}: leave these rows out until it is weighed",
            with_uncertainty(is / in_file, half / in_file, 4),
        ),
        looks_like: format!("the weight of {stated} looks like another one"),
        location,
        estimates: vec![Estimate::as_written("n", is, is - half, is + half)],
        explains: wrong.beyond.abs() * known.most_slope(&wrong.data),
        data: wrong.data.clone(),
        rivals: Vec::new(),
    }
}
