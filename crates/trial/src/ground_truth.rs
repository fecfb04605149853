//! What is concealed in a case: one line of the key.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::Seed;
use crate::effect_name::EffectName;
use crate::place::Place;

/// One case of the key. Units are those of the names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroundTruth {
    /// `rig/case-0001`.
    pub case: String,
    /// What sort of case.
    pub kind: Kind,
    /// The pair of effects that imitate each other of which it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conflict: Option<String>,
    /// What is wrong, strongest first; of an unknown case physics that no library has.
    pub effects: Vec<Concealed>,
    /// What accompanies it and is right to be named, but not sought.
    #[serde(default)]
    pub companions: Vec<Concealed>,
    /// How many times as far off as the files state their numbers are; 0: exact.
    #[serde(default)]
    pub numbers_off: f64,
    /// Standard deviation of a reading, µm, its shape, and the step of the display, µm.
    pub noise_um: f64,
    /// `normal`, `student-t (5)`, `student-t (4), correlated 0.35`.
    pub noise_shape: String,
    /// Step of the display, µm.
    pub quantum_um: f64,
    /// Numbers in the file.
    pub readings: usize,
    /// For people: loads, trials, axes.
    pub protocol: String,
    /// Joints that the rod file declares, and where, mm.
    pub joints: BTreeMap<String, f64>,
    /// Root mean square of what large deflection adds to the linear rod, µm: no effect, but no
    /// noise either.
    pub geometric_um: f64,
    /// Share of the held-out squares that goes once the effects are known, 1 − noise²/(noise² +
    /// effects²), the noise with that of the zero; `None` where there is nothing to gain: no
    /// effect, or one that a single run has.
    pub oracle_gain: Option<f64>,
    /// Seed of the trial, from which whoever scores makes the case once more. A key of before has
    /// none.
    #[serde(default)]
    pub seed: Option<Seed>,
    /// Residuals of a real recording from which the noise was drawn; empty where it was computed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub residuals: Vec<f64>,
    /// What belongs into the readings that are asked for.
    #[serde(default, rename = "asked")]
    pub query: Option<PredictionQuery>,
}

/// A prediction query: readings, or coordinates x, y, z of balls, that are asked for and not given,
/// in the order of the file that asks, µm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PredictionQuery {
    /// What would be read without noise.
    pub true_um: Vec<f64>,
    /// What an oracle says that knows the law and the place of every effect and finds its size out
    /// from the recording; `None` where there is no such size: no effect, one of a single run, or
    /// physics that no library has.
    pub oracle_um: Option<Vec<f64>>,
    /// True for points in a frame that nobody knows: they are compared after the best motion of all
    /// of them.
    #[serde(default)]
    pub is_any_frame: bool,
}

/// What sort of case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Nothing.
    Clean,
    /// One effect of the library.
    Single,
    /// Two of them.
    Pair,
    /// Physics that no library has.
    Unknown,
    /// Something that was written wrongly.
    Mistake,
    /// Single readings that were misread.
    Suspect,
}

/// One concealed effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Concealed {
    /// Its name.
    pub effect: EffectName,
    /// Where, for people.
    pub location: String,
    /// Where it acts, as the key compares it.
    pub place: Place,
    /// Its numbers, by name.
    pub parameters: Vec<Parameter>,
    /// Root mean square of what it does to the readings over the noise.
    pub size_over_noise: f64,
    /// What an oracle could have known.
    pub detectability: Detectability,
}

impl Concealed {
    /// A mistake: files that do not fit each other leave nothing to detect.
    pub fn mistake(effect: EffectName, place: Place, parameters: Vec<Parameter>) -> Concealed {
        Concealed {
            effect,
            location: place.to_string(),
            parameters,
            size_over_noise: f64::MAX,
            detectability: Detectability {
                against_none: f64::MAX,
                against_rival: f64::MAX,
                against_pair: None,
                best_rival: String::new(),
                class: Vec::new(),
                places: vec![place.clone()],
                stations_mm: None,
            },
            place,
        }
    }
}

/// A number of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name with its unit.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// What it is together with the errors of the files' numbers, which nobody can separate from
    /// it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with_numbers: Option<f64>,
}

/// Expected log Bayes factors of an oracle that knows the readings without noise, natural
/// logarithms.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Detectability {
    /// Against nothing being wrong.
    pub against_none: f64,
    /// Against the best effect of another name.
    pub against_rival: f64,
    /// Of physics that no library has: against the best two effects of it.
    #[serde(default)]
    pub against_pair: Option<f64>,
    /// The best effect of another name, for people; empty where there is none.
    pub best_rival: String,
    /// Effects of other names less than 5 away: nobody could distinguish them.
    pub class: Vec<EffectName>,
    /// Places of the same effect less than 3 away.
    pub places: Vec<Place>,
    /// For joints: the stations that cannot be distinguished, mm.
    pub stations_mm: Option<[f64; 2]>,
}

impl Detectability {
    /// Expected log Bayes factor from which on an effect counts as identifiable.
    pub const IDENTIFIABLE: f64 = 5.0;

    /// The smallest separation.
    pub fn separation(&self) -> f64 {
        self.against_none.min(self.against_rival).min(self.against_pair.unwrap_or(f64::MAX))
    }

    /// True where the recording shows that something is wrong.
    pub fn is_detectable(&self) -> bool {
        self.against_none >= Self::IDENTIFIABLE
    }

    /// True where the recording distinguishes it from nothing and from every other effect.
    pub fn is_identifiable(&self) -> bool {
        self.separation() >= Self::IDENTIFIABLE
    }
}
