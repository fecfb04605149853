//! Runs side by side, for programs.

use serde_json::{Value, json};

use super::{Change, LEVEL, Quantity, Run, Runs, State};

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

pub(super) fn word(state: State) -> &'static str {
    match state {
        State::Same => "same",
        State::Changed => "changed",
        State::Alone => "in one run only",
    }
}
