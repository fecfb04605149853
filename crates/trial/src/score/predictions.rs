//! How well the readings that were asked for are predicted, over all cases.

use std::fmt;

use serde::Serialize;

use super::counterfactual::Counterfactual;
use super::scored_case::ScoredCase;
use crate::ground_truth::Kind;

/// Worst cases that are listed.
const MOST_WORST: usize = 10;

/// Errors of what was asked over the oracle's, of the identifiable cases with an oracle.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Predictions {
    /// Such cases.
    pub n: usize,
    /// Those that were answered.
    pub answered: usize,
    /// Median of the ratios of errors; `None` of no case.
    pub median: Option<f64>,
    /// Lower and upper quartile of the same.
    pub quartiles: [Option<f64>; 2],
    /// Median of the answers' errors over the noise.
    pub answer_over_noise_median: Option<f64>,
    /// And of the oracle's.
    pub oracle_over_noise_median: Option<f64>,
    /// The largest ratios.
    pub worst: Vec<Worst>,
}

/// A case whose answer is far from the oracle's.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worst {
    /// `rig/case-0001`.
    pub case: String,
    /// Error of the answer over the oracle's.
    pub ratio: f64,
    /// Root mean squares.
    #[serde(flatten)]
    pub errors: Counterfactual,
}

/// How well identifiable cases with an oracle are predicted.
pub fn predictions(cases: &[ScoredCase<'_>]) -> Predictions {
    let is_asked = |case: &&ScoredCase<'_>| {
        let has_oracle = case.truth.query.as_ref().is_some_and(|asked| asked.oracle_um.is_some());
        let is_identifiable = case.truth.effects.iter().all(|e| e.detectability.is_identifiable());
        has_oracle && is_identifiable && matches!(case.truth.kind, Kind::Single | Kind::Pair)
    };
    let asked: Vec<&ScoredCase<'_>> = cases.iter().filter(is_asked).collect();
    let mut predicted: Vec<(f64, Counterfactual, &ScoredCase<'_>)> = asked
        .iter()
        .filter_map(|case| Some((case.counterfactual?.ratio()?, case.counterfactual?, *case)))
        .collect();
    predicted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sorted = |ratio: &dyn Fn(&Counterfactual) -> f64| -> Vec<f64> {
        let mut all: Vec<f64> = predicted.iter().map(|(_, errors, _)| ratio(errors)).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let ratios: Vec<f64> = predicted.iter().map(|(ratio, ..)| *ratio).collect();
    let worst = predicted.iter().rev().take(MOST_WORST);
    Predictions {
        n: asked.len(),
        answered: predicted.len(),
        median: quantile(&ratios, 0.5),
        quartiles: [0.25, 0.75].map(|share| quantile(&ratios, share)),
        answer_over_noise_median: quantile(&sorted(&|e| e.answer_um / e.noise_um), 0.5),
        oracle_over_noise_median: quantile(&sorted(&|e| e.oracle_um / e.noise_um), 0.5),
        worst: worst
            .map(|(ratio, errors, case)| Worst {
                case: case.truth.case.clone(),
                ratio: *ratio,
                errors: *errors,
            })
            .collect(),
    }
}

/// `1.31 (median of 40 of 41 cases; half of them 1.02 to 2.50)`.
impl fmt::Display for Predictions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Some(median), [Some(low), Some(high)]) = (self.median, self.quartiles) else {
            return f.write_str("no case");
        };
        let (answered, n) = (self.answered, self.n);
        write!(f, "{median:.2} (median of {answered} of {n} cases; half of them {low:.2} to {high:.2})")
    }
}

/// Of sorted numbers, between neighbours by a straight line.
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let at = share * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted.get(at.floor() as usize)?, sorted.get(at.ceil() as usize)?);
    Some(low + (high - low) * at.fract())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[3.0], 0.25), Some(3.0));
        assert_eq!(quantile(&[1.0, 2.0, 4.0, 8.0], 0.5), Some(3.0));
    }
}
