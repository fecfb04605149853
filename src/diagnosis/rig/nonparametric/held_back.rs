//! A force that is held back on the way up, and kept on the way down, and that is not the same
//! throughout: friction that wears, that sticks the longer it rests, or that depends on where the
//! slide stands.
//!
//! ```text
//! y = C·(F ∓ f(x))      −: while loading, +: while unloading; x the run, the time at rest, or the load
//! ```
//!
//! f is a curve like all others. Where it is the same everywhere, friction is the shorter
//! explanation, and the curve pays for its other columns.

use super::super::numbering::numbered;
use super::along::{ALL_DEFLECTIONS, Along, Coordinate, along, along_the_recording};
use super::before::Before;
use super::cosines::{curve, scaled};
use crate::diagnosis::rig::effects::entry::Entry;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Variable;

/// Size of the force as a share of the largest load: that of friction.
const SLIDE: f64 = 0.05;
/// Runs from which on a change from one to the next is more than two numbers.
const FEWEST_RUNS: usize = 3;

const BY_RUN: Along = along_the_recording(
    "force against the motion by run",
    "acts like friction that changes from run to run",
    Variable::Trial,
);
const AT_REST: Along = along(
    "force against the motion by time at rest",
    "acts like friction that depends on the time since the load was changed",
    Variable::TimeInRun,
);
const BY_LOAD: Along = along(
    "force against the motion by load",
    "acts like friction that depends on the load or on where the slide stands",
    Variable::Load,
);

/// All of them; `levels`: the load of each datum as curves count it.
pub(super) fn all(data: &[Datum], slopes: &[f64], before: &Before, levels: &Coordinate) -> Vec<Entry> {
    let Some(held) = held(data, slopes) else { return Vec::new() };
    let moved: Vec<usize> = (0..data.len()).filter(|&i| held[i] != 0.0).collect();
    let runs = numbered(moved.iter().map(|&i| data[i].run)).into_iter().max().map_or(0, |last| last + 1);
    let of_run = || scaled(&data.iter().map(|d| Some(d.run as f64)).collect::<Coordinate>());
    let mut coordinates = vec![(BY_LOAD, levels.clone())];
    coordinates.extend((runs >= FEWEST_RUNS).then(|| (BY_RUN, of_run())));
    coordinates.extend(before.waits().map(|waits| (AT_REST, scaled(&waits))));
    let largest = data.iter().fold(0.0, |most: f64, d| most.max(d.load));
    coordinates
        .iter()
        .filter_map(|(along, x)| curve(*along, ALL_DEFLECTIONS, x, &moved, "n", SLIDE * largest, |i| held[i]))
        .collect()
}

/// What a newton against the motion changes of each datum, m/N; nothing where all loads only grow,
/// since it is then an error of the load.
fn held(data: &[Datum], slopes: &[f64]) -> Option<Vec<f64>> {
    data.iter().any(Datum::is_unloading).then_some(())?;
    let of_datum = |(datum, slope): (&Datum, &f64)| {
        let away = if datum.is_unloading() && datum.load != datum.peak { -1.0 } else { 1.0 };
        match (datum.imposed, datum.motion) {
            (Some(imposed), Some(motion)) => imposed.per_newton * motion.direction,
            (_, Some(motion)) => -slope * motion.direction,
            // nothing hangs there yet; a slide that was unloaded still holds the rod
            (_, None) if datum.load == 0.0 && !datum.is_unloading() => 0.0,
            (_, None) => -slope * away * f64::from(datum.direction.sign),
        }
    };
    Some(data.iter().zip(slopes).map(of_datum).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    #[test]
    fn it_is_held_back_on_the_way_up_and_kept_on_the_way_down_to_nothing() {
        let text = "axis,load_n,phase,dy_um\n-y,0,load,0\n-y,5,load,1\n-y,10,load,2\n-y,10,unload,2\n\
                    -y,5,unload,1\n-y,0,unload,0\n";
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        // the rod gives way along the load: to −y; the top that is read once more has not moved
        let held = held(&data, &[1e-6; 6]).unwrap();
        assert_eq!(held, [0.0, 1e-6, 1e-6, 1e-6, -1e-6, -1e-6]);
        // of loads that only grow it would be an error of the load
        assert!(super::held(&data[..3], &[1e-6; 3]).is_none());
    }
}
