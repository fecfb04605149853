//! Sensors that are stuck or at the end of their range: the same value, whatever the load.

use std::collections::HashSet;

use super::super::effects::mistakes::{SATURATED_SENSOR, STUCK_SENSOR};
use super::lines::{Line, lines};
use super::part::Part;
use crate::diagnosis::rig::recording::columns::{column, rows_between};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::resolution::resolution;
use crate::diagnosis::rig::recording::spread::scatter_of;
use crate::inference::{Estimate, Key, Quantity};
use crate::spatial::Axis;
use crate::statistics::median;
use crate::units::{UM, significant};

/// Readings that are the same differ by no more than this share of the channel's largest.
const SAME: f64 = 1e-9;
/// What the rod expects of a stuck channel: this share of the largest deflection at least, so many
/// times the scatter.
const EXPECTED: f64 = 0.05;
const TIMES_SCATTER: f64 = 20.0;
/// And this share of it at most is there.
const MOVES: f64 = 0.03;
/// A line is right that is off by less than this share.
const RIGHT: f64 = 0.3;
/// Readings at a limit, at least; and a frozen display.
const AT_LIMIT: usize = 3;
const FROZEN: usize = 4;
/// The loads change while it is frozen: so much of the largest reading is expected at least.
const CHANGES: f64 = 0.2;
/// And so many steps of the display.
const DIGITS: f64 = 5.0;
/// Of a line of more than so many times the data, a few that do not belong to it change what it
/// says by less than half.
const MANY: usize = 100;
const HARDLY: f64 = 0.5;
/// How well a line is known by the rod, as a share of it.
const SCALE: f64 = 0.1;
/// How far beyond a limit the readings would lie, as a share of it.
const BEYOND: f64 = 0.05;
/// Ln of the chance by which readings at one load may be the same: one in fifty.
const BY_CHANCE: f64 = -3.912;
/// And of readings at loads that differ, all over a file; so many are looked at.
const NEVER: f64 = -20.0;
const LONG: usize = 8;
/// So many readings that are the largest to the last digit are cut off, wherever they would lie,
/// where noise, and what the line goes on by between them, is more than so many steps of the
/// display: of readings that merely end there about an eighth of one more lies within a step of the
/// largest, and four more by a chance of 1e-5. Repeats of one load may well be the same.
const TIED: (usize, f64) = (5, 20.0);

/// What the rod says of each line.
pub(super) struct Expected {
    /// m/N, in the scale of the readings.
    pub slopes: Vec<f64>,
    /// What most lines are of the rod's own slopes.
    pub scale: f64,
}

/// Channels that do not move where the rod says that they must.
pub(super) fn stuck(data: &[Datum], lines: &[Line], expected: Option<&Expected>) -> Vec<Part> {
    let is_scale_right = expected.is_some_and(|expected| expected.scale.ln().abs() < RIGHT);
    let expected = expected.map(|expected| &expected.slopes[..]);
    let deflections: Vec<f64> = (0..lines.len())
        .map(|k| expected.map_or(0.0, |slopes| slopes[k].abs() * lines[k].largest_load))
        .collect();
    let most = deflections.iter().copied().fold(0.0, f64::max);
    let most_shown = lines.iter().map(|line| line.fit.slope.abs() * line.largest_load).fold(0.0, f64::max);
    // a display that is still but for noise is only stuck where the rod is right otherwise
    let is_right_else = |channel: Axis| {
        let is_right = |k: usize| {
            let size = deflections[k].max(lines[k].fit.slope.abs() * lines[k].largest_load);
            let off = expected.map_or(0.0, |slopes| (lines[k].fit.slope - slopes[k]) * lines[k].largest_load);
            size < MOVES * most_shown || off.abs() < RIGHT * size
        };
        let mut others = (0..lines.len()).filter(|&k| lines[k].channel != channel).peekable();
        is_scale_right && others.peek().is_some() && others.all(is_right)
    };
    // what the displays can show of it
    let step = resolution(data);
    let mut found = Vec::new();
    for channel in Axis::ALL {
        let is_read = |k: &usize| lines[*k].channel == channel && lines[*k].has_slope;
        let own: Vec<usize> = match expected {
            Some(_) => {
                (0..lines.len()).filter(is_read).filter(|&k| deflections[k] > EXPECTED * most).collect()
            }
            None => (0..lines.len()).filter(is_read).filter(|&k| lines[k].axis == channel).collect(),
        };
        // what moves under another load, or by another rod, is not stuck
        let shown = |k: usize| lines[k].fit.slope.abs() * lines[k].largest_load;
        let is_moving = (0..lines.len()).any(|k| {
            let is_sure = lines[k].fit.slope.abs() > 5.0 * lines[k].fit.error;
            lines[k].channel == channel && is_sure && shown(k) > MOVES * most_shown
        });
        let is_still = |&k: &usize| {
            let line = &lines[k];
            let values: Vec<f64> = line.data.iter().map(|&i| data[i].measured).collect();
            let is_same = is_same(&values);
            match expected {
                Some(expected) => {
                    let moves = line.fit.slope.abs();
                    (is_same || (moves < 4.0 * line.fit.error && is_right_else(channel)))
                        && moves < MOVES * expected[k].abs()
                        && deflections[k] > (TIMES_SCATTER * line.fit.scatter).max(DIGITS * step)
                }
                None => is_same && line.data.len() >= FROZEN && values[0] != 0.0,
            }
        };
        if own.is_empty() || is_moving || !own.iter().all(is_still) {
            continue;
        }
        let of_channel: Vec<usize> = (0..data.len()).filter(|&i| data[i].channel == channel).collect();
        let mut values: Vec<f64> = of_channel.iter().map(|&i| data[i].measured).collect();
        values.sort_by(f64::total_cmp);
        let (value, low, high) = (values[values.len() / 2], values[0], values[values.len() - 1]);
        let name = column(channel);
        found.push(Part {
            effect: &STUCK_SENSOR,
            location: Key::new(&name),
            estimates: vec![Estimate::new("um", value, low, high)],
            observed: format!(
                "{name} shows {} whatever the load: leave the column out, and look at its sensor",
                Quantity { value: value / UM, low: low / UM, high: high / UM }.with_unit("µm")
            ),
            looks_like: format!("{name} looks stuck"),
            explains: deflections[own[0]],
            data: of_channel,
            rivals: Vec::new(),
        });
    }
    found
}

fn is_same(values: &[f64]) -> bool {
    let most = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    values.iter().all(|value| (value - values[0]).abs() <= SAME * most)
}

/// Readings at the largest or the smallest value that a channel shows, beyond which others of their
/// lines would lie.
///
/// Where too few others are left of a line, the rod says where they would lie, if those that are
/// left say so too.
pub(super) fn saturated(data: &[Datum], lines: &[Line], by_rod: Option<&Expected>) -> Vec<Part> {
    let mut found = Vec::new();
    for channel in Axis::ALL {
        let own: Vec<usize> = (0..data.len()).filter(|&i| data[i].channel == channel).collect();
        let most = own.iter().fold(0.0, |most: f64, &i| most.max(data[i].measured.abs()));
        for side in [1.0, -1.0] {
            let limit = own.iter().map(|&i| side * data[i].measured).fold(f64::NEG_INFINITY, f64::max);
            if !(limit > 0.0 && limit > EXPECTED * most) {
                continue;
            }
            let is_at = |i: usize| (side * data[i].measured - limit).abs() <= SAME * most;
            let at: Vec<usize> = own.iter().copied().filter(|&i| is_at(i)).collect();
            // the other end of the range is no part of a line either
            let other_end =
                own.iter().copied().filter(|&i| (side * data[i].measured + limit).abs() <= SAME * most);
            let ends: Vec<usize> = at.iter().copied().chain(other_end).collect();
            if at.len() < AT_LIMIT || at.len() == own.len() {
                continue;
            }
            let of_lines = expected(data, &at, &ends);
            let of_rod = by_rod.and_then(|rod| expected_of_rod(data, &at, &ends, lines, rod));
            let step = step_of(data, &own);
            // what a line leaves may be that it is bent, or slipped: it is no noise
            let without: HashSet<usize> = ends.iter().copied().collect();
            let others: Vec<&Datum> =
                own.iter().filter(|i| !without.contains(i)).map(|&i| &data[i]).collect();
            let noise = scatter_of(&others).unwrap_or(f64::INFINITY);
            let beyond = |expected: Vec<(f64, f64)>| {
                let beyond = expected.iter().map(|(value, _)| side * value - limit).collect::<Vec<_>>();
                let scatter = expected.iter().fold(0.0, |most: f64, (_, scatter)| most.max(*scatter));
                let least = expected.iter().fold(noise, |least, (_, scatter)| least.min(*scatter));
                let (low, high) = range(&beyond);
                let is_tied = at.len() >= TIED.0
                    && step > 0.0
                    && least.min(high - low) > TIED.1 * step
                    && trembles(data, &own);
                cut_off(&beyond, [scatter, noise], limit, step.max(SAME * most))
                    .or(is_tied.then_some(high.max(0.0)))
            };
            let Some(high) = [of_lines, of_rod].into_iter().flatten().find_map(beyond) else { continue };
            let name = column(channel);
            let shown = side * limit / UM;
            found.push(Part {
                effect: &SATURATED_SENSOR,
                location: Key::new(&name),
                estimates: vec![Estimate::new("um", side * limit, side * limit, side * limit)],
                observed: format!(
                    "{name} is cut off at {} µm in {} readings: leave them out, or use a sensor of a longer range",
                    significant(shown, 4),
                    at.len()
                ),
                looks_like: format!("{name} looks cut off at {} µm", significant(shown, 4)),
                explains: high,
                data: at,
                rivals: Vec::new(),
            });
        }
    }
    found
}

fn range(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

/// True where most readings of a channel differ: displacements that were set are the same again and
/// again.
fn trembles(data: &[Datum], own: &[usize]) -> bool {
    let mut values: Vec<f64> = own.iter().map(|&i| data[i].measured).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    2 * values.len() > own.len()
}

/// How far beyond a limit the farthest of some readings would lie, where they show that they are
/// cut off there; `beyond` is what is expected of each, with the scatter about their lines, and
/// that from reading to reading.
fn cut_off(beyond: &[f64], [scatter, noise]: [f64; 2], limit: f64, step: f64) -> Option<f64> {
    let (low, high) = range(beyond);
    let mean = beyond.iter().sum::<f64>() / beyond.len() as f64;
    // the same value to the last digit at loads that differ, all of them beyond; friction holds
    // a rod on the way down, but not all of these
    let goes_on = mean > 2.0 * scatter || (high - low > 3.0 * scatter && beyond.len() >= 2 * AT_LIMIT);
    let is_flat = high - low > (BEYOND * limit).max(scatter) && low > -scatter && goes_on;
    // or, at one load, well beyond, with noise in all other readings: so many are the same by a
    // chance of step/(2·√π·scatter) each
    let noise = scatter.min(noise);
    let tie = (step / (2.0 * std::f64::consts::PI.sqrt() * noise)).ln();
    let is_noisy = noise > 3.0 * step || (beyond.len() as f64 - 1.0) * tie < BY_CHANCE;
    let is_still = low > 3.0 * scatter && is_noisy;
    (mean > BEYOND * limit && (is_flat || is_still)).then_some(high)
}

/// Displays that stood still for some rows in which the loads changed.
///
/// Where whole lines are among these rows, so that nothing else says what they would show, the rod
/// does, if the display trembles elsewhere.
pub(super) fn frozen(data: &[Datum], all: &[Line], by_rod: Option<&Expected>) -> Vec<Part> {
    let mut found = Vec::new();
    for channel in Axis::ALL {
        let own: Vec<usize> = (0..data.len()).filter(|&i| data[i].channel == channel).collect();
        let largest = own.iter().fold(0.0, |most: f64, &i| most.max(data[i].measured.abs()));
        let mut first = 0;
        while first < own.len() {
            let same =
                own[first..].iter().take_while(|&&i| data[i].measured == data[own[first]].measured).count();
            let at = &own[first..first + same];
            first += same;
            if same < FROZEN || same == own.len() || is_surely_flat(data, all, at, HARDLY * CHANGES * largest)
            {
                continue;
            }
            // what moves by a digit or two of its own display stays the same for long
            let step = step_of(data, &own);
            let (values, scatter): (Vec<f64>, f64) = match (expected(data, at, at), by_rod) {
                (Some(expected), _) => {
                    let scatter = expected.iter().fold(0.0, |most: f64, (_, scatter)| most.max(*scatter));
                    (expected.iter().map(|(value, _)| *value).collect(), scatter)
                }
                (None, Some(rod)) if same >= LONG => {
                    let Some(tremor) = tremor(data, &own, at).filter(|tremor| is_no_tie(same, step, *tremor))
                    else {
                        continue;
                    };
                    let Some(values) = by_the_rod(data, all, at, rod) else { continue };
                    (values, tremor)
                }
                _ => continue,
            };
            let value = data[at[0]].measured;
            let range = range(&values);
            let least = (CHANGES * largest).max(TIMES_SCATTER * scatter).max(DIGITS * step);
            if range.1 - range.0 < least {
                continue;
            }
            let (name, rows) = (column(channel), rows_between(data[at[0]].row, data[at[same - 1]].row));
            let shown = significant(value / UM, 4);
            found.push(Part {
                effect: &STUCK_SENSOR,
                location: Key::new(&name).rows(&rows),
                estimates: vec![Estimate::new("um", value, value, value)],
                observed: format!(
                    "{name} stays at {shown} µm in the {rows} while the loads change: leave these readings out"
                ),
                looks_like: format!("{name} looks stuck in the {rows}"),
                explains: range.1 - range.0,
                data: at.to_vec(),
                rivals: Vec::new(),
            });
        }
    }
    found
}

/// What the rod says of some data, where it is right of most lines.
fn by_the_rod(data: &[Datum], lines: &[Line], at: &[usize], rod: &Expected) -> Option<Vec<f64>> {
    let says = |&i: &usize| {
        let k = lines.iter().position(|line| line.holds(&data[i]))?;
        Some(rod.slopes[k] * data[i].signed_load())
    };
    (rod.scale.ln().abs() < RIGHT).then(|| at.iter().map(says).collect()).flatten()
}

/// How much a channel trembles from one reading to the next about its lines, apart from `at`: the
/// standard deviation of a reading, m. What goes on for a while does not count.
fn tremor(data: &[Datum], own: &[usize], at: &[usize]) -> Option<f64> {
    let without: HashSet<usize> = at.iter().copied().collect();
    let rest = lines(data, |i| !without.contains(&i));
    let off = |&i: &usize| {
        let line = rest.iter().find(|line| line.holds(&data[i]) && line.has_slope && line.data.len() > 2)?;
        (!without.contains(&i)).then(|| data[i].measured - line.fit.at(data[i].signed_load()))
    };
    let off: Vec<Option<f64>> = own.iter().map(off).collect();
    let steps: Vec<f64> = off.windows(2).filter_map(|pair| Some((pair[1]? - pair[0]?).abs())).collect();
    // of a difference of two normal numbers of one standard deviation
    const MEDIAN: f64 = 0.954;
    median(&steps).map(|step| step / MEDIAN)
}

/// True where a display that trembles so much hardly shows the same so many times in a row: each
/// time again by a chance of step/(2·√π·tremor).
fn is_no_tie(same: usize, step: f64, tremor: f64) -> bool {
    let again = (step / (2.0 * std::f64::consts::PI.sqrt() * tremor)).ln();
    step > 0.0 && (same as f64 - 1.0) * again < NEVER
}

/// The smallest step of the display of the channel of which `own` are the data, m.
fn step_of(data: &[Datum], own: &[usize]) -> f64 {
    resolution(own.iter().map(|&i| &data[i]))
}

/// True where lines that `at` is hardly a part of say that its readings are the same within
/// `change`: no need to fit the lines without it.
fn is_surely_flat(data: &[Datum], lines: &[Line], at: &[usize], change: f64) -> bool {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &i in at {
        let Some(line) = lines.iter().find(|line| line.holds(&data[i])) else { return false };
        if line.data.len() < MANY * at.len() {
            return false;
        }
        let value = line.fit.at(data[i].signed_load());
        (low, high) = (low.min(value), high.max(value));
    }
    high - low < change
}

/// What the other readings of their lines say of some data, with the scatter about those; `None`
/// where they say nothing of one.
fn expected(data: &[Datum], at: &[usize], without: &[usize]) -> Option<Vec<(f64, f64)>> {
    let without: HashSet<usize> = without.iter().copied().collect();
    let rest = lines(data, |i| !without.contains(&i));
    let expected_at = |&i: &usize| {
        let d = &data[i];
        let line = rest.iter().find(|line| line.holds(d) && line.data.len() >= 2)?;
        if !line.has_slope {
            return through_origin(data, line, d);
        }
        // loads beyond those of the others are predicted no better than the slope is known
        let scatter = line.fit.scatter.hypot(line.fit.error * d.load);
        (line.data.len() >= 3).then(|| (line.fit.at(d.signed_load()), scatter))
    };
    at.iter().map(expected_at).collect()
}

/// What the rod says of some data, in the scale of all lines; `None` where the others of their
/// lines are none or say otherwise.
fn expected_of_rod(
    data: &[Datum],
    at: &[usize],
    without: &[usize],
    lines: &[Line],
    by_rod: &Expected,
) -> Option<Vec<(f64, f64)>> {
    let without: HashSet<usize> = without.iter().copied().collect();
    let says = |k: usize, i: usize| by_rod.slopes[k] * data[i].signed_load();
    // of each line: whether its others are some, and say what the rod says
    let is_right = |(k, line): (usize, &Line)| {
        let mut others = line.data.iter().copied().filter(|i| !without.contains(i)).peekable();
        others.peek().is_some()
            && others.all(|i| (data[i].measured - says(k, i)).abs() < RIGHT * says(k, i).abs())
    };
    let are_right: Vec<bool> = lines.iter().enumerate().map(is_right).collect();
    let expected_at = |&i: &usize| {
        let k = lines.iter().position(|line| line.holds(&data[i]))?;
        are_right[k].then(|| (says(k, i), SCALE * says(k, i).abs()))
    };
    at.iter().map(expected_at).collect()
}

/// What readings at a single load say of another one: a line through the origin, which play and
/// friction leave by some.
fn through_origin(data: &[Datum], line: &Line, d: &Datum) -> Option<(f64, f64)> {
    const PLAY: f64 = 0.1;
    let sums = line.data.iter().fold((0.0, 0.0), |(xy, xx), &i| {
        let load = data[i].signed_load();
        (xy + load * data[i].measured, xx + load * load)
    });
    let value = d.signed_load() * sums.0 / sums.1;
    (sums.1 > 0.0).then(|| (value, line.fit.scatter.max(0.0).hypot(PLAY * value)))
}
