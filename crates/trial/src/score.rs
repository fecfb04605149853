//! The score of a trial: what was said, beside what was concealed and what could have been known.
//!
//! An effect counts as identifiable where the oracle's expected log Bayes factor is 5 or more
//! against nothing and against the best other effect. Rates have Wilson's 95 % intervals; nothing
//! depends on the order of the answers.

mod counterfactual;
mod data;
mod diagnosis;
mod follow_up;
mod place;
mod predictions;
mod rate;
mod scored_case;
mod tables;
mod target;
mod targets;
mod verdict;

use std::collections::BTreeMap;
use std::path::Path;

use rodcal_base::delimited::quoted;
use rodcal_base::error::{Error, Place, Result};

pub use self::counterfactual::Counterfactual;
pub use self::data::{Below, Clean, Coverage, Mistakes, Pairs, Part, Score, Singles, Suspects, Unknown};
use self::diagnosis::Finding;
pub use self::follow_up::{Files, FindingSummary, NextMeasurement, Open, Outcome, PendingFollowUp};
pub use self::predictions::{Predictions, Worst};
pub use self::rate::Rate;
use self::scored_case::ScoredCase;
pub use self::tables::{Bin, Conflicts, Confusion, Failure, PowerBin};
pub use self::target::{Measured, Missed, Reached, Target};
pub use self::verdict::Verdict;
use super::answers::{self, Answer};
use super::archive::Manifest;
use super::effect_name::EffectName;
use super::ground_truth::{GroundTruth, Kind};
use super::seed::Seed;

/// A key and answers that belong to one trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Sealed {
    truths: Vec<GroundTruth>,
    given: Vec<Answer>,
    /// False of a key that says nothing of the manifest.
    names_manifest: bool,
}

impl Sealed {
    /// What all cases were drawn from; `None` of a key of a former version.
    pub fn seed(&self) -> Option<Seed> {
        self.truths.iter().find_map(|truth| truth.seed)
    }

    /// What was proposed for the cases whose answer is ambiguous and holds the truth, by case.
    pub fn pending(&self) -> Vec<PendingFollowUp> {
        answered(&self.truths, &self.given).iter().filter_map(PendingFollowUp::of).collect()
    }

    /// The score; `outcomes` are what the proposals led to, by case.
    pub fn score(&self, outcomes: &[(String, Outcome)]) -> Score {
        let mut score = score(&self.truths, &self.given, outcomes);
        if !self.names_manifest {
            score.remarks.push(
                "The key is of a former version and does not say which manifest it belongs to: \
                 changed recordings would not be noticed."
                    .into(),
            );
        }
        score
    }
}

/// Reads the key and the answers to the trial in `directory`.
///
/// # Errors
/// [`Error::Input`] for a key, a recording or an answer that does not belong to this trial;
/// [`Error::File`], [`Error::Syntax`].
pub fn open(directory: &Path, key: &Path, answers: &Path) -> Result<Sealed> {
    let manifest = Manifest::read(directory)?;
    let (truths, names_manifest) = manifest.read_key(directory, key)?;
    manifest.check_directory(directory)?;
    let cases = manifest.case_names();
    cases.iter().try_for_each(|case| manifest.check_case(directory, case))?;
    let given = answers::read(answers)?;
    let wrong = |found: String, expected: &str, hint: &str| Error::Input {
        at: Place::whole_file(&answers.display().to_string()),
        found,
        expected: expected.into(),
        hint: Some(hint.into()),
    };
    for answer in &given {
        if cases.binary_search(&answer.case).is_err() {
            let found = format!("an answer to {}, which is no case of this trial", quoted(&answer.case));
            return Err(wrong(
                found,
                "answers to the cases of the manifest",
                "are these answers to another trial?",
            ));
        }
        if answer.sha256 != manifest.hashes_of(&answer.case) {
            let found = format!("the answer to {} is to other files", answer.case);
            let expected = "the SHA-256 of each file as the manifest has it";
            return Err(wrong(found, expected, "answer this case again"));
        }
    }
    Ok(Sealed { truths, given, names_manifest })
}

/// Answers beside their truths, by case.
fn answered<'a>(truths: &'a [GroundTruth], given: &[Answer]) -> Vec<ScoredCase<'a>> {
    let answers: BTreeMap<&str, &Answer> = given.iter().map(|a| (a.case.as_str(), a)).collect();
    let mut cases: Vec<ScoredCase<'_>> = truths
        .iter()
        .filter_map(|truth| Some(ScoredCase::new(truth, answers.get(truth.case.as_str())?)))
        .collect();
    cases.sort_by(|a, b| a.truth.case.cmp(&b.truth.case));
    cases
}

/// Scores answers; truths without one are left out and counted.
fn score(truths: &[GroundTruth], given: &[Answer], outcomes: &[(String, Outcome)]) -> Score {
    let cases = answered(truths, given);
    let outcomes: BTreeMap<&str, &Outcome> =
        outcomes.iter().map(|(case, outcome)| (case.as_str(), outcome)).collect();
    let suite = |name: &str| {
        let is_of_suite = |case: &&ScoredCase<'_>| case.truth.case.starts_with(name);
        let cases: Vec<ScoredCase<'_>> = cases.iter().filter(is_of_suite).cloned().collect();
        (!cases.is_empty()).then(|| part(&cases, &outcomes))
    };
    let unanswered = truths.len() - cases.len();
    let remarks = match unanswered {
        0 => Vec::new(),
        _ => vec![format!(
            "{unanswered} of {} cases have no answer: the score is of the other {}.",
            truths.len(),
            cases.len()
        )],
    };
    Score {
        remarks,
        whole: part(&cases, &outcomes),
        unanswered,
        rig: suite("rig"),
        calibration: suite("calibration"),
    }
}

/// The score of cases in their order.
fn part(cases: &[ScoredCase<'_>], outcomes: &BTreeMap<&str, &Outcome>) -> Part {
    let of_kind = |kind: Kind| cases.iter().filter(move |case| case.truth.kind == kind);
    let first = |case: &&ScoredCase<'_>| case.truth.effects.first().map(|e| e.detectability.clone());
    let is_identifiable =
        |case: &&ScoredCase<'_>| case.truth.effects.iter().all(|e| e.detectability.is_identifiable());
    let is_detectable = |case: &&ScoredCase<'_>| first(case).is_some_and(|d| d.is_detectable());
    let is_named = |case: &ScoredCase<'_>| case.sought().next().is_some();

    let of_clean = |times: fn(f64) -> bool| {
        let clean = of_kind(Kind::Clean).filter(move |case| times(case.truth.numbers_off));
        Rate::of(clean, |case| !is_named(case) && !case.is_unexplained && !case.failed)
    };
    let clean = Clean {
        false_names: Rate::of(of_kind(Kind::Clean), is_named),
        false_unexplained: Rate::of(of_kind(Kind::Clean), |case| case.is_unexplained),
        silent: of_clean(|times| times <= 1.0),
        silent_twice: of_clean(|times| times > 1.0),
    };

    let identifiable: Vec<&ScoredCase<'_>> = of_kind(Kind::Single).filter(is_identifiable).collect();
    let of_identifiable =
        |is_so: &dyn Fn(&ScoredCase<'_>) -> bool| Rate::of(identifiable.iter(), |c| is_so(c));
    let (name_ok, location_ok) = (of_identifiable(&|c| c.name_ok()), of_identifiable(&|c| c.location_ok()));
    let missed = of_identifiable(&|case| !is_named(case));
    let named: Vec<&ScoredCase<'_>> =
        of_kind(Kind::Single).filter(is_detectable).filter(|case| is_named(case)).collect();
    let in_class = Rate::of(named.iter(), |case| case.in_class());
    let class_size =
        named.iter().map(|case| case.class().len() as f64).sum::<f64>() / named.len().max(1) as f64;

    let faint: Vec<&ScoredCase<'_>> = of_kind(Kind::Single).filter(|case| !is_detectable(case)).collect();
    let below = Below {
        silent: Rate::of(&faint, |case| !is_named(case) && !case.is_unexplained),
        silent_or_right: Rate::of(&faint, |case| {
            case.in_class() || (!is_named(case) && !case.is_unexplained)
        }),
        wrongly_named: Rate::of(&faint, |case| is_named(case) && !case.in_class()),
    };

    let pairs: Vec<&ScoredCase<'_>> = of_kind(Kind::Pair).filter(is_identifiable).collect();
    let found = |case: &ScoredCase<'_>| case.truth.effects.iter().filter(|e| case.found(e).is_some()).count();
    let both_found = Rate::of(pairs.iter(), |case| found(case) == case.truth.effects.len());
    let one_found = Rate::of(pairs.iter(), |case| found(case) >= 1);

    let unknown: Vec<&ScoredCase<'_>> = of_kind(Kind::Unknown).filter(is_identifiable).collect();
    let called_unknown = Rate::of(unknown.iter(), |case| case.is_unexplained && !is_named(case));
    let wrongly_named = Rate::of(unknown.iter(), |case| is_named(case));

    let is_mistaken = |case: &&ScoredCase<'_>| case.truth.kind == Kind::Mistake;
    // mistakes have a score of their own
    let speaking = || cases.iter().filter(|case| !is_mistaken(case) && !case.findings.is_empty());
    let right_when_named =
        Rate::of(speaking(), |case| case.findings.first().is_some_and(|f| case.is_concealed(&f.effect)));
    let right_or_inseparable = Rate::of(speaking(), |case| case.is_right());
    let class_right_when_named =
        Rate::of(speaking(), |case| case.class().into_iter().any(|name| case.is_concealed(name)));

    let mut coverage = Coverage::default();
    let of_library = |case: &&ScoredCase<'_>| matches!(case.truth.kind, Kind::Single | Kind::Pair);
    for case in cases.iter().filter(of_library) {
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
    let counterfactual = predictions::predictions(cases);
    let mut part = Part {
        cases: cases.len(),
        failed: cases.iter().filter(|case| case.failed).count(),
        clean,
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
        below,
        mistakes: mistakes(cases),
        suspects: Suspects {
            remarked: Rate::of(of_kind(Kind::Suspect), ScoredCase::all_remarked),
            named: Rate::of(of_kind(Kind::Suspect), is_named),
        },
        right_when_named,
        right_or_inseparable,
        class_right_when_named,
        coverage,
        gain_over_oracle: (possible > 0.0).then(|| gained / possible),
        counterfactual_over_oracle: counterfactual.median,
        counterfactual,
        next_measurement_ok: follow_up::next_measurement(cases, outcomes),
        bins: tables::bins(cases),
        confusion: tables::confusion(cases),
        conflicts: tables::conflicts(cases),
        outside: tables::outside(cases),
        power: tables::power(cases),
        failures: tables::failures(cases),
        targets: Vec::new(),
        missed_targets: Vec::new(),
    };
    part.targets = targets::reached(&part);
    part.missed_targets = part.targets.iter().filter_map(Reached::missed).collect();
    part
}

/// Mistakes that were made, and that were not.
fn mistakes(cases: &[ScoredCase<'_>]) -> Mistakes {
    let (made, others): (Vec<_>, Vec<_>) = cases.iter().partition(|case| case.truth.kind == Kind::Mistake);
    let is_named = |case: &ScoredCase<'_>| case.mistake_named().is_some();
    let mut by_mistake: BTreeMap<EffectName, Rate> = BTreeMap::new();
    for case in &made {
        let Some(concealed) = case.truth.effects.first() else { continue };
        by_mistake.entry(concealed.effect.clone()).or_default().add(is_named(case));
    }
    Mistakes {
        named: Rate::of(&made, |case| is_named(case)),
        placed: Rate::of(&made, |case| case.mistake_placed()),
        as_other: Rate::of(&made, |case| !is_named(case) && !case.is_silent()),
        silent: Rate::of(&made, |case| case.is_silent()),
        invented: Rate::of(&others, |case| case.findings.iter().any(Finding::is_mistake)),
        by_mistake,
    }
}

#[cfg(test)]
mod tests;
