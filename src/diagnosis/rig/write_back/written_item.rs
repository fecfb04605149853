//! What a correction writes, as values.

use std::fmt;

use crate::inference::law::Law;
use crate::inference::{Effect, Location};
use crate::rod::{NominalNumber, RodLaw};

/// Something that enters the rod's file, is taken out of the readings, or fits neither.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum WrittenItem {
    /// An effect at its place.
    Effect(&'static Effect, Location),
    /// A number of the rod's file that moved within its standard uncertainty.
    Number(NominalNumber),
    /// A law that the rod's file holds.
    Law(RodLaw),
    /// A law over something that this recording alone has.
    LawOfRecording {
        /// What it is a function of.
        variable: String,
        /// Where it acts.
        location: Location,
    },
}

impl WrittenItem {
    /// A law that no file holds.
    pub(super) fn of_recording(law: &Law) -> WrittenItem {
        let (variable, location) = (law.site.variable.name.clone(), law.site.location.clone());
        WrittenItem::LawOfRecording { variable, location }
    }

    /// In sentences: `stiffness scale, rod`.
    pub fn description(&self) -> String {
        match self {
            WrittenItem::Effect(effect, location) => format!("{}, {location}", effect.title()),
            WrittenItem::Number(_) | WrittenItem::Law(_) | WrittenItem::LawOfRecording { .. } => {
                self.to_string()
            }
        }
    }
}

/// As in files and JSON: `stiffness_scale, rod`.
impl fmt::Display for WrittenItem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WrittenItem::Effect(effect, location) => write!(f, "{effect}, {location}"),
            WrittenItem::Number(number) => write!(f, "{number}, within its standard uncertainty"),
            WrittenItem::Law(law) => write!(f, "law, {law}"),
            WrittenItem::LawOfRecording { variable, location } => {
                write!(f, "law over the {variable}, {location}")
            }
        }
    }
}
