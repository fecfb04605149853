//! The score of a trial: what was said, beside what was concealed and what could have been known.
//!
//! An effect counts as identifiable where the oracle's expected log Bayes factor is 5 or more against nothing and against
//! the best other effect. Rates have Wilson's 95 % intervals; nothing depends on the order of the answers.

mod counterfactual;
mod data;
mod judged;
mod next;
mod place;
mod rate;
mod tables;
mod targets;

use std::collections::BTreeMap;
use std::path::Path;

use rodcal_base::error::{Error, Place, Result};

pub use self::counterfactual::{Counterfactual, Foretold, Worst};
pub use self::data::{Clean, Coverage, Pairs, Part, Score, Singles, Unknown};
use self::judged::Judged;
pub use self::next::{Due, Files, NextMeasurement, Open, Outcome, Said};
pub use self::rate::Rate;
pub use self::tables::{Bin, Confusion, Failure, PowerBin};
pub use self::targets::{Missed, Target};
use super::answers::{self, Answer};
use super::envelope::Manifest;
use super::truth::{Detectability, Kind, Truth};

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
        score(&self.truths, &self.given, outcomes)
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
fn score(truths: &[Truth], given: &[Answer], outcomes: &[(String, Outcome)]) -> Score {
    let cases = judged(truths, given);
    let outcomes: BTreeMap<&str, &Outcome> =
        outcomes.iter().map(|(case, outcome)| (case.as_str(), outcome)).collect();
    let half = |name: &str| {
        let is_of_half = |case: &&Judged<'_>| case.truth.case.starts_with(name);
        let cases: Vec<Judged<'_>> = cases.iter().filter(is_of_half).cloned().collect();
        (!cases.is_empty()).then(|| part(&cases, &outcomes))
    };
    Score {
        whole: part(&cases, &outcomes),
        unanswered: truths.len() - cases.len(),
        rig: half("rig"),
        calibration: half("calibration"),
    }
}

/// The score of cases in their order.
fn part(cases: &[Judged<'_>], outcomes: &BTreeMap<&str, &Outcome>) -> Part {
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
    let both_found = Rate::of(pairs.iter(), |case| found(case) == 2);
    let one_found = Rate::of(pairs.iter(), |case| found(case) >= 1);

    let unknown: Vec<&Judged<'_>> = of_kind(Kind::Unknown).filter(is_identifiable).collect();
    let called_unknown = Rate::of(unknown.iter(), |case| case.is_unexplained && case.findings.is_empty());
    let wrongly_named = Rate::of(unknown.iter(), |case| !case.findings.is_empty());

    let speaking = || cases.iter().filter(|case| !case.findings.is_empty());
    let right_when_named = Rate::of(speaking(), |case| case.is_concealed(case.said()));
    let class_right_when_named =
        Rate::of(speaking(), |case| case.class().into_iter().any(|name| case.is_concealed(name)));

    let mut coverage = Coverage::default();
    for case in cases.iter().filter(|case| case.truth.kind != Kind::Unknown) {
        for concealed in &case.truth.effects {
            for (name, is_in) in case.covered(concealed) {
                coverage.all.add(is_in);
                coverage.by_parameter.entry(format!("{} {name}", concealed.effect)).or_default().add(is_in);
            }
        }
    }
    let gains =
        identifiable.iter().chain(&pairs).filter_map(|case| Some((case.gain?, case.truth.oracle_gain?)));
    let (gained, possible) = gains.fold((0.0, 0.0), |sum, (gain, oracle)| (sum.0 + gain, sum.1 + oracle));
    let counterfactual = counterfactual::foretold(cases);
    let mut part = Part {
        cases: cases.len(),
        failed: cases.iter().filter(|case| case.failed).count(),
        clean: Clean { false_names, false_unexplained },
        single: Singles {
            n: of_kind(Kind::Single).count(),
            name_ok,
            location_ok,
            missed,
            in_class,
            class_size,
        },
        pairs: Pairs { n: of_kind(Kind::Pair).count(), both_found, one_found },
        unknown: Unknown { n: of_kind(Kind::Unknown).count(), called_unknown, wrongly_named },
        right_when_named,
        class_right_when_named,
        coverage,
        gain_over_oracle: (possible > 0.0).then(|| gained / possible),
        counterfactual_over_oracle: counterfactual.median,
        counterfactual,
        next_measurement_ok: next::next_measurement(cases, outcomes),
        bins: tables::bins(cases),
        confusion: tables::confusion(cases),
        outside: tables::outside(cases),
        power: tables::power(cases),
        failures: tables::failures(cases),
        missed_targets: Vec::new(),
    };
    part.missed_targets = targets::missed(&part);
    part
}

#[cfg(test)]
mod tests;
