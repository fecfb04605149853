//! The measurement that would tell a finding from its rivals.

use super::RigWorld;
use crate::diagnosis::{Diagnosis, Evidence, Finding};
use crate::error::Result;
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// A measurement to make next.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// In the user's words; a full sentence.
    pub words: String,
    /// By how much it would tell the finding from its closest rival: ln of the odds that are expected.
    pub log_odds: f64,
    /// What it tells the finding from: effect and place.
    pub rivals: Vec<(String, String)>,
}

/// The feasible measurement that best tells `finding` from all its rivals; `None` where it has none.
pub(super) fn next_measurement(
    _readings: &Readings,
    _rod: Option<&Rod>,
    _world: &RigWorld,
    _evidence: &Evidence,
    _diagnosis: &Diagnosis,
    _finding: &Finding,
) -> Result<Option<Proposal>> {
    Ok(None)
}
