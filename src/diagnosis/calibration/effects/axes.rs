//! The axes of the device that sees the ball.

use nalgebra::Vector3;

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::super::model::law::Law;
use super::{
    CalibrationEffect, Context, Entry, Transfer, no_event, out_of_what_is_shown, own_parameters, single, unit,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{
    Effect, Estimate, Finding, FindingPart, Kind, Location, NotTestable, Part, Reported, WrittenTo,
};
use crate::spatial::Axis;

/// Error of the scale of an axis against the others, and how far two are from square.
const ERROR: f64 = 3e-4;
/// Pairs of axes.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
/// Names of their numbers.
const SCALES: [&str; 3] = ["scale_x_um_per_m", "scale_y_um_per_m", "scale_z_um_per_m"];
const SHEARS: [&str; 3] = ["shear_xy_um_per_m", "shear_yz_um_per_m", "shear_zx_um_per_m"];
/// How often an axis is off, over how often an effect is there: the small errors of a robot that
/// nobody has named act like several axes together.
const RARE: f64 = 0.1;

/// Axes of unequal scale, or that are not square.
pub static DEVICE_AXES: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "device_axes",
        kind: Kind::Physics,
        summary: "the axes of tracker, camera or measuring machine have unequal scales or are not square",
        formula: "½·s·(e_a·e_bᵀ + e_b·e_aᵀ)·ball: s is the scale of one axis a = b of {W}, or the shear of two",
        prior: "300 µm/m, and a tenth as often as another effect: cameras and measuring machines are known to \
                0.1 mm in a metre and worse; a common scale cannot be distinguished from longer links",
        parameters: &[
            (&["scale_x_um_per_m"], "scale of x"),
            (&["scale_y_um_per_m"], "scale of y"),
            (&["scale_z_um_per_m"], "scale of z"),
            (&["shear_xy_um_per_m"], "shear of x and y: how far from square, µrad"),
            (&["shear_yz_um_per_m"], "shear of y and z: how far from square, µrad"),
            (&["shear_zx_um_per_m"], "shear of z and x: how far from square, µrad"),
        ],
        needs: "points of a tracker, camera or measuring machine",
        cause: "unequal or oblique axes of the measuring device",
        cause_at: |location| format!("the axes of the measuring device ({location})"),
        written_to: WrittenTo::Recording,
        reported: Reported::Together,
        seen_along: |_| Vec::new(),
        direct_check: Some("Measure a bar of known length along x, y and z, and across."),
    },
    candidates: axes,
    estimates: own_parameters,
    observed: axes_observed,
    write: write_axes,
    transfer: Transfer::Nothing,
    event: no_event,
};

fn axes(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    // each station has axes of its own
    if !context.is_tracked() || context.recording.stations.len() > 1 {
        return Vec::new();
    }
    let entry = |form: String, name: &str, pair: [usize; 2]| {
        let location = Location::Form { part: Part::Tracker, form };
        let column = context.column(|_, there| shown(pair, &there.tip));
        let mut entry = single(&DEVICE_AXES, location, linear(name, ERROR), column).by(Law::Axes(pair));
        entry.candidate.weight = RARE;
        entry
    };
    let letter = |axis: usize| Axis::ALL[axis];
    let scale = |axis: usize| entry(format!("scale along {}", letter(axis)), SCALES[axis], [axis, axis]);
    let shear = |k: usize| {
        let [a, b] = PAIRS[k];
        entry(format!("{} and {} not square", letter(a), letter(b)), SHEARS[k], PAIRS[k])
    };
    (0..3).map(scale).chain((0..3).map(shear)).collect()
}

/// ½·(e_a·e_bᵀ + e_b·e_aᵀ)·ball.
fn shown([a, b]: [usize; 2], ball: &Vector3<f64>) -> Vector3<f64> {
    0.5 * (unit(a) * ball[b] + unit(b) * ball[a])
}

fn write_axes(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let number = |part: &FindingPart| match model.law(part.term.candidate) {
        Law::Axes(pair) => Some((*pair, part.term.values.first().copied()?)),
        _ => None,
    };
    let numbers: Vec<([usize; 2], f64)> = finding.parts.iter().filter_map(number).collect();
    out_of_what_is_shown(finding, model, extended, |ball| {
        numbers.iter().map(|(pair, value)| shown(*pair, ball) * *value).sum()
    })
}

fn axes_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let of_number = |own: &Estimate| {
        let number = own.quantity();
        if let Some(k) = SHEARS.iter().position(|name| *name == own.name) {
            let [a, b] = PAIRS[k].map(|axis| Axis::ALL[axis]);
            return format!("{a} and {b} are {} from square", number.size().with_unit("µrad"));
        }
        let axis = SCALES.iter().position(|name| *name == own.name).unwrap_or_default();
        let word = if number.value < 0.0 { "small" } else { "large" };
        format!("the scale along {} is {} too {word}", Axis::ALL[axis], number.size().with_unit("µm/m"))
    };
    let all: Vec<String> = finding.estimates.iter().map(of_number).collect();
    format!("On the measuring device, {}", all.join(", "))
}
