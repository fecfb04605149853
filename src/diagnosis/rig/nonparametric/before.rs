//! What came before a reading: how far and how long ago its load was changed, and what hung there
//! until then.
//!
//! A slide that is damped, or a rod that settles, is still on its way when it is read: it lacks a
//! share of the last change that depends on the time since,
//!
//! ```text
//! y = C·F + g(t)·C·(F − F′)      F′ the load before, t the time since the load was changed
//! ```
//!
//! and what remembers otherwise shows C·F·h(F′). Both g and h are curves of no law.

use super::super::numbering::numbered;
use super::along::Coordinate;
use crate::diagnosis::rig::mechanics::load_history::{dwell, instants, runs};
use crate::diagnosis::rig::recording::datum::Datum;

/// Waiting times that differ by less than this factor are the same.
const SAME_WAIT: f64 = 1.1;

/// The change of the load before each datum.
pub(in crate::diagnosis::rig) struct Before {
    /// F′ of each datum, as [`Datum::drive`] counts it; 0 at the first of a run.
    pub load: Vec<f64>,
    /// Time since the load was changed, s: as the file says, or else since the reading before.
    pub wait: Option<Vec<f64>>,
}

impl Before {
    pub fn of(data: &[Datum]) -> Before {
        let times: Option<Vec<f64>> = data.iter().map(|d| d.time).collect();
        let usual = times.as_deref().map_or(0.0, |times| dwell(data, times));
        let (mut load, mut wait) = (vec![0.0; data.len()], vec![usual; data.len()]);
        for run in runs(data) {
            let instants = instants(data, &run);
            for (k, instant) in instants.iter().enumerate() {
                let before = k.checked_sub(1).map(|k| instants[k][0]);
                for &i in instant {
                    load[i] = before.map_or(0.0, |before| data[before].drive());
                    if let Some(times) = &times {
                        let changed = data[i].loaded_at.or(before.map(|before| times[before]));
                        wait[i] = changed.map_or(usual, |changed| (times[i] - changed).max(0.0));
                    }
                }
            }
        }
        let has_waits = times.is_some() && usual > 0.0;
        Before { load, wait: has_waits.then_some(wait) }
    }

    /// The logarithm of the waiting time, where those differ; at the shortest and before it, that.
    pub fn waits(&self) -> Option<Coordinate> {
        let wait = self.wait.as_ref()?;
        let positive = || wait.iter().copied().filter(|t| *t > 0.0);
        let (least, most) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
        (most > SAME_WAIT * least).then(|| wait.iter().map(|t| Some(t.max(least).ln())).collect())
    }

    /// C·(F − F′) of each datum, m: how far the rod deflects between the reading before and this
    /// one.
    pub fn changes(&self, data: &[Datum], deflections: &[f64]) -> Vec<f64> {
        let line = numbered(data.iter().map(Datum::line_key));
        let mut slope = vec![0.0; line.iter().max().map_or(0, |last| last + 1)];
        for ((datum, deflection), &line) in data.iter().zip(deflections).zip(&line) {
            if datum.drive() != 0.0 {
                slope[line] = deflection / datum.drive();
            }
        }
        (0..data.len()).map(|i| slope[line[i]] * (data[i].drive() - self.load[i])).collect()
    }

    /// F′ as a coordinate; nothing where it is always the same at the same load, whose curve is
    /// then the same.
    pub fn loads(&self, data: &[Datum]) -> Option<Coordinate> {
        let conditions = numbered(data.iter().map(|d| (d.direction, d.drive().to_bits(), d.phase)));
        let mut first_of: Vec<usize> = Vec::new();
        for (i, &condition) in conditions.iter().enumerate() {
            if condition == first_of.len() {
                first_of.push(i);
            }
        }
        let is_free = (0..data.len()).any(|i| self.load[first_of[conditions[i]]] != self.load[i]);
        is_free.then(|| self.load.iter().copied().map(Some).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    #[test]
    fn a_change_is_what_lies_between_two_readings() {
        let text = "axis,trial,load_n,time_s,dy_um\ny,1,5,0,10\ny,1,10,20,20\ny,1,5,80,10\n";
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        let before = Before::of(&data);
        assert_eq!(before.load, [0.0, 5.0, 10.0]);
        // before the first reading it hung as long as usual
        assert_eq!(before.wait, Some(vec![60.0, 20.0, 60.0]));
        assert_eq!(before.changes(&data, &[1.0, 2.0, 1.0]), [1.0, 1.0, -1.0]);
        assert!(before.waits().is_some() && before.loads(&data).is_some());
    }

    #[test]
    fn loads_that_come_in_one_order_say_nothing_of_the_one_before() {
        let text = "axis,trial,load_n,dy_um\ny,1,5,10\ny,1,10,20\ny,2,5,10\ny,2,10,20\n";
        let before = Before::of(&datum::all(&Readings::from_text("f", text).unwrap().rows));
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        assert!(before.loads(&data).is_none() && before.waits().is_none());
    }
}
