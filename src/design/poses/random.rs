//! What the same number of random poses is worth, and how many of them would be worth as much.

use nalgebra::DMatrix;

use crate::optimal_design::{Criterion, Measurements, anything, value};
use crate::parallel::in_parallel;
use crate::statistics::{Random, median};

/// Random plans that are looked at, and those for each number of poses.
const PLANS: usize = 101;
const FEWER: usize = 15;
/// Of larger plans than this fewer will do: their values hardly scatter.
const LARGE: f64 = 2_000.0;
/// No more is looked for than so many times as many random poses.
const MOST: f64 = 20.0;
/// Halvings of the interval between two numbers of poses.
const HALVINGS: usize = 6;

/// Random poses beside the chosen ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// Median value of random plans of the same size, as the exchange has it.
    pub median: f64,
    /// So many times as many random poses are worth as much; `None` beyond 20.
    pub worth: Option<f64>,
}

/// Compares a choice of this `value` with random plans of the same quotas.
pub(super) fn beside(
    all: &Measurements,
    quotas: &[usize],
    before: &DMatrix<f64>,
    criterion: &Criterion,
    own: f64,
) -> Beside {
    let plans =
        in_parallel(PLANS, |plan| value(all, &anything(all, quotas, 1_000 + plan as u64), before, criterion));
    let median_of = |plans: Vec<Option<f64>>| {
        let values: Vec<f64> = plans.into_iter().map(|v| v.unwrap_or(f64::NEG_INFINITY)).collect();
        median(&values).unwrap_or(f64::NEG_INFINITY)
    };
    let typical = median_of(plans);
    let groups: Vec<Vec<usize>> = (0..quotas.len()).map(|group| all.of_group(group).collect()).collect();
    // so many random poses that the candidates do not last: some come twice
    let total: usize = quotas.iter().sum();
    let with = |times: f64| {
        let plans = if total as f64 * times > LARGE { FEWER / 5 } else { FEWER };
        median_of(in_parallel(plans, |plan| {
            let mut random = Random::seeded(7, plan as u64);
            let mut chosen = Vec::new();
            for (open, quota) in groups.iter().zip(quotas) {
                let count = (*quota as f64 * times).round() as usize;
                chosen.extend((0..count).map(|_| open[random.index(open.len())]));
            }
            value(all, &chosen, before, criterion)
        }))
    };
    let (mut low, mut high) = (1.0, 1.0);
    while high < MOST && with(high) < own {
        (low, high) = (high, (2.0 * high).min(MOST));
    }
    if with(high) < own {
        return Beside { median: typical, worth: None };
    }
    for _ in 0..HALVINGS {
        let middle = f64::sqrt(low * high);
        if with(middle) < own { low = middle } else { high = middle }
    }
    Beside { median: typical, worth: Some(f64::sqrt(low * high)) }
}
