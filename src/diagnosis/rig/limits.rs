//! What a recording cannot say: effects that it has no data for, and what makes every claim weaker.

use std::fmt;

use super::datum::Datum;
use super::{Body, RigWorld};
use crate::diagnosis::{Evidence, World};
use crate::rig::readings::Axis;
use crate::rod::Rod;

/// An effect that these readings cannot show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotTestable {
    /// Its name.
    pub effect: &'static str,
    /// What is missing.
    pub reason: &'static str,
}

/// What makes every claim weaker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    NoFolds,
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
            Limit::NoFolds => f.write_str("The readings are too few to hold any out: nothing is proved by prediction."),
        }
    }
}

/// Fewer than these are few.
const FEW: usize = 12;

pub(super) fn limits(world: &RigWorld, evidence: &Evidence) -> Vec<Limit> {
    let data = world.data();
    let mut limits = Vec::new();
    let cells = evidence.cell.iter().max().map_or(0, |last| last + 1);
    if cells == data.len() {
        limits.push(Limit::NoRepeats);
    }
    let axes: Vec<Axis> =
        Axis::ALL.into_iter().filter(|axis| data.iter().any(|d| d.direction.axis == *axis)).collect();
    if let ([axis], Body::Rod(_)) = (&axes[..], &world.body) {
        limits.push(Limit::OneAxis(*axis));
    }
    let mut loads: Vec<f64> = data.iter().map(|d| d.load).filter(|load| *load > 0.0).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    if loads.len() < 2 {
        limits.push(Limit::OneLoad);
    }
    if data.len() < FEW {
        limits.push(Limit::FewReadings(data.len()));
    }
    if evidence.fold.iter().max().is_none_or(|last| *last == 0) {
        limits.push(Limit::NoFolds);
    }
    limits
}

/// Effects of the rig's library that no candidate stands for.
pub(super) fn not_testable(world: &RigWorld, rod: Option<&Rod>) -> Vec<NotTestable> {
    let has = |of: fn(&Datum) -> bool| world.data().iter().any(of);
    let no_rod = "there is no rod: straight lines have no parts";
    let needs_rod = |reason: &'static str| if rod.is_none() { no_rod } else { reason };
    let of_loads = "the loads do not make it yield";
    let no_unloading = "nothing was read while unloading (column `phase`)";
    let reasons = [
        ("stiffness_scale", needs_rod(of_loads)),
        ("shear_modulus", needs_rod("the loads neither twist nor shear the rod")),
        ("joint_compliance", needs_rod(of_loads)),
        ("root_compliance", needs_rod(of_loads)),
        (
            "bend_flexibility",
            needs_rod(match rod.is_some_and(|rod| rod.arc_length() > 0.0) {
                true => of_loads,
                false => "the rod's corner is sharp: it has no arc that could ovalise",
            }),
        ),
        ("friction", "nothing was loaded"),
        ("load_offset", "nothing was loaded"),
        ("backlash", "no channel was read along a load"),
        ("creep", "there are no times, or they do not differ (column `time_s`)"),
        ("hysteresis", no_unloading),
        ("nonlinear_stiffness", "there is one size of load only"),
        ("sensor_scale", needs_rod("nothing was read")),
        ("sensor_misalignment", needs_rod("the channels would show nothing of it")),
        ("load_misalignment", needs_rod("the channels would show nothing of it")),
        (
            "thermal_drift",
            match has(|d| d.time.is_some()) || has(|d| d.temperature.is_some()) {
                true => "times or temperatures are missing in places, or do not differ",
                false => "there are neither times nor temperatures (columns `time_s`, `temperature_c`)",
            },
        ),
        ("slip", "no run has two readings on either side of a slip"),
    ];
    let is_candidate = |effect: &str| world.candidates().iter().any(|c| c.effect == effect);
    reasons
        .into_iter()
        .filter(|(effect, _)| !is_candidate(effect))
        .map(|(effect, reason)| NotTestable { effect, reason })
        .collect()
}
