//! Readings that were written as increments: what each weight added, not what all of them did.
//!
//! ```text
//! y_i = b·(F_i − F_{i−1})      F_0 = 0 at the beginning of each run
//! ```
//!
//! instead of y_i = b·F_i. With equal steps that is a constant, which a zero would be too: only the
//! rod file says that b is its compliance.

use std::collections::BTreeMap;

use super::super::effects::mistakes::INCREMENT_MISTAKE;
use super::lines::Line;
use super::part::Part;
use crate::diagnosis::rig::recording::columns::columns;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Key;
use crate::spatial::Axis;

/// Share of the squares that increments may leave, and that offsets must.
const LEFT: f64 = 0.03;
const OFF: f64 = 0.1;
/// How near to the rod's own the slope must be, as a ratio.
const LIKE_THE_ROD: f64 = 1.5;
/// Lines that show less than this share of the largest deflection say nothing.
const SHOWN: f64 = 0.1;
/// Readings of a line, at least.
const LEAST: usize = 4;

/// Readings that are increments, with what all weights together did, m, for each datum of the part.
pub(super) struct Increments {
    pub part: Part,
    pub offsets: Vec<f64>,
}

/// All readings are such where all lines that show anything are; `by_rod` are the slopes of the rod
/// file, m/N.
pub(super) fn found(data: &[Datum], lines: &[Line], by_rod: &[f64]) -> Option<Increments> {
    let mut steps = vec![0.0; data.len()];
    let mut sums = vec![0.0; data.len()];
    let mut before: BTreeMap<(usize, usize), (f64, f64)> = BTreeMap::new();
    let line_of = |datum: &Datum| lines.iter().position(|line| line.holds(datum));
    for (i, datum) in data.iter().enumerate() {
        let (load, sum) = before.entry((datum.run, line_of(datum)?)).or_default();
        steps[i] = datum.signed_load() - *load;
        (*load, *sum) = (datum.signed_load(), *sum + datum.measured);
        sums[i] = *sum;
    }
    let expected = |k: usize| by_rod[k].abs() * lines[k].largest_load;
    let most = (0..lines.len()).map(expected).fold(0.0, f64::max);
    let shown: Vec<usize> = (0..lines.len()).filter(|&k| expected(k) > SHOWN * most).collect();
    let are_all = shown.iter().all(|&k| {
        let line = &lines[k];
        let readings = || line.data.iter().map(|&i| data[i].measured);
        let (offset, left) = through_origin(line.data.iter().map(|&i| data[i].signed_load()).zip(readings()));
        let (increment, left_by_steps) = through_origin(line.data.iter().map(|&i| steps[i]).zip(readings()));
        let is_rod = |slope: f64| (slope / by_rod[k]).ln().abs() < LIKE_THE_ROD.ln();
        line.data.len() >= LEAST && left > OFF && left_by_steps < LEFT && is_rod(increment) && !is_rod(offset)
    });
    if shown.is_empty() || !are_all {
        return None;
    }
    let mut channels: Vec<Axis> = data.iter().map(|datum| datum.channel).collect();
    channels.sort();
    channels.dedup();
    let location = Key::new(columns(&channels));
    let verb = if channels.len() == 1 { "is" } else { "are" };
    let part = Part {
        effect: &INCREMENT_MISTAKE,
        observed: format!(
            "{location} {verb} what each load added to the one before: add up the readings of each run"
        ),
        looks_like: format!(
            "{location} {} like increments",
            if channels.len() == 1 { "looks" } else { "look" }
        ),
        location,
        estimates: Vec::new(),
        explains: most,
        data: (0..data.len()).collect(),
        rivals: Vec::new(),
    };
    Some(Increments { part, offsets: sums })
}

/// The slope of a line through the origin, and the share of the squares that it leaves.
fn through_origin(points: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let (xx, xy, yy) =
        points.fold((0.0, 0.0, 0.0), |(xx, xy, yy), (x, y)| (xx + x * x, xy + x * y, yy + y * y));
    (xy / xx, 1.0 - xy * xy / (xx * yy))
}
