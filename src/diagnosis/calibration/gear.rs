//! The error of a joint's gear or encoder as a function of its angle.

use nalgebra::{DMatrix, DVector};

use super::cosines::Cosines;

/// What a transmission error is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum Gear {
    /// a·sin(n·q) + b·cos(n·q).
    Harmonic {
        /// The joint, from 0.
        joint: usize,
        /// n.
        cycles_per_rev: f64,
    },
    /// (a + c·u)·sin(n·q) + (b + d·u)·cos(n·q), u = (q − q̄)·h: to first order a wave of n + h·(a·d − b·c)/(a² + b²) cycles per
    /// revolution, whose amplitude may grow along the range.
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
            Gear::Harmonic { joint, .. } | Gear::Wave { joint, .. } | Gear::Curve { joint, .. } => *joint,
        }
    }

    /// What one unit of the `k`th parameter turns the joint by at angle q, rad.
    pub fn term(&self, k: usize, q: f64) -> f64 {
        match self {
            Gear::Harmonic { cycles_per_rev, .. } if k == 0 => (cycles_per_rev * q).sin(),
            Gear::Harmonic { cycles_per_rev, .. } => (cycles_per_rev * q).cos(),
            Gear::Wave { cycles_per_rev, middle, half_step, .. } => {
                let (sine, cosine) = (cycles_per_rev * q).sin_cos();
                [sine, cosine][k % 2] * if k < 2 { 1.0 } else { (q - middle) * half_step }
            }
            // the constant is the joint's offset
            Gear::Curve { cosines, .. } => cosines.value(k + 1, q),
        }
    }

    /// Cycles per revolution of a wave of these values, with the gradient; of any other its highest, as if that were exact.
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

    /// Highest frequency of so many terms, cycles per revolution.
    pub fn highest(&self, terms: usize) -> f64 {
        match self {
            Gear::Harmonic { cycles_per_rev, .. } => *cycles_per_rev,
            Gear::Wave { cycles_per_rev, half_step, .. } => cycles_per_rev + half_step,
            Gear::Curve { cosines, .. } => cosines.frequency(terms),
        }
    }
}

/// The whole error of a joint: the sum of all that was found of it, with what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The joint, from 0.
    pub joint: usize,
    /// Each part with its values, rad, and the mean that is taken out of it: a constant is the joint's offset.
    parts: Vec<(Gear, Vec<f64>)>,
    mean: f64,
    /// Posterior covariance of all values, rad².
    covariance: DMatrix<f64>,
}

impl Curve {
    /// Of parts of one joint; `angles` are those that were recorded, over which the mean is zero.
    pub(super) fn new(
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
        let of_part = |(gear, values): &(Gear, Vec<f64>)| -> f64 {
            values.iter().enumerate().map(|(k, value)| value * gear.term(k, q)).sum()
        };
        self.parts.iter().map(of_part).sum::<f64>() - self.mean
    }

    /// Standard deviation of that, rad.
    pub fn sd(&self, q: f64) -> f64 {
        let terms = self.parts.iter().flat_map(|(gear, values)| (0..values.len()).map(|k| gear.term(k, q)));
        let terms = DVector::from_iterator(self.covariance.nrows(), terms);
        terms.dot(&(&self.covariance * &terms)).max(0.0).sqrt()
    }

    /// Highest frequency, cycles per revolution.
    pub fn highest(&self) -> f64 {
        self.parts.iter().map(|(gear, values)| gear.highest(values.len())).fold(0.0, f64::max)
    }
}
