//! One answer beside its truth.

use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::counterfactual::Counterfactual;
use super::place;
use crate::answers::Answer;
use crate::place::Place;
use crate::truth::{Concealed, Truth};

/// What an answer found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Finding {
    /// Name of the effect.
    pub effect: String,
    /// `physics`, `event` or `mistake`.
    #[serde(default)]
    pub kind: String,
    /// Where, for people, and as data.
    #[serde(default)]
    pub location: String,
    #[serde(default)]
    #[allow(missing_docs)]
    pub place: Option<Place>,
    /// Its numbers.
    #[serde(default)]
    pub parameters: Vec<Interval>,
    /// Effects that it might be as well.
    #[serde(default)]
    pub indistinguishable_from: Vec<String>,
    /// What might stand in its place, and where.
    #[serde(default)]
    pub rivals: Vec<Rival>,
    /// What would decide, in words and as numbers.
    #[serde(default)]
    pub next_measurement: Option<String>,
    #[serde(default)]
    #[allow(missing_docs)]
    pub next_measurement_plan: Option<Value>,
}

/// What might stand in the place of a finding.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Rival {
    /// Name of the effect.
    pub effect: String,
    /// Where.
    #[serde(default)]
    pub place: Option<Place>,
}

impl Finding {
    /// Other places of the same effect.
    pub fn other_places(&self) -> impl Iterator<Item = &Place> {
        self.rivals
            .iter()
            .filter(|rival| rival.effect == self.effect)
            .filter_map(|rival| rival.place.as_ref())
    }

    /// A mistake in the files.
    pub fn is_mistake(&self) -> bool {
        self.kind == "mistake"
    }
}

/// A number with its 95 % interval; an end that JSON has no number for is at infinity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs)]
pub struct Interval {
    pub name: String,
    #[serde(deserialize_with = "below")]
    pub lo: f64,
    #[serde(deserialize_with = "above")]
    pub hi: f64,
}

fn below<'de, D: Deserializer<'de>>(end: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(end)?.unwrap_or(f64::NEG_INFINITY))
}

fn above<'de, D: Deserializer<'de>>(end: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(end)?.unwrap_or(f64::INFINITY))
}

/// A single reading that an answer calls suspect.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Remark {
    #[serde(default)]
    row: Option<usize>,
    #[serde(default)]
    channel: Option<String>,
}

/// What of an answer is scored.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
struct Said {
    #[serde(default)]
    findings: Vec<Finding>,
    #[serde(default)]
    unexplained: Option<Value>,
    #[serde(default)]
    suspects: Vec<Remark>,
    #[serde(default)]
    heldout_before_um: Option<f64>,
    #[serde(default)]
    heldout_after_um: Option<f64>,
}

/// What the errors of the files' numbers come to.
const OF_NUMBERS: [&str; 2] = ["stiffness_scale", "shear_modulus"];
/// Two factors of a mistake that are one.
const SAME_FACTOR: f64 = 0.03;

/// A case with its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged<'a> {
    /// What was concealed.
    pub truth: &'a Truth,
    /// What was found, strongest first.
    pub findings: Vec<Finding>,
    /// True where a remainder was called unexplained.
    pub is_unexplained: bool,
    /// Single readings that were called suspect.
    suspects: Vec<Remark>,
    /// 1 − after²/before² of the held-out errors.
    pub gain: Option<f64>,
    /// Errors of the readings that were asked for.
    pub counterfactual: Option<Counterfactual>,
    /// True where the answer is no diagnosis.
    pub failed: bool,
}

impl<'a> Judged<'a> {
    /// Reads an answer.
    pub fn new(truth: &'a Truth, answer: &Answer) -> Self {
        let counterfactual = Counterfactual::new(truth, answer);
        Judged { counterfactual, ..Judged::of_diagnosis(truth, &answer.answer) }
    }

    /// Reads a diagnosis. What is none has found nothing.
    pub fn of_diagnosis(truth: &'a Truth, answer: &Value) -> Self {
        let said = Said::deserialize(answer);
        let failed = said.is_err() || answer.get("verdict").is_none();
        let said = said.unwrap_or_default();
        let gain = match (said.heldout_before_um, said.heldout_after_um) {
            (Some(before), Some(after)) if before > 0.0 => Some(1.0 - (after / before).powi(2)),
            _ => None,
        };
        Judged {
            truth,
            findings: said.findings,
            is_unexplained: said.unexplained.is_some(),
            suspects: said.suspects,
            gain,
            counterfactual: None,
            failed,
        }
    }

    /// The findings but for what accompanies the effects that are sought: those are right, and
    /// nobody asked.
    pub fn sought(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|finding| !self.is_companion(&finding.effect))
    }

    /// Friction beside the effect; a stiffness that is off by more than the file states.
    fn is_companion(&self, name: &str) -> bool {
        let truth = self.truth;
        let is_of_numbers = truth.numbers_off > 1.0 && OF_NUMBERS.contains(&name);
        let is_it = |concealed: &Concealed| concealed.effect == name;
        !truth.effects.iter().any(is_it) && (is_of_numbers || truth.companions.iter().any(is_it))
    }

    /// Nothing was found, named or not.
    pub fn is_silent(&self) -> bool {
        self.findings.is_empty() && !self.is_unexplained && !self.failed
    }

    /// The finding of the right name for a concealed effect, at the right place if there is one.
    pub fn found(&self, concealed: &Concealed) -> Option<&Finding> {
        let mut named: Vec<&Finding> =
            self.findings.iter().filter(|f| f.effect == concealed.effect).collect();
        let at = named.iter().position(|f| place::is_same(self.truth, concealed, f.place.as_ref()));
        named.swap_remove(at.or((!named.is_empty()).then_some(0))?).into()
    }

    /// An effect of this name is concealed, or accompanies one that is.
    pub fn is_concealed(&self, name: &str) -> bool {
        self.truth.effects.iter().any(|concealed| concealed.effect == name) || self.is_companion(name)
    }

    /// The strongest finding is concealed, or its class holds an effect that is, and the oracle
    /// cannot distinguish the two.
    pub fn is_right(&self) -> bool {
        let Some(first) = self.findings.first() else { return false };
        let class = self.class();
        let is_inseparable = |concealed: &Concealed| {
            class.contains(&concealed.effect.as_str())
                && concealed.detectability.class.contains(&first.effect)
        };
        self.is_concealed(&first.effect) || self.truth.effects.iter().any(is_inseparable)
    }

    /// The strongest finding has the name of the (strongest) concealed effect.
    pub fn name_ok(&self) -> bool {
        match (self.truth.effects.first(), self.sought().next()) {
            (Some(concealed), Some(first)) => first.effect == concealed.effect,
            _ => false,
        }
    }

    /// And its place.
    pub fn location_ok(&self) -> bool {
        self.truth.effects.first().is_some_and(|concealed| self.is_placed(concealed)) && self.name_ok()
    }

    /// A finding has the name of the effect and its place.
    pub fn is_placed(&self, concealed: &Concealed) -> bool {
        self.found(concealed).is_some_and(|f| place::is_same(self.truth, concealed, f.place.as_ref()))
    }

    /// Something was named that is not concealed, or not there.
    pub fn has_more(&self) -> bool {
        let is_right = |finding: &Finding| {
            self.truth.effects.iter().any(|concealed| {
                let is_there = || place::is_same(self.truth, concealed, finding.place.as_ref());
                finding.effect == concealed.effect && is_there()
            })
        };
        !self.sought().all(is_right)
    }

    /// A mistake is named where one was made: its name, and its factor where it has one.
    pub fn mistake_named(&self) -> Option<&Finding> {
        let concealed = self.truth.effects.first()?;
        let factor = concealed.parameters.iter().find(|p| p.name == "factor").map(|p| p.value);
        let is_factor = |finding: &Finding| {
            let said = finding.parameters.iter().find(|p| p.name == "factor");
            match (factor, said) {
                (Some(factor), Some(said)) => (said.lo / factor - 1.0).abs() < SAME_FACTOR,
                (None, _) => true,
                (Some(_), None) => false,
            }
        };
        let mistakes = self.findings.iter().filter(|finding| finding.is_mistake());
        let mut named = mistakes.filter(|f| f.effect == concealed.effect && is_factor(f));
        let first = named.next()?;
        let is_placed = |f: &&Finding| place::is_same(self.truth, concealed, f.place.as_ref());
        Some(named.find(is_placed).filter(|_| !is_placed(&first)).unwrap_or(first))
    }

    /// And it is said which columns or keys it concerns.
    pub fn mistake_placed(&self) -> bool {
        let concealed = self.truth.effects.first();
        let is_same = |f: &Finding| {
            concealed.is_some_and(|concealed| place::is_same(self.truth, concealed, f.place.as_ref()))
        };
        self.mistake_named().is_some_and(is_same)
    }

    /// Every reading that was misread is called suspect.
    pub fn all_remarked(&self) -> bool {
        let is_remarked = |place: &Place| {
            self.suspects.iter().any(|remark| remark.row == place.row && remark.channel == place.channel)
        };
        self.truth.effects.iter().all(|concealed| is_remarked(&concealed.place))
    }

    /// What the strongest finding may be.
    pub fn class(&self) -> Vec<&str> {
        let first = self.sought().next().or(self.findings.first());
        let Some(first) = first else { return Vec::new() };
        let others = first.indistinguishable_from.iter().map(|name| first_word(name));
        let mut class: Vec<&str> = others.chain([first.effect.as_str()]).collect();
        class.sort_unstable();
        class.dedup();
        class
    }

    /// The concealed effect is in the class.
    pub fn in_class(&self) -> bool {
        self.truth.effects.first().is_some_and(|concealed| self.class().contains(&concealed.effect.as_str()))
    }

    /// For each number of a concealed effect that was found at its place: whether the interval
    /// holds it.
    pub fn covered(&self, concealed: &Concealed) -> Vec<(String, bool)> {
        let Some(finding) = self.found(concealed).filter(|_| self.is_placed(concealed)) else {
            return Vec::new();
        };
        // of several outliers the one at this cell
        let cell = concealed.place.all.iter().position(|cell| Some(cell) == finding.place.as_ref());
        let truths: Vec<&crate::truth::Parameter> = match concealed.effect.as_str() {
            "outlier" => concealed.parameters.get(cell.unwrap_or(0)).into_iter().collect(),
            _ => concealed.parameters.iter().collect(),
        };
        let covered = |truth: &crate::truth::Parameter| {
            let said = finding.parameters.iter().find(|p| p.name == truth.name)?;
            let holds = |value: f64| (said.lo..=said.hi).contains(&value);
            Some((truth.name.clone(), holds(truth.value) || truth.with_numbers.is_some_and(holds)))
        };
        truths.into_iter().filter_map(covered).collect()
    }

    /// For a table: the strongest finding's name, `unexplained` or `nothing`.
    pub fn said(&self) -> &str {
        match (self.sought().next(), self.is_unexplained) {
            _ if self.failed => "failed",
            (Some(first), _) => &first.effect,
            (None, true) => "unexplained",
            (None, false) => "nothing",
        }
    }
}

/// `friction (slide)` is friction.
pub(super) fn first_word(name: &str) -> &str {
    name.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or(name)
}
