//! Mistakes in some of the readings: what they are, and which data.

use crate::inference::{Effect, Estimate, Key};

/// A mistake in some of the data.
pub(super) struct Part {
    pub effect: &'static Effect,
    pub location: Key,
    pub estimates: Vec<Estimate>,
    pub observed: String,
    pub looks_like: String,
    /// About how much of the readings it explains, m.
    pub explains: f64,
    /// Indices of the data.
    pub data: Vec<usize>,
    /// What it may be as well: an effect at a place.
    pub rivals: Vec<(&'static Effect, Key)>,
}
