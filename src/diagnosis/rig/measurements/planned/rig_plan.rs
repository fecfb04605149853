//! A plan of measurements, and what it will tell.

use crate::inference::{Effect, LoadPlan, Location};

/// What the rig can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bench {
    /// Largest load, N.
    pub largest_load: f64,
    /// Standard deviation of a reading's noise, m.
    pub noise: f64,
    /// True where loads hang and sensors stand at the tip only.
    pub is_at_tip: bool,
}

/// A plan, and what it will tell.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RigPlan {
    /// What to do, in its order.
    pub measurements: Vec<PlannedLoads>,
    /// How long that takes, minutes.
    pub minutes: f64,
    /// ln of the odds that were asked for.
    pub wanted: f64,
    /// Whether it is proven that no plan of less effort is enough; else it is known only that
    /// nothing of this one can be left out.
    pub is_least: bool,
    /// Each effect beside each other one, and beside nothing.
    pub distinguished: Vec<Distinguished>,
    /// The interval of r_rod, where that is what was asked for.
    pub ratio: Option<Ratio>,
}

/// Width of the 95 % interval of r_rod, a share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratio {
    /// At most so wide.
    pub asked: f64,
    /// As noise makes it.
    pub expected: f64,
}

/// One of its measurements.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedLoads {
    /// What to do; a full sentence.
    pub description: String,
    /// The same as numbers.
    pub loads: LoadPlan,
    /// How long that takes, minutes.
    pub minutes: f64,
}

/// How well one effect is distinguished from another.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Distinguished {
    /// What there is.
    pub effect: &'static Effect,
    /// What it may be taken for; `None` is nothing at all.
    pub against: Option<&'static Effect>,
    /// For each place where it may be the ln of the odds against the other one, wherever that is:
    /// that this plan is expected to give, and that all measurements together, repeated twelve
    /// times, would.
    pub places: Vec<(Location, f64, f64)>,
}
