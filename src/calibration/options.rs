//! How to calibrate.

use super::noise::Robust;

/// How to calibrate.
///
/// ```
/// use rodcal::calibration::{Options, Robust};
///
/// let options = Options::default().with_robust(Robust::Huber).with_pruning(true);
/// assert!(options.robust == Robust::Huber && options.prune);
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct Options {
    /// What an outlier counts.
    pub robust: Robust,
    /// Hold numbers of the robot that the data do not support at their nominal values.
    pub prune: bool,
}

impl Options {
    /// With outliers that count so much.
    pub fn with_robust(self, robust: Robust) -> Options {
        Options { robust, ..self }
    }

    /// With or without numbers of the robot held that the data do not support.
    pub fn with_pruning(self, prune: bool) -> Options {
        Options { prune, ..self }
    }
}
