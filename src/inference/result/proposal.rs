//! What to measure next, in words and as numbers.

use crate::inference::{Effect, Location};
use crate::spatial::{Axis, Direction, Pose};

/// A measurement that would separate a finding from its rivals.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Proposal {
    /// What to do, as the user calls it: a full sentence.
    pub description: String,
    /// The same as numbers; `None` for what is weighed or gauged without any recording.
    pub plan: Option<Plan>,
    /// By how much it would separate the finding from the closest of `separates_from`: ln of the
    /// odds that are expected.
    pub log_odds: f64,
    /// What it separates the finding from.
    pub separates_from: Vec<(&'static Effect, Location)>,
}

/// A measurement as numbers, SI.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Plan {
    /// Loads to hang and offsets to read.
    Loads(LoadPlan),
    /// Poses to measure.
    Poses(PosePlan),
}

/// Loads on a rod.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LoadPlan {
    /// Where the loads pull to.
    pub direction: Direction,
    /// Loads in their order on the way up, N.
    pub loads: Vec<f64>,
    /// True where the same loads, but the largest, are read again on the way down.
    pub unloading: bool,
    /// Where the load hangs, m from the flange; `None` is the tip.
    pub load_station: Option<f64>,
    /// Where the sensors stand, m from the flange; `None` is the tip.
    pub read_station: Option<f64>,
    /// Times since a load was hung at which it is read, s.
    pub waits: Vec<f64>,
    /// How often all of it is done, each time from a new zero.
    pub repeats: usize,
    /// What is read.
    pub channels: Vec<Axis>,
}

/// Poses of a robot, beside those that were measured.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PosePlan {
    /// The poses, in the order in which they are measured.
    pub poses: Vec<PlannedPose>,
    /// A clamp that is not there yet, its name and its frame in {W}; its index is the next one.
    pub new_fixture: Option<(String, Pose)>,
}

/// A pose to measure.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlannedPose {
    /// Joint values, rad or m.
    pub joints: Vec<f64>,
    /// Index of its clamp or socket.
    pub group: usize,
    /// The recorded row that is most like it, from 0.
    pub like: usize,
}
