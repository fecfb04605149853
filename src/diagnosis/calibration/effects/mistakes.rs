//! What may have been written, named or wired wrongly in a campaign: signs, orders, units, zeros,
//! frames, rows, files, columns that do not move.
//!
//! These are records only: a mistake is no term of a model but something that is undone before
//! there is one. How they are found: `diagnosis/calibration/mistakes`.

use crate::inference::{Effect, WrittenTo, at};

const NONE: Effect = Effect {
    prior: "one of some hundred, at odds of 1000, where what it acts on is then three times nearer",
    needs: "",
    ..Effect::MISTAKE
};

/// A joint, or an axis of the device, the wrong way round.
pub static SIGN_MISTAKE: Effect = Effect {
    name: "sign_mistake",
    summary: "a joint, or an axis of the device, has the wrong sign",
    formula: "true = −recorded",
    needs: "joints that move by more than a few degrees",
    cause: "a wrong sign",
    cause_at: |location| at("a wrong sign", location),
    direct_check: Some("Move the joint alone and look which way the arm goes."),
    ..NONE
};

/// Columns, clamps or axes exchanged.
pub static SWAP_MISTAKE: Effect = Effect {
    name: "swap_mistake",
    summary: "joints, axes of the device or clamps are exchanged",
    formula: "names exchanged",
    needs: "joints that move, or two clamps",
    cause: "names exchanged",
    cause_at: |location| at("names exchanged", location),
    direct_check: Some("Move one joint alone and look which column changes."),
    ..NONE
};

/// Radians, metres, inches.
pub static UNIT_MISTAKE: Effect = Effect {
    name: "unit_mistake",
    summary: "angles, positions, forces or numbers of the robot file are in another unit",
    formula: "true = factor × recorded",
    parameters: &[(&["factor"], "what the numbers must be multiplied by")],
    needs: "joints that move",
    cause: "a wrong unit",
    cause_at: |location| at("a wrong unit", location),
    ..NONE
};

/// Sockets that are not as far apart as the campaign says.
pub static DISTANCE_MISTAKE: Effect = Effect {
    name: "distance_mistake",
    summary: "the sockets are not as far apart as the campaign says",
    formula: "d = |mean tip in socket 1 − mean tip in socket 0|, by the robot's drawing",
    prior: "six standard deviations that drawing and poses leave of the distance, and 2 % of it",
    parameters: &[(&["mm"], "the distance by angles and drawing")],
    needs: "a placement with both sockets",
    cause: "a wrong distance of the sockets",
    cause_at: |location| at("a wrong distance", location),
    direct_check: Some("Measure with a caliper how far apart the sockets are."),
    ..NONE
};

/// A joint's zero by a quarter or half turn.
pub static OFFSET_MISTAKE: Effect = Effect {
    name: "offset_mistake",
    summary: "a joint's zero is off by a quarter or half turn, or by any angle in some rows, or in all",
    formula: "true = recorded + constant",
    parameters: &[
        (&["deg"], "what must be added to the recorded angle"),
        (&["mm"], "what must be added where the joint slides"),
    ],
    needs: "joints that move; of the first joint a stated base, of the last one a stated tool",
    cause: "a wrong zero of the joint",
    cause_at: |location| at("a wrong zero", location),
    direct_check: Some("Drive the joint to zero and compare with the robot's drawing."),
    ..NONE
};

/// Angles and positions that do not belong together.
pub static ROW_MISTAKE: Effect = Effect {
    name: "row_mistake",
    summary: "positions stand some rows away from their angles, or in reverse order, or a column beside the others",
    formula: "position (or number of a column) of row i = recorded one of row i + rows, or of row n − i",
    parameters: &[(&["rows"], "how many rows further down a row's position stands")],
    needs: "poses that differ from row to row",
    cause: "rows displaced",
    cause_at: |location| at("rows displaced", location),
    ..NONE
};

/// A frame read in another convention, or the other way round.
pub static FRAME_MISTAKE: Effect = Effect {
    name: "frame_mistake",
    summary: "a frame of base, tool or clamp, an angle, or gravity, is given in another convention, inverted, or in another frame",
    formula: "another order of roll, pitch and yaw; the inverse; axes exchanged; an angle that holds that of the joint before",
    needs: "a stated base, a stated tool or rod, clamps, or two parallel axes; for gravity a robot file with masses",
    cause: "a frame given in another way",
    cause_at: |location| at("a frame given in another way", location),
    ..NONE
};

/// The rod that was on the flange is another one.
pub static ROD_MISTAKE: Effect = Effect {
    name: "rod_mistake",
    summary: "the rod is that of another file of the same folder",
    formula: "another rod's tip and compliance",
    needs: "other rod files beside the given one",
    cause: "another rod's file",
    cause_at: |location| at("another rod's file", location),
    written_to: WrittenTo::Model,
    direct_check: Some("Measure L1 and L2 of the rod on the flange."),
    ..NONE
};

/// The robot is another one.
pub static ROBOT_MISTAKE: Effect = Effect {
    name: "robot_mistake",
    summary: "the robot is that of another file of the same folder",
    formula: "another robot's kinematics",
    needs: "other robot files beside the given one",
    cause: "another robot's file",
    cause_at: |location| at("another robot's file", location),
    written_to: WrittenTo::Model,
    ..NONE
};

/// A column that shows the same value in all rows, or in many one after the other.
pub static STUCK_SENSOR: Effect = Effect {
    name: "stuck_sensor",
    summary: "a column shows the same value in all rows, or in many one after the other",
    formula: "recorded = constant",
    prior: "more equal numbers than one in a thousand recordings has by chance, farther out than the others",
    parameters: &[(&["mm"], "what a position shows"), (&["deg"], "what a joint shows")],
    needs: "five rows, of a joint four; of a joint that never moves a fit that fails",
    cause: "a value that was not recorded",
    cause_at: |location| at("a column that does not change", location),
    written_to: WrittenTo::Nowhere,
    ..NONE
};

/// A device at the end of its range.
pub static SATURATED_SENSOR: Effect = Effect {
    name: "saturated_sensor",
    summary: "a position is cut off at a limit",
    formula: "recorded = limit for all that lies beyond",
    prior: "more equal numbers than one in a thousand recordings has by chance, farther out than the others",
    parameters: &[(&["mm"], "the limit")],
    needs: "five rows at the limit, others below it",
    cause: "a sensor at the end of its range",
    cause_at: |location| at("a saturated sensor", location),
    written_to: WrittenTo::Nowhere,
    ..NONE
};

/// A column that repeats another one.
pub static COPIED_COLUMN: Effect = Effect {
    name: "copied_column",
    summary: "a column repeats another one",
    formula: "column = another column",
    needs: "five rows",
    cause: "one column stands twice",
    cause_at: |location| at("a column that stands twice", location),
    written_to: WrittenTo::Nowhere,
    ..NONE
};

/// One number of one row.
pub static TYPING_MISTAKE: Effect = Effect {
    name: "typing_mistake",
    summary: "one number of one row was typed wrongly",
    formula: "true = recorded with another sign, decimal point or digit",
    prior: "one of some hundred slips of that row, at odds of 1000 against any disturbance",
    parameters: &[(&["meant"], "the number that was meant, in the unit of its column")],
    needs: "a row that is far out, and others that fit",
    cause: "a number that was typed wrongly",
    cause_at: |location| at("a number that was typed wrongly", location),
    ..NONE
};

/// Rows that stand twice.
pub static COPY_MISTAKE: Effect = Effect {
    name: "copy_mistake",
    summary: "rows repeat other rows, or their positions",
    formula: "row i = row k, to the last digit",
    prior: "digits that are five times finer than the scatter; three neighbours, or a row that is far out",
    needs: "measured points",
    cause: "rows that stand twice",
    cause_at: |location| at("rows that stand twice", location),
    ..NONE
};
