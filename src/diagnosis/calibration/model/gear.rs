//! The error of a joint's gear or encoder as a function of its angle, and what it amounts to.
//!
//! ```text
//! amplitude of a harmonic    √(a² + b²)
//! amplitude of a wave        √(a² + b² + (c² + d²)·mean(u²))
//! frequency of a wave        n + h·(a·d − b·c)/(a² + b²)
//! amplitude of a curve       √2 times its rms over the recorded angles: that of a wave of that rms
//! frequency of a curve       that of the one wave that explains most of it
//! ```
//!
//! A constant and one cycle per revolution are taken out of a curve first: the calibration takes
//! most of them up, and what is said of them is little more than a guess.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::cosines::Cosines;
use super::vector::{Length, length, weighted_length};
use crate::inference::{Estimate, FindingPart, rms};

/// Step of the scan for a curve's strongest wave, cycles per revolution.
const WAVE_STEP: f64 = 0.25;
/// So many cycles within the joint's range make a wave of one frequency.
const WHOLE: f64 = 1.5;

/// Names of the frequencies of a part, of which there are as many as it has waves.
pub(in crate::diagnosis::calibration) const CYCLES_OF_PART: [&str; 2] =
    ["cycles_per_rev", "second_cycles_per_rev"];
/// Names of the two sizes of a whole error.
pub(in crate::diagnosis::calibration) const RECORDED_RMS: &str = "recorded_rms_urad";
pub(in crate::diagnosis::calibration) const RECORDED_HALF_PEAK_TO_PEAK: &str =
    "recorded_half_peak_to_peak_urad";

/// What a transmission error is made of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Gear {
    /// a·sin(n·q) + b·cos(n·q).
    Harmonic {
        /// The joint, from 0.
        joint: usize,
        /// n.
        cycles_per_rev: f64,
    },
    /// Two harmonics: a·sin(n·q) + b·cos(n·q) + c·sin(m·q) + d·cos(m·q).
    Harmonics {
        /// The joint, from 0.
        joint: usize,
        /// n and m.
        cycles_per_rev: [f64; 2],
    },
    /// (a + c·u)·sin(n·q) + (b + d·u)·cos(n·q), u = (q − q̄)·h: to first order a wave of
    /// n + h·(a·d − b·c)/(a² + b²) cycles per revolution, whose amplitude may grow along the range.
    Wave {
        /// The joint, from 0.
        joint: usize,
        /// n, a step of the scan.
        cycles_per_rev: f64,
        /// q̄, rad.
        middle: f64,
        /// h, half a step of the scan, cycles per revolution.
        half_step: f64,
    },
    /// A smooth curve.
    Curve {
        /// The joint, from 0.
        joint: usize,
        /// Its terms.
        cosines: Cosines,
    },
}

impl Gear {
    /// The joint, from 0.
    pub fn joint(&self) -> usize {
        match self {
            Gear::Harmonic { joint, .. }
            | Gear::Harmonics { joint, .. }
            | Gear::Wave { joint, .. }
            | Gear::Curve { joint, .. } => *joint,
        }
    }

    /// What one unit of the `k`th parameter turns the joint by at angle q, rad.
    pub fn term(&self, k: usize, q: f64) -> f64 {
        match self {
            Gear::Harmonic { cycles_per_rev, .. } if k == 0 => (cycles_per_rev * q).sin(),
            Gear::Harmonic { cycles_per_rev, .. } => (cycles_per_rev * q).cos(),
            Gear::Harmonics { cycles_per_rev, .. } => {
                let (sine, cosine) = (cycles_per_rev[(k / 2).min(1)] * q).sin_cos();
                [sine, cosine][k % 2]
            }
            Gear::Wave { cycles_per_rev, middle, half_step, .. } => {
                let (sine, cosine) = (cycles_per_rev * q).sin_cos();
                [sine, cosine][k % 2] * if k < 2 { 1.0 } else { (q - middle) * half_step }
            }
            // the constant is the joint's offset
            Gear::Curve { cosines, .. } => cosines.value(k + 1, q),
        }
    }

    /// By how much these values turn the joint at angle q, rad.
    pub fn turn(&self, values: &[f64], q: f64) -> f64 {
        values.iter().enumerate().map(|(k, value)| value * self.term(k, q)).sum()
    }

    /// Cycles per revolution of a wave of these values, with the gradient; of any other its
    /// highest, as if that were exact.
    pub fn frequency(&self, values: &[f64]) -> (f64, DVector<f64>) {
        let (Gear::Wave { cycles_per_rev, half_step, .. }, &[a, b, c, d]) = (self, values) else {
            return (self.highest(values.len()), DVector::zeros(values.len()));
        };
        let square = (a * a + b * b).max(f64::MIN_POSITIVE);
        let shift = (a * d - b * c) / square;
        let gradient = [d - 2.0 * a * shift, -c - 2.0 * b * shift, -b, a].map(|x| x * half_step / square);
        // beyond the next step the wave would be another one
        (cycles_per_rev + half_step * shift.clamp(-2.0, 2.0), DVector::from_column_slice(&gradient))
    }

    /// Frequencies and amplitudes of the error that a part of a finding is, over the recorded
    /// `angles`, the largest first.
    pub(in crate::diagnosis::calibration) fn estimates(
        &self,
        part: &FindingPart,
        angles: &[f64],
    ) -> Vec<Estimate> {
        let mut waves = self.waves(part, angles);
        waves.sort_by(|a, b| b.amplitude.value.total_cmp(&a.amplitude.value));
        let of_wave = |wave: Wave| {
            let half = wave.amplitude.half_interval(part);
            [
                positive("cycles_per_rev", wave.cycles, wave.half_cycles),
                positive("amplitude_urad", wave.amplitude.value, half),
            ]
        };
        waves.into_iter().flat_map(of_wave).collect()
    }

    /// Frequencies of the waves that a part of a finding is made of, in their order; none of a
    /// curve.
    pub(in crate::diagnosis::calibration) fn frequencies(
        &self,
        part: &FindingPart,
        angles: &[f64],
    ) -> Vec<Estimate> {
        if let Gear::Curve { .. } = self {
            return Vec::new();
        }
        let waves = self.waves(part, angles).into_iter().zip(CYCLES_OF_PART);
        waves.map(|(wave, name)| positive(name, wave.cycles, wave.half_cycles)).collect()
    }

    /// The waves that a part of a finding is; of a curve the strongest one.
    fn waves(&self, part: &FindingPart, angles: &[f64]) -> Vec<Wave> {
        let values = &part.term.values;
        let resolved =
            |cycles: f64, amplitude: Length| Wave { cycles, half_cycles: 0.5 / turns(angles), amplitude };
        match self {
            Gear::Harmonics { cycles_per_rev: [n, m], .. } => vec![
                resolved(*n, weighted_length(values, &[1.0, 1.0, 0.0, 0.0])),
                resolved(*m, weighted_length(values, &[0.0, 0.0, 1.0, 1.0])),
            ],
            Gear::Harmonic { cycles_per_rev, .. } => vec![resolved(*cycles_per_rev, length(values))],
            Gear::Wave { middle, half_step, .. } => {
                let (cycles, gradient) = self.frequency(values);
                let square = |q: &f64| ((q - middle) * half_step).powi(2);
                let mean = angles.iter().map(square).sum::<f64>() / angles.len().max(1) as f64;
                let half = Length { value: cycles, gradient }.half_interval(part);
                // a part of a wave is one of a wave of another frequency too
                let is_part = cycles * turns(angles) < WHOLE;
                let half_cycles = if is_part { half.max(0.5 / turns(angles)) } else { half };
                let amplitude = weighted_length(values, &[1.0, 1.0, mean, mean]);
                vec![Wave { cycles, half_cycles, amplitude }]
            }
            Gear::Curve { .. } => {
                let (cycles, amplitude) = of_curve(self, values, angles);
                vec![resolved(cycles, amplitude)]
            }
        }
    }

    /// How many waves [`Gear::estimates`] names.
    pub(in crate::diagnosis::calibration) fn wave_count(&self) -> usize {
        match self {
            Gear::Harmonics { .. } => 2,
            Gear::Harmonic { .. } | Gear::Wave { .. } | Gear::Curve { .. } => 1,
        }
    }

    /// Highest frequency of so many terms, cycles per revolution.
    pub fn highest(&self, terms: usize) -> f64 {
        match self {
            Gear::Harmonic { cycles_per_rev, .. } => *cycles_per_rev,
            Gear::Harmonics { cycles_per_rev: [n, m], .. } => n.max(*m),
            Gear::Wave { cycles_per_rev, half_step, .. } => cycles_per_rev + half_step,
            Gear::Curve { cosines, .. } => cosines.frequency(terms),
        }
    }
}

/// Cycles per revolution with half of their 95 % interval, and amplitude, rad.
struct Wave {
    cycles: f64,
    half_cycles: f64,
    amplitude: Length,
}

/// A number that is never negative, with half of its 95 % interval, SI.
fn positive(name: &str, value: f64, half: f64) -> Estimate {
    Estimate::new(name, value, (value - half).max(0.0), value + half)
}

/// The whole error of a joint: the sum of all that was found of it, with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The joint, from 0.
    pub joint: usize,
    /// Each part with its values, rad, and the mean that is taken out of it: a constant is the
    /// joint's offset.
    parts: Vec<(Gear, Vec<f64>)>,
    mean: f64,
    /// Posterior covariance of all values, rad².
    covariance: DMatrix<f64>,
}

impl Curve {
    /// Of parts of one joint; `angles` are those that were recorded, over which the mean is zero.
    pub(in crate::diagnosis::calibration) fn new(
        joint: usize,
        parts: Vec<(Gear, Vec<f64>)>,
        covariance: DMatrix<f64>,
        angles: &[f64],
    ) -> Self {
        let mut curve = Curve { joint, parts, mean: 0.0, covariance };
        curve.mean = angles.iter().map(|&q| curve.at(q)).sum::<f64>() / angles.len().max(1) as f64;
        curve
    }

    /// By how much the joint is farther than its angle q says, rad: add it to q.
    pub fn at(&self, q: f64) -> f64 {
        let turns = self.parts.iter().map(|(gear, values)| gear.turn(values, q));
        turns.sum::<f64>() - self.mean
    }

    /// Standard deviation of that, rad.
    pub fn sd(&self, q: f64) -> f64 {
        let terms = self.terms(q);
        terms.dot(&(&self.covariance * &terms)).max(0.0).sqrt()
    }

    /// Over the recorded `angles` its root mean square, and half the way from its lowest value to
    /// its highest.
    pub(in crate::diagnosis::calibration) fn estimates(
        &self,
        angles: &[f64],
        coverage_factor: f64,
    ) -> Vec<Estimate> {
        let count = angles.len().max(1) as f64;
        let values: Vec<f64> = angles.iter().map(|&q| self.at(q)).collect();
        let rms = (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt();
        let along = angles.iter().zip(&values).map(|(&q, value)| self.terms(q) * *value);
        let slope = along.fold(DVector::zeros(self.covariance.nrows()), |sum, own| sum + own);
        let half = |gradient: &DVector<f64>| {
            coverage_factor * gradient.dot(&(&self.covariance * gradient)).max(0.0).sqrt()
        };
        let mut all =
            vec![positive(RECORDED_RMS, rms, half(&(slope / (count * rms.max(f64::MIN_POSITIVE)))))];
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let ends = (0..angles.len()).min_by(by_value).zip((0..angles.len()).max_by(by_value));
        if let Some((low, high)) = ends {
            let gradient = (self.terms(angles[high]) - self.terms(angles[low])) * 0.5;
            let value = 0.5 * (values[high].max(0.0) - values[low].min(0.0));
            all.push(positive(RECORDED_HALF_PEAK_TO_PEAK, value, half(&gradient)));
        }
        all
    }

    /// What one unit of each value turns the joint by at angle q, rad.
    fn terms(&self, q: f64) -> DVector<f64> {
        let terms = self.parts.iter().flat_map(|(gear, values)| (0..values.len()).map(|k| gear.term(k, q)));
        DVector::from_iterator(self.covariance.nrows(), terms)
    }

    /// Highest frequency, cycles per revolution.
    pub fn highest(&self) -> f64 {
        self.parts.iter().map(|(gear, values)| gear.highest(values.len())).fold(0.0, f64::max)
    }
}

/// Range of angles in revolutions: frequencies closer than its inverse are hard to tell apart.
fn turns(angles: &[f64]) -> f64 {
    let (low, high) =
        angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &q| (a.min(q), b.max(q)));
    ((high - low) / TAU).max(f64::MIN_POSITIVE)
}

/// Frequency and amplitude of a curve over the recorded angles.
fn of_curve(gear: &Gear, values: &[f64], angles: &[f64]) -> (f64, Length) {
    let slow = DMatrix::from_fn(angles.len(), 3, |row, k| match k {
        0 => 1.0,
        1 => angles[row].sin(),
        _ => angles[row].cos(),
    });
    let slow = slow.qr().q();
    let terms = DMatrix::from_fn(angles.len(), values.len(), |row, k| gear.term(k, angles[row]));
    let terms = &terms - &slow * slow.tr_mul(&terms);
    let curve = &terms * DVector::from_column_slice(values);
    let rms = rms(&curve).max(f64::MIN_POSITIVE);
    let gradient = terms.tr_mul(&curve) * (2.0f64.sqrt() / (angles.len().max(1) as f64 * rms));
    let amplitude = Length { value: 2.0f64.sqrt() * rms, gradient };
    (strongest_wave(&curve, angles, gear.highest(values.len())), amplitude)
}

/// Cycles per revolution of the one wave that explains most of a curve.
fn strongest_wave(curve: &DVector<f64>, angles: &[f64], highest: f64) -> f64 {
    let power = |cycles: f64| {
        let wave = DMatrix::from_fn(angles.len(), 2, |row, k| {
            let (sine, cosine) = (cycles * angles[row]).sin_cos();
            if k == 0 { sine } else { cosine }
        });
        wave.qr().q().tr_mul(curve).norm_squared()
    };
    let steps = (1..).map(|step| f64::from(step) * WAVE_STEP);
    let powers = steps.take_while(|cycles| *cycles <= highest).map(|cycles| (cycles, power(cycles)));
    let stronger = |most: (f64, f64), next: (f64, f64)| if next.1 > most.1 { next } else { most };
    powers.fold((0.0, 0.0), stronger).0
}
