//! What readings say about a rig: the engine's diagnosis with what only the rig knows.

use super::RigWorld;
use super::correction::Correction;
use super::limits::{Limit, NotTestable, limits, not_testable};
use super::next::{Proposal, next_measurement};
use crate::diagnosis::{Diagnosis, Evidence, diagnose as of_world};
use crate::error::Result;
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// A rig's diagnosis.
#[derive(Debug, Clone)]
pub struct RigDiagnosis {
    /// The physics that was asked about.
    pub world: RigWorld,
    /// The recording as numbers.
    pub evidence: Evidence,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// Effects that these readings cannot show, with the reason.
    pub not_testable: Vec<NotTestable>,
    /// What makes every claim weaker.
    pub limits: Vec<Limit>,
    /// For each finding the measurement that would tell it from its rivals; `None` where it has none.
    pub next: Vec<Option<Proposal>>,
    /// The rod and its compliance with what was found; `None` without a rod, or where nothing was found.
    pub correction: Option<Correction>,
}

/// Diagnoses `readings` against the FEA model of `rod` as its file gives it, or, without a rod, against straight lines
/// through the origin.
///
/// # Errors
/// See [`RigWorld::new`]; what the beam model refuses of the corrected rod.
pub fn diagnose(readings: &Readings, rod: Option<&Rod>) -> Result<RigDiagnosis> {
    let (world, evidence) = RigWorld::new(readings, rod)?;
    let diagnosis = of_world(&world, &evidence);
    let next = diagnosis
        .findings
        .iter()
        .map(|finding| next_measurement(readings, rod, &world, &evidence, &diagnosis, finding))
        .collect::<Result<_>>()?;
    let correction = match rod {
        Some(rod) if !diagnosis.findings.is_empty() => {
            Some(Correction::new(rod, readings, &world, &diagnosis)?)
        }
        _ => None,
    };
    Ok(RigDiagnosis {
        not_testable: not_testable(&world, rod),
        limits: limits(&world, &evidence),
        next,
        correction,
        diagnosis,
        evidence,
        world,
    })
}
