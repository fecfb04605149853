//! Which joint something is about.

use crate::inference::{JointVariable, Variable};

/// The joint, from 0, and its number that a covariate is.
pub fn joint_of(variable: Variable) -> Option<(usize, JointVariable)> {
    match variable {
        Variable::Joint(joint, what) => Some((joint, what)),
        _ => None,
    }
}
