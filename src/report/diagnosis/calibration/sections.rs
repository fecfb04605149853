//! The body of a calibration's diagnosis.

use super::headline::{other_effects, other_places, sentence};
use super::remainder::{Remainder, remainder};
use super::{Distances, figures};
use crate::calibration::{Campaign, Summary};
use crate::diagnosis::calibration::{CalibrationDiagnosis, Mismatch, cause_at};
use crate::diagnosis::rms;
use crate::report::diagnosis::headline::{RIVALS_SAID, um};
use crate::report::diagnosis::ranking::ranking;
use crate::report::diagnosis::shared::{self, add_parameters, alternatives, evidence, locate, proof};
use crate::report::diagnosis::spoken;
use crate::report::table::{Column, Table};
use crate::report::{Block, Section};
use crate::units::{UM, significant};

/// What was recorded.
const NOUN: &str = "poses";

pub fn all(campaign: &Campaign, found: &CalibrationDiagnosis) -> Vec<Section> {
    let mut sections = vec![findings(found), location(campaign, found)];
    let mut helps = proof(NOUN, &found.diagnosis);
    helps.blocks.push(Block::Table(distances(found)));
    if !found.diagnosis.replicas.is_empty() {
        helps.blocks.push(Block::Table(replication(found)));
    }
    helps.blocks.push(Block::Figure(figures::distribution(found)));
    sections.push(helps);
    sections.push(evidence(&ranking(&found.world, &found.diagnosis)));
    sections.push(remains(campaign, found));
    sections.extend(not_seen(found));
    sections
}

fn findings(found: &CalibrationDiagnosis) -> Section {
    if found.mismatches.is_empty() {
        let words = "No effect of the library is needed to explain what the calibration leaves.";
        return Section::new("What was found", vec![Block::Paragraph(words.into())]);
    }
    let points = found.mismatches.iter().zip(&found.next).map(|(mismatch, next)| {
        let next =
            next.as_ref().map_or_else(String::new, |next| format!(" To tell them apart: {}", next.words));
        format!("{} {}{next}", sentence(found, mismatch), details(found, mismatch))
    });
    Section::new("What was found", vec![Block::List(points.collect()), Block::Table(parameters(found))])
}

/// How sure a mismatch is, and what it may be as well.
fn details(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> String {
    let mut words = format!("It explains {} µm rms per coordinate", um(mismatch.rms));
    if let Some((some, all)) = found.found_in_folds(mismatch) {
        words += &format!(", and is found again in {some} of {all} searches without a part of the poses");
    }
    words.push('.');
    if mismatch.parts.len() > 1 && mismatch.effect == "transmission_error" {
        words += &format!(" Its shape takes {} terms; the strongest is told.", mismatch.parts.len());
    }
    let others: Vec<String> = other_effects(found, mismatch)
        .iter()
        .skip(RIVALS_SAID)
        .map(|(effect, place)| cause_at(effect, place))
        .collect();
    let places = other_places(found, mismatch);
    words + &alternatives(&others, &places)
}

fn parameters(found: &CalibrationDiagnosis) -> Table {
    let mut table = shared::parameters();
    for mismatch in &found.mismatches {
        let numbers = mismatch.parameters.iter();
        let numbers = numbers.map(|n| (n.name.as_str(), n.unit, [n.value, n.low, n.high]));
        add_parameters(&mut table, &mismatch.effect, &mismatch.location, mismatch.p_value, numbers);
    }
    table
}

fn location(campaign: &Campaign, found: &CalibrationDiagnosis) -> Section {
    let mut table = locate(NOUN, &found.evidence, &found.diagnosis, figures::along);
    // an arm has dozens of numbers that nothing follows
    let all = table.rows.len();
    table.rows.retain(|row| row[1] != "none" || row[4] != "none");
    let mut blocks = match table.rows.len() {
        0 => vec![Block::Paragraph(format!(
            "What is left follows none of {all} numbers: order, place in the workspace, angles, torques and moves of joints."
        ))],
        some => {
            table.notes.push(format!("Nothing follows any of {} other numbers.", all - some));
            vec![Block::Table(table)]
        }
    };
    blocks.extend(figures::seen(campaign, found).into_iter().map(Block::Figure));
    blocks.push(Block::Figure(figures::vectors(found)));
    Section::new("Where it lives", blocks)
}

fn distances(found: &CalibrationDiagnosis) -> Table {
    let columns = ["mean", "max", "median", "rms"].map(|name| Column::number(name, "µm"));
    let columns = [vec![Column::text("of"), Column::number("poses", "")], columns.to_vec()].concat();
    let mut table = Table::new("distances", "Distances of the tip from where it was measured.", columns);
    let mut row = |name: &str, lengths: &[f64]| {
        let summary = Summary::of(lengths);
        let numbers = [summary.mean, summary.max, summary.median, summary.rms].map(um);
        table.row([vec![name.to_owned(), lengths.len().to_string()], numbers.to_vec()].concat());
    };
    let distances = Distances::of(found);
    row("calibration as it is", &distances.before);
    row("with what was found", &distances.after);
    if let Some((before, after)) = &distances.held_out {
        row("held out, calibration as it is", before);
        row("held out, with what was found", after);
    }
    table
}

/// How well each clamp or placement is predicted from the others.
fn replication(found: &CalibrationDiagnosis) -> Table {
    let columns = vec![
        Column::text("left out"),
        Column::number("calibration as it is", "µm"),
        Column::number("with what the others show", "µm"),
    ];
    let caption = "Each clamp or placement predicted from the others, the search for effects included; rms of a coordinate, \
                   about the socket's own place where nobody knows it.";
    let mut table = Table::new("replication", caption, columns);
    for replica in &found.diagnosis.replicas {
        let name = found.session(replica.session).to_owned();
        table.row(vec![name, um(replica.before), um(replica.after)]);
    }
    table
}

fn remains(campaign: &Campaign, found: &CalibrationDiagnosis) -> Section {
    let diagnosis = &found.diagnosis;
    let Some(left) = remainder(found) else {
        let words = format!(
            "{} µm rms are left of each coordinate; that is their noise ({} µm).",
            um(rms(&diagnosis.after)),
            um(diagnosis.noise)
        );
        return Section::new("What remains", vec![Block::Paragraph(words)]);
    };
    let table = shape(campaign, &left);
    Section::new("What remains", vec![Block::Paragraph(left.sentence), Block::Table(table)])
}

fn shape(campaign: &Campaign, left: &Remainder) -> Table {
    let (name, unit) = &left.along;
    let mut columns = vec![Column::text("pose"), Column::number(figures::along(name), unit.as_str())];
    columns.extend(["x", "y", "z"].map(|axis| Column::number(axis, "µm")));
    let mut table = Table::new("remainder", "The shape of what remains.", columns);
    for (row, value, by) in &left.samples {
        let pose = campaign.measurements.rows[*row].pose.clone();
        let mut cells = vec![pose, significant(*value, 4)];
        cells.extend(by.iter().map(|x| format!("{:.1}", x / UM)));
        table.row(cells);
    }
    table
}

/// What the calibration hides, and what the files have no data for.
fn not_seen(found: &CalibrationDiagnosis) -> Option<Section> {
    let hidden = found.hidden().into_iter().map(|(effect, places)| {
        format!(
            "{} ({}): the calibration takes it up; its parameters would hide it.",
            spoken(&effect),
            places.join(", ")
        )
    });
    let lacking =
        found.world.not_testable.iter().map(|not| format!("{}: {}", spoken(&not.effect), not.reason));
    let points: Vec<String> = hidden.chain(lacking).collect();
    (!points.is_empty()).then(|| Section::new("What cannot be seen here", vec![Block::List(points)]))
}
