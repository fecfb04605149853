//! One load–deflection line: averaged repeats, a slope common to loading and unloading, and whether it is straight.
//!
//! Repeats at one load are averaged before any inference: they share whatever was wrong with that load, and taken
//! as independent they make every line look better known than it is. With the averages ȳ_k of n_k readings at
//! load F_k,
//!
//! ```text
//! ȳ_k = c·F_k + b         weights n_k; b of its own for loading and for unloading
//! lack of fit   s_f² = Σ n_k (ȳ_k − ŷ_k)² / (K − p)     K averages, p coefficients
//! pure error    s_e² = ΣΣ (y_ki − ȳ_k)² / (N − K)       N readings
//! F = s_f² / s_e²
//! ```
//!
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., § 2.1.) A sensor of resolution q moves every
//! average by up to q/2 however often it is read, which repeats do not show: s_e² counts as n·q²/12 at least.
//!
//! Standard errors rest on both variances together, or on s_f² alone where it is the larger one with p < 0.25: what
//! makes the line crooked then counts too. (That level is T. A. Bancroft's for pooling, *Biometrics* 20 (1964) 427–442.)
//!
//! The readings of one trial may share an error too: a zero that was off, a rod that sat differently. Where an F test
//! finds that trials differ by an offset or a slope of their own, these leave the pure error (with their degrees of
//! freedom), and the trial is the unit that the standard errors count. With the residuals e of the readings and
//! the T trials t,
//!
//! ```text
//! cov(b, c) = T/(T − 1) · U·(Σ_t g_t g_tᵀ)·U,   g_t = Σ x e over the trial,   U = (Σ x xᵀ)⁻¹;   T − 1 dof
//! ```
//!
//! which is the scatter of the trials' own lines where every trial has every load.
//! (K.-Y. Liang, S. L. Zeger, *Biometrika* 73 (1986) 13–22.)

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::readings::{Axis, Direction, Phase};
use crate::error::Result;
use crate::least_squares::{self, Noise, Options, Robust};
use crate::statistics::{self, Estimate};
use crate::units::UM;

/// Below this probability a line is called crooked.
pub(super) const CROOKED: f64 = 0.01;
/// Below this probability the averages' own distance from the line decides how well it is known.
const LEAVES_THE_LINE: f64 = 0.25;
/// Below this probability trials are said to differ: they are cheap to believe in, and costly to overlook.
const TRIALS_DIFFER: f64 = 0.05;

/// What a line is fitted to: one channel under loads along one direction at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineKey {
    /// Direction of the load in {T}.
    pub direction: Direction,
    /// Axis of the offset in {T}.
    pub channel: Axis,
    /// Station of the load, m; `None`: the tip.
    pub load_station: Option<f64>,
    /// Station of the sensor, m; `None`: the tip.
    pub read_station: Option<f64>,
}

/// One reading of a line.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Magnitude of the load, N.
    pub load: f64,
    /// Offset of the channel, m.
    pub offset: f64,
    /// Loading or unloading.
    pub phase: Phase,
    /// Which trial it belongs to; all alike where the file names none.
    pub trial: usize,
    /// Line in the file.
    pub line: usize,
}

/// The average of the repeats at one load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Magnitude of the load, N.
    pub load: f64,
    /// Loading or unloading.
    pub phase: Phase,
    /// Mean offset, m.
    pub mean: f64,
    /// Number of readings (their weights' sum in a robust fit).
    pub count: f64,
    /// Offset less that of the fitted line, m.
    pub residual: f64,
}

impl Point {
    fn has(&self, sample: &Sample) -> bool {
        self.load == sample.load && self.phase == sample.phase
    }
}

/// A fitted line.
#[derive(Debug, Clone)]
pub struct Line {
    /// What was fitted.
    pub key: LineKey,
    /// Compliance: offset per force, the force counted along the positive axis of {T}, m/N.
    pub slope: Estimate,
    /// Offset at no load on the loading line, m.
    pub intercept: Estimate,
    /// Offset at no load on the unloading line, m.
    pub unload_intercept: Option<Estimate>,
    /// Load at which the loading line crosses the load axis, N: what friction takes off every load.
    pub load_offset: Option<Estimate>,
    /// Half the distance between the loading and the unloading line, N: Coulomb friction, free of any offset.
    pub friction: Option<Estimate>,
    /// Averages with their residuals.
    pub points: Vec<Point>,
    /// Number of readings.
    pub count: usize,
    /// Standard deviation of one reading about the line, m.
    pub residual_sd: Option<f64>,
    /// Standard deviation of one reading about the average of its repeats, m; where trials differ, about its trial.
    pub noise_sd: Option<f64>,
    /// The readings of a trial share an error, and the standard errors come from the scatter of trials.
    pub trials_differ: bool,
    /// Whether the line is straight.
    pub lack_of_fit: Option<LackOfFit>,
    /// The same readings with a quadratic term, where there are four different loads or more.
    pub quadratic: Option<Quadratic>,
    /// Lines of the file whose readings a robust fit trusts less than half.
    pub distrusted: Vec<usize>,
}

/// F test of a curve against the scatter of repeats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// s_f² / s_e².
    pub f: f64,
    /// K − p.
    pub dof_fit: usize,
    /// N − K, less what trials take up where they differ.
    pub dof_repeats: usize,
    /// Probability of so large an F, were the curve right and all repeats independent.
    pub p_value: f64,
}

/// ȳ = b0 + b1·F + b2·F².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadratic {
    /// b0 (m), b1 (m/N), b2 (m/N²), F the magnitude of the load.
    pub coefficients: [Estimate; 3],
    /// Standard deviation of one reading about the curve, m.
    pub residual_sd: Option<f64>,
    /// Whether the curve fits.
    pub lack_of_fit: Option<LackOfFit>,
}

impl LineKey {
    /// "dz under load z": channel and load direction, with the stations where they are not the tip.
    pub fn label(&self) -> String {
        let at = |station: Option<f64>, what| match station {
            Some(s) => format!(", {what} at {:.0} mm", s * 1e3),
            None => String::new(),
        };
        let (load, read) = (at(self.load_station, "loaded"), at(self.read_station, "read"));
        format!("d{} under load {}{load}{read}", self.channel, self.direction)
    }
}

impl Line {
    /// Fits a line to `samples`; `None` where they have fewer than two different loads.
    ///
    /// # Errors
    /// As [`least_squares::linear`].
    pub fn fit(key: LineKey, samples: &[Sample], robust: Robust) -> Result<Option<Line>> {
        // the rod was zeroed unloaded: such rows say nothing of the line that friction shifts
        let loaded: Vec<Sample> = samples.iter().copied().filter(|s| s.load != 0.0).collect();
        let samples = if distinct_loads(&loaded, None) >= 2 { loaded } else { samples.to_vec() };
        if distinct_loads(&samples, None) < 2 {
            return Ok(None);
        }
        let [up, down] = [Phase::Load, Phase::Unload].map(|p| distinct_loads(&samples, Some(p)));
        let columns = Columns { degree: 1, unload: up.min(down) >= 1 && up.max(down) >= 2 };
        let trust = trust(&samples, columns, robust)?;
        let line = Curve::fit(columns, &samples, &trust)?;

        let [b, c] = [0, 1].map(|i| line.estimate(i));
        let sign = f64::from(key.direction.sign);
        let quadratic = match distinct_loads(&samples, None) {
            0..=3 => None,
            _ => Some(Curve::fit(Columns { degree: 2, ..columns }, &samples, &trust)?),
        };
        Ok(Some(Line {
            key,
            slope: c.times(sign),
            intercept: b,
            unload_intercept: columns.unload.then(|| line.combination(&[1.0, 0.0, 1.0])),
            load_offset: line.ratio(&[-1.0, 0.0, 0.0]),
            friction: if columns.unload { line.ratio(&[0.0, 0.0, 0.5]) } else { None },
            count: samples.len(),
            residual_sd: line.residual_sd,
            noise_sd: line.noise_sd,
            trials_differ: line.trials_differ,
            lack_of_fit: line.lack_of_fit,
            quadratic: quadratic.map(|curve| Quadratic {
                coefficients: [0, 1, 2].map(|i| curve.estimate(i)),
                residual_sd: curve.residual_sd,
                lack_of_fit: curve.lack_of_fit,
            }),
            distrusted: samples.iter().zip(&trust).filter(|(_, t)| **t < 0.5).map(|(s, _)| s.line).collect(),
            points: line.points,
        }))
    }
}

/// Columns of the design matrix: 1, F, …, F^degree, then 1 on unloading.
#[derive(Debug, Clone, Copy)]
struct Columns {
    degree: usize,
    unload: bool,
}

impl Columns {
    fn count(self) -> usize {
        self.degree + 1 + usize::from(self.unload)
    }

    fn entry(self, column: usize, load: f64, phase: Phase) -> f64 {
        if column <= self.degree {
            load.powi(column as i32)
        } else {
            f64::from(u8::from(phase == Phase::Unload))
        }
    }
}

/// A polynomial through the averages, with its tests.
struct Curve {
    coefficients: DVector<f64>,
    /// Covariances that the coefficients may have, with their degrees of freedom; the larger one counts.
    covariances: Vec<(DMatrix<f64>, usize)>,
    points: Vec<Point>,
    residual_sd: Option<f64>,
    noise_sd: Option<f64>,
    trials_differ: bool,
    lack_of_fit: Option<LackOfFit>,
}

impl Curve {
    fn fit(columns: Columns, samples: &[Sample], trust: &[f64]) -> Result<Curve> {
        let mut points = average(samples, trust);
        let design = DMatrix::from_fn(points.len(), columns.count(), |k, j| {
            columns.entry(j, points[k].load, points[k].phase)
        });
        let means = DVector::from_iterator(points.len(), points.iter().map(|p| p.mean));
        let counts = DVector::from_iterator(points.len(), points.iter().map(|p| p.count));
        let options = Options { noise: Noise::Known(1.0), ..Options::default() };
        let fit = least_squares::linear(&design, &means, Some(&counts), &options)?;

        let fitted = &design * &fit.parameters;
        for (point, y) in points.iter_mut().zip(fitted.iter()) {
            point.residual = point.mean - y;
        }
        let between: f64 = points.iter().map(|p| p.count * p.residual.powi(2)).sum();
        let dof_fit = points.len().saturating_sub(fit.covariance.rank);
        let repeats = Repeats::new(samples, trust, &points)?;
        let (trials, noise) = match repeats.trials_differ()? {
            true => (Some(repeats.trials), repeats.within_trials),
            false => (None, repeats.all),
        };
        let fit_variance = mean_square(between, dof_fit);
        let least = trusted_count(trust) as f64 / points.len() as f64 * resolution(samples).powi(2) / 12.0;
        let noise_variance = noise.mean_square().map(|variance| variance.max(least));
        let lack_of_fit = match (fit_variance, noise_variance) {
            (Some(fit_variance), Some(variance)) if variance > 0.0 => {
                let f = fit_variance / variance;
                let p_value = statistics::f_survival(f, dof_fit as f64, noise.dof as f64)?;
                Some(LackOfFit { f, dof_fit, dof_repeats: noise.dof, p_value })
            }
            _ => None,
        };
        let unit = &fit.covariance.matrix;
        let stays = lack_of_fit.is_some_and(|test| test.p_value >= LEAVES_THE_LINE);
        let of_repeats = match (trials, noise_variance) {
            (Some(trials), _) => {
                Some((trial_covariance(columns, &fit.parameters, unit, samples, trust), trials - 1))
            }
            (None, Some(variance)) if stays => {
                let dof = dof_fit + noise.dof;
                Some((unit * ((between + variance * noise.dof as f64) / dof as f64), dof))
            }
            (None, variance) => variance.map(|variance| (unit * variance, noise.dof)),
        };
        let of_fit = fit_variance.filter(|_| !stays).map(|variance| (unit * variance, dof_fit));
        let covariances = of_repeats.into_iter().chain(of_fit).collect();
        Ok(Curve {
            coefficients: fit.parameters,
            covariances,
            points,
            residual_sd: mean_square(between + repeats.all.sum, dof_fit + repeats.all.dof).map(f64::sqrt),
            noise_sd: noise.mean_square().map(f64::sqrt),
            trials_differ: trials.is_some(),
            lack_of_fit,
        })
    }

    fn estimate(&self, index: usize) -> Estimate {
        let mut row = vec![0.0; self.coefficients.len()];
        row[index] = 1.0;
        self.combination(&row)
    }

    /// The linear combination wᵀβ with its standard error √(wᵀ Σ w).
    fn combination(&self, row: &[f64]) -> Estimate {
        let mut weights = DVector::zeros(self.coefficients.len());
        for (w, r) in weights.iter_mut().zip(row) {
            *w = *r;
        }
        let variance = |covariance: &DMatrix<f64>| (weights.transpose() * covariance * &weights)[(0, 0)];
        let variances = self.covariances.iter().map(|(covariance, dof)| (variance(covariance), *dof));
        let largest = variances.max_by(|a, b| a.0.total_cmp(&b.0));
        Estimate {
            value: weights.dot(&self.coefficients),
            std_error: largest.map(|(variance, _)| variance.sqrt()),
            dof: largest.map_or(0, |(_, dof)| dof),
        }
    }

    /// wᵀβ / β₁, a load, by propagation to first order: d(u/c) = (du − (u/c) dc)/c. `None` without a slope that
    /// differs from zero: the 95 % interval of such a ratio is unbounded (E. C. Fieller, *JRSS B* 16 (1954) 175–185).
    fn ratio(&self, row: &[f64]) -> Option<Estimate> {
        let slope = self.estimate(1);
        if slope.half_width_95().is_some_and(|half_width| slope.value.abs() <= half_width) {
            return None;
        }
        let value = self.combination(row).value / slope.value;
        let mut gradient: Vec<f64> =
            row.iter().take(self.coefficients.len()).map(|w| w / slope.value).collect();
        gradient[1] -= value / slope.value;
        let spread = self.combination(&gradient);
        (value.is_finite() && spread.std_error.is_none_or(f64::is_finite))
            .then_some(Estimate { value, ..spread })
    }
}

/// A sum of squares with its degrees of freedom.
#[derive(Debug, Clone, Copy)]
struct Squares {
    sum: f64,
    dof: usize,
}

impl Squares {
    fn mean_square(self) -> Option<f64> {
        mean_square(self.sum, self.dof)
    }
}

fn mean_square(sum: f64, dof: usize) -> Option<f64> {
    (dof > 0).then(|| sum / dof as f64)
}

/// How the repeats scatter about their averages.
struct Repeats {
    /// About the averages alone.
    all: Squares,
    /// About the averages and an offset and a slope of each trial.
    within_trials: Squares,
    /// Number of trials.
    trials: usize,
}

impl Repeats {
    fn new(samples: &[Sample], trust: &[f64], points: &[Point]) -> Result<Repeats> {
        let used: Vec<(&Sample, f64)> =
            samples.iter().zip(trust.iter().copied()).filter(|(_, weight)| *weight > 0.0).collect();
        let place: Vec<usize> =
            used.iter().filter_map(|(s, _)| points.iter().position(|p| p.has(s))).collect();
        // what is left of one number per reading once its weighted average over the repeats is taken off
        let centred = |of: &dyn Fn(&Sample) -> f64| {
            let mut averages = vec![0.0; points.len()];
            for ((sample, weight), &k) in used.iter().zip(&place) {
                averages[k] += of(sample) * weight / points[k].count;
            }
            DVector::from_iterator(
                used.len(),
                used.iter().zip(&place).map(|((s, _), &k)| of(s) - averages[k]),
            )
        };
        let deviations = centred(&|s| s.offset);
        let weights = DVector::from_iterator(used.len(), used.iter().map(|(_, weight)| *weight));
        let all = Squares {
            sum: deviations.component_mul(&deviations).dot(&weights),
            dof: used.len() - points.len(),
        };
        let mut trials: Vec<usize> = used.iter().map(|(s, _)| s.trial).collect();
        trials.sort_unstable();
        trials.dedup();
        let mut repeats = Repeats { all, within_trials: all, trials: trials.len() };
        if trials.len() > 1 && 2 * (trials.len() - 1) < all.dof {
            let largest = used.iter().fold(0.0, |max: f64, (s, _)| s.load.max(max));
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
            let fit = least_squares::linear(&design, &deviations, Some(&weights), &Options::default())?;
            repeats.within_trials =
                Squares { sum: fit.sum_of_squares, dof: all.dof.saturating_sub(fit.covariance.rank) };
        }
        Ok(repeats)
    }

    /// True where offsets and slopes of the trials explain more of the scatter than chance would.
    fn trials_differ(&self) -> Result<bool> {
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

/// Covariance of the coefficients by the scatter of whole trials; `unit` is theirs per unit variance of a reading.
fn trial_covariance(
    columns: Columns,
    coefficients: &DVector<f64>,
    unit: &DMatrix<f64>,
    samples: &[Sample],
    trust: &[f64],
) -> DMatrix<f64> {
    let mut pulls: BTreeMap<usize, DVector<f64>> = BTreeMap::new();
    for (sample, weight) in samples.iter().zip(trust).filter(|(_, weight)| **weight > 0.0) {
        let row = DVector::from_fn(columns.count(), |j, _| columns.entry(j, sample.load, sample.phase));
        let residual = sample.offset - row.dot(coefficients);
        *pulls.entry(sample.trial).or_insert_with(|| DVector::zeros(columns.count())) +=
            row * (weight * residual);
    }
    let trials = pulls.len() as f64;
    let scatter: DMatrix<f64> = pulls.values().map(|g| g * g.transpose()).sum();
    unit * scatter * unit * (trials / (trials - 1.0))
}

fn trusted_count(trust: &[f64]) -> usize {
    trust.iter().filter(|weight| **weight > 0.0).count()
}

/// The decimal place of a micrometre that the offsets are rounded to, m; 0 where they show none.
fn resolution(samples: &[Sample]) -> f64 {
    const MOST_DECIMALS: i32 = 6;
    let is_multiple = |offset: f64, place: f64| {
        let steps = offset / UM / place;
        (steps - steps.round()).abs() <= 8.0 * f64::EPSILON * steps.abs()
    };
    let places = (0..=MOST_DECIMALS).map(|decimals| 10f64.powi(-decimals));
    let found = places.into_iter().find(|&place| samples.iter().all(|s| is_multiple(s.offset, place)));
    found.map_or(0.0, |place| place * UM)
}

/// Averages of the repeats.
fn average(samples: &[Sample], trust: &[f64]) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for (sample, &weight) in samples.iter().zip(trust).filter(|(_, weight)| **weight > 0.0) {
        match points.iter_mut().find(|point| point.has(sample)) {
            Some(point) => {
                point.count += weight;
                point.mean += (sample.offset - point.mean) * weight / point.count;
            }
            None => points.push(Point {
                load: sample.load,
                phase: sample.phase,
                mean: sample.offset,
                count: weight,
                residual: 0.0,
            }),
        }
    }
    points
}

/// How much each single reading is trusted, 0 to 1: all 1 unless the fit is robust.
fn trust(samples: &[Sample], columns: Columns, robust: Robust) -> Result<Vec<f64>> {
    if robust == Robust::None {
        return Ok(vec![1.0; samples.len()]);
    }
    let design = DMatrix::from_fn(samples.len(), columns.count(), |k, j| {
        columns.entry(j, samples[k].load, samples[k].phase)
    });
    let offsets = DVector::from_iterator(samples.len(), samples.iter().map(|s| s.offset));
    let options = Options { robust, ..Options::default() };
    let fit = least_squares::linear(&design, &offsets, None, &options)?;
    Ok(fit.weights.iter().copied().collect())
}

fn distinct_loads(samples: &[Sample], phase: Option<Phase>) -> usize {
    let is_counted = |s: &&Sample| phase.is_none_or(|p| p == s.phase);
    let mut loads: Vec<f64> = samples.iter().filter(is_counted).map(|s| s.load).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    loads.len()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    fn samples(rows: &[(f64, usize, f64)]) -> Vec<Sample> {
        let sample = |&(load, trial, offset): &(f64, usize, f64)| Sample {
            load,
            offset,
            phase: Phase::Load,
            trial,
            line: 0,
        };
        rows.iter().map(sample).collect()
    }

    const STRAIGHT: Columns = Columns { degree: 1, unload: false };

    fn curve(rows: &[(f64, usize, f64)]) -> Curve {
        Curve::fit(STRAIGHT, &samples(rows), &vec![1.0; rows.len()]).unwrap()
    }

    #[test]
    fn averages_weigh_readings_by_their_trust_and_leave_out_the_distrusted() {
        let rows = samples(&[(1.0, 0, 2.0), (1.0, 0, 5.0), (2.0, 0, 7.0), (1.0, 0, 99.0)]);
        let points = average(&rows, &[1.0, 0.5, 1.0, 0.0]);
        assert_eq!(points.len(), 2);
        assert_eq!((points[0].mean, points[0].count), (3.0, 1.5));
        // 1·1² + ½·2²; two trusted readings more than averages would need three
        let repeats = Repeats::new(&rows, &[1.0, 0.5, 1.0, 0.0], &points).unwrap();
        assert_relative_eq!(repeats.all.sum, 3.0, max_relative = 1e-14);
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
        let trust = vec![1.0; rows.len()];
        let repeats = Repeats::new(&rows, &trust, &average(&rows, &trust)).unwrap();
        // what is left is the wobbles: 16 · 0.5²
        assert_relative_eq!(repeats.within_trials.sum, 4.0, max_relative = 1e-9);
        assert_eq!((repeats.all.dof, repeats.within_trials.dof, repeats.trials), (12, 6, 4));
        assert!(repeats.trials_differ().unwrap());
        // a trial that stopped half way: its offset and slope are still its own
        let rows = &rows[..14];
        let repeats = Repeats::new(rows, &trust[..14], &average(rows, &trust[..14])).unwrap();
        assert_eq!((repeats.all.dof, repeats.within_trials.dof), (10, 4));
    }

    #[test]
    fn loads_of_one_trial_alone_tell_nothing_about_trials() {
        let rows = [(0.1, 0, 1.0), (0.1, 0, 1.1), (0.3, 1, 3.0), (0.3, 1, 3.1), (0.7, 2, 7.2), (0.7, 2, 7.1)];
        let curve = curve(&rows);
        assert!(!curve.trials_differ);
        assert_eq!(curve.lack_of_fit.unwrap().dof_repeats, 3);
    }

    #[test]
    fn a_ratio_has_the_error_that_both_its_numbers_give_it() {
        let rows = [(1.0, 0, 8.1), (2.0, 0, 18.0), (3.0, 0, 27.8), (4.0, 0, 38.2)];
        let curve = curve(&rows);
        let [b, c] = [0, 1].map(|i| curve.estimate(i));
        let crossing = curve.ratio(&[-1.0, 0.0]).unwrap();
        assert_relative_eq!(crossing.value, -b.value / c.value, max_relative = 1e-14);
        // x = −b/c: s_x² = (s_b² + x² s_c² + 2x cov)/c², cov(b, c) = −F̄ s_c²
        let (x, s_c) = (crossing.value, c.std_error.unwrap());
        let variance = b.std_error.unwrap().powi(2) + x * x * s_c * s_c - 2.0 * x * 2.5 * s_c * s_c;
        assert_relative_eq!(crossing.std_error.unwrap(), variance.sqrt() / c.value, max_relative = 1e-9);
        assert_eq!(crossing.dof, 2);
    }

    #[test]
    fn a_slope_within_its_noise_crosses_the_axis_nowhere() {
        assert!(
            curve(&[(1.0, 0, 1.0), (2.0, 0, -1.0), (3.0, 0, 1.5), (4.0, 0, -0.5)]).ratio(&[-1.0]).is_none()
        );
    }

    #[test]
    fn a_resolution_is_the_last_decimal_that_is_used() {
        let of = |micrometres: &[f64]| {
            let rows: Vec<_> = micrometres.iter().map(|um| (1.0, 0, um * UM)).collect();
            resolution(&samples(&rows)) / UM
        };
        assert_eq!(of(&[50.0, -101.0, 0.0]), 1.0);
        assert_relative_eq!(of(&[50.0, 101.5]), 0.1);
        assert_relative_eq!(of(&[2798.826, 5576.824]), 0.001);
        assert_eq!(of(&[std::f64::consts::PI, 1.0]), 0.0);
    }
}
