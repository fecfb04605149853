//! What may have been written or wired wrongly: units, signs, names, a zero, a sensor, the wrong
//! file.
//!
//! These are records only: a mistake is no term of a model but something that is undone before
//! there is one. How they are found: `diagnosis/rig/mistakes`.

use crate::inference::{Effect, Location, WrittenTo, at};

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
    parameters: &[(&["factor"], "what the numbers must be multiplied by")],
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
    summary: "two columns, two axes of the loads, or two lengths, sides or pipes of the rod are exchanged",
    formula: "names exchanged",
    cause: "two names exchanged",
    cause_at: |location| at("two names exchanged", location),
    direct_check: Some("Push the tip by hand along each axis and look which column moves."),
    ..NONE
};

/// Readings, or loads, in other rows than those where they belong.
pub static ROW_MISTAKE: Effect = Effect {
    name: "row_mistake",
    summary: "readings, or loads, stand some rows away from where they belong",
    formula: "readings of row i = recorded readings of row i + rows",
    parameters: &[(&["rows"], "how many rows further down they stand; 0: the ways down the other way round")],
    needs: "loads that differ from row to row",
    cause: "rows displaced",
    cause_at: |location| at("rows displaced", location),
    direct_check: Some("Compare these rows with the protocol that was written at the rig."),
    ..NONE
};

/// Readings of what each load added.
pub static INCREMENT_MISTAKE: Effect = Effect {
    name: "increment_mistake",
    summary: "readings are what each load added to the one before",
    formula: "reading = c·(F − load before it in its run)",
    prior: "where that leaves 3 % of the squares, offsets leave 10 %, and the slope is the rod's",
    cause: "increments instead of offsets",
    cause_at: |location| at("increments instead of offsets", location),
    direct_check: Some("Compare the largest reading with the display under the largest load."),
    ..NONE
};

/// A load that was typed wrongly in one row.
pub static TYPING_MISTAKE: Effect = Effect {
    name: "typing_mistake",
    summary: "the load of a row is not the one that all its readings show",
    formula: "load = Σ w·s·(y − a)/Σ w·s² of the row's readings",
    parameters: &[(&["n"], "the load by its readings")],
    prior: "in rows where that is 8 σ and a tenth of a usual load away",
    needs: "six readings of a line; two channels that show the load, or a load that no other row has",
    cause: "a number typed wrongly",
    cause_at: |location| at("a number typed wrongly", location),
    direct_check: Some("Compare the row with the protocol that was written at the rig."),
    ..NONE
};

/// A weight that is another one than it is said to be.
pub static WEIGHT_MISTAKE: Effect = Effect {
    name: "weight_mistake",
    summary: "a weight is another one than it is said to be: all its rows show that",
    formula: "load = Σ w·s·(y − a)/Σ w·s² of the readings of all its rows",
    parameters: &[(&["n"], "the load by its readings")],
    prior: "of one load between the least and the largest: 8 σ off, and five times as far as any other",
    needs: "five loads, each in two runs",
    cause: "a weight that is another one",
    cause_at: |location| at("a weight that is another one", location),
    direct_check: Some("Weigh it."),
    ..NONE
};

/// A trial that is another one once more.
pub static COPY_MISTAKE: Effect = Effect {
    name: "copy_mistake",
    summary: "a trial repeats another one to the last digit",
    formula: "all readings equal, where those of other trials scatter",
    prior: "odds of 1000 against chance, by the scatter and the step of the display",
    needs: "three trials through the same loads",
    cause: "a trial copied",
    cause_at: |location| at("a trial copied", location),
    direct_check: Some("Compare the trial with the protocol that was written at the rig."),
    ..NONE
};

/// A zero that was not taken.
pub const OFFSET_MISTAKE: Effect = Effect {
    name: "offset_mistake",
    summary: "a zero was not taken: a constant on all readings of a channel or of a run; or a hanger was not \
        counted in one trial",
    formula: "true = recorded − constant; of loads: true = recorded + constant",
    parameters: &[(&["um"], "the constant"), (&["n"], "what hung more than written")],
    cause: "a zero that was not taken",
    cause_at: |location| match location {
        Location::Key(key) if key.names.starts_with("load_") => at("a hanger that was not counted", location),
        _ => at("a zero that was not taken", location),
    },
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

/// A rod that was bent, or mounted, to another angle than that of its file.
pub static ANGLE_MISTAKE: Effect = Effect {
    name: "angle_mistake",
    summary: "the angle between the pipes is not the one of the rod file",
    formula: "the compliance with γ at the whole degree that leaves the least",
    needs: "loads in the plane of the rod",
    cause: "another angle between the pipes",
    cause_at: |location| at("another angle between the pipes", location),
    written_to: WrittenTo::Model,
    direct_check: Some("Measure the angle between the pipes; 180° is a straight rod."),
    ..NONE
};

/// A display that does not move.
pub static STUCK_SENSOR: Effect = Effect {
    name: "stuck_sensor",
    summary: "a channel shows the same value whatever the load",
    formula: "recorded = constant",
    parameters: &[(&["um"], "what it shows")],
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
    parameters: &[(&["um"], "the limit")],
    needs: "several readings at the limit, others below it",
    cause: "a sensor at the end of its range",
    cause_at: |location| at("a saturated sensor", location),
    ..NONE
};
