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

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use crate::linalg::positive_definite_inverse;

/// Most steps.
const ROUNDS: usize = 12;
/// Steps that are tried at once, as Levenberg's damping in units of the largest curvature.
const DAMPINGS: [f64; 6] = [0.0, 1e-3, 1e-2, 0.1, 1.0, 10.0];
/// The smallest differences, as a share of the range, and the widest of what has one peak.
const DIFFERENCE: f64 = 1e-4;
pub(super) const WIDEST: f64 = 0.1;
/// A step that gains less is the last one.
const ENOUGH: f64 = 0.01;

/// Points that are drawn for each number beyond the first, and how much wider than the normal
/// density.
const DRAWN: usize = 64;
const WIDER: f64 = 1.4;
/// Times that they are drawn at most, each about the mean and by the covariance of those before:
/// what has edges is not what second derivatives say (O. Cappé et al., J. Comput. Graph. Stat. 13,
/// 2004). It is enough once ln of the evidence changes by less.
const LOOKS: usize = 8;
const SETTLED: f64 = 0.05;

/// The likeliest numbers.
#[derive(Debug, Clone)]
pub(super) struct Peak {
    pub at: DVector<f64>,
    /// Ln of the evidence, averaged over the prior.
    pub log_evidence: f64,
    /// Ln of the evidence there.
    pub highest: f64,
    /// Points with what share of the posterior each stands for.
    points: Vec<(DVector<f64>, f64)>,
}

impl Peak {
    /// Uphill from `start`, each number within its range, by differences of at most `widest` as a
    /// share of it; `evidence` of many points at once.
    pub fn from(
        start: DVector<f64>,
        ranges: &[(f64, f64)],
        widest: &[f64],
        evidence: &dyn Fn(&[DVector<f64>]) -> Vec<f64>,
    ) -> Peak {
        let count = ranges.len();
        let width = DVector::from_fn(count, |k, _| ranges[k].1 - ranges[k].0);
        let within = |point: DVector<f64>| bounded(point, ranges);
        let widest = DVector::from_fn(count, |k, _| width[k] * widest[k]);
        let mut steps = widest.clone();
        let mut at = within(start);
        let mut curved = curvature(&at, &steps, ranges, evidence);
        // where nothing is gained the differences may have been too wide
        let mut idle = 0;
        for _ in 0..ROUNDS {
            let largest = curved.hessian.diagonal().amax().max(f64::MIN_POSITIVE);
            let bowl = curved.bowl();
            let tried: Vec<DVector<f64>> = DAMPINGS
                .iter()
                .filter_map(|damping| {
                    let scale =
                        DMatrix::from_diagonal(&width.map(|w| (damping * largest).max(1.0 / (w * w))));
                    Some(within(&at + (&bowl + scale).try_inverse()? * &curved.gradient))
                })
                .collect();
            let values = evidence(&tried);
            let best = tried.into_iter().zip(values).max_by(|a, b| a.1.total_cmp(&b.1));
            let gained = best.as_ref().map_or(0.0, |(_, value)| value - curved.value);
            if let Some((point, _)) = best.filter(|_| gained > 0.0) {
                at = point;
            }
            for k in 0..count {
                let sd = curved.hessian[(k, k)].max(f64::MIN_POSITIVE).sqrt().recip();
                steps[k] = sd.clamp(DIFFERENCE * width[k], widest[k]);
            }
            curved = curvature(&at, &steps, ranges, evidence);
            idle = if gained < ENOUGH { idle + 1 } else { 0 };
            if idle > 2 {
                break;
            }
        }
        let prior = DMatrix::from_diagonal(&width.map(|w| 12.0 / (w * w)));
        let precision = curved.bowl() + prior;
        let covariance = positive_definite_inverse(&precision)
            .map_or_else(|| DMatrix::zeros(count, count), |(inverse, _)| inverse);
        Peak::around(at, covariance, ranges, evidence, curved.value)
    }

    /// What is around the likeliest numbers, whose ln evidence is `most`.
    fn around(
        at: DVector<f64>,
        covariance: DMatrix<f64>,
        ranges: &[(f64, f64)],
        evidence: &dyn Fn(&[DVector<f64>]) -> Vec<f64>,
        most: f64,
    ) -> Peak {
        let mut peak = Peak { points: vec![(at.clone(), 1.0)], at, log_evidence: most, highest: most };
        let (mut middle, mut spread) = (peak.at.clone(), covariance);
        for _ in 0..LOOKS {
            let Some((points, log_evidence)) = looked(&middle, &spread, ranges, evidence, most) else {
                break;
            };
            let changed = (log_evidence - peak.log_evidence).abs();
            (peak.points, peak.log_evidence) = (points, log_evidence);
            if changed < SETTLED {
                break;
            }
            let mut mean = DVector::zeros(middle.len());
            peak.points.iter().for_each(|(point, weight)| mean += point * *weight);
            let mut square = DMatrix::zeros(middle.len(), middle.len());
            for (point, weight) in &peak.points {
                let off = point - &mean;
                square += &off * off.transpose() * *weight;
            }
            (middle, spread) = (mean, square);
        }
        peak
    }

    /// Points that stand for as much of it each.
    pub fn even(&self, count: usize) -> Vec<DVector<f64>> {
        let (mut next, mut below, mut even) = (0, 0.0, Vec::with_capacity(count));
        for (point, weight) in &self.points {
            below += weight;
            while next < count && (next as f64 + 0.5) / count as f64 <= below {
                even.push(point.clone());
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

    /// The 95 % interval of what is made of them, `ends` the ends of its range: the shortest of a
    /// few, for one of quantiles alone never holds what is at an end.
    pub fn interval(&self, value: &dyn Fn(&DVector<f64>) -> f64, ends: Option<(f64, f64)>) -> (f64, f64) {
        let mut by_size: Vec<(f64, f64)> = self.points.iter().map(|(point, w)| (value(point), *w)).collect();
        by_size.sort_by(|a, b| a.0.total_cmp(&b.0));
        let below = |p: f64| {
            let mut sum = 0.0;
            let found = by_size.iter().find(|(_, weight)| {
                sum += weight;
                sum >= p
            });
            found.or(by_size.last()).map_or_else(|| value(&self.at), |point| point.0)
        };
        let mut shortest = (below(0.025), below(0.975));
        let Some((lowest, highest)) = ends else { return shortest };
        for (low, high) in [(lowest, below(0.95)), (below(0.05), highest)] {
            if high - low < shortest.1 - shortest.0 {
                shortest = (low, high);
            }
        }
        shortest
    }
}

/// Points about a middle that are within the ranges, with their share of the posterior.
type Points = Vec<(DVector<f64>, f64)>;

/// Points about a middle by importance sampling, and ln of the evidence; `None` where there are
/// none.
fn looked(
    middle: &DVector<f64>,
    spread: &DMatrix<f64>,
    ranges: &[(f64, f64)],
    evidence: &dyn Fn(&[DVector<f64>]) -> Vec<f64>,
    most: f64,
) -> Option<(Points, f64)> {
    let volume: f64 = ranges.iter().map(|(low, high)| high - low).product();
    let (count, number) = (ranges.len(), DRAWN * (ranges.len() - 1));
    let root = (spread * WIDER.powi(2)).cholesky()?.l();
    // −ln q of z, but for its constant
    let drawn = (1..=number).map(|k| normal(k, count));
    let drawn = drawn.map(|z| (middle + &root * &z, 0.5 * z.norm_squared()));
    let is_within = |point: &DVector<f64>| bounded(point.clone(), ranges) == *point;
    let (drawn, rare): (Vec<DVector<f64>>, Vec<f64>) = drawn.filter(|(point, _)| is_within(point)).unzip();
    let values = evidence(&drawn);
    let weights = values.into_iter().zip(rare).map(|(g, rare)| (g - most + rare).exp());
    let mut points: Points = drawn.into_iter().zip(weights).filter(|(_, w)| w.is_finite()).collect();
    let whole: f64 = points.iter().map(|(_, weight)| weight).sum();
    if whole <= 0.0 {
        return None;
    }
    points.iter_mut().for_each(|(_, weight)| *weight /= whole);
    let density = TAU.powf(0.5 * count as f64) * root.determinant();
    Some((points, most + (whole / number as f64 * density / volume).ln()))
}

/// Primes, as many as numbers and one more.
const PRIMES: [usize; 6] = [2, 3, 5, 7, 11, 13];

/// Point number k of an even sequence of the standard normal in so many dimensions, six at most (J.
/// H. Halton 1960; G. E. P. Box, M. E. Muller 1958).
fn normal(k: usize, count: usize) -> DVector<f64> {
    let halton = |base: usize| {
        let (mut value, mut share, mut rest) = (0.0, 1.0, k);
        while rest > 0 {
            share /= base as f64;
            value += share * (rest % base) as f64;
            rest /= base;
        }
        value
    };
    let pair = |bases: &[usize]| {
        let (a, b) = (halton(bases[0]), halton(bases[1]));
        let (radius, turn) = ((-2.0 * (1.0 - a).ln()).sqrt(), TAU * b);
        [radius * turn.cos(), radius * turn.sin()]
    };
    DVector::from_iterator(count, PRIMES.chunks(2).flat_map(pair).take(count))
}

fn bounded(point: DVector<f64>, ranges: &[(f64, f64)]) -> DVector<f64> {
    DVector::from_fn(point.len(), |k, _| point[k].clamp(ranges[k].0, ranges[k].1))
}

/// The evidence about a point.
struct Curved {
    value: f64,
    gradient: DVector<f64>,
    /// −∂²g.
    hessian: DMatrix<f64>,
}

impl Curved {
    /// H without the directions in which it bends upwards.
    fn bowl(&self) -> DMatrix<f64> {
        let eigen = SymmetricEigen::new(self.hessian.clone());
        let values = eigen.eigenvalues.map(|value| value.max(0.0));
        &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
    }
}

/// By central differences, about a point that is moved inwards where it is at an end of its range.
fn curvature(
    at: &DVector<f64>,
    steps: &DVector<f64>,
    ranges: &[(f64, f64)],
    evidence: &dyn Fn(&[DVector<f64>]) -> Vec<f64>,
) -> Curved {
    let count = at.len();
    let inwards = |k: usize| at[k].clamp(ranges[k].0 + steps[k], ranges[k].1 - steps[k]);
    let middle = DVector::from_fn(count, |k, _| inwards(k));
    let moved = |along: &[(usize, f64)]| {
        let mut point = middle.clone();
        along.iter().for_each(|&(k, times)| point[k] += times * steps[k]);
        point
    };
    let pairs: Vec<(usize, usize)> = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))).collect();
    let mut points = vec![at.clone(), middle.clone()];
    for k in 0..count {
        points.extend([moved(&[(k, 1.0)]), moved(&[(k, -1.0)])]);
    }
    let first = points.len();
    points.extend(pairs.iter().map(|&(a, b)| moved(&[(a, 1.0), (b, 1.0)])));
    points.extend(pairs.iter().map(|&(a, b)| moved(&[(a, -1.0), (b, -1.0)])));
    let g = evidence(&points);
    let (up, down) = (|k: usize| g[2 + 2 * k], |k: usize| g[3 + 2 * k]);
    let mut hessian = DMatrix::zeros(count, count);
    for k in 0..count {
        hessian[(k, k)] = -(up(k) - 2.0 * g[1] + down(k)) / steps[k].powi(2);
    }
    for (number, &(a, b)) in pairs.iter().enumerate() {
        let corners = g[first + number] + g[first + pairs.len() + number];
        let mixed = 0.5 * (corners - up(a) - up(b) - down(a) - down(b) + 2.0 * g[1]);
        hessian[(a, b)] = -mixed / (steps[a] * steps[b]);
        hessian[(b, a)] = hessian[(a, b)];
    }
    let slope = DVector::from_fn(count, |k, _| (up(k) - down(k)) / (2.0 * steps[k]));
    // what is no number bends nowhere
    let is_known = hessian.iter().all(|value| value.is_finite());
    let hessian = if is_known { hessian } else { DMatrix::zeros(count, count) };
    let slope = slope.map(|value| if value.is_finite() { value } else { 0.0 });
    Curved { value: g[0], gradient: slope - &hessian * (at - &middle), hessian }
}

#[cfg(test)]
mod tests {
    use super::*;

    use nalgebra::{Matrix3, Vector3};

    const RANGES: [(f64, f64); 3] = [(-4.0, 0.0), (0.0, 2.0), (0.5, 1.0)];

    fn dynamic(numbers: [f64; 3]) -> DVector<f64> {
        DVector::from_row_slice(&numbers)
    }

    fn fixed(numbers: &DVector<f64>) -> Vector3<f64> {
        Vector3::new(numbers[0], numbers[1], numbers[2])
    }

    /// A normal density that leans is found, with its covariance and its volume.
    #[test]
    fn a_peak_that_leans_is_found_and_measured() {
        let mean = Vector3::new(-1.3, 0.9, 0.72);
        let root = Matrix3::new(0.05, 0.0, 0.0, -0.06, 0.03, 0.0, 0.01, 0.0, 0.02);
        let inverse = (root * root.transpose()).try_inverse().unwrap();
        let one = |x: &DVector<f64>| -0.5 * (fixed(x) - mean).dot(&(inverse * (fixed(x) - mean)));
        let evidence = |xs: &[DVector<f64>]| xs.iter().map(one).collect::<Vec<f64>>();
        let peak = Peak::from(dynamic([-2.0, 0.4, 0.9]), &RANGES, &[WIDEST; 3], &evidence);
        assert!((fixed(&peak.at) - mean).amax() < 0.005, "{}", peak.at);
        let expected = root * root.transpose();
        for k in 0..3 {
            let (_, sd) = peak.moments(k);
            assert!((sd / expected[(k, k)].sqrt() - 1.0).abs() < 0.15, "{k}: {sd}");
            let (low, high) = peak.interval(&|point| point[k], None);
            assert!(((high - low) / (3.92 * sd) - 1.0).abs() < 0.2, "{k}: {low} {high}");
        }
        let volume = (TAU.powf(1.5) * expected.determinant().sqrt() / 4.0).ln();
        assert!((peak.log_evidence - volume).abs() < 0.1, "{} {volume}", peak.log_evidence);
        let even = peak.even(24);
        let mean_of = even.iter().map(fixed).sum::<Vector3<f64>>() / 24.0;
        assert!(even.len() == 24 && (mean_of - mean).amax() < 0.03, "{mean_of}");
    }

    /// Of numbers that nothing is known of the evidence is what it is anywhere.
    #[test]
    fn what_changes_nothing_costs_nothing() {
        let evidence = |xs: &[DVector<f64>]| vec![3.0; xs.len()];
        let peak = Peak::from(dynamic([-1.0, 1.0, 0.6]), &RANGES, &[WIDEST; 3], &evidence);
        assert!((peak.log_evidence - 3.0).abs() < 0.3, "{}", peak.log_evidence);
        let (low, high) = peak.interval(&|point| point[2], None);
        assert!(low < 0.55 && high > 0.9, "{low} {high}");
    }

    /// An edge is no normal density: what is as likely as anything up to it, and nothing beyond.
    #[test]
    fn what_has_edges_is_measured_as_it_is() {
        let is_in = |x: &DVector<f64>| (x[0] + 2.0).abs() < 0.3 && (x[1] - 1.0).abs() < 0.2;
        let one = |x: &DVector<f64>| if is_in(x) { 0.0 } else { -1e3 } - 0.5 * ((x[2] - 0.7) / 0.02).powi(2);
        let evidence = |xs: &[DVector<f64>]| xs.iter().map(one).collect::<Vec<f64>>();
        let peak = Peak::from(dynamic([-2.1, 1.05, 0.72]), &RANGES, &[WIDEST; 3], &evidence);
        for (k, half) in [(0, 0.3), (1, 0.2)] {
            let (_, sd) = peak.moments(k);
            assert!((sd * 3.0f64.sqrt() / half - 1.0).abs() < 0.12, "{k}: {sd}");
        }
        // 0.6 × 0.4 × √(2π)·0.02 of 4 × 2 × 0.5
        let volume = (0.24 * TAU.sqrt() * 0.02 / 4.0).ln();
        assert!((peak.log_evidence - volume).abs() < 0.25, "{} {volume}", peak.log_evidence);
    }

    /// A peak at the end of a range goes inwards alone.
    #[test]
    fn what_is_at_an_end_goes_inwards() {
        let one =
            |x: &DVector<f64>| -0.5 * ((x[2] - 1.05) / 0.1).powi(2) - 0.5 * ((x[0] + 2.0) / 0.1).powi(2);
        let evidence = |xs: &[DVector<f64>]| xs.iter().map(one).collect::<Vec<f64>>();
        let peak = Peak::from(dynamic([-2.0, 1.0, 0.7]), &RANGES, &[WIDEST; 3], &evidence);
        let (mean, sd) = peak.moments(2);
        assert!(peak.at[2] == 1.0, "{}", peak.at);
        // what is at the end is within
        let (low, high) = peak.interval(&|point| point[2], Some(RANGES[2]));
        assert!(high == 1.0 && (0.75..0.9).contains(&low), "{low} {high}");
        // of a normal density beyond half a standard deviation: 1.05 − 0.1·φ(½)/Φ(−½)
        assert!((mean - 0.936).abs() < 0.015 && sd < 0.08, "{mean} {sd}");
    }
}
