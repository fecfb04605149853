//! What was recorded: the data, in which order and session, what repeats, and what the file calls
//! its columns and rows.

pub mod chronicle;
pub mod columns;
pub mod datum;
mod estimate;
pub mod evidence;
mod multiples;
pub mod passing;
pub mod place;
mod recurring;
pub mod resolution;
mod rezeroed;
pub mod settings;
pub mod spread;
mod sweeps;
mod turns;
