//! A finding as it is said to people.

use std::fmt;

/// A finding in words.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Description {
    /// What the recording shows, with values and their 95 % intervals, for example
    /// `Loads are felt 1.02 ± 0.04 N too small`.
    pub observed: String,
    /// What that is called, for example `friction in the slide`.
    pub cause: String,
}

impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.observed, self.cause)
    }
}
