//! What gives way under the weight of the arm: drives, and the base below them; links in
//! `bending.rs`.
//!
//! Where a robot's masses are unknown its torques are a sum over its links, τⱼ = Σ_k m_k·zⱼ·((p_k −
//! oⱼ) × g), and the compliance has one parameter for every frame beyond the joint: c·m_k·g, rad
//! per metre of horizontal lever.

use super::super::model::entry::{Column, at_least, linear};
use super::super::model::law::Law;
use super::super::model::{CalibrationModel, Configuration};
use super::per_torque::per_torque;
use super::{
    CalibrationEffect, Context, Entry, Transfer, along, first, first_value, in_file, joint, joint_by, lack,
    law, no_event, on_top, own_parameters, single,
};
use crate::calibration::campaign::Campaign;
use crate::inference::{
    Effect, Finding, JointVariable, Kind, Location, NotTestable, Parameter, Part, Reported, WrittenTo,
};
use crate::robot::{self, TorquePower};
use crate::units::capital;

/// Angle by which a joint or a link deflects under its largest torque beyond what is modelled, rad:
/// a tenth to a half of what industrial drives deflect by altogether (0.5 mrad).
pub(super) const DEFLECTION: f64 = 200e-6;
/// Torque relative to the robot's largest below which a joint counts as unloaded.
const NO_TORQUE: f64 = 1e-3;
/// Distance below which frames are at one point and weights have no lever, m.
const ONE_POINT: f64 = 0.01;
/// What is said where torques are unknown.
pub(super) const NO_MASSES: &str = "the robot file has no masses, so that no torque is known";

/// Joints that turn and are loaded, with their largest torque, N·m; none without masses.
pub(super) fn loaded(context: &Context) -> Vec<(usize, f64)> {
    let largest = |j: usize| context.largest(|there| there.torque[j]);
    let most = (0..context.joint_count()).map(largest).fold(0.0, f64::max);
    let is_loaded =
        |&(_, torque): &(usize, f64)| context.has_masses && most > 0.0 && torque > NO_TORQUE * most;
    context.revolute().into_iter().map(|j| (j, largest(j))).filter(is_loaded).collect()
}

/// A drive that is compliant.
pub static JOINT_COMPLIANCE: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "joint_compliance",
        kind: Kind::Physics,
        summary: "a drive is not as compliant as modelled",
        formula: "Jⱼ·c·τⱼ; without masses Jⱼ·Σ_k c_k·(horizontal lever of frame k about the joint)",
        prior: "200 µrad at the largest torque: a tenth to a half of the whole deflection of \
                industrial drives (0.5 mrad)",
        parameters: &[
            (&["compliance_urad_per_nm"], "angle per torque, beyond the model"),
            (
                &["joint_N_urad_per_m", "flange_urad_per_m"],
                "angle per metre of horizontal lever, by an \
                unknown weight at that frame",
            ),
        ],
        needs: "a joint that is loaded differently from pose to pose",
        cause: "the compliance of its drive",
        cause_at: |location| format!("the compliance of {}", location.place()),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Torque),
        direct_check: None,
    },
    candidates: compliances,
    estimates: own_parameters,
    observed: compliance_observed,
    write: write_compliance,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn compliances(context: &Context, _: &mut Vec<NotTestable>) -> Vec<Entry> {
    let loaded = loaded(context);
    if loaded.is_empty() {
        let joints = context.revolute().into_iter();
        return joints.filter_map(|j| compliance_without_masses(context, j)).collect();
    }
    let of_joint = |(j, largest): (usize, f64)| {
        // with what is modelled no drive turns against its torque
        let modelled = context.configurations.first().map_or(0.0, |there| there.compliance[j]);
        let modelled = modelled
            + in_file(context.effects, |effect| match effect {
                robot::Effect::Compliance { joint, per_nm } if *joint == j => Some(*per_nm),
                _ => None,
            });
        let compliance = linear("compliance_urad_per_nm", DEFLECTION / largest);
        let compliance = at_least(-modelled, compliance);
        single(&JOINT_COMPLIANCE, joint(j), compliance, context.turn(j, |_, there| there.torque[j]))
    };
    loaded.into_iter().map(of_joint).collect()
}

fn compliance_without_masses(context: &Context, j: usize) -> Option<Entry> {
    let down = context.configurations.first()?.gravity.try_normalize(0.0)?;
    let beyond: Vec<Option<usize>> = (j + 1..context.joint_count()).map(Some).chain([None]).collect();
    let point =
        |there: &Configuration, frame: Option<usize>| frame.map_or(there.flange.origin, |k| there.origin[k]);
    // frames that are always at one point are one; the outermost stands for all
    let differs = |(at, frame): (usize, &Option<usize>)| {
        let apart = |there: &Configuration| {
            beyond[at + 1..]
                .iter()
                .map(|other| (point(there, *other) - point(there, *frame)).norm())
                .fold(f64::INFINITY, f64::min)
        };
        context.configurations.iter().any(|there| apart(there) > ONE_POINT)
    };
    let frames =
        beyond.iter().enumerate().filter(|&(at, frame)| differs((at, frame))).map(|(_, frame)| *frame);
    let (frames, parameters): (Vec<Option<usize>>, Vec<(Parameter, Column)>) = frames
        .filter_map(|frame| {
            // horizontal lever of a force down at the frame, m
            let arm = |there: &Configuration| there.torque_of(j, &point(there, frame), &down);
            let largest = context.largest(arm);
            let name = frame.map_or("flange_urad_per_m".into(), |k| format!("joint_{}_urad_per_m", k + 1));
            let column = context.turn(j, |_, there| arm(there));
            // drives deflect with their torque, never against it
            let known = in_file(context.effects, |effect| match effect {
                robot::Effect::Weight { joint, at, per_metre } if (*joint, *at) == (j, frame) => {
                    Some(*per_metre)
                }
                _ => None,
            });
            let deflection = at_least(-known, linear(name, DEFLECTION / largest.max(ONE_POINT)));
            (largest > ONE_POINT).then_some((frame, (deflection, column)))
        })
        .unzip();
    let location = joint_by(j, "masses unknown");
    let entry = |parameters| Entry::new(&JOINT_COMPLIANCE.effect, location, parameters);
    (!parameters.is_empty()).then(|| entry(parameters).by(Law::MassesUnknown(frames)))
}

fn compliance_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let named = capital(&finding.location);
    match law(finding, model) {
        Law::MassesUnknown(_) => {
            format!("{named} gives way to the weight beyond it (the robot file has no masses)")
        }
        Law::Only
        | Law::Gear(_)
        | Law::Play(_)
        | Law::Nonlinear(_)
        | Law::Rod(_)
        | Law::Hung(_)
        | Law::Drift(..)
        | Law::Warms(..)
        | Law::Bends(_)
        | Law::Moved(_)
        | Law::Axes(_) => {
            let by = first(finding);
            let word = if by.value >= 0.0 { "more" } else { "less" };
            format!("{named} gives way by {} {word} than modelled", by.size().with_unit("µrad/(N·m)"))
        }
    }
}

/// A weight that nobody knows is written with its lever.
fn write_compliance(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    match (finding.location.joint(), law(finding, model)) {
        (Some(joint), Law::Only) => {
            let known = model.calibration.setup.compliance[joint];
            extended.robot.joints[joint].compliance = known + first_value(finding);
            WrittenTo::Model
        }
        (Some(joint), Law::MassesUnknown(frames)) => {
            let Some(part) = finding.parts.first() else { return WrittenTo::Nowhere };
            for (&at, &per_metre) in frames.iter().zip(&part.term.values).filter(|(_, value)| **value != 0.0)
            {
                extended.robot.effects.push(robot::Effect::Weight { joint, at, per_metre });
            }
            WrittenTo::Model
        }
        _ => WrittenTo::Nowhere,
    }
}

/// A drive that deflects out of proportion to its load.
pub static JOINT_NONLINEAR_STIFFNESS: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "joint_nonlinear_stiffness",
        kind: Kind::Physics,
        summary: "a drive's compliance depends on its load",
        formula: "Jⱼ·k₂·τⱼ|τⱼ| or Jⱼ·k₃·τⱼ³",
        prior: "200 µrad at the largest torque, as joint_compliance",
        parameters: &[
            (&["urad_per_nm2"], "angle per square of the torque"),
            (&["urad_per_nm3"], "angle per third power of the torque"),
        ],
        needs: "masses in the robot file, and a joint that they load",
        cause: "a stiffness that depends on the load",
        cause_at: |location| format!("a load-dependent stiffness of {}", location.place()),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |location| along(location, JointVariable::Torque),
        direct_check: None,
    },
    candidates: nonlinear,
    estimates: per_torque,
    observed: nonlinear_observed,
    write: write_nonlinear,
    transfer: Transfer::Candidate,
    event: no_event,
};

fn nonlinear(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    let loaded = loaded(context);
    if loaded.is_empty() {
        lacks.push(lack(&JOINT_NONLINEAR_STIFFNESS, NO_MASSES));
    }
    let of_joint = |(j, largest): (usize, f64)| {
        let turn = |angle: fn(f64) -> f64| context.turn(j, move |_, there| angle(there.torque[j]));
        let quadratic = linear("urad_per_nm2", DEFLECTION / largest.powi(2));
        let cubic = linear("urad_per_nm3", DEFLECTION / largest.powi(3));
        let square = turn(|torque| torque * torque.abs());
        let cube = turn(|torque| torque.powi(3));
        [
            single(&JOINT_NONLINEAR_STIFFNESS, joint(j), quadratic, square)
                .by(Law::Nonlinear(TorquePower::Square)),
            single(&JOINT_NONLINEAR_STIFFNESS, joint_by(j, "cubic"), cubic, cube)
                .by(Law::Nonlinear(TorquePower::Cube)),
        ]
    };
    loaded.into_iter().flat_map(of_joint).collect()
}

fn nonlinear_observed(finding: &Finding, model: &CalibrationModel) -> String {
    let (unit, power) = match law(finding, model) {
        Law::Nonlinear(TorquePower::Cube) => ("µrad/(N·m)³", "the third power of"),
        Law::Nonlinear(TorquePower::Square)
        | Law::Only
        | Law::Gear(_)
        | Law::Play(_)
        | Law::MassesUnknown(_)
        | Law::Rod(_)
        | Law::Hung(_)
        | Law::Drift(..)
        | Law::Warms(..)
        | Law::Bends(_)
        | Law::Moved(_)
        | Law::Axes(_) => ("µrad/(N·m)²", "the square of"),
    };
    format!(
        "{} gives way with {power} its load, by {}",
        capital(&finding.location),
        first(finding).with_unit(unit)
    )
}

fn write_nonlinear(finding: &Finding, model: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    let (Some(joint), Law::Nonlinear(power)) = (finding.location.joint(), law(finding, model)) else {
        return WrittenTo::Nowhere;
    };
    let (power, coefficient) = (*power, first_value(finding));
    extended.robot.effects.push(robot::Effect::NonlinearStiffness { joint, power, coefficient });
    WrittenTo::Model
}

/// A base that tilts under the arm.
pub static GRAVITY_TILT: CalibrationEffect = CalibrationEffect {
    effect: Effect {
        name: "gravity_tilt",
        kind: Kind::Physics,
        summary: "the base tilts under the arm's weight",
        formula: "φ × (tip − o): φ = k·(moment about o, its horizontal part), o the origin of {0}",
        prior: "200 µrad at the largest moment, as joint_compliance",
        parameters: &[(&["tilt_urad_per_nm"], "angle per moment")],
        needs: "masses in the robot file",
        cause: "the compliance of the base",
        cause_at: |_| "a base that tilts under the arm's weight".into(),
        written_to: WrittenTo::Model,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    },
    candidates: tilts,
    estimates: per_torque,
    observed: |finding, model| {
        let known = tilt_in_file(&model.campaign.robot.effects);
        let (by, unit) = (first(finding), "µrad/(N·m)");
        let plain = || format!("The base tilts by {} under the arm's moment", by.with_unit(unit));
        on_top("The tilt of the base under the arm's moment", by, unit, known).unwrap_or_else(plain)
    },
    write: write_tilt,
    transfer: Transfer::Candidate,
    event: no_event,
};

/// k, rad/(N·m).
fn tilt_in_file(effects: &[robot::Effect]) -> f64 {
    in_file(effects, |effect| match effect {
        robot::Effect::GravityTilt { per_nm } => Some(*per_nm),
        _ => None,
    })
}

fn write_tilt(finding: &Finding, _: &CalibrationModel, extended: &mut Campaign) -> WrittenTo {
    extended.robot.effects.push(robot::Effect::GravityTilt { per_nm: first_value(finding) });
    WrittenTo::Model
}

/// Also by what is known to pull where the masses of the arm are not.
fn tilts(context: &Context, lacks: &mut Vec<NotTestable>) -> Vec<Entry> {
    if loaded(context).is_empty() {
        lacks.push(lack(&GRAVITY_TILT, NO_MASSES));
    }
    tilt(context).into_iter().collect()
}

fn tilt(context: &Context) -> Option<Entry> {
    let largest = context.largest(|there| there.base_moment.norm());
    let column = context.column(|_, there| there.base_moment.cross(&(there.tip - there.base.origin)));
    let size = DEFLECTION / largest.max(f64::MIN_POSITIVE);
    let tilting = at_least(-tilt_in_file(context.effects), linear("tilt_urad_per_nm", size));
    (largest > 0.0).then(|| single(&GRAVITY_TILT, Location::Part(Part::Base), tilting, column))
}
