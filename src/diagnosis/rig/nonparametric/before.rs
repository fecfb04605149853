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
//! and what remembers otherwise shows C·F·h(F′), or C·F·k(v) with v = (F − F′)/Δt the speed of
//! loading. g, h and k are curves of no law.

use std::collections::HashMap;

use super::super::numbering::numbered;
use super::along::Coordinate;
use crate::diagnosis::rig::mechanics::load_history::{dwell, instants, runs};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::diagnosis::rig::recording::passing::speeds;
use crate::rig::readings::Direction;

/// Waiting times that differ by less than this factor are the same.
const SAME_WAIT: f64 = 1.1;
/// And speeds: what is fast and slow alike follows the sign of the motion alone.
const SAME_SPEED: f64 = 1.25;
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

    /// How fast the load was changed to what it is, N/s (m/s of an imposed displacement):
    /// v = (F − F′)/Δt, positive where it grew, Δt from the reading before until it hung, else
    /// until it is read; at the first reading of a run the usual one; of a slide that is read on
    /// its way, how fast it [passes](crate::diagnosis::rig::recording::passing). Nothing where it
    /// is always the same at the same load, or but for its sign everywhere.
    pub fn speeds(&self, data: &[Datum]) -> Option<Vec<f64>> {
        let times: Vec<f64> = data.iter().map(|d| d.time).collect::<Option<_>>()?;
        let usual = dwell(data, &times);
        let mut speed = vec![0.0; data.len()];
        for run in runs(data) {
            let mut before: Option<f64> = None;
            let instants = instants(data, &run);
            if let Some(passing) = passing(data, &times, &instants) {
                for (instant, v) in instants.iter().zip(passing) {
                    instant.iter().for_each(|&i| speed[i] = f64::from(data[i].direction.sign) * v);
                }
                continue;
            }
            for instant in instants {
                for &i in &instant {
                    let (sign, change) = (f64::from(data[i].direction.sign), data[i].drive() - self.load[i]);
                    let took = before.map_or(usual, |before| data[i].loaded_at.unwrap_or(times[i]) - before);
                    speed[i] = if took > 0.0 { sign * change / took } else { 0.0 };
                }
                before = Some(times[instant[0]]);
            }
        }
        let known: Coordinate = speed.iter().copied().map(Some).collect();
        let sizes = || speed.iter().map(|v| v.abs()).filter(|v| *v > 0.0);
        let (least, most) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        (most > SAME_SPEED * least && is_free(data, &known)).then_some(speed)
    }

    /// C·(F − F′) of each datum, m: how far the rod deflects between the reading before and this
    /// one.
    pub fn changes(&self, data: &[Datum], deflections: &[f64]) -> Vec<f64> {
        let slopes = slopes(data, deflections);
        (0..data.len()).map(|i| slopes[i] * (data[i].drive() - self.load[i])).collect()
    }

    /// F′ as a coordinate, positive where it pulled as the load does now: what remembers does not
    /// know the axes of {T}. Nothing where it is always the same at the same load, whose curve is
    /// then the same.
    pub fn loads(&self, data: &[Datum]) -> Option<Coordinate> {
        let along = |(datum, before): (&Datum, &f64)| Some(before * f64::from(datum.direction.sign));
        Some(data.iter().zip(&self.load).map(along).collect()).filter(|loads| is_free(data, loads))
    }
}

/// arsinh(v/v₀) of speeds, v₀ the slowest: as many columns for a decade as for the next.
pub(super) fn by_decade(speeds: &[f64]) -> Coordinate {
    let sizes = speeds.iter().map(|v| v.abs()).filter(|v| *v > 0.0);
    let slowest = sizes.fold(f64::INFINITY, f64::min);
    speeds.iter().map(|v| Some((v / slowest).asinh())).collect()
}

/// How fast a slide passes the displacements that were imposed at the instants of a run, m/s;
/// nothing where it stood still at them.
fn passing(data: &[Datum], times: &[f64], instants: &[Vec<usize>]) -> Option<Vec<f64>> {
    let imposed = |instant: &Vec<usize>| {
        let imposed = instant.iter().find_map(|&i| data[i].imposed)?;
        Some((imposed, times[instant[0]]))
    };
    let own: Vec<_> = instants.iter().map(imposed).collect::<Option<_>>()?;
    let (u, times): (Vec<f64>, Vec<f64>) = own.iter().map(|(own, time)| (own.set, *time)).unzip();
    speeds(&u, &times, own.iter().any(|(own, _)| own.known.recurs()))
}

/// Is a coordinate not always the same at the same load?
fn is_free(data: &[Datum], coordinate: &Coordinate) -> bool {
    let mut of_load: HashMap<(Direction, u64), f64> = HashMap::new();
    data.iter().zip(coordinate).any(|(datum, x)| {
        let load = (datum.direction, datum.drive().to_bits());
        x.is_some_and(|x| *of_load.entry(load).or_insert(x) != x)
    })
}

/// How much each datum deflects by what is driven, m/N: that of its line.
pub(super) fn slopes(data: &[Datum], deflections: &[f64]) -> Vec<f64> {
    let line = numbered(data.iter().map(Datum::line_key));
    let mut slope = vec![0.0; line.iter().max().map_or(0, |last| last + 1)];
    for ((datum, deflection), &line) in data.iter().zip(deflections).zip(&line) {
        if datum.drive() != 0.0 {
            slope[line] = deflection / datum.drive();
        }
    }
    line.into_iter().map(|line| slope[line]).collect()
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
        let text = "axis,trial,load_n,time_s,dy_um\ny,1,5,0,10\ny,1,10,9,20\ny,2,5,60,10\ny,2,10,69,20\n";
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        let before = Before::of(&data);
        assert!(before.loads(&data).is_none() && before.waits().is_none() && before.speeds(&data).is_none());
    }

    #[test]
    fn the_load_before_pulls_as_the_present_one_and_its_speed_too() {
        let text = "axis,trial,load_n,phase,time_s,dy_um\n-y,1,5,load,0,10\n-y,1,10,load,10,20\n-y,1,5,unload,30,10\n";
        let data = datum::all(&Readings::from_text("f", text).unwrap().rows);
        let before = Before::of(&data);
        assert_eq!(before.loads(&data), Some(vec![Some(0.0), Some(5.0), Some(10.0)]));
        // the same load came once from below and once, more slowly, from above; as long as usual
        // before the first reading
        assert_eq!(before.speeds(&data), Some(vec![0.25, 0.5, -0.25]));
        // as fast up as down it follows the direction of the motion, and nothing else
        let data = datum::all(&Readings::from_text("f", &text.replace(",30,10", ",20,10")).unwrap().rows);
        assert_eq!(Before::of(&data).speeds(&data), None);
    }
}
