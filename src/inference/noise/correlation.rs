//! How much neighbours of a run resemble each other beyond what the run has in common: φ of a
//! first-order autoregression.
//!
//! Found in repeats, from what each datum is off the mean of its own condition d, so that nothing
//! that repeats itself counts: the φ that makes
//!
//! ```text
//! −2·ln L = n·ln(Σ|W·d|²/n) + Σ ((m − 1)·ln(1 − φ²) + ln(1 + ρ·|a|²))
//! ```
//!
//! least, at the likeliest ρ, where that is worth its number ([`WORTH`]).

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::inference::Evidence;

/// φ that are tried.
const CORRELATIONS: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];
/// ρ that are tried.
const RATIOS: [f64; 13] = [0.0, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0, 1e3, 1e4, 1e5];
/// Ln of the likelihood ratio from which on neighbours resemble each other.
const WORTH: f64 = 3.0;
/// Fewer repeated data say nothing.
const FEWEST: usize = 20;

/// What each datum is off the mean of its repeats, as much as it counts, scaled to the variance of
/// a datum: r repeats leave (r − 1)/r of it. Nothing for what was not repeated, or hardly counts:
/// what is far off says nothing of the others.
pub fn deviations(evidence: &Evidence, left: &DVector<f64>) -> Vec<Option<f64>> {
    deviations_among(evidence, left, |_| true)
}

/// The same among the rows that are `wanted`.
pub fn deviations_among(
    evidence: &Evidence,
    left: &DVector<f64>,
    is_wanted: impl Fn(usize) -> bool,
) -> Vec<Option<f64>> {
    let counts = |row: usize| evidence.counts(row) && is_wanted(row);
    let mut replicates: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for (row, &group) in evidence.replicate_group.iter().enumerate().filter(|(row, _)| counts(*row)) {
        let (sum, count) = replicates.entry(group).or_default();
        (*sum, *count) = (*sum + left[row], *count + 1.0);
    }
    let off = |(row, group): (usize, &usize)| {
        let (sum, repeats) = *replicates.get(group)?;
        let scale = (evidence.weight[row] * repeats / (repeats - 1.0)).sqrt();
        (counts(row) && repeats > 1.0).then(|| (left[row] - sum / repeats) * scale)
    };
    evidence.replicate_group.iter().enumerate().map(off).collect()
}

/// Those of each run.
pub fn by_group(evidence: &Evidence, deviations: &[Option<f64>]) -> Vec<Vec<f64>> {
    let mut groups: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (deviation, &run) in deviations.iter().zip(&evidence.shared) {
        groups.entry(run).or_default().extend(deviation);
    }
    groups.into_values().filter(|group| group.len() > 1).collect()
}

/// φ; 0 where the repeats do not show one.
pub fn correlation(evidence: &Evidence, left: &DVector<f64>) -> f64 {
    if !evidence.is_robust {
        return 0.0;
    }
    let groups = by_group(evidence, &deviations(evidence, left));
    if groups.iter().map(Vec::len).sum::<usize>() < FEWEST {
        return 0.0;
    }
    let (_, without) = likeliest(&groups, 0.0);
    let tried = CORRELATIONS.map(|phi| (phi, likeliest(&groups, phi).1));
    let best = tried.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    best.filter(|(_, likelihood)| *likelihood > without + WORTH).map_or(0.0, |(phi, _)| phi)
}

/// |a|² of m data.
pub fn length(m: usize, phi: f64) -> f64 {
    1.0 + (m as f64 - 1.0) * (1.0 - phi) / (1.0 + phi)
}

/// The likeliest ρ with the ln of its likelihood.
pub fn likeliest(groups: &[Vec<f64>], phi: f64) -> (f64, f64) {
    // Σ of the squares of A·d, and (a·A·d)² of each group with its |a|²
    let (quick, slow) = ((1.0 - phi * phi).sqrt(), ((1.0 - phi) / (1.0 + phi)).sqrt());
    let (mut square, mut determinant, mut count) = (0.0, 0.0, 0.0);
    let mut along: Vec<(f64, f64)> = Vec::new();
    for group in groups {
        let mut own = group[0];
        square += own * own;
        for pair in group.windows(2) {
            let e = (pair[1] - phi * pair[0]) / quick;
            (square, own) = (square + e * e, own + slow * e);
        }
        determinant += (group.len() as f64 - 1.0) * (1.0 - phi * phi).ln();
        count += group.len() as f64;
        along.push((own * own, length(group.len(), phi)));
    }
    let likelihood = |ratio: f64| {
        let taken = |(own, length): &(f64, f64)| own * ratio / (1.0 + ratio * length);
        let left = square - along.iter().map(taken).sum::<f64>();
        let of_shared: f64 = along.iter().map(|(_, length)| (ratio * length).ln_1p()).sum();
        -0.5 * (count * (left.max(f64::MIN_POSITIVE) / count).ln() + determinant + of_shared)
    };
    let tried = RATIOS.map(|ratio| (ratio, likelihood(ratio)));
    tried.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, f64::NEG_INFINITY))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// 20 runs of 12 conditions, whose noise has the correlation φ, and a zero of their own.
    fn evidence(phi: f64, zero: f64) -> Evidence {
        let mut random = Random::seeded(17, 0);
        let (mut residual, mut shared) = (Vec::new(), Vec::new());
        for run in 0..20 {
            let (mut noise, zero) = (random.normal(), zero * random.normal());
            for condition in 0..12 {
                residual.push(5.0 * condition as f64 + zero + noise);
                shared.push(run);
                noise = phi * noise + (1.0 - phi * phi).sqrt() * random.normal();
            }
        }
        let replicate_group = (0..240).map(|row| row % 12).collect();
        let is_robust = true;
        Evidence { shared, replicate_group, is_robust, ..Evidence::new(DVector::from_vec(residual)) }
    }

    #[test]
    fn neighbours_that_resemble_each_other_are_seen_beside_the_zeros_of_runs() {
        for (phi, zero) in [(0.0, 0.0), (0.0, 2.0), (0.5, 0.0), (0.5, 2.0)] {
            let evidence = evidence(phi, zero);
            let found = correlation(&evidence, &evidence.residual);
            assert!((found - phi).abs() < 0.15, "{found} instead of {phi}, zeros {zero}");
        }
    }
}
