//! The numbers of a loop together: where they are likeliest, and how far they may be from there.
//!
//! Newton's method on the ln of the evidence g, its derivatives by differences over what is about
//! one standard deviation. Its prior counts as normal, of the variance that an even one has over
//! its range R: P = diag(12/R²). With H = −∂²g,
//!
//! It is normal about there, of the covariance (H + P)⁻¹, but for the ends of the ranges and what
//! bends otherwise: points x drawn from such a normal density q, wider by [`WIDER`], count by
//! w = eᵍ/q (importance sampling; C. P. Robert, G. Casella, Monte Carlo Statistical Methods, 2004,
//! ch. 3), those beyond the ranges by nothing:
//!
//! ```text
//! evidence = Σ w/(N·V)        V the volume of the ranges
//! ```

use std::f64::consts::TAU;

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use crate::linalg::positive_definite_inverse;

/// Most steps.
const ROUNDS: usize = 12;
/// Steps that are tried at once, as Levenberg's damping in units of the largest curvature.
const DAMPINGS: [f64; 6] = [0.0, 1e-3, 1e-2, 0.1, 1.0, 10.0];
/// Differences, as shares of the range.
const DIFFERENCE: (f64, f64) = (1e-4, 0.1);
/// A step that gains less is the last one.
const ENOUGH: f64 = 0.01;

/// Points that are drawn, and how much wider than the normal density.
const DRAWN: usize = 128;
const WIDER: f64 = 1.4;

/// Range of each number.
pub(super) type Ranges = [(f64, f64); 3];

/// The likeliest numbers.
#[derive(Debug, Clone)]
pub(super) struct Peak {
    pub at: Vector3<f64>,
    /// Ln of the evidence, averaged over the prior.
    pub log_evidence: f64,
    /// Ln of the evidence there.
    pub highest: f64,
    /// Points with what share of the posterior each stands for.
    points: Vec<(Vector3<f64>, f64)>,
}

impl Peak {
    /// Uphill from `start`; `evidence` of many points at once.
    pub fn from(start: Vector3<f64>, ranges: Ranges, evidence: &dyn Fn(&[Vector3<f64>]) -> Vec<f64>) -> Peak {
        let width = Vector3::from_fn(|k, _| ranges[k].1 - ranges[k].0);
        let within = |point: Vector3<f64>| bounded(point, &ranges);
        let mut steps = width * DIFFERENCE.1;
        let mut at = within(start);
        let mut curved = curvature(at, &steps, &ranges, evidence);
        // where nothing is gained the differences may have been too wide
        let mut idle = 0;
        for _ in 0..ROUNDS {
            let largest = curved.hessian.diagonal().amax().max(f64::MIN_POSITIVE);
            let tried: Vec<Vector3<f64>> = DAMPINGS
                .iter()
                .filter_map(|damping| {
                    let scale =
                        Matrix3::from_diagonal(&width.map(|w| (damping * largest).max(1.0 / (w * w))));
                    Some(within(at + (curved.bowl() + scale).try_inverse()? * curved.gradient))
                })
                .collect();
            let values = evidence(&tried);
            let best = tried.into_iter().zip(values).max_by(|a, b| a.1.total_cmp(&b.1));
            let gained = best.map_or(0.0, |(_, value)| value - curved.value);
            if let Some((point, _)) = best.filter(|_| gained > 0.0) {
                at = point;
            }
            for k in 0..3 {
                let sd = curved.hessian[(k, k)].max(f64::MIN_POSITIVE).sqrt().recip();
                steps[k] = sd.clamp(DIFFERENCE.0 * width[k], DIFFERENCE.1 * width[k]);
            }
            curved = curvature(at, &steps, &ranges, evidence);
            idle = if gained < ENOUGH { idle + 1 } else { 0 };
            if idle > 2 {
                break;
            }
        }
        let prior = Matrix3::from_diagonal(&width.map(|w| 12.0 / (w * w)));
        let precision = curved.bowl() + prior;
        let covariance =
            positive_definite_inverse(&nalgebra::DMatrix::from_iterator(3, 3, precision.iter().copied()))
                .map_or_else(Matrix3::zeros, |(inverse, _)| Matrix3::from_fn(|i, j| inverse[(i, j)]));
        Peak::around(at, covariance * WIDER.powi(2), ranges, evidence, curved.value)
    }

    /// What is around the likeliest numbers, whose ln evidence is `most`.
    fn around(
        at: Vector3<f64>,
        spread: Matrix3<f64>,
        ranges: Ranges,
        evidence: &dyn Fn(&[Vector3<f64>]) -> Vec<f64>,
        most: f64,
    ) -> Peak {
        let volume: f64 = ranges.iter().map(|(low, high)| high - low).product();
        let alone = Peak { at, log_evidence: most, highest: most, points: vec![(at, 1.0)] };
        let Some(root) = spread.cholesky().map(|cholesky| cholesky.l()) else { return alone };
        // −ln q of z, but for its constant
        let drawn = (1..=DRAWN).map(normal).map(|z| (at + root * z, 0.5 * z.norm_squared()));
        let is_within = |point: &Vector3<f64>| bounded(*point, &ranges) == *point;
        let drawn: Vec<(Vector3<f64>, f64)> = drawn.filter(|(point, _)| is_within(point)).collect();
        let values = evidence(&drawn.iter().map(|(point, _)| *point).collect::<Vec<_>>());
        let weighted = drawn.iter().zip(values).map(|((point, rare), g)| (*point, (g - most + rare).exp()));
        let mut points: Vec<(Vector3<f64>, f64)> = weighted.filter(|(_, w)| w.is_finite()).collect();
        let whole: f64 = points.iter().map(|(_, weight)| weight).sum();
        if whole <= 0.0 {
            return alone;
        }
        points.iter_mut().for_each(|(_, weight)| *weight /= whole);
        let density = TAU.powf(1.5) * root.determinant();
        let log_evidence = most + (whole / DRAWN as f64 * density / volume).ln();
        Peak { at, log_evidence, highest: most, points }
    }

    /// Points that stand for as much of it each.
    pub fn even(&self, count: usize) -> Vec<Vector3<f64>> {
        let (mut next, mut below, mut even) = (0, 0.0, Vec::with_capacity(count));
        for (point, weight) in &self.points {
            below += weight;
            while next < count && (next as f64 + 0.5) / count as f64 <= below {
                even.push(*point);
                next += 1;
            }
        }
        even
    }

    /// Mean and standard deviation of one of them.
    pub fn moments(&self, k: usize) -> (f64, f64) {
        let mean: f64 = self.points.iter().map(|(point, weight)| weight * point[k]).sum();
        let square: f64 = self.points.iter().map(|(point, weight)| weight * (point[k] - mean).powi(2)).sum();
        (mean, square.sqrt())
    }

    /// The 95 % interval of one of them.
    pub fn interval(&self, k: usize) -> (f64, f64) {
        let mut by_size: Vec<(f64, f64)> = self.points.iter().map(|(point, w)| (point[k], *w)).collect();
        by_size.sort_by(|a, b| a.0.total_cmp(&b.0));
        let below = |p: f64| {
            let mut sum = 0.0;
            let found = by_size.iter().find(|(_, weight)| {
                sum += weight;
                sum >= p
            });
            found.or(by_size.last()).map_or(self.at[k], |point| point.0)
        };
        (below(0.025), below(0.975))
    }
}

/// Point number k of an even sequence of the standard normal (J. H. Halton 1960; G. E. P. Box, M.
/// E. Muller 1958).
fn normal(k: usize) -> Vector3<f64> {
    let halton = |base: usize| {
        let (mut value, mut share, mut rest) = (0.0, 1.0, k);
        while rest > 0 {
            share /= base as f64;
            value += share * (rest % base) as f64;
            rest /= base;
        }
        value
    };
    let [a, b, c, d] = [2, 3, 5, 7].map(halton);
    let (radius, other) = ((-2.0 * (1.0 - a).ln()).sqrt(), (-2.0 * (1.0 - c).ln()).sqrt());
    Vector3::new(radius * (TAU * b).cos(), radius * (TAU * b).sin(), other * (TAU * d).cos())
}

fn bounded(point: Vector3<f64>, ranges: &Ranges) -> Vector3<f64> {
    Vector3::from_fn(|k, _| point[k].clamp(ranges[k].0, ranges[k].1))
}

/// The evidence about a point.
struct Curved {
    value: f64,
    gradient: Vector3<f64>,
    /// −∂²g.
    hessian: Matrix3<f64>,
}

impl Curved {
    /// H without the directions in which it bends upwards.
    fn bowl(&self) -> Matrix3<f64> {
        let eigen = SymmetricEigen::new(self.hessian);
        let values = eigen.eigenvalues.map(|value| value.max(0.0));
        eigen.eigenvectors * Matrix3::from_diagonal(&values) * eigen.eigenvectors.transpose()
    }
}

/// By central differences, about a point that is moved inwards where it is at an end of its range.
fn curvature(
    at: Vector3<f64>,
    steps: &Vector3<f64>,
    ranges: &Ranges,
    evidence: &dyn Fn(&[Vector3<f64>]) -> Vec<f64>,
) -> Curved {
    let middle = Vector3::from_fn(|k, _| at[k].clamp(ranges[k].0 + steps[k], ranges[k].1 - steps[k]));
    let along = |k: usize, times: f64| Vector3::ith(k, times * steps[k]);
    let mut points = vec![at, middle];
    for k in 0..3 {
        points.extend([middle + along(k, 1.0), middle + along(k, -1.0)]);
    }
    const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];
    points.extend(PAIRS.iter().map(|&(a, b)| middle + along(a, 1.0) + along(b, 1.0)));
    points.extend(PAIRS.iter().map(|&(a, b)| middle + along(a, -1.0) + along(b, -1.0)));
    let g = evidence(&points);
    let (up, down) = (|k: usize| g[2 + 2 * k], |k: usize| g[3 + 2 * k]);
    let mut hessian = Matrix3::zeros();
    for k in 0..3 {
        hessian[(k, k)] = -(up(k) - 2.0 * g[1] + down(k)) / steps[k].powi(2);
    }
    for (number, (a, b)) in PAIRS.into_iter().enumerate() {
        let corners = g[8 + number] + g[11 + number];
        let mixed = 0.5 * (corners - up(a) - up(b) - down(a) - down(b) + 2.0 * g[1]);
        hessian[(a, b)] = -mixed / (steps[a] * steps[b]);
        hessian[(b, a)] = hessian[(a, b)];
    }
    let slope = Vector3::from_fn(|k, _| (up(k) - down(k)) / (2.0 * steps[k]));
    // what is no number bends nowhere
    let hessian = if hessian.iter().all(|value| value.is_finite()) { hessian } else { Matrix3::zeros() };
    let slope = slope.map(|value| if value.is_finite() { value } else { 0.0 });
    Curved { value: g[0], gradient: slope - hessian * (at - middle), hessian }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGES: Ranges = [(-4.0, 0.0), (0.0, 2.0), (0.5, 1.0)];

    /// A normal density that leans is found, with its covariance and its volume.
    #[test]
    fn a_peak_that_leans_is_found_and_measured() {
        let mean = Vector3::new(-1.3, 0.9, 0.72);
        let root = Matrix3::new(0.05, 0.0, 0.0, -0.06, 0.03, 0.0, 0.01, 0.0, 0.02);
        let inverse = (root * root.transpose()).try_inverse().unwrap();
        let one = |x: &Vector3<f64>| -0.5 * (x - mean).dot(&(inverse * (x - mean)));
        let evidence = |xs: &[Vector3<f64>]| xs.iter().map(one).collect::<Vec<f64>>();
        let peak = Peak::from(Vector3::new(-2.0, 0.4, 0.9), RANGES, &evidence);
        assert!((peak.at - mean).amax() < 0.005, "{}", peak.at);
        let expected = root * root.transpose();
        for k in 0..3 {
            let (_, sd) = peak.moments(k);
            assert!((sd / expected[(k, k)].sqrt() - 1.0).abs() < 0.15, "{k}: {sd}");
            let (low, high) = peak.interval(k);
            assert!(((high - low) / (3.92 * sd) - 1.0).abs() < 0.2, "{k}: {low} {high}");
        }
        let volume = (TAU.powf(1.5) * expected.determinant().sqrt() / 4.0).ln();
        assert!((peak.log_evidence - volume).abs() < 0.1, "{} {volume}", peak.log_evidence);
        let even = peak.even(24);
        let mean_of = even.iter().sum::<Vector3<f64>>() / 24.0;
        assert!(even.len() == 24 && (mean_of - mean).amax() < 0.03, "{mean_of}");
    }

    /// Of numbers that nothing is known of the evidence is what it is anywhere.
    #[test]
    fn what_changes_nothing_costs_nothing() {
        let evidence = |xs: &[Vector3<f64>]| vec![3.0; xs.len()];
        let peak = Peak::from(Vector3::new(-1.0, 1.0, 0.6), RANGES, &evidence);
        assert!((peak.log_evidence - 3.0).abs() < 0.3, "{}", peak.log_evidence);
        let (low, high) = peak.interval(2);
        assert!(low < 0.55 && high > 0.9, "{low} {high}");
    }

    /// A peak at the end of a range goes inwards alone.
    #[test]
    fn what_is_at_an_end_goes_inwards() {
        let one =
            |x: &Vector3<f64>| -0.5 * ((x[2] - 1.05) / 0.1).powi(2) - 0.5 * ((x[0] + 2.0) / 0.1).powi(2);
        let evidence = |xs: &[Vector3<f64>]| xs.iter().map(one).collect::<Vec<f64>>();
        let peak = Peak::from(Vector3::new(-2.0, 1.0, 0.7), RANGES, &evidence);
        let (mean, sd) = peak.moments(2);
        assert!(peak.at[2] == 1.0, "{}", peak.at);
        // of a normal density beyond half a standard deviation: 1.05 − 0.1·φ(½)/Φ(−½)
        assert!((mean - 0.936).abs() < 0.015 && sd < 0.08, "{mean} {sd}");
    }
}
