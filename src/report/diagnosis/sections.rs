//! The body of a diagnosis' report, of a rig or of a calibration.

use super::headline::{RIVALS_SAID, cause_at, is_scatter_estimated, is_undone, sentence, size, um};
use super::hidden::hidden;
use super::law;
use super::subject::Subject;
use super::tables::{alternatives, evidence, held_out_section, locate, named, parameters, replication};
use crate::inference::{Finding, Kind};
use crate::report::{Block, Section};
use crate::units::capital;

/// So many places where an effect is hidden are said; all of them are in the JSON.
const PLACES: usize = 4;

pub fn all(subject: &mut Subject) -> Vec<Section> {
    let mut sections = vec![findings(subject), location(subject)];
    let mut helps = held_out_section(subject);
    helps.blocks.extend(std::mem::take(&mut subject.held_out));
    if !subject.diagnosis.sessions.is_empty() {
        helps.blocks.push(Block::Table(replication(subject)));
    }
    sections.push(helps);
    sections.push(evidence(subject));
    sections.extend(subject.consequences.take());
    sections.push(remains(subject));
    sections.extend(subject.law.as_ref().map(law::section));
    sections.extend(not_seen(subject));
    sections
}

fn findings(subject: &Subject) -> Section {
    let mut blocks = Vec::new();
    let source = subject.source.iter();
    blocks.extend(source.map(|source| Block::Paragraph(format!("Source of the {}: {source}", subject.noun))));
    let findings = &subject.diagnosis.findings;
    if findings.is_empty() {
        blocks.push(Block::Paragraph(match &subject.remainder {
            Some(_) => "An error was found that no effect of the library explains: see What remains.".into(),
            None => format!("No effect of the library is needed to explain these {}.", subject.noun),
        }));
        return Section::new("What was found", blocks);
    }
    let points = findings.iter().enumerate().map(|(k, finding)| {
        let next = finding.next.as_ref();
        let has_rivals =
            !finding.rivals.is_empty() || next.is_some_and(|next| !next.separates_from.is_empty());
        let purpose = if has_rivals { "distinguish them" } else { "check it" };
        let next = next.map_or_else(String::new, |next| format!(" To {purpose}: {}", next.description));
        // what nothing can undo is said in full above, and no number says more
        let said = match is_undone(finding) {
            true => sentence(subject, finding),
            false => format!("{}.", capital(cause_at(finding))),
        };
        format!("{said} {}{next}", details(subject, k, finding))
    });
    blocks.push(Block::List(points.collect()));
    blocks.push(Block::Table(parameters(findings)));
    Section::new("What was found", blocks)
}

/// Whose residual it is, where no coordinate says it.
fn whose(subject: &Subject) -> String {
    if subject.per.is_empty() { format!(" of the {}", subject.noun) } else { String::new() }
}

/// How sure a finding is, and what it may be as well.
fn details(subject: &Subject, index: usize, finding: &Finding) -> String {
    let whose = whose(subject);
    if !is_undone(finding) {
        return "How much of the residual it explains can be computed from correct numbers only.".into();
    }
    let mut words = format!("It explains {} rms{whose}{}", size(finding.explains), subject.per);
    if let Some((some, all)) = finding.found_in_folds {
        words += &format!(", and is found in {some} of {all} searches that leave a part of them out");
    }
    words.push('.');
    words += subject.details.get(index).map_or("", String::as_str);
    let others = finding.other_effects();
    let others: Vec<String> =
        others.iter().skip(RIVALS_SAID).map(|(effect, place)| (effect.cause_at)(place)).collect();
    // a stretch of the rod is said already
    let places = match finding.place_estimate() {
        Some(_) => Vec::new(),
        None => finding.other_places(),
    };
    words + &alternatives(&others, &places)
}

fn location(subject: &mut Subject) -> Section {
    let findings = subject.diagnosis.findings.iter();
    let mistakes = findings.filter(|finding| finding.kind() == Kind::Mistake);
    // some are corrected before there is a model, others are fitted with all else
    let (fitted, beforehand): (Vec<&Finding>, Vec<&Finding>) =
        mistakes.partition(|own| !own.parts.is_empty());
    let said = match (beforehand.iter().any(|own| is_undone(own)), fitted.is_empty()) {
        (true, true) => "All that follows is of the recording without the mistakes above.",
        (true, false) => {
            "All that follows is of the recording without those of the mistakes above that were corrected beforehand."
        }
        (false, _) => "All that follows is of the recording as it is.",
    };
    let has_mistake = !(beforehand.is_empty() && fitted.is_empty());
    let mut blocks: Vec<Block> = has_mistake.then(|| Block::Paragraph(said.into())).into_iter().collect();
    blocks.push(locate(subject));
    blocks.append(&mut subject.places);
    let is_needed = !subject.diagnosis.findings.is_empty() || subject.diagnosis.discrepancy.is_some();
    Section::new(if is_needed { "Where the mismatch appears" } else { "What the residuals follow" }, blocks)
}

fn remains(subject: &Subject) -> Section {
    let diagnosis = subject.diagnosis;
    let sources = subject.uneven.iter().flat_map(|uneven| uneven.table.clone()).map(Block::Table);
    let Some(left) = &subject.remainder else {
        let whose = whose(subject);
        let words = format!(
            "The residual{whose} is {} µm rms{}; the scatter is {} µm{}.",
            um(diagnosis.error_after()),
            subject.per,
            um(diagnosis.noise),
            if is_scatter_estimated(subject) { ", with the fitted parameters allowed for" } else { "" }
        );
        return Section::new("What remains", [vec![Block::Paragraph(words)], sources.collect()].concat());
    };
    let table = left.table(subject.noun);
    let blocks = vec![Block::Paragraph(left.sentence.clone()), Block::Table(table)];
    Section::new("What remains", [blocks, sources.collect()].concat())
}

/// What the base model hides, and what the files have no data for.
fn not_seen(subject: &Subject) -> Option<Section> {
    let hidden = hidden(subject).into_iter().map(|(effect, places)| {
        let more = match places.len().saturating_sub(PLACES) {
            0 => String::new(),
            more => format!(", and {more} more places"),
        };
        let places = places[..places.len().min(PLACES)].join(", ");
        format!("{} ({places}{more}): the parameters of the calibration absorb it.", named(effect))
    });
    let lacking = subject.not_testable.iter().map(|not| format!("{}: {}", not.effect.title(), not.reason));
    let points: Vec<String> = hidden.chain(lacking).collect();
    (!points.is_empty()).then(|| Section::new("What could not be tested", vec![Block::List(points)]))
}
