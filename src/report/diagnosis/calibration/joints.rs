//! Which joint something is about.

use crate::diagnosis::calibration::{CalibrationDiagnosis, Gear};
use crate::inference::{Finding, JointVariable, Variable};

/// The joint, from 0, whose gear a finding is about.
pub fn gear_of(found: &CalibrationDiagnosis, finding: &Finding) -> Option<usize> {
    finding.parts.first().and_then(|part| found.model.gear_of(part)).map(Gear::joint)
}

/// The joint, from 0, and its number that a covariate is.
pub fn joint_of(variable: Variable) -> Option<(usize, JointVariable)> {
    match variable {
        Variable::Joint(joint, what) => Some((joint, what)),
        _ => None,
    }
}
