//! Loads that were typed wrongly in single rows.
//!
//! All channels of an instant know its load (`shown_loads.rs`). Where that is far from the load in
//! the file, two channels or more contradict the file and all agree with it, the load is wrong and
//! not a reading; a single channel is a suspect reading like any other, but where the load in the
//! file is in no other row and the one that it shows is, or where two rows of a run show each
//! other's loads. Which number was meant: another load of the recording, its decimal point
//! elsewhere, or two neighbouring digits exchanged; one that is both, another load and of these
//! digits, before the nearest. What other rows of the same load show as well, or most rows of a
//! run, was not typed wrongly.

use std::collections::BTreeMap;

use super::super::effects::mistakes::TYPING_MISTAKE;
use super::lines::Line;
use super::part::Part;
use super::possible::exact;
use super::shown_loads::{AGREE, LoadByReadings, SCATTERS, ShownLoads};
use crate::diagnosis::rig::recording::columns::{columns, load_column, number_in_file, unit_of_loads};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Estimate, Key};
use crate::rig::readings::LoadColumn;
use crate::spatial::Axis;
use crate::statistics::median;
use crate::units::significant;

/// A load is wrong that its readings are so far from, as a share of a usual one.
const FAR: f64 = 0.1;
/// How near a load must come to a number that it may be, as a share.
const NEAR: f64 = 0.02;
/// By which share the other rows of a run may be off all together.
const RIGHT: f64 = 0.2;
/// By how much a load that has only one of the two reasons, the digits and another row, is less
/// likely than one of both (the logarithm of odds).
const ONE_REASON: f64 = 3.0;
/// Loads may be so many times a usual one.
const MOST: f64 = 150.0;
/// At most this share of the rows.
const FEW: f64 = 0.1;

/// A load that was typed wrongly.
pub(super) struct Entry {
    pub part: Part,
    /// Its rows, from 0.
    pub rows: Vec<usize>,
    /// What it is, N, along the axis; `None` where that is not known.
    pub load: Option<f64>,
}

/// Loads of single rows that all their readings contradict: channels that show loads by themselves,
/// or, of one row, several together.
pub(super) fn found(data: &[Datum], lines: &[Line], unit: LoadColumn) -> Vec<Entry> {
    let known = ShownLoads::of(data, lines);
    let by_themselves = contradicted(&known, unit, |shown| shown.against);
    if !by_themselves.is_empty() {
        return by_themselves;
    }
    let mut together = contradicted(&known, unit, |shown| shown.against_together);
    if together.len() > 1 {
        return Vec::new();
    }
    together.retain(|one| is_beside_right_loads(&known, one));
    together
}

/// True where the other rows of its run show their loads: a run in another unit does not.
fn is_beside_right_loads(known: &ShownLoads, wrong: &Entry) -> bool {
    let Some(wrong) = wrong.part.data.first().map(|&i| &known.data[i]) else { return false };
    let (mut top, mut bottom) = (0.0, 0.0);
    for (own, shown) in known.all() {
        let datum = &known.data[own[0]];
        if datum.run == wrong.run && datum.order != wrong.order {
            let weight = shown.error.powi(-2);
            top += weight * shown.load * datum.signed_load();
            bottom += weight * datum.load.powi(2);
        }
    }
    (top / bottom - 1.0).abs() < RIGHT
}

/// Loads that readings contradict, as far as `against` counts them.
fn contradicted(
    known: &ShownLoads,
    unit: LoadColumn,
    against: impl Fn(&LoadByReadings) -> [f64; 2],
) -> Vec<Entry> {
    let data = known.data;
    let levels: Vec<f64> = data.iter().map(|datum| datum.load).collect();
    let usual = median(&levels).unwrap_or(0.0);
    let (in_file, _) = unit_of_loads(unit);
    let shown = known.all();
    // the weights of two rows of a run hung in the wrong order: each shows the other one's load
    let is_exchanged = |own: &[usize], load: f64| {
        let datum = &data[own[0]];
        shown.iter().any(|(other, by_readings)| {
            let other = &data[other[0]];
            let is_near = |a: f64, b: f64| (a - b).abs() < NEAR * b.abs();
            other.run == datum.run
                && other.order != datum.order
                && other.load != datum.load
                && is_near(load, other.signed_load())
                && is_near(by_readings.load, datum.signed_load())
        })
    };
    let (mut found, mut as_others) = (Vec::new(), Vec::new());
    for (own, shown) in &shown {
        let datum = &data[own[0]];
        let apart = (shown.load - datum.signed_load()).abs();
        let is_wrong = apart > FAR * usual && apart > SCATTERS * shown.error;
        if !is_wrong || shown.off > AGREE {
            continue;
        }
        let along = f64::from(datum.direction.sign) * shown.load;
        // no load is below none, and nobody hangs more than a rig bears
        if along < 0.0 || along > MOST * usual {
            continue;
        }
        // one channel alone may be misread, but for a load that nobody else hung where it shows one
        // that was hung elsewhere, or for two rows that show each other's loads
        let is_elsewhere = |load: f64| {
            let is_same = |d: &&Datum| d.order != datum.order && (d.load - load).abs() < 1e-6 * usual;
            data.iter().any(|d| is_same(&d))
        };
        let error = shown.error.max(NEAR * along.abs() / AGREE);
        let meant = meant(datum.load, &levels, in_file, (along, error));
        let against = against(shown);
        let is_alone = against[1] < AGREE;
        let is_known = !is_elsewhere(datum.load) && meant.is_some_and(is_elsewhere);
        if is_alone && !is_known && !is_exchanged(own, shown.load) {
            continue;
        }
        if against[0] < if is_known { AGREE } else { SCATTERS } {
            continue;
        }
        found.push(entry(data, own, unit, shown, meant, apart * known.most_slope(own)));
        as_others.push(is_as_others(known, own, apart));
    }
    few(data, &known.instants, found, &as_others)
}

/// What is said of a load, and done: `meant` (N) is written instead, or the row is left out.
fn entry(
    data: &[Datum],
    own: &[usize],
    unit: LoadColumn,
    shown: &LoadByReadings,
    meant: Option<f64>,
    explains: f64,
) -> Entry {
    let datum = &data[own[0]];
    let (row, line) = (datum.row, datum.line);
    let (in_file, unit_name) = unit_of_loads(unit);
    let along = f64::from(datum.direction.sign) * shown.load;
    let half = 2.0 * shown.error;
    let written = number_in_file(datum.load / in_file);
    let is = match meant {
        Some(meant) => number_in_file(meant / in_file),
        None => format!("{} ± {}", significant(along / in_file, 3), significant(half / in_file, 1)),
    };
    let location = Key::new(load_column(unit)).rows(format!("row {row}"));
    let readings: Vec<Axis> = own.iter().map(|&i| data[i].channel).collect();
    let verb = if readings.len() == 1 { "is" } else { "are" };
    Entry {
        part: Part {
            effect: &TYPING_MISTAKE,
            observed: format!(
                "The load in row {row} (line {line}) is {written} {unit_name}, but {} {verb} of {is} {unit_name}: write that instead, or leave the row out",
                columns(&readings)
            ),
            looks_like: format!("{location} looks mistyped"),
            location,
            estimates: vec![match meant {
                Some(meant) => exact("n", meant),
                None => Estimate::as_written("n", along, along - half, along + half),
            }],
            explains,
            data: own.to_vec(),
            rivals: Vec::new(),
        },
        rows: own.iter().map(|&i| data[i].row - 1).collect(),
        load: meant,
    }
}

/// Those of `found` that are slips of single rows: what most rows of a load show, or `as_others` of
/// it do, was not typed wrongly, nor what most rows of a run do; and they are few.
fn few(
    data: &[Datum],
    instants: &BTreeMap<usize, Vec<usize>>,
    found: Vec<Entry>,
    as_others: &[bool],
) -> Vec<Entry> {
    let first = |entry: &Entry| &data[entry.part.data[0]];
    let are_most = |among: &[Entry], entry: &Entry, alike: &dyn Fn(&Datum, &Datum) -> bool| {
        let rows = instants.values().filter(|own| alike(&data[own[0]], first(entry))).count();
        let wrong = among.iter().filter(|other| alike(first(other), first(entry))).count();
        wrong > 1 && 2 * wrong > rows
    };
    let of_load = |a: &Datum, b: &Datum| a.direction == b.direction && a.load == b.load;
    let of_run = |a: &Datum, b: &Datum| a.run == b.run;
    let repeat: Vec<bool> = found.iter().map(|entry| are_most(&found, entry, &of_load)).collect();
    let keeps = repeat.iter().zip(as_others).map(|(repeats, is_as_others)| !repeats && !is_as_others);
    let single: Vec<Entry> =
        found.into_iter().zip(keeps).filter_map(|(entry, is_kept)| is_kept.then_some(entry)).collect();
    let are_few = single.len() as f64 <= (FEW * instants.len() as f64).max(1.0);
    match are_few && !single.iter().any(|entry| are_most(&single, entry, &of_run)) {
        true => single,
        false => Vec::new(),
    }
}

/// True where other rows of the same load show what this one does: not half as far from it as its
/// load is `apart` from the one in the file, N. Friction, play and curves do.
fn is_as_others(known: &ShownLoads, own: &[usize], apart: f64) -> bool {
    let data = known.data;
    // the load by which it differs from theirs, by all channels as each knows it
    let (mut top, mut bottom) = (0.0, 0.0);
    for &i in own {
        let Some(line) = known.line(i) else { continue };
        let is_other = |other: &&usize| {
            let other = &data[**other];
            other.order != data[i].order
                && other.direction == data[i].direction
                && other.load == data[i].load
                && other.is_unloading() == data[i].is_unloading()
        };
        let others: Vec<f64> = line.data.iter().filter(is_other).map(|&other| data[other].measured).collect();
        let Some(others) = median(&others) else { continue };
        let weight = line.scatter_of_readings().powi(-2);
        top += weight * line.fit.slope * (data[i].measured - others);
        bottom += weight * line.fit.slope.powi(2);
    }
    bottom > 0.0 && (top / bottom).abs() < 0.5 * apart
}

/// The load that was meant, N: one that another row has, or the written one with its decimal point
/// elsewhere or two digits exchanged; the likeliest of those that the readings, `shown` N with
/// their standard error, do not contradict.
///
/// ```text
/// z²/2 + what is unlikely about it
/// ```
fn meant(written: f64, levels: &[f64], in_file: f64, (shown, error): (f64, f64)) -> Option<f64> {
    let is_same = |a: f64, b: f64| (a - b).abs() < 1e-6 * b.abs();
    let is_level = |load: f64| levels.iter().any(|&level| is_same(load, level));
    let its_digits = of_its_digits(written / in_file).into_iter().map(|load| (load * in_file, true));
    let others = levels.iter().map(|&level| (level, false));
    let possible = its_digits.chain(others).filter(|(load, _)| load.is_finite() && !is_same(*load, written));
    let cost = |&(load, is_by_digits): &(f64, bool)| {
        let z = (load - shown) / error;
        let is_both = is_by_digits && is_level(load);
        let (away, unlikely) = if is_both { (AGREE, 0.0) } else { (AGREE / 2.0, ONE_REASON) };
        (z.abs() < away).then_some((load, 0.5 * z * z + unlikely))
    };
    possible.filter_map(|one| cost(&one)).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(load, _)| load)
}

/// A number with its decimal point elsewhere, or two neighbouring digits exchanged.
fn of_its_digits(written: f64) -> Vec<f64> {
    let mut found: Vec<f64> = [0.01, 0.1, 10.0, 100.0].map(|factor| factor * written).to_vec();
    let digits: Vec<char> = number_in_file(written).chars().collect();
    for i in 1..digits.len() {
        let mut other = digits.clone();
        other.swap(i - 1, i);
        found.extend(other.iter().collect::<String>().parse::<f64>());
    }
    found
}
