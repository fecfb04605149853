//! A diagnosed recording, as reports and users get it.

use super::limitation::Limitation;
use crate::inference::law::Proposed;
use crate::inference::{Absorbed, Diagnosis, Evidence, NotTestable};

/// A recording with its forward model and everything that was found: all that a report needs.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Diagnosed<M> {
    /// The physics that was asked about, and the recording.
    pub model: M,
    /// The recording as numbers.
    pub evidence: Evidence,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// Effects that this recording has no data for.
    pub not_testable: Vec<NotTestable>,
    /// Effects that the base model takes up.
    pub absorbed: Vec<Absorbed>,
    /// What makes every claim weaker, for people.
    pub limits: Vec<Limitation>,
    /// Where something is left unexplained, a law for it, or why there is none.
    pub law: Option<Proposed>,
}
