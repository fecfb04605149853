//! The body of a diagnosis' report.

use super::headline::{RIVALS_SAID, sentence, um};
use super::ranking::ranking;
use super::remainder::{Remainder, remainder};
use super::shared::{self, add_parameters, alternatives, evidence, locate, proof};
use super::{correction, figures, spoken};
use crate::diagnosis::rig::{RigDiagnosis, cause_at};
use crate::diagnosis::{Finding, World, rms};
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::{UM, significant};

/// What was recorded.
const NOUN: &str = "readings";

pub fn all(found: &RigDiagnosis, readings: &Readings, rod: Option<&Rod>) -> Vec<Section> {
    let mut sections = vec![findings(found, readings), location(found, rod), proof(NOUN, &found.diagnosis)];
    sections.push(evidence(&ranking(&found.world, &found.diagnosis)));
    sections.extend(found.correction.as_ref().map(correction::section));
    sections.push(remains(found));
    sections.extend(not_tested(found));
    sections
}

fn findings(found: &RigDiagnosis, readings: &Readings) -> Section {
    let mut blocks = Vec::new();
    blocks.extend(
        readings.source.iter().map(|source| Block::Paragraph(format!("Source of the readings: {source}"))),
    );
    let findings = &found.diagnosis.findings;
    if findings.is_empty() {
        blocks.push(Block::Paragraph("No effect of the library is needed to explain these readings.".into()));
        return Section::new("What was found", blocks);
    }
    let points = findings.iter().zip(&found.next).map(|(finding, next)| {
        let next =
            next.as_ref().map_or_else(String::new, |next| format!(" To tell them apart: {}", next.words));
        format!("{} {}{next}", sentence(found, finding), details(found, finding))
    });
    blocks.push(Block::List(points.collect()));
    blocks.push(Block::Table(parameters(found)));
    Section::new("What was found", blocks)
}

/// How sure a finding is, and what it may be as well.
fn details(found: &RigDiagnosis, finding: &Finding) -> String {
    let mut words = format!("It explains {} µm rms of the readings", um(finding.rms));
    if let Some((some, all)) = found.found_in_folds(finding) {
        words += &format!(", and is found again in {some} of {all} searches without a part of them");
    }
    words.push('.');
    let others: Vec<String> = found
        .other_effects(finding)
        .iter()
        .skip(RIVALS_SAID)
        .map(|(effect, place)| cause_at(effect, place))
        .collect();
    // a stretch of the rod is said already
    let places = match found.world.stretch(finding) {
        Some(_) => Vec::new(),
        None => found.other_places(finding),
    };
    words + &alternatives(&others, &places)
}

fn parameters(found: &RigDiagnosis) -> Table {
    let mut table = shared::parameters();
    for finding in &found.diagnosis.findings {
        let candidate = &found.world.candidates()[finding.chosen.candidate];
        let parameters = candidate.parameters.iter().enumerate().filter_map(|(k, parameter)| {
            let (value, low, high) = found.world.interval(finding, k)?;
            Some((parameter.name.as_str(), parameter.unit, [value, low, high]))
        });
        add_parameters(&mut table, &candidate.effect, &finding.place, finding.p_value, parameters);
    }
    table
}

fn location(found: &RigDiagnosis, rod: Option<&Rod>) -> Section {
    let mut blocks = vec![Block::Table(locate(NOUN, &found.evidence, &found.diagnosis, figures::along))];
    blocks.push(Block::Figure(figures::residuals(found)));
    blocks.extend(rod.and_then(|rod| figures::places(found, rod)).map(Block::Figure));
    Section::new("Where it lives", blocks)
}

fn remains(found: &RigDiagnosis) -> Section {
    let diagnosis = &found.diagnosis;
    let Some(left) = remainder(found) else {
        let words = format!(
            "{} µm rms are left of the readings; that is their noise ({} µm).",
            um(rms(&diagnosis.after)),
            um(diagnosis.noise)
        );
        return Section::new("What remains", vec![Block::Paragraph(words)]);
    };
    let table = shape(&left);
    Section::new("What remains", vec![Block::Paragraph(left.sentence), Block::Table(table)])
}

fn shape(left: &Remainder) -> Table {
    let (name, unit) = &left.along;
    let columns = vec![
        Column::text("readings"),
        Column::number(figures::along(name), unit.as_str()),
        Column::number("left", "µm"),
    ];
    let mut table = Table::new("remainder", "The shape of what remains.", columns);
    for (line, value, y) in &left.samples {
        table.row([line.clone(), significant(*value, 4), format!("{:.1}", y / UM)]);
    }
    table
}

fn not_tested(found: &RigDiagnosis) -> Option<Section> {
    let point = |not: &crate::diagnosis::rig::NotTestable| format!("{}: {}", spoken(not.effect), not.reason);
    let points: Vec<String> = found.not_testable.iter().map(point).collect();
    (!points.is_empty()).then(|| Section::new("What could not be tested", vec![Block::List(points)]))
}
