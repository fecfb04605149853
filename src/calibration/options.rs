//! How to calibrate.

use super::noise::Robust;

/// How to calibrate.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// What an outlier counts.
    pub robust: Robust,
    /// Hold numbers of the robot that the data do not support at their nominal values.
    pub prune: bool,
}
