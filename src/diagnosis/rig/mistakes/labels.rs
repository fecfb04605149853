//! Mistakes of units, signs and names that a file of readings may hold, as a list.

mod in_file;
mod signs;
mod swaps;
mod units;
mod unknown_unit;

pub(super) use self::in_file::Labels;
use self::signs::signs;
use self::swaps::swaps;
pub(super) use self::units::{BESIDE, HARDLY_BESIDE, ReadIn, of_loads, of_readings};
use self::units::{decimals, decimals_of_axes, load_units, reading_units};
pub(super) use self::unknown_unit::{BEYOND_A_ROD, unknown_units};
pub use self::unknown_unit::{is_like_a_rod, is_unknown_unit};
use super::possible::PossibleMistake;

/// Every mistake that lines with these labels could show.
pub(super) fn all(labels: &Labels) -> Vec<PossibleMistake> {
    let mut all = load_units(labels, false);
    all.extend(reading_units(labels));
    all.extend(decimals_of_axes(labels));
    all.extend(signs(labels));
    all.extend(swaps(labels));
    all
}

/// Every one that some trials could show which others are compared with: what softer or stiffer
/// rods look like too, and decimal places.
pub(super) fn in_trials(labels: &Labels) -> Vec<PossibleMistake> {
    let mut all = load_units(labels, true);
    all.extend(reading_units(labels));
    all.extend(decimals_of_axes(labels));
    all.extend(decimals(labels));
    all.extend(signs(labels));
    all.extend(swaps(labels));
    all
}
