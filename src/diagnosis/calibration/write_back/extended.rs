//! A campaign with what was found of it.

use super::destination::{write, write_law};
use crate::calibration::campaign::Campaign;
use crate::diagnosis::calibration::CalibrationDiagnosis;
use crate::inference::law::{Law, Proposed};
use crate::inference::{Finding, WrittenTo};

/// A campaign with what was found: the nominal robot with it, the measured points without it.
pub struct Extended {
    /// The campaign, to be calibrated again.
    pub campaign: Campaign,
    /// What entered the model, for people.
    pub entered: Vec<String>,
    /// What was taken out of the measured points, or made another socket.
    pub removed: Vec<String>,
    /// What nothing can hold.
    pub left_out: Vec<String>,
}

impl Extended {
    /// With all that was found; `None` where nothing of it could be written.
    pub fn of(found: &CalibrationDiagnosis) -> Option<Extended> {
        let model = &found.model;
        let mut campaign = model.campaign.clone();
        let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
        let mut put = |destination: WrittenTo, description: String| match destination {
            WrittenTo::Model => entered.push(description),
            WrittenTo::Recording => removed.push(description),
            WrittenTo::Nowhere => left_out.push(description),
        };
        let law = proposed(found).and_then(|proposed| proposed.law.as_ref().ok());
        // what was undone before there was a model is nothing to write into it
        for finding in found.diagnosis.findings.iter().filter(|finding| finding.is_of_model()) {
            let cause = (finding.effect.cause_at)(&finding.location);
            let finding = beside(law, finding);
            put(write(&finding, model, &mut campaign), cause);
        }
        for law in law.into_iter().flat_map(Law::all) {
            let (destination, description) = write_law(law, model, &mut campaign);
            put(destination, description);
        }
        if entered.is_empty() && removed.is_empty() {
            return None;
        }
        campaign.take_up_moves();
        Some(Extended { campaign, entered, removed, left_out })
    }
}

/// What is proposed as a law; `None` where there is no law.
pub fn proposed<'f>(found: &'f CalibrationDiagnosis) -> Option<&'f Proposed> {
    found.law.as_ref().filter(|proposed| proposed.law.is_ok())
}

/// A finding as it is beside the law.
fn beside(law: Option<&Law>, finding: &Finding) -> Finding {
    let mut finding = finding.clone();
    let terms = law.map_or(&[][..], |law| &law.beside.terms);
    for part in &mut finding.parts {
        if let Some(term) = terms.iter().find(|term| term.candidate == part.term.candidate) {
            part.term = term.clone();
        }
    }
    finding
}
