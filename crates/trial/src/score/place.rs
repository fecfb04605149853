//! Whether a finding is where the effect was concealed: places as data, none of their texts.

use crate::place::Place;
use crate::truth::{Concealed, Truth};

/// Scans for joints are not finer than this, mm: an answer so far beyond the stations that cannot
/// be distinguished counts.
const SCAN_MM: f64 = 10.0;

/// True where a finding of the right name, at `place`, is at the right place; without a place it is
/// not.
///
/// Of joints of a rod the station counts, by name or by number; of a slip its run; of what is
/// several things at once any of them; of a key
/// also what is said more closely (`dy_um, axis y`, or `dy_um, axis y, trial 2` of `dy_um, trial
/// 2`);
/// of all others the place itself or one that nobody could distinguish from it.
pub fn is_same(truth: &Truth, concealed: &Concealed, place: Option<&Place>) -> bool {
    let Some(place) = place.filter(|place| !place.is_nowhere()) else { return false };
    let of = &concealed.detectability;
    let known = || std::iter::once(&concealed.place).chain(&of.places);
    if known().any(|known| known == place) {
        return true;
    }
    if !place.all.is_empty() {
        return place.all.iter().any(|one| is_same(truth, concealed, Some(one)));
    }
    if known().any(|known| known.all.contains(place)) {
        return true;
    }
    let is_rig = truth.case.starts_with("rig/");
    match concealed.effect.as_str() {
        "joint_compliance" if is_rig => match (station(truth, place), of.stations_mm) {
            (Some(station), Some([low, high])) => (low - SCAN_MM..=high + SCAN_MM).contains(&station),
            _ => false,
        },
        "slip" => {
            let run = |place: &Place| Place { after_row: None, channel: None, ..place.clone() };
            let is_between = |place: &Place| place.channel.is_some();
            known().any(|known| {
                run(known) == run(place) && (known.channel == place.channel || !is_between(known))
            })
        }
        // frames turned as a whole, about one axis or about all
        "sensor_misalignment" | "load_misalignment" => is_frame(place) && known().any(is_frame),
        _ => match (&place.key, &concealed.place.key) {
            (Some(said), Some(key)) => {
                let is_closer = said.strip_prefix(key.as_str()).is_some_and(|more| more.starts_with(','));
                let mut parts = key.split(", ");
                let said: Vec<&str> = said.split(", ").collect();
                is_closer || parts.next() == said.first().copied() && parts.all(|part| said.contains(&part))
            }
            _ => false,
        },
    }
}

fn is_frame(place: &Place) -> bool {
    place.about.is_some() || place.part.is_some()
}

/// Station of a place on the rod, mm.
fn station(truth: &Truth, place: &Place) -> Option<f64> {
    let declared = place.name.as_ref().and_then(|name| truth.joints.get(name).copied());
    declared.or(place.station_mm)
}
