//! How well readings are predicted that were asked for and not given.

use std::fmt;

use nalgebra::Vector3;
use serde::Serialize;

use super::judged::Judged;
use crate::answers::Answer;
use crate::truth::{Kind, Truth};
use rodcal_base::spatial::best_motion;

/// Errors of the readings that were asked for, root mean squares, µm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Counterfactual {
    /// Of the answer.
    pub answer_um: f64,
    /// Of an oracle that had to find out the sizes of the effects only.
    pub oracle_um: f64,
    /// Standard deviation of a reading, µm.
    pub noise_um: f64,
}

/// Worst cases that are listed.
const MOST_WORST: usize = 10;

impl Counterfactual {
    /// Of a case with an oracle; `None` where nothing was predicted, or not each reading.
    pub fn new(truth: &Truth, answer: &Answer) -> Option<Self> {
        let asked = truth.asked.as_ref()?;
        let error = |said: &[f64]| -> Option<f64> {
            let is_whole = !said.is_empty() && said.len() == asked.true_um.len();
            let said = if asked.is_any_frame { moved_onto(said, &asked.true_um)? } else { said.to_vec() };
            let squares = said.iter().zip(&asked.true_um).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            is_whole.then(|| (squares / said.len() as f64).sqrt()).filter(|error| error.is_finite())
        };
        Some(Counterfactual {
            answer_um: error(answer.asked_um.as_ref()?)?,
            oracle_um: error(asked.oracle_um.as_ref()?)?,
            noise_um: truth.noise_um,
        })
    }

    /// Error of the answer over the oracle's.
    fn ratio(&self) -> Option<f64> {
        (self.oracle_um > 0.0).then(|| self.answer_um / self.oracle_um)
    }
}

/// Coordinates of points after the motion that brings them closest to others.
fn moved_onto(said: &[f64], goal: &[f64]) -> Option<Vec<f64>> {
    let [points, goal] = [said, goal]
        .map(|all| -> Vec<Vector3<f64>> { all.chunks_exact(3).map(Vector3::from_column_slice).collect() });
    let motion = best_motion(&points, &goal).ok()?;
    Some(points.iter().flat_map(|point| <[f64; 3]>::from(motion.point(point))).collect())
}

/// Errors of what was asked over the oracle's, of the identifiable cases with an oracle.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Predictions {
    /// Such cases.
    pub n: usize,
    /// Those that were answered.
    pub answered: usize,
    /// Of the ratios of errors; `None` of no case.
    pub median: Option<f64>,
    #[allow(missing_docs)]
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
pub fn predictions(cases: &[Judged<'_>]) -> Predictions {
    let is_asked = |case: &&Judged<'_>| {
        let has_oracle = case.truth.asked.as_ref().is_some_and(|asked| asked.oracle_um.is_some());
        let is_identifiable = case.truth.effects.iter().all(|e| e.detectability.is_identifiable());
        has_oracle && is_identifiable && matches!(case.truth.kind, Kind::Single | Kind::Pair)
    };
    let asked: Vec<&Judged<'_>> = cases.iter().filter(is_asked).collect();
    let mut predicted: Vec<(f64, Counterfactual, &Judged<'_>)> = asked
        .iter()
        .filter_map(|case| Some((case.counterfactual?.ratio()?, case.counterfactual?, *case)))
        .collect();
    predicted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sorted = |of: &dyn Fn(&Counterfactual) -> f64| -> Vec<f64> {
        let mut all: Vec<f64> = predicted.iter().map(|(_, errors, _)| of(errors)).collect();
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
    fn where_nobody_knows_the_frame_points_are_compared_after_a_motion() {
        let goal: Vec<f64> = [[0.0, 0.0, 0.0], [9e5, 1e5, 0.0], [-2e5, 6e5, 3e5], [1e5, 2e5, -8e5]].concat();
        // a quarter of a turn about z, and on
        let moved: Vec<f64> = goal.chunks(3).flat_map(|p| [3e4 - p[1], p[0] - 1e4, p[2] + 5e3]).collect();
        let back = moved_onto(&moved, &goal).unwrap();
        assert!(back.iter().zip(&goal).all(|(a, b)| (a - b).abs() < 1e-6), "{back:?}");
        // what is no motion stays an error
        let larger: Vec<f64> = moved.iter().map(|x| 1.001 * x).collect();
        let left = moved_onto(&larger, &goal).unwrap();
        assert!(left.iter().zip(&goal).any(|(a, b)| (a - b).abs() > 300.0), "{left:?}");
        assert_eq!(moved_onto(&[f64::NAN; 12], &goal), None);
    }

    #[test]
    fn quantiles_lie_between_their_neighbours() {
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(quantile(&[3.0], 0.25), Some(3.0));
        assert_eq!(quantile(&[1.0, 2.0, 4.0, 8.0], 0.5), Some(3.0));
    }
}
