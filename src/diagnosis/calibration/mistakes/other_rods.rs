//! Other rods of the same folder, as what a rod of another stiffness or mass may be.
//!
//! The search for mistakes names one that fits far better. Of rods of one length, which bend by a
//! few hundredths of a millimetre, the poses say little, and a number of the rod is found instead.
//! So each is calibrated with, and is a rival where the poses are about as probable with it.

use super::super::diagnose::CalibrationDiagnosis;
use super::super::diagnose::prepared::Prepared;
use super::super::effects::mistakes::ROD_MISTAKE;
use super::super::model::law::{Hung, Law};
use super::search::ALIKE;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Mode, Options, calibrate};
use crate::inference::{Finding, Location, Rival, sketch};
use crate::rod::Rod;

/// Tips that are farther apart, as a share of the rod's length, are seen as such.
const ANOTHER_TIP: f64 = 0.03;
/// So many rods are tried.
const MOST: usize = 4;

/// Adds the rods of `rods`, by their files, to what was found of the campaign's rod.
pub fn add_rivals(
    campaign: &Campaign,
    rods: &[(String, Rod)],
    options: &Options,
    found: &mut CalibrationDiagnosis,
) {
    let (Some(own), mode) = (&campaign.rod, found.model.calibration.mode) else { return };
    let model = &found.model;
    let is_rod = |finding: &Finding| {
        let is_of_rod = |law: &Law| matches!(law, Law::Rod(_) | Law::Hung(Hung::Rod));
        finding.parts.iter().any(|part| is_of_rod(model.law(part.term.candidate)))
    };
    let Some(position) = found.diagnosis.findings.iter().position(is_rod) else { return };
    let is_near = |rod: &Rod| (rod.tip() - own.tip()).norm() < ANOTHER_TIP * own.tip().norm();
    let Some(known) = log_probability(campaign, mode, options) else { return };
    // the readings of a rig are those of the rod that was on it
    let mode = if mode == Mode::Meas { Mode::Fea } else { mode };
    for (file, rod) in rods.iter().filter(|(_, rod)| is_near(rod)).take(MOST) {
        let with = Campaign { rod: Some(rod.clone()), readings: None, ..campaign.clone() };
        let Some(other) = log_probability(&with, mode, options) else { continue };
        if other + ALIKE > known {
            // a file is sooner looked at than anything is measured
            let rival =
                Rival::without_term(&ROD_MISTAKE, Location::key(file), (known - other).max(0.0).exp());
            found.diagnosis.findings[position].rivals.insert(0, rival);
        }
    }
}

/// Ln of the probability of the poses with all that explains them best.
fn log_probability(campaign: &Campaign, mode: Mode, options: &Options) -> Option<f64> {
    let calibration = calibrate(campaign, mode, options).ok()?;
    let prepared = Prepared::new(campaign, calibration).ok()?;
    Some(sketch(&prepared.model, &prepared.evidence).log_probability)
}
