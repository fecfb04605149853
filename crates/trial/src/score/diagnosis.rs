//! What of a diagnosis' JSON is scored. Its text is read here, once; behind this file names and
//! places are values.

use serde::{Deserialize, Deserializer};
use serde_json::Value;

use crate::effect_name::EffectName;
use crate::place::Place;

/// A diagnosis, as far as it is scored.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub(super) struct Diagnosis {
    #[serde(default)]
    pub findings: Vec<Finding>,
    #[serde(default)]
    pub unexplained: Option<Value>,
    #[serde(default)]
    pub suspects: Vec<Suspect>,
    #[serde(default)]
    pub heldout_before_um: Option<f64>,
    #[serde(default)]
    pub heldout_after_um: Option<f64>,
}

/// What an answer found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Finding {
    /// Name of the effect.
    pub effect: EffectName,
    /// What it is.
    #[serde(default)]
    pub kind: FindingKind,
    /// Where, for people, and as data.
    #[serde(default)]
    pub location: String,
    /// The same place, as the key compares it.
    #[serde(default)]
    pub place: Option<Place>,
    /// Its numbers.
    #[serde(default)]
    pub parameters: Vec<Interval>,
    /// Effects that it might be as well.
    #[serde(default, deserialize_with = "names")]
    pub indistinguishable_from: Vec<EffectName>,
    /// What might stand in its place, and where.
    #[serde(default)]
    pub rivals: Vec<Rival>,
    /// What would decide, in a sentence.
    #[serde(default)]
    pub next_measurement: Option<String>,
    /// The same as numbers.
    #[serde(default)]
    pub next_measurement_plan: Option<Value>,
}

/// What a finding is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FindingKind {
    /// Written or wired wrongly.
    Mistake,
    /// Happened once.
    Event,
    /// Acts on every datum.
    #[default]
    #[serde(other)]
    Physics,
}

/// What might stand in the place of a finding.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Rival {
    /// Name of the effect.
    pub effect: EffectName,
    /// The place at which it would act.
    #[serde(default)]
    pub place: Option<Place>,
}

/// A number with its 95 % interval; an end that JSON has no number for is at infinity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "the names are those of the JSON of an answer")]
pub struct Interval {
    pub name: String,
    #[serde(deserialize_with = "below")]
    pub lo: f64,
    #[serde(deserialize_with = "above")]
    pub hi: f64,
}

/// A single reading that an answer calls suspect.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Suspect {
    #[serde(default)]
    pub row: Option<usize>,
    #[serde(default)]
    pub channel: Option<String>,
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
        self.kind == FindingKind::Mistake
    }
}

fn below<'de, D: Deserializer<'de>>(end: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(end)?.unwrap_or(f64::NEG_INFINITY))
}

fn above<'de, D: Deserializer<'de>>(end: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(end)?.unwrap_or(f64::INFINITY))
}

/// Answers of former versions say where too: `friction (slide)` is friction.
fn names<'de, D: Deserializer<'de>>(list: D) -> Result<Vec<EffectName>, D::Error> {
    let name = |text: &String| {
        let without_place = text.split(" (").next().unwrap_or(text);
        EffectName::from(without_place)
    };
    Ok(Vec::<String>::deserialize(list)?.iter().map(name).collect())
}
