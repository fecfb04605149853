//! What makes every claim about a calibration weaker.

use super::super::effects::JOINT_ANGLE;
use super::super::model::Context;
use crate::calibration::campaign::{Campaign, Group};
use crate::calibration::{Calibration, Noise};
use crate::diagnosis::Limitation;
use crate::inference::{Diagnosis, Evidence, Location};
use crate::statistics::median;

/// Rows per parameter below which they are few.
const FEW: f64 = 2.0;
/// Range of a joint, rad, below which little is seen of what depends on its angle.
const NARROW: f64 = 0.35;

/// Tip's motion by a usual error of a joint, in noises, below which the joint is not seen.
const UNSEEN: f64 = 0.1;
/// Distance from an axis, as a share of the arm's reach, beyond which a target is not on it,
/// whatever the noise.
const ON_AXIS: f64 = 0.02;

/// A clamp that scatters so many times as much as the others is worth a look.
const NOISY: f64 = 3.0;

pub fn limits(context: &Context, calibration: &Calibration, evidence: &Evidence) -> Vec<Limitation> {
    let mut limits = Vec::new();
    if !calibration.is_converged {
        limits.push(Limitation::NotConverged);
    }
    let (rows, parameters) =
        (context.configurations.len(), evidence.nuisance.ncols() + evidence.background.ncols());
    if (rows as f64) < FEW * parameters as f64 {
        limits.push(Limitation::FewPoses(rows, parameters));
    }
    limits.extend(context.revolute().into_iter().filter_map(|j| {
        let (low, high) = context.range(j);
        (high - low < NARROW).then_some(Limitation::NarrowJoint(j, high - low))
    }));
    let levers = (0..context.joint_count()).map(|j| context.largest(|there| there.tip_jacobian[j].norm()));
    let seen = calibration.noise.pooled / JOINT_ANGLE;
    // where the fit fails, everything drowns in what is left
    let is_judged = calibration.is_plausible();
    let beside = (UNSEEN * seen).min(ON_AXIS * calibration.reach);
    for (j, lever) in levers.enumerate().filter(|(_, lever)| is_judged && *lever < beside) {
        limits.push(Limitation::OnAxis(j, lever));
    }
    let folds = evidence.fold.iter().filter(|fold| **fold != Evidence::NONE).max();
    if folds.is_none_or(|last| *last == 0) {
        limits.push(Limitation::NoFoldsOfPoses);
    }
    limits
}

/// Poses that may have been misread, where no finding is about them.
pub fn far_out(context: &Context, diagnosis: &Diagnosis, rows: &[usize]) -> Option<Limitation> {
    let parts = || diagnosis.findings.iter().flat_map(|finding| &finding.parts);
    let is_named = |row: &usize| {
        parts().any(|part| matches!(part.location, Location::Pose { row: own, .. } if own == *row))
    };
    let poses: Vec<String> =
        rows.iter().filter(|row| !is_named(row)).map(|row| context.pose_name(*row)).collect();
    (!poses.is_empty()).then_some(Limitation::FarOut(poses))
}

/// Clamps that scatter so many times as much as the others do in the middle.
pub fn noisy(campaign: &Campaign, noise: &Noise) -> Vec<Limitation> {
    let groups = &campaign.measurements.groups;
    let of_group = |(k, group): (usize, &Group)| {
        let others: Vec<f64> =
            (0..groups.len()).filter(|&other| other != k).map(|k| noise.of_group[k]).collect();
        let usual = median(&others)?;
        let own = noise.of_group[k];
        (own > NOISY * usual).then(|| Limitation::NoisyGroup(group.name.to_string(), own, usual))
    };
    groups.iter().enumerate().filter_map(of_group).collect()
}
