//! Places and variables of laws: as files call them, and as the engine knows them.

use crate::inference::law::Measure;
use crate::inference::{Location, Part};
use crate::rod::{LawVariable, RodLawPlace};
use crate::units::UM;

/// What a law on a rig may be a function of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SiteVariable {
    /// What a law of the rod's file may be a function of too.
    OfFile(LawVariable),
    /// The time since the first reading.
    Time,
    /// The temperature above the lowest.
    Temperature,
    /// The place in the order of recording.
    Order,
}

impl SiteVariable {
    /// Those that a file can name.
    pub fn all_of_files() -> impl Iterator<Item = SiteVariable> {
        let of_recording = [SiteVariable::Time, SiteVariable::Temperature];
        LawVariable::ALL.into_iter().map(SiteVariable::OfFile).chain(of_recording)
    }

    /// In files; `None` for what no file names.
    pub fn key(self) -> Option<&'static str> {
        match self {
            SiteVariable::OfFile(variable) => Some(variable.key()),
            SiteVariable::Time => Some("time_s"),
            SiteVariable::Temperature => Some("temperature_k"),
            SiteVariable::Order => None,
        }
    }

    /// As the engine knows it.
    pub fn measure(self) -> Measure {
        match self {
            SiteVariable::OfFile(variable) => {
                let si = if variable.unit() == "µm" { UM } else { 1.0 };
                measure(variable.symbol(), variable.description(), variable.unit(), si)
            }
            SiteVariable::Time => measure("t", "time", "s", 1.0),
            SiteVariable::Temperature => measure("T", "temperature above the lowest", "K", 1.0),
            SiteVariable::Order => measure("n", "number of readings before", "", 1.0),
        }
    }
}

/// A number that the engine knows a law by.
pub fn measure(symbol: &'static str, name: &str, unit: &'static str, si: f64) -> Measure {
    Measure { symbol, name: name.into(), unit, si }
}

/// What a file calls this place; `None` where no law of a file acts there.
pub fn place_in_file(location: &Location) -> Option<RodLawPlace> {
    match location {
        Location::Part(Part::Rod) => Some(RodLawPlace::Rod),
        Location::Part(Part::Clamp) => Some(RodLawPlace::Clamp),
        Location::Part(Part::Root) => Some(RodLawPlace::Root),
        Location::Part(Part::Bend) => Some(RodLawPlace::Bend),
        Location::Part(Part::Slide) => Some(RodLawPlace::Slide),
        Location::Channel { channel, .. } => Some(RodLawPlace::Sensor(*channel)),
        Location::Named(joint) => Some(RodLawPlace::named(joint)),
        _ => None,
    }
}
