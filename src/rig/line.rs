//! One load–deflection line: averaged repeats, a slope common to loading and unloading, and whether it is straight.
//!
//! Repeats at one load are averaged before any inference: they share whatever was wrong with that load or that
//! trial, and taken as independent they make every line look better known than it is. With the averages ȳ_k of
//! n_k readings at load F_k,
//!
//! ```text
//! ȳ_k = c·F_k + b         weights n_k; b of its own for loading and for unloading
//! lack of fit   s_f² = Σ n_k (ȳ_k − ŷ_k)² / (K − p)     K averages, p coefficients
//! pure error    s_e² = ΣΣ (y_ki − ȳ_k)² / (N − K)       N readings
//! F = s_f² / s_e²
//! ```
//!
//! Standard errors use the larger of the two variances: the averages scatter at least as much as their own
//! repeats say, and whatever makes the line crooked counts too.
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., § 2.1.)

use nalgebra::{DMatrix, DVector};

use super::readings::{Axis, Direction, Phase};
use crate::error::Result;
use crate::least_squares::{self, Noise, Options, Robust};
use crate::statistics::{self, Estimate};

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
    /// Standard deviation of one reading about the average of its repeats, m.
    pub noise_sd: Option<f64>,
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
    /// N − K.
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
        let has_both = [Phase::Load, Phase::Unload].map(|p| distinct_loads(&samples, Some(p)) >= 2);
        let columns = Columns { degree: 1, unload: has_both == [true, true] };
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
    /// Of the coefficients, per unit variance of one reading.
    unit_covariance: DMatrix<f64>,
    /// Variance of one reading for the standard errors, and its degrees of freedom.
    variance: Option<(f64, usize)>,
    points: Vec<Point>,
    residual_sd: Option<f64>,
    noise_sd: Option<f64>,
    lack_of_fit: Option<LackOfFit>,
}

impl Curve {
    fn fit(columns: Columns, samples: &[Sample], trust: &[f64]) -> Result<Curve> {
        let (mut points, within) = average(samples, trust);
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
        let trusted = trust.iter().filter(|t| **t > 0.0).count();
        let dof_fit = points.len().saturating_sub(fit.covariance.rank);
        let dof_repeats = trusted - points.len();
        let mean_square = |sum: f64, dof: usize| (dof > 0).then(|| (sum / dof as f64, dof));
        let (fit_variance, noise) = (mean_square(between, dof_fit), mean_square(within, dof_repeats));
        let lack_of_fit = match (fit_variance, noise) {
            (Some((fit_variance, _)), Some((noise, _))) if noise > 0.0 => {
                let f = fit_variance / noise;
                let p_value = statistics::f_survival(f, dof_fit as f64, dof_repeats as f64)?;
                Some(LackOfFit { f, dof_fit, dof_repeats, p_value })
            }
            _ => None,
        };
        Ok(Curve {
            unit_covariance: fit.covariance.matrix,
            coefficients: fit.parameters,
            variance: match (fit_variance, noise) {
                (Some(a), Some(b)) => Some(if a.0 >= b.0 { a } else { b }),
                (a, b) => a.or(b),
            },
            points,
            residual_sd: mean_square(between + within, dof_fit + dof_repeats).map(|(v, _)| v.sqrt()),
            noise_sd: noise.map(|(v, _)| v.sqrt()),
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
        let unit = (weights.transpose() * &self.unit_covariance * &weights)[(0, 0)];
        Estimate {
            value: weights.dot(&self.coefficients),
            std_error: self.variance.map(|(variance, _)| (unit * variance).sqrt()),
            dof: self.variance.map_or(0, |(_, dof)| dof),
        }
    }

    /// wᵀβ / β₁, a load, by propagation to first order: d(u/c) = (du − (u/c) dc)/c. `None` without a slope.
    fn ratio(&self, row: &[f64]) -> Option<Estimate> {
        let slope = self.coefficients[1];
        let value = self.combination(row).value / slope;
        let mut gradient: Vec<f64> = row.iter().take(self.coefficients.len()).map(|w| w / slope).collect();
        gradient[1] -= value / slope;
        let std_error = self.combination(&gradient).std_error;
        (value.is_finite() && std_error.is_none_or(f64::is_finite)).then(|| Estimate {
            value,
            std_error,
            dof: self.variance.map_or(0, |(_, dof)| dof),
        })
    }
}

/// Averages of the repeats, and the sum of squares within them.
fn average(samples: &[Sample], trust: &[f64]) -> (Vec<Point>, f64) {
    let mut points: Vec<Point> = Vec::new();
    for (sample, &weight) in samples.iter().zip(trust).filter(|(_, weight)| **weight > 0.0) {
        let is_same = |p: &&mut Point| p.load == sample.load && p.phase == sample.phase;
        match points.iter_mut().find(is_same) {
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
    let mean_of = |s: &Sample| {
        points.iter().find(|p| p.load == s.load && p.phase == s.phase).map_or(s.offset, |p| p.mean)
    };
    let within = samples.iter().zip(trust).map(|(s, w)| w * (s.offset - mean_of(s)).powi(2)).sum();
    (points, within)
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
