//! What `rodcal compare-runs` says: two or more results of one command side by side.

mod difference;
mod run;
#[cfg(test)]
mod tests;

use serde_json::{Value, json};

pub use self::difference::{Change, Difference, Input, LEVEL, State};
pub use self::run::{Quantity, Run, spoken};
use super::chart::{Bar, Chart, Colour, Direction, Figure, Mark, Style};
use super::scale::typeset;
use super::table::{Align, Column, Table};
use super::{Block, Card, Report, Section, Tone};
use crate::error::{Error, Result};
use crate::units::significant;

/// Runs of one command; each is compared with the first.
pub struct Runs {
    runs: Vec<Run>,
    differences: Vec<Difference>,
}

impl Runs {
    /// Of two runs or more.
    ///
    /// # Errors
    /// [`Error::Argument`] for less than two, and where not all are of one command.
    pub fn new(runs: Vec<Run>) -> Result<Runs> {
        let [first, others @ ..] = &runs[..] else {
            return Err(refused(
                "no run".into(),
                "the folders of two runs or more, as --out writes them".into(),
            ));
        };
        if others.is_empty() {
            let found = format!("{} alone", first.folder);
            return Err(refused(found, "the folders of two runs or more, as --out writes them".into()));
        }
        if let Some(other) = others.iter().find(|other| other.subcommand != first.subcommand) {
            let of_run = |run: &Run| format!("{} (rodcal {})", run.folder, run.subcommand);
            let found = format!("{} and {}", of_run(first), of_run(other));
            return Err(refused(found, "runs of one command".into()));
        }
        let differences =
            others.iter().map(|other| Difference::between(first, other)).collect::<Result<_>>()?;
        let labels = labels(&runs.iter().map(|run| run.folder.as_str()).collect::<Vec<_>>());
        let named = |(run, label): (Run, String)| Run { label, ..run };
        Ok(Runs { runs: runs.into_iter().zip(labels).map(named).collect(), differences })
    }

    /// Each run but the first, with its difference from that.
    fn compared(&self) -> impl Iterator<Item = (&Run, &Difference)> {
        self.runs.iter().skip(1).zip(&self.differences)
    }
}

/// The shortest ends of paths, by whole names, that are all different; else the paths.
fn labels(folders: &[&str]) -> Vec<String> {
    let end = |folder: &str, count: usize| -> String {
        let names: Vec<&str> = folder.split('/').filter(|name| !name.is_empty()).collect();
        names[names.len().saturating_sub(count)..].join("/")
    };
    let longest = folders.iter().map(|folder| folder.split('/').count()).max().unwrap_or(0);
    let are_apart = |labels: &Vec<String>| {
        let apart: std::collections::BTreeSet<&String> = labels.iter().collect();
        apart.len() == labels.len() && labels.iter().all(|label| !label.is_empty())
    };
    let ends = (1..=longest).map(|count| folders.iter().map(|folder| end(folder, count)).collect());
    let whole = || folders.iter().map(|folder| (*folder).to_owned()).collect();
    ends.into_iter().find(are_apart).unwrap_or_else(whole)
}

fn refused(found: String, expected: String) -> Error {
    Error::Argument { name: "RUNS", found, expected }
}

/// The JSON of `rodcal compare-runs --json`.
pub fn json(runs: &Runs) -> Value {
    let run = |run: &Run| {
        json!({
            "folder": run.folder,
            "command": run.command,
            "program": run.program,
            "verdict": run.verdict,
        })
    };
    let value = |quantity: &Option<Quantity>| {
        quantity.as_ref().map(|q| json!({ "value": q.value, "std_error": q.std_error }))
    };
    let change = |change: &Change| {
        json!({
            "name": change.name,
            "unit": change.unit,
            "first": value(&change.values[0]),
            "other": value(&change.values[1]),
            "difference": change.difference,
            "std_error": change.std_error,
            "ratio": change.ratio(),
            "significant": change.is_significant,
        })
    };
    let option = |(name, [first, other]): &(String, [String; 2])| json!({ "option": name, "first": first, "other": other });
    let differences = runs.compared().map(|(other, difference)| {
        let inputs = difference.inputs.iter().map(
            |input| json!({ "first": input.files[0], "other": input.files[1], "state": word(input.state) }),
        );
        let findings = difference
            .findings
            .iter()
            .map(|(finding, [first, other])| json!({ "finding": finding, "first": first, "other": other }));
        json!({
            "folder": other.folder,
            "inputs": inputs.collect::<Vec<_>>(),
            "options": difference.options.iter().map(option).collect::<Vec<_>>(),
            "shared_recordings": difference.shared_recordings,
            "parameters": difference.parameters.iter().map(change).collect::<Vec<_>>(),
            "errors": difference.errors.iter().map(change).collect::<Vec<_>>(),
            "findings": findings.collect::<Vec<_>>(),
            "significant": difference.significant(),
            "tested": difference.tested(),
        })
    });
    json!({
        "subcommand": runs.runs.first().map(|run| &run.subcommand),
        "runs": runs.runs.iter().map(run).collect::<Vec<_>>(),
        "differences": differences.collect::<Vec<_>>(),
        "level": LEVEL,
    })
}

fn word(state: State) -> &'static str {
    match state {
        State::Same => "same",
        State::Changed => "changed",
        State::Alone => "in one run only",
    }
}

/// The report of `rodcal compare-runs`.
pub fn report(runs: &Runs) -> Report {
    let subcommand = runs.runs.first().map_or("", |run| &run.subcommand);
    let headline: Vec<String> =
        runs.compared().map(|(other, difference)| headline(runs, other, difference)).collect();
    let mut sections = vec![commands(runs)];
    for (other, difference) in runs.compared() {
        sections.extend(of_pair(&runs.runs[0], other, difference, runs.runs.len() == 2));
    }
    Report {
        title: format!("Runs of rodcal {subcommand}"),
        headline: headline.join(" "),
        cards: runs.compared().flat_map(|(other, difference)| cards(runs, other, difference)).collect(),
        warnings: warnings(runs),
        sections,
        provenance: vec![("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into())],
        ..Report::default()
    }
}

/// "b against a: the readings changed; 2 of 4 tested parameters differ significantly; …".
fn headline(runs: &Runs, other: &Run, difference: &Difference) -> String {
    let changed = difference.inputs.iter().filter(|input| input.state != State::Same).count();
    let inputs = match (changed, difference.inputs.len()) {
        (_, 0) => "no input files are recorded".to_owned(),
        (0, 1) => "the input is the same".into(),
        (0, _) => "all inputs are the same".into(),
        (changed, all) => format!("{changed} of {all} inputs differ"),
    };
    let changed = |(name, [a, b]): &(String, [String; 2])| format!("{name} {a} → {b}");
    let mut facts = vec![inputs];
    facts.extend(difference.options.iter().map(changed));
    facts.push(parameters_said(difference));
    facts.extend(main_error(difference).map(|change| {
        let [a, b] = change.values.each_ref().map(shown);
        format!("{} {a} → {b} {}", change.name, change.unit).trim_end().to_owned()
    }));
    facts.extend(findings_said(difference));
    format!("{} against {}: {}.", other.label, runs.runs[0].label, facts.join("; "))
}

fn parameters_said(difference: &Difference) -> String {
    let differ = difference.parameters.iter().filter(|change| change.difference.is_some_and(|d| d != 0.0));
    let alone = difference.parameters.iter().filter(|change| change.difference.is_none()).count();
    let said = match (differ.count(), difference.tested()) {
        (0, _) if difference.parameters.is_empty() => "no parameters to compare".to_owned(),
        (0, _) if alone == 0 => "no parameter differs".into(),
        (differ, 0) => {
            format!("{differ} of {} parameters differ, significance not tested", difference.parameters.len())
        }
        (_, tested) => {
            format!("{} of {tested} tested parameters differ significantly", difference.significant())
        }
    };
    if alone == 0 { said } else { format!("{said}, {alone} stand in one run only") }
}

fn findings_said(difference: &Difference) -> Option<String> {
    let only = |which: usize| {
        let of_one = difference.findings.iter().filter(|(_, has)| has[which] && !has[1 - which]);
        of_one.map(|(name, _)| name.as_str()).collect::<Vec<_>>().join("; ")
    };
    let (gone, new) = (only(0), only(1));
    match (gone.is_empty(), new.is_empty()) {
        (true, true) if difference.findings.is_empty() => None,
        (true, true) => Some("the findings are the same".into()),
        (false, true) => Some(format!("no longer found: {gone}")),
        (true, false) => Some(format!("newly found: {new}")),
        (false, false) => Some(format!("no longer found: {gone}; newly found: {new}")),
    }
}

/// The error that counts: at poses or readings that the fit has not seen, where there are some.
fn main_error(difference: &Difference) -> Option<&Change> {
    let both = || difference.errors.iter().filter(|change| change.difference.is_some());
    let unseen =
        |start: &str| both().find(|change| change.name.starts_with(start) && change.name.ends_with("mean"));
    unseen("error at validation poses")
        .or_else(|| unseen("error at held-out poses"))
        .or_else(|| both().find(|change| change.name == "held-out rms with findings"))
        .or_else(|| both().next())
}

fn cards(runs: &Runs, other: &Run, difference: &Difference) -> Vec<Card> {
    let against = format!("{} against {}", other.label, runs.runs[0].label);
    let count = |state: State| difference.inputs.iter().filter(|input| input.state == state).count();
    let (changed, alone, all) = (count(State::Changed), count(State::Alone), difference.inputs.len());
    let inputs =
        if changed + alone == 0 { "the same".into() } else { format!("{} of {all} differ", changed + alone) };
    let mut cards = vec![Card::new("Inputs", inputs, against.clone())];
    let significant = difference.significant();
    let parameters = match difference.tested() {
        0 if difference.parameters.iter().any(|change| change.difference.is_some_and(|d| d != 0.0)) => {
            let differ =
                difference.parameters.iter().filter(|change| change.difference.is_some_and(|d| d != 0.0));
            let value = format!("{} of {} differ", differ.count(), difference.parameters.len());
            Card::new("Parameters", value, format!("significance not tested; {against}"))
        }
        0 => Card::new("Parameters", parameters_said(difference), against.clone()),
        tested => {
            let tone = if significant == 0 { Tone::Neutral } else { Tone::Attention };
            let value = format!("{significant} of {tested} differ significantly");
            Card::new("Parameters", value, against.clone()).toned(tone)
        }
    };
    cards.push(parameters);
    if let Some(change) = main_error(difference) {
        let [a, b] = change.values.each_ref().map(shown);
        cards.push(Card::new(capital(&change.name), format!("{a} → {b} {}", change.unit), against.clone()));
    }
    cards.extend(findings_said(difference).map(|said| Card::new("Findings", said, against)));
    cards
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn warnings(runs: &Runs) -> Vec<String> {
    let first = &runs.runs[0];
    let mut warnings = Vec::new();
    for (other, difference) in runs.compared() {
        let differs = difference.parameters.iter().any(|change| change.difference.is_some_and(|d| d != 0.0));
        if differs && !difference.shared_recordings.is_empty() {
            warnings.push(format!(
                "{} and {} were made of the same recording ({}). Their random errors are partly common: \
                 difference over standard error is usually too small, and no significance is stated",
                first.label,
                other.label,
                difference.shared_recordings.join(", ")
            ));
        }
        if other.program != first.program {
            let (a, b) = (&first.program, &other.program);
            warnings.push(format!("{} was written by {a}, {} by {b}", first.label, other.label));
        }
    }
    warnings
}

fn commands(runs: &Runs) -> Section {
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

fn of_pair(first: &Run, other: &Run, difference: &Difference, is_alone: bool) -> Vec<Section> {
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
        "± is one standard error. Ratio: difference over √(s₁² + s₂²). Significant: by Student's t with at most {} % \
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

/// Most parameters that a picture shows, the most changed ones.
const MOST_SHOWN: usize = 16;

/// How far each parameter moved, in its own standard errors; nothing where none has any.
fn difference_picture(parameters: &[Change]) -> Option<Figure> {
    let mut moved: Vec<(&str, f64)> =
        parameters.iter().filter_map(|change| Some((change.name.as_str(), change.ratio()?))).collect();
    let all = moved.len();
    moved.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    moved.truncate(MOST_SHOWN);
    if moved.is_empty() {
        return None;
    }
    let row = |k: usize| -(k as f64);
    let mut chart = Chart::new("", "difference over its standard error", "");
    chart.y.names = moved.iter().enumerate().map(|(k, (name, _))| (row(k), (*name).to_owned())).collect();
    chart.height_px = Some(22.0 * moved.len() as f64 + 10.0);
    let bar = |(k, (_, ratio)): (usize, &(&str, f64))| Bar {
        from: row(k) - 0.33,
        to: row(k) + 0.33,
        value: *ratio,
        text: typeset(&two_digits(*ratio)),
        ..Bar::default()
    };
    let chart = chart.with(Mark::Bars {
        label: String::new(),
        bars: moved.iter().enumerate().map(bar).collect(),
        direction: Direction::Right,
        style: Style::nth(0).colour(Colour::Blue),
    });
    let rest =
        if all > moved.len() { format!(" The {} largest of {all}.", moved.len()) } else { String::new() };
    let caption = format!(
        "How far each parameter moved, in standard errors of the difference as of two recordings that have nothing in \
         common.{rest}"
    );
    Some(Figure::from(chart).named("parameter-differences").captioned(caption))
}

/// "+12", "−0.064": two digits and a sign.
fn two_digits(ratio: f64) -> String {
    let text = significant(ratio, 2);
    if ratio > 0.0 { format!("+{text}") } else { text }
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

/// "46.31 ± 0.12": the standard error to two digits, the value to the same decimals.
fn shown(quantity: &Option<Quantity>) -> String {
    let Some(quantity) = quantity else { return "–".into() };
    match quantity.std_error.filter(|error| *error > 0.0 && error.is_finite()) {
        Some(error) => {
            let error_text = significant(error, 2);
            let decimals = error_text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            match error_text.contains('e') {
                true => format!("{} ± {error_text}", significant(quantity.value, 5)),
                false => format!("{:.decimals$} ± {error_text}", quantity.value),
            }
        }
        None => significant(quantity.value, 4),
    }
}
