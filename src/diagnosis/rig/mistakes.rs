//! Mistakes before physics: units, signs, names, zeros, sensors, files.
//!
//! They are discrete, few and of enormous evidence, so they are undone before there is a model.
//! Three steps:
//!
//! 1. readings that no load could give: channels that are stuck or cut off, runs whose sign is the
//!    other way (`sensors.rs`, `groups.rs`), one of several sensors along the rod (`gauges.rs`); a
//!    line of readings shows these by itself;
//! 2. the slopes of all lines against the rod (`lines.rs`, `physics.rs`): where what is left is
//!    more than ordinary physics leaves, some hundred hypotheses (`labels.rs`, `rods.rs`), each a
//!    [`relabelling::Relabelling`] of readings or another rod, compete with each other and with all that physics may
//!    add (`search.rs`);
//! 3. zeros that were not taken, on the corrected lines (`groups.rs`).
//!
//! A mistake is named where what it acts on is more than 22 % (rms) off without it and plausible
//! with it, at odds of 1000 against everything else. Physics may stand beside: a unit counts where
//! what remains is a factor of 0.8 to 1.25. A factor that is no unit's and that no physics reaches
//! is a mistake too (`labels/unknown_unit.rs`).

mod columns_and_rod;
mod copies;
mod displaced;
mod entries;
mod gauges;
mod groups;
mod increments;
mod labels;
mod limits;
mod lines;
mod lookalikes;
mod mended;
mod needed;
mod part;
mod physics;
mod possible;
mod relabelling;
mod rods;
mod same_load;
mod search;
mod sensors;
mod shown_loads;
mod some_rows;
#[cfg(test)]
mod tests;
mod trials;
mod weights;

pub(super) use self::labels::{is_like_a_rod, is_unknown_unit};
pub(super) use self::lookalikes::{is_one_factor, lookalikes};
pub(super) use self::mended::Mended;
pub(super) use self::rods::OtherRod;
pub(super) use self::search::{ODDS, RARE};
use crate::diagnosis::Suspicion;
use crate::error::Result;
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// Each mistake that `readings` seem to hold, for those who do not ask for a diagnosis: `load_n
/// looks like kilograms: the rod seems 9.8 times softer than its file`.
///
/// ```
/// use rodcal::diagnosis::rig::suspected;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let text = std::fs::read_to_string("stiffness_data/5.csv")?.replace("load_kg", "load_n");
/// let suspicions = suspected(&Readings::from_text("5.csv", &text)?, Some(&rod))?;
/// assert!(suspicions[0].description.starts_with("load_n looks like kilograms"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// What the beam model refuses of the rod.
pub fn suspected(readings: &Readings, rod: Option<&Rod>) -> Result<Vec<Suspicion>> {
    Ok(mended(readings, rod, &[])?.suspicions)
}

/// Readings and rod without mistakes; `others` are rods that may have been meant, by their files.
pub(super) fn mended(readings: &Readings, rod: Option<&Rod>, others: &[(String, Rod)]) -> Result<Mended> {
    let mut mended = Mended::new(readings, rod);
    mended.copies();
    mended.increments()?;
    mended.displaced();
    // one load ten times too large makes the slope of its trial ten times too small
    mended.entries();
    mended.trials()?;
    mended.entries();
    mended.sensors()?;
    mended.gauges()?;
    if mended.has_data {
        mended.labels(others)?;
        mended.weights();
        mended.zeros();
    }
    mended.has_data = mended.has_data && mended.has_slope();
    mended.found.sort_by(|a, b| b.explains.total_cmp(&a.explains));
    Ok(mended)
}
