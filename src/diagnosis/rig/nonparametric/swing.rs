//! What comes and goes in time with one period: a few numbers find what no curve of many does.
//!
//! ```text
//! y + a·cos(2πt/T) + b·sin(2πt/T)      a, b vectors: a number for each channel
//! ```
//!
//! or, where runs have zeros of their own, what has come since the zero was taken: each wave less
//! its value at the first reading of the run.
//!
//! T is the length of the recording over 1, 1½, 2 … [`MOST_SWINGS`]: half-way between two of them
//! the waves are an eighth of a swing off at the ends of the recording, and 0.97 of the true one is
//! seen. A swing takes [`TO_SEE_ONE`] readings to be seen, so that fewer of them bound the number
//! of swings.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::super::numbering::numbered;
use super::along::{Along, Coordinate, LEAST_SHIFT, SHARE, largest_reading, rival};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Location;

const MOST_SWINGS: usize = 12;
/// Periods that are tried for each swing more.
const FOR_EACH: usize = 2;
/// Times of which a swing needs so many: two, and what uneven ones lose.
const TO_SEE_ONE: f64 = 2.5;
/// Times from which on swings are told from a smooth curve.
const FEWEST: usize = 12;

type Wave = fn(f64) -> f64;

/// All periods, over a coordinate from 0 to 1.
pub(super) fn all(along: Along, coordinate: &Coordinate, data: &[Datum]) -> Vec<Entry> {
    let known: Vec<usize> = (0..data.len()).filter(|&i| coordinate[i].is_some()).collect();
    let times = numbered(known.iter().filter_map(|&i| coordinate[i]).map(f64::to_bits));
    let times = times.into_iter().max().map_or(0, |last| last + 1);
    if times < FEWEST {
        return Vec::new();
    }
    let seen = (FOR_EACH as f64 * times as f64 / TO_SEE_ONE) as usize;
    let channels = numbered(known.iter().map(|&i| data[i].channel));
    let count = channels.iter().max().map_or(0, |last| last + 1);
    let own: Vec<Arc<[usize]>> = (0..count)
        .map(|k| known.iter().zip(&channels).filter(|(_, own)| **own == k).map(|(&i, _)| i).collect())
        .collect();
    let size = |own: &[usize]| {
        let largest = own.iter().fold(0.0, |most: f64, &i| most.max(data[i].measured.abs()));
        0.5 * (SHARE * largest).max(LEAST_SHIFT * largest_reading(data))
    };
    let started = starts(coordinate, data);
    let swings = |(half, since): (usize, Since)| {
        let turns = half as f64 / FOR_EACH as f64;
        let of_own = |(own, wave): (&Arc<[usize]>, Wave)| {
            let at = |&i: &usize| {
                let now = coordinate[i].map_or(0.0, |x| wave(TAU * turns * x));
                match since {
                    Since::Always => now,
                    Since::Zero => now - started[i].map_or(0.0, |x| wave(TAU * turns * x)),
                }
            };
            let weights = Weights { data: Arc::clone(own), values: own.iter().map(at).collect() };
            (parameter("um", 0.0, size(own), UNBOUNDED), Action::Shift(weights))
        };
        let waves: [Wave; 2] = [f64::cos, f64::sin];
        let all = own.iter().flat_map(|own| waves.map(|wave| (own, wave)));
        let (parameters, actions) = all.map(of_own).unzip();
        let place = match since {
            Since::Always => format!("{turns} swings, all sensors"),
            Since::Zero => format!("{turns} swings, all sensors, since the zero of each run"),
        };
        let location = Location::Curve {
            label: format!("{}, {place}", along.name),
            follows: along.follows(&place),
            along: Some(along.variable),
        };
        (rival(location, parameters), actions)
    };
    let has_zeros = known.iter().any(|&i| data[i].run != data[known[0]].run);
    let since = if has_zeros { vec![Since::Always, Since::Zero] } else { vec![Since::Always] };
    let halves = FOR_EACH..=seen.min(FOR_EACH * MOST_SWINGS);
    halves.flat_map(|half| since.iter().map(move |&since| (half, since))).map(swings).collect()
}

/// From where on a wave counts.
#[derive(Clone, Copy)]
enum Since {
    Always,
    Zero,
}

/// The coordinate of the first reading of each datum's run.
fn starts(coordinate: &Coordinate, data: &[Datum]) -> Coordinate {
    let runs = data.iter().map(|d| d.run + 1).max().unwrap_or(0);
    let mut first: Coordinate = vec![None; runs];
    for (datum, x) in data.iter().zip(coordinate) {
        let known = &mut first[datum.run];
        *known = match (*known, *x) {
            (Some(known), Some(x)) => Some(x.min(known)),
            (known, x) => known.or(x),
        };
    }
    data.iter().map(|d| first[d.run]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::TIME;
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;

    #[test]
    fn each_period_has_two_waves_of_every_channel() {
        let row = |i: usize| format!("y,{},{},1,2\n", 1 + i % 4, 10 * i);
        let text = "axis,load_n,time_s,dy_um,dz_um\n".to_owned() + &(0..40).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 390.0)).collect();
        let entries = all(TIME, &coordinate, &data);
        // 1, 1½ … 12 swings, each always and since the zeros of the runs
        assert_eq!(entries.len(), 46);
        assert!(
            entries.iter().all(|(candidate, actions)| candidate.parameters.len() == 4 && actions.len() == 4)
        );
        // 20 times show eight swings, and eleven too few
        assert_eq!(all(TIME, &coordinate[..40].to_vec(), &data[..40]).len(), 30);
        assert!(all(TIME, &coordinate[..22].to_vec(), &data[..22]).is_empty());
    }

    #[test]
    fn what_has_come_since_the_zero_is_nothing_at_the_first_reading_of_a_run() {
        let row = |i: usize| format!("y,{},{},{},1,2\n", 1 + i % 10, 1 + i / 10, 10 * i);
        let text =
            "axis,load_n,trial,time_s,dy_um,dz_um\n".to_owned() + &(0..40).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 390.0)).collect();
        let entries = all(TIME, &coordinate, &data);
        assert_eq!(entries.len(), 46);
        let label = |entry: &Entry| entry.0.location.to_string();
        let (_, actions) = entries
            .iter()
            .find(|entry| label(entry) == "time, 2 swings, all sensors, since the zero of each run")
            .unwrap();
        let Action::Shift(weights) = &actions[1] else { panic!("a shift") };
        for (i, weight) in weights.iter() {
            let at = |reading: usize| (TAU * 2.0 * reading as f64 / 39.0).sin();
            let reading = i / 2;
            assert!((weight - (at(reading) - at(reading / 10 * 10))).abs() < 1e-12, "{i}: {weight}");
        }
    }
}
