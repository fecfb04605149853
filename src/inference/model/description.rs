//! A finding as it is said to people.

use std::fmt;

/// A finding in words.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Description {
    /// What the recording shows, with values and their 95 % intervals, for example
    /// `Loads are felt 1.02 ± 0.04 N too small`.
    pub observed: String,
    /// What that is called, for example `friction in the slide`; nothing where `observed` says it.
    pub cause: String,
}

impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.cause.as_str() {
            "" => f.write_str(&self.observed),
            cause => write!(f, "{}: {cause}", self.observed),
        }
    }
}
