//! Other rods of the same folder, and a contact force in another unit, as what a number of the rod
//! or a force that differs may be.
//!
//! The search for mistakes names what fits far better. Where a rod bends by a few hundredths of a
//! millimetre the poses say little, and another number is found instead. So each is calibrated
//! with, and is a rival where the poses are about as probable with it.

use super::super::diagnose::CalibrationDiagnosis;
use super::super::diagnose::prepared::Prepared;
use super::super::effects::contact::CONTACT_FORCE_VARIATION;
use super::super::effects::mistakes::{ROD_MISTAKE, UNIT_MISTAKE};
use super::super::model::law::Law;
use super::search::ALIKE;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Mode, Options, calibrate};
use crate::inference::{Effect, Finding, Location, Rival, sketch};
use crate::rod::Rod;
use crate::units::{POUND_FORCE, STANDARD_GRAVITY};

/// Tips that are farther apart, as a share of the rod's length, are seen as such.
const ANOTHER_TIP: f64 = 0.03;
/// So many rods are tried.
const MOST: usize = 4;
/// Units that a force may be in, N.
const UNITS: [f64; 2] = [STANDARD_GRAVITY, POUND_FORCE];

/// Adds what may be meant, of the files `rods` and the units, to what was found of rod and force.
pub fn add_rivals(
    campaign: &Campaign,
    rods: &[(String, Rod)],
    options: &Options,
    found: &mut CalibrationDiagnosis,
) {
    let model = &found.model;
    // a mass at its tip or at the flange may be that of the rod as well
    let is_of_rod = |finding: &Finding| {
        let is_rod = |law: &Law| matches!(law, Law::Rod(_) | Law::Hung(_));
        *finding.effect == CONTACT_FORCE_VARIATION.effect
            || finding.parts.iter().any(|part| is_rod(model.law(part.term.candidate)))
    };
    let Some(position) = found.diagnosis.findings.iter().position(is_of_rod) else { return };
    let mode = model.calibration.mode;
    let Some(known) = log_probability(campaign, mode, options) else { return };
    for (effect, location, other, mode) in meant(campaign, rods, mode) {
        let finding = &mut found.diagnosis.findings[position];
        let is_known = finding.rivals.iter().any(|own| own.effect == effect && own.location == location);
        let Some(other) = log_probability(&other, mode, options).filter(|_| !is_known) else { continue };
        if other + ALIKE > known {
            // a file is sooner looked at than anything is measured
            let odds = (known - other).max(0.0).exp();
            finding.rivals.insert(0, Rival::without_term(effect, location, odds));
        }
    }
}

/// Campaigns with another rod, or another unit of the force.
fn meant(
    campaign: &Campaign,
    rods: &[(String, Rod)],
    mode: Mode,
) -> Vec<(&'static Effect, Location, Campaign, Mode)> {
    // the readings of a rig are those of the rod that was on it
    let of_file = if mode == Mode::Meas { Mode::Fea } else { mode };
    let tip = campaign.rod.as_ref().map(Rod::tip);
    let is_near = |rod: &Rod| tip.is_some_and(|tip| (rod.tip() - tip).norm() < ANOTHER_TIP * tip.norm());
    let with_rod = |(file, rod): &(String, Rod)| {
        let with = Campaign { rod: Some(rod.clone()), readings: None, ..campaign.clone() };
        (&ROD_MISTAKE, Location::key(file), with, of_file)
    };
    let with_force = |unit: f64| {
        let force = campaign.contact_force.map(|force| force * unit)?;
        let with = Campaign { contact_force: Some(force), ..campaign.clone() };
        Some((&UNIT_MISTAKE, Location::key("contact_force_n"), with, mode))
    };
    let rods = rods.iter().filter(|(_, rod)| is_near(rod)).take(MOST).map(with_rod);
    rods.chain(UNITS.into_iter().filter_map(with_force)).collect()
}

/// Ln of the probability of the poses with all that explains them best.
fn log_probability(campaign: &Campaign, mode: Mode, options: &Options) -> Option<f64> {
    let calibration = calibrate(campaign, mode, options).ok()?;
    let prepared = Prepared::new(campaign, calibration).ok()?;
    Some(sketch(&prepared.model, &prepared.evidence).log_probability)
}
