//! What may have been written or wired wrongly: units, signs, names, a zero, a sensor, the wrong
//! file.
//!
//! These are records only: a mistake is no term of a model but something that is undone before
//! there is one. How they are found: `diagnosis/rig/mistakes`.

use crate::inference::{Effect, WrittenTo, at};

const NONE: Effect = Effect {
    prior: "one of some hundred, tried where nothing ordinary fits; odds of 1000 at least",
    needs: "a rod file",
    ..Effect::MISTAKE
};

/// Kilograms for newtons, millimetres for micrometres, a radius for a diameter.
pub static UNIT_MISTAKE: Effect = Effect {
    name: "unit_mistake",
    summary: "a column or a key is in another unit, or a radius stands for a diameter",
    formula: "true = factor × recorded",
    parameters: &[("factor", "what the numbers must be multiplied by")],
    cause: "a wrong unit",
    cause_at: |location| at("a wrong unit", location),
    direct_check: Some("Read the display's and the weights' unit once more."),
    ..NONE
};

/// A channel, or the loads of an axis, the wrong way round.
pub static SIGN_MISTAKE: Effect = Effect {
    name: "sign_mistake",
    summary: "a channel or the loads of an axis have the wrong sign, in all rows or in some",
    formula: "true = −recorded",
    needs: "a rod file; without one, runs of either sign",
    cause: "a wrong sign",
    cause_at: |location| at("a wrong sign", location),
    direct_check: Some("Push the tip by hand along each axis and look which way the display goes."),
    ..NONE
};

/// Two columns, axes or lengths exchanged.
pub static SWAP_MISTAKE: Effect = Effect {
    name: "swap_mistake",
    summary: "two columns, two axes of the loads or two lengths of the rod are exchanged",
    formula: "names exchanged",
    cause: "two names exchanged",
    cause_at: |location| at("two names exchanged", location),
    direct_check: Some("Push the tip by hand along each axis and look which column moves."),
    ..NONE
};

/// A zero that was not taken.
pub const OFFSET_MISTAKE: Effect = Effect {
    name: "offset_mistake",
    summary: "a zero was not taken: a constant on all readings of a channel or of a run",
    formula: "true = recorded − constant, beyond the rod's own deflection",
    parameters: &[("um", "the constant")],
    cause: "a zero that was not taken",
    cause_at: |location| at("a zero that was not taken", location),
    ..NONE
};

/// The rod that was measured is another one.
pub static ROD_MISTAKE: Effect = Effect {
    name: "rod_mistake",
    summary: "the readings are those of another rod file of the same folder",
    formula: "another rod's compliance",
    needs: "other rod files beside the given one",
    cause: "another rod's file",
    cause_at: |location| at("another rod's file", location),
    written_to: WrittenTo::Model,
    direct_check: Some("Measure L1, L2 and the diameters of the rod that was loaded."),
    ..NONE
};

/// A display that does not move.
pub static STUCK_SENSOR: Effect = Effect {
    name: "stuck_sensor",
    summary: "a channel shows the same value whatever the load",
    formula: "recorded = constant",
    parameters: &[("um", "what it shows")],
    needs: "loads under which the channel should move",
    cause: "a sensor that is stuck or not connected",
    cause_at: |location| at("a stuck sensor", location),
    direct_check: Some("Push the tip by hand and look whether the display moves."),
    ..NONE
};

/// A display at the end of its range.
pub static SATURATED_SENSOR: Effect = Effect {
    name: "saturated_sensor",
    summary: "a channel is cut off at a limit",
    formula: "recorded = limit for all that lies beyond",
    parameters: &[("um", "the limit")],
    needs: "several readings at the limit, others below it",
    cause: "a sensor at the end of its range",
    cause_at: |location| at("a saturated sensor", location),
    ..NONE
};
