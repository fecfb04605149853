//! Loads that were typed wrongly in single rows.
//!
//! All channels of a row know its load:
//!
//! ```text
//! F = Σ w·s·(y − a) / Σ w·s²,   w = 1/σ²
//! ```
//!
//! s, a and σ slope, zero and scatter of the line of each channel. Where that is far from the load in
//! the file, and every channel agrees with it, the load is wrong and not a reading. With a single
//! channel nobody can distinguish the two; then the number itself must say so: another load of the
//! recording, its digits exchanged, or its decimal point elsewhere.

use std::collections::BTreeMap;

use super::super::datum::Datum;
use super::super::effects::mistakes::ENTRY_MISTAKE;
use super::change::exact;
use super::lines::Line;
use super::moves::{column, load_column};
use super::part::Part;
use crate::inference::Estimate;
use crate::rig::readings::LoadColumn;
use crate::units::{STANDARD_GRAVITY, significant};

/// A load is wrong that its readings are so far from: in scatters, and as a share of the largest.
const SCATTERS: f64 = 8.0;
const FAR: f64 = 0.1;
/// How well the channels of a row agree about its load, in scatters, and how near it must come to
/// a number that it may be, as a share.
const AGREE: f64 = 4.0;
const NEAR: f64 = 0.02;
/// Lines of fewer readings say nothing of one of them.
const LEAST: usize = 6;
/// At most this share of the rows.
const FEW: f64 = 0.1;

/// A load that was typed wrongly.
pub(super) struct Entry {
    pub part: Part,
    /// From 0.
    pub row: usize,
    /// What it is, N, along the axis; `None` where that is not known.
    pub load: Option<f64>,
}

/// What the channels of a row say of its load.
struct Said {
    /// N, with its standard error.
    load: f64,
    error: f64,
    /// Channels that show loads along this axis.
    channels: usize,
    /// How far the reading that agrees the least is off it, and off the load in the file, in
    /// scatters.
    off: f64,
    off_before: f64,
}

/// Loads of single rows that all their readings contradict.
pub(super) fn found(data: &[Datum], lines: &[Line], unit: LoadColumn) -> Vec<Entry> {
    let mut line_of: Vec<Option<usize>> = vec![None; data.len()];
    for (k, line) in lines.iter().enumerate().filter(|(_, line)| line.data.len() >= LEAST) {
        line.data.iter().for_each(|&i| line_of[i] = Some(k));
    }
    let mut rows: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    data.iter().enumerate().for_each(|(i, datum)| rows.entry(datum.row).or_default().push(i));
    let levels: Vec<f64> = data.iter().map(|datum| datum.load).collect();
    let largest = levels.iter().copied().fold(0.0, f64::max);
    let in_file = match unit {
        LoadColumn::Newtons => 1.0,
        LoadColumn::Kilograms => STANDARD_GRAVITY,
    };
    let mut found = Vec::new();
    for (&row, own) in &rows {
        let Some(said) = said(data, lines, &line_of, own) else { continue };
        let datum = &data[own[0]];
        let apart = (said.load - datum.signed_load()).abs();
        let is_wrong = apart > FAR * largest && apart > SCATTERS * said.error;
        if !is_wrong || said.off > AGREE || said.off_before < SCATTERS {
            continue;
        }
        let along = f64::from(datum.direction.sign) * said.load;
        let tolerance = (NEAR * along.abs()).max(2.0 * said.error);
        let meant = meant(datum.load / in_file, &levels, in_file);
        let meant =
            meant.into_iter().map(|load| load * in_file).filter(|load| (load - along).abs() < tolerance);
        let meant = meant.min_by(|a, b| (a - along).abs().total_cmp(&(b - along).abs()));
        if meant.is_none() && said.channels < 2 {
            continue;
        }
        let name = load_column(unit);
        let unit_name = if unit == LoadColumn::Newtons { "N" } else { "kg" };
        let written = number(datum.load / in_file);
        let is = match meant {
            Some(meant) => number(meant / in_file),
            None => format!(
                "{} ± {}",
                significant(along / in_file, 3),
                significant(2.0 * said.error / in_file, 1)
            ),
        };
        let location = format!("{name}, row {row}");
        let readings: Vec<String> = own.iter().map(|&i| column(data[i].channel)).collect();
        let (rivals, or) = match said.channels {
            1 => {
                let shown = own.iter().find(|&&i| line_of[i].is_some_and(|k| is_shown(&lines[k])));
                let other = shown.map(|&i| format!("{}, row {row}", column(data[i].channel)));
                (other.into_iter().map(|at| (&ENTRY_MISTAKE, at)).collect(), ", unless the reading is wrong")
            }
            _ => (Vec::new(), ""),
        };
        let line = datum.line;
        let verb = if readings.len() == 1 { "is" } else { "are" };
        found.push(Entry {
            part: Part {
                effect: &ENTRY_MISTAKE,
                observed: format!(
                    "The load in row {row} (line {line}) is {written} {unit_name}, but {} {verb} of {is} {unit_name}: write that instead, or leave the row out{or}",
                    readings.join(", ")
                ),
                looks_like: format!("{location} looks mistyped"),
                location,
                estimates: vec![match meant {
                    Some(meant) => Estimate { name: "n".into(), ..exact("n", meant) },
                    None => Estimate {
                        name: "n".into(),
                        unit: 1.0,
                        value: along,
                        low: along - 2.0 * said.error,
                        high: along + 2.0 * said.error,
                    },
                }],
                explains: apart * most_slope(lines, &line_of, own),
                data: own.clone(),
                rivals,
            },
            row: row - 1,
            load: meant.filter(|_| said.channels > 1),
        });
    }
    if found.len() as f64 > (FEW * rows.len() as f64).max(1.0) { Vec::new() } else { found }
}

/// As it stands in a file: without what conversions leave in the last digits.
fn number(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}

/// A line that shows its loads.
fn is_shown(line: &Line) -> bool {
    line.fit.slope.abs() * line.largest_load > 2.0 * SCATTERS * line.fit.scatter
}

fn most_slope(lines: &[Line], line_of: &[Option<usize>], own: &[usize]) -> f64 {
    own.iter().filter_map(|&i| Some(lines[line_of[i]?].fit.slope.abs())).fold(0.0, f64::max)
}

fn said(data: &[Datum], lines: &[Line], line_of: &[Option<usize>], own: &[usize]) -> Option<Said> {
    let known: Vec<(&Datum, &Line)> = own
        .iter()
        .filter_map(|&i| Some((&data[i], &lines[line_of[i]?])))
        .filter(|(_, line)| line.has_slope)
        .collect();
    let scatter = |line: &Line| line.fit.scatter.max(1e-4 * line.fit.slope.abs() * line.largest_load);
    let without_play = |datum: &Datum, line: &Line| {
        datum.measured - line.fit.zero - line.fit.play * f64::from(datum.direction.sign)
    };
    let (mut top, mut bottom, mut channels) = (0.0, 0.0, 0);
    for (datum, line) in &known {
        let weight = scatter(line).powi(-2);
        top += weight * line.fit.slope * without_play(datum, line);
        bottom += weight * line.fit.slope.powi(2);
        channels += usize::from(is_shown(line));
    }
    let load = top / bottom;
    let off = |load: f64| {
        let of = |(datum, line): &(&Datum, &Line)| {
            // the slope is known to its error only
            let sigma = scatter(line).hypot(line.fit.error * load);
            ((without_play(datum, line) - line.fit.slope * load) / sigma).abs()
        };
        known.iter().map(of).fold(0.0, f64::max)
    };
    let before = known.first().map(|(datum, _)| datum.signed_load())?;
    (channels > 0 && load.is_finite()).then(|| Said {
        load,
        error: bottom.powf(-0.5),
        channels,
        off: off(load),
        off_before: off(before),
    })
}

/// Numbers that may have been meant, in the unit of the file: other loads of the recording, the
/// decimal point elsewhere, two digits exchanged.
fn meant(written: f64, levels: &[f64], in_file: f64) -> Vec<f64> {
    let mut meant: Vec<f64> = [0.01, 0.1, 10.0, 100.0].map(|factor| factor * written).to_vec();
    let digits: Vec<char> = number(written).chars().collect();
    for i in 0..digits.len() {
        for j in i + 1..digits.len() {
            let mut other = digits.clone();
            other.swap(i, j);
            meant.extend(other.iter().collect::<String>().parse::<f64>());
        }
    }
    meant.extend(levels.iter().map(|level| level / in_file));
    meant.retain(|value| value.is_finite() && (value - written).abs() > 1e-9 * written.abs());
    meant
}
