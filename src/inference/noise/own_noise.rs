//! Sensors that scatter more or less than the others, by what a hypothesis leaves of their data.
//!
//! Where all noise is taken for alike, the noise of a sensor that is far worse than the others is
//! a shape that something draws: chance is as improbable in it as in the others. Its scale is
//! that of what the longest hypothesis leaves of its data, curve of the unknown included, so that
//! it is no part of what that explains; a hypothesis that leaves sensors uneven has a noise that
//! is not theirs, and is looked for again with the one that they show.
//!
//! A sensor that scatters in one series only, such as the loads along one axis, does not scatter:
//! something else does. And what a sensor repeats is no noise, and no reading is surer than its
//! display shows ([`noise_range`](Evidence::noise_range)).

use nalgebra::DVector;

use crate::inference::Evidence;
use crate::inference::noise::scatter::{Tails, in_spread};

/// Fewer data of a sensor do not say what it scatters by.
const FEWEST: usize = 8;
/// Within a factor, and within so many standard deviations of ln of the ratio of two scales, all
/// sensors scatter alike: by themselves, and where something else decides.
pub const CLEARLY: (f64, f64) = (2.0, 4.0);
pub const POSSIBLY: (f64, f64) = (1.5, 1.5);
/// A spread that differs by less than this factor is the same.
const SAME: f64 = 1.2;
/// Without one series it scatters less than this share of what it does in all: not the sensor.
const IN_ONE: f64 = 0.67;
/// Least and most times that a sensor scatters as the usual one does.
const TIMES: (f64, f64) = (0.1, 30.0);

/// The spread of the data whose errors, as far as they share none, are `residual`; `None` where
/// the one that they have is theirs.
pub fn own_spread(evidence: &Evidence, residual: &DVector<f64>, beyond: (f64, f64)) -> Option<Vec<f64>> {
    let count = evidence.sensor.iter().max().map_or(0, |last| last + 1);
    if count < 2 || evidence.is_spread_stated {
        return None;
    }
    let even = in_spread(evidence, residual);
    let all: Vec<usize> = (0..evidence.recorded).filter(|&row| evidence.counts(row)).collect();
    let tails = Tails::of(&even.select_rows(&all), evidence.rounding());
    let rows_of = |sensor: usize| -> Vec<usize> {
        all.iter().copied().filter(|&row| evidence.sensor[row] == sensor).collect()
    };
    let scales: Vec<Option<Scale>> =
        (0..count).map(|sensor| Scale::of_sensor(evidence, &even, &rows_of(sensor), &tails)).collect();
    let usual = usual(&scales)?;
    let times: Vec<f64> =
        scales.iter().map(|own| own.map_or(1.0, |own| own.over(&usual, &tails, beyond))).collect();
    let mut spread = evidence.spread.clone();
    for (row, spread) in spread.iter_mut().enumerate() {
        let (least, most) = evidence.noise_range[row];
        let new = *spread * times[evidence.sensor[row]];
        if new > *spread {
            *spread = new.min(TIMES.1).min(most / usual.scale).max(*spread);
        } else if new < *spread {
            *spread = new.max(TIMES.0).max(least / usual.scale).min(*spread);
        }
    }
    let is_other = |(new, old): (&f64, &f64)| (new / old).ln().abs() > SAME.ln();
    spread.iter().zip(&evidence.spread).any(is_other).then_some(spread)
}

/// What the data of a sensor scatter by.
#[derive(Clone, Copy)]
struct Scale {
    scale: f64,
    count: usize,
}

impl Scale {
    fn of_sensor(evidence: &Evidence, even: &DVector<f64>, rows: &[usize], tails: &Tails) -> Option<Scale> {
        // what is more than the differences of readings scatter by is no noise
        let most = rows.iter().fold(0.0, |most: f64, &row| most.max(evidence.noise_range[row].1));
        let of_rows = |rows: &[usize]| {
            let scale = || tails.scale_of(&even.select_rows(rows)).min(most / evidence.spread[rows[0]]);
            (rows.len() >= FEWEST).then(|| Scale { scale: scale(), count: rows.len() })
        };
        let whole = of_rows(rows)?;
        let mut series: Vec<usize> = rows.iter().map(|&row| evidence.series[row]).collect();
        series.sort_unstable();
        series.dedup();
        let without = |left_out: usize| {
            let others = rows.iter().copied().filter(|&row| evidence.series[row] != left_out);
            of_rows(&others.collect::<Vec<usize>>())
        };
        let least = series.into_iter().filter_map(without).min_by(|a, b| a.scale.total_cmp(&b.scale));
        Some(least.filter(|least| least.scale < IN_ONE * whole.scale).unwrap_or(whole))
    }

    /// Over another one; 1 where chance may make the difference. The scale of n data with tails of
    /// ν degrees of freedom is known to √((ν + 3)/(2·ν·n)) of it.
    fn over(&self, other: &Scale, tails: &Tails, beyond: (f64, f64)) -> f64 {
        let of_tails = if tails.freedom.is_finite() { 1.0 + 3.0 / tails.freedom } else { 1.0 };
        let variance = 0.5 * of_tails * ((self.count as f64).recip() + (other.count as f64).recip());
        let ratio = self.scale / other.scale;
        let (factor, sure) = beyond;
        if ratio.ln().abs() > factor.ln().max(sure * variance.sqrt()) { ratio } else { 1.0 }
    }
}

/// The scale of the datum in the middle, were all sorted by that of their sensors.
fn usual(scales: &[Option<Scale>]) -> Option<Scale> {
    let mut known: Vec<Scale> = scales.iter().copied().flatten().filter(|own| own.scale > 0.0).collect();
    known.sort_by(|a, b| a.scale.total_cmp(&b.scale));
    let all: usize = known.iter().map(|own| own.count).sum();
    let mut before = 0;
    known.into_iter().find(|own| {
        before += own.count;
        2 * before >= all
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::noise::scatter::OFF;
    use crate::statistics::Random;

    /// Three sensors in turn, of 60 data each, under loads along three axes; each datum of one
    /// scatters by so much.
    fn of_noise(seed: u64, noise: impl Fn(usize, usize) -> f64) -> Evidence {
        let mut random = Random::seeded(seed, 0);
        let (sensor, axis) = (|row: usize| row % 3, |row: usize| row / 60);
        let residual = DVector::from_fn(180, |row, _| noise(sensor(row), axis(row)) * random.normal());
        Evidence {
            sensor: (0..180).map(sensor).collect(),
            series: (0..180).map(|row| 3 * axis(row) + sensor(row)).collect(),
            ..Evidence::new(residual)
        }
    }

    fn spread(evidence: &Evidence) -> Option<[f64; 3]> {
        let spread = own_spread(evidence, &evidence.residual, CLEARLY)?;
        Some([spread[0], spread[1], spread[2]])
    }

    #[test]
    fn a_sensor_that_is_worse_or_better_has_its_own_spread() {
        for seed in 0..20 {
            let worse = of_noise(seed, |sensor, _| [1.0, 6.0, 1.0][sensor]);
            let [a, b, c] = spread(&worse).unwrap();
            assert!(a == 1.0 && c == 1.0 && (4.0..9.0).contains(&b), "{seed}: {a} {b} {c}");
            let better = of_noise(seed, |sensor, _| [5.0, 5.0, 1.0][sensor]);
            let [a, b, c] = spread(&better).unwrap();
            assert!(a == 1.0 && b == 1.0 && (0.13..0.3).contains(&c), "{seed}: {a} {b} {c}");
            // what it has already is not given once more
            let known: Vec<f64> = worse.sensor.iter().map(|k| [1.0, 6.0, 1.0][*k]).collect();
            assert_eq!(spread(&Evidence { spread: known, ..worse }), None, "{seed}");
            // however much that is
            let stiff = of_noise(seed, |sensor, _| [1.0, 50.0, 1.0][sensor]);
            let known: Vec<f64> = stiff.sensor.iter().map(|k| [1.0, 50.0, 1.0][*k]).collect();
            assert_eq!(spread(&Evidence { spread: known, ..stiff }), None, "{seed}");
        }
    }

    #[test]
    fn readings_far_off_say_nothing_of_a_sensor() {
        let mut evidence = of_noise(3, |_, _| 1.0);
        evidence.spread = (0..180).map(|row| [1.0, 6.0, 1.0][row % 3]).collect();
        evidence.weight = evidence.even_weight();
        for row in (0..180).filter(|row| row % 3 == 1) {
            evidence.residual[row] *= 6.0;
            if row % 5 < 2 {
                (evidence.residual[row], evidence.weight[row]) = (900.0, OFF);
            }
        }
        assert_eq!(spread(&evidence), None);
    }

    #[test]
    fn sensors_that_are_alike_stay_so() {
        for seed in 0..200 {
            assert_eq!(spread(&of_noise(seed, |_, _| 1.0)), None, "{seed}");
        }
    }

    #[test]
    fn what_scatters_along_one_axis_only_is_no_sensor() {
        for seed in 0..20 {
            let rattles = |sensor, axis| if (sensor, axis) == (1, 2) { 9.0 } else { 1.0 };
            assert_eq!(spread(&of_noise(seed, rattles)), None, "{seed}");
        }
    }

    #[test]
    fn what_a_sensor_repeats_is_no_noise() {
        let mut evidence = of_noise(1, |sensor, _| [1.0, 6.0, 1.0][sensor]);
        let ranges = |most: f64| (0..180).map(|row| (0.0, if row % 3 == 1 { most } else { 9.0 })).collect();
        evidence.noise_range = ranges(2.5);
        // over the noise of the others, beside the tails that all three together have
        let [_, b, _] = spread(&evidence).unwrap();
        assert!((2.0..4.0).contains(&b), "{b}");
        evidence.noise_range = ranges(0.7);
        assert_eq!(spread(&evidence), None);
    }

    /// Two sensors leave a wave that they repeat, and the third none of it.
    #[test]
    fn beside_what_others_repeat_no_sensor_is_a_good_one() {
        let mut evidence = of_noise(1, |sensor, _| [6.0, 6.0, 1.0][sensor]);
        evidence.noise_range = vec![(0.0, 1.3); 180];
        assert_eq!(spread(&evidence), None);
    }

    #[test]
    fn no_sensor_is_surer_than_its_display() {
        let mut evidence = of_noise(1, |sensor, _| [5.0, 5.0, 1.0][sensor]);
        evidence.noise_range = vec![(2.5, f64::INFINITY); 180];
        let [_, _, c] = spread(&evidence).unwrap();
        assert!((0.4..0.7).contains(&c), "{c}");
    }
}
