//! Whether a finding is where the effect was concealed: places as data, none of their texts.

use crate::effect_name::EffectName;
use crate::ground_truth::{Concealed, GroundTruth};
use crate::place::Place;

/// Scans for joints are not finer than this, mm: an answer so far beyond the stations that cannot
/// be distinguished counts.
const SCAN_MM: f64 = 10.0;

/// True where a finding of the right name, at `place`, is at the right place; without a place it is
/// not.
///
/// Of joints of a rod the station counts, by name or by number; of a slip its run; of what is
/// several things at once any of them; of a key also what is said more closely (`dy_um, axis y`, or
/// `dy_um, axis y, trial 2` of `dy_um, trial 2`); of all others the place itself or one that nobody
/// could distinguish from it.
pub fn is_same(truth: &GroundTruth, concealed: &Concealed, place: Option<&Place>) -> bool {
    let Some(place) = place.filter(|place| !place.is_nowhere()) else { return false };
    let detectability = &concealed.detectability;
    let known = || std::iter::once(&concealed.place).chain(&detectability.places);
    if known().any(|known| known == place) {
        return true;
    }
    if !place.all.is_empty() {
        return place.all.iter().any(|one| is_same(truth, concealed, Some(one)));
    }
    if known().any(|known| known.all.contains(place)) {
        return true;
    }
    match concealed.effect {
        EffectName::JointCompliance => match (station(truth, place), detectability.stations_mm) {
            (Some(station), Some([low, high])) => (low - SCAN_MM..=high + SCAN_MM).contains(&station),
            _ => false,
        },
        EffectName::Slip => {
            let run = |place: &Place| Place { after_row: None, channel: None, ..place.clone() };
            let is_between = |place: &Place| place.channel.is_some();
            known().any(|known| {
                run(known) == run(place) && (known.channel == place.channel || !is_between(known))
            })
        }
        // all nine errors of a device hold the one of them
        EffectName::SensorScale => (concealed.place.name.as_deref())
            .is_some_and(|name| place.name.as_deref() == name.split(Place::CLOSER).next()),
        // frames turned as a whole, about one axis or about all
        EffectName::SensorMisalignment | EffectName::LoadMisalignment => {
            is_frame(place) && known().any(is_frame)
        }
        _ => match (&place.key, &concealed.place.key) {
            (Some(answered), Some(key)) => answered.refines(key),
            _ => false,
        },
    }
}

fn is_frame(place: &Place) -> bool {
    place.about.is_some() || place.part.is_some()
}

/// Station of a place on the rod, mm.
fn station(truth: &GroundTruth, place: &Place) -> Option<f64> {
    let declared = place.name.as_ref().and_then(|name| truth.joints.get(name).copied());
    declared.or(place.station_mm)
}
