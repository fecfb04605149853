//! The record of an effect, what it sees of readings, and what candidates are made with.

use std::fmt;

use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{
    Candidate, Effect, Finding, Location, Parameter, Quantity, Term, Variable, WrittenTo,
};
use crate::rig::readings::LoadColumn;
use crate::rod::Rod;
use crate::units::{DEG, Unit};

/// An effect with what it does on a rig.
pub struct RigEffect {
    /// Everything that is said of it.
    pub effect: Effect,
    /// The numbers of its prior, which say how large it usually is.
    pub usual: &'static [Usual],
    /// True for what is the rod's: straight lines have no parts.
    pub(in crate::diagnosis::rig) needs_rod: bool,
    /// Its candidates for these readings, in the order of preference among equals.
    pub(in crate::diagnosis::rig) candidates: fn(&mut Context) -> Vec<Entry>,
    /// Why it cannot be tested, where it has no candidate.
    pub(in crate::diagnosis::rig) missing: fn(&Context) -> &'static str,
    /// What the readings show, with numbers: `Loads are felt 1.02 ± 0.04 N too small`.
    pub(in crate::diagnosis::rig) observed: fn(&Finding, &RigModel) -> String,
    /// Writes a term of it into the rod, where that is its place; the answer is where it belongs.
    pub(in crate::diagnosis::rig) write: fn(&Term, &RigModel, &mut Rod) -> WrittenTo,
}

/// How large something usually is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Usual {
    /// A share: `5 %`.
    Share(f64),
    /// An angle, rad: `1°`.
    Angle(f64),
    /// A factor, or what is added to one.
    Number(f64),
}

/// As the record's prior has it.
impl fmt::Display for Usual {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = |value: f64| (1e6 * value).round() / 1e6;
        match self {
            Usual::Share(share) => write!(f, "{} %", digits(100.0 * share)),
            Usual::Angle(angle) => write!(f, "{}°", digits(angle / DEG)),
            Usual::Number(number) => write!(f, "{}", digits(*number)),
        }
    }
}

/// What effects see of readings.
pub(in crate::diagnosis::rig) struct Context<'a> {
    pub data: &'a [Datum],
    /// The column that the loads stand in.
    pub load_column: LoadColumn,
    pub body: &'a mut Body,
    pub rod: Option<&'a Rod>,
    /// How many times as stiff as its file the rod is at first sight; 1 unless far off.
    pub stiffness: f64,
    /// The same, however near to 1 it is.
    pub at_first_sight: f64,
}

/// A candidate with what its parameters do.
pub(in crate::diagnosis::rig) type Entry = (Candidate, Vec<Action>);

pub(in crate::diagnosis::rig) const UNBOUNDED: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
pub(in crate::diagnosis::rig) const NOT_NEGATIVE: (f64, f64) = (0.0, f64::INFINITY);
/// Of a factor: wider than what anybody mistakes. A factor that is refused leaves its place to
/// another effect that is none, and that one would be named as if nothing else could be.
pub(in crate::diagnosis::rig) const SCALES: (f64, f64) = (0.01, 100.0);

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
pub(in crate::diagnosis::rig) fn largest_load(data: &[Datum]) -> f64 {
    data.iter().fold(0.0, |max: f64, d| max.max(d.load))
}

pub(in crate::diagnosis::rig) fn parameter(
    name: &str,
    neutral: f64,
    size: f64,
    bounds: (f64, f64),
) -> Parameter {
    Parameter { name: name.into(), unit: Unit::of_key(name), neutral, size, bounds }
}

/// A candidate of one parameter.
pub(super) fn entry(
    effect: &'static RigEffect,
    location: Location,
    parameter: Parameter,
    action: Action,
) -> Entry {
    (candidate(&effect.effect, location, vec![parameter]), vec![action])
}

/// A candidate as likely as its effect's others.
pub(in crate::diagnosis::rig) fn candidate(
    effect: &'static Effect,
    location: Location,
    parameters: Vec<Parameter>,
) -> Candidate {
    Candidate::new(effect, location, parameters)
}

/// Gives those entries that are `main` as much weight together as all others together: the place
/// that a rod's file names, the rig as a whole.
pub(super) fn preferring(mut entries: Vec<Entry>, is_main: impl Fn(&Candidate) -> bool) -> Vec<Entry> {
    let main = entries.iter().filter(|(candidate, _)| is_main(candidate)).count();
    let others = entries.len() - main;
    for (candidate, _) in &mut entries {
        candidate.weight = 1.0 / if is_main(candidate) { main } else { others } as f64;
    }
    entries
}

/// Marks one of several forms of the same thing.
pub(super) fn alternative((candidate, actions): Entry) -> Entry {
    (Candidate { is_alternative: true, ..candidate }, actions)
}

/// It is the rig's: taken out of the readings.
pub(super) fn out_of_the_readings(_: &Term, _: &RigModel, _: &mut Rod) -> WrittenTo {
    WrittenTo::Recording
}

/// Neither file has a key for it.
pub(super) fn nowhere(_: &Term, _: &RigModel, _: &mut Rod) -> WrittenTo {
    WrittenTo::Nowhere
}

/// What follows a load is best seen along it.
pub(super) fn along_the_load(_: &Location) -> Vec<Variable> {
    vec![Variable::SignedLoad, Variable::Load]
}

/// The numbers of a finding, each with what it does and the parameter that it is.
pub(super) fn by_action<'m>(
    finding: &Finding,
    model: &'m RigModel,
) -> Vec<(&'m Action, &'m Parameter, Quantity)> {
    let Some(part) = finding.parts.first() else { return Vec::new() };
    let parameters = &model.candidates[part.term.candidate].parameters;
    let numbers = model.actions[part.term.candidate].iter().zip(parameters).zip(&finding.estimates);
    numbers.map(|((action, parameter), own)| (action, parameter, own.quantity())).collect()
}

/// The number of a finding that does this.
pub(super) fn of_action(
    finding: &Finding,
    model: &RigModel,
    is_it: impl Fn(&Action) -> bool,
) -> Option<Quantity> {
    let numbers = by_action(finding, model).into_iter();
    numbers.filter(|(action, ..)| is_it(action)).map(|(.., quantity)| quantity).next()
}

/// A number of a finding in the unit of its name; NaN where it has none of that name.
pub(super) fn number(finding: &Finding, name: &str) -> Quantity {
    let nothing = Quantity { value: f64::NAN, low: f64::NAN, high: f64::NAN };
    finding.quantity(name).unwrap_or(nothing)
}

/// The size of one, as people write it.
pub(super) fn size(finding: &Finding, name: &str, unit: &str) -> String {
    number(finding, name).size().with_unit(unit)
}
