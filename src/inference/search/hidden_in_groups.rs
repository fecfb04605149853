//! What acts on whole groups of data that share an error, and looks like the scatter of these
//! errors.
//!
//! Zeros that are read run by run scatter; a knock between two runs shifts all that follow, a drift
//! moves them all. As long as the ratio ρ of that scatter is found with the knock or the drift in
//! it, neither is worth a name: it is what zeros do. With it taken out, ρ is another one, and the
//! Gaussian likelihoods of what is left can be compared,
//!
//! ```text
//! ln p = −½·ν·ln(|W·r|²/ν) − ½·Σ ln(1 + ρ·|a|²)      over the groups, W and a as in `whitening.rs`
//! ```
//!
//! less ½·k·ln(number of groups) for the k numbers of what is taken out (G. Schwarz, *Ann. Stat.* 6
//! (1978) 461–464).

use std::collections::{BTreeMap, HashMap};

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::linearised::Linearised;
use crate::inference::noise::whitening::Whitening;
use crate::inference::{Evidence, ForwardModel, Kind, Step, Term};
use crate::linalg::least_squares;

/// Ln of the odds at which ρ is found without a step: a thousand, and a hundred places.
const HIDDEN: f64 = 11.5;
/// Groups on either side of a step, at least: one zero that is far out is a zero.
const GROUPS: usize = 2;

/// So many steps are looked at in full: those that take most of the scatter of the groups' means.
const LOOKED: usize = 8;

/// Ratios among which the likeliest is looked for.
const RATIOS: [f64; 8] = [0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0];
/// Share of a column's squares that its means over the groups have, at least, of what acts on whole
/// groups.
const OF_GROUPS: f64 = 0.5;

/// The step, or whatever acts on whole groups, that is most probably hidden in what is `left`;
/// `None` where none is.
pub fn hidden(model: &Linearised<'_>, evidence: &Evidence, left: &DVector<f64>) -> Option<Term> {
    let both = [hidden_step(model, evidence, left), hidden_course(model, evidence, left)];
    let mut found: Vec<Hidden> =
        both.into_iter().flatten().filter(|hidden| hidden.log_odds > HIDDEN).collect();
    found.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    // ρ by moments is about the likeliest: what is gained may be gained by a better one alone
    let is_so = |hidden: &Hidden| {
        highest_density(evidence, &hidden.rest) - highest_density(evidence, left) > HIDDEN + hidden.price
    };
    found.into_iter().find(is_so).map(|hidden| hidden.term)
}

/// What may be hidden.
struct Hidden {
    /// Ln of its odds, about.
    log_odds: f64,
    /// Ln of what its numbers cost.
    price: f64,
    term: Term,
    /// What is left without it.
    rest: DVector<f64>,
}

/// The highest of the densities over ρ, with neighbours that resemble each other and without.
fn highest_density(evidence: &Evidence, left: &DVector<f64>) -> f64 {
    let own = Whitening::new(evidence, left);
    let ratios = RATIOS.into_iter().chain([own.ratio]);
    let densities = ratios.flat_map(|ratio| [0.0, own.correlation].map(|correlation| (ratio, correlation)));
    let density = |(ratio, correlation): (f64, f64)| {
        let known =
            Evidence { shared_ratio: Some(ratio), correlation: Some(correlation), ..evidence.clone() };
        log_density(&known, left)
    };
    densities.map(density).fold(f64::NEG_INFINITY, f64::max)
}

/// Ln of the density of what is left, at the ρ that it has.
fn log_density(evidence: &Evidence, left: &DVector<f64>) -> f64 {
    let whitening = Whitening::new(evidence, left);
    let degrees_of_freedom = whitening.degrees_of_freedom.max(1) as f64;
    let square = whitening.apply(left).norm_squared().max(f64::MIN_POSITIVE);
    -0.5 * degrees_of_freedom * (square / degrees_of_freedom).ln() + whitening.log_determinant()
}

/// What acts on whole groups otherwise than by a step, as a drift does.
fn hidden_course(model: &Linearised<'_>, evidence: &Evidence, left: &DVector<f64>) -> Option<Hidden> {
    let members = {
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        evidence
            .shared
            .iter()
            .enumerate()
            .for_each(|(row, &group)| members.entry(group).or_default().push(row));
        members.into_values().collect::<Vec<_>>()
    };
    let is_of_groups = |columns: &DMatrix<f64>| {
        let of_mean = |rows: &Vec<usize>, k: usize| {
            rows.iter().map(|&row| columns[(row, k)]).sum::<f64>().powi(2) / rows.len() as f64
        };
        let of_means: f64 =
            (0..columns.ncols()).flat_map(|k| members.iter().map(move |rows| of_mean(rows, k))).sum();
        of_means > OF_GROUPS * columns.norm_squared()
    };
    let before = log_density(evidence, left);
    let candidates = model.candidates();
    let of_candidate = |candidate: usize| {
        if model.step(candidate).is_some() || candidates[candidate].effect.kind == Kind::Mistake {
            return None;
        }
        let columns = model.neutral(candidate);
        let k = columns.ncols();
        if k * GROUPS > members.len() || !(is_of_groups(&columns) && columns.amax() > 0.0) {
            return None;
        }
        let weighted = |row: usize, k: usize| evidence.weight[row].sqrt() * columns[(row, k)];
        let values = least_squares(
            &DMatrix::from_fn(left.len(), k, weighted),
            &DVector::from_fn(left.len(), |row, _| evidence.weight[row].sqrt() * left[row]),
        )
        .ok()?;
        let price = 0.5 * k as f64 * (members.len() as f64).ln();
        let rest = left - &columns * &values;
        let log_odds = log_density(evidence, &rest) - before - price;
        let neutral = candidates[candidate].neutral(candidate);
        let sizes = candidates[candidate].parameters.iter().map(|p| p.size);
        let values = neutral.values.iter().zip(values.iter().zip(sizes)).map(|(n, (x, size))| n + x * size);
        Some(Hidden { log_odds, price, term: Term { values: values.collect(), ..neutral }, rest })
    };
    (0..candidates.len()).filter_map(of_candidate).max_by(|a, b| a.log_odds.total_cmp(&b.log_odds))
}

/// The step that is most probably hidden.
fn hidden_step(model: &Linearised<'_>, evidence: &Evidence, left: &DVector<f64>) -> Option<Hidden> {
    let log_density = |left: &DVector<f64>| log_density(evidence, left);
    let candidates = model.candidates();
    let stepped = most_likely_steps(model, evidence, left).into_iter().filter_map(|(candidate, step)| {
        let (before, after) = step.data.split_at(step.from);
        let mean = |rows: &[usize]| mean_of_groups(evidence, left, rows);
        let (level, level_before, level_after) = (mean(&step.data)?, mean(before)?, mean(after)?);
        // whatever level all have is not the question
        let less = |before_by: f64, after_by: f64| {
            let mut rest = left.clone();
            before.iter().for_each(|&row| rest[row] -= before_by);
            after.iter().for_each(|&row| rest[row] -= after_by);
            rest
        };
        let rest = less(level_before, level_after);
        let log_odds = log_density(&rest) - log_density(&less(level, level));
        Some((log_odds, candidate, level_after - level_before, rest))
    });
    let (log_odds, candidate, by, rest) =
        stepped.reduce(|best, other| if other.0 > best.0 { other } else { best })?;
    let neutral = candidates[candidate].neutral(candidate);
    let values = neutral.values.iter().map(|value| value + by).collect();
    Some(Hidden { log_odds, price: 0.0, term: Term { values, ..neutral }, rest })
}

/// The steps that take most of the scatter of the groups' means, as a share of what they leave.
fn most_likely_steps(model: &Linearised<'_>, evidence: &Evidence, left: &DVector<f64>) -> Vec<(usize, Step)> {
    let mut levels: HashMap<*const usize, Levels> = HashMap::new();
    let mut steps: Vec<(f64, usize, Step)> = Vec::new();
    for candidate in 0..model.candidates().len() {
        let Some(step) = model.step(candidate) else { continue };
        let of_sequence =
            levels.entry(step.data.as_ptr()).or_insert_with(|| Levels::of(evidence, left, &step.data));
        steps.push((of_sequence.taken_by_step(step.from), candidate, step));
    }
    steps.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    steps.truncate(LOOKED);
    steps.sort_by_key(|(_, candidate, _)| *candidate);
    steps.into_iter().map(|(_, candidate, step)| (candidate, step)).collect()
}

/// Means of the groups along a sequence.
struct Levels {
    /// How many groups have begun before each datum of the sequence.
    begun: Vec<usize>,
    /// Sums of the means of so many groups, from none to all.
    sums: Vec<f64>,
    /// Sum of the squares of the means.
    square: f64,
}

impl Levels {
    fn of(evidence: &Evidence, left: &DVector<f64>, data: &[usize]) -> Levels {
        let mut number: HashMap<usize, usize> = HashMap::new();
        let mut of_group: Vec<(f64, f64)> = Vec::new();
        let mut begun = Vec::with_capacity(data.len());
        for &row in data {
            begun.push(of_group.len());
            let number = *number.entry(evidence.shared[row]).or_insert_with(|| {
                of_group.push((0.0, 0.0));
                of_group.len() - 1
            });
            of_group[number].0 += evidence.weight[row] * left[row];
            of_group[number].1 += evidence.weight[row];
        }
        let means = of_group.iter().map(|(sum, weight)| sum / weight.max(f64::MIN_POSITIVE));
        let mut sums = vec![0.0];
        let mut square = 0.0;
        for mean in means {
            sums.push(sums[sums.len() - 1] + mean);
            square += mean * mean;
        }
        Levels { begun, sums, square }
    }

    /// What a step before datum `from` takes of the squares of the means about their own mean, over
    /// what it leaves: with levels b of n before and a of m after it, n·m/(n + m)·(a − b)².
    fn taken_by_step(&self, from: usize) -> f64 {
        let all = self.sums.len() - 1;
        let before = self.begun.get(from).copied().unwrap_or(all);
        if before == 0 || before == all {
            return 0.0;
        }
        let (n, m) = (before as f64, (all - before) as f64);
        let (sum, whole) = (self.sums[before], self.sums[all]);
        let taken = n * m / (n + m) * ((whole - sum) / m - sum / n).powi(2);
        let scatter = (self.square - whole * whole / (n + m)).max(0.0);
        taken / (scatter - taken).max(f64::EPSILON * scatter).max(f64::MIN_POSITIVE)
    }
}

/// The mean of the means of the groups; `None` of fewer than [`GROUPS`].
fn mean_of_groups(evidence: &Evidence, left: &DVector<f64>, rows: &[usize]) -> Option<f64> {
    let mut groups: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for &row in rows {
        let (sum, weight) = groups.entry(evidence.shared[row]).or_default();
        (*sum, *weight) = (*sum + evidence.weight[row] * left[row], *weight + evidence.weight[row]);
    }
    let sum: f64 = groups.values().map(|(sum, weight)| sum / weight.max(f64::MIN_POSITIVE)).sum();
    (groups.len() >= GROUPS).then(|| sum / groups.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    const GROUPS: usize = 20;
    const POINTS: usize = 6;

    fn swing(row: usize) -> f64 {
        (1.5 * std::f64::consts::TAU * (row / POINTS) as f64 / GROUPS as f64).sin()
    }

    /// A swing over the groups, and a law within them.
    fn model() -> Columns {
        let mut model = Columns::new(GROUPS * POINTS);
        let column = |value: fn(usize) -> f64| DMatrix::from_fn(GROUPS * POINTS, 1, move |row, _| value(row));
        model.add("swing", "", column(swing), false);
        model.add("law", "", column(|row| (row % POINTS) as f64 - 2.5), false);
        model
    }

    fn hidden_in(size: f64, zeros: f64, seed: u64) -> Option<Term> {
        let mut random = Random::seeded(seed, 0);
        let mut residual = Vec::new();
        for group in 0..GROUPS {
            let zero = zeros * random.normal();
            for point in 0..POINTS {
                residual.push(size * swing(group * POINTS + point) + zero + random.normal());
            }
        }
        let evidence = Evidence {
            replicate_group: (0..GROUPS * POINTS).map(|row| row % POINTS).collect(),
            shared: (0..GROUPS * POINTS).map(|row| row / POINTS).collect(),
            ..independent(residual)
        };
        hidden(&Linearised::new(&model()), &evidence, &evidence.residual)
    }

    #[test]
    fn a_swing_of_the_zeros_is_no_scatter_of_theirs() {
        for seed in 0..5 {
            let Some(term) = hidden_in(8.0, 0.5, seed) else { panic!("{seed}: found") };
            assert_eq!(term.candidate, 0);
            // √(2/20) of a zero with the mean of its readings, 0.65, three times
            assert!((term.values[0] - 8.0).abs() < 0.62, "{term:?}");
        }
    }

    #[test]
    fn zeros_that_only_scatter_hide_nothing() {
        for seed in 0..20 {
            assert!(hidden_in(0.0, 5.0, seed).is_none(), "{seed}");
            assert!(hidden_in(0.0, 0.0, seed).is_none(), "{seed}");
        }
    }
}
