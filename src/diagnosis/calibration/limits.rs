//! What makes every claim about a calibration weaker.

use super::context::Context;
use super::effects::JOINT_ANGLE;
use crate::calibration::Calibration;
use crate::inference::{Evidence, Limit};

/// Rows per parameter below which they are few.
const FEW: f64 = 2.0;
/// Range of a joint, rad, below which little is seen of what depends on its angle.
const NARROW: f64 = 0.35;

/// Tip's motion by a usual error of a joint, in noises, below which the joint is not seen.
const UNSEEN: f64 = 0.1;

pub(super) fn limits(context: &Context, calibration: &Calibration, evidence: &Evidence) -> Vec<Limit> {
    let mut limits = Vec::new();
    if !calibration.is_converged {
        limits.push(Limit::NotConverged);
    }
    let (rows, parameters) =
        (context.configurations.len(), evidence.nuisance.ncols() + evidence.background.ncols());
    if (rows as f64) < FEW * parameters as f64 {
        limits.push(Limit::FewPoses(rows, parameters));
    }
    limits.extend(context.revolute().into_iter().filter_map(|j| {
        let (low, high) = context.range(j);
        (high - low < NARROW).then_some(Limit::NarrowJoint(j, high - low))
    }));
    let levers = (0..context.joint_count()).map(|j| context.largest(|there| there.tip_jacobian[j].norm()));
    let seen = calibration.noise.pooled / JOINT_ANGLE;
    for (j, lever) in levers.enumerate().filter(|(_, lever)| *lever < UNSEEN * seen) {
        limits.push(Limit::OnAxis(j, lever));
    }
    let folds = evidence.fold.iter().filter(|fold| **fold != Evidence::NONE).max();
    if folds.is_none_or(|last| *last == 0) {
        limits.push(Limit::NoFoldsOfPoses);
    }
    limits
}
