//! What makes every claim about a calibration weaker.

use std::fmt;

use super::library::JOINT_ANGLE;
use super::scene::Scene;
use crate::calibration::Calibration;
use crate::diagnosis::Evidence;
use crate::units::MM;

/// Rows per parameter below which they are few.
const FEW: f64 = 2.0;
/// Range of a joint, rad, below which little is seen of what depends on its angle.
const NARROW: f64 = 0.35;

/// Tip's motion by a usual error of a joint, in noises, below which the joint is not seen.
const UNSEEN: f64 = 0.1;

/// What makes every claim weaker.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Limit {
    /// The calibration did not come to rest.
    NotConverged,
    /// So many rows for so many parameters.
    FewRows(usize, usize),
    /// A joint, from 1, that moved over so small a range, rad.
    NarrowJoint(usize, f64),
    /// A joint, from 1, whose axis the target lies on: so far beside it at most, m.
    OnAxis(usize, f64),
    /// The rows are too few to hold any out.
    NoFolds,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Limit::NotConverged => f.write_str(
                "The calibration did not come to rest: what it leaves is no measure of the robot. Look at `calibrate` first.",
            ),
            Limit::FewRows(rows, parameters) => write!(
                f,
                "Only {rows} poses for {parameters} calibrated parameters: these take up most of what else is wrong, and small \
                 effects stay unseen.",
            ),
            Limit::NarrowJoint(joint, range) => write!(
                f,
                "Joint {joint} moved over {:.0}° only: what depends on its angle stays unseen.",
                range.to_degrees()
            ),
            Limit::OnAxis(joint, lever) => write!(
                f,
                "Joint {joint} cannot be seen: the target lies on its axis (at most {:.2} mm beside it). Offset the tool.",
                lever / MM
            ),
            Limit::NoFolds => f.write_str("The poses are too few to hold any out: nothing is proved by prediction."),
        }
    }
}

pub(super) fn limits(scene: &Scene, calibration: &Calibration, evidence: &Evidence) -> Vec<Limit> {
    let mut limits = Vec::new();
    if !calibration.is_converged {
        limits.push(Limit::NotConverged);
    }
    let (rows, parameters) = (scene.postures.len(), evidence.nuisance.ncols());
    if (rows as f64) < FEW * parameters as f64 {
        limits.push(Limit::FewRows(rows, parameters));
    }
    limits.extend(scene.revolute().into_iter().filter_map(|j| {
        let (low, high) = scene.range(j);
        (high - low < NARROW).then_some(Limit::NarrowJoint(j + 1, high - low))
    }));
    let reach = (0..scene.joint_count()).map(|j| scene.largest(|posture| posture.lever[j].norm()));
    let seen = calibration.noise.pooled / JOINT_ANGLE;
    for (j, lever) in reach.enumerate().filter(|(_, lever)| *lever < UNSEEN * seen) {
        limits.push(Limit::OnAxis(j + 1, lever));
    }
    let folds = evidence.fold.iter().filter(|fold| **fold != Evidence::KEPT).max();
    if folds.is_none_or(|last| *last == 0) {
        limits.push(Limit::NoFolds);
    }
    limits
}
