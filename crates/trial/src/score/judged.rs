//! One answer beside its truth.

use serde::Deserialize;
use serde_json::Value;

use super::counterfactual::Counterfactual;
use super::place;
use crate::answers::Answer;
use crate::truth::{Concealed, Truth};

/// What an answer found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Finding {
    /// Name of the effect.
    pub effect: String,
    /// Where.
    #[serde(default)]
    pub location: String,
    /// Its numbers.
    #[serde(default)]
    pub parameters: Vec<Interval>,
    /// Effects that it might be as well.
    #[serde(default)]
    pub indistinguishable_from: Vec<String>,
    /// Where it might be as well.
    #[serde(default)]
    pub places: Vec<String>,
    /// What would tell, in words and as numbers.
    #[serde(default)]
    pub next_measurement: Option<String>,
    #[serde(default)]
    #[allow(missing_docs)]
    pub next_measurement_plan: Option<Value>,
}

/// A number with its 95 % interval.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs)]
pub struct Interval {
    pub name: String,
    pub lo: f64,
    pub hi: f64,
}

/// What of an answer is scored.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
struct Said {
    #[serde(default)]
    findings: Vec<Finding>,
    #[serde(default)]
    unexplained: Option<Value>,
    #[serde(default)]
    heldout_before_um: Option<f64>,
    #[serde(default)]
    heldout_after_um: Option<f64>,
}

/// A case with its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged<'a> {
    /// What was concealed.
    pub truth: &'a Truth,
    /// What was found, strongest first.
    pub findings: Vec<Finding>,
    /// True where a remainder was called unexplained.
    pub is_unexplained: bool,
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
            gain,
            counterfactual: None,
            failed,
        }
    }

    /// The finding of the right name for a concealed effect, at the right place if there is one.
    pub fn found(&self, concealed: &Concealed) -> Option<&Finding> {
        let mut named: Vec<&Finding> =
            self.findings.iter().filter(|f| f.effect == concealed.effect).collect();
        let at = named.iter().position(|f| place::is_same(self.truth, concealed, &f.location));
        named.swap_remove(at.or((!named.is_empty()).then_some(0))?).into()
    }

    /// An effect of this name is concealed.
    pub fn is_concealed(&self, name: &str) -> bool {
        self.truth.effects.iter().any(|concealed| concealed.effect == name)
    }

    /// The strongest finding has the name of the (strongest) concealed effect.
    pub fn name_ok(&self) -> bool {
        match (self.truth.effects.first(), self.findings.first()) {
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
        self.found(concealed).is_some_and(|f| place::is_same(self.truth, concealed, &f.location))
    }

    /// Something was named that is not concealed, or not there.
    pub fn has_more(&self) -> bool {
        let is_right = |finding: &Finding| {
            self.truth.effects.iter().any(|concealed| {
                let is_there = || place::is_same(self.truth, concealed, &finding.location);
                finding.effect == concealed.effect && is_there()
            })
        };
        !self.findings.iter().all(is_right)
    }

    /// What the strongest finding may be.
    pub fn class(&self) -> Vec<&str> {
        let Some(first) = self.findings.first() else { return Vec::new() };
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

    /// For each number of a concealed effect that was found at its place: whether the interval holds it.
    pub fn covered(&self, concealed: &Concealed) -> Vec<(String, bool)> {
        let Some(finding) = self.found(concealed).filter(|_| self.is_placed(concealed)) else {
            return Vec::new();
        };
        // of several outliers the one at this cell
        let cell = concealed.location.split("; ").position(|cell| cell == finding.location).unwrap_or(0);
        let truths: Vec<&crate::truth::Parameter> = match concealed.effect.as_str() {
            "outlier" => concealed.parameters.get(cell).into_iter().collect(),
            _ => concealed.parameters.iter().collect(),
        };
        let covered = |truth: &crate::truth::Parameter| {
            let said = finding.parameters.iter().find(|p| p.name == truth.name)?;
            Some((truth.name.clone(), (said.lo..=said.hi).contains(&truth.value)))
        };
        truths.into_iter().filter_map(covered).collect()
    }

    /// For a table: the strongest finding's name, `unexplained` or `nothing`.
    pub fn said(&self) -> &str {
        match (self.findings.first(), self.is_unexplained) {
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
