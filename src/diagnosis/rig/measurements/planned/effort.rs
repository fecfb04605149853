//! How long a measurement takes, and how often it is repeated.

use crate::inference::LoadPlan;

/// Minutes that a new place of load or sensors takes, that a new zero takes, and that a reading
/// takes.
const SETUP: f64 = 10.0;
const ZEROING: f64 = 2.0;
const READING: f64 = 0.5;
/// Fewest repeats of a measurement, for the scatter has to be seen too; and most.
pub(super) const FEWEST: usize = 3;
pub(super) const MOST_REPEATS: usize = 12;

/// The effort of a plan of loads, minutes.
pub fn minutes(loads: &LoadPlan) -> f64 {
    let up = loads.loads.len();
    let steps = if loads.unloading { 2 * up - 1 } else { up };
    let waiting = loads.waits.last().copied().unwrap_or_default() / 60.0;
    let readings = (steps * loads.waits.len()) as f64 * READING;
    SETUP + loads.repeats as f64 * (ZEROING + readings + waiting)
}
