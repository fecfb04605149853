//! What curves run along, and what they have in common.

use crate::diagnosis::rig::datum::Datum;
use crate::inference::{Candidate, Location, Parameter, UNKNOWN, Variable};

/// Columns of a curve.
pub(super) const MOST_COLUMNS: usize = 6;
pub(super) const PERCENT: f64 = 0.01;
/// Size of a curve as a share of the largest reading, or of the deflection.
pub(super) const SHARE: f64 = 0.05;
/// The same, as a share of the largest of all readings: a sensor and its holder are a little wrong
/// even where hardly anything is to be read.
pub(super) const LEAST_SHIFT: f64 = 0.01;

/// What a curve is a function of: its name in labels, how it is said, the number it is seen along.
#[derive(Clone, Copy)]
pub(super) struct Along {
    pub name: &'static str,
    pub follows: &'static str,
    pub variable: Variable,
}

pub(super) const LOAD: Along = Along { name: "load", follows: "follows the load", variable: Variable::Load };
pub(super) const UNLOADING: Along =
    Along { name: "unloading", follows: "follows the load while unloading", variable: Variable::Load };
pub(super) const SIGNED_LOAD: Along =
    Along { name: "signed load", follows: "follows the signed load", variable: Variable::Load };
pub(super) const POSITION: Along = Along {
    name: "position in the run",
    follows: "follows the position in the run",
    variable: Variable::Order,
};
pub(super) const FALLING: Along = Along {
    name: "signed load, falling",
    follows: "follows the signed load while it falls",
    variable: Variable::SignedLoad,
};
pub(super) const ORDER: Along =
    Along { name: "order", follows: "follows the order of the readings", variable: Variable::Order };
pub(super) const TIME: Along = Along { name: "time", follows: "follows the time", variable: Variable::Time };
pub(super) const SINCE_CHANGE: Along = Along {
    name: "time since the load was changed",
    follows: "follows the time since the load was changed",
    variable: Variable::TimeInRun,
};
pub(super) const LOAD_BEFORE: Along =
    Along { name: "load before", follows: "follows the load that hung before", variable: Variable::Order };
pub(super) const TEMPERATURE: Along =
    Along { name: "temperature", follows: "follows the temperature", variable: Variable::Temperature };

/// The place of a curve that multiplies all deflections.
pub(super) const ALL_DEFLECTIONS: &str = "all deflections";
/// The same of what all deflections change by from one reading to the next.
pub(super) const CHANGES: &str = "all changes of deflections";

impl Along {
    /// `follows the load (all readings alike)`.
    pub(super) fn follows(self, place: &str) -> String {
        let readings = if place == ALL_DEFLECTIONS { "all readings alike" } else { place };
        format!("{} ({readings})", self.follows)
    }
}

/// A rival for physics that nobody has named.
pub(super) fn rival(location: Location, parameters: Vec<Parameter>) -> Candidate {
    Candidate {
        effect: &UNKNOWN,
        location,
        parameters,
        weight: 1.0,
        is_alternative: false,
        is_nonparametric: true,
    }
}

/// A coordinate from 0 to 1 for each datum; `None` where it has no meaning.
pub(super) type Coordinate = Vec<Option<f64>>;

/// The largest reading, m.
pub(super) fn largest_reading(data: &[Datum]) -> f64 {
    data.iter().fold(0.0, |most: f64, datum| most.max(datum.measured.abs()))
}
