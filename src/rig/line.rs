//! One load–deflection line: which readings it rests on, its slope, where it crosses the load axis,
//! its friction.
//!
//! How repeats become averages and averages a line with standard errors stands in `curve.rs` and
//! `repeats.rs`.

use nalgebra::{DMatrix, DVector};

use super::curve::{Columns, Curve};
use super::readings::{Axis, Direction, Phase, Reading};
use super::repeats::resolution;
pub use super::sample::{LackOfFit, Point, Sample};
use crate::error::{Error, Result};
use crate::least_squares::{self, Options, Robust};
use crate::statistics::Estimate;

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

/// A fitted line.
#[derive(Debug, Clone)]
#[non_exhaustive]
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
    /// Half the distance between the loading and the unloading line, N: Coulomb friction, free of
    /// any offset.
    pub friction: Option<Estimate>,
    /// Averages with their residuals.
    pub points: Vec<Point>,
    /// Number of readings.
    pub count: usize,
    /// Standard deviation of one reading about the line, m.
    pub residual_sd: Option<f64>,
    /// Standard deviation of one reading about the average of its repeats, m; where trials differ,
    /// about its trial.
    pub noise_sd: Option<f64>,
    /// The readings of a trial share an error, and the standard errors come from the scatter of
    /// trials.
    pub trials_differ: bool,
    /// Whether the line is straight.
    pub lack_of_fit: Option<LackOfFit>,
    /// The same readings with a quadratic term, where there are four different loads or more.
    pub quadratic: Option<Quadratic>,
    /// Lines of the file whose readings a robust fit gives less than half their weight.
    pub downweighted: Vec<usize>,
    curve: Curve,
}

/// ȳ = b0 + b1·F + b2·F².
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Quadratic {
    /// b0 (m), b1 (m/N), b2 (m/N²), F the magnitude of the load.
    pub coefficients: [Estimate; 3],
    /// Standard deviation of one reading about the curve, m.
    pub residual_sd: Option<f64>,
    /// Whether the curve fits.
    pub lack_of_fit: Option<LackOfFit>,
}

impl LineKey {
    /// The line that one channel of a reading belongs to.
    pub(super) fn of_reading(row: &Reading, channel: Axis) -> LineKey {
        LineKey {
            direction: row.direction,
            channel,
            load_station: row.load_station,
            read_station: row.read_station,
        }
    }

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
    /// ```
    /// use rodcal::least_squares::Robust;
    /// use rodcal::rig::line::{Line, LineKey, Sample};
    /// use rodcal::rig::readings::{Axis, Direction, Phase};
    ///
    /// let key = LineKey {
    ///     direction: Direction::along(Axis::Z), channel: Axis::Z, load_station: None, read_station: None,
    /// };
    /// let sample = |line, load: f64, offset: f64| Sample { load, offset, phase: Phase::Load, trial: 0, line };
    /// let samples = [sample(2, 5.0, 50e-6), sample(3, 10.0, 101e-6), sample(4, 15.0, 149e-6)];
    /// let line = Line::fit(key, &samples, Robust::None)?.expect("two different loads or more");
    /// // Σ(F − F̄)(d − d̄)/Σ(F − F̄)² = 495/50 µm/N
    /// assert!((line.slope.value - 9.9e-6).abs() < 1e-15);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
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
        let resolution = resolution(&samples);
        let (samples, downweighted) = resistant(samples, columns, robust)?;
        let line = Curve::fit(columns, &samples, resolution)?;

        let [b, c] = [0, 1].map(|i| line.estimate(i));
        let sign = f64::from(key.direction.sign);
        let quadratic = match distinct_loads(&samples, None) {
            0..=3 => None,
            _ => Some(Curve::fit(Columns { degree: 2, ..columns }, &samples, resolution)?),
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
            downweighted,
            points: line.points.clone(),
            curve: line,
        }))
    }

    /// Offset of the loading line at a load (its magnitude, N), m, with its standard error.
    pub fn at(&self, load: f64) -> Estimate {
        self.curve.combination(&[1.0, load])
    }
}

/// Readings that least squares treats as the robust fit treated the real ones, and the lines of
/// those it trusts less than half.
///
/// Huber's pseudo-observations y* = ŷ + K·ψ(y − ŷ)/ψ̄': their least-squares line is the robust one,
/// and their residual variance is the robust one too, so that all that follows needs to know
/// nothing of weights (P. J. Huber, *Robust Statistics*, 1981, § 7.10).
fn resistant(samples: Vec<Sample>, columns: Columns, robust: Robust) -> Result<(Vec<Sample>, Vec<usize>)> {
    if robust == Robust::None {
        return Ok((samples, Vec::new()));
    }
    let design = DMatrix::from_fn(samples.len(), columns.count(), |k, j| {
        columns.entry(j, samples[k].load, samples[k].phase)
    });
    let offsets = DVector::from_iterator(samples.len(), samples.iter().map(|s| s.offset));
    let options = Options { robust, ..Options::default() };
    let fit = least_squares::linear(&design, &offsets, None, &options)?;
    if !fit.is_converged() {
        return Err(Error::Numerical { what: "the robust fit of a line", why: fit.reason.to_string() });
    }
    // residuals are ŷ − y and ψ = w·(y − ŷ); s² = (K/ψ̄')² Σψ²/dof gives the factor K/ψ̄'
    let pull = -fit.weights.component_mul(&fit.residuals);
    let factor = match fit.residual_sd {
        Some(sd) if pull.norm() > 0.0 => sd * (fit.degrees_of_freedom as f64).sqrt() / pull.norm(),
        _ => 1.0,
    };
    let downweighted = samples.iter().zip(fit.weights.iter()).filter(|(_, w)| **w < 0.5).map(|(s, _)| s.line);
    let downweighted = downweighted.collect();
    let fitted = &design * &fit.parameters;
    let pseudo = |(k, sample): (usize, Sample)| Sample { offset: fitted[k] + factor * pull[k], ..sample };
    Ok((samples.into_iter().enumerate().map(pseudo).collect(), downweighted))
}

fn distinct_loads(samples: &[Sample], phase: Option<Phase>) -> usize {
    let is_counted = |s: &&Sample| phase.is_none_or(|p| p == s.phase);
    let mut loads: Vec<f64> = samples.iter().filter(is_counted).map(|s| s.load).collect();
    loads.sort_by(f64::total_cmp);
    loads.dedup();
    loads.len()
}
