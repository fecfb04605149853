//! Single data far off that effects were taken for.
//!
//! A datum far off draws effects to itself: a step to it and a step back, a play of its line. Every
//! effect of a hypothesis is therefore compared with some data that are off by any amount each, in
//! its place: a column eᵢ of each such datum, whose size is as little known as an effect's. That
//! some datum of n is misread is as likely as that any effect is there,
//!
//! ```text
//! ln p(rest, data off) = ln p(r | rest, e₁ … eₖ) + ln prior(rest) + k·ln(library/none/n)
//! ```

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};

use crate::inference::noise::scatter::{MOST_ALONE, SUSPECT};
use crate::inference::score::priors::PRIOR;
use crate::inference::search::Search;
use crate::inference::{Evidence, Hypothesis};
use crate::statistics::median;

/// Most data that may stand for one effect.
const MOST: usize = 3;
/// Standard deviation of a datum, over the median size of what repeats are off their median: twice
/// that of a normal distribution, for medians of a few are near to their data.
const FAR: f64 = 3.0;
/// Size of such an error, in the hypothesis's noise: what is far off is usually so.
const USUAL: f64 = 10.0;

/// Fewer repeats do not show which one of them is off.
const FEWEST: usize = 3;

/// Single data far off the median of their repeats, as long as they are few and no two of a run are
/// neighbours: until something explains them they are misread. What every repeat shows stays.
pub fn unlike_repeats(evidence: &Evidence) -> BTreeSet<usize> {
    let mut repeats: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (datum, &group) in evidence.replicate_group.iter().enumerate().take(evidence.recorded) {
        repeats.entry(group).or_default().push(datum);
    }
    let mut deviations: Vec<(usize, f64)> = Vec::new();
    for data in repeats.into_values().filter(|data| data.len() >= FEWEST) {
        let values: Vec<f64> =
            data.iter().map(|&datum| evidence.residual[datum] / evidence.spread[datum]).collect();
        let Some(middle) = median(&values) else { continue };
        deviations.extend(data.iter().zip(values).map(|(&datum, value)| (datum, value - middle)));
    }
    let sizes: Vec<f64> = deviations.iter().map(|(_, deviation)| deviation.abs()).collect();
    let Some(usual) = median(&sizes) else { return BTreeSet::new() };
    let is_far = |deviation: f64| usual > 0.0 && deviation.abs() > FAR * SUSPECT * usual;
    let far: BTreeSet<usize> =
        deviations.into_iter().filter(|(_, deviation)| is_far(*deviation)).map(|(datum, _)| datum).collect();
    let mut last: BTreeMap<usize, usize> = BTreeMap::new();
    let mut are_neighbours = false;
    for (datum, group) in evidence.shared.iter().enumerate() {
        let before = last.insert(*group, datum);
        are_neighbours |= far.contains(&datum) && before.is_some_and(|before| far.contains(&before));
    }
    if far.len() > MOST_ALONE || are_neighbours { BTreeSet::new() } else { far }
}

impl Search<'_> {
    /// Data that, off each by itself, explain at least as much as an effect of a hypothesis does.
    pub fn misread(&self, hypothesis: &Hypothesis) -> BTreeSet<usize> {
        (0..hypothesis.terms.len()).flat_map(|position| self.instead(hypothesis, position)).collect()
    }

    /// Those that explain as much as the effect at `position`; none if it is worth more.
    fn instead(&self, hypothesis: &Hypothesis, position: usize) -> Vec<usize> {
        let rest = self.without(hypothesis, position);
        let linear = self.linear_part(&rest.terms);
        let count = self.evidence.recorded;
        let price = (PRIOR.1 / PRIOR.0 / count as f64).ln();
        let at_first = self.plain_residual(&rest);
        let mut left = self.standardised(&rest);
        let mut off: Vec<usize> = Vec::new();
        let mut columns: Vec<DVector<f64>> = Vec::new();
        for _ in 0..MOST {
            let others = (0..count).filter(|i| !off.contains(i));
            let Some(farthest) = others.max_by(|&a, &b| left[a].abs().total_cmp(&left[b].abs())) else {
                break;
            };
            // neighbours that are off to the same side have something in common
            let is_beside = |&other: &usize| {
                let (first, last) = (farthest.min(other), farthest.max(other));
                let run = self.evidence.shared[first];
                run == self.evidence.shared[last]
                    && self.evidence.shared[first + 1..last].iter().all(|between| *between != run)
                    && at_first[farthest] * at_first[other] > 0.0
            };
            if off.iter().any(is_beside) {
                break;
            }
            off.push(farthest);
            let mut column = DVector::zeros(self.evidence.residual.len());
            column[farthest] = USUAL * hypothesis.sigma * self.evidence.spread[farthest];
            columns.push(self.whitening.apply(&column));
            let (log_probability, rest_left) =
                self.with_columns(&rest, &linear, &DMatrix::from_columns(&columns));
            if log_probability + off.len() as f64 * price > hypothesis.log_probability {
                return off;
            }
            left = rest_left;
        }
        Vec::new()
    }
}
