//! How well readings are predicted that were asked for and not given.

use nalgebra::Vector3;
use serde::Serialize;

use crate::answers::Answer;
use crate::ground_truth::GroundTruth;
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

impl Counterfactual {
    /// Of a case with an oracle; `None` where nothing was predicted, or not each reading.
    pub fn new(truth: &GroundTruth, answer: &Answer) -> Option<Self> {
        let query = truth.query.as_ref()?;
        let error = |predicted: &[f64]| -> Option<f64> {
            let is_whole = !predicted.is_empty() && predicted.len() == query.true_um.len();
            let predicted =
                if query.is_any_frame { moved_onto(predicted, &query.true_um)? } else { predicted.to_vec() };
            let squares = predicted.iter().zip(&query.true_um).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            is_whole.then(|| (squares / predicted.len() as f64).sqrt()).filter(|error| error.is_finite())
        };
        Some(Counterfactual {
            answer_um: error(answer.predicted_um.as_ref()?)?,
            oracle_um: error(query.oracle_um.as_ref()?)?,
            noise_um: truth.noise_um,
        })
    }

    /// Error of the answer over the oracle's.
    pub fn ratio(&self) -> Option<f64> {
        (self.oracle_um > 0.0).then(|| self.answer_um / self.oracle_um)
    }
}

/// Coordinates of points after the motion that brings them closest to others.
fn moved_onto(predicted: &[f64], goal: &[f64]) -> Option<Vec<f64>> {
    let [points, goal] = [predicted, goal]
        .map(|all| -> Vec<Vector3<f64>> { all.chunks_exact(3).map(Vector3::from_column_slice).collect() });
    let motion = best_motion(&points, &goal).ok()?;
    Some(points.iter().flat_map(|point| <[f64; 3]>::from(motion.point(point))).collect())
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
}
