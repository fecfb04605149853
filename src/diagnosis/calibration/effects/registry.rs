//! The list of all effects of a calibration: the only source of their names.

use super::super::model::law::{Law, TakenUp};
use super::axes::DEVICE_AXES;
use super::bending::LINK_FLEXIBILITY;
use super::clamp_drift::CLAMP_DRIFT;
use super::contact::{CONTACT_FORCE_VARIATION, CONTACT_SPRING};
use super::device::SENSOR_SCALE;
use super::encoders::{ENCODER_SCALE, WRIST_COUPLING};
use super::events::{JOINT_SHIFT, OUTLIER};
use super::fixture::{CLAMP_POSE, CLAMP_SHIFT, SOCKET_SHIFT};
use super::gear::TRANSMISSION_ERROR;
use super::joints::{GRAVITY_TILT, JOINT_COMPLIANCE, JOINT_NONLINEAR_STIFFNESS};
use super::load_change::LOAD_CHANGE;
use super::loads::{GRAVITY_DIRECTION, ROD_MASS, ROD_STIFFNESS, TIP_MASS};
use super::mounting::{BASE_SHIFT, TOOL_SHIFT};
use super::payload::PAYLOAD_MASS;
use super::play::{BACKLASH, JOINT_FRICTION};
use super::procedure::{READBACK_LAG, THERMAL_DRIFT};
use super::range::RANGE_OFFSET;
use super::tracker::TRACKER_LAG;
use super::{CalibrationEffect, Context, Entry, mistakes};
use crate::inference::{Effect, NotTestable};

/// All of them, as they are listed wherever they are.
pub static ALL: [&CalibrationEffect; 31] = [
    &ROD_STIFFNESS,
    &TIP_MASS,
    &ROD_MASS,
    &PAYLOAD_MASS,
    &CONTACT_FORCE_VARIATION,
    &CONTACT_SPRING,
    &SENSOR_SCALE,
    &GRAVITY_DIRECTION,
    &JOINT_COMPLIANCE,
    &JOINT_NONLINEAR_STIFFNESS,
    &LINK_FLEXIBILITY,
    &GRAVITY_TILT,
    &BACKLASH,
    &JOINT_FRICTION,
    &ENCODER_SCALE,
    &WRIST_COUPLING,
    &TRANSMISSION_ERROR,
    &READBACK_LAG,
    &TRACKER_LAG,
    &RANGE_OFFSET,
    &DEVICE_AXES,
    &CLAMP_POSE,
    &CLAMP_SHIFT,
    &SOCKET_SHIFT,
    &CLAMP_DRIFT,
    &BASE_SHIFT,
    &TOOL_SHIFT,
    &LOAD_CHANGE,
    &JOINT_SHIFT,
    &THERMAL_DRIFT,
    &OUTLIER,
];

/// Every mistake that the diagnosis of a calibration knows. They are no terms of a model: they are
/// undone before there is one.
pub static MISTAKES: [&Effect; 14] = [
    &mistakes::SIGN_MISTAKE,
    &mistakes::SWAP_MISTAKE,
    &mistakes::UNIT_MISTAKE,
    &mistakes::OFFSET_MISTAKE,
    &mistakes::DISTANCE_MISTAKE,
    &mistakes::ROW_MISTAKE,
    &mistakes::FRAME_MISTAKE,
    &mistakes::ROD_MISTAKE,
    &mistakes::ROBOT_MISTAKE,
    &mistakes::STUCK_SENSOR,
    &mistakes::SATURATED_SENSOR,
    &mistakes::COPIED_COLUMN,
    &mistakes::TYPING_MISTAKE,
    &mistakes::COPY_MISTAKE,
];

/// What pulls on the arm as a whole: preferred to what a single joint does.
static OF_LOADS: [&CalibrationEffect; 7] = [
    &ROD_STIFFNESS,
    &TIP_MASS,
    &ROD_MASS,
    &PAYLOAD_MASS,
    &CONTACT_FORCE_VARIATION,
    &GRAVITY_DIRECTION,
    &GRAVITY_TILT,
];
/// What follows the torque of a joint.
static OF_TORQUE: [&CalibrationEffect; 4] =
    [&JOINT_COMPLIANCE, &JOINT_NONLINEAR_STIFFNESS, &BACKLASH, &LINK_FLEXIBILITY];
/// What follows the motion of a joint.
static OF_MOTION: [&CalibrationEffect; 3] = [&BACKLASH, &JOINT_FRICTION, &ENCODER_SCALE];

/// True for what pulls on the arm as a whole.
pub(in crate::diagnosis::calibration) fn pulls(effect: &Effect) -> bool {
    OF_LOADS.iter().any(|known| known.effect == *effect)
}

/// The record of an effect; `None` for what nobody has named.
pub(in crate::diagnosis::calibration) fn record(effect: &Effect) -> Option<&'static CalibrationEffect> {
    ALL.into_iter().find(|known| known.effect == *effect)
}

/// The candidates of all effects for a recording, those that do nothing to it included, in the
/// order of preference among those that explain it exactly as well; with the effects that it has no
/// data for. Where a base is upright, for example, a tilting base and the bending first link do the
/// same.
pub(in crate::diagnosis::calibration) fn candidates(context: &Context) -> (Vec<Entry>, Vec<NotTestable>) {
    let mut lacks = Vec::new();
    let mut entries = Vec::new();
    for effect in ALL {
        entries.extend((effect.candidates)(context, &mut lacks));
    }
    // stable: the candidates of one effect stay in its own order
    entries.sort_by_key(preference);
    (entries, lacks)
}

/// Block, joint in it, and place in the block: what loads do, joint by joint what its torque does,
/// joint by joint what its motion does, and then all else in the order of the list.
fn preference(entry: &Entry) -> (usize, usize, usize) {
    let place =
        |block: &[&CalibrationEffect]| block.iter().position(|known| known.effect == *entry.candidate.effect);
    let joint = entry.candidate.location.joint().unwrap_or_default();
    let is_by_approach = entry.law == Law::Play(TakenUp::ByApproach);
    if let Some(place) = place(&OF_LOADS) {
        return (0, 0, place);
    }
    if let Some(place) = place(&OF_TORQUE).filter(|_| !is_by_approach) {
        return (1, joint, place);
    }
    match place(&OF_MOTION) {
        Some(place) => (2, joint, place),
        None => (3, 0, place(&ALL).unwrap_or(ALL.len())),
    }
}
