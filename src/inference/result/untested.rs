//! What a recording says nothing about.

use crate::inference::{Effect, Location};

/// An effect that a recording has no data for.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct NotTestable {
    /// What it is.
    pub effect: &'static Effect,
    /// What is missing.
    pub reason: String,
}

/// An effect that the base model takes up: were it there, its parameters would hide it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Absorbed {
    /// What it is.
    pub effect: &'static Effect,
    /// The place at which it would act.
    pub location: Location,
    /// ‖M·C‖/‖C‖: share of its columns that the base model cannot take up.
    pub unabsorbed: f64,
}
