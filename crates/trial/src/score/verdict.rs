//! What a case, or an answer to it, comes to in one word.

use std::cmp::Ordering;
use std::fmt;

use serde::{Serialize, Serializer};

use crate::effect_name::EffectName;

/// Truth or answer, as a row or a column of a table; ordered as its text is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// Its strongest effect.
    Named(EffectName),
    /// An error that no effect of the library explains.
    Unexplained,
    /// Nothing is wrong.
    Nothing,
    /// The answer is no diagnosis.
    Failed,
}

impl Verdict {
    fn as_str(&self) -> &str {
        match self {
            Verdict::Named(effect) => effect.as_str(),
            Verdict::Unexplained => "unexplained",
            Verdict::Nothing => "nothing",
            Verdict::Failed => "failed",
        }
    }

    /// True of an answer to `truth` that is right; that to physics `outside` the library is that
    /// it is unexplained.
    pub fn is_right(&self, truth: &Verdict, is_outside: impl Fn(&EffectName) -> bool) -> bool {
        let has_no_name = matches!(truth, Verdict::Named(effect) if is_outside(effect));
        self == truth || (*self == Verdict::Unexplained && has_no_name)
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Ord for Verdict {
    fn cmp(&self, other: &Verdict) -> Ordering {
        self.as_str().cmp(other.as_str())
    }
}

impl PartialOrd for Verdict {
    fn partial_cmp(&self, other: &Verdict) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}
