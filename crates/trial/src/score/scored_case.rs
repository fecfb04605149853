//! One answer beside its truth.

use serde::Deserialize;
use serde_json::Value;

use super::counterfactual::Counterfactual;
use super::diagnosis::{Diagnosis, Finding, Suspect};
use super::place;
use super::verdict::Verdict;
use crate::answers::Answer;
use crate::effect_name::EffectName;
use crate::ground_truth::{Concealed, GroundTruth, Parameter};
use crate::place::Place;

/// What the errors of the files' numbers come to.
const OF_NUMBERS: [EffectName; 2] = [EffectName::StiffnessScale, EffectName::ShearModulus];
/// Two factors of a mistake that are one.
const SAME_FACTOR: f64 = 0.03;

/// A case with its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct ScoredCase<'a> {
    /// What was concealed.
    pub truth: &'a GroundTruth,
    /// What was found, strongest first.
    pub findings: Vec<Finding>,
    /// True where a remainder was called unexplained.
    pub is_unexplained: bool,
    /// Single readings that were called suspect.
    suspects: Vec<Suspect>,
    /// 1 − after²/before² of the held-out errors.
    pub gain: Option<f64>,
    /// Errors of the readings that were asked for.
    pub counterfactual: Option<Counterfactual>,
    /// True where the answer is no diagnosis.
    pub failed: bool,
}

impl<'a> ScoredCase<'a> {
    /// Reads an answer.
    pub fn new(truth: &'a GroundTruth, answer: &Answer) -> Self {
        let counterfactual = Counterfactual::new(truth, answer);
        ScoredCase { counterfactual, ..ScoredCase::of_diagnosis(truth, &answer.answer) }
    }

    /// Reads a diagnosis. What is none has found nothing.
    pub fn of_diagnosis(truth: &'a GroundTruth, answer: &Value) -> Self {
        let diagnosis = Diagnosis::deserialize(answer);
        let failed = diagnosis.is_err() || answer.get("verdict").is_none();
        let diagnosis = diagnosis.unwrap_or_default();
        let gain = match (diagnosis.heldout_before_um, diagnosis.heldout_after_um) {
            (Some(before), Some(after)) if before > 0.0 => Some(1.0 - (after / before).powi(2)),
            _ => None,
        };
        ScoredCase {
            truth,
            findings: diagnosis.findings,
            is_unexplained: diagnosis.unexplained.is_some(),
            suspects: diagnosis.suspects,
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
    fn is_companion(&self, name: &EffectName) -> bool {
        let truth = self.truth;
        let is_of_numbers = truth.numbers_off > 1.0 && OF_NUMBERS.contains(name);
        let is_it = |concealed: &Concealed| concealed.effect == *name;
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
    pub fn is_concealed(&self, name: &EffectName) -> bool {
        self.truth.effects.iter().any(|concealed| concealed.effect == *name) || self.is_companion(name)
    }

    /// The strongest finding is concealed, or its class holds an effect that is, and the oracle
    /// cannot distinguish the two.
    pub fn is_right(&self) -> bool {
        let Some(first) = self.findings.first() else { return false };
        let class = self.class();
        let is_inseparable = |concealed: &Concealed| {
            class.contains(&&concealed.effect) && concealed.detectability.class.contains(&first.effect)
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
            let answered = finding.parameters.iter().find(|p| p.name == "factor");
            match (factor, answered) {
                (Some(factor), Some(answered)) => (answered.lo / factor - 1.0).abs() < SAME_FACTOR,
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
    pub fn class(&self) -> Vec<&EffectName> {
        let first = self.sought().next().or(self.findings.first());
        let Some(first) = first else { return Vec::new() };
        let mut class: Vec<&EffectName> =
            first.indistinguishable_from.iter().chain([&first.effect]).collect();
        class.sort_unstable();
        class.dedup();
        class
    }

    /// The concealed effect is in the class.
    pub fn in_class(&self) -> bool {
        self.truth.effects.first().is_some_and(|concealed| self.class().contains(&&concealed.effect))
    }

    /// For each number of a concealed effect that was found at its place: whether the interval
    /// holds it.
    pub fn covered(&self, concealed: &Concealed) -> Vec<(String, bool)> {
        let Some(finding) = self.found(concealed).filter(|_| self.is_placed(concealed)) else {
            return Vec::new();
        };
        // of several outliers the one at this cell
        let cell = concealed.place.all.iter().position(|cell| Some(cell) == finding.place.as_ref());
        let truths: Vec<&Parameter> = match concealed.effect {
            EffectName::Outlier => concealed.parameters.get(cell.unwrap_or(0)).into_iter().collect(),
            _ => concealed.parameters.iter().collect(),
        };
        let covered = |truth: &Parameter| {
            let interval = finding.parameters.iter().find(|p| p.name == truth.name)?;
            let holds = |value: f64| (interval.lo..=interval.hi).contains(&value);
            Some((truth.name.clone(), holds(truth.value) || truth.with_numbers.is_some_and(holds)))
        };
        truths.into_iter().filter_map(covered).collect()
    }

    /// What it comes to.
    pub fn verdict(&self) -> Verdict {
        match (self.sought().next(), self.is_unexplained) {
            _ if self.failed => Verdict::Failed,
            (Some(first), _) => Verdict::Named(first.effect.clone()),
            (None, true) => Verdict::Unexplained,
            (None, false) => Verdict::Nothing,
        }
    }
}
