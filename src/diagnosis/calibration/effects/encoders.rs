//! What a joint turns besides what its encoder shows: a scale, and what its neighbour takes along.

use super::super::model::CalibrationModel;
use super::super::model::entry::linear;
use super::{
    CalibrationEffect, Context, Entry, Transfer, along, first, first_value, joint, no_event, own_parameters,
    single,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Finding, JointVariable, Kind, Location, NotTestable, Reported, WrittenTo};
use crate::robot;
use crate::units::capital;

/// Scale of an encoder, rad per rad.
const SCALE: f64 = 1e-4;
/// What a wrist joint takes along of its neighbour, rad per rad.
const COUPLED: f64 = 1e-4;
/// Joints of a wrist.
const WRIST: usize = 3;

/// A joint that turns more or less than its encoder says.
pub static ENCODER_SCALE: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "encoder_scale",
        kind: Kind::Physics,
        summary: "a joint turns more or less than its encoder shows",
        formula: "Jⱼ·(s − 1)·qⱼ",
        prior: "1e-4: 1 count in 10⁴, the share of an eccentric disc read over part of a turn",
        parameters: &[(&["factor"], "s: angle turned over angle shown")],
        needs: "a joint that turns",
        cause: "the scale of its encoder",
        cause_at: |location| format!("the encoder's scale of {location}"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Angle),
        direct_check: None,
    },
    candidates: scales,
    estimates: own_parameters,
    observed: scale_observed,
    write: write_scale,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn scales(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let of_joint = |j: usize| {
        let mut factor = linear("factor", SCALE);
        factor.neutral = 1.0;
        single(&ENCODER_SCALE, joint(j), factor, context.turn(j, |_, there| there.joints[j]))
    };
    context.revolute().into_iter().map(of_joint).collect()
}

fn scale_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let excess = first(finding).map(|factor| 1e6 * (factor - 1.0));
    let word = if excess.value >= 0.0 { "more" } else { "less" };
    let (named, excess) = (capital(&finding.location), excess.size().with_unit(""));
    format!("{named} turns {excess} µrad per radian {word} than its encoder shows")
}

fn write_scale(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let Some(joint) = finding.location.joint() else { return WrittenTo::Nowhere };
    let factor = first_value(finding);
    extended.robot.effects.push(robot::Effect::EncoderScale { joint, factor });
    WrittenTo::Model
}

/// A wrist joint that takes its neighbour along.
pub static WRIST_COUPLING: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "wrist_coupling",
        kind: Kind::Physics,
        summary: "a wrist joint drives its neighbour",
        formula: "J_J·k·q_I: joint I drives joint J, neighbours among the last three",
        prior: "1e-4 rad per rad",
        parameters: &[(&["fraction"], "rotation of the driven joint per rotation of the driving one")],
        needs: "neighbouring joints of a wrist that turn",
        cause: "coupled wrist gears",
        cause_at: |location| format!("coupling of {location}"),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: couplings,
    estimates: own_parameters,
    observed: coupling_observed,
    write: write_coupling,
    transfer: Transfer::Candidate,
    event: no_event,
};

/// Neighbours among the last joints, either driving the other.
fn couplings(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let count = context.joint_count();
    let turning = context.revolute();
    let neighbours = count.saturating_sub(WRIST)..count.saturating_sub(1);
    let pairs = neighbours.flat_map(|k| [(k, k + 1), (k + 1, k)]);
    let both = pairs.filter(|(i, j)| turning.contains(i) && turning.contains(j));
    both.map(|(from, to)| {
        let column = context.turn(to, |_, there| there.joints[from]);
        let fraction = linear("fraction", COUPLED);
        single(&WRIST_COUPLING, Location::Coupling { from, to }, fraction, column)
    })
    .collect()
}

fn coupling_observed(finding: &Finding, _: &CalibrationModel) -> String {
    let share = first(finding).map(|share| 1e6 * share).with_unit("µrad");
    match finding.location {
        Location::Coupling { from, to } => {
            let (from, to) = (from + 1, to + 1);
            format!("Joint {to} turns by {share} for every radian of joint {from}")
        }
        _ => format!("{}: {share} per radian", finding.location),
    }
}

fn write_coupling(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let Location::Coupling { from, to } = finding.location else { return WrittenTo::Nowhere };
    let fraction = first_value(finding);
    extended.robot.effects.push(robot::Effect::Coupling { from, joint: to, fraction });
    WrittenTo::Model
}
