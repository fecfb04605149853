//! The effects that a rig may show: one file for a family, one record for an effect.
//!
//! A record ([`RigEffect`]) and the functions below it say everything of an effect: its law, its
//! usual size and the source of that number, what it needs of a recording, how it is said, where it
//! is written. [`registry::ALL`] is the list of them.
//!
//! A prior size is what a rig of this kind is usually wrong by: a share of the recording's own
//! loads, readings, times and temperatures, so that the same recording in other units, or of a rod
//! ten times as large, has the same answer. "The paper": Improved
//! MultiCal, Sensors 2023, 23(12), 5717.

pub(super) mod events;
pub(super) mod history;
pub(super) mod load;
pub mod mistakes;
mod places;
pub mod registry;
pub(super) mod sensor;
pub(super) mod structure;
#[cfg(test)]
mod tests;
pub(super) mod zeros;

use super::action::Action;
use super::datum::Datum;
use super::{Body, RigModel};
use crate::inference::{Candidate, Effect, Finding, Location, Parameter, Quantity, Variable};
use crate::rod::Rod;

/// An effect with what it does on a rig.
pub struct RigEffect {
    /// Everything that is said of it.
    pub effect: Effect,
    /// True for what is the rod's: straight lines have no parts.
    pub(super) needs_rod: bool,
    /// Its candidates for these readings, in the order of preference among equals.
    pub(super) candidates: fn(&mut Context) -> Vec<Entry>,
    /// Why it cannot be tested, where it has no candidate.
    pub(super) missing: fn(&Context) -> &'static str,
    /// What the readings show, with numbers: `Loads are felt 1.02 ± 0.04 N too small`.
    pub(super) observed: fn(&Finding, &RigModel) -> String,
}

/// What effects see of readings.
pub(super) struct Context<'a> {
    pub data: &'a [Datum],
    pub body: &'a mut Body,
    pub rod: Option<&'a Rod>,
}

/// A candidate with what its parameters do.
pub(super) type Entry = (Candidate, Vec<Action>);

pub(super) const UNBOUNDED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
pub(super) const NOT_NEGATIVE: (f64, f64) = (0.0, f64::INFINITY);

impl Context<'_> {
    /// The largest load, N.
    pub fn largest_load(&self) -> f64 {
        largest_load(self.data)
    }

    /// The largest reading, m.
    pub fn largest_reading(&self) -> f64 {
        self.data.iter().fold(0.0, |most: f64, d| most.max(d.measured.abs()))
    }
}

/// The largest load, N.
pub(super) fn largest_load(data: &[Datum]) -> f64 {
    data.iter().fold(0.0, |max: f64, d| max.max(d.load))
}

pub(super) fn parameter(name: &str, unit: f64, neutral: f64, size: f64, bounds: (f64, f64)) -> Parameter {
    Parameter { name: name.into(), unit, neutral, size, bounds }
}

/// A candidate of one parameter.
fn entry(effect: &'static RigEffect, location: Location, parameter: Parameter, action: Action) -> Entry {
    (candidate(&effect.effect, location, vec![parameter]), vec![action])
}

/// A candidate as likely as its effect's others.
pub(super) fn candidate(
    effect: &'static Effect,
    location: Location,
    parameters: Vec<Parameter>,
) -> Candidate {
    Candidate { effect, location, parameters, weight: 1.0, is_alternative: false, is_nonparametric: false }
}

/// Gives those entries that are `main` as much weight together as all others together: the place
/// that a rod's file names, the rig as a whole.
fn preferring(mut entries: Vec<Entry>, is_main: impl Fn(&Candidate) -> bool) -> Vec<Entry> {
    let main = entries.iter().filter(|(candidate, _)| is_main(candidate)).count();
    let others = entries.len() - main;
    for (candidate, _) in &mut entries {
        candidate.weight = 1.0 / if is_main(candidate) { main } else { others } as f64;
    }
    entries
}

/// Marks one of several forms of the same thing.
fn alternative((candidate, actions): Entry) -> Entry {
    (Candidate { is_alternative: true, ..candidate }, actions)
}

/// What follows a load is best seen along it.
fn along_the_load(_: &Location) -> Vec<Variable> {
    vec![Variable::SignedLoad, Variable::Load]
}

/// A number of a finding in the unit of its name; NaN where it has none of that name.
fn of(finding: &Finding, name: &str) -> Quantity {
    let nothing = Quantity { value: f64::NAN, low: f64::NAN, high: f64::NAN };
    finding.quantity(name).unwrap_or(nothing)
}

/// Its size as people write it.
fn said(finding: &Finding, name: &str, unit: &str) -> String {
    of(finding, name).size().say(unit)
}
