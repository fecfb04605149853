//! The load that the readings of an instant show, by the lines of their channels.
//!
//! ```text
//! F = Σ w·s·(y − a) / Σ w·s²,   w = 1/σ²
//! ```
//!
//! s, a and σ slope, zero and scatter of the line of each channel, without loads far beyond all
//! others.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::lines::{Line, far_load, fit};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::resolution::resolution;
use crate::spatial::Axis;

/// What is so many scatters off was not read under that load, and what is so few was.
pub(super) const SCATTERS: f64 = 8.0;
pub(super) const AGREE: f64 = 4.0;
/// A load so many times the others' largest would draw its line after it.
const BEYOND: f64 = 1.3;
/// Lines of fewer readings say nothing of one of them.
const LEAST: usize = 6;

/// The load of a row by its readings.
pub(super) struct LoadByReadings {
    /// N, with its standard error.
    pub load: f64,
    pub error: f64,
    /// How far those are off the load in the file that contradict it most, in scatters: of those
    /// that show loads by themselves.
    pub against: [f64; 2],
    /// The same of those that show it together.
    pub against_together: [f64; 2],
    /// How far the reading that agrees the least is off it, in scatters.
    pub off: f64,
}

/// All readings with the lines that show their loads.
pub(super) struct ShownLoads<'a> {
    pub data: &'a [Datum],
    /// The data of each instant.
    pub instants: BTreeMap<usize, Vec<usize>>,
    lines: Vec<Line>,
    /// For each datum its line, where that has readings enough.
    line_of: Vec<Option<usize>>,
}

impl<'a> ShownLoads<'a> {
    pub fn of(data: &'a [Datum], lines: &[Line]) -> ShownLoads<'a> {
        let mut line_of: Vec<Option<usize>> = vec![None; data.len()];
        for (k, line) in lines.iter().enumerate().filter(|(_, line)| line.data.len() >= LEAST) {
            line.data.iter().for_each(|&i| line_of[i] = Some(k));
        }
        let mut instants: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        data.iter().enumerate().for_each(|(i, datum)| instants.entry(datum.order).or_default().push(i));
        ShownLoads { data, instants, lines: fit_to_show_loads(data, lines), line_of }
    }

    /// The line of a datum.
    pub fn line(&self, i: usize) -> Option<&Line> {
        self.line_of[i].map(|k| &self.lines[k])
    }

    /// The load of each instant whose readings show it.
    pub fn all(&self) -> Vec<(&[usize], LoadByReadings)> {
        self.instants.values().filter_map(|own| Some((&own[..], self.at(own)?))).collect()
    }

    /// How far the steepest of these data move per newton, m/N.
    pub fn most_slope(&self, own: &[usize]) -> f64 {
        own.iter().filter_map(|&i| Some(self.line(i)?.fit.slope.abs())).fold(0.0, f64::max)
    }

    fn at(&self, own: &[usize]) -> Option<LoadByReadings> {
        let line = |&i: &usize| Some((&self.data[i], self.line(i)?));
        let known: Vec<(&Datum, &Line)> =
            own.iter().filter_map(line).filter(|(_, line)| line.has_slope).collect();
        let without_play = |datum: &Datum, line: &Line| {
            datum.measured - line.fit.zero - line.fit.play * f64::from(datum.direction.sign)
        };
        let (mut top, mut bottom) = (0.0, 0.0);
        for (datum, line) in &known {
            let weight = line.scatter_of_readings().powi(-2);
            top += weight * line.fit.slope * without_play(datum, line);
            bottom += weight * line.fit.slope.powi(2);
        }
        let load = top / bottom;
        let off = |load: f64, (datum, line): &(&Datum, &Line)| {
            // the slope is known to its error only
            let sigma = line.scatter_of_readings().hypot(line.fit.error * load);
            ((without_play(datum, line) - line.fit.slope * load) / sigma).abs()
        };
        let in_file = known.first().map(|(datum, _)| datum.signed_load())?;
        let all = known.iter().map(|(_, line)| in_scatters(line, in_file).powi(2)).sum::<f64>().sqrt();
        let most = |least: f64| {
            let showing = known.iter().filter(|(_, line)| in_scatters(line, in_file) > least);
            let mut against: Vec<f64> = showing.map(|one| off(in_file, one)).chain([0.0; 2]).collect();
            against.sort_by(|a, b| b.total_cmp(a));
            [against[0], against[1]]
        };
        let together = if all > 2.0 * SCATTERS { SCATTERS } else { f64::INFINITY };
        load.is_finite().then(|| LoadByReadings {
            load,
            error: bottom.powf(-0.5),
            against: most(2.0 * SCATTERS),
            against_together: most(together),
            off: known.iter().map(|one| off(load, one)).fold(0.0, f64::max),
        })
    }
}

/// What a line reads under its largest load, or this one, N, in its scatter; 0 where its slope may
/// be chance.
fn in_scatters(line: &Line, load: f64) -> f64 {
    match line.fit.slope.abs() > AGREE * line.fit.error {
        true => line.fit.slope.abs() * line.largest_load.max(load.abs()) / line.fit.scatter,
        false => 0.0,
    }
}

/// Lines without loads far beyond all others, whose readings scatter by rounding at least: a
/// display that shows one number for most loads knows none of these.
fn fit_to_show_loads(data: &[Datum], lines: &[Line]) -> Vec<Line> {
    let rounded = |channel: Axis| {
        let step = resolution(data.iter().filter(|datum| datum.channel == channel));
        step / 12f64.sqrt()
    };
    let rounded = Axis::ALL.map(rounded);
    let own = |line: &Line| {
        let mut line = without_far_load(data, line).into_owned();
        line.fit.scatter = line.fit.scatter.max(rounded[line.channel.index()]);
        line
    };
    lines.iter().map(own).collect()
}

/// A line, without a load so far beyond all others that it would follow that.
fn without_far_load<'a>(data: &[Datum], line: &'a Line) -> Cow<'a, Line> {
    let loads: Vec<f64> = line.data.iter().map(|&i| data[i].load).collect();
    let Some(far) = far_load(&loads, BEYOND) else { return Cow::Borrowed(line) };
    let others = [&line.data[..far], &line.data[far + 1..]].concat();
    let largest = others.iter().fold(0.0, |most: f64, &i| most.max(data[i].load));
    let points: Vec<(f64, f64)> = others.iter().map(|&i| (data[i].signed_load(), data[i].measured)).collect();
    let has_slope = points.iter().any(|(load, _)| (load - points[0].0).abs() > 1e-6 * largest);
    Cow::Owned(Line { fit: fit(&points), largest_load: largest, has_slope, data: others, ..line.clone() })
}
