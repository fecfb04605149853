//! A step between groups of data that share an error, which looks like the scatter of these errors.
//!
//! Zeros that are read run by run scatter; a knock between two runs shifts all that follow. As long as the ratio ρ of that scatter
//! is found with the knock in it, no step is worth a name: it is what zeros do. With the step s taken out, ρ is another one,
//! and the Gaussian likelihoods of what is left can be compared,
//!
//! ```text
//! ln p = −½·ν·ln(|W·r|²/ν) − ½·Σ ln(1 + ρ·|a|²)      over the groups, W and a as in `whitening.rs`
//! ```

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::linearised::Linearised;
use super::whitening::Whitening;
use super::{Evidence, ForwardModel, Term};

/// Ln of the odds at which ρ is found without a step: a thousand, and a hundred places.
const HIDDEN: f64 = 11.5;
/// Groups on either side of a step, at least: one zero that is far out is a zero.
const GROUPS: usize = 2;

/// The step that is most probably hidden in what is `left`; `None` where none is.
pub(super) fn hidden_step(model: &Linearised<'_>, evidence: &Evidence, left: &DVector<f64>) -> Option<Term> {
    let log_density = |left: &DVector<f64>| {
        let whitening = Whitening::new(evidence, left);
        let degrees_of_freedom = whitening.degrees_of_freedom.max(1) as f64;
        let square = whitening.apply(left).norm_squared().max(f64::MIN_POSITIVE);
        -0.5 * degrees_of_freedom * (square / degrees_of_freedom).ln() + whitening.log_determinant()
    };
    let candidates = model.candidates();
    let stepped = (0..candidates.len()).filter_map(|candidate| {
        let step = model.step(candidate)?;
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
        let log_odds = log_density(&less(level_before, level_after)) - log_density(&less(level, level));
        Some((log_odds, candidate, level_after - level_before))
    });
    let (log_odds, candidate, by) =
        stepped.reduce(|best, other| if other.0 > best.0 { other } else { best })?;
    let neutral = candidates[candidate].neutral(candidate);
    let values = neutral.values.iter().map(|value| value + by).collect();
    (log_odds > HIDDEN).then_some(Term { values, ..neutral })
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
