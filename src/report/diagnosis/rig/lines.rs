//! Names of lines of readings: one channel under loads along one axis.

use crate::diagnosis::rig::Datum;
use crate::rig::readings::Phase;
use crate::units::MM;

/// What is one line of readings, for example `dy under loads along y`.
pub fn line_name(datum: &Datum) -> String {
    let at = |what: &str, station: Option<f64>| {
        station.map_or_else(String::new, |s| format!(", {what} at {:.1} mm", s / MM))
    };
    let session = datum.session.as_ref().map_or_else(String::new, |session| format!(", session {session}"));
    format!(
        "d{} under loads along {}{}{}{session}",
        datum.channel,
        datum.direction.axis,
        at("loaded", datum.load_station),
        at("read", datum.read_station)
    )
}

/// A line, and its way down by itself.
pub fn branch_name(datum: &Datum) -> String {
    let down = if datum.phase == Some(Phase::Unload) { ", unloading" } else { "" };
    line_name(datum) + down
}
