//! What the calibration leaves of each joint, over the joint's own angle.

use nalgebra::Vector3;

use crate::diagnosis::Limitation;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Curve, GearError};
use crate::report::chart::Figure;
use crate::report::pictures::diagnosis::{AngleError, angle_errors};
use crate::robot::Motion;
use crate::units::URAD;

/// Points of a curve for each of its cycles, and at least and at most.
const PER_CYCLE: f64 = 12.0;
const POINTS: (f64, f64) = (120.0, 1500.0);
/// Part of a joint's longest lever below which a pose shows too little of its angle.
const LEVER: f64 = 0.25;

/// Every joint that turns, with the curve that was found of it. A joint whose axis the target lies
/// on has no lever to be seen by.
pub fn errors(found: &CalibrationDiagnosis) -> Vec<Figure> {
    let is_unseen = |joint: usize| {
        found.limits.iter().any(|limit| matches!(limit, Limitation::OnAxis(unseen, _) if *unseen == joint))
    };
    let [before, after] =
        [&found.diagnosis.before, &found.diagnosis.after].map(|data| found.model.by_row(data));
    let joints: Vec<AngleError> = (0..found.model.campaign.robot.joints.len())
        .filter(|&joint| {
            found.model.campaign.robot.joints[joint].motion == Motion::Revolute && !is_unseen(joint)
        })
        .map(|joint| error(found, joint, [&before, &after]))
        .collect();
    let has_curve = joints.iter().any(|joint| !joint.curve.is_empty());
    let figures = angle_errors(&joints).into_iter();
    figures.map(|figure| figure.captioned(caption(!found.diagnosis.findings.is_empty(), has_curve))).collect()
}

fn caption(has_findings: bool, has_curve: bool) -> String {
    let mut words = "Angle errors of joints over their own angles: the pose residual projected on the \
                     joint's motion, divided by its lever arm"
        .to_owned();
    words += if has_findings { "; before, and after with the findings." } else { "." };
    if has_curve {
        words += " Where a curve was found, the other findings are removed first.";
    }
    words
}

/// One joint, from what is left of the rows before and after, m.
fn error(found: &CalibrationDiagnosis, joint: usize, [before, after]: [&[Vector3<f64>]; 2]) -> AngleError {
    let angles = found.model.angles(joint);
    let curve = found.gear(joint);
    let longest =
        found.model.tip_jacobians.iter().map(|jacobians| jacobians[joint].norm()).fold(0.0, f64::max);
    let poses = (0..angles.len()).filter_map(|row| {
        let jacobian = found.model.tip_jacobians[row][joint];
        let turned = |residual: &Vector3<f64>| jacobian.dot(residual) / jacobian.norm_squared();
        let left = turned(&after[row]);
        let shown = match &curve {
            Some(curve) => left + curve.at(angles[row]),
            None => turned(&before[row]),
        };
        (jacobian.norm() > LEVER * longest).then_some([angles[row].to_degrees(), shown / URAD, left / URAD])
    });
    let of_gear = found
        .diagnosis
        .findings
        .iter()
        .find(|finding| GearError::of(finding).is_some_and(|gear| gear.joint == joint));
    let factor = of_gear.map_or(0.0, |finding| finding.parts[0].coverage_factor);
    let drawn = |curve: &Curve| {
        let at = |q: f64| [q.to_degrees(), curve.at(q) / URAD, factor * curve.sd(q) / URAD];
        sampled(curve, &angles).map(at).collect()
    };
    AngleError {
        joint: format!("joint {}", joint + 1),
        poses: poses.collect(),
        curve: curve.as_ref().map(drawn).unwrap_or_default(),
    }
}

/// Angles over the recorded range, as finely as the curve needs, rad.
fn sampled(curve: &Curve, angles: &[f64]) -> impl Iterator<Item = f64> + use<> {
    let low = angles.iter().copied().fold(f64::INFINITY, f64::min);
    let high = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let cycles = curve.highest() * (high - low) / std::f64::consts::TAU;
    let count = (PER_CYCLE * cycles).clamp(POINTS.0, POINTS.1).round();
    (0..=count as usize).map(move |k| low + (high - low) * k as f64 / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::diagnosis::calibration::figures::tests::with_diagnosed;

    #[test]
    fn every_joint_that_can_be_seen_has_its_panels() {
        with_diagnosed(&|_| Vector3::zeros(), |_, found| {
            let panels: usize = errors(found).iter().map(|figure| figure.panels.len()).sum();
            assert_eq!((found.diagnosis.findings.len(), panels), (0, 6));
        });
        // the last of a recording was misread
        let off = |row: usize| Vector3::new(if row == 40 { 2e-3 } else { 0.0 }, 0.0, 0.0);
        with_diagnosed(&off, |_, found| {
            let figures = errors(found);
            let titles: Vec<&str> =
                figures.iter().flat_map(|figure| &figure.panels).map(|panel| panel.title.as_str()).collect();
            assert_eq!(titles.len(), 12);
            assert_eq!(titles[10..], ["joint 6: before", "joint 6: after"]);
        });
    }
}
