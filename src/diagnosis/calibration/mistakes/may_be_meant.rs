//! Other rods of the same folder, and a contact force in another unit, as what a number of the rod
//! or a force that differs may be.
//!
//! The search for mistakes names what fits far better. Where a rod bends by a few hundredths of a
//! millimetre the poses say little, and another number is found instead. So each is calibrated
//! with, and is a rival where the poses are about as probable with it.

use super::super::diagnose::CalibrationDiagnosis;
use super::super::diagnose::hung::{beside_hidden_masses, may_bend, may_hide};
use super::super::diagnose::prepared::{FirstLook, Prepared};
use super::super::effects::contact::CONTACT_FORCE_VARIATION;
use super::super::effects::mistakes::{ROD_MISTAKE, UNIT_MISTAKE};
use super::super::model::law::Law;
use super::search::ALIKE;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Mode, Options, calibrate};
use crate::diagnosis::Limitation;
use crate::inference::{Diagnosis, Finding, Location, Rival, sketch};
use crate::units::{POUND_FORCE, STANDARD_GRAVITY};

/// Units that a force may be in, N.
const UNITS: [f64; 2] = [STANDARD_GRAVITY, POUND_FORCE];

/// How probable the poses are with other rods.
#[derive(Debug, Clone)]
pub(super) struct ComparedRods {
    /// Ln with the stated rod.
    pub known: f64,
    /// Files, and ln with each.
    pub others: Vec<(String, f64)>,
}

impl ComparedRods {
    /// The files that stand beside the stated one, and the odds against each; less than 1 where it
    /// is the more probable one.
    pub fn alike(&self) -> impl Iterator<Item = (&String, f64)> {
        let odds = self.others.iter().map(|(file, other)| (file, self.known - other));
        odds.filter(|(_, against)| *against < ALIKE).map(|(file, against)| (file, against.exp()))
    }

    /// What is to be said of them beside a diagnosis that names none.
    pub fn limits(&self, diagnosis: &Diagnosis) -> Vec<Limitation> {
        let is_said = |file: &str| {
            let place = Location::key(file);
            let findings = diagnosis.findings.iter();
            let mut rivals = findings.flat_map(|finding| &finding.rivals);
            rivals.any(|rival| *rival.effect == ROD_MISTAKE && rival.location == place)
        };
        let open = self.alike().filter(|(file, _)| !is_said(file));
        open.map(|(file, against)| Limitation::AnotherRod(file.clone(), 1.0 / against)).collect()
    }
}

/// A number of the files in another unit.
#[derive(Debug, Clone)]
pub(super) struct OtherUnit {
    /// Of which key.
    pub key: String,
    /// Ln of the odds against it.
    pub against: f64,
}

impl OtherUnit {
    /// The odds against it, 1 at least.
    pub fn odds(&self) -> f64 {
        self.against.max(0.0).exp()
    }
}

/// Adds what may be meant, of the rods and units that were compared, to what was found of rod
/// and force.
pub fn add_rivals(
    campaign: &Campaign,
    rods: Option<&ComparedRods>,
    units: &[OtherUnit],
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
    for (file, odds) in rods.iter().flat_map(|rods| rods.alike()) {
        let rival = Rival::without_term(&ROD_MISTAKE, Location::key(file), odds.max(1.0));
        add(&mut found.diagnosis.findings[position], rival);
    }
    for unit in units.iter().filter(|unit| unit.against < ALIKE) {
        let rival = Rival::without_term(&UNIT_MISTAKE, Location::key(&unit.key), unit.odds());
        add(&mut found.diagnosis.findings[position], rival);
    }
    let Some(known) = calibrated(campaign, mode, options) else { return };
    for other in in_other_units(campaign, mode, options) {
        if other + ALIKE > known {
            let odds = (known - other).max(0.0).exp();
            let rival = Rival::without_term(&UNIT_MISTAKE, Location::key("contact_force_n"), odds);
            add(&mut found.diagnosis.findings[position], rival);
        }
    }
}

/// Ln of the probability of the poses with the contact force in each unit that it may be in.
pub(super) fn in_other_units(campaign: &Campaign, mode: Mode, options: &Options) -> Vec<f64> {
    let with = |unit: &f64| {
        let contact_force = Some(campaign.contact_force? * *unit);
        calibrated(&Campaign { contact_force, ..campaign.clone() }, mode, options)
    };
    UNITS.iter().filter_map(with).collect()
}

/// A file is sooner looked at than anything is measured.
fn add(finding: &mut Finding, rival: Rival) {
    let is_it = |own: &Rival| own.effect == rival.effect && own.location == rival.location;
    if !finding.rivals.iter().any(is_it) {
        finding.rivals.insert(0, rival);
    }
}

fn calibrated(campaign: &Campaign, mode: Mode, options: &Options) -> Option<f64> {
    log_probability(campaign, calibrate(campaign, mode, options).ok()?)
}

/// How well poses are explained.
pub(super) struct Explained {
    /// Ln of their probability with all that explains them best.
    pub log_probability: f64,
    /// True where a load, or a rod, is part of it.
    pub bears_load: bool,
}

/// How well poses are explained about a calibration.
pub(super) fn explained(campaign: &Campaign, calibration: Calibration) -> Option<Explained> {
    let prepared = Prepared::new(campaign, calibration).ok()?;
    let found = sketch(&prepared.model, &prepared.evidence);
    let bears_load = may_hide(&prepared, &found.hypothesis);
    Some(Explained { log_probability: found.log_probability, bears_load })
}

/// Ln of the probability of the poses with all that explains them best.
pub(super) fn log_probability(campaign: &Campaign, calibration: Calibration) -> Option<f64> {
    Some(explained(campaign, calibration)?.log_probability)
}

/// The same, or that with a mass which the calibration has hidden, where it is more probable.
pub(super) fn beside_masses(campaign: &Campaign, calibration: Calibration) -> Option<f64> {
    let prepared = Prepared::new(campaign, calibration).ok()?;
    if !may_bend(&prepared) {
        return Some(sketch(&prepared.model, &prepared.evidence).log_probability);
    }
    Some(beside_hidden_masses(campaign, prepared, &FirstLook::default()).ok()?.log_probability)
}
