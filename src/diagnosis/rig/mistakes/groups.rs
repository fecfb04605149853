//! Mistakes in whole runs or directions: a sign that was lost, a zero that was not taken.

use std::collections::BTreeMap;

use super::super::effects::events::SLIP;
use super::super::effects::mistakes::{OFFSET_MISTAKE, SIGN_MISTAKE};
use super::lines::{Fit, Line, fit};
use super::part::Part;
use crate::diagnosis::rig::recording::columns::{axis_rows, column, columns, rows_of, sensor_in_run};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Estimate, Key, Quantity};
use crate::spatial::{Axis, Direction};
use crate::statistics::median;

/// A flipped group has the slope of the others, within this share.
const ALIKE: f64 = 0.3;
/// And leaves at most this share of the squares, or as much as the others do by so many times:
/// friction, creep and whatever else acts on all of them.
const LEFT: f64 = 0.03;
const TIMES_USUAL: f64 = 3.0;
/// But no more than this.
const MOST_LEFT: f64 = 0.15;
/// What the rod moves under a group, in scatters.
const TIMES_SCATTER: f64 = 20.0;
/// Of so many readings; of more it is the surer.
const FEWEST: f64 = 3.0;
/// A zero that no play and no friction explains, as a share of the rod's deflection along the axis.
const FAR: f64 = 0.3;
/// One of a run.
const FAR_FOR_A_RUN: f64 = 1.0;
/// One that a play could be.
const FAR_FOR_PLAY: f64 = 3.0;
/// How constant such a zero is.
const CONSTANT: f64 = 0.15;

/// Some data of a line.
pub(super) struct Group {
    pub data: Vec<usize>,
    pub fit: Fit,
    /// True where its loads differ by a fifth of the largest.
    pub has_slope: bool,
}

pub(super) fn group(data: &[Datum], own: Vec<usize>) -> Group {
    let points: Vec<(f64, f64)> = own.iter().map(|&i| (data[i].signed_load(), data[i].measured)).collect();
    let largest = points.iter().fold(0.0, |most: f64, (x, _)| most.max(x.abs()));
    let has_slope = own.len() >= 3 && points.iter().any(|(x, _)| (x - points[0].0).abs() > 0.2 * largest);
    Group { fit: fit(&points), data: own, has_slope }
}

fn split(data: &[Datum], line: &Line, key: impl Fn(&Datum) -> i64) -> Vec<(i64, Group)> {
    let mut of_key: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for &i in &line.data {
        of_key.entry(key(&data[i])).or_default().push(i);
    }
    of_key.into_iter().map(|(key, readings)| (key, group(data, readings))).collect()
}

/// True where the data of a group follow −`slope` instead of `slope`, as the `right` ones do that.
fn is_flipped(data: &[Datum], group: &Group, slope: f64, scatter: f64, right: &[&Group]) -> bool {
    let usual = median(&right.iter().map(|right| left_of(data, right, slope).0).collect::<Vec<_>>());
    let most = (TIMES_USUAL * usual.unwrap_or(0.0)).clamp(LEFT, MOST_LEFT);
    let (left, moved) = left_of(data, group, -slope);
    group.has_slope
        && (group.fit.slope / slope + 1.0).abs() < ALIKE
        && left < most
        && moved * (group.data.len() as f64 / FEWEST).sqrt() > 0.25 * TIMES_SCATTER * scatter
}

/// The share of the squares that a straight line of this slope leaves of a group, wherever its zero
/// is; and how far the line goes, root mean square, m.
fn left_of(data: &[Datum], group: &Group, slope: f64) -> (f64, f64) {
    let loads: Vec<f64> = group.data.iter().map(|&i| data[i].signed_load()).collect();
    let count = loads.len().max(1) as f64;
    let mean = loads.iter().sum::<f64>() / count;
    let all: f64 = loads.iter().map(|x| (slope * (x - mean)).powi(2)).sum();
    let off: Vec<f64> = group.data.iter().zip(&loads).map(|(&i, x)| data[i].measured - slope * x).collect();
    let zero = off.iter().sum::<f64>() / count;
    let left: f64 = off.iter().map(|r| (r - zero).powi(2)).sum();
    (left / all.max(f64::MIN_POSITIVE), (all / count).sqrt())
}

/// Runs, or directions, of a channel whose sign is the other way than that of the rest; `expected`
/// is the slope of each line by the rod, in the scale of the readings, where there is one.
pub(super) fn flipped(data: &[Datum], lines: &[Line], expected: Option<&[f64]>) -> Vec<Part> {
    let mut found: Vec<Flipped> = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let hint = expected.map(|slopes| slopes[k]);
        let flipped = flipped_runs(data, line, hint).or_else(|| flipped_direction(data, line, hint));
        let Some((own, rows)) = flipped else { continue };
        match found.iter_mut().find(|flipped| flipped.rows == rows) {
            // the other channels of the same rows: their direction is the likelier cause
            Some(flipped) => {
                flipped.channels.push(line.channel);
                flipped.data.extend(own);
            }
            None => {
                let slope = line.fit.slope.abs().max(hint.unwrap_or(0.0).abs());
                let explains = slope * line.largest_load;
                found.push(Flipped { channels: vec![line.channel], rows, data: own, explains });
            }
        }
    }
    found.into_iter().map(Flipped::part).collect()
}

/// Readings whose sign is the other way.
struct Flipped {
    channels: Vec<Axis>,
    /// Their loads' direction, and which runs: `axis y, trial 2`.
    rows: Key,
    data: Vec<usize>,
    explains: f64,
}

impl Flipped {
    fn part(self) -> Part {
        let Flipped { channels, rows, data, explains } = self;
        let of_rows = |channels: &[Axis]| {
            let key = Key::new(columns(channels)).rows(&rows.names);
            rows.rows.iter().fold(key, |key, runs| key.rows(runs))
        };
        let location = of_rows(&channels);
        Part {
            effect: &SIGN_MISTAKE,
            observed: format!(
                "The sign is wrong in some rows ({location}): multiply these readings by −1 (or turn their direction in the column axis round)"
            ),
            looks_like: format!("{}: the sign looks wrong", of_rows(&channels[..1])),
            location,
            estimates: Vec::new(),
            explains,
            data,
            rivals: vec![(&SIGN_MISTAKE, rows)],
        }
    }
}

/// Fewer runs than the others.
fn flipped_runs(data: &[Datum], line: &Line, hint: Option<f64>) -> Option<(Vec<usize>, Key)> {
    let groups = split(data, line, |d| d.run as i64);
    let usable: Vec<&(i64, Group)> = groups.iter().filter(|(_, group)| group.has_slope).collect();
    let against = usable.iter().filter(|(_, group)| group.fit.slope < 0.0).count();
    let with = usable.len() - against;
    // a minority; where they are as many, the rod knows
    let sign = match (against.cmp(&with), hint) {
        (std::cmp::Ordering::Less, _) => 1.0,
        (std::cmp::Ordering::Greater, _) => -1.0,
        (_, Some(hint)) => hint.signum(),
        _ => return None,
    };
    let right: Vec<&Group> = usable.iter().map(|(_, g)| g).filter(|g| g.fit.slope * sign > 0.0).collect();
    let slope = median(&right.iter().map(|group| group.fit.slope).collect::<Vec<_>>())?;
    let scatter = median(&usable.iter().map(|(_, g)| g.fit.scatter).collect::<Vec<_>>())?;
    if right.iter().any(|other| (other.fit.slope / slope - 1.0).abs() > ALIKE) {
        return None;
    }
    let wrong: Vec<&&(i64, Group)> =
        usable.iter().filter(|(_, group)| group.fit.slope * sign < 0.0).collect();
    if wrong.is_empty() || !wrong.iter().all(|(_, group)| is_flipped(data, group, slope, scatter, &right)) {
        return None;
    }
    let flipped: Vec<usize> = wrong.iter().flat_map(|(_, group)| group.data.clone()).collect();
    let mut trials: Vec<&str> = flipped.iter().filter_map(|&i| data[i].trial.as_deref()).collect();
    trials.dedup();
    let runs = match trials.is_empty() {
        false => format!("trial {}", trials.join(" and ")),
        true => rows_of(flipped.iter().map(|&i| &data[i])),
    };
    Some((flipped, Key::new(axis_rows(line.axis)).rows(runs)))
}

/// The loads of one direction, where those of the other are right.
fn flipped_direction(data: &[Datum], line: &Line, hint: Option<f64>) -> Option<(Vec<usize>, Key)> {
    let groups = split(data, line, |d| i64::from(d.direction.sign));
    let [(_, minus), (_, plus)] = &groups[..] else { return None };
    // the other way round by the rod; without one the smaller group, else the negative one
    let is_plus_wrong = match hint {
        Some(hint) => plus.fit.slope * hint < 0.0,
        None => minus.data.len() > plus.data.len(),
    };
    let (wrong, right, direction) = match is_plus_wrong {
        true => (plus, minus, Direction::along(line.axis)),
        false => (minus, plus, Direction::against(line.axis)),
    };
    let is_it = right.has_slope
        && hint.is_none_or(|hint| right.fit.slope * hint > 0.0)
        && is_flipped(data, wrong, right.fit.slope, right.fit.scatter, &[right]);
    is_it.then(|| (wrong.data.clone(), Key::new(format!("axis {direction}"))))
}

/// Zeros of channels and of runs that were not taken. The lines are right otherwise.
pub(super) fn offsets(data: &[Datum], lines: &[Line]) -> Vec<Part> {
    let moved = |axis: Axis| {
        let of_axis = lines.iter().filter(|line| line.axis == axis);
        of_axis.map(|line| line.fit.slope.abs() * line.largest_load).fold(0.0, f64::max)
    };
    let most = Axis::ALL.into_iter().map(moved).fold(0.0, f64::max);
    let mut found = Vec::new();
    for channel in Axis::ALL {
        let own: Vec<&Line> = lines.iter().filter(|line| line.channel == channel).collect();
        if let Some(of_all) = of_channel(data, &own, channel, most) {
            found.push(of_all);
            continue;
        }
        let zeros: Vec<Vec<RunZero>> = own.iter().map(|line| zeros_of_runs(data, line)).collect();
        for (k, line) in own.iter().enumerate() {
            let is_same = |other: &usize| own[*other].stations[1] == line.stations[1];
            let of_sensor: Vec<&RunZero> =
                (0..own.len()).filter(is_same).flat_map(|other| &zeros[other]).collect();
            // along an axis on which the rod hardly moves a zero is off by more than that in any
            // run
            let moved = moved(line.axis).max(FAR * most);
            found.extend(of_run(data, &zeros[k], &of_sensor, moved));
        }
    }
    found
}

/// How far a datum is off its line through the origin, m.
fn off(data: &[Datum], line: &Line, i: usize) -> f64 {
    data[i].measured - line.fit.slope * data[i].signed_load()
}

fn of_channel(data: &[Datum], lines: &[&Line], channel: Axis, most: f64) -> Option<Part> {
    let zeros: Vec<(usize, f64)> =
        lines.iter().flat_map(|line| line.data.iter().map(|&i| (i, off(data, line, i)))).collect();
    let values: Vec<f64> = zeros.iter().map(|(_, zero)| *zero).collect();
    let zero = median(&values)?;
    let scatter = spread(&values, zero)?;
    // play and friction depend on the direction, and on the axis
    let has = |is_met: &dyn Fn(&Datum) -> bool| zeros.iter().any(|(i, _)| is_met(&data[*i]));
    let is_independent = has(&|d| d.direction.axis != channel)
        || has(&|d| d.load == 0.0)
        || (has(&|d| d.direction.sign > 0) && has(&|d| d.direction.sign < 0));
    let least = if is_independent { FAR } else { FAR_FOR_PLAY };
    let near = values.iter().filter(|value| (*value - zero).abs() < 2.0 * CONSTANT * zero.abs()).count();
    if zero.abs() < least * most || scatter > CONSTANT * zero.abs() || near * 10 < values.len() * 9 {
        return None;
    }
    let data = zeros.iter().map(|(i, _)| *i).collect();
    Some(part(Key::new(column(channel)), zero, scatter / (values.len() as f64).sqrt(), data))
}

fn spread(values: &[f64], about: f64) -> Option<f64> {
    Some(1.4826 * median(&values.iter().map(|value| (value - about).abs()).collect::<Vec<_>>())?)
}

fn part(location: Key, zero: f64, error: f64, data: Vec<usize>) -> Part {
    let estimate = Estimate::new("um", zero, zero - 2.0 * error, zero + 2.0 * error);
    let zero_um: Quantity = estimate.quantity();
    Part {
        effect: &OFFSET_MISTAKE,
        observed: format!(
            "A zero was not taken ({location}): subtract {} from these readings",
            zero_um.with_unit("µm")
        ),
        looks_like: format!("{location}: a zero looks not taken"),
        location,
        explains: zero.abs(),
        estimates: vec![estimate],
        data,
        rivals: Vec::new(),
    }
}

/// The zero of a run of one line.
struct RunZero {
    /// Number of the run, in the order of recording.
    run: usize,
    data: Vec<usize>,
    /// Beyond the usual zero of the line, m.
    distance: f64,
    scatter: f64,
    /// Farthest reading from it, m.
    most: f64,
}

/// Those of all runs of a line; none where nobody knows which zero is usual.
fn zeros_of_runs(data: &[Datum], line: &Line) -> Vec<RunZero> {
    let runs = split(data, line, |d| d.run as i64);
    if runs.len() < 3 {
        return Vec::new();
    }
    let zero_of = |(run, group): (i64, Group)| {
        // play and friction change sides with the load
        let play = |i: usize| line.fit.play * f64::from(data[i].direction.sign);
        let values: Vec<f64> = group.data.iter().map(|&i| off(data, line, i) - play(i)).collect();
        let zero = median(&values)?;
        let most = values.iter().fold(0.0, |most: f64, v| most.max((v - zero).abs()));
        let scatter = spread(&values, zero)?;
        Some(RunZero { run: run as usize, data: group.data, distance: zero, scatter, most })
    };
    let Some(mut zeros) = runs.into_iter().map(zero_of).collect::<Option<Vec<_>>>() else {
        return Vec::new();
    };
    let usual = median(&zeros.iter().map(|zero| zero.distance).collect::<Vec<_>>()).unwrap_or_default();
    zeros.iter_mut().for_each(|zero| zero.distance -= usual);
    zeros
}

/// Runs that start elsewhere than most runs (`own`) of their line; what stays until the end has
/// slipped; of the last run alone it may be either. Where the run before or after it among all
/// those `of_sensor`, along whatever axis, is off as far, it is no zero of one run.
fn of_run(data: &[Datum], own: &[RunZero], of_sensor: &[&RunZero], moved: f64) -> Vec<Part> {
    let is_far = |k: usize| own[k].distance.abs() > FAR_FOR_A_RUN * moved && moved > 0.0;
    let far: Vec<usize> = (0..own.len()).filter(|&k| is_far(k)).collect();
    let stays = far.len() > 1 && far.iter().enumerate().all(|(n, &k)| k == own.len() - far.len() + n);
    if far.len() * 3 > own.len() || stays {
        return Vec::new();
    }
    let goes_on = |zero: &RunZero| {
        let is_alike = |other: &&&RunZero| {
            other.run.abs_diff(zero.run) == 1
                && (other.distance - zero.distance).abs() < CONSTANT * zero.distance.abs()
        };
        of_sensor.iter().any(|other| is_alike(&other))
    };
    let mut found = Vec::new();
    for k in far {
        let zero = &own[k];
        if zero.most > 2.0 * CONSTANT * zero.distance.abs() || zero.data.len() < 2 || goes_on(zero) {
            continue;
        }
        let ends = [zero.data[0], zero.data[zero.data.len() - 1]].map(|i| &data[i]);
        let location = sensor_in_run(ends[0], ends[1]);
        let error = zero.scatter / (zero.data.len() as f64).sqrt();
        let mut part = part(location, zero.distance, error, zero.data.clone());
        if k + 1 == own.len() {
            part.rivals.push((&SLIP.effect, part.location.clone()));
        }
        found.push(part);
    }
    found
}
