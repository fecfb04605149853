//! A mistake in one line, for those who did not ask for a diagnosis.

use std::fmt;

/// A mistake that files seem to hold, in one line. Its `Display` is that line.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Suspicion {
    /// `load_n looks like kilograms: the rod seems 9.8 times softer than its file`, without a full
    /// stop.
    pub description: String,
    /// False for a first guess of base or tip, which a calibration corrects.
    pub spoils_fit: bool,
}

impl Suspicion {
    /// Of a mistake that spoils what is fitted to the files.
    pub(super) fn new(description: String) -> Suspicion {
        Suspicion { description, spoils_fit: true }
    }
}

impl fmt::Display for Suspicion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.description)
    }
}
