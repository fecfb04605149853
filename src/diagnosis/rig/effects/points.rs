//! Points of the rod at which loads act and sensors read that are not those stated.

use super::entry::{
    Context, Entry, RigEffect, Usual, along_the_load, by_action, candidate, out_of_the_readings, parameter,
};
use super::places::{loaded_axes, measured_channels};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::{End, Structure, Varied, tangent};
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::inference::{Candidate, Effect, Finding, Kind, Location, Parameter, Part, Reported, WrittenTo};
use crate::spatial::Axis;

/// Along the rod as a share of its length: a hook or a stylus that is a tube's diameter away.
const ALONG: f64 = 0.03;
/// Across it as a share of the pipe's height: a cord that pulls at the tube's surface.
const BESIDE: f64 = 0.5;
/// Beyond that share of the rod's length, or so many times the usual size beside it, nobody would
/// take it for the point that was stated.
const MOST: f64 = 0.2;
const MOST_BESIDE: f64 = 3.0;
/// A point that can move by less than this share of the rod's length is not tried along it.
const LEAST: f64 = 1e-3;
/// Of so many stations no one is tried by itself any more.
const MOST_STATIONS: usize = 12;

const LENGTHS: &[(&[&str], &str)] = &[
    (&["along_mm"], "along the rod, towards the tip"),
    (&["x_mm"], "across the rod, along x"),
    (&["y_mm"], "across the rod, along y"),
    (&["z_mm"], "across the rod, along z"),
];

/// Loads that act at another point.
pub static LOAD_POINT: RigEffect = RigEffect {
    effect: Effect {
        name: "load_point",
        kind: Kind::Physics,
        summary: "loads act at another point of the rod than stated",
        formula: "u = C(s + a, s_read)·F + K·(r × F), K: displacement per moment",
        prior: "3 % of the rod's length along it, half the pipe's height beside it: a cord at a tube's surface",
        parameters: LENGTHS,
        needs: "a rod file",
        cause: "loads that are not attached where stated",
        cause_at: |location| "loads that are not attached where stated".to_owned() + &whose(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(ALONG)],
    needs_rod: true,
    candidates: |context| {
        let axes = loaded_axes(context.data);
        points(context, &LOAD_POINT, End::Load, &axes)
    },
    missing: |_| "no load was applied",
    observed: |finding, model| {
        let loads = whose(&finding.location);
        format!("The point where loads act{loads} is off by {}", displacement(finding, model))
    },
    write: out_of_the_readings,
};

/// Sensors that read another point.
pub static SENSOR_POINT: RigEffect = RigEffect {
    effect: Effect {
        name: "sensor_point",
        kind: Kind::Physics,
        summary: "sensors read another point of the rod than stated",
        formula: "u = C(s_load, s + a)·F + (Θ·F) × r, Θ: rotation per force",
        prior: "3 % of the rod's length along it, half the pipe's height beside it: a stylus at a tube's surface",
        parameters: LENGTHS,
        needs: "a rod file",
        cause: "sensors that do not read where stated",
        cause_at: |location| "sensors that do not read where stated".to_owned() + &whose(location),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: along_the_load,
        direct_check: None,
    },
    usual: &[Usual::Share(ALONG)],
    needs_rod: true,
    candidates: |context| {
        let channels = measured_channels(context.data);
        points(context, &SENSOR_POINT, End::Reading, &channels)
    },
    missing: |_| "no readings were taken",
    observed: |finding, model| {
        let sensors = whose(&finding.location);
        format!("The point that sensors read{sensors} is off by {}", displacement(finding, model))
    },
    write: out_of_the_readings,
};

/// Of one station: along the rod and across it, all axes together and each by itself, for each is
/// set up by itself. Of several: each of them, along the rod. Several numbers at once would explain
/// what is none of them.
fn points(context: &mut Context, effect: &'static RigEffect, end: End, axes: &[Axis]) -> Vec<Entry> {
    let Body::Rod(structure) = &mut *context.body else { return Vec::new() };
    let stations = structure.stations_of(end);
    let every = [true; 3];
    let of_place = |location: Location, (parameter, action): (Parameter, Action)| {
        (candidate(&effect.effect, location, vec![parameter]), vec![action])
    };
    let [station] = stations[..] else {
        let own = if stations.len() > MOST_STATIONS { &[] } else { &stations[..] };
        let of_station = |station: &f64| {
            Some(of_place(Location::Station(*station), along(structure, end, *station, every)?))
        };
        return own.iter().filter_map(of_station).collect();
    };
    let part = if end == End::Load { Part::LoadPoint } else { Part::ReadPoint };
    let own = |axis: Axis| {
        let name = if end == End::Load { format!("loads along {axis}, ") } else { format!("d{axis}, ") };
        (name, Axis::ALL.map(|other| other == axis))
    };
    let each = axes.iter().filter(|_| axes.len() > 1).map(|axis| own(*axis));
    let mut entries = Vec::new();
    for (whose, axes) in [(String::new(), every)].into_iter().chain(each) {
        let along = along(structure, end, station, axes);
        for (parameter, action) in along.into_iter().chain(beside(structure, end, station, axes)) {
            let way = match parameter.name.strip_suffix("_mm") {
                Some(axis) if axis != "along" => format!("along {axis}"),
                _ => "along the rod".into(),
            };
            let location = Location::Form { part, form: format!("{whose}{way}") };
            let entry = of_place(location, (parameter, action));
            entries.push((axes == every, entry));
        }
    }
    let count = entries.iter().filter(|(is_of_all, _)| *is_of_all).count().max(1) as f64;
    let others = (entries.len() as f64 - count).max(1.0);
    let weighted = |(is_of_all, (candidate, actions)): (bool, Entry)| {
        let weight = 1.0 / if is_of_all { count } else { others };
        (Candidate { weight, ..candidate }, actions)
    };
    entries.into_iter().map(weighted).collect()
}

/// Along the rod, no farther than to the bend.
fn along(structure: &mut Structure, end: End, station: f64, axes: [bool; 3]) -> Option<(Parameter, Action)> {
    let rod = structure.rod();
    let length = rod.length();
    let bend = if station > rod.bend_end() { rod.bend_end() } else { rod.bend_start() };
    let most = (MOST * length).min((station - bend).abs()).min(station);
    if most < LEAST * length {
        return None;
    }
    let number = structure.add_variation(Varied::Along(end, station), most)?;
    let size = (ALONG * length).min(most);
    // beyond the tip there is only what is fastened to it
    let bounds = (-most, most.min(length - station + size));
    Some((parameter("along_mm", 0.0, size, bounds), Action::Varied(number, axes)))
}

/// Along the two axes of {T} that are most across the rod.
fn beside(structure: &mut Structure, end: End, station: f64, axes: [bool; 3]) -> Vec<(Parameter, Action)> {
    let rod = structure.rod();
    let own = if station > rod.bend_end() { &rod.pipe2 } else { &rod.pipe1 };
    let (size, along) = (BESIDE * own.section.height(), tangent(rod, station));
    let in_plane = if along.x.abs() < along.z.abs() { (Axis::X, "x_mm") } else { (Axis::Z, "z_mm") };
    let across = |(axis, name): (Axis, &str)| {
        let number = structure.add_variation(Varied::Beside(end, station, axis), size)?;
        let most = MOST_BESIDE * size;
        Some((parameter(name, 0.0, size, (-most, most)), Action::Varied(number, axes)))
    };
    [in_plane, (Axis::Y, "y_mm")].into_iter().filter_map(across).collect()
}

/// ` (loads along x)`; nothing of all.
fn whose(location: &Location) -> String {
    match location {
        Location::Form { form, .. } => {
            form.rsplit_once(", ").map_or_else(String::new, |(own, _)| format!(" ({own})"))
        }
        Location::Station(_) => format!(" ({location})"),
        _ => String::new(),
    }
}

/// `60 ± 2 mm towards the flange`.
fn displacement(finding: &Finding, model: &RigModel) -> String {
    let Some((_, parameter, length)) = by_action(finding, model).pop() else { return String::new() };
    let is_positive = length.value >= 0.0;
    let towards = match (parameter.name.strip_suffix("_mm"), is_positive) {
        (Some("along") | None, true) => "the tip".to_owned(),
        (Some("along") | None, false) => "the flange".to_owned(),
        (Some(axis), _) => format!("{}{axis}", if is_positive { "+" } else { "-" }),
    };
    format!("{} towards {towards}", length.size().with_unit("mm"))
}
