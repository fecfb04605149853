//! How much does a rod really bend?

use super::Answer;
use crate::diagnosis::rig::suspected;
use crate::error::Result;
use crate::report;
use crate::rig::{self, Options, readings::Readings};
use crate::rod::Rod;

/// Lines through readings, r and the measured compliance of `rod`; without one, lines alone.
///
/// # Errors
/// As [`rig::fit`].
pub fn rig_fit(readings: &Readings, rod: Option<&Rod>, options: &Options) -> Result<Answer> {
    let fit = rig::fit(readings, rod, options)?;
    let mut report = report::rig::report(&fit, readings, rod);
    let suspicions = suspected(readings, rod)?;
    // nothing that follows is worth more than what it is made of
    if let Some(worst) = suspicions.first() {
        report.headline = format!("Most likely a mistake: {worst}. {}", report.headline);
    }
    report.warnings.extend(suspicions);
    Ok(Answer::new(report::rig::json(&fit, readings, rod), report))
}
