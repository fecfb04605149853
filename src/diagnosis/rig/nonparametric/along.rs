//! What curves run along, and what they have in common.

use std::sync::Arc;

use super::super::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Location, Parameter, UNKNOWN, Variable};

/// Columns of a curve.
pub(super) const MOST_COLUMNS: usize = 6;
/// Size of a curve as a share of the largest reading, or of the deflection.
pub(super) const SHARE: f64 = 0.05;
/// The same, as a share of the largest of all readings: a sensor and its holder are a little wrong
/// even where hardly anything is to be read.
const LEAST_SHIFT: f64 = 0.01;

/// What a curve is a function of.
#[derive(Clone, Copy)]
pub(super) struct Along {
    /// In labels.
    pub name: &'static str,
    /// In sentences.
    pub follows: &'static str,
    /// The number that it is seen along.
    pub variable: Variable,
    /// True for what only grows from the first reading to the last, of a run or of all.
    pub is_recording: bool,
}

pub(super) const fn along(name: &'static str, follows: &'static str, variable: Variable) -> Along {
    Along { name, follows, variable, is_recording: false }
}

pub(super) const fn along_the_recording(
    name: &'static str,
    follows: &'static str,
    variable: Variable,
) -> Along {
    Along { name, follows, variable, is_recording: true }
}

pub(super) const LOAD: Along = along("load", "follows the load", Variable::Load);
pub(super) const UNLOADING: Along = along("unloading", "follows the load while unloading", Variable::Load);
pub(super) const SIGNED_LOAD: Along = along("signed load", "follows the signed load", Variable::Load);
pub(super) const FALLING: Along =
    along("signed load, falling", "follows the signed load while it falls", Variable::SignedLoad);
pub(super) const SINCE_CHANGE: Along = along(
    "time since the load was changed",
    "follows the time since the load was changed",
    Variable::TimeInRun,
);
pub(super) const LOAD_BEFORE: Along =
    along("load before", "follows the load that hung before", Variable::Order);
pub(super) const SPEED: Along =
    along("speed of loading", "follows the speed at which the load was changed", Variable::TimeInRun);
pub(super) const READING: Along = along("reading", "follows the reading itself", Variable::Load);
pub(super) const TEMPERATURE: Along = along("temperature", "follows the temperature", Variable::Temperature);
pub(super) const POSITION: Along =
    along_the_recording("position in the run", "follows the position in the run", Variable::Order);
pub(super) const ORDER: Along =
    along_the_recording("order", "follows the order of the readings", Variable::Order);
pub(super) const TIME: Along = along_the_recording("time", "follows the time", Variable::Time);

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
    Candidate { is_nonparametric: true, ..Candidate::new(&UNKNOWN, location, parameters) }
}

/// Which way something moves sensors under loads that point both ways.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Way {
    /// As the load does.
    Along,
    /// The same way whichever way loads point: a stand that sinks.
    Same,
}

impl Way {
    /// Those that are two under the loads of these data.
    pub fn of(data: &[Datum], group: &[usize]) -> &'static [Way] {
        match group.iter().any(|&i| data[i].drive() < 0.0) {
            true => &[Way::Along, Way::Same],
            false => &[Way::Along],
        }
    }

    /// 1 or −1 by the load.
    pub fn side(self, drive: f64) -> f64 {
        if self == Way::Along { drive.signum() } else { 1.0 }
    }

    pub fn in_sentences(self) -> &'static str {
        if self == Way::Along { "" } else { ", whichever way they point" }
    }
}

/// A coordinate from 0 to 1 for each datum; `None` where it has no meaning.
pub(super) type Coordinate = Vec<Option<f64>>;

/// Size of what adds to the readings of a group, m.
pub(super) fn size(group: &[usize], data: &[Datum]) -> f64 {
    let largest = group.iter().fold(0.0, |most: f64, &i| most.max(data[i].measured.abs()));
    let of_all = data.iter().fold(0.0, |most: f64, datum| most.max(datum.measured.abs()));
    (SHARE * largest).max(LEAST_SHIFT * of_all)
}

/// These data by channel.
pub(super) fn by_channel(known: &[usize], data: &[Datum]) -> Vec<Arc<[usize]>> {
    let channels = numbered(known.iter().map(|&i| data[i].channel));
    let count = channels.iter().max().map_or(0, |last| last + 1);
    let own = |k: usize| known.iter().zip(&channels).filter(move |(_, own)| **own == k).map(|(&i, _)| i);
    (0..count).map(|k| own(k).collect()).collect()
}

/// The coordinate of the first reading of each datum's run, at which its zero is taken.
pub(super) fn starts(coordinate: &Coordinate, data: &[Datum]) -> Coordinate {
    let runs = data.iter().map(|d| d.run + 1).max().unwrap_or(0);
    let mut first: Coordinate = vec![None; runs];
    for (datum, x) in data.iter().zip(coordinate) {
        let known = &mut first[datum.run];
        *known = match (*known, *x) {
            (Some(known), Some(x)) => Some(x.min(known)),
            (known, x) => known.or(x),
        };
    }
    data.iter().map(|d| first[d.run]).collect()
}
