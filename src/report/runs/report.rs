//! What is said of runs side by side: first lines, cards, warnings.

use super::compared::Runs;
use super::tables::{commands, of_pair, shown};
use super::{Change, Difference, Run, State};
use crate::report::{Card, Report, Tone};
use crate::units::capital;

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
    let both = difference.errors.iter().filter(|change| change.difference.is_some());
    both.min_by_key(|change| change.precedence)
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
