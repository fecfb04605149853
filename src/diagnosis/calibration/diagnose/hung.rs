//! A mass that nobody stated, where the calibration has hidden it.
//!
//! Half a kilogram at the tip is more torque on the wrist than rod and ball are, so that a
//! calibration that knows of none turns its weight into soft drives, about which a mass at the tip
//! draws something else: a rod that bends under its weight is then nearer to what is left. Where
//! rod or masses are what is found, each mass is therefore sought as the calibration itself would
//! see it, by its residual,
//!
//! ```text
//! m = argmin_m  min_ρ |recorded − predicted(ρ; m)|²
//! ```
//!
//! and the search is made about that robot too.

use super::beside::{Loads, calibrated_with};
use super::prepared::Prepared;
use crate::calibration::Calibration;
use crate::diagnosis::calibration::model::law::{Hung, Law};
use crate::error::Result;
use crate::inference::Hypothesis;

/// Of more rows each calibration takes too long.
const MOST_ROWS: usize = 2000;
/// Masses at the tip that are tried first, kg, and at the flange.
const TRIED: [(Hung, [f64; 4]); 2] =
    [(Hung::Tip, [0.1, 0.3, 0.6, 1.0]), (Hung::Flange, [0.5, 1.5, 3.0, 6.0])];
/// Times that the steps about the best one are halved.
const HALVED: usize = 4;

/// True where what was found bends rod or drives as a mass would.
pub fn may_hide(prepared: &Prepared, hypothesis: &Hypothesis) -> bool {
    prepared.model.campaign.measurements.len() <= MOST_ROWS && !acting_alike(prepared, hypothesis).is_empty()
}

/// The laws of rod and masses that a hypothesis holds.
fn acting_alike<'p>(prepared: &'p Prepared, hypothesis: &Hypothesis) -> Vec<&'p Law> {
    let laws = hypothesis.terms.iter().map(|term| prepared.model.law(term.candidate));
    laws.filter(|law| matches!(law, Law::Rod(_) | Law::Hung(_))).collect()
}

/// Robots beside a mass that may be all that rod and masses of a hypothesis stand for, the rows as
/// if nothing hung there.
pub fn beside_masses<'c>(prepared: &Prepared<'c>, hypothesis: &Hypothesis) -> Result<Vec<Calibration<'c>>> {
    let model = &prepared.model;
    let law = |candidate: usize| model.law(candidate);
    let known = acting_alike(prepared, hypothesis);
    let is_found = |own: Hung| known[..] == [&Law::Hung(own)];
    let is_possible = |own: Hung| (0..model.terms.candidates.len()).any(|k| *law(k) == Law::Hung(own));
    let mut found = Vec::new();
    for (own, masses) in TRIED {
        if is_found(own) || !is_possible(own) {
            continue;
        }
        let with =
            |mass: f64| calibrated_with(prepared, &Loads { hung: vec![(own, mass)], displaced: Vec::new() });
        let left = |mass: f64| -> Result<f64> {
            Ok(with(mass)?
                .map_or(f64::INFINITY, |beside| beside.0.deviations.iter().map(|d| d.norm_squared()).sum()))
        };
        let mut best = (0.0, f64::INFINITY);
        for mass in masses {
            let left = left(mass)?;
            if left < best.1 {
                best = (mass, left);
            }
        }
        let mut step = best.0 / 2.0;
        for _ in 0..HALVED {
            for mass in [best.0 - step, best.0 + step] {
                let left = left(mass)?;
                if left < best.1 {
                    best = (mass, left);
                }
            }
            step /= 2.0;
        }
        found.extend(with(best.0)?.map(|(_, about)| about));
    }
    Ok(found)
}
