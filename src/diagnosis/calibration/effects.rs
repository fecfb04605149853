//! The effects that a calibration may have left out: one file for a family, one record for an
//! effect.
//!
//! A record ([`CalibrationEffect`]) and the functions below it say everything of an effect: its
//! formula, its usual size and the source of that number, what it needs of a recording, how it is
//! said, where it is written, what it does to other poses. [`registry::ALL`] is the list of them.
//!
//! A prior size is what a robot or a fixture of this kind is usually wrong by, not what these
//! residuals say. All effects are linear: the response of a recording is a sum of columns, each
//! ∂tip/∂parameter through the calibrated kinematics. In the formulae Jⱼ is the tip Jacobian of
//! joint j, ∂tip/∂qⱼ in {W}, τⱼ the torque of all loads beyond it about its axis.

pub(super) mod axes;
pub(super) mod bending;
pub(super) mod clamp_drift;
pub(super) mod contact;
pub(super) mod device;
pub(super) mod encoders;
pub(super) mod events;
pub(super) mod fixture;
pub(super) mod gear;
pub(super) mod joints;
mod load_change;
pub(super) mod loads;
pub(super) mod mistakes;
pub(super) mod mounting;
pub(super) mod payload;
mod per_torque;
pub(super) mod play;
pub(super) mod procedure;
pub(super) mod range;
pub mod registry;
pub(super) mod tracker;

use nalgebra::Vector3;

use super::model::entry::{Column, Entry, linear};
use super::model::law::Law;
use super::model::{CalibrationModel, Context};
use crate::calibration::campaign::{Campaign, Targets};
use crate::inference::{
    Candidate, Effect, Estimate, Finding, FindingPart, JointVariable, Location, NotTestable, Parameter,
    Quantity, Variable, WrittenTo,
};
use crate::robot;
use crate::units::MM;

/// Error of one joint angle, rad rms: a UR5 shows 60 to 110 µrad, a UR10 220 to 400.
pub(super) const JOINT_ANGLE: f64 = 150e-6;
/// What a knock does, m and rad: millimetres when one sees it, tenths when one does not.
const KNOCK: (f64, f64) = (0.5 * MM, 0.5e-3);
/// Most rows that may be outliers.
const MOST_PLACES: usize = 200;
/// In a recording of no more rows each may be that after which something moved; of a longer one
/// every third, fourth …, then the very row.
pub(super) const EVERY_ROW: usize = 100;
/// Names of the parameters of a displacement and of a turn.
const SHIFT: [&str; 3] = ["dx_um", "dy_um", "dz_um"];
const TURN: [&str; 3] = ["rx_urad", "ry_urad", "rz_urad"];

/// An effect with what it does to a calibrated robot.
pub struct CalibrationEffect {
    /// Everything that is said of it.
    pub effect: Effect,
    /// Its candidates for a recording, in the order of preference among equals, those that do
    /// nothing to it included; what it lacks of data for more is added to the list.
    pub(super) candidates: fn(&Context, &mut Vec<NotTestable>) -> Vec<Entry>,
    /// What the parts of a finding amount to.
    pub(super) estimates: fn(&CalibrationModel, &[FindingPart]) -> Vec<Estimate>,
    /// What the poses show, with numbers: `Joint 3 has 210 ± 20 µrad of play, …`.
    pub(super) observed: fn(&Finding, &CalibrationModel) -> String,
    /// Puts a finding into a campaign that is to be calibrated again, or takes it out of its
    /// points; the answer is where it went.
    pub(super) write: fn(&Finding, &CalibrationModel, &mut Campaign) -> WrittenTo,
    /// What it does to other poses of the same robot.
    pub(super) transfer: Transfer,
    /// For what happened at one pose: how a picture of the order marks it.
    pub(super) event: fn(&Location) -> Option<String>,
}

/// What an effect does to other poses of the same robot.
#[derive(Clone, Copy)]
pub(super) enum Transfer {
    /// Nothing: it happened to the fixture, to its force or to single poses of the recording.
    Nothing,
    /// What its candidate at the same place does there.
    Candidate,
    /// What this makes of the candidate and its law there.
    Made(fn(&Context, &Candidate, &Law) -> Entry),
}

/// An effect without data.
fn lack(effect: &'static CalibrationEffect, reason: &str) -> NotTestable {
    NotTestable { effect: &effect.effect, reason: reason.into() }
}

/// A candidate of one parameter.
fn single(
    effect: &'static CalibrationEffect,
    location: Location,
    parameter: Parameter,
    column: Column,
) -> Entry {
    Entry::new(&effect.effect, location, vec![(parameter, column)])
}

/// A joint, from 0, as a place.
fn joint(joint: usize) -> Location {
    Location::Joint { joint, form: None }
}

/// A joint, from 0, with an error by one of several laws.
fn joint_by(joint: usize, form: impl Into<String>) -> Location {
    Location::Joint { joint, form: Some(form.into()) }
}

/// A number of the joint that a place is.
fn along(location: &Location, what: JointVariable) -> Vec<Variable> {
    location.joint().map(|joint| Variable::Joint(joint, what)).into_iter().collect()
}

/// The unit vector of an axis of {W}.
fn unit(axis: usize) -> Vector3<f64> {
    Vector3::ith(axis, 1.0)
}

/// Three parameters of one size.
fn three(names: &[&str; 3], size: f64, column: impl Fn(usize) -> Column) -> Vec<(Parameter, Column)> {
    let parameter = |(axis, name): (usize, &&str)| (linear(*name, size), column(axis));
    names.iter().enumerate().map(parameter).collect()
}

/// How much of an effect the robot's file has already, SI: what is found comes on top, and no less
/// than nothing is left of both.
fn in_file(effects: &[robot::Effect], amount: impl Fn(&robot::Effect) -> Option<f64>) -> f64 {
    effects.iter().filter_map(amount).sum()
}

/// What is found on top of what the robot's file has: `The play of joint 3 is 90 ± 10 µrad less
/// than the robot file says`; `None` where it has nothing.
fn on_top(what: &str, found: Quantity, unit: &str, in_file: f64) -> Option<String> {
    let word = if found.value < 0.0 { "less" } else { "more" };
    (in_file != 0.0)
        .then(|| format!("{what} is {} {word} than the robot file says", found.size().with_unit(unit)))
}

/// The parameters as they are.
fn own_parameters(_: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    parts.iter().flat_map(|part| part.estimates.clone()).collect()
}

/// Taken out of the measured points; sockets have none.
pub(super) fn out_of_the_points(
    finding: &Finding,
    model: &CalibrationModel,
    extended: &mut Campaign,
) -> WrittenTo {
    move_points(extended, &model.by_row(&model.response_of(finding)))
}

/// The same of what a device shows wrongly of places in {W}: it has shown the points of the
/// validation too.
fn out_of_what_is_shown(
    finding: &Finding,
    model: &CalibrationModel,
    extended: &mut Campaign,
    shown: impl Fn(&Vector3<f64>) -> Vector3<f64>,
) -> WrittenTo {
    let validation = extended.validation.as_mut().map(|recording| &mut recording.targets);
    if let Some(Targets::Points(points)) = validation {
        points.iter_mut().for_each(|point| *point -= shown(point));
    }
    out_of_the_points(finding, model, extended)
}

/// The measured points without a displacement of each row, m; sockets have none.
pub(super) fn move_points(extended: &mut Campaign, moved: &[Vector3<f64>]) -> WrittenTo {
    match &mut extended.measurements.targets {
        Targets::Sockets(_) => WrittenTo::Nowhere,
        Targets::Points(points) => {
            points.iter_mut().zip(moved).for_each(|(point, moved)| *point -= moved);
            WrittenTo::Recording
        }
    }
}

/// Nothing that happened at one pose.
fn no_event(_: &Location) -> Option<String> {
    None
}

/// The law of a finding's strongest part.
fn law<'m>(finding: &Finding, model: &'m CalibrationModel) -> &'m Law {
    finding.parts.first().map_or(&Law::Only, |part| model.law(part.term.candidate))
}

/// The value of the first parameter of a finding's strongest part, SI.
fn first_value(finding: &Finding) -> f64 {
    let value = finding.parts.first().and_then(|part| part.term.values.first());
    value.copied().unwrap_or_default()
}

/// An estimate of a finding, in its unit.
fn nth(finding: &Finding, index: usize) -> Quantity {
    let nothing = Quantity { value: f64::NAN, low: f64::NAN, high: f64::NAN };
    finding.estimates.get(index).map_or(nothing, Estimate::quantity)
}

/// The first estimate of a finding, in its unit.
fn first(finding: &Finding) -> Quantity {
    nth(finding, 0)
}

/// A vector's length over the first three values of a finding's strongest part, in `unit`.
fn size(finding: &Finding, unit: f64) -> Quantity {
    let nothing = Quantity { value: f64::NAN, low: f64::NAN, high: f64::NAN };
    finding.parts.first().map_or(nothing, |part| super::model::vector::size(part, unit))
}
