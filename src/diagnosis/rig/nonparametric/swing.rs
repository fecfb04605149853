//! What comes and goes with one period, in time or along a display: a few numbers find what no
//! curve of many does.
//!
//! ```text
//! y + a·cos(2πx/T) + b·sin(2πx/T)      a, b vectors: a number for each channel
//! ```
//!
//! In time x is that of the reading; where runs have zeros of their own, also what has come since
//! the zero was taken: each wave less its value at the first reading of the run. Along a display,
//! whose scale or interpolation errs, x is the reading, and the waves are nothing at its zero.
//!
//! T is the range of x over 1, 1½, 2 … [`MOST_SWINGS`]: half-way between two of them the waves are
//! an eighth of a swing off at the ends, and 0.97 of the true one is seen. A swing takes
//! [`TO_SEE_ONE`] different x to be seen, so that fewer of them bound the number of swings.

use std::f64::consts::TAU;
use std::sync::Arc;

use super::super::numbering::numbered;
use super::along::{Along, Coordinate, READING, by_channel, rival, size, starts};
use crate::diagnosis::rig::effects::entry::{Entry, UNBOUNDED, parameter};
use crate::diagnosis::rig::mechanics::action::{Action, Weights};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::{Candidate, Location};
use crate::statistics::median;
use crate::units::{UM, significant};

const MOST_SWINGS: usize = 12;
/// Periods that are tried for each swing more.
const FOR_EACH: usize = 2;
/// Times of which a swing needs so many: two, and what uneven ones lose.
const TO_SEE_ONE: f64 = 2.5;
/// Times from which on swings are distinguished from a smooth curve.
const FEWEST: usize = 12;
/// Readings that differ by less than this part of the range are the same.
const LEVELS: f64 = 50.0;
/// Weight of one period of a display beside that of a curve.
const OF_DISPLAY: f64 = 0.1;

type Wave = fn(f64) -> f64;

/// All periods, over a coordinate in time from 0 to 1.
pub(super) fn in_time(along: Along, coordinate: &Coordinate, data: &[Datum]) -> Vec<Entry> {
    let known: Vec<usize> = (0..data.len()).filter(|&i| coordinate[i].is_some()).collect();
    let different = numbered(known.iter().filter_map(|&i| coordinate[i]).map(f64::to_bits));
    let Some(halves) = halves(different.into_iter().max().map_or(0, |last| last + 1)) else {
        return Vec::new();
    };
    let x: Vec<f64> = coordinate.iter().map(|x| x.unwrap_or(0.0)).collect();
    let start: Vec<f64> = starts(coordinate, data).into_iter().map(|x| x.unwrap_or(0.0)).collect();
    let has_zeros = known.iter().any(|&i| data[i].run != data[known[0]].run);
    let since = [(None, ""), (Some(&start[..]), ", since the zero of each run")];
    let since = &since[..if has_zeros { 2 } else { 1 }];
    let channels = by_channel(&known, data);
    let at = |(half, &(start, said)): (usize, &(Option<&[f64]>, &str))| {
        let place = format!("{} swings, all sensors{said}", half as f64 / FOR_EACH as f64);
        waves((along, &place, along.follows(&place)), half, (&x, start), &channels, data)
    };
    halves.flat_map(|half| since.iter().map(move |since| (half, since))).map(at).collect()
}

/// All periods of all displays, and of each alone. `deflections`: by the base model, m.
pub(super) fn of_displays(data: &[Datum], deflections: &[f64]) -> Vec<Entry> {
    let shown = expected(data, deflections);
    let everything: Vec<usize> = (0..data.len()).collect();
    let channels = by_channel(&everything, data);
    let zero = vec![0.0; data.len()];
    let of_group = |(name, channels): (String, &[Arc<[usize]>])| {
        let largest = |group: &[usize]| group.iter().fold(0.0, |most: f64, &i| most.max(shown[i].abs()));
        let range = channels.iter().map(|group| largest(group)).fold(0.0, f64::max);
        let x: Vec<f64> = shown.iter().map(|shown| shown / range).collect();
        // the one that moves most shows it
        let widest = channels.iter().find(|group| largest(group) >= range);
        let halves = widest
            .filter(|_| range > 0.0)
            .and_then(|group| halves(levels(group.iter().map(|&i| x[i].abs()).collect())));
        let at = |half: usize| {
            let place = format!("{} swings, {name}", half as f64 / FOR_EACH as f64);
            let period = significant(range * FOR_EACH as f64 / half as f64 / UM, 2);
            let follows = format!("repeats every {period} µm or so of the reading ({name})");
            let said = (READING, &*place, follows);
            let (candidate, actions) = waves(said, half, (&x, Some(&zero)), channels, data);
            // all periods together are one curve
            (Candidate { weight: OF_DISPLAY, ..candidate }, actions)
        };
        halves.into_iter().flatten().map(at).collect::<Vec<Entry>>()
    };
    let each =
        channels.iter().map(|group| (format!("d{}", data[group[0]].channel), std::slice::from_ref(group)));
    let all = (channels.len() > 1).then(|| ("all displays".to_owned(), &channels[..]));
    all.into_iter().chain(each).flat_map(of_group).collect()
}

/// What the displays show but for single errors, m: the deflection by the model, as much steeper on
/// each line as the readings are.
fn expected(data: &[Datum], deflections: &[f64]) -> Vec<f64> {
    let line = numbered(data.iter().map(Datum::line_key));
    let mut ratios = vec![Vec::new(); line.iter().max().map_or(0, |last| last + 1)];
    for ((datum, &deflection), &line) in data.iter().zip(deflections).zip(&line) {
        if deflection != 0.0 {
            ratios[line].push(datum.measured / deflection);
        }
    }
    let steeper: Vec<f64> = ratios.iter().map(|ratios| median(ratios).unwrap_or(1.0)).collect();
    deflections.iter().zip(&line).map(|(deflection, &line)| deflection * steeper[line]).collect()
}

/// How many different ones there are of what is shown, as parts of the range: those that are the
/// same begin at the smallest of them. With a sign or without, a reading is one: both waves say as
/// much of one side as of the other.
fn levels(mut shown: Vec<f64>) -> usize {
    shown.sort_by(f64::total_cmp);
    let (mut count, mut first) = (0, f64::NEG_INFINITY);
    for x in shown {
        if x > first + 1.0 / LEVELS {
            (count, first) = (count + 1, x);
        }
    }
    count
}

/// The numbers of half swings that so many different x let see; nothing of too few.
fn halves(different: usize) -> Option<std::ops::RangeInclusive<usize>> {
    let seen = (FOR_EACH as f64 * different as f64 / TO_SEE_ONE) as usize;
    (different >= FEWEST).then_some(FOR_EACH..=seen.min(FOR_EACH * MOST_SWINGS))
}

/// Two waves of each group over x, less their value at the start where there is one.
fn waves(
    (along, place, follows): (Along, &str, String),
    half: usize,
    (x, start): (&[f64], Option<&[f64]>),
    groups: &[Arc<[usize]>],
    data: &[Datum],
) -> Entry {
    let turns = half as f64 / FOR_EACH as f64;
    let of_group = |(own, wave): (&Arc<[usize]>, Wave)| {
        let at =
            |&i: &usize| wave(TAU * turns * x[i]) - start.map_or(0.0, |start| wave(TAU * turns * start[i]));
        let weights = Weights { data: Arc::clone(own), values: own.iter().map(at).collect() };
        (parameter("um", 0.0, 0.5 * size(own, data), UNBOUNDED), Action::Shift(weights))
    };
    let waves: [Wave; 2] = [f64::cos, f64::sin];
    let all = groups.iter().flat_map(|own| waves.map(|wave| (own, wave)));
    let (parameters, actions) = all.map(of_group).unzip();
    let location =
        Location::Curve { label: format!("{}, {place}", along.name), follows, along: Some(along.variable) };
    (rival(location, parameters), actions)
}

#[cfg(test)]
mod tests {
    use super::super::TIME;
    use super::*;
    use crate::diagnosis::rig::recording::datum;
    use crate::rig::readings::Readings;
    use crate::spatial::Axis;

    #[test]
    fn each_period_has_two_waves_of_every_channel() {
        let row = |i: usize| format!("y,{},{},1,2\n", 1 + i % 4, 10 * i);
        let text = "axis,load_n,time_s,dy_um,dz_um\n".to_owned() + &(0..40).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 390.0)).collect();
        let entries = in_time(TIME, &coordinate, &data);
        // 1, 1½ … 12 swings, each always and since the zeros of the runs
        assert_eq!(entries.len(), 46);
        assert!(
            entries.iter().all(|(candidate, actions)| candidate.parameters.len() == 4 && actions.len() == 4)
        );
        // 20 times show eight swings, and eleven too few
        assert_eq!(in_time(TIME, &coordinate[..40].to_vec(), &data[..40]).len(), 30);
        assert!(in_time(TIME, &coordinate[..22].to_vec(), &data[..22]).is_empty());
    }

    #[test]
    fn the_wave_of_a_display_is_one_of_what_it_shows() {
        // 24 loads; dy reads twice what the model says, dz nothing
        let row = |i: usize| format!("y,{i},{},0\n", 20 * i);
        let text = "axis,load_n,dy_um,dz_um\n".to_owned() + &(1..25).map(row).collect::<String>();
        let mut data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let deflections: Vec<f64> =
            data.iter().map(|d| if d.channel == Axis::Y { 10e-6 * d.drive() } else { 0.0 }).collect();
        data[10].measured += 1e-4;
        let entries = of_displays(&data, &deflections);
        // 1, 1½ … 9½ swings of both displays, and of dy alone
        assert_eq!(entries.len(), 36);
        let label = "reading, 2 swings, dy";
        let (candidate, actions) =
            entries.iter().find(|(candidate, _)| candidate.location.to_string() == label).unwrap();
        // of 480 µm
        let Location::Curve { follows, .. } = &candidate.location else { panic!("a curve") };
        assert_eq!(follows, "repeats every 240 µm or so of the reading (dy)");
        let Action::Shift(weights) = &actions[1] else { panic!("a shift") };
        for (i, weight) in weights.iter() {
            let wave = (TAU * 2.0 * (i / 2 + 1) as f64 / 24.0).sin();
            assert!((weight - wave).abs() < 1e-12, "{i}: {weight}");
        }
    }

    #[test]
    fn readings_of_one_load_are_one_whatever_they_scatter_and_whichever_way_it_pulled() {
        // on the border of two fiftieths, and at the other side
        let around = |x: f64| [x - 0.002, x, x + 0.002];
        assert_eq!(levels([0.25, 0.5, 0.75, 1.0].into_iter().flat_map(around).collect()), 4);
        assert_eq!(levels(Vec::new()), 0);
        // four levels each way, read with a scatter, are too few to see anything that repeats
        let row = |i: usize| {
            let (sign, level) = (if (i / 4).is_multiple_of(2) { "" } else { "-" }, 1 + i % 4);
            format!("{sign}y,{}.0{},{},0\n", 5 * level, i % 7, 228 * level)
        };
        let text = "axis,load_n,dy_um,dz_um\n".to_owned() + &(0..48).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let deflections: Vec<f64> = data.iter().map(|d| 45.6e-6 * d.drive()).collect();
        assert!(of_displays(&data, &deflections).is_empty());
    }

    #[test]
    fn what_has_come_since_the_zero_is_nothing_at_the_first_reading_of_a_run() {
        let row = |i: usize| format!("y,{},{},{},1,2\n", 1 + i % 10, 1 + i / 10, 10 * i);
        let text =
            "axis,load_n,trial,time_s,dy_um,dz_um\n".to_owned() + &(0..40).map(row).collect::<String>();
        let data = datum::all(&Readings::from_text("f", &text).unwrap().rows);
        let coordinate: Coordinate = data.iter().map(|d| d.time.map(|t| t / 390.0)).collect();
        let entries = in_time(TIME, &coordinate, &data);
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
