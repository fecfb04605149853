//! A score as data, as JSON and as text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;

use rodcal_base::error::Result;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::{
    Bin, Conflicts, Confusion, Failure, Missed, NextMeasurement, PowerBin, Predictions, Rate, Reached,
    tables::confusion_text,
};
use crate::archive::unwritable;
use crate::effect_name::EffectName;

/// A trial's score: of all cases, and of each suite of them. As JSON its keys are those of
/// [`Part`], then the suites.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    /// All cases.
    #[serde(flatten)]
    pub whole: Part,
    /// Cases of the key without an answer.
    pub unanswered: usize,
    /// Rods at a rig; `None` where there is no such case.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rig: Option<Part>,
    /// Calibrations of arms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Part>,
    /// What limits it, to be said before anything else: cases without an answer.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
}

/// The score of some cases.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Part {
    /// Answered cases.
    pub cases: usize,
    /// Those whose answer is no diagnosis.
    pub failed: usize,
    /// Nothing is concealed.
    pub clean: Clean,
    /// One effect is concealed.
    pub single: Singles,
    /// Two are.
    pub pairs: Pairs,
    /// Physics that no library has.
    pub unknown: Unknown,
    /// One effect is concealed that is too small for anybody to detect.
    pub below: Below,
    /// Something was written wrongly.
    pub mistakes: Mistakes,
    /// Single readings were misread.
    pub suspects: Suspects,
    /// The strongest finding is concealed, of the cases with a finding.
    pub right_when_named: Rate,
    /// It is, or something of its class is that the oracle cannot distinguish from it.
    pub right_or_inseparable: Rate,
    /// Something of its class is.
    pub class_right_when_named: Rate,
    /// 95 % intervals that hold the truth.
    #[serde(flatten)]
    pub coverage: Coverage,
    /// Gain of held-out errors over what an oracle gains, identifiable cases together.
    pub gain_over_oracle: Option<f64>,
    /// Readings that were asked for and not given: the median of `counterfactual`.
    pub counterfactual_over_oracle: Option<f64>,
    /// Errors of these predictions over those of the oracle.
    pub counterfactual: Predictions,
    /// What the proposals of ambiguous answers led to.
    pub next_measurement_ok: NextMeasurement,
    /// Cases with one effect by what the oracle could know.
    pub bins: Vec<Bin>,
    /// Truth → answer → cases.
    pub confusion: Confusion,
    /// Effects that imitate each other: pair → truth → answer → cases.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub conflicts: Conflicts,
    /// Names of effects that no library has.
    pub outside: BTreeSet<EffectName>,
    /// Probability of the right name over size, by effect.
    pub power: BTreeMap<EffectName, Vec<PowerBin>>,
    /// Cases that somebody should look at.
    pub failures: Vec<Failure>,
    /// What was to be reached, missed targets first.
    pub targets: Vec<Reached>,
    /// What was to be reached and was not.
    pub missed_targets: Vec<Missed>,
}

/// Of clean cases.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clean {
    /// Something was named.
    pub false_names: Rate,
    /// A remainder was called unexplained.
    pub false_unexplained: Rate,
    /// Neither, of the recordings whose files state their numbers' uncertainty rightly,
    pub silent: Rate,
    /// and of those whose numbers are off by twice that.
    pub silent_twice: Rate,
}

/// Of cases with one effect.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Singles {
    /// All of them; the rates but `in_class` are of the identifiable ones.
    pub n: usize,
    /// The name is right,
    pub name_ok: Rate,
    /// and the place.
    pub location_ok: Rate,
    /// Nothing was named.
    pub missed: Rate,
    /// Of detectable cases with a finding: the truth is in its class.
    pub in_class: Rate,
    /// Mean size of that class.
    pub class_size: f64,
}

/// Of cases with two effects.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pairs {
    /// All of them; the rates are of those whose effects are both identifiable.
    pub n: usize,
    /// Both effects were found,
    pub both_found: Rate,
    /// or at least one.
    pub one_found: Rate,
}

/// Of cases with physics that no library has.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Unknown {
    /// All of them; the rates are of the identifiable ones.
    pub n: usize,
    /// Called unexplained and nothing else.
    pub called_unknown: Rate,
    /// Something was named.
    pub wrongly_named: Rate,
}

/// Of cases whose effect is below the detection limit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Below {
    /// Nothing was found, as is right,
    pub silent: Rate,
    /// or its class holds the truth,
    pub silent_or_right: Rate,
    /// or something else was named.
    pub wrongly_named: Rate,
}

/// Of cases with a mistake in their files, but for `invented`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Mistakes {
    /// Its name was said, with its factor where it has one,
    pub named: Rate,
    /// and its place.
    pub placed: Rate,
    /// Something else was said, or something that has no name.
    pub as_other: Rate,
    /// Nothing was found.
    pub silent: Rate,
    /// A mistake was named in a case without one.
    pub invented: Rate,
    /// Those that were named, by the mistake.
    pub by_mistake: BTreeMap<EffectName, Rate>,
}

/// Of cases with misread readings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Suspects {
    /// Every misread reading was called suspect.
    pub remarked: Rate,
    /// Something was reported as a finding.
    pub named: Rate,
}

/// Intervals that hold the truth.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Coverage {
    /// Of all numbers,
    pub all: Rate,
    /// and of each, by the names of effect and number.
    pub by_parameter: BTreeMap<String, Rate>,
}

impl Serialize for Clean {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Clean { false_names, false_unexplained, silent, silent_twice } = self;
        json!({
            "n": false_names.total,
            "false_names": false_names.count, "false_unexplained": false_unexplained.count,
            "false_names_rate": false_names, "false_unexplained_rate": false_unexplained,
            "silent_rate": silent, "silent_twice_rate": silent_twice,
        })
        .serialize(serializer)
    }
}

impl Serialize for Singles {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Singles { n, name_ok, location_ok, missed, in_class, class_size } = self;
        json!({
            "n": n, "identifiable": name_ok.total,
            "name_ok": name_ok.count, "location_ok": location_ok.count, "in_class": in_class.count,
            "missed": missed.count, "class_size": class_size,
            "name_ok_rate": name_ok, "location_ok_rate": location_ok, "in_class_rate": in_class,
        })
        .serialize(serializer)
    }
}

impl Serialize for Pairs {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Pairs { n, both_found, one_found } = self;
        json!({
            "n": n, "identifiable": both_found.total,
            "both_found": both_found.count, "one_found": one_found.count, "both_found_rate": both_found,
        })
        .serialize(serializer)
    }
}

impl Serialize for Unknown {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Unknown { n, called_unknown, wrongly_named } = self;
        json!({
            "n": n, "identifiable": called_unknown.total,
            "called_unknown": called_unknown.count, "wrongly_named": wrongly_named.count,
            "called_unknown_rate": called_unknown, "wrongly_named_rate": wrongly_named,
        })
        .serialize(serializer)
    }
}

impl Serialize for Coverage {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        json!({
            "coverage": self.all.share(), "coverage_rate": self.all, "coverage_by_parameter": self.by_parameter,
        })
        .serialize(serializer)
    }
}

impl Score {
    /// The suites that have cases, by name.
    pub fn suites(&self) -> impl Iterator<Item = (&'static str, &Part)> {
        [("rig", &self.rig), ("calibration", &self.calibration)]
            .into_iter()
            .filter_map(|(name, part)| Some((name, part.as_ref()?)))
    }

    /// For `--json`.
    ///
    /// # Errors
    /// [`rodcal_base::Error::Numerical`] for what JSON has no words for.
    pub fn json(&self) -> Result<Value> {
        serde_json::to_value(self).map_err(unwritable)
    }

    /// For people: missed targets, all cases, then each suite if there are both.
    pub fn text(&self) -> String {
        let mut text: String = self.remarks.iter().map(|remark| format!("{remark}\n")).collect();
        for (suite, part) in self.suites() {
            part.missed_targets.iter().for_each(|missed| text += &format!("MISSED {suite}: {missed}\n"));
        }
        if !text.is_empty() {
            text += "\n";
        }
        text += &self.whole.text();
        if self.suites().count() > 1 {
            self.suites().for_each(|(suite, part)| text += &format!("\n{suite}\n{}", part.text()));
        }
        text
    }
}

impl Part {
    fn text(&self) -> String {
        let Part { clean, single, pairs, unknown, below, mistakes, suspects, .. } = self;
        let mut text: String = self.targets.iter().map(|reached| format!("{reached}\n")).collect();
        text += "\n";
        let mut line = |what: &str, value: &dyn Display| text += &format!("{what:44} {value}\n");
        line("clean: silent", &clean.silent);
        line("clean, numbers twice as far off: silent", &clean.silent_twice);
        line("clean: false names", &clean.false_names);
        line("clean: called unexplained", &clean.false_unexplained);
        line("single, identifiable: name right", &single.name_ok);
        line("single, identifiable: name and place right", &single.location_ok);
        line("single, identifiable: nothing named", &single.missed);
        line(
            "single, detectable, named: truth in class",
            &match single.class_size > 0.0 {
                true => format!("{}; class of {:.1}", single.in_class, single.class_size),
                false => single.in_class.to_string(),
            },
        );
        line("single, below the limit: silent", &below.silent);
        line("single, below the limit: silent or right", &below.silent_or_right);
        line("single, below the limit: wrongly named", &below.wrongly_named);
        line("pairs, identifiable: both found", &pairs.both_found);
        line("pairs, identifiable: one found", &pairs.one_found);
        line("unknown, identifiable: called unexplained", &unknown.called_unknown);
        line("unknown, identifiable: wrongly named", &unknown.wrongly_named);
        line("mistakes: named", &mistakes.named);
        line("mistakes: named and placed", &mistakes.placed);
        line("mistakes: named as something else", &mistakes.as_other);
        line("mistakes: silent", &mistakes.silent);
        line("no mistake: a mistake named", &mistakes.invented);
        for (mistake, rate) in &mistakes.by_mistake {
            line(&format!("  {mistake}: named"), rate);
        }
        line("misread readings: all remarked", &suspects.remarked);
        line("misread readings: something named", &suspects.named);
        line("right when it names", &self.right_when_named);
        line("right, or not distinguishable, when it names", &self.right_or_inseparable);
        line("right, or in its class, when it names", &self.class_right_when_named);
        line("95 % intervals that hold the truth", &self.coverage.all);
        let gain = self.gain_over_oracle.map_or("no case".into(), |gain| format!("{gain:.3}"));
        line("held-out gain over the oracle's", &gain);
        line("error of other readings over the oracle's", &self.counterfactual);
        line("ambiguous: settled by what is proposed", &self.next_measurement_ok);
        text += &confusion_text("truth (identifiable)", &self.confusion);
        self.conflicts.iter().for_each(|(pair, counts)| text += &confusion_text(pair, counts));
        text
    }
}
