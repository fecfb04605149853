//! What may be wrong, as data: one record for everything that is said of an effect.
//!
//! The engine compares effects and copies their records into findings; what an effect does to a
//! recording is the forward model's business, and so are the words with numbers in them.

use std::fmt;

use crate::inference::Location;

/// An effect: what it is, how large it usually is, what it needs, how it is said, where it goes.
///
/// Records are statics of the registries (`diagnosis/rig/effects`,
/// `diagnosis/calibration/effects`), which are the only source of names: `--help`, docs, JSON and
/// "cannot be tested" read them.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Effect {
    /// Name in JSON, tables and arguments, for example `friction`.
    pub name: &'static str,
    /// What sort of thing it is.
    pub kind: Kind,
    /// One line for `--help` and for the table of the docs: what happens.
    pub summary: &'static str,
    /// What it does to a recording, as a formula, and where that is from.
    pub formula: &'static str,
    /// Its usual size (standard deviation of the prior) and the source of that number.
    pub prior: &'static str,
    /// Its numbers: names with their units, three of a vector, and what they mean.
    pub parameters: &'static [(&'static [&'static str], &'static str)],
    /// What a recording must have so that it can be seen.
    pub needs: &'static str,
    /// What it is called where its numbers are said: `friction in the slide`.
    pub cause: &'static str,
    /// The same without numbers, at its place, among others that it may be mistaken for.
    pub cause_at: fn(&Location) -> String,
    /// Which file can hold it.
    pub written_to: WrittenTo,
    /// Which findings of it are reported as one.
    pub reported: Reported,
    /// Numbers of a recording along which it is best seen, the best first.
    pub seen_along: fn(&Location) -> Vec<crate::inference::Variable>,
    /// How it is checked without another recording: a full sentence.
    pub direct_check: Option<&'static str>,
}

/// What sort of thing is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// A law that acts on every datum alike: it will act on the next recording too.
    Physics,
    /// Something that happened once: a slip, a knock, a wrong reading.
    Event,
    /// Something that was written or wired wrongly: a unit, a sign, two columns swapped.
    Mistake,
}

impl Kind {
    /// As in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Physics => "physics",
            Kind::Event => "event",
            Kind::Mistake => "mistake",
        }
    }
}

/// Where `--apply` writes an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum WrittenTo {
    /// Into the model's file: the rod's, the robot's.
    Model,
    /// Out of the recording: the readings or points are corrected.
    Recording,
    /// No file has a place for it.
    Nowhere,
}

/// Which findings of one effect are reported as one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reported {
    /// Each by itself.
    Alone,
    /// All at one place (its form left out): the waves of one joint's gear.
    ByPlace,
    /// All that happened after one row: what a knock does to each channel.
    ByRow,
    /// All of them: misread poses.
    Together,
}

/// The effect of candidates that stand for physics nobody has named.
pub static UNKNOWN: Effect = Effect {
    name: "unknown",
    kind: Kind::Physics,
    summary: "an unexplained error",
    formula: "a smooth curve",
    prior: "",
    parameters: &[],
    needs: "",
    cause: "an unexplained error",
    cause_at: |location| location.to_string(),
    written_to: WrittenTo::Nowhere,
    reported: Reported::Alone,
    seen_along: |_| Vec::new(),
    direct_check: None,
};

/// `a wrong sign (q4_deg)`: what it is called at a place.
pub(crate) fn at(what: &str, location: &Location) -> String {
    format!("{what} ({location})")
}

impl Effect {
    /// What all mistakes have in common, to be filled in by their records: they are corrections of
    /// the recording, each reported by itself.
    pub(crate) const MISTAKE: Effect = Effect {
        name: "",
        kind: Kind::Mistake,
        summary: "",
        formula: "",
        prior: "",
        parameters: &[],
        needs: "",
        cause: "",
        cause_at: |location| location.to_string(),
        written_to: WrittenTo::Recording,
        reported: Reported::Alone,
        seen_along: |_| Vec::new(),
        direct_check: None,
    };

    /// Its name as words: `load offset`.
    pub fn title(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// Names are unique.
impl PartialEq for Effect {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Effect {}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}
