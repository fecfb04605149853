//! Whether a finding is where the effect was concealed.

use crate::truth::{Concealed, Truth};

/// Scans for joints are not finer than this, mm: an answer so far beyond the stations that cannot be told apart counts.
const SCAN_MM: f64 = 10.0;

/// True where a finding of the right name, at `location`, is at the right place.
///
/// Of joints the station counts, by name or by number; of a slip its run; of what repeats a place with a remark
/// (`rod, since each load`) the place without it; of all others the place itself or one that nobody could tell from it.
pub fn is_same(truth: &Truth, concealed: &Concealed, location: &str) -> bool {
    let of = &concealed.detectability;
    let is_listed = |place: &str| place == concealed.location || of.places.iter().any(|known| known == place);
    if is_listed(location) {
        return true;
    }
    let first = |place: &str| place.split(',').next().unwrap_or_default().trim().to_owned();
    // of what concerns one joint the joint counts, of several outliers any
    let is_calibration = truth.case.starts_with("calibration/");
    match concealed.effect.as_str() {
        "transmission_error"
        | "backlash"
        | "joint_compliance"
        | "joint_nonlinear_stiffness"
        | "rod_stiffness"
        | "readback_lag"
            if is_calibration =>
        {
            first(location) == first(&concealed.location)
        }
        "outlier" if is_calibration => {
            location.split("; ").any(|pose| concealed.location.split("; ").any(|other| other == pose))
        }
        "joint_compliance" => match (station(truth, location), of.stations_mm) {
            (Some(station), Some([low, high])) => (low - SCAN_MM..=high + SCAN_MM).contains(&station),
            _ => false,
        },
        "slip" => {
            let run = |place: &str| place.split(", after").next().unwrap_or_default().to_owned();
            run(location) == run(&concealed.location)
        }
        "thermal_drift" | "creep" | "hysteresis" => first(location) == first(&concealed.location),
        "outlier" => concealed.location.split("; ").any(|cell| cell == location),
        _ => false,
    }
}

/// Station of a place on the rod, mm.
fn station(truth: &Truth, location: &str) -> Option<f64> {
    match truth.joints.get(location) {
        Some(station) => Some(*station),
        None => location.strip_prefix("station ")?.strip_suffix(" mm")?.parse().ok(),
    }
}
