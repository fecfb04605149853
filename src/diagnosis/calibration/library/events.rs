//! What happened to the fixture, and what drifts.
//!
//! ```text
//! clamp_pose                   −(t + φ × (ball − clamp))     t, φ: where the clamp is, less where the file says it is
//! clamp_shift, socket_shift    −t from some row on           t: how far the clamp, or the socket, moved
//! base_shift                   t + φ × (ball − base)         from some row on: the robot moved
//! thermal_drift                d·(T − T̄), d·(t − t̄), d·e^(−t/t₁)    of the robot in {W} or of its tool in {T}
//! outlier                      t at one row
//! ```
//!
//! A shift leaves two rows at least on either side, else it is an outlier.

use std::ops::Range;

use nalgebra::Vector3;

use super::{CLAMP, KNOCK, NotTestable, OUTLIER, PER_HOUR, PER_KELVIN, WARM_UP, lack};
use crate::calibration::campaign::Row;
use crate::diagnosis::EffectParameter;
use crate::diagnosis::calibration::posture::Posture;
use crate::diagnosis::calibration::scene::{Column, Entry, Scene, entry, linear};
use crate::units::UM;

/// Time constants of a robot that warms up, as parts of the recording.
const WARMING: [f64; 4] = [0.03, 0.1, 0.2, 0.4];
const HOUR: f64 = 3600.0;
const URAD: f64 = 1e-6;
/// Most rows of a clamp or socket after which a shift is looked for (of longer ones every second, third …), and most rows that
/// may be outliers.
const MOST_PLACES: usize = 200;
/// Most rows after which the base may have moved: with its six parameters each of them is dear.
const MOST_OF_BASE: usize = 100;
/// Angle by which a knock turns a plate of sockets, rad: 0.5 mm over its width.
const PLATE: f64 = 3e-3;
const SHIFT: [&str; 3] = ["dx_um", "dy_um", "dz_um"];
const TURN: [&str; 3] = ["rx_urad", "ry_urad", "rz_urad"];

pub(super) fn all(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let mut entries = clamps(scene, lacks);
    entries.extend(shifts(scene));
    entries.extend(base(scene));
    entries.extend(drift(scene, lacks));
    entries.extend(far_out(scene).into_iter().map(|row| {
        let moved = |axis: usize| scene.part(row..row + 1, |_, _| unit(axis));
        entry("outlier", scene.pose_name(row), parameters(&SHIFT, UM, OUTLIER, moved))
    }));
    entries
}

/// The rows that are farthest out, in their order: no other is an outlier.
fn far_out(scene: &Scene) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..scene.postures.len()).collect();
    rows.sort_by(|&a, &b| scene.deviation(b).total_cmp(&scene.deviation(a)));
    rows.truncate(MOST_PLACES);
    rows.sort_unstable();
    rows
}

fn unit(axis: usize) -> Vector3<f64> {
    Vector3::ith(axis, 1.0)
}

fn parameters(
    names: &[&str; 3],
    unit: f64,
    size: f64,
    column: impl Fn(usize) -> Column,
) -> Vec<(EffectParameter, Column)> {
    names.iter().enumerate().map(|(axis, name)| (linear(*name, unit, size), column(axis))).collect()
}

fn rows_of(scene: &Scene, is_of: impl Fn(usize) -> bool) -> Vec<usize> {
    (0..scene.postures.len()).filter(|&row| is_of(scene.recording.rows[row].group)).collect()
}

fn clamps(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let groups = &scene.recording.groups;
    if scene.has_sockets() || groups.len() < 2 {
        lacks.push(lack("clamp_pose", "there are no clamps whose places could disagree"));
        return Vec::new();
    }
    let of_clamp = |k: usize| {
        let at = |displacement: &dyn Fn(&Posture) -> Vector3<f64>| {
            scene.column(|row, posture| match scene.recording.rows[row].group == k {
                true => -displacement(posture),
                false => Vector3::zeros(),
            })
        };
        let mut six = parameters(&SHIFT, UM, CLAMP.0, |axis| at(&|_| unit(axis)));
        let centre = groups[k].device.origin;
        let turned = |axis: usize| at(&|posture: &Posture| unit(axis).cross(&(posture.tip - centre)));
        six.extend(parameters(&TURN, URAD, CLAMP.1, turned));
        entry("clamp_pose", groups[k].name.clone(), six)
    };
    (0..groups.len()).map(of_clamp).collect()
}

/// At most `most` positions in `count` rows after which a shift is looked for: the number of rows before it.
fn places(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let places: Range<usize> = 2..count.saturating_sub(1);
    let stride = places.len().div_ceil(most).max(1);
    places.step_by(stride)
}

/// A clamp or a socket that moved, or the whole plate of a placement, which may have turned as well.
fn shifts(scene: &Scene) -> Vec<Entry> {
    let groups = &scene.recording.groups;
    let is_fixture = scene.has_sockets() || groups.len() > 1 || !groups[0].name.is_empty();
    let mut fixtures: Vec<(String, Vec<usize>)> = Vec::new();
    if is_fixture {
        fixtures.extend((0..groups.len()).map(|k| (groups[k].name.clone(), vec![k])));
    }
    let mut plates: Vec<(String, Vec<usize>)> = Vec::new();
    if scene.has_sockets() {
        for (k, group) in groups.iter().enumerate() {
            let Some((placement, _)) = group.name.rsplit_once('/') else { continue };
            match plates.iter_mut().find(|(name, _)| name == placement) {
                Some((_, members)) => members.push(k),
                None => plates.push((placement.to_owned(), vec![k])),
            }
        }
        // a plate of one socket is that socket
        plates.retain(|(_, members)| members.len() > 1);
    }
    let single = fixtures.iter().flat_map(|(name, members)| moved(scene, name, members, false));
    single.chain(plates.iter().flat_map(|(name, members)| moved(scene, name, members, true))).collect()
}

/// What moved, after each of its rows; what turns does so about the middle of its points.
fn moved(scene: &Scene, name: &str, members: &[usize], turns: bool) -> Vec<Entry> {
    let rows = rows_of(scene, |group| members.contains(&group));
    let middle =
        rows.iter().map(|&row| scene.postures[row].tip).sum::<Vector3<f64>>() / rows.len().max(1) as f64;
    let after = |before: usize| {
        let on = |displacement: &dyn Fn(&Posture) -> Vector3<f64>| {
            scene.part(rows[before]..scene.postures.len(), |row, posture| {
                match members.contains(&scene.recording.rows[row].group) {
                    true => -displacement(posture),
                    false => Vector3::zeros(),
                }
            })
        };
        let mut columns = parameters(&SHIFT, UM, KNOCK.0, |axis| on(&|_| unit(axis)));
        if turns {
            let turned = |axis: usize| on(&|posture: &Posture| unit(axis).cross(&(posture.tip - middle)));
            columns.extend(parameters(&TURN, URAD, PLATE, turned));
        }
        let last = rows[before - 1];
        let (effect, location) = match scene.has_sockets() {
            true => ("socket_shift", format!("{name}, after row {}", last + 1)),
            false => ("clamp_shift", format!("{name}, after {}", scene.pose_name(last))),
        };
        entry(effect, location, columns)
    };
    places(rows.len(), MOST_PLACES).map(after).collect()
}

/// The robot that moved on its base; with sockets, whose places are unknown, that is a plate that moved.
fn base(scene: &Scene) -> Vec<Entry> {
    let count = if scene.has_sockets() { 0 } else { scene.postures.len() };
    let after =
        |before: usize| base_moved(scene, before..count, format!("after {}", scene.pose_name(before - 1)));
    places(count, MOST_OF_BASE).map(after).collect()
}

/// The robot on a base that is displaced at some rows.
pub(in crate::diagnosis::calibration) fn base_moved(
    scene: &Scene,
    rows: Range<usize>,
    location: String,
) -> Entry {
    let on = |displacement: &dyn Fn(&Posture) -> Vector3<f64>| {
        scene.part(rows.clone(), |_, posture| displacement(posture))
    };
    let mut six = parameters(&SHIFT, UM, KNOCK.0, |axis| on(&|_| unit(axis)));
    let turned = |axis: usize| on(&|posture: &Posture| unit(axis).cross(&(posture.tip - posture.origin[0])));
    six.extend(parameters(&TURN, URAD, KNOCK.1, turned));
    entry("base_shift", location, six)
}

/// How a drift goes: name of its course, value by row less the mean of the recording that it was found in, unit of its
/// parameters (as a suffix and in SI), size.
type Course<'a> = (String, Vec<f64>, &'a str, f64, f64);

/// With temperature or time where they are known, and in any case with the order; steadily, or as a robot warms up.
fn drift(scene: &Scene, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let courses = courses(scene);
    let is_clocked = |(_, _, suffix, ..): &Course| *suffix != "um";
    if !courses.iter().any(is_clocked) {
        let reason = "rows have neither temperature nor time: only their order can tell";
        lacks.push(lack("thermal_drift", reason));
    }
    let of_course = |(name, values, suffix, unit_si, size): Course| {
        let names = ["x", "y", "z"].map(|axis| format!("{axis}_{suffix}"));
        let drifting = |place: &str, along: &dyn Fn(&Posture, usize) -> Vector3<f64>| {
            let column = |axis: usize| scene.column(|row, posture| along(posture, axis) * values[row]);
            let names = [0, 1, 2].map(|axis| names[axis].as_str());
            entry("thermal_drift", format!("{place}, with {name}"), parameters(&names, unit_si, size, column))
        };
        [
            drifting("base", &|_, axis| unit(axis)),
            drifting("tool", &|posture, axis| posture.flange.rotation.column(axis).into()),
        ]
    };
    courses.into_iter().flat_map(of_course).collect()
}

fn courses(scene: &Scene) -> Vec<Course<'static>> {
    let (rows, since) = (&scene.recording.rows, &scene.since.rows);
    let is_later = !std::ptr::eq(scene.recording, scene.since);
    let known = |of: fn(&Row) -> Option<f64>| -> Option<[Vec<f64>; 2]> {
        let of_rows = |rows: &[Row]| rows.iter().map(of).collect::<Option<Vec<f64>>>();
        Some([of_rows(since)?, of_rows(rows)?])
    };
    let (temperature, time) = (known(|row| row.temperature), known(|row| row.time));
    // a recording without a clock drifts from its first to its last row, and what comes later goes on
    let count = |from: usize, rows: usize| (from..from + rows).map(|row| row as f64).collect();
    let order = || [count(0, since.len()), count(if is_later { since.len() } else { 0 }, rows.len())];
    let clock = time.clone().unwrap_or_else(order);
    let first = clock[0].iter().copied().fold(f64::INFINITY, f64::min);
    let last = clock[0].iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let share = |t: f64| (t - first) / (last - first).max(f64::MIN_POSITIVE);
    let less_mean = |[since, own]: [Vec<f64>; 2]| -> Vec<f64> {
        let mean = since.iter().sum::<f64>() / since.len().max(1) as f64;
        own.into_iter().map(|value| value - mean).collect()
    };
    let of_clock = |of: &dyn Fn(f64) -> f64| {
        less_mean(clock.clone().map(|times| times.into_iter().map(|t| of(share(t))).collect()))
    };
    let mut courses: Vec<Course> = vec![("order".into(), of_clock(&|share| share), "um", UM, PER_HOUR)];
    courses.extend(WARMING.map(|part| {
        let name = format!("warm-up over {} % of the recording", 100.0 * part);
        (name, of_clock(&|share| (-share / part).exp()), "um", UM, WARM_UP)
    }));
    courses.extend(
        temperature.map(|values| ("temperature".into(), less_mean(values), "um_per_k", UM, PER_KELVIN)),
    );
    courses.extend(
        time.map(|values| ("time".into(), less_mean(values), "um_per_h", UM / HOUR, PER_HOUR / HOUR)),
    );
    courses
}
