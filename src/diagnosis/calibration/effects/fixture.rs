//! What is wrong with the fixture, or happened to it.
//!
//! A shift leaves two rows at least on either side, else it is an outlier.

use std::ops::Range;

use nalgebra::Vector3;

use super::super::model::law::Law;
use super::super::model::{CalibrationModel, Configuration};
use super::{
    CalibrationEffect, Context, EVERY_ROW, Entry, KNOCK, SHIFT, TURN, Transfer, lack, law, no_event,
    out_of_the_points, own_parameters, size, three, unit,
};
use crate::calibration::campaign::{Campaign, GroupName};
use crate::inference::{Effect, Finding, Kind, Location, NotTestable, Reported, WrittenTo};
use crate::units::{UM, capital};

/// Error of a clamp's place, m and rad.
const MISPLACED: (f64, f64) = (100.0 * UM, 0.5e-3);
/// Places in a longer recording after which a first look tries what may have moved: a shift some
/// rows off explains nearly as much, and its columns are dear.
const AT_FIRST_SIGHT: usize = 50;
/// Angle by which a knock turns a plate of sockets, rad: 0.5 mm over its width.
const PLATE: f64 = 3e-3;

/// A clamp that is not where the campaign says.
pub static CLAMP_POSE: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "clamp_pose",
        kind: Kind::Physics,
        summary: "a clamp is not where the campaign says",
        formula: "−(t + φ × (ball − clamp)): t and φ are where the clamp is, less where the file says \
                  it is",
        prior: "100 µm and 0.5 mrad: a fixture that was measured by a hand-held gauge",
        parameters: &[
            (&["dx_um", "dy_um", "dz_um"], "displacement of the clamp in {W}"),
            (&["rx_urad", "ry_urad", "rz_urad"], "its rotation about the axes of {W}"),
        ],
        needs: "at least two clamps",
        cause: "a wrong clamp position in the campaign",
        cause_at: |location| format!("the position of {location}"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: clamps,
    estimates: own_parameters,
    observed: |finding, _| {
        let by = size(finding, UM).with_unit("µm");
        format!("{} is {by} away from its position in the campaign", capital(&finding.location))
    },
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn clamps(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let groups = &context.recording.groups;
    if context.has_sockets() || groups.len() < 2 {
        lacks.push(lack(&CLAMP_POSE, "there are fewer than two clamps"));
        return Vec::new();
    }
    let of_clamp = |k: usize| {
        let at = |displacement: &dyn Fn(&Configuration) -> Vector3<f64>| {
            context.column(|row, there| match context.recording.rows[row].group == k {
                true => -displacement(there),
                false => Vector3::zeros(),
            })
        };
        let mut six = three(&SHIFT, MISPLACED.0, |axis| at(&|_| unit(axis)));
        let centre = groups[k].device.origin;
        let turned = |axis: usize| at(&|there: &Configuration| unit(axis).cross(&(there.tip - centre)));
        six.extend(three(&TURN, MISPLACED.1, turned));
        Entry::new(&CLAMP_POSE.effect, Location::Named(groups[k].name.to_string()), six)
    };
    (0..groups.len()).map(of_clamp).collect()
}

/// A clamp that moved.
pub static CLAMP_SHIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "clamp_shift",
        kind: Kind::Event,
        summary: "a clamp moved after one pose",
        formula: "−t from some row on: t is how far the clamp moved",
        prior: "0.5 mm: millimetres when one sees a knock, tenths when one does not",
        parameters: &[(&["dx_um", "dy_um", "dz_um"], "displacement of the clamp in {W}")],
        needs: "four poses in a clamp",
        cause: "a knock or a slip of the clamp",
        cause_at: |location| format!("a shift ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: |context, _| match context.has_sockets() {
        true => Vec::new(),
        false => shifts(context, &CLAMP_SHIFT),
    },
    estimates: own_parameters,
    observed: |finding, _| moved_observed(finding),
    write: out_of_the_points,
    transfer: Transfer::Nothing,
    event: moved_event,
};

/// A socket that moved, or a plate of them.
pub static SOCKET_SHIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "socket_shift",
        kind: Kind::Event,
        summary: "a socket or a plate of sockets moved after a pose",
        formula: "−(t + φ × (ball − middle)) from some row on: t is how far the socket moved; a plate \
                  also turns by φ about the middle of its points",
        prior: "0.5 mm, and 3 mrad for a plate: 0.5 mm over its width",
        parameters: &[
            (&["dx_um", "dy_um", "dz_um"], "displacement of the socket or plate in {W}"),
            (&["rx_urad", "ry_urad", "rz_urad"], "rotation of a plate about the axes of {W}"),
        ],
        needs: "four poses in a socket, or on a plate",
        cause: "a knock or a slip of the socket",
        cause_at: |location| format!("a shift ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: |context, _| match context.has_sockets() {
        true => shifts(context, &SOCKET_SHIFT),
        false => Vec::new(),
    },
    estimates: own_parameters,
    observed: |finding, _| moved_observed(finding),
    write: another_socket,
    transfer: Transfer::Nothing,
    event: moved_event,
};

/// From then on it is another socket, or another plate.
fn another_socket(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let (Some(row), Law::Moved(sockets)) = (finding.location.moved_after(), law(finding, model)) else {
        return WrittenTo::Nowhere;
    };
    let rows = &model.campaign.measurements.rows;
    let is_moved = |at: usize| at > row && sockets.contains(&rows[at].group);
    let is_plate = sockets.len() > 1;
    extended.measurements.rename_groups(&is_moved, &format!("row {}", row + 2), is_plate);
    WrittenTo::Recording
}

fn moved_observed(finding: &Finding) -> String {
    let by = size(finding, UM).with_unit("µm");
    match &finding.location {
        Location::Shift { what: Some(what), after, .. } => {
            format!("{} moved by {by} after {after}", capital(what))
        }
        other => format!("{} moved by {by}", capital(other)),
    }
}

pub(super) fn moved_event(location: &Location) -> Option<String> {
    match location {
        Location::Shift { what: Some(what), .. } => Some(format!("{what} moved")),
        other => Some(format!("{other} moved")),
    }
}

fn rows_of(context: &Context, is_of: impl Fn(usize) -> bool) -> Vec<usize> {
    let rows = 0..context.configurations.len();
    rows.filter(|&row| is_of(context.recording.rows[row].group)).collect()
}

/// Numbers of `rows` before a shift: of a short recording each, of a longer one so many over all of
/// it, and every one near to what a first look has seen.
fn places(context: &Context, rows: &[usize]) -> Vec<usize> {
    let places: Range<usize> = 2..rows.len().saturating_sub(1);
    let most = if rows.len() > EVERY_ROW { AT_FIRST_SIGHT } else { EVERY_ROW };
    let (first, stride) = (places.start, places.len().div_ceil(most).max(1));
    let seen: Vec<usize> =
        context.moved_after.iter().map(|&last| rows.partition_point(|&row| row <= last)).collect();
    let is_near = |before: usize| seen.iter().any(|&seen| before.abs_diff(seen) < stride);
    places.filter(|&before| (before - first).is_multiple_of(stride) || is_near(before)).collect()
}

/// The same of all rows.
pub(super) fn places_of_all(context: &Context) -> Vec<usize> {
    places(context, &(0..context.configurations.len()).collect::<Vec<_>>())
}

/// The same with a tenth of the rows at least on either side: what changes earlier or later is
/// hardly another thing than what is there always.
pub(in crate::diagnosis::calibration) fn places_amid(context: &Context) -> Vec<usize> {
    let count = context.configurations.len();
    let least = count.div_ceil(10);
    places_of_all(context).into_iter().filter(|&before| before >= least && before + least <= count).collect()
}

/// A clamp or a socket that moved, or the whole plate of a placement, which may have turned as
/// well.
fn shifts(context: &Context, effect: &'static CalibrationEffect) -> Vec<Entry> {
    let groups = &context.recording.groups;
    let is_fixture = context.has_sockets() || groups.len() > 1 || !groups[0].name.is_tracked();
    let mut fixtures: Vec<(String, Vec<usize>)> = Vec::new();
    if is_fixture {
        fixtures.extend((0..groups.len()).map(|k| (groups[k].name.to_string(), vec![k])));
    }
    let mut plates: Vec<(String, Vec<usize>)> = Vec::new();
    if context.has_sockets() {
        let session = context.recording.session_by_group();
        let members = |number: usize| (0..groups.len()).filter(|&k| session[k] == number).collect();
        let names = context.recording.sessions().into_iter().map(GroupName::session);
        plates.extend(names.enumerate().map(|(number, name)| (name, members(number))));
        // a plate of one socket is that socket
        plates.retain(|(_, members)| members.len() > 1);
    }
    let alone = fixtures.iter().flat_map(|(name, members)| moved(context, effect, name, members, false));
    let whole = plates.iter().flat_map(|(name, members)| moved(context, effect, name, members, true));
    alone.chain(whole).collect()
}

/// What moved, after each of its rows; what turns does so about the middle of its points.
fn moved(
    context: &Context,
    effect: &'static CalibrationEffect,
    name: &str,
    members: &[usize],
    turns: bool,
) -> Vec<Entry> {
    let rows = rows_of(context, |group| members.contains(&group));
    let tips = rows.iter().map(|&row| context.configurations[row].tip);
    let middle = tips.sum::<Vector3<f64>>() / rows.len().max(1) as f64;
    let places = places(context, &rows);
    let Some(&first) = places.first() else { return Vec::new() };
    let on = |displacement: &dyn Fn(&Configuration) -> Vector3<f64>| {
        context.part(rows[first]..context.configurations.len(), |row, there| {
            match members.contains(&context.recording.rows[row].group) {
                true => -displacement(there),
                false => Vector3::zeros(),
            }
        })
    };
    let mut columns = three(&SHIFT, KNOCK.0, |axis| on(&|_| unit(axis)));
    if turns {
        let turned = |axis: usize| on(&|there: &Configuration| unit(axis).cross(&(there.tip - middle)));
        columns.extend(three(&TURN, PLATE, turned));
    }
    let place = |before: usize| {
        let row = rows[before - 1];
        // poses in sockets often have no names of their own
        let after = match context.has_sockets() {
            true => format!("row {}", row + 1),
            false => context.pose_name(row),
        };
        Location::Shift { what: Some(name.to_owned()), row, after }
    };
    let always = Entry::new(&effect.effect, place(first), columns).by(Law::Moved(members.to_vec()));
    let after = |before: usize| always.starting_at(rows[before], place(before));
    // a plate of which only one socket was visited from then on is that socket
    let group = |row: usize| context.recording.rows[row].group;
    let is_of_one = |before: &usize| {
        let own = group(rows[*before]);
        let is_own = |row: &usize| group(*row) == own;
        members.len() > 1 && rows[*before..].iter().all(is_own) && rows[..*before].iter().any(is_own)
    };
    places.into_iter().filter(|before| !is_of_one(before)).map(after).collect()
}
