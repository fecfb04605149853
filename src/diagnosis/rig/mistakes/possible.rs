//! A mistake that may have been made.

use super::relabelling::Relabelling;
use crate::inference::{Effect, Estimate, Key};
use crate::units::uncapital;

/// One of the hypotheses that the search tries.
#[derive(Debug, Clone)]
pub(super) struct PossibleMistake {
    pub effect: &'static Effect,
    /// Columns, keys and names as they stand in the file.
    pub location: Key,
    /// What undoes it.
    pub relabelling: Relabelling,
    /// How usual it is: ln of odds against the most usual one.
    pub log_prior: f64,
    pub estimates: Vec<Estimate>,
    /// What is wrong, with the correction: a full sentence without its full stop.
    pub observed: String,
    /// What could be done instead where all rows are wrong alike: `name the column load_kg`.
    pub or_else: Option<&'static str>,
    /// What it looks like, for one line: `load_n looks like kilograms`.
    pub looks_like: String,
    /// How far the factor that all lines still have in common may be from 1, as a ratio: a unit's
    /// factor counts only near it.
    pub within: f64,
}

impl PossibleMistake {
    /// The sentence where all rows are wrong.
    pub fn observed_in_all_rows(&self) -> String {
        match self.or_else {
            Some(instead) => format!("{} (or {instead})", self.observed),
            None => self.observed.clone(),
        }
    }

    /// The same said of some rows: the rest of a sentence that begins with them.
    pub fn observed_in_some_rows(&self) -> String {
        uncapital(&self.observed)
    }
}

/// An estimate without a unit.
pub(super) fn exact(name: &str, value: f64) -> Estimate {
    Estimate::as_written(name, value, value, value)
}
