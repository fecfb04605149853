//! What comes and goes in time with one period: a few numbers find what no curve of many does.
//!
//! ```text
//! y + a·cos(2πt/T) + b·sin(2πt/T)      a, b vectors: a number for each channel
//! ```
//!
//! T is the length of the recording over 1, 1½, 2 … [`MOST_SWINGS`].

use std::f64::consts::TAU;
use std::sync::Arc;

use super::super::action::{Action, Weights};
use super::super::datum::Datum;
use super::super::numbering::numbered;
use super::along::{Along, Coordinate, LEAST_SHIFT, SHARE, largest_reading, rival};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::inference::Location;
use crate::units::UM;

const MOST_SWINGS: usize = 8;
/// Times from which on as many swings are seen.
const FEWEST: usize = 4 * MOST_SWINGS;

type Wave = fn(f64) -> f64;

/// All periods, over a coordinate from 0 to 1.
pub(super) fn all(along: Along, coordinate: &Coordinate, data: &[Datum]) -> Vec<Entry> {
    let known: Vec<usize> = (0..data.len()).filter(|&i| coordinate[i].is_some()).collect();
    let times = numbered(known.iter().filter_map(|&i| coordinate[i]).map(f64::to_bits));
    if times.into_iter().max().is_none_or(|last| last + 1 < FEWEST) {
        return Vec::new();
    }
    let channels = numbered(known.iter().map(|&i| data[i].channel));
    let count = channels.iter().max().map_or(0, |last| last + 1);
    let own: Vec<Arc<[usize]>> = (0..count)
        .map(|k| known.iter().zip(&channels).filter(|(_, own)| **own == k).map(|(&i, _)| i).collect())
        .collect();
    let size = |own: &[usize]| {
        let largest = own.iter().fold(0.0, |most: f64, &i| most.max(data[i].measured.abs()));
        0.5 * (SHARE * largest).max(LEAST_SHIFT * largest_reading(data))
    };
    let swings = |half: usize| {
        let turns = half as f64 / 2.0;
        let of = |(own, wave): (&Arc<[usize]>, Wave)| {
            let at = |&i: &usize| coordinate[i].map_or(0.0, |x| wave(TAU * turns * x));
            let weights = Weights { data: Arc::clone(own), values: own.iter().map(at).collect() };
            (parameter("um", UM, 0.0, size(own), UNBOUNDED), Action::Shift(weights))
        };
        let waves: [Wave; 2] = [f64::cos, f64::sin];
        let all = own.iter().flat_map(|own| waves.map(|wave| (own, wave)));
        let (parameters, actions) = all.map(of).unzip();
        let place = format!("{turns} swings, all sensors");
        let location = Location::Curve {
            label: format!("{}, {place}", along.name),
            follows: along.follows(&place),
            along: Some(along.variable),
        };
        (rival(location, parameters), actions)
    };
    (2..=2 * MOST_SWINGS).map(swings).collect()
}

#[cfg(test)]
mod tests {
    use super::super::TIME;
    use super::*;
    use crate::diagnosis::rig::datum;
    use crate::rig::readings::Readings;

    #[test]
    fn each_period_has_two_waves_of_every_channel() {
        let row = |i: usize| format!("y,{},{},1,2\n", 1 + i % 4, 10 * i);
        let text = "axis,load_n,time_s,dy_um,dz_um\n".to_owned() + &(0..40).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 390.0)).collect();
        let entries = all(TIME, &coordinate, &data);
        assert_eq!(entries.len(), 15);
        assert!(
            entries.iter().all(|(candidate, actions)| candidate.parameters.len() == 4 && actions.len() == 4)
        );
        // of too few times none
        assert!(all(TIME, &coordinate, &data[..60]).is_empty());
    }
}
