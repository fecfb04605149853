//! Mistakes in some of the readings: what they are, and which data.

use super::super::datum::Datum;
use crate::inference::{Effect, Estimate};

/// A mistake in some of the data.
pub(super) struct Part {
    pub effect: &'static Effect,
    pub location: String,
    pub estimates: Vec<Estimate>,
    pub observed: String,
    pub looks_like: String,
    /// About how much of the readings it explains, m.
    pub explains: f64,
    /// Indices of the data.
    pub data: Vec<usize>,
    /// What it may be as well: an effect at a place.
    pub rivals: Vec<(&'static Effect, String)>,
}

/// `3`, `3 of session monday`; `None` where trials have no names.
pub(super) fn trial_name(datum: &Datum) -> Option<String> {
    let trial = datum.trial.as_ref()?;
    Some(match &datum.session {
        Some(session) => format!("{trial} of session {session}"),
        None => trial.clone(),
    })
}

/// `rows 7 to 12`.
pub(super) fn rows_name<'a>(data: impl Iterator<Item = &'a Datum>) -> String {
    let (first, last) =
        data.fold((usize::MAX, 0), |(low, high), datum| (low.min(datum.row), high.max(datum.row)));
    format!("rows {first} to {last}")
}
