//! The effects that a rig may show: one file for a family, one record for an effect.
//!
//! A record ([`RigEffect`](entry::RigEffect)) and the functions below it say everything of an
//! effect: its law, its usual size and the source of that number, what it needs of a recording, how
//! it is said, where it is written. [`registry::ALL`] is the list of them.
//!
//! A prior size is what a rig of this kind is usually wrong by: a share of the recording's own
//! loads, readings, times and temperatures, so that the same recording in other units, or of a rod
//! ten times as large, has the same answer. "The paper": Improved
//! MultiCal, Sensors 2023, 23(12), 5717.

pub(super) mod dimension;
pub(super) mod display;
pub(super) mod drift;
pub mod entry;
pub(super) mod events;
pub(super) mod history;
pub(super) mod load;
pub mod mistakes;
pub(super) mod of_trial;
pub(super) mod pipe;
pub(super) mod places;
pub(super) mod points;
pub mod registry;
pub(super) mod sensor;
pub(super) mod structure;
#[cfg(test)]
mod tests;
pub(super) mod zeros;
