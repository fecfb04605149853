//! A polynomial through averaged repeats: its coefficients, how well they are known, and whether it
//! fits.
//!
//! Repeats at one load are averaged before any inference: they share whatever was wrong with that
//! load, and taken as independent they make every line look better known than it is. With the
//! averages ȳ_k of n_k readings at load F_k,
//!
//! ```text
//! ȳ_k = c·F_k + b         weights n_k; b of its own for loading and for unloading
//! lack of fit   s_f² = Σ n_k (ȳ_k − ŷ_k)² / (K − p)     K averages, p coefficients
//! pure error    s_e² = ΣΣ (y_ki − ȳ_k)² / (N − K)       N readings
//! F = s_f² / s_e²
//! ```
//!
//! (N. R. Draper, H. Smith, *Applied Regression Analysis*, 3rd ed., § 2.1.) A sensor of resolution
//! q moves every average by up to q/2 however often it is read, which repeats do not show: s_e²
//! counts as n·q²/12 at least.
//!
//! Standard errors rest on both variances together, or on s_f² alone where it is the larger one
//! with p < 0.25: what bends the line then counts too. (That level is T. A. Bancroft's for
//! pooling, *Biometrics* 20 (1964) 427–442.)
//!
//! The readings of one trial may share an error too: a zero that was off, a rod that sat
//! differently. Where an F test finds that trials differ by an offset or a slope of their own,
//! these leave the pure error (with their degrees of freedom), and the trial is the unit that the
//! standard errors count. With the residuals e of the readings and the T trials t,
//!
//! ```text
//! cov(b, c) = T/(T − 1) · U·(Σ_t g_t g_tᵀ)·U      g_t = Σ x e over the trial
//!                                                 U = (Σ x xᵀ)⁻¹;  T − 1 dof
//! ```
//!
//! which is the scatter of the trials' own lines where every trial has every load.
//! (K.-Y. Liang, S. L. Zeger, *Biometrika* 73 (1986) 13–22.)

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::readings::Phase;
use super::repeats::{Repeats, average, mean_square};
use super::sample::{LackOfFit, Point, Sample};
use crate::error::Result;
use crate::least_squares::{self, Noise, Options};
use crate::statistics::{self, Estimate};

/// Below this probability the averages' own distance from the line decides how well it is known.
const LEAVES_THE_LINE: f64 = 0.25;

/// Columns of the design matrix: 1, F, …, F^degree, then 1 on unloading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Columns {
    pub degree: usize,
    pub unload: bool,
}

impl Columns {
    pub(super) fn count(self) -> usize {
        self.degree + 1 + usize::from(self.unload)
    }

    pub(super) fn entry(self, column: usize, load: f64, phase: Phase) -> f64 {
        if column <= self.degree {
            load.powi(column as i32)
        } else {
            f64::from(u8::from(phase == Phase::Unload))
        }
    }
}

/// A polynomial through the averages, with its tests.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub coefficients: DVector<f64>,
    /// Covariances that the coefficients may have, with their degrees of freedom; the larger one
    /// counts.
    pub covariances: Vec<(DMatrix<f64>, usize)>,
    pub points: Vec<Point>,
    pub residual_sd: Option<f64>,
    pub noise_sd: Option<f64>,
    pub trials_differ: bool,
    pub lack_of_fit: Option<LackOfFit>,
}

impl Curve {
    pub(super) fn fit(columns: Columns, samples: &[Sample], resolution: f64) -> Result<Curve> {
        let mut points = average(samples);
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
        let repeats = Repeats::new(samples, &points)?;
        let (trials, noise) = match repeats.trials_differ()? {
            true => (Some(repeats.trials), repeats.within_trials),
            false => (None, repeats.all),
        };
        let fit_variance = mean_square(between, dof_fit);
        let least = samples.len() as f64 / points.len() as f64 * resolution.powi(2) / 12.0;
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
        let from_fit = fit_variance.filter(|_| !stays).map(|variance| (unit * variance, dof_fit));
        let mut covariances: Vec<(DMatrix<f64>, usize)> = from_fit.into_iter().collect();
        match (trials, noise_variance) {
            (Some(trials), _) => {
                let from_trials = trial_covariance(columns, &fit.parameters, unit, samples);
                // trials that agree by luck still have the sensor's resolution
                covariances.extend([(from_trials, trials - 1), (unit * least, trials - 1)]);
            }
            (None, Some(variance)) if stays => {
                let dof = dof_fit + noise.dof;
                covariances.push((unit * ((between + variance * noise.dof as f64) / dof as f64), dof));
            }
            (None, Some(variance)) => covariances.push((unit * variance, noise.dof)),
            (None, None) => {}
        }
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

    pub(super) fn estimate(&self, index: usize) -> Estimate {
        let mut row = vec![0.0; self.coefficients.len()];
        row[index] = 1.0;
        self.combination(&row)
    }

    /// The linear combination wᵀβ with its standard error √(wᵀ Σ w).
    pub(super) fn combination(&self, row: &[f64]) -> Estimate {
        let mut weights = DVector::zeros(self.coefficients.len());
        for (w, r) in weights.iter_mut().zip(row) {
            *w = *r;
        }
        let variance = |covariance: &DMatrix<f64>| (weights.transpose() * covariance * &weights)[(0, 0)];
        let variances = self.covariances.iter().map(|(covariance, dof)| (variance(covariance), *dof));
        let largest = variances.max_by(|a, b| a.0.total_cmp(&b.0));
        Estimate {
            value: weights.dot(&self.coefficients),
            // rounding may leave a vanishing variance below zero
            std_error: largest.map(|(variance, _)| variance.max(0.0).sqrt()),
            dof: largest.map_or(0, |(_, dof)| dof),
        }
    }

    /// wᵀβ / β₁, a load, by propagation to first order: d(u/c) = (du − (u/c) dc)/c. `None` without
    /// a slope that differs from zero: the 95 % interval of such a ratio is unbounded (E. C.
    /// Fieller, *JRSS B* 16 (1954) 175–185).
    pub(super) fn ratio(&self, row: &[f64]) -> Option<Estimate> {
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

/// Covariance of the coefficients by the scatter of whole trials; `unit` is theirs per unit
/// variance of a reading.
fn trial_covariance(
    columns: Columns,
    coefficients: &DVector<f64>,
    unit: &DMatrix<f64>,
    samples: &[Sample],
) -> DMatrix<f64> {
    let mut pulls: BTreeMap<usize, DVector<f64>> = BTreeMap::new();
    for sample in samples {
        let row = DVector::from_fn(columns.count(), |j, _| columns.entry(j, sample.load, sample.phase));
        let residual = sample.offset - row.dot(coefficients);
        *pulls.entry(sample.trial).or_insert_with(|| DVector::zeros(columns.count())) += row * residual;
    }
    let trials = pulls.len() as f64;
    let scatter: DMatrix<f64> = pulls.values().map(|g| g * g.transpose()).sum();
    unit * scatter * unit * (trials / (trials - 1.0))
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::super::repeats::tests::samples;
    use super::*;

    const STRAIGHT: Columns = Columns { degree: 1, unload: false };

    fn curve(rows: &[(f64, usize, f64)]) -> Curve {
        Curve::fit(STRAIGHT, &samples(rows), 0.0).unwrap()
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
}
