//! What differs between the diagnosis of a rig and that of a calibration, as data.

use serde_json::Value;

use super::remainder::Remainder;
use crate::diagnosis::Limitation;
use crate::inference::law::Proposed;
use crate::inference::{Absorbed, Candidate, Diagnosis, Evidence, NotTestable, Plan, WrittenTo};
use crate::report::Block;
use crate::report::Section;
use crate::report::table::Table;

/// A diagnosed recording as its report sees it.
pub struct Subject<'a> {
    /// The recording as numbers.
    pub evidence: &'a Evidence,
    /// What was found.
    pub diagnosis: &'a Diagnosis,
    /// All that was asked about.
    pub candidates: &'a [Candidate],
    /// Effects without data.
    pub not_testable: &'a [NotTestable],
    /// Effects that the base model takes up.
    pub absorbed: &'a [Absorbed],
    /// What makes every claim weaker.
    pub limits: &'a [Limitation],
    /// Title of the report.
    pub title: String,
    /// What was recorded: `readings`, `poses`.
    pub noun: &'static str,
    /// Of what a root mean square is: nothing, or ` per coordinate`.
    pub per: &'static str,
    /// Said where nothing was found: `The readings agree with the model`.
    pub agrees: &'static str,
    /// Whose errors are compared before and after.
    pub errors: Errors,
    /// Root mean square before mistakes were corrected, m, where there were any.
    pub before_correction: Option<f64>,
    /// A number of a file that hardly is what its key asks for, in a sentence: it is said first,
    /// for whatever was found may be made of it.
    pub doubtful: Option<String>,
    /// What the nominal numbers explain, in a sentence.
    pub nominal: Option<String>,
    /// Sensors that scatter otherwise than the others do.
    pub uneven: Option<Uneven>,
    /// What the findings are worth for data that no search has seen.
    pub elsewhere: Option<Elsewhere>,
    /// A suspect datum as JSON: its row or pose, its channel.
    pub suspect: Box<dyn Fn(usize) -> Value + 'a>,
    /// What no effect explains.
    pub remainder: Option<Remainder>,
    /// A law for that, or why there is none; `None` where nobody looked for one.
    pub law: Option<LawSubject<'a>>,
    /// Warnings of the input files and of the base model.
    pub warnings: Vec<String>,
    /// Head of the JSON: what was diagnosed.
    pub head: Vec<(&'static str, Value)>,
    /// More of the JSON.
    pub more: Vec<(&'static str, Value)>,
    /// For each finding more of its JSON.
    pub of_findings: Vec<Vec<(&'static str, Value)>>,
    /// For each finding more words.
    pub details: Vec<String>,
    /// Of the table of sessions: what it says, and the head of its first numbers.
    pub sessions: (&'static str, &'static str),
    /// For each session its name.
    pub session_name: Box<dyn Fn(usize) -> String + 'a>,
    /// A proposed measurement as JSON.
    pub plan: Box<dyn Fn(&Plan) -> Value + 'a>,
    /// Above the findings: where the recording is from.
    pub source: Option<String>,
    /// Where the mismatch lives: pictures.
    pub places: Vec<Block>,
    /// Does it help: more tables and pictures.
    pub held_out: Vec<Block>,
    /// What is written back to the model.
    pub consequences: Option<Section>,
    /// Number of rows or readings.
    pub count: usize,
}

impl Subject<'_> {
    /// True where nothing is left out of the model, as far as it could be seen.
    pub fn is_consistent(&self) -> bool {
        let is_contradicted = self.elsewhere.as_ref().is_some_and(|own| own.is_mismatch);
        !self.diagnosis.is_mismatch() && !self.limits.contains(&Limitation::NotConverged) && !is_contradicted
    }

    /// Its own warnings, and the limits of the search.
    pub fn all_warnings(&self) -> Vec<String> {
        let limits = self.limits.iter().map(ToString::to_string);
        self.warnings.iter().cloned().chain(limits).collect()
    }
}

/// Data that no search has seen.
pub struct Elsewhere {
    /// In a sentence.
    pub words: String,
    /// Their error, without and with what was found.
    pub value: String,
    /// What else is known of it, in a few words.
    pub detail: String,
    /// True where it is far from what is expected.
    pub is_far: bool,
    /// True where that is a mismatch, whatever the other data say.
    pub is_mismatch: bool,
}

/// What scatters otherwise than the rest does.
pub struct Uneven {
    /// What it is, as a key of the JSON.
    pub key: &'static str,
    /// In a sentence.
    pub words: String,
    /// As JSON, one object for each.
    pub all: Value,
    /// As a table, where there is one.
    pub table: Option<Table>,
}

/// What was made of the remainder.
pub struct LawSubject<'a> {
    /// A law, or why there is none.
    pub proposed: &'a Proposed,
    /// What was recorded: `readings`.
    pub noun: &'static str,
    /// Of each law that is proposed.
    pub notes: Vec<LawNote>,
    /// What the model's file and the recording's are called.
    pub files: [&'static str; 2],
}

/// What is known of a law besides itself.
pub struct LawNote {
    /// Where --apply writes it.
    pub written_to: WrittenTo,
    /// The nearest mechanism of a textbook, in a sentence.
    pub remark: Option<String>,
}

/// Errors that a headline compares, m.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    /// How they are averaged, for people: nothing for a root mean square, ` on average`.
    pub averaged: &'static str,
    /// Of the data that were fitted.
    pub before: f64,
    /// The same with what was found.
    pub after: f64,
    /// Of held-out data, before and after.
    pub held_out: Option<(f64, f64)>,
}
