//! What was run, and how two runs differ, as tables.

use super::json::word;
use super::picture::{difference_picture, two_digits};
use super::{Change, Difference, LEVEL, Quantity, Run, Runs};
use crate::report::table::{Align, Column, Table};
use crate::report::{Block, Section};
use crate::statistics::student_t_quantile;
use crate::units::{significant, with_uncertainty};

pub(super) fn commands(runs: &Runs) -> Section {
    let has_verdict = runs.runs.iter().any(|run| run.verdict.is_some());
    let headers = ["run", "command", "program", "verdict"];
    let columns =
        headers[..if has_verdict { 4 } else { 3 }].iter().map(|header| Column::text(*header)).collect();
    let mut table = Table::new("runs", "What was run; every other run is compared with the first.", columns);
    for run in &runs.runs {
        table.row([
            run.label.as_str(),
            &run.command,
            &run.program,
            run.verdict.as_deref().unwrap_or_default(),
        ]);
    }
    Section::new("The runs", vec![Block::Table(table)])
}

pub(super) fn of_pair(first: &Run, other: &Run, difference: &Difference, is_alone: bool) -> Vec<Section> {
    let names = [&first.label, &other.label];
    let pair = format!("{} against {}", other.label, first.label);
    let mut inputs = Table::new(
        "inputs",
        format!("Input files by the SHA-256 of their content, {pair}."),
        vec![Column::text(names[0]), Column::text(names[1]), Column::text("content")],
    );
    for input in &difference.inputs {
        let file = |k: usize| input.files[k].clone().unwrap_or_else(|| "–".into());
        inputs.row([file(0), file(1), word(input.state).into()]);
    }
    let columns = vec![Column::text("option"), Column::text(names[0]), Column::text(names[1])];
    let mut options = Table::new("options", format!("Options that differ, {pair}."), columns);
    for (name, [a, b]) in &difference.options {
        options.row([name, a, b]);
    }
    let mut parameters = changes("parameters", format!("Parameters, {pair}."), names, &difference.parameters);
    let note = format!(
        "± is half of the 95 % interval. Ratio: difference over √(s₁² + s₂²) of the standard errors. Significant: by Student's t with at most {} % \
         for any such difference by chance in the whole table (Bonferroni), of recordings that have nothing in common.",
        significant(100.0 * LEVEL, 1)
    );
    if difference.parameters.iter().any(|change| change.std_error.is_some()) {
        parameters.notes.push(note);
    }
    let errors = changes("errors", format!("Errors, {pair}."), names, &difference.errors);
    let columns = vec![Column::text("finding"), Column::text(names[0]), Column::text(names[1])];
    let mut findings = Table::new("findings", format!("Findings, {pair}."), columns);
    for (finding, has) in &difference.findings {
        let yes = |has: bool| if has { "found" } else { "–" }.to_owned();
        findings.row([finding.clone(), yes(has[0]), yes(has[1])]);
    }
    let sections = [
        ("Inputs", inputs),
        ("Options", options),
        ("Parameters", parameters),
        ("Errors", errors),
        ("Findings", findings),
    ];
    let with_rows = sections.into_iter().filter(|(_, table)| !table.rows.is_empty());
    let mut picture = difference_picture(&difference.parameters);
    let section = |(what, table): (&str, Table)| {
        let figure = picture.take_if(|_| what == "Parameters");
        let blocks = figure.map(Block::Figure).into_iter().chain([Block::Table(table)]).collect();
        // of two runs there is one pair, which the captions name
        let heading = if is_alone { what.to_owned() } else { format!("{what}, {pair}") };
        Section::new(heading, blocks)
    };
    with_rows.map(section).collect()
}

/// Numbers of two runs; where none has a standard error, nothing is said of significance.
fn changes(name: &str, caption: String, names: [&String; 2], changes: &[Change]) -> Table {
    let right = |header: &str| Column { align: Align::Right, ..Column::in_row_unit(header) };
    let mut columns =
        vec![Column::text("number"), right(names[0]), right(names[1]), Column::units(), right("difference")];
    let has_ratios = changes.iter().any(|change| change.std_error.is_some());
    if has_ratios {
        columns.extend([Column::number("ratio", ""), Column::text("significant")]);
    }
    let mut table = Table::new(name, caption, columns);
    for change in changes {
        let [a, b] = change.values.each_ref().map(shown);
        // a difference has the decimals of what it is a difference of
        let decimals =
            |text: &str| text.split(' ').next().and_then(|t| t.split_once('.')).map_or(0, |(_, d)| d.len());
        let decimals = decimals(&a).max(decimals(&b));
        let mut row =
            vec![change.name.clone(), a, b, change.unit.clone(), signed(change.difference, decimals)];
        if has_ratios {
            let is_significant = change.is_significant.map(|is| if is { "yes" } else { "no" });
            let ratio = change.ratio().map_or_else(|| "–".into(), two_digits);
            row.extend([ratio, is_significant.unwrap_or("not tested").into()]);
        }
        table.row(row);
    }
    table
}

/// "+1.40", "0" where nothing of it is left, "–" where there is none.
fn signed(number: Option<f64>, decimals: usize) -> String {
    let Some(number) = number else { return "–".into() };
    let text = format!("{number:+.decimals$}");
    if text.contains(|digit: char| ('1'..='9').contains(&digit)) { text } else { "0".into() }
}

/// "46.31 ± 0.24": half of the 95 % interval.
pub(super) fn shown(quantity: &Option<Quantity>) -> String {
    let Some(quantity) = quantity else { return "–".into() };
    // a count has no digits behind it
    if quantity.std_error.is_none() && quantity.unit.is_empty() && quantity.value.fract() == 0.0 {
        return format!("{:.0}", quantity.value);
    }
    let half =
        quantity.std_error.map(|error| error * student_t_quantile(0.975, quantity.dof).unwrap_or(f64::NAN));
    with_uncertainty(quantity.value, half.unwrap_or(0.0), 4)
}
