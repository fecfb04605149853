//! A distance of the sockets that is not the one stated: in another unit, or another number.
//!
//! Angles and the robot's drawing say how far apart the sockets of a placement are, to half a
//! per cent or so: a calibration that believes another distance makes the whole arm longer or
//! shorter, and fits as well.

use super::Mended;
use super::moves::exact;
use super::search::{FittedDraft, MistakeSearch};
use crate::calibration::campaign::{Distance, Recording, Targets};
use crate::diagnosis::calibration::effects::mistakes::{DISTANCE_MISTAKE, UNIT_MISTAKE};
use crate::inference::{Estimate, Location};
use crate::statistics::{HALF_95, chi_squared_survival, median};
use crate::units::{MM, significant};

/// The key, as it stands in the campaign.
const KEY: &str = "sockets.distance_mm";
/// So many standard deviations, and such a share of the distance, are no accident.
const SURE: f64 = 6.0;
const LEAST: f64 = 0.02;
/// Share of the placements that have to agree.
const AGREE: f64 = 0.6;
/// Units in which the number may stand.
const UNITS: [(f64, &str); 6] = [
    (10.0, "centimetres"),
    (1e3, "metres"),
    (25.4, "inches"),
    (100.0, "decimetres"),
    (1e-3, "micrometres"),
    (0.0254, "mils"),
];

/// What the poses say of the distance of the sockets.
struct Measured {
    stated: Distance,
    value: f64,
    sd: f64,
}

impl Mended {
    /// The distance of the sockets, where poses and drawing contradict the one stated.
    pub(super) fn add_distance(&mut self, search: &MistakeSearch, best: &FittedDraft) {
        if search.has_failed(best) {
            return;
        }
        let Some(measured) = measured(&self.campaign.measurements, search, best) else { return };
        let Measured { stated, value, sd } = measured;
        let off = (value - stated.value).abs();
        let z = off / sd.hypot(stated.sd);
        if z < SURE || off < LEAST * stated.value {
            return;
        }
        let fits = |factor: f64| (stated.value * factor - value).abs() < SURE * sd.hypot(stated.sd);
        let half = HALF_95 * sd;
        let (digits, uncertain) = (significant(value / MM, 4), significant(half / MM, 2));
        let number = (stated.value / MM * 1e6).round() / 1e6;
        let there = format!("by angles and drawing the sockets are {digits} ± {uncertain} mm apart");
        let key = Location::key(KEY);
        let log_odds = -chi_squared_survival(z * z, 1.0).unwrap_or(0.0).ln();
        let meant = match UNITS.iter().find(|(factor, _)| fits(*factor)) {
            Some((factor, unit)) => {
                let cure = format!("Multiply {KEY} by {factor}");
                let why = format!("it is in {unit}, not in millimetres ({there})");
                self.add(&UNIT_MISTAKE, key, exact("factor", *factor), (&cure, &why), log_odds);
                Distance { value: stated.value * factor, ..stated }
            }
            None => {
                let (low, high) = ((value - half) / MM, (value + half) / MM);
                let estimate = Estimate::as_written("mm", value / MM, low, high);
                let cure = format!("Write {digits} for {number} as {KEY}");
                self.add(&DISTANCE_MISTAKE, key, vec![estimate], (&cure, &there), log_odds);
                Distance { value, sd, ..stated }
            }
        };
        if let Some(finding) = self.found.last_mut() {
            // each socket is half of it off, in a direction that nobody knows
            finding.explains = off / 12.0f64.sqrt();
            finding.next = finding.direct_check(&[]);
        }
        let validation = self.campaign.validation.as_mut();
        for recording in std::iter::once(&mut self.campaign.measurements).chain(validation) {
            let Targets::Sockets(distances) = &mut recording.targets else { continue };
            distances.iter_mut().for_each(|own| (own.value, own.sd) = (meant.value, meant.sd));
        }
        self.is_changed = true;
    }
}

/// The middle of the placements, where most of them agree.
fn measured(recording: &Recording, search: &MistakeSearch, best: &FittedDraft) -> Option<Measured> {
    let Targets::Sockets(distances) = &recording.targets else { return None };
    let stated = *distances.first()?;
    let draft = search.changed(&best.steps);
    let body = &search.bodies[draft.body];
    let all: Vec<(f64, f64)> =
        distances.iter().filter_map(|own| best.fit.distance(&draft, body, own.between)).collect();
    let (values, sds): (Vec<f64>, Vec<f64>) = all.iter().copied().unzip();
    let (value, sd) = (median(&values)?, median(&sds)?);
    let agreeing = all.iter().filter(|(own, sd)| (own - value).abs() < SURE * sd).count();
    (agreeing as f64 >= AGREE * all.len() as f64).then_some(Measured { stated, value, sd })
}
