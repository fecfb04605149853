//! The body of a diagnosis' report.

use super::headline::{RIVALS_SAID, sentence, um};
use super::ranking::{Ranked, ranking};
use super::remainder::{Remainder, remainder};
use super::{correction, figures, spoken};
use crate::diagnosis::rig::{RigDiagnosis, cause_at};
use crate::diagnosis::{Finding, LackOfFit, Proof, Structure, World, rms};
use crate::report::pictures::diagnosis::Class;
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::rig::readings::Readings;
use crate::rod::Rod;
use crate::units::{UM, significant};

/// Distances from chance, in standard deviations, from which on structure is called weak and strong.
const WEAK: f64 = 3.0;
const STRONG: f64 = 6.0;
/// Most other places that are listed.
const PLACES: usize = 4;

pub fn all(found: &RigDiagnosis, readings: &Readings, rod: Option<&Rod>) -> Vec<Section> {
    let mut sections = vec![findings(found, readings), location(found, rod), proof(found)];
    sections.push(evidence(&ranking(found)));
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
    if !others.is_empty() {
        words += &format!(" It may also be {}.", others.join(", or "));
    }
    // a stretch of the rod is said already
    let places = match found.world.stretch(finding) {
        Some(_) => Vec::new(),
        None => found.other_places(finding),
    };
    if !places.is_empty() {
        let more = if places.len() > PLACES { " …" } else { "" };
        words += &format!(" It may be elsewhere: {}{more}.", places[..places.len().min(PLACES)].join("; "));
    }
    words
}

fn parameters(found: &RigDiagnosis) -> Table {
    let columns = vec![
        Column::text("effect"),
        Column::text("where"),
        Column::text("parameter"),
        Column::number("value", ""),
        Column::number("from", ""),
        Column::number("to", ""),
        Column::number("chance", ""),
    ];
    let caption = "Parameters, in the units of their names, with 95 % intervals. Chance: the probability that noise alone \
                   looks as much like it.";
    let mut table = Table::new("findings", caption, columns);
    for finding in &found.diagnosis.findings {
        let candidate = &found.world.candidates()[finding.chosen.candidate];
        for (k, parameter) in candidate.parameters.iter().enumerate() {
            let Some((value, low, high)) = found.world.interval(finding, k) else { continue };
            let show = |x: f64| significant(x / parameter.unit, 4);
            let first = |text: String| if k == 0 { text } else { String::new() };
            table.row([
                first(spoken(&candidate.effect)),
                first(finding.place.clone()),
                parameter.name.clone(),
                show(value),
                show(low),
                show(high),
                first(chance(finding.p_value)),
            ]);
        }
    }
    table
}

/// A probability; what is less than one in 10^12 is never.
fn chance(p: f64) -> String {
    if p < 1e-12 { "< 1e-12".into() } else { significant(p, 1) }
}

fn location(found: &RigDiagnosis, rod: Option<&Rod>) -> Section {
    let mut table = Table::new(
        "locate",
        "How much the readings' distance from the model follows each number of the recording. Strength: 0 none, 1 nothing \
         else; z: standard deviations from what chance gives.",
        vec![
            Column::text("along"),
            Column::text("before"),
            Column::number("strength", ""),
            Column::number("z", ""),
            Column::text("after"),
            Column::number("strength", ""),
            Column::number("z", ""),
        ],
    );
    let diagnosis = &found.diagnosis;
    for k in figures::covariates(found) {
        let covariate = &found.evidence.covariates[k];
        let (before, after) = (&diagnosis.structure_before[k], &diagnosis.structure_after[k]);
        let cells =
            |s: &Structure| [word(s.z).to_owned(), format!("{:.2}", s.strength), format!("{:.1}", s.z)];
        let mut row = vec![figures::along(&covariate.name).to_owned()];
        row.extend(cells(before).into_iter().chain(cells(after)));
        table.row(row);
    }
    let mut blocks = vec![Block::Table(table)];
    blocks.push(Block::Figure(figures::residuals(found)));
    blocks.extend(rod.and_then(|rod| figures::places(found, rod)).map(Block::Figure));
    Section::new("Where it lives", blocks)
}

fn word(z: f64) -> &'static str {
    match z {
        z if z >= STRONG => "strong",
        z if z >= WEAK => "weak",
        _ => "none",
    }
}

fn proof(found: &RigDiagnosis) -> Section {
    let diagnosis = &found.diagnosis;
    let mut table = Table::new(
        "errors",
        "What is left of the readings. Held out: parts of the readings are predicted from the others, the search for effects \
         included. F compares the averages of repeats with their scatter; a p below 0.001 says that something is left out.",
        vec![
            Column::text("model"),
            Column::number("rms", "µm"),
            Column::number("held out", "µm"),
            Column::number("noise", "µm"),
            Column::number("F", ""),
            Column::number("p", ""),
        ],
    );
    let held_out =
        |of: fn(&Proof) -> f64| diagnosis.proof.as_ref().map_or("–".to_owned(), |proof| um(of(proof)));
    let test = |test: &Option<LackOfFit>| match test {
        Some(test) => [significant(test.f, 3), significant(test.p_value, 2)],
        None => ["–".to_owned(), "–".to_owned()],
    };
    let mut row = |name: &str, rms: f64, held_out: String, noise: String, [f, p]: [String; 2]| {
        table.row([name.to_owned(), um(rms), held_out, noise, f, p]);
    };
    row(
        "as it is",
        rms(&diagnosis.before),
        held_out(|p| p.before),
        String::new(),
        test(&diagnosis.lack_of_fit_before),
    );
    row(
        "with what was found",
        rms(&diagnosis.after),
        held_out(|p| p.after),
        um(diagnosis.noise),
        test(&diagnosis.lack_of_fit_after),
    );
    let mut blocks = Vec::new();
    if let Some(proof) = &diagnosis.proof {
        let interval = proof.gain_interval.map_or_else(String::new, |(low, high)| {
            format!(" (95 % interval {} to {} %)", percent(low), percent(high))
        });
        blocks.push(Block::Paragraph(format!(
            "Of the squares of held-out errors {} % vanish{interval}.",
            percent(proof.gain)
        )));
        blocks.push(Block::Figure(figures::proof(proof, diagnosis.noise)));
    }
    blocks.push(Block::Table(table));
    Section::new("Does it help?", blocks)
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share).replace('-', "−")
}

fn evidence(ranked: &[Ranked]) -> Section {
    let mut table = Table::new(
        "ranking",
        "Every effect by itself against noise alone, at its best place. Odds are powers of ten: 2 is a hundred to one. \
         An effect that says little by itself may be adopted for what another one leaves.",
        vec![
            Column::text("effect"),
            Column::text("where"),
            Column::number("log10 of the odds", ""),
            Column::text("verdict"),
        ],
    );
    for ranked in ranked {
        let odds = ranked.log_odds / std::f64::consts::LN_10;
        let verdict = match ranked.class {
            Class::Adopted if ranked.effect == "unknown" => "remains",
            Class::Adopted => "adopted",
            Class::Rival => "cannot be told from it",
            Class::Rejected => "rejected",
        };
        let odds = if odds.is_finite() { format!("{odds:.1}") } else { "–".into() };
        table.row([spoken(&ranked.effect), ranked.place.clone(), odds, verdict.into()]);
    }
    Section::new(
        "What else it might be",
        vec![Block::Figure(figures::candidates(ranked)), Block::Table(table)],
    )
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
