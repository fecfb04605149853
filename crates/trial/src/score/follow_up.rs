//! Whether the measurement that an answer proposes settles what it could not distinguish: it is
//! made with the concealed effects, put below the recording, and diagnosed once more.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Value, json};

use super::diagnosis::Finding;
use super::place;
use super::rate::Rate;
use super::scored_case::ScoredCase;
use crate::effect_name::EffectName;
use crate::ground_truth::{Concealed, GroundTruth, Kind};
use crate::place::Place;
use crate::{Seed, Source, Suite, calibration, rig};
use rodcal_base::error::Result;
use rodcal_base::files;

/// A case whose answer is ambiguous and holds the truth.
#[derive(Debug, Clone, PartialEq)]
pub struct PendingFollowUp {
    /// `rig/case-0001`.
    pub case: String,
    seed: Option<Seed>,
    residuals: Vec<f64>,
    /// True for a case with effects that imitate each other.
    is_conflict: bool,
    /// What the answer proposes, for people and as numbers; `None` where it proposes nothing.
    description: Option<String>,
    proposed: Option<Value>,
}

/// What a proposal led to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// The answer proposed nothing.
    NotProposed,
    /// It could not be done, or not be diagnosed: the reason.
    NotDone(String),
    /// The diagnosis' JSON of the recording with the new readings.
    Diagnosed(Value),
}

impl PendingFollowUp {
    /// Of an answer that asks for it.
    pub(super) fn of(case: &ScoredCase<'_>) -> Option<PendingFollowUp> {
        let (finding, _) = ambiguous(case)?;
        Some(PendingFollowUp {
            case: case.truth.case.clone(),
            seed: case.truth.seed,
            residuals: case.truth.residuals.clone(),
            is_conflict: case.truth.conflict.is_some(),
            description: finding.next_measurement.clone(),
            proposed: finding.next_measurement_plan.clone().filter(|plan| !plan.is_null()),
        })
    }

    /// The case's files that change when what is proposed is measured and put below the recording,
    /// name and text; `Err` is what the proposal led to where there are none.
    ///
    /// # Errors
    /// [`rodcal_base::Error::File`] where a sealed file cannot be read.
    pub fn files(&self, directory: &Path) -> Result<std::result::Result<Files, Outcome>> {
        let not = |why: &str| Ok(Err(Outcome::NotDone(why.to_owned())));
        let proposed = match (&self.proposed, &self.description) {
            (Some(proposed), _) => proposed,
            (None, Some(_)) => return not("it needs no recording"),
            (None, None) => return Ok(Err(Outcome::NotProposed)),
        };
        let (folder, number) = self.case.split_once("/case-").unwrap_or_default();
        let (Some(seed), Ok(number)) = (self.seed, number.parse()) else { return not("the key has no seed") };
        let suite = match (folder, self.is_conflict) {
            (_, true) => Suite::Conflicts,
            ("calibration", _) => Suite::Calibration,
            _ => Suite::Rig,
        };
        let source = Source { seed, suite, residuals: self.residuals.clone() };
        let [before, after] = match follow_up(&source, number, proposed) {
            Ok(files) => files,
            Err(why) => return not(why),
        };
        // only what the sealed recording was made of may be done once more
        for (name, text) in &before {
            if files::read_text(&directory.join(&self.case).join(name))? != *text {
                return not("this version of the program draws another case");
            }
        }
        Ok(Ok(after))
    }
}

/// Name and text of each.
pub type Files = Vec<(String, String)>;

/// The files of a case as they were and with what is proposed.
fn follow_up(
    source: &Source,
    number: usize,
    proposed: &Value,
) -> std::result::Result<[Files; 2], &'static str> {
    const NONE: &str = "not a measurement";
    if source.suite != Suite::Rig {
        let proposed = calibration::Proposed::deserialize(proposed).map_err(|_| NONE)?;
        let measured = calibration::follow_up(source, number, &proposed)?;
        return Ok([measured.before, measured.after]);
    }
    let proposed = rig::Proposed::deserialize(proposed).map_err(|_| NONE)?;
    let measured = rig::follow_up(source.seed, number, &source.residuals, &proposed)?;
    Ok([measured.before, measured.after].map(|text| vec![("readings.csv".to_owned(), text)]))
}

/// The strongest finding, where it is ambiguous and its class holds the truth, with that truth.
fn ambiguous<'a>(case: &'a ScoredCase<'_>) -> Option<(&'a Finding, &'a Concealed)> {
    let is_of_library = matches!(case.truth.kind, Kind::Single | Kind::Pair);
    let finding = case.sought().next().filter(|_| is_of_library)?;
    let is_ambiguous = !finding.indistinguishable_from.is_empty() || finding.other_places().next().is_some();
    let class = case.class();
    let concealed = case.truth.effects.iter().find(|e| class.contains(&&e.effect))?;
    is_ambiguous.then_some((finding, concealed))
}

/// True where the truth is now a finding, at its place, that none of its former rivals can stand
/// for.
fn is_settled(truth: &GroundTruth, before: &Finding, concealed: &Concealed, after: &ScoredCase<'_>) -> bool {
    let named: Vec<&Finding> = match truth.kind {
        Kind::Single => after.sought().take(1).collect(),
        _ => after.sought().collect(),
    };
    let is_right = |place: &Place| place::is_same(truth, concealed, Some(place));
    let was_rival =
        |name: &EffectName| *name == before.effect || before.indistinguishable_from.contains(name);
    named.into_iter().any(|finding| {
        let others = finding.indistinguishable_from.iter();
        let is_apart = others.filter(|name| **name != concealed.effect).all(|name| !was_rival(name));
        // places matter where they were what was ambiguous
        let was_wrong = |place: &Place| before.other_places().any(|known| known == place) && !is_right(place);
        let is_there = before.effect != concealed.effect
            || (finding.place.as_ref().is_some_and(is_right) && !finding.other_places().any(was_wrong));
        finding.effect == concealed.effect && is_apart && is_there
    })
}

/// What the proposals led to.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NextMeasurement {
    /// Proposals that settled what was ambiguous.
    pub settled: Rate,
    /// Those where it was which effect,
    pub effects: Rate,
    /// and those where it was only which place.
    pub places: Rate,
    /// Ambiguous answers without a proposal.
    pub not_proposed: usize,
    /// Proposals that could not be done or not be diagnosed, by their reason.
    pub not_done: BTreeMap<String, usize>,
    /// Proposals that did not settle it.
    pub open: Vec<Open>,
}

/// A case that a proposal did not settle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Open {
    /// `rig/case-0001`.
    pub case: String,
    /// What was concealed, and where.
    pub truth: String,
    /// The ambiguous finding.
    pub before: FindingSummary,
    /// What it proposed.
    pub next_measurement: Option<String>,
    /// The findings after that measurement.
    pub after: Vec<FindingSummary>,
    /// A remainder was called unexplained.
    pub unexplained: bool,
}

/// Name and place of a finding, and what it may be as well.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(missing_docs, reason = "the names are those of the JSON of an answer")]
pub struct FindingSummary {
    pub effect: EffectName,
    pub location: String,
    pub indistinguishable_from: Vec<EffectName>,
    pub places: Vec<String>,
}

impl FindingSummary {
    fn of(finding: &Finding) -> FindingSummary {
        FindingSummary {
            effect: finding.effect.clone(),
            location: finding.location.clone(),
            indistinguishable_from: finding.indistinguishable_from.clone(),
            places: finding.other_places().map(Place::to_string).collect(),
        }
    }
}

/// Counts what the proposals led to.
pub fn next_measurement(cases: &[ScoredCase<'_>], outcomes: &BTreeMap<&str, &Outcome>) -> NextMeasurement {
    let mut next = NextMeasurement::default();
    for case in cases {
        let Some((finding, concealed)) = ambiguous(case) else { continue };
        match outcomes.get(case.truth.case.as_str()) {
            None => *next.not_done.entry("not asked".into()).or_default() += 1,
            Some(Outcome::NotProposed) => next.not_proposed += 1,
            Some(Outcome::NotDone(why)) => *next.not_done.entry(why.clone()).or_default() += 1,
            Some(Outcome::Diagnosed(answer)) => {
                let after = ScoredCase::of_diagnosis(case.truth, answer);
                let is_ok = is_settled(case.truth, finding, concealed, &after);
                next.settled.add(is_ok);
                let is_of_places = finding.indistinguishable_from.is_empty();
                let part = if is_of_places { &mut next.places } else { &mut next.effects };
                part.add(is_ok);
                if !is_ok {
                    next.open.push(Open {
                        case: case.truth.case.clone(),
                        truth: format!("{} at {}", concealed.effect, concealed.location),
                        before: FindingSummary::of(finding),
                        next_measurement: finding.next_measurement.clone(),
                        after: after.findings.iter().map(FindingSummary::of).collect(),
                        unexplained: after.is_unexplained,
                    });
                }
            }
        }
    }
    next
}

impl Serialize for NextMeasurement {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        json!({
            "n": self.settled.total, "ok": self.settled.count, "rate": self.settled,
            "effects": self.effects, "places": self.places,
            "not_proposed": self.not_proposed, "not_done": self.not_done, "open": self.open,
        })
        .serialize(serializer)
    }
}

/// `12 of 40, 30.0 % (18.1 to 45.4); 3 more without a proposal; 1 not done (a station that is not
/// on the rod)`.
impl fmt::Display for NextMeasurement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.settled)?;
        if self.not_proposed > 0 {
            write!(f, "; {} more without a proposal", self.not_proposed)?;
        }
        self.not_done.iter().try_for_each(|(why, count)| write!(f, "; {count} not done ({why})"))
    }
}
