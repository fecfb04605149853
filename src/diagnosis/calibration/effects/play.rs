//! What a joint keeps of the way that it came: play and friction.

use super::super::model::CalibrationModel;
use super::super::model::entry::{at_least, linear};
use super::super::model::law::{Law, TakenUp};
use super::joints::{NO_MASSES, loaded};
use super::per_torque::per_torque;
use super::{
    CalibrationEffect, Context, Entry, JOINT_ANGLE, Transfer, along, first, first_value, in_file, joint,
    joint_by, lack, law, no_event, on_top, own_parameters, single,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{Effect, Finding, JointVariable, Kind, NotTestable, Reported, WrittenTo};
use crate::robot;
use crate::units::capital;

/// Play of a gear.
pub static BACKLASH: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "backlash",
        kind: Kind::Physics,
        summary: "play in a gear",
        formula: "Jⱼ·½b·sign(τⱼ) or, where friction holds the joint, Jⱼ·½b·(direction of approach)",
        prior: "150 µrad: the error of a joint angle that a UR5 shows (60 to 110 µrad), and half of \
                a UR10's",
        parameters: &[(&["play_urad"], "the whole gap")],
        needs: "masses in the robot file and a joint whose torque changes sign; for play by approach, \
                rows in the order of recording",
        cause: "play in its gear",
        cause_at: |location| format!("play in {}", location.place()),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| {
            let numbers = [JointVariable::Approach, JointVariable::Torque];
            numbers.into_iter().flat_map(|number| along(location, number)).collect()
        },
        direct_check: None,
    },
    candidates: plays,
    estimates: own_parameters,
    observed: play_observed,
    write: write_play,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn plays(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let play = |j: usize, taken_up: TakenUp| {
        at_least(-play_in_file(context.effects, j, taken_up), linear("play_urad", JOINT_ANGLE))
    };
    let loaded = loaded(context);
    if loaded.is_empty() {
        lacks.push(lack(&BACKLASH, NO_MASSES));
    }
    let sign = |torque: f64| if torque == 0.0 { 0.0 } else { 0.5 * torque.signum() };
    let by_torque = loaded.into_iter().map(|(j, _)| {
        let hangs = context.turn(j, |_, there| sign(there.torque[j]));
        let play = play(j, TakenUp::ByTorque);
        single(&BACKLASH, joint(j), play, hangs).by(Law::Play(TakenUp::ByTorque))
    });
    let by_approach = context.revolute().into_iter().map(|j| {
        let came_from = context.turn(j, |_, there| 0.5 * there.approach[j]);
        let play = play(j, TakenUp::ByApproach);
        single(&BACKLASH, joint_by(j, "by approach"), play, came_from).by(Law::Play(TakenUp::ByApproach))
    });
    by_torque.chain(by_approach).collect()
}

/// The whole gap, rad.
fn play_in_file(effects: &[robot::Effect], own: usize, taken_up: TakenUp) -> f64 {
    in_file(effects, |effect| match (effect, taken_up) {
        (robot::Effect::Backlash { joint, play }, TakenUp::ByTorque) if *joint == own => Some(*play),
        (robot::Effect::PlayByApproach { joint, play }, TakenUp::ByApproach) if *joint == own => Some(*play),
        _ => None,
    })
}

fn play_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let (taken_up, by) = match law(finding, model) {
        Law::Play(TakenUp::ByApproach) => {
            (TakenUp::ByApproach, "taken up according to the direction of approach")
        }
        Law::Play(TakenUp::ByTorque)
        | Law::Only
        | Law::Gear(_)
        | Law::Nonlinear(_)
        | Law::MassesUnknown(_)
        | Law::Rod(_)
        | Law::Hung(_)
        | Law::Drift(..)
        | Law::Warms(..)
        | Law::Bends(_)
        | Law::Moved(_)
        | Law::Axes(_) => (TakenUp::ByTorque, "taken up on the side that its load pulls to"),
    };
    let known = |joint: usize| play_in_file(&model.campaign.robot.effects, joint, taken_up);
    let known = finding.location.joint().map_or(0.0, known);
    let what = format!("The play of {}, {by},", finding.location.place());
    let or_tool = match taken_up == TakenUp::ByTorque && may_be_tool(finding, model) {
        true => ", or the tool is loose in its mount",
        false => "",
    };
    let plain = || {
        let play = first(finding).with_unit("µrad");
        format!("{} has {play} of play, {by}{or_tool}", capital(&finding.location))
    };
    on_top(&what, first(finding), "µrad", known).unwrap_or_else(plain)
}

/// True of the last joint: a tool that is loose in its mount along that joint's motion rests on the
/// side to which its weight turns the joint, and moves the ball as its play does.
fn may_be_tool(finding: &Finding, model: &CalibrationModel) -> bool {
    finding.location.joint().is_some_and(|joint| joint + 1 == model.campaign.robot.joints.len())
}

/// Play by approach needs the order of the poses, wherever it is used.
fn write_play(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    match (finding.location.joint(), law(finding, model)) {
        (Some(joint), Law::Play(TakenUp::ByTorque)) => {
            let play = first_value(finding);
            extended.robot.effects.push(robot::Effect::Backlash { joint, play });
            WrittenTo::Model
        }
        (Some(joint), Law::Play(TakenUp::ByApproach)) => {
            let play = first_value(finding);
            extended.robot.effects.push(robot::Effect::PlayByApproach { joint, play });
            WrittenTo::Model
        }
        _ => WrittenTo::Nowhere,
    }
}

/// A drive that friction keeps wound up.
pub static JOINT_FRICTION: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "joint_friction",
        kind: Kind::Physics,
        summary: "friction that grows with a joint's load keeps its drive wound up",
        formula: "Jⱼ·½h·|τⱼ|·(direction of approach): what play by approach does, but as large as the load \
                  is; friction that does not grow with it is the same as play",
        prior: "150 µrad at the largest torque, as backlash",
        parameters: &[(&["urad_per_nm"], "h: angle between the two directions of approach, per torque")],
        needs: "masses in the robot file, a joint that they load, rows in the order of recording",
        cause: "friction in its drive",
        cause_at: |location| format!("friction in the drive of {}", location.place()),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Approach),
        direct_check: None,
    },
    candidates: frictions,
    estimates: per_torque,
    observed: friction_observed,
    write: write_friction,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn frictions(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let loaded = loaded(context);
    if loaded.is_empty() {
        lacks.push(lack(&JOINT_FRICTION, NO_MASSES));
    }
    let of_joint = |(j, largest): (usize, f64)| {
        let known = friction_in_file(context.effects, j);
        let wound = at_least(-known, linear("urad_per_nm", JOINT_ANGLE / largest));
        let column = context.turn(j, |_, there| 0.5 * there.torque[j].abs() * there.approach[j]);
        single(&JOINT_FRICTION, joint(j), wound, column)
    };
    loaded.into_iter().map(of_joint).collect()
}

fn write_friction(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let Some(joint) = finding.location.joint() else { return WrittenTo::Nowhere };
    extended.robot.effects.push(robot::Effect::Friction { joint, per_nm: first_value(finding) });
    WrittenTo::Model
}

/// h, rad/(N·m).
fn friction_in_file(effects: &[robot::Effect], own: usize) -> f64 {
    in_file(effects, |effect| match effect {
        robot::Effect::Friction { joint, per_nm } if *joint == own => Some(*per_nm),
        _ => None,
    })
}

fn friction_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let known = |joint: usize| friction_in_file(&model.campaign.robot.effects, joint);
    let known = finding.location.joint().map_or(0.0, known);
    let (place, per, unit) = (&finding.location, first(finding), "µrad/(N·m)");
    let plain = || {
        let (joint, per) = (capital(place), per.with_unit("µrad per N·m of load"));
        format!("{joint} stops at two angles, {per} apart, depending on the side it comes from")
    };
    on_top(&format!("The friction of {place}"), per, unit, known).unwrap_or_else(plain)
}
