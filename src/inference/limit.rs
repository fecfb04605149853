//! What makes every claim about a recording weaker.

use std::fmt;

use crate::spatial::Axis;
use crate::units::MM;

/// A weakness of the recording or of its base model; its `Display` is the advice.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Limit {
    /// Nothing was read twice under the same conditions.
    NoRepeats,
    /// Loads along one axis only.
    OneAxis(Axis),
    /// One size of load only.
    OneLoad,
    /// So few readings that a part held out leaves too little to learn from.
    FewReadings(usize),
    /// The readings have no folds that could be held out.
    NoFoldsOfReadings,
    /// The calibration did not come to rest.
    NotConverged,
    /// So many rows for so many parameters.
    FewPoses(usize, usize),
    /// A joint, from 0, that moved over so small a range, rad.
    NarrowJoint(usize, f64),
    /// A joint, from 0, whose axis the target lies on: so far beside it at most, m.
    OnAxis(usize, f64),
    /// The poses are too few to hold any out.
    NoFoldsOfPoses,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Limit::NoRepeats => f.write_str(
                "No reading was repeated: the noise is judged by what the best story leaves, so that every claim is \
                 weaker. Read every load at least twice, each time from a new zero.",
            ),
            Limit::OneAxis(axis) => write!(
                f,
                "Loads along {axis} only: many parts of the rod yield alike under them. Loads along a second axis tell \
                 more than repeats do.",
            ),
            Limit::OneLoad => f.write_str(
                "One size of load only: friction, offsets and play look like stiffness. Use three loads or more.",
            ),
            Limit::FewReadings(count) => write!(
                f,
                "Only {count} readings: what is held out for the proof leaves little to learn from, and small effects \
                 stay unseen.",
            ),
            Limit::NoFoldsOfReadings => {
                f.write_str("The readings are too few to hold any out: nothing is proved by prediction.")
            }
            Limit::NotConverged => f.write_str(
                "The calibration did not come to rest: what it leaves is no measure of the robot. Look at `calibrate` first.",
            ),
            Limit::FewPoses(rows, parameters) => write!(
                f,
                "Only {rows} poses for {parameters} calibrated parameters: these take up most of what else is wrong, and small \
                 effects stay unseen.",
            ),
            Limit::NarrowJoint(joint, range) => write!(
                f,
                "Joint {} moved over {:.0}° only: what depends on its angle stays unseen.",
                joint + 1,
                range.to_degrees()
            ),
            Limit::OnAxis(joint, lever) => write!(
                f,
                "Joint {} cannot be seen: the target lies on its axis (at most {:.2} mm beside it). Offset the tool.",
                joint + 1,
                lever / MM
            ),
            Limit::NoFoldsOfPoses => {
                f.write_str("The poses are too few to hold any out: nothing is proved by prediction.")
            }
        }
    }
}
