//! The score of a trial: what was said, beside what was concealed and what could have been known.
//!
//! An effect counts as identifiable where the oracle's expected log Bayes factor is 5 or more against nothing and against
//! the best other effect. Rates have Wilson's 95 % intervals; nothing depends on the order of the answers.

mod counterfactual;
mod judged;
mod next;
mod place;
mod rate;
mod tables;
mod targets;

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value, json};

use self::judged::Judged;
pub use self::next::{Due, Files, Outcome};
use self::rate::Rate;
use super::answers::{self, Answer};
use super::envelope::Manifest;
use super::truth::{Detectability, Kind, Truth};
use rodcal_base::error::{Error, Place, Result};

/// A trial's score.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// For `--json`.
    pub json: Value,
    /// For people.
    pub text: String,
}

/// A key and answers that belong to one trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Sealed {
    truths: Vec<Truth>,
    given: Vec<Answer>,
}

impl Sealed {
    /// What was proposed for the cases whose answer is ambiguous and holds the truth, by case.
    pub fn due(&self) -> Vec<Due> {
        judged(&self.truths, &self.given).iter().filter_map(Due::of).collect()
    }

    /// The score; `outcomes` says what became of the proposals, by case.
    pub fn score(&self, outcomes: &[(String, Outcome)]) -> Score {
        of(&self.truths, &self.given, outcomes)
    }
}

/// Reads the key and the answers to the trial in `directory`.
///
/// # Errors
/// [`Error::Input`] for a key, a recording or an answer that does not belong to this trial; [`Error::File`],
/// [`Error::Syntax`].
pub fn open(directory: &Path, key: &Path, answers: &Path) -> Result<Sealed> {
    let manifest = Manifest::read(directory)?;
    let truths = manifest.read_key(key)?;
    let given = answers::read(answers)?;
    for answer in &given {
        manifest.check_case(directory, &answer.case)?;
        if answer.sha256 != manifest.hashes_of(&answer.case) {
            return Err(Error::Input {
                at: Place::whole_file(&answers.display().to_string()),
                found: format!("the answer to {} is to other files", answer.case),
                expected: "the SHA-256 of each file as the manifest has it".into(),
                hint: Some("answer this case again".into()),
            });
        }
    }
    Ok(Sealed { truths, given })
}

/// Answers beside their truths, by case.
fn judged<'a>(truths: &'a [Truth], given: &[Answer]) -> Vec<Judged<'a>> {
    let answers: BTreeMap<&str, &Answer> = given.iter().map(|a| (a.case.as_str(), a)).collect();
    let mut cases: Vec<Judged<'_>> = truths
        .iter()
        .filter_map(|truth| Some(Judged::new(truth, answers.get(truth.case.as_str())?)))
        .collect();
    cases.sort_by(|a, b| a.truth.case.cmp(&b.truth.case));
    cases
}

/// Scores answers; truths without one are left out and counted.
fn of(truths: &[Truth], given: &[Answer], outcomes: &[(String, Outcome)]) -> Score {
    let cases = judged(truths, given);
    let outcomes: BTreeMap<&str, &Outcome> = outcomes.iter().map(|(case, of)| (case.as_str(), of)).collect();
    let of_cases = |cases: &[Judged<'_>]| of_cases(cases, &outcomes);
    let unanswered = truths.len() - cases.len();
    let halves: Vec<(&str, Vec<Judged<'_>>)> = ["rig", "calibration"]
        .into_iter()
        .map(|half| (half, cases.iter().filter(|case| case.truth.case.starts_with(half)).cloned().collect()))
        .filter(|(_, of_half): &(&str, Vec<Judged<'_>>)| !of_half.is_empty())
        .collect();
    let mut whole = of_cases(&cases);
    whole.json["unanswered"] = unanswered.into();
    for (half, of_half) in &halves {
        let part = if halves.len() > 1 { of_cases(of_half) } else { of_cases(&cases) };
        if halves.len() > 1 {
            whole.text += &format!("\n{half}\n{}", part.text);
        }
        whole.json[*half] = part.json;
    }
    let mut first = String::new();
    for (half, _) in &halves {
        let missed = whole.json[*half]["missed_targets"].as_array().into_iter().flatten();
        missed.filter_map(Value::as_str).for_each(|words| first += &format!("MISSED {half}: {words}\n"));
    }
    whole.text = if first.is_empty() { whole.text } else { first + "\n" + &whole.text };
    whole
}

/// The score of cases in their order.
fn of_cases(cases: &[Judged<'_>], outcomes: &BTreeMap<&str, &Outcome>) -> Score {
    let of_kind = |kind: Kind| cases.iter().filter(move |case| case.truth.kind == kind);
    let first = |case: &&Judged<'_>| case.truth.effects.first().map(|e| e.detectability.clone());
    let is_identifiable =
        |case: &&Judged<'_>| case.truth.effects.iter().all(|e| e.detectability.is_identifiable());
    let is_detectable =
        |case: &&Judged<'_>| first(case).is_some_and(|d| d.against_none >= Detectability::IDENTIFIABLE);

    let false_names = Rate::of(of_kind(Kind::Clean), |case| !case.findings.is_empty());
    let false_unexplained = Rate::of(of_kind(Kind::Clean), |case| case.is_unexplained);

    let identifiable: Vec<&Judged<'_>> = of_kind(Kind::Single).filter(is_identifiable).collect();
    let of_identifiable = |is_so: &dyn Fn(&Judged<'_>) -> bool| Rate::of(identifiable.iter(), |c| is_so(c));
    let (name_ok, location_ok) = (of_identifiable(&|c| c.name_ok()), of_identifiable(&|c| c.location_ok()));
    let missed = of_identifiable(&|case| case.findings.is_empty());
    let named: Vec<&Judged<'_>> =
        of_kind(Kind::Single).filter(is_detectable).filter(|case| !case.findings.is_empty()).collect();
    let in_class = Rate::of(named.iter(), |case| case.in_class());
    let class_size =
        named.iter().map(|case| case.class().len() as f64).sum::<f64>() / named.len().max(1) as f64;

    let pairs: Vec<&Judged<'_>> = of_kind(Kind::Pair).filter(is_identifiable).collect();
    let found = |case: &Judged<'_>| case.truth.effects.iter().filter(|e| case.found(e).is_some()).count();
    let both = Rate::of(pairs.iter(), |case| found(case) == 2);
    let one = Rate::of(pairs.iter(), |case| found(case) >= 1);

    let unknown: Vec<&Judged<'_>> = of_kind(Kind::Unknown).filter(is_identifiable).collect();
    let called = Rate::of(unknown.iter(), |case| case.is_unexplained && case.findings.is_empty());
    let wrongly = Rate::of(unknown.iter(), |case| !case.findings.is_empty());

    let speaking = || cases.iter().filter(|case| !case.findings.is_empty());
    let right = Rate::of(speaking(), |case| case.is_concealed(case.said()));
    let right_class =
        Rate::of(speaking(), |case| case.class().into_iter().any(|name| case.is_concealed(name)));

    let mut coverage = Rate::default();
    let mut by_parameter: BTreeMap<String, Rate> = BTreeMap::new();
    for case in cases.iter().filter(|case| case.truth.kind != Kind::Unknown) {
        for concealed in &case.truth.effects {
            for (name, is_in) in case.covered(concealed) {
                coverage.add(is_in);
                by_parameter.entry(format!("{} {name}", concealed.effect)).or_default().add(is_in);
            }
        }
    }
    let gains =
        identifiable.iter().chain(&pairs).filter_map(|case| Some((case.gain?, case.truth.oracle_gain?)));
    let (gained, possible) = gains.fold((0.0, 0.0), |sum, (gain, oracle)| (sum.0 + gain, sum.1 + oracle));
    let gain_over_oracle = (possible > 0.0).then(|| gained / possible);
    let by_parameter: BTreeMap<String, Value> =
        by_parameter.iter().map(|(k, rate)| (k.clone(), rate.json())).collect();

    let (counterfactual_over_oracle, counterfactual) = counterfactual::of(cases);
    let next = next::of(cases, outcomes);

    let mut json = json!({
        "cases": cases.len(),
        "failed": cases.iter().filter(|case| case.failed).count(),
        "clean": {
            "n": false_names.of, "false_names": false_names.count, "false_unexplained": false_unexplained.count,
            "false_names_rate": false_names.json(), "false_unexplained_rate": false_unexplained.json(),
        },
        "single": {
            "n": of_kind(Kind::Single).count(), "identifiable": identifiable.len(),
            "name_ok": name_ok.count, "location_ok": location_ok.count, "in_class": in_class.count,
            "missed": missed.count, "class_size": class_size,
            "name_ok_rate": name_ok.json(), "location_ok_rate": location_ok.json(), "in_class_rate": in_class.json(),
        },
        "pairs": {
            "n": of_kind(Kind::Pair).count(), "identifiable": pairs.len(),
            "both_found": both.count, "one_found": one.count, "both_found_rate": both.json(),
        },
        "unknown": {
            "n": of_kind(Kind::Unknown).count(), "identifiable": unknown.len(),
            "called_unknown": called.count, "wrongly_named": wrongly.count,
            "called_unknown_rate": called.json(), "wrongly_named_rate": wrongly.json(),
        },
        "right_when_named": right.json(),
        "class_right_when_named": right_class.json(),
        "coverage": coverage.share(),
        "coverage_rate": coverage.json(),
        "coverage_by_parameter": by_parameter,
        "gain_over_oracle": gain_over_oracle,
        "counterfactual_over_oracle": counterfactual_over_oracle,
        "counterfactual": counterfactual,
        "next_measurement_ok": next,
        "bins": tables::bins(cases),
        "confusion": tables::confusion(cases),
        "outside": tables::outside(cases),
        "power": tables::power(cases),
        "failures": tables::failures(cases),
    });
    json["missed_targets"] = targets::missed(&json).into();
    let mut text = String::new();
    let mut say = |what: &str, words: String| text += &format!("{what:44} {words}\n");
    say("clean: false names", false_names.words());
    say("clean: called unexplained", false_unexplained.words());
    say("single, identifiable: name right", name_ok.words());
    say("single, identifiable: name and place right", location_ok.words());
    say("single, identifiable: nothing named", missed.words());
    say(
        "single, detectable, named: truth in class",
        format!("{}; class of {class_size:.1}", in_class.words()),
    );
    say("pairs, identifiable: both found", both.words());
    say("pairs, identifiable: one found", one.words());
    say("unknown, identifiable: called unexplained", called.words());
    say("unknown, identifiable: wrongly named", wrongly.words());
    say("right when it names", right.words());
    say("right, or in its class, when it names", right_class.words());
    say("95 % intervals that hold the truth", coverage.words());
    say("held-out gain over the oracle's", gain_over_oracle.map_or("no case".into(), |g| format!("{g:.3}")));
    say("error of other readings over the oracle's", counterfactual::words(&json["counterfactual"]));
    say("ambiguous: settled by what is proposed", next::words(&json["next_measurement_ok"]));
    text += &tables::confusion_text(cases);
    Score { json, text }
}

#[cfg(test)]
mod tests;
