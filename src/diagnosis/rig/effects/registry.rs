//! All effects of a rig, in the order of preference among equals: the single source of names.

use super::entry::RigEffect;
use super::{
    dimension, display, drift, events, history, load, mistakes, pipe, points, sensor, structure, zeros,
};
use crate::diagnosis::rig::model::RigModel;
use crate::inference::{Effect, Term, WrittenTo};
use crate::rod::Rod;

/// Every effect that the diagnosis of a rig knows.
pub static ALL: [&RigEffect; 23] = [
    &load::FRICTION,
    &load::PULLEY_FRICTION,
    &load::LOAD_OFFSET,
    &load::BACKLASH,
    &structure::STIFFNESS_SCALE,
    &structure::SHEAR_MODULUS,
    &structure::JOINT_COMPLIANCE,
    &structure::ROOT_COMPLIANCE,
    &structure::BEND_FLEXIBILITY,
    &pipe::PIPE_STIFFNESS,
    &dimension::ROD_DIMENSION,
    &sensor::SENSOR_MISALIGNMENT,
    &load::LOAD_MISALIGNMENT,
    &points::LOAD_POINT,
    &points::SENSOR_POINT,
    &sensor::SENSOR_SCALE,
    &display::SENSOR_LAG,
    &history::NONLINEAR_STIFFNESS,
    &history::CREEP,
    &history::HYSTERESIS,
    &history::THERMAL_SOFTENING,
    &drift::THERMAL_DRIFT,
    &events::SLIP,
];

/// Every mistake that the diagnosis of a rig knows. They are no terms of a model: they are undone
/// before there is one.
pub static MISTAKES: [&Effect; 13] = [
    &mistakes::UNIT_MISTAKE,
    &mistakes::SIGN_MISTAKE,
    &mistakes::SWAP_MISTAKE,
    &mistakes::ROW_MISTAKE,
    &mistakes::INCREMENT_MISTAKE,
    &mistakes::TYPING_MISTAKE,
    &mistakes::WEIGHT_MISTAKE,
    &mistakes::COPY_MISTAKE,
    &mistakes::OFFSET_MISTAKE,
    &mistakes::ROD_MISTAKE,
    &mistakes::ANGLE_MISTAKE,
    &mistakes::STUCK_SENSOR,
    &mistakes::SATURATED_SENSOR,
];

/// All that may be a term of a model: the effects, and a mistake that competes with them.
pub(in crate::diagnosis::rig) fn terms() -> impl Iterator<Item = &'static RigEffect> {
    ALL.into_iter().chain([&zeros::ZERO_NOT_TAKEN])
}

/// What is known of an effect; `None` of a lab's own.
pub(in crate::diagnosis::rig) fn record(effect: &Effect) -> Option<&'static RigEffect> {
    terms().find(|known| known.effect == *effect)
}

/// Writes a term back; what no record knows fits no file.
pub(in crate::diagnosis::rig) fn write(term: &Term, model: &RigModel, rod: &mut Rod) -> WrittenTo {
    match record(model.candidates[term.candidate].effect) {
        Some(effect) => (effect.write)(term, model, rod),
        None => WrittenTo::Nowhere,
    }
}
