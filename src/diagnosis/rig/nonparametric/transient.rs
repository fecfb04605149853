//! What sets in suddenly and decays: a lamp that is switched on and off, a bench that was bumped
//! and settles.
//!
//! ```text
//! y + a·e^(−(t − t₀)/τ)  from t₀ on      a a vector: a number for each channel
//! ```
//!
//! t₀ is the time of any reading: what began before it is as much larger. τ is [`LASTS`] of the
//! time between two readings; the shortest is seen where several sensors have it in common, for in
//! one it is what correlated noise does. A run counts from its zero, which is taken at its first
//! reading.

use std::sync::Arc;

use super::along::{Along, Coordinate, by_channel, rival, size, starts};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Location};

/// How long it lasts, in times between readings.
const LASTS: [f64; 3] = [1.5, 4.0, 12.0];
/// Readings of which the first two and the last two show no such course.
const ENDS: usize = 2;
/// Readings from which on it is distinguished from a smooth curve.
const FEWEST: usize = 12;
/// Readings up to which every beginning is tried.
const MOST: usize = 200;
/// Weight of all beginnings together, beside that of a curve.
const WEIGHT: f64 = 0.5;

/// All beginnings and durations, over a coordinate in time or in order from 0 to 1.
pub(super) fn all(along: Along, coordinate: &Coordinate, data: &[Datum]) -> Vec<Entry> {
    let known: Vec<usize> = (0..data.len()).filter(|&i| coordinate[i].is_some()).collect();
    let x: Vec<f64> = coordinate.iter().map(|x| x.unwrap_or(0.0)).collect();
    let mut times: Vec<f64> = known.iter().map(|&i| x[i]).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    if !(FEWEST..=MOST).contains(&times.len()) {
        return Vec::new();
    }
    let groups = by_channel(&known, data);
    let start: Vec<f64> = starts(coordinate, data).into_iter().map(|x| x.unwrap_or(0.0)).collect();
    let between = 1.0 / (times.len() - 1) as f64;
    let begins = &times[ENDS..times.len() - ENDS];
    let lasts = if groups.len() > 1 { &LASTS[..] } else { &LASTS[1..] };
    let weight = WEIGHT / (begins.len() * lasts.len()) as f64;
    let at = |(begin, lasts): (f64, f64)| {
        let course = |x: f64| if x < begin { 0.0 } else { (-(x - begin) / (lasts * between)).exp() };
        let of_group = |group: &Arc<[usize]>| {
            let values = group.iter().map(|&i| course(x[i]) - course(start[i])).collect();
            let weights = Weights { data: Arc::clone(group), values };
            (parameter("um", 0.0, size(group, data), UNBOUNDED), Action::Shift(weights))
        };
        let (parameters, actions) = groups.iter().map(of_group).unzip();
        let row = known.iter().filter(|&&i| x[i] >= begin).map(|&i| data[i].row).min().unwrap_or(0);
        let location = Location::Curve {
            label: format!("{}, a decay over {lasts} readings from row {row} on", along.name),
            follows: format!(
                "sets in suddenly at row {row} and decays with a time constant of about {lasts} readings"
            ),
            along: Some(along.variable),
        };
        (Candidate { weight, ..rival(location, parameters) }, actions)
    };
    begins.iter().flat_map(|&begin| lasts.iter().map(move |&lasts| (begin, lasts))).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::super::TIME;
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;
    use crate::spatial::Axis;

    /// 20 readings of two channels in two runs, one every 10 s.
    fn recorded() -> (Vec<Datum>, Coordinate) {
        let row = |i: usize| format!("y,{},{},{},1,2\n", 1 + i % 10, 1 + i / 10, 10 * i);
        let text =
            "axis,load_n,trial,time_s,dy_um,dz_um\n".to_owned() + &(0..20).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate = data.iter().map(|d| d.time.map(|t| t / 190.0)).collect();
        (data, coordinate)
    }

    #[test]
    fn it_is_nothing_before_it_comes_and_a_later_run_counts_from_its_zero() {
        let (data, coordinate) = recorded();
        let entries = all(TIME, &coordinate, &data);
        assert_eq!(entries.len(), 16 * LASTS.len());
        let label = "time, a decay over 4 readings from row 9 on";
        let (candidate, actions) =
            entries.iter().find(|(candidate, _)| candidate.location.to_string() == label).unwrap();
        assert_eq!((candidate.parameters.len(), actions.len()), (2, 2));
        let Action::Shift(weights) = &actions[1] else { panic!("a shift") };
        let course = |reading: usize| if reading < 8 { 0.0 } else { (-(reading as f64 - 8.0) / 4.0).exp() };
        for (i, weight) in weights.iter() {
            let (reading, zero) = (i / 2, if i / 2 < 10 { 0 } else { 10 });
            assert!((weight - (course(reading) - course(zero))).abs() < 1e-12, "{i}: {weight}");
        }
    }

    #[test]
    fn of_one_sensor_the_shortest_is_not_distinguished_from_its_noise() {
        let (mut data, _) = recorded();
        data.retain(|datum| datum.channel == Axis::Y);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 190.0)).collect();
        assert_eq!(all(TIME, &coordinate, &data).len(), 16 * (LASTS.len() - 1));
    }

    #[test]
    fn few_readings_show_no_such_course() {
        let (data, coordinate) = recorded();
        assert!(all(TIME, &coordinate[..20].to_vec(), &data[..20]).is_empty());
    }
}
