//! What `diagnose` says: JSON, words, tables and pictures, written once for every diagnosis.
//!
//! What differs between a rig and a calibration is data (`subject::Subject`): its nouns, its
//! pictures, its remainder, and the corrected model.

pub mod calibration;
mod cards;
mod headline;
mod hidden;
mod json;
mod law;
mod lengths;

pub(super) use json::load_plan;
mod place;
mod remainder;
pub mod rig;
mod sections;
mod subject;
mod tables;

use serde_json::Value;

use self::subject::Subject;
use super::Report;
use super::method;

fn report(mut subject: Subject) -> Report {
    Report {
        title: subject.title.clone(),
        headline: headline::headline(&subject),
        cards: cards::cards(&subject),
        method: method::paragraphs(method::DIAGNOSIS),
        warnings: subject.all_warnings(),
        sections: sections::all(&mut subject),
        ..Report::default()
    }
}

fn json(subject: &Subject) -> Value {
    json::json(subject)
}
