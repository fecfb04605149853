//! All effects of a rig, in the order of preference among equals: the single source of names.

use super::{RigEffect, events, history, load, sensor, structure};

/// Every effect that the diagnosis of a rig knows.
pub static ALL: [&RigEffect; 16] = [
    &load::FRICTION,
    &load::LOAD_OFFSET,
    &load::BACKLASH,
    &structure::STIFFNESS_SCALE,
    &structure::SHEAR_MODULUS,
    &structure::JOINT_COMPLIANCE,
    &structure::ROOT_COMPLIANCE,
    &structure::BEND_FLEXIBILITY,
    &sensor::SENSOR_MISALIGNMENT,
    &load::LOAD_MISALIGNMENT,
    &sensor::SENSOR_SCALE,
    &history::NONLINEAR_STIFFNESS,
    &history::CREEP,
    &history::HYSTERESIS,
    &sensor::THERMAL_DRIFT,
    &events::SLIP,
];
