//! The first lines of a diagnosis: what was found, and what it is worth.

use super::subject::Subject;
use crate::inference::{Finding, Kind, rms};
use crate::units::{UM, significant};

/// So many findings are said in full; more are named.
const IN_FULL: usize = 2;
/// So many more are named; the others are counted.
const NAMED: usize = 3;
/// So many rivals are said at once.
pub const RIVALS_SAID: usize = 2;

/// What was found, and what it does to the errors.
pub fn headline(subject: &Subject) -> String {
    let diagnosis = subject.diagnosis;
    let noise = format!("{} µm{}", um(diagnosis.noise), subject.per);
    let findings = &diagnosis.findings;
    let remains = subject.remainder.as_ref().map(|left| left.sentence.clone());
    if findings.is_empty() {
        let with_noise = |words: String| format!("{words} Noise is {noise}.");
        return remains.map(with_noise).unwrap_or_else(|| {
            format!(
                "{}: what is left, {} µm{}, is noise ({} µm).",
                subject.agrees,
                um(rms(&diagnosis.before)),
                subject.per,
                um(diagnosis.noise)
            )
        });
    }
    let said: Vec<String> = findings.iter().take(IN_FULL).map(|finding| sentence(subject, finding)).collect();
    let mut words = said.join(" ");
    let others = &findings[IN_FULL.min(findings.len())..];
    let named: Vec<String> = others.iter().take(NAMED).map(cause_at).collect();
    if !named.is_empty() {
        let more = match others.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!("; and {more} more"),
        };
        words += &format!(" Found besides: {}{more}.", named.join("; "));
    }
    words += &worth(subject);
    match remains {
        Some(remains) => format!("{words} {remains}"),
        None => words,
    }
}

/// What the findings do to the errors.
fn worth(subject: &Subject) -> String {
    let (findings, errors) = (&subject.diagnosis.findings, subject.errors);
    let noise = um(subject.diagnosis.noise);
    let it = if findings.len() > 1 { "them" } else { "it" };
    let averaged = errors.averaged;
    let fitted = |why: &str| {
        let (before, after) = (um(errors.before), um(errors.after));
        format!(
            " Taking {it} into account lowers the error from {before} to {after} µm{averaged}{why}; noise is {noise} µm."
        )
    };
    // a single event says nothing about data that were held out
    let are_events = findings.iter().all(|finding| finding.kind() == Kind::Event);
    match errors.held_out {
        _ if are_events => fitted(""),
        Some((before, after)) if um(after) != um(before) && after < before => format!(
            " Taking {it} into account lowers the held-out error from {} to {} µm{averaged}; noise is {noise} µm.",
            um(before),
            um(after)
        ),
        Some((before, after)) => format!(
            " Held-out {} do not confirm {it}: their error is {} µm before and {} µm after{averaged}.",
            subject.noun,
            um(before),
            um(after)
        ),
        None => fitted(" (nothing could be held out)"),
    }
}

/// A finding with what cannot be told from it.
pub fn sentence(subject: &Subject, finding: &Finding) -> String {
    let description = &finding.description;
    let others = finding.other_effects();
    if others.is_empty() {
        return format!("{description}.");
    }
    let said =
        others.iter().take(RIVALS_SAID).map(|(effect, place)| format!(", or {}", (effect.cause_at)(place)));
    let more = if others.len() > RIVALS_SAID { ", or others" } else { "" };
    let said = said.collect::<String>();
    format!("{description}{said}{more}; these {} cannot tell.", subject.noun)
}

/// A finding without numbers.
pub fn cause_at(finding: &Finding) -> String {
    (finding.effect.cause_at)(&finding.location)
}

/// A length in µm with as many digits as are read.
pub fn um(length: f64) -> String {
    significant(length / UM, if length.abs() < 0.995e-4 { 2 } else { 3 })
}
