//! What `diagnose` says: JSON, words, tables and pictures, written once for every diagnosis.
//!
//! What differs between a rig and a calibration is data (`subject::Subject`): its nouns, its
//! pictures, its remainder, and what becomes of the model.

pub mod calibration;
mod headline;
mod json;
mod place;
mod remainder;
pub mod rig;
mod sections;
mod subject;
mod tables;

use serde_json::Value;

use self::subject::Subject;
use super::Report;
use crate::inference::Effect;

fn report(mut subject: Subject) -> Report {
    Report {
        title: subject.title.clone(),
        headline: headline::headline(&subject),
        warnings: warnings(&subject),
        sections: sections::all(&mut subject),
        provenance: Vec::new(),
    }
}

fn json(subject: &Subject) -> Value {
    json::json(subject)
}

fn warnings(subject: &Subject) -> Vec<String> {
    let limits = subject.limits.iter().map(ToString::to_string);
    subject.warnings.iter().cloned().chain(limits).collect()
}

/// What the base model hides, by effect: the places, without those that are seen in another form.
fn hidden(subject: &Subject) -> Vec<(&'static Effect, Vec<String>)> {
    let mut hidden: Vec<(&'static Effect, Vec<String>)> = Vec::new();
    for absorbed in subject.absorbed {
        let place = absorbed.location.place();
        let is_seen = subject
            .candidates
            .iter()
            .any(|candidate| candidate.effect == absorbed.effect && candidate.location.place() == place);
        if is_seen {
            continue;
        }
        let place = place.to_string();
        match hidden.iter_mut().find(|(effect, _)| *effect == absorbed.effect) {
            Some((_, places)) if places.contains(&place) => {}
            Some((_, places)) => places.push(place),
            None => hidden.push((absorbed.effect, vec![place])),
        }
    }
    hidden
}
