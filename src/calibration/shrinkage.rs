//! What the drawing says of the robot, as far as the data believe it.
//!
//! Every number of the geometry is normal about its nominal value with the standard deviation s·u:
//! u is that of the robot file (`[standard_uncertainty]`), s one factor for all, the common scale,
//! which the data choose. What the poses show stays as they show it; along what they hardly show
//! the robot stays near its drawing, instead of wandering by centimetres in search of the last
//! micrometre of the residual.
//!
//! With A = M·J·U, the whitened columns of the geometry in units of u with all else projected out,
//! d its singular values and z the components of the nominal robot's residual along its left
//! singular vectors, the marginal likelihood is
//!
//! ```text
//! ln p(y | s) = −½·Σₖ [ ln(1 + s²dₖ²) + zₖ²/(1 + s²dₖ²) ] + const        D. J. C. MacKay, Neural Computation 4 (1992) 415–447
//! ```
//!
//! At an estimate t̂ = U⁻¹(ρ̂ − ρ₀) with the scale s₀, where the gradient vanishes, z = d·Vᵀt̂ +
//! Vᵀ(t̂/s₀² − U·h)/d, h the slope of what the density of the data has besides their squares.

use nalgebra::{DMatrix, DVector};

use crate::error::Result;
use crate::least_squares::Prior;
use crate::linalg::thin_svd;
use crate::robot::{Parameter, Setup};

/// The scale before there is a fit: wide enough to take what a rough start has missed.
const FIRST: f64 = 10.0;
/// How well the scale is known before the data: within a factor of e, one standard deviation.
const LOG_SD: f64 = 1.0;
/// Range in which the scale is looked for, and how finely, ln.
const LOG_RANGE: (f64, f64) = (-4.0, 7.0);
const LOG_STEP: f64 = 0.05;
/// A slope holds as far as so many times what the drawing is known to.
const AS_FAR: f64 = 10.0;
/// Singular values below this, in standard deviations of the noise per u, say nothing.
const NOTHING: f64 = 1e-6;

/// What is known of the free parameters before the data.
#[derive(Debug, Clone)]
pub(super) struct Drawing {
    /// Of each free parameter: nominal value and standard uncertainty, SI; `None` where no drawing
    /// says anything of it.
    known: Vec<Option<(f64, f64)>>,
    /// What the density of the data has besides their squares: its slope by each free parameter.
    slopes: Vec<f64>,
    /// Scale s of all standard uncertainties of the drawing, which the data may correct.
    pub scale: f64,
    /// How many of the numbers of the geometry the data determine; the drawing does the rest.
    determined: f64,
}

impl Drawing {
    /// That of a robot; nothing is known of `stated` parameters, for which there is a prior of the
    /// user's.
    pub fn new(nominal: &Setup, free: &[Parameter], stated: &[Parameter]) -> Self {
        let uncertainty = &nominal.robot.standard_uncertainty;
        let of_parameter = |&parameter: &Parameter| {
            let sd = uncertainty.of(parameter).filter(|_| !stated.contains(&parameter))?;
            Some((nominal.get(parameter), sd))
        };
        let known: Vec<_> = free.iter().map(of_parameter).collect();
        let determined = known.iter().flatten().count() as f64;
        Drawing { slopes: vec![0.0; known.len()], known, scale: FIRST, determined }
    }

    /// The same where the density of the data has such slopes besides ([`super::growth`]).
    pub fn with_slopes(self, slopes: Vec<f64>) -> Self {
        Drawing { slopes, ..self }
    }

    /// A prior for each number that the drawing has: N(ρ₀, σ²) times a slope h is N(ρ₀ + σ²h, σ²).
    pub fn priors(&self) -> impl Iterator<Item = Prior> {
        let share = self.share_of_slopes();
        self.known.iter().zip(&self.slopes).enumerate().filter_map(move |(parameter, (known, slope))| {
            let (nominal, sd) = (*known)?;
            let sd = self.scale * sd;
            Some(Prior { parameter, value: nominal + sd * sd * share * slope, sd })
        })
    }

    /// As much of the slopes as moves no number farther than they hold.
    fn share_of_slopes(&self) -> f64 {
        let of_number = |(known, slope): (&Option<(f64, f64)>, &f64)| {
            known.map_or(0.0, |(_, sd)| self.scale.powi(2) * sd * slope.abs())
        };
        let farthest = self.known.iter().zip(&self.slopes).map(of_number).fold(0.0, f64::max);
        if farthest > AS_FAR { AS_FAR / farthest } else { 1.0 }
    }

    /// Numbers that the drawing determines rather than the data.
    pub fn undetermined(&self) -> f64 {
        self.known.iter().flatten().count() as f64 - self.determined
    }

    /// Chooses the scale by the marginal likelihood: `root` is the square root of the information
    /// of the data alone (whitened, free parameters), `p` the estimate with the present scale. By
    /// how much its logarithm has changed.
    ///
    /// # Errors
    /// As [`thin_svd`].
    pub fn rescale(&mut self, root: &DMatrix<f64>, p: &DVector<f64>) -> Result<f64> {
        let own: Vec<usize> = (0..self.known.len()).filter(|&k| self.known[k].is_some()).collect();
        if own.is_empty() {
            return Ok(0.0);
        }
        let (unit, offset): (Vec<f64>, Vec<f64>) = own
            .iter()
            .filter_map(|&k| self.known[k].map(|(nominal, sd)| (sd, (p[k] - nominal) / sd)))
            .unzip();
        let share = self.share_of_slopes();
        let slopes = own.iter().zip(&unit).map(|(&k, unit)| share * self.slopes[k] * unit);
        let slope = DVector::from_iterator(own.len(), slopes);
        let columns = geometry(root, &own, &unit)?;
        let svd = thin_svd(&columns)?;
        let along = svd.v.transpose() * DVector::from_vec(offset);
        let slope = svd.v.transpose() * slope;
        let precision = self.scale.powi(-2);
        let parts: Vec<(f64, f64)> = svd
            .singular_values
            .iter()
            .zip(along.iter().zip(slope.iter()))
            .filter(|(d, _)| **d > NOTHING)
            .map(|(&d, (&t, slope))| (d, d * t + (precision * t - slope) / d))
            .collect();
        let log_likelihood = |log_scale: f64| {
            let square = (2.0 * log_scale).exp();
            let of_part = |&(d, z): &(f64, f64)| {
                let variance = 1.0 + square * d * d;
                variance.ln() + z * z / variance
            };
            -0.5 * (parts.iter().map(of_part).sum::<f64>() + (log_scale / LOG_SD).powi(2))
        };
        let count = ((LOG_RANGE.1 - LOG_RANGE.0) / LOG_STEP) as usize;
        let best = (0..=count)
            .map(|k| LOG_RANGE.0 + LOG_STEP * k as f64)
            .max_by(|a, b| log_likelihood(*a).total_cmp(&log_likelihood(*b)))
            .unwrap_or_default();
        let change = (best - self.scale.ln()).abs();
        self.scale = best.exp();
        let square = self.scale.powi(2);
        self.determined = parts.iter().map(|(d, _)| square * d * d / (1.0 + square * d * d)).sum();
        Ok(change)
    }
}

/// M·J·U: the columns of the geometry in units of what is known of them, without what base, tool
/// and compliances take up.
fn geometry(root: &DMatrix<f64>, own: &[usize], unit: &[f64]) -> Result<DMatrix<f64>> {
    let rest: Vec<usize> = (0..root.ncols()).filter(|k| !own.contains(k)).collect();
    let mut columns = DMatrix::from_fn(root.nrows(), own.len(), |i, k| root[(i, own[k])] * unit[k]);
    if !rest.is_empty() {
        let others = root.select_columns(&rest);
        let scales: Vec<f64> = others.column_iter().map(|column| column.norm()).collect();
        let scaled = DMatrix::from_fn(others.nrows(), others.ncols(), |i, k| {
            others[(i, k)] / if scales[k] > 0.0 { scales[k] } else { 1.0 }
        });
        let svd = thin_svd(&scaled)?;
        let basis = svd.u.columns(0, svd.rank(1e-9)).into_owned();
        let along = basis.tr_mul(&columns);
        columns -= &basis * along;
    }
    Ok(columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// Twelve numbers of which the data know half to a hundredth, half hardly: the scale is that of
    /// the errors that they have.
    #[test]
    fn the_scale_is_that_of_the_errors() {
        for truth in [0.2, 1.0, 5.0] {
            let mut random = Random::seeded(7, 0);
            let count = 12;
            let root = DMatrix::from_fn(count, count, |i, k| match (i == k, i % 2) {
                (true, 0) => 100.0,
                (true, _) => 0.05,
                _ => 0.0,
            });
            let (known, slopes) = (vec![Some((3.0, 1.0)); count], vec![0.0; count]);
            let mut drawing = Drawing { known, slopes, scale: FIRST, determined: count as f64 };
            let actual: Vec<f64> = (0..count).map(|_| truth * random.normal()).collect();
            let noise: Vec<f64> = (0..count).map(|_| random.normal()).collect();
            for _ in 0..20 {
                // the estimate with this scale: (d² + 1/s²)·t = d·(d·t₀ + ε)
                let p = DVector::from_fn(count, |k, _| {
                    let d = root[(k, k)];
                    3.0 + d * (d * actual[k] + noise[k]) / (d * d + drawing.scale.powi(-2))
                });
                if drawing.rescale(&root, &p).unwrap() < 1e-9 {
                    break;
                }
            }
            assert!((drawing.scale / truth).ln().abs() < 0.5, "{} instead of {truth}", drawing.scale);
            assert!(drawing.undetermined() > 5.0, "{}", drawing.undetermined());
        }
    }
}
