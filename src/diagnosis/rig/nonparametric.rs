//! Rivals for physics that nobody has named: smooth curves along whatever a reading may depend on.
//!
//! Each is a sum of cosines over a coordinate x from 0 to 1, at most [`MOST_COLUMNS`] of them,
//!
//! ```text
//! Σ_j a_j·cos(π j x)       a_j ~ s/(1 + j)
//! ```
//!
//! for every shape is more likely to be smooth than not. Over the levels of the load x counts
//! levels, so that four loads have four columns and any shape can be met: a step at one load, a
//! contact that stiffens beyond 10 N. A curve adds to the readings of one line or channel (s a
//! share of what was read there), or it multiplies the deflections of all lines at once (s a share
//! of them), or of one sensor over the time, or, over the load, it adds to what is read along the
//! load on all lines: then physics that acts on all lines alike, such as relaxation with one time
//! constant or a seat that gives way, is one rival and not many.
//!
//! What all sensors show of the loads along an axis has a curve for each of them ([`all_sensors`]).
//!
//! What the load before leaves behind, the time since its change and the speed of that multiply
//! deflections ([`before`]). A force against the motion that is not the same throughout has its
//! size as a curve ([`held_back`]).
//!
//! What is softer along the rod here than there is a curve over its stations ([`station`]).
//!
//! What sets in suddenly and decays has rivals that begin at every reading ([`transient`]), what
//! comes and goes with one period such of two waves ([`swing`]).
//!
//! What sets in at a load, or acts one way, has rivals of one number ([`kink`]), and so has what
//! jumps at a load ([`step`]). What comes and
//! goes in time has finer curves besides, of [`FINE`] columns of which the first
//! half are of one size.

mod all_sensors;
mod along;
mod before;
mod cosines;
mod cycles;
mod held_back;
mod kink;
mod station;
mod step;
mod swing;
mod transient;

use self::along::*;
pub(super) use self::before::Before;
use self::before::by_decade;
use self::cosines::{cosines, curve, scaled};
use self::cycles::Cycles;
use super::effects::entry::{Entry, UNBOUNDED, parameter};
use super::mechanics::action::Action;
use super::mechanics::load_history::runs;
use super::model::Body;
use super::numbering::numbered;
use super::recording::datum::Datum;
use crate::inference::{Location, Variable};
use crate::spatial::Axis;

/// Columns of a curve in time that swings: six periods in a recording.
const FINE: usize = 14;
/// Loads that are hung are at most so many different ones.
const MOST_LEVELS: usize = 30;
/// Share by which the slope of a line may be off, and share of the steepest line's slope that a
/// flat one may have: as large as the known effects on a rod.
const SLOPE: (f64, f64) = (0.27, 0.02);

/// All curves for these readings. `deflections`: how far the rod deflects at each datum by the base
/// model, m.
pub(super) fn all(data: &[Datum], deflections: &[f64], (body, place): (&Body, &[usize])) -> Vec<Entry> {
    let everything: Vec<usize> = (0..data.len()).collect();
    let lines = groups(data, &numbered(data.iter().map(Datum::line_key)), &|d| {
        format!("d{} under loads along {}{}", d.channel, d.direction.axis, places(d))
    });
    let channels = groups(data, &numbered(data.iter().map(|d| d.channel)), &|d| format!("d{}", d.channel));
    let clock = if data.iter().any(|d| d.time.is_some()) { Variable::Time } else { Variable::Order };
    let mut entries = Vec::new();
    let cycles = Cycles::of(data, deflections);
    let levels = by_axis(data, |d| d.drive().abs(), |_| true);
    for (along, coordinate, is_of_line) in coordinates(data, &levels) {
        let mut curves: Vec<Entry> = Vec::new();
        curves.extend(curve(along, ALL_DEFLECTIONS, &coordinate, &everything, "percent", SHARE, |i| {
            deflections[i]
        }));
        if along.variable == clock && !is_of_line {
            curves.extend(swing::in_time(along, &coordinate, data));
            curves.extend(transient::all(along, &coordinate, data));
        }
        for (place, group) in if is_of_line { &lines } else { &channels } {
            let size = size(group, data);
            curves.extend(curve(along, place, &coordinate, group, "um", size, |_| 1.0));
            if along.variable == clock && !is_of_line {
                curves.extend(fine(along, place, &coordinate, group, size));
                // a display that fades: more the larger its reading
                let gain = format!("gain of {place}");
                curves.extend(curve(along, &gain, &coordinate, group, "percent", SHARE, |i| deflections[i]));
            }
        }
        if let Some(cycles) = cycles.as_ref().filter(|_| along.is_recording) {
            curves.retain(|(candidate, actions)| cycles.are_predicted(candidate, actions));
        }
        entries.extend(curves);
    }
    let before = Before::of(data);
    if let Some(waits) = before.waits() {
        let changes = before.changes(data, deflections);
        entries.extend(curve(SINCE_CHANGE, CHANGES, &scaled(&waits), &everything, "percent", SHARE, |i| {
            changes[i]
        }));
    }
    let speeds = before.speeds(data).map(|speeds| by_decade(&speeds));
    for (along, coordinate) in [(LOAD_BEFORE, before.loads(data)), (SPEED, speeds)] {
        let Some(coordinate) = coordinate.map(|values| scaled(&values)) else { continue };
        entries.extend(curve(along, ALL_DEFLECTIONS, &coordinate, &everything, "percent", SHARE, |i| {
            deflections[i]
        }));
    }
    entries.extend(held_back::all(data, &before::slopes(data, deflections), &before, &levels));
    entries.extend(swing::of_displays(data, deflections));
    entries.extend(along_the_load(data));
    entries.extend(all_sensors::under_loads(data, &levels));
    entries.extend(kink::all(data, deflections));
    entries.extend(step::all(data, &lines, &channels));
    if let Body::Rod(structure) = body {
        entries.extend(slopes(data, deflections, &lines));
        entries.extend(station::along_the_rod(data, structure, place));
    }
    entries
}

/// What a reading may follow: name, coordinate, and whether it acts by line (loads) or by channel
/// (drifts). `levels`: the load of each datum.
fn coordinates(data: &[Datum], levels: &Coordinate) -> Vec<(Along, Coordinate, bool)> {
    let unloading = by_axis(data, |d| d.drive().abs(), Datum::is_unloading);
    let mut position: Coordinate = vec![None; data.len()];
    let of_runs = runs(data);
    for run in &of_runs {
        let rows = numbered(run.iter().map(|&i| data[i].order));
        for (&i, row) in run.iter().zip(rows) {
            position[i] = Some(row as f64);
        }
    }
    let mut found = vec![(LOAD, levels.clone(), true), (UNLOADING, unloading, true)];
    // a clamp that is loose one way, a contact that opens
    let pushes = |axis: Axis| data.iter().any(|d| d.direction.axis == axis && d.drive() < 0.0);
    let pulls = |axis: Axis| data.iter().any(|d| d.direction.axis == axis && d.drive() > 0.0);
    if Axis::ALL.into_iter().any(|axis| pushes(axis) && pulls(axis)) {
        found.push((SIGNED_LOAD, by_axis(data, Datum::drive, |_| true), true));
        let falls = |d: &Datum| d.motion.is_some_and(|motion| motion.direction < 0.0);
        if data.iter().any(falls) {
            found.push((FALLING, by_axis(data, Datum::drive, falls), true));
        }
    }
    // loads that always come in the same order cannot be distinguished from it
    let conditions = numbered(data.iter().map(|d| (d.direction, d.drive().to_bits(), d.phase)));
    let mut first_of: Vec<usize> = Vec::new();
    for (i, &condition) in conditions.iter().enumerate() {
        if condition == first_of.len() {
            first_of.push(i);
        }
    }
    let follows_load = (0..data.len()).all(|i| position[first_of[conditions[i]]] == position[i]);
    if !follows_load {
        found.push((POSITION, scaled(&position), true));
    }
    let coordinate_of =
        |value: &dyn Fn(&Datum) -> Option<f64>| scaled(&data.iter().map(value).collect::<Coordinate>());
    if of_runs.len() > 1 {
        found.push((ORDER, coordinate_of(&|d| Some(d.order as f64)), false));
    }
    found.push((TIME, coordinate_of(&|d| d.time), false));
    found.push((TEMPERATURE, coordinate_of(&|d| d.temperature), false));
    found
}

/// Rank of the load among those along its axis, for the data that are wanted. Of more than
/// [`MOST_LEVELS`] loads the size instead: where a measured load trembles about its levels, its
/// rank is a better load.
fn by_axis(data: &[Datum], load: impl Fn(&Datum) -> f64, is_wanted: impl Fn(&Datum) -> bool) -> Coordinate {
    let levels = Axis::ALL.map(|axis| {
        let along = data.iter().filter(|d| is_wanted(d) && d.direction.axis == axis);
        let mut levels: Vec<f64> = along.map(&load).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        levels
    });
    let rank = |datum: &Datum| {
        is_wanted(datum).then_some(())?;
        let levels = &levels[datum.direction.axis.index()];
        if levels.len() > MOST_LEVELS {
            let (least, most) = (levels[0], levels[levels.len() - 1]);
            return Some((load(datum) - least) / (most - least));
        }
        let rank = levels.partition_point(|&level| level < load(datum));
        Some((rank as f64 + 0.5) / levels.len() as f64)
    };
    data.iter().map(rank).collect()
}

/// A curve in time that swings; nothing where too few times are known to see that.
fn fine(along: Along, place: &str, coordinate: &Coordinate, group: &[usize], size: f64) -> Option<Entry> {
    let times = numbered(group.iter().filter_map(|&i| coordinate[i]).map(f64::to_bits));
    (times.into_iter().max()? >= 2 * FINE).then_some(())?;
    let even = (FINE / 2) as f64;
    let sizes: Vec<f64> = (0..FINE).map(|j| size / (1.0 + j as f64 / even).powi(2)).collect();
    let label = format!("{}, in swings, {place}", along.name);
    cosines(&label, (along, place), (coordinate, group), "um", &sizes, |_| 1.0)
}

/// What moves the tip towards the load, by a curve of its size wherever it pulls to; nothing along
/// a single axis, where the curve of its line is the same.
fn along_the_load(data: &[Datum]) -> Option<Entry> {
    let along: Vec<usize> = (0..data.len())
        .filter(|&i| data[i].channel == data[i].direction.axis && data[i].drive() != 0.0)
        .collect();
    let axes = numbered(along.iter().map(|&i| data[i].channel)).into_iter().max()? + 1;
    let coordinate: Coordinate = scaled(&data.iter().map(|d| Some(d.drive().abs())).collect::<Vec<_>>());
    let size = size(&along, data);
    let sign = |i: usize| if data[i].drive() < 0.0 { -1.0 } else { 1.0 };
    (axes > 1)
        .then(|| curve(LOAD, "readings along the load", &coordinate, &along, "um", size, sign))
        .flatten()
}

/// A slope of its own for every line: a rod whose compliance differs from the model in a way that
/// no part of it explains.
fn slopes(data: &[Datum], deflections: &[f64], lines: &[(String, Vec<usize>)]) -> Option<Entry> {
    let slope =
        |&i: &usize| if data[i].drive() != 0.0 { (deflections[i] / data[i].drive()).abs() } else { 0.0 };
    let steepest = (0..data.len()).map(|i| slope(&i)).fold(0.0, f64::max);
    let of_line = |(place, line): &(String, Vec<usize>)| {
        let size = SLOPE.0 * line.iter().map(slope).fold(0.0, f64::max) + SLOPE.1 * steepest;
        let parameter = parameter(&format!("{place}_um_per_n"), 0.0, size, UNBOUNDED);
        (parameter, Action::Shift(line.iter().map(|&i| (i, data[i].drive())).collect()))
    };
    let (parameters, actions) = lines.iter().map(of_line).unzip();
    let location = Location::Curve {
        label: "slope of each line".into(),
        follows: "makes some lines steeper or flatter than others".into(),
        along: Some(Variable::Load),
    };
    (steepest > 0.0).then_some((rival(location, parameters), actions))
}

/// The data of each group with its name.
fn groups(data: &[Datum], group: &[usize], name: &dyn Fn(&Datum) -> String) -> Vec<(String, Vec<usize>)> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, &number) in group.iter().enumerate() {
        if number == groups.len() {
            groups.push((name(&data[i]), Vec::new()));
        }
        groups[number].1.push(i);
    }
    groups
}

/// Stations, where they are stated.
fn places(datum: &Datum) -> String {
    let at = |what: &str, station: Option<f64>| {
        station.map_or_else(String::new, |s| format!(", {what} at {:.1} mm", s * 1e3))
    };
    at("loaded", datum.load_station) + &at("read", datum.read_station)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    fn along(text: &str) -> Option<Entry> {
        along_the_load(&datum::all(&Readings::from_text("f", text).unwrap().rows))
    }

    #[test]
    fn what_gives_way_along_the_load_does_so_wherever_that_pulls() {
        let (candidate, actions) =
            along("axis,load_n,dy_um,dz_um\n-y,0,0,0\n-y,5,-9,1\n-y,10,-18,2\nz,10,3,30\n").unwrap();
        assert_eq!(candidate.location.to_string(), "load, readings along the load");
        let weights = |action: &Action| match action {
            Action::Shift(weights) => weights.iter().collect::<Vec<_>>(),
            _ => panic!("a shift"),
        };
        // by datum: dy and dz of every row; a constant, and one half of a cosine from no load to
        // the largest
        assert_eq!(weights(&actions[0]), [(2, -1.0), (4, -1.0), (7, 1.0)]);
        let half: Vec<f64> = weights(&actions[1]).iter().map(|(_, weight)| *weight).collect();
        assert!(half[0].abs() < 1e-15 && half[1..] == [1.0, -1.0], "{half:?}");
    }

    #[test]
    fn along_one_axis_the_curve_of_its_line_is_enough() {
        assert!(along("axis,load_n,dy_um,dz_um\n-y,5,-9,1\ny,10,18,2\n").is_none());
    }
}
