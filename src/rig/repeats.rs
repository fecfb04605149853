//! Repeats of a reading: their averages, their scatter, and whether whole trials differ.

use std::collections::{BTreeMap, HashMap};

use nalgebra::{DMatrix, DVector};

use super::sample::{Point, Sample};
use crate::error::{Error, Result};
use crate::least_squares::{self, Options};
use crate::limits;
use crate::parallel::checkpoint;
use crate::statistics;
use crate::units::UM;

/// Below this probability trials are said to differ: they are cheap to believe in, and costly to
/// overlook.
const TRIALS_DIFFER: f64 = 0.05;

/// Averages of the repeats.
pub(super) fn average(samples: &[Sample]) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for (sample, place) in samples.iter().zip(places(samples)) {
        if place == points.len() {
            let (load, phase) = (sample.load, sample.phase);
            points.push(Point { load, phase, mean: 0.0, count: 0.0, residual: 0.0 });
        }
        let point = &mut points[place];
        point.count += 1.0;
        point.mean += (sample.offset - point.mean) / point.count;
    }
    points
}

/// Which average each sample belongs to, numbered as they come.
fn places(samples: &[Sample]) -> Vec<usize> {
    let mut known = HashMap::new();
    samples
        .iter()
        .map(|sample| {
            let next = known.len();
            *known.entry(sample.repeated()).or_insert(next)
        })
        .collect()
}

/// A sum of squares with its degrees of freedom.
#[derive(Debug, Clone, Copy)]
pub(super) struct Squares {
    pub sum: f64,
    pub dof: usize,
}

impl Squares {
    pub(super) fn mean_square(self) -> Option<f64> {
        mean_square(self.sum, self.dof)
    }
}

pub(super) fn mean_square(sum: f64, dof: usize) -> Option<f64> {
    (dof > 0).then(|| sum / dof as f64)
}

/// How the repeats scatter about their averages.
pub(super) struct Repeats {
    /// About the averages alone.
    pub all: Squares,
    /// About the averages and an offset and a slope of each trial.
    pub within_trials: Squares,
    /// Number of trials.
    pub trials: usize,
}

/// So many trials are eliminated one by one: their columns would fill the memory.
const MANY_TRIALS: usize = 50;

impl Repeats {
    pub(super) fn new(samples: &[Sample], points: &[Point]) -> Result<Repeats> {
        let place = places(samples);
        // what is left of one number per reading once its average over the repeats is taken off
        let centred = |value: &dyn Fn(&Sample) -> f64| {
            checkpoint();
            let mut averages = vec![0.0; points.len()];
            for (sample, &k) in samples.iter().zip(&place) {
                averages[k] += value(sample) / points[k].count;
            }
            let left = samples.iter().zip(&place).map(|(s, &k)| value(s) - averages[k]);
            DVector::from_iterator(samples.len(), left)
        };
        let deviations = centred(&|s| s.offset);
        let all = Squares { sum: deviations.norm_squared(), dof: samples.len() - points.len() };
        let mut trials: Vec<usize> = samples.iter().map(|s| s.trial).collect();
        trials.sort_unstable();
        trials.dedup();
        let mut repeats = Repeats { all, within_trials: all, trials: trials.len() };
        if trials.len() > 1 && 2 * (trials.len() - 1) < all.dof {
            if trials.len() > MANY_TRIALS {
                if points.len() > limits::REPEATED_LOADS {
                    return Err(Error::NotApplicable {
                        what: "a comparison of trials".into(),
                        why: format!(
                            "{} trials at {} different loads need too much memory; the limit is {}",
                            trials.len(),
                            points.len(),
                            limits::REPEATED_LOADS
                        ),
                        hint: "round the loads to what was hung on, so that repeats share one".into(),
                    });
                }
                repeats.within_trials = within_trials(samples, &place, points.len(), &deviations);
                return Ok(repeats);
            }
            let largest = samples.iter().fold(0.0, |max: f64, s| s.load.max(max));
            let columns: Vec<DVector<f64>> = trials
                .iter()
                .flat_map(|&trial| [0, 1].map(|power| (trial, power)))
                .map(|(trial, power)| {
                    centred(&|s| if s.trial == trial { (s.load / largest).powi(power) } else { 0.0 })
                        // a load that only this trial has: nothing but rounding
                        .map(|x| if x.abs() < 1e-12 { 0.0 } else { x })
                })
                .collect();
            let design = DMatrix::from_columns(&columns);
            let fit = least_squares::linear(&design, &deviations, None, &Options::default())?;
            repeats.within_trials =
                Squares { sum: fit.sum_of_squares, dof: all.dof.saturating_sub(fit.covariance.rank) };
        }
        Ok(repeats)
    }

    /// True where offsets and slopes of the trials explain more of the scatter than chance would.
    pub(super) fn trials_differ(&self) -> Result<bool> {
        let dof = self.all.dof - self.within_trials.dof;
        let explained = mean_square(self.all.sum - self.within_trials.sum, dof);
        let (Some(explained), Some(left)) = (explained, self.within_trials.mean_square()) else {
            return Ok(false);
        };
        let p_value = match left > 0.0 {
            true => statistics::f_survival(explained / left, dof as f64, self.within_trials.dof as f64)?,
            false => 1.0,
        };
        Ok(p_value < TRIALS_DIFFER)
    }
}

/// What is left of the deviations once each of `points` averages and each trial's offset and slope
/// are fitted to them.
///
/// Of many trials: offset and slope concern one of them only, so that they are eliminated trial by
/// trial, which leaves normal equations for the averages. Time and memory grow with the readings,
/// however many trials they are in.
fn within_trials(samples: &[Sample], place: &[usize], points: usize, deviations: &DVector<f64>) -> Squares {
    /// Length, relative to what it was, below which nothing but rounding is left of a direction.
    const ROUNDING: f64 = 1e-9;
    let largest = samples.iter().fold(0.0, |max: f64, s| s.load.max(max)).max(f64::MIN_POSITIVE);
    let mut of_trial: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, sample) in samples.iter().enumerate() {
        of_trial.entry(sample.trial).or_default().push(i);
    }
    let (mut gram, mut product) = (DMatrix::<f64>::zeros(points, points), DVector::<f64>::zeros(points));
    let (mut square, mut fitted) = (0.0, 0);
    for (&k, deviation) in place.iter().zip(deviations.iter()) {
        gram[(k, k)] += 1.0;
        product[k] += deviation;
        square += deviation * deviation;
    }
    for own in of_trial.values() {
        let count = own.len() as f64;
        let mean = own.iter().map(|&i| samples[i].load / largest).sum::<f64>() / count;
        let about: Vec<f64> = own.iter().map(|&i| samples[i].load / largest - mean).collect();
        let length = about.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut directions = vec![vec![1.0 / count.sqrt(); own.len()]];
        if length > ROUNDING * count.sqrt() {
            directions.push(about.iter().map(|x| x / length).collect());
        }
        for direction in directions {
            let mut along: BTreeMap<usize, f64> = BTreeMap::new();
            let mut share = 0.0;
            for (&i, x) in own.iter().zip(&direction) {
                *along.entry(place[i]).or_default() += x;
                share += x * deviations[i];
            }
            let along: Vec<(usize, f64)> = along.into_iter().collect();
            for &(k, x) in &along {
                checkpoint();
                product[k] -= x * share;
                let mut column = gram.column_mut(k);
                along.iter().for_each(|&(l, y)| column[l] -= x * y);
            }
            square -= share * share;
            fitted += 1;
        }
    }
    let (explained, rank) = explained(&gram, &product, ROUNDING);
    square -= explained;
    fitted += rank;
    Squares { sum: square.max(0.0), dof: samples.len().saturating_sub(fitted) }
}

/// bᵀ·G⁺·b and the rank of a positive semidefinite G, for b in its range: Cholesky's triangle, the
/// largest pivot first, to where a pivot is but `rounding` of the first. Column by column, for it
/// may be asked to stop.
fn explained(gram: &DMatrix<f64>, b: &DVector<f64>, rounding: f64) -> (f64, usize) {
    let mut pivots = gram.diagonal();
    let least = rounding * pivots.max();
    let (mut triangle, mut rest) = (DMatrix::<f64>::zeros(gram.nrows(), gram.nrows()), b.clone());
    let mut sum = 0.0;
    for rank in 0..gram.nrows() {
        checkpoint();
        let largest = pivots.imax();
        if pivots[largest] <= least {
            return (sum, rank);
        }
        let root = pivots[largest].sqrt();
        let known = triangle.columns(0, rank);
        let column = (gram.column(largest) - known * known.row(largest).transpose()) / root;
        let share = rest[largest] / root;
        rest.axpy(-share, &column, 1.0);
        pivots -= column.component_mul(&column);
        pivots[largest] = 0.0;
        triangle.set_column(rank, &column);
        sum += share * share;
    }
    (sum, gram.nrows())
}

/// The decimal place of a micrometre that the offsets are rounded to, m; 0 where they show none.
pub(super) fn resolution(samples: &[Sample]) -> f64 {
    const MOST_DECIMALS: i32 = 6;
    let is_multiple = |offset: f64, place: f64| {
        let steps = offset / UM / place;
        (steps - steps.round()).abs() <= 8.0 * f64::EPSILON * steps.abs()
    };
    let places = (0..=MOST_DECIMALS).map(|decimals| 10f64.powi(-decimals));
    let found = places.into_iter().find(|&place| samples.iter().all(|s| is_multiple(s.offset, place)));
    found.map_or(0.0, |place| place * UM)
}

#[cfg(test)]
pub(super) mod tests {
    use approx::assert_relative_eq;

    use super::super::readings::Phase;
    use super::*;

    pub fn samples(rows: &[(f64, usize, f64)]) -> Vec<Sample> {
        let sample = |&(load, trial, offset): &(f64, usize, f64)| Sample {
            load,
            offset,
            phase: Phase::Load,
            trial,
            line: 0,
        };
        rows.iter().map(sample).collect()
    }

    #[test]
    fn averages_are_those_of_one_load_and_one_phase() {
        let mut rows = samples(&[(1.0, 0, 2.0), (1.0, 0, 5.0), (2.0, 0, 7.0), (1.0, 0, 99.0)]);
        rows[3].phase = Phase::Unload;
        let points = average(&rows);
        assert_eq!(points.len(), 3);
        assert_eq!((points[0].mean, points[0].count), (3.5, 2.0));
        // 2 · 1.5²
        let repeats = Repeats::new(&rows, &points).unwrap();
        assert_relative_eq!(repeats.all.sum, 4.5, max_relative = 1e-14);
        assert_eq!(repeats.all.dof, 1);
    }

    /// Trials y = (10 + a)·F + b with wobbles that are neither offset nor slope.
    fn trials(shifts: &[(f64, f64)], wobble: f64) -> Vec<(f64, usize, f64)> {
        let mut rows = Vec::new();
        for (t, (a, b)) in shifts.iter().enumerate() {
            let w = if t % 2 == 0 { wobble } else { -wobble };
            for (load, sign) in [(1.0, 1.0), (2.0, -1.0), (3.0, -1.0), (4.0, 1.0)] {
                rows.push((load, t, (10.0 + a) * load + b + sign * w));
            }
        }
        rows
    }

    #[test]
    fn offsets_and_slopes_of_trials_are_told_from_the_rest() {
        let rows = trials(&[(0.1, 3.0), (-0.2, 0.0), (0.0, -1.0), (0.1, 0.0)], 0.5);
        let rows = samples(&rows);
        let repeats = Repeats::new(&rows, &average(&rows)).unwrap();
        // what is left is the wobbles: 16 · 0.5²
        assert_relative_eq!(repeats.within_trials.sum, 4.0, max_relative = 1e-9);
        assert_eq!((repeats.all.dof, repeats.within_trials.dof, repeats.trials), (12, 6, 4));
        assert!(repeats.trials_differ().unwrap());
        // a trial that stopped half way: its offset and slope are still its own
        let rows = &rows[..14];
        let repeats = Repeats::new(rows, &average(rows)).unwrap();
        assert_eq!((repeats.all.dof, repeats.within_trials.dof), (10, 4));
    }

    #[test]
    fn a_resolution_is_the_last_decimal_that_is_used() {
        let found = |micrometres: &[f64]| {
            let rows: Vec<_> = micrometres.iter().map(|um| (1.0, 0, um * UM)).collect();
            resolution(&samples(&rows)) / UM
        };
        assert_eq!(found(&[50.0, -101.0, 0.0]), 1.0);
        assert_relative_eq!(found(&[50.0, 101.5]), 0.1);
        assert_relative_eq!(found(&[2798.826, 5576.824]), 0.001);
        assert_eq!(found(&[std::f64::consts::PI, 1.0]), 0.0);
    }
}
