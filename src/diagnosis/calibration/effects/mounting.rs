//! What happened to the robot on its base, and to the tool in its mount.
//!
//! A shift leaves two rows at least on either side, else it is an outlier.

use std::ops::Range;

use nalgebra::Vector3;

use super::fixture::{moved_event, places_of_all};
use super::{
    CalibrationEffect, Context, Entry, KNOCK, SHIFT, TURN, Transfer, out_of_the_points, own_parameters, size,
    three, unit,
};
use crate::diagnosis::calibration::model::CalibrationModel;
use crate::diagnosis::calibration::model::configuration::Configuration;
use crate::diagnosis::calibration::model::law::Law;
use crate::diagnosis::calibration::model::vector::{self, Length};
use crate::inference::{
    Candidate, Effect, Estimate, Finding, FindingPart, Kind, Location, NotTestable, Reported, WrittenTo,
};
use crate::units::{MM, UM, URAD};

/// Distance of the ball from the flange below which no rotation moves it, m.
const LEAST_LEVER: f64 = 10.0 * MM;

/// A robot that moved on its base.
pub static BASE_SHIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "base_shift",
        kind: Kind::Event,
        summary: "the robot moved on its base after one pose",
        formula: "t + φ × (ball − base) from some row on",
        prior: "0.5 mm and 0.5 mrad: millimetres when one sees a knock, tenths when one does not",
        parameters: &[
            (&["dx_um", "dy_um", "dz_um"], "displacement of the base in {W}"),
            (&["rx_urad", "ry_urad", "rz_urad"], "its rotation about the axes of {W}"),
        ],
        needs: "measured points (the points of sockets are unknown: there a moved plate stands for it)",
        cause: "a slip of the robot on its base",
        cause_at: |location| format!("a shift of the base ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: bases,
    estimates: own_parameters,
    observed: |finding, _| {
        let by = size(finding, UM).with_unit("µm");
        let turned = finding.parts.first().map_or_else(String::new, |part| {
            format!(" and turned by {}", vector::size_of(part, 3..6, URAD).with_unit("µrad"))
        });
        format!("The robot moved on its base by {by}{turned} {}", finding.location)
    },
    write: out_of_the_points,
    transfer: Transfer::Made(stays_moved),
    event: |_| Some("the base moved".into()),
};

fn bases(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    if context.has_sockets() {
        return Vec::new();
    }
    let places = places_of_all(context);
    let Some(&first) = places.iter().min() else { return Vec::new() };
    let at = |row: usize| Location::Shift { what: None, row, after: context.pose_name(row) };
    let always = base_moved(context, first..context.configurations.len(), at(first - 1));
    places.into_iter().map(|before| always.starting_at(before, at(before - 1))).collect()
}

/// The robot on a base that is displaced at some rows.
fn base_moved(context: &Context, rows: Range<usize>, location: Location) -> Entry {
    let on = |displacement: &dyn Fn(&Configuration) -> Vector3<f64>| {
        context.part(rows.clone(), |_, there| displacement(there))
    };
    let mut six = three(&SHIFT, KNOCK.0, |axis| on(&|_| unit(axis)));
    let turned = |axis: usize| on(&|there: &Configuration| unit(axis).cross(&(there.tip - there.origin[0])));
    six.extend(three(&TURN, KNOCK.1, turned));
    Entry::new(&BASE_SHIFT.effect, location, six)
}

/// The robot stands where it was moved to, whatever row that was after: also if a later pose has
/// that one's name.
fn stays_moved(context: &Context, candidate: &Candidate, _: &Law) -> Entry {
    base_moved(context, 0..context.configurations.len(), candidate.location.clone())
}

/// A tool that slipped in its mount.
pub static TOOL_SHIFT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "tool_shift",
        kind: Kind::Event,
        summary: "the rod or tool slipped in its mount after one pose",
        formula: "R·d from some row on: d = t + φ × ball in {T}, by how much the ball moved in {T}; a ball \
                  alone does not show how much of it was a rotation φ",
        prior: "0.5 mm: millimetres when one sees a knock, tenths when one does not",
        parameters: &[
            (&["dx_um", "dy_um", "dz_um"], "displacement of the ball in {T}"),
            (&["rotation_deg"], "the least rotation about the flange that moves the ball so"),
        ],
        needs: "poses in the order of recording that hold the tool in different directions",
        cause: "a slip of the rod or tool in its mount",
        cause_at: |location| format!("a slip of the tool ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: Some("Look whether the rod is tight in its mount."),
    },
    candidates: tools,
    estimates: slipped,
    observed: slip_observed,
    write: out_of_the_points,
    transfer: Transfer::Made(stays_slipped),
    event: moved_event,
};

fn tools(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let places = places_of_all(context);
    let Some(&first) = places.iter().min() else { return Vec::new() };
    let at = |row: usize| Location::Shift { what: Some("tool".into()), row, after: context.pose_name(row) };
    let always = tool_moved(context, first..context.configurations.len(), at(first - 1));
    places.into_iter().map(|before| always.starting_at(before, at(before - 1))).collect()
}

/// The ball elsewhere in {T} at some rows.
fn tool_moved(context: &Context, rows: Range<usize>, location: Location) -> Entry {
    let along =
        |axis: usize| context.part(rows.clone(), |_, there| there.flange.rotation.column(axis).into_owned());
    Entry::new(&TOOL_SHIFT.effect, location, three(&SHIFT, KNOCK.0, along))
}

/// The tool stays where it slipped to.
fn stays_slipped(context: &Context, candidate: &Candidate, _: &Law) -> Entry {
    tool_moved(context, 0..context.configurations.len(), candidate.location.clone())
}

/// The displacement, and the least rotation about the flange that does it: what of it is across the
/// lever, over the lever.
fn slipped(model: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let mut estimates = own_parameters(model, parts);
    let lever = model.calibration.setup.tool;
    let (Some(part), Some(along)) = (parts.first(), lever.try_normalize(LEAST_LEVER)) else {
        return estimates;
    };
    let &[x, y, z] = &part.term.values[..] else { return estimates };
    let moved = Vector3::new(x, y, z);
    let across = (moved - along * along.dot(&moved)) / lever.norm();
    let angle = vector::length(across.as_slice());
    // the gradient of its length has nothing along the lever
    let turned = Length { gradient: angle.gradient / lever.norm(), ..angle };
    let half = turned.half_interval(part);
    let (value, low) = (turned.value, (turned.value - half).max(0.0));
    estimates.push(Estimate::new("rotation_deg", value, low, turned.value + half));
    estimates
}

fn slip_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let by = size(finding, UM).with_unit("µm");
    let as_turn = match finding.estimates.get(3) {
        Some(turn) => format!(", as by a rotation of {} in its mount", turn.quantity().with_unit("°")),
        None => String::new(),
    };
    match &finding.location {
        Location::Shift { after, .. } => {
            format!("The ball moved in the tool frame by {by} after {after}{as_turn}")
        }
        other => format!("The ball moved in the tool frame by {by}, {other}{as_turn}"),
    }
}
