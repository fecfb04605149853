//! What a reader in a hurry takes away from a diagnosis.

use super::headline::{RIVALS_SAID, cause_at, is_scatter_estimated, um};
use super::subject::{Elsewhere, Subject};
use crate::inference::{Finding, Kind};
use crate::report::{Card, Tone};

/// The answer, the errors before and after, how sure, and what is left.
pub fn cards(subject: &Subject) -> Vec<Card> {
    let mut cards = vec![answer(subject), errors(subject)];
    cards.extend(subject.diagnosis.findings.first().map(|finding| sure(subject, finding)));
    cards.extend(subject.elsewhere.as_ref().map(elsewhere));
    cards.push(left(subject));
    cards
}

fn answer(subject: &Subject) -> Card {
    let label = "Strongest finding";
    let findings = &subject.diagnosis.findings;
    match findings.first() {
        Some(first) => {
            let more = match findings.len() - 1 {
                0 => String::new(),
                1 => "; 1 more finding".to_owned(),
                more => format!("; {more} more findings"),
            };
            let kind = match first.kind() {
                Kind::Physics => "physics",
                Kind::Event => "an event",
                Kind::Mistake => "a mistake in the files",
            };
            Card::new(label, cause_at(first), format!("{kind}{more}")).toned(Tone::Attention)
        }
        None if subject.remainder.is_some() => {
            Card::new(label, "none", "something is left that no effect explains").toned(Tone::Attention)
        }
        None => Card::new(label, "none", subject.agrees).toned(Tone::Good),
    }
}

fn errors(subject: &Subject) -> Card {
    let errors = subject.errors;
    let value = |before: f64, after: f64| format!("{} → {} µm", um(before), um(after));
    match errors.held_out {
        _ if subject.diagnosis.findings.is_empty() => {
            // what the headline has per coordinate is here of the whole distance
            let statistic =
                if errors.averaged.is_empty() { "root mean square" } else { "mean distance of the tip" };
            Card::new("Residual", format!("{} µm", um(errors.before)), statistic)
        }
        Some((before, after)) => {
            let tone = if after < before { Tone::Good } else { Tone::Attention };
            let detail = format!("before and after{}", errors.averaged);
            Card::new("Held-out error", value(before, after), detail).toned(tone)
        }
        None => {
            let detail = format!("before and after{}; nothing could be held out", errors.averaged);
            Card::new("Error", value(errors.before, errors.after), detail)
        }
    }
}

/// How sure the strongest finding is.
fn sure(subject: &Subject, finding: &Finding) -> Card {
    let others = finding.other_causes();
    let folds = finding.found_in_folds.map(|(some, all)| format!("in {some} of {all} searches"));
    if others.is_empty() {
        let found = match folds {
            Some(folds) => format!("found {folds} that leave a part of the {} out", subject.noun),
            None => "nothing else explains as much".to_owned(),
        };
        return Card::new("How sure", "no rival", found).toned(Tone::Good);
    }
    let value = match others.len() {
        1 => "1 rival".to_owned(),
        count => format!("{count} rivals"),
    };
    let said = others[..others.len().min(RIVALS_SAID)].join(" or ");
    Card::new("How sure", value, format!("it may as well be {said}")).toned(Tone::Attention)
}

fn elsewhere(own: &Elsewhere) -> Card {
    let tone = if own.is_far { Tone::Attention } else { Tone::Good };
    Card::new("Validation error", own.value.clone(), own.detail.clone()).toned(tone)
}

fn left(subject: &Subject) -> Card {
    let scatter = if is_scatter_estimated(subject) { "estimated scatter" } else { "scatter" };
    let noise = format!("{scatter} {} µm{}", um(subject.diagnosis.noise), subject.per);
    match &subject.remainder {
        Some(remainder) => {
            let value = format!("{} µm rms", um(remainder.rms));
            Card::new("Unexplained", value, format!("{}; {noise}", remainder.location)).toned(Tone::Attention)
        }
        // scatter is unexplained too: "nothing" would contradict the headline
        None => Card::new("Pattern in what is left", "none", noise).toned(Tone::Good),
    }
}
