//! A contact force that was stated in another unit.
//!
//! It bends the rod as if it were softer, or as if more were pushed: what is named for that has the
//! unit as its rival, where the interval holds it.
//!
//! ```text
//! s ∋ k,    δ ∋ (k − 1)·F      k the newtons of a kilogram or a pound, s a rod's softness under F, δ what is pushed beyond F
//! ```

use nalgebra::Vector3;

use super::super::effects::contact::CONTACT_FORCE_VARIATION;
use super::super::effects::mistakes::UNIT_MISTAKE;
use super::super::model::CalibrationModel;
use super::super::model::law::{Law, RodLoad};
use crate::inference::{Diagnosis, Estimate, Finding, FindingPart, Location, Rival};
use crate::units::{POUND_FORCE, STANDARD_GRAVITY};

/// Units that a force may be in, N.
pub const UNITS: [f64; 2] = [STANDARD_GRAVITY, POUND_FORCE];

/// Adds the rival, for a campaign whose contact force is `stated`, N in the frames of its devices.
pub fn add_rivals(model: &CalibrationModel, stated: Option<Vector3<f64>>, diagnosis: &mut Diagnosis) {
    let Some(force) = stated else { return };
    for finding in &mut diagnosis.findings {
        if UNITS.into_iter().any(|unit| is_in(unit, &force, finding, model)) {
            // a file is sooner looked at than anything is measured
            let location = Location::key("contact_force_n");
            finding.rivals.insert(0, Rival::without_term(&UNIT_MISTAKE, location, 1.0));
        }
    }
}

fn is_in(unit: f64, force: &Vector3<f64>, finding: &Finding, model: &CalibrationModel) -> bool {
    let [part] = &finding.parts[..] else { return false };
    let holds = |estimate: &Estimate, value: f64| estimate.low < value && value < estimate.high;
    let is_softer = |part: &FindingPart| {
        matches!(model.law(part.term.candidate), Law::Rod(RodLoad::Contact))
            && holds(&part.estimates[0], unit)
    };
    let is_pushed = |part: &FindingPart| {
        let beyond = force * (unit - 1.0);
        let is_everywhere =
            *finding.effect == CONTACT_FORCE_VARIATION.effect && finding.location == Location::AllClamps;
        is_everywhere && part.estimates.iter().zip(beyond.iter()).all(|(own, beyond)| holds(own, *beyond))
    };
    is_softer(part) || is_pushed(part)
}
