//! What the calibration leaves of each joint, over the joint's own angle.

use nalgebra::Vector3;

use crate::calibration::Campaign;
use crate::diagnosis::calibration::{CalibrationDiagnosis, Curve, Gear, Limit, Mismatch};
use crate::report::chart::Figure;
use crate::report::pictures::diagnosis::{AngleError, angle_errors};
use crate::robot::Motion;
use crate::units::URAD;

/// Points of a curve for each of its cycles, and at least and at most.
const PER_CYCLE: f64 = 12.0;
const POINTS: (f64, f64) = (120.0, 1500.0);
/// Part of a joint's longest lever below which a pose shows too little of its angle.
const LEVER: f64 = 0.25;

/// The joint whose gear a mismatch is about.
pub fn gear_of(found: &CalibrationDiagnosis, mismatch: &Mismatch) -> Option<usize> {
    let candidate = found.diagnosis.findings[mismatch.parts[0]].chosen.candidate;
    found.world.gear(candidate).map(Gear::joint)
}

/// Every joint that turns, with the curve that was found of it. A joint whose axis the target lies on has no lever to be seen
/// by.
pub fn errors(campaign: &Campaign, found: &CalibrationDiagnosis) -> Vec<Figure> {
    let is_unseen = |joint: usize| {
        found.limits.iter().any(|limit| matches!(limit, Limit::OnAxis(unseen, _) if *unseen == joint + 1))
    };
    let [before, after] = [&found.diagnosis.before, &found.diagnosis.after].map(|data| found.by_row(data));
    let joints: Vec<AngleError> = (0..campaign.robot.joints.len())
        .filter(|&joint| campaign.robot.joints[joint].motion == Motion::Revolute && !is_unseen(joint))
        .map(|joint| error(campaign, found, joint, [&before, &after]))
        .collect();
    let has_curve = joints.iter().any(|joint| !joint.curve.is_empty());
    let figures = angle_errors(&joints).into_iter();
    figures.map(|figure| figure.captioned(caption(!found.mismatches.is_empty(), has_curve))).collect()
}

fn caption(has_findings: bool, has_curve: bool) -> String {
    let mut words = "How far joints are from where they say they are, over their own angles: what the calibration leaves of a \
                     pose along the way that the joint moves the tip, over the joint's lever"
        .to_owned();
    words += if has_findings { "; before, and after with what was found." } else { "." };
    if has_curve {
        words += " Where a curve was found, all else that was found is taken out beforehand.";
    }
    words
}

/// One joint, from what is left of the rows before and after, m.
fn error(
    campaign: &Campaign,
    found: &CalibrationDiagnosis,
    joint: usize,
    [before, after]: [&[Vector3<f64>]; 2],
) -> AngleError {
    let recording = &campaign.measurements;
    let angles: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[joint]).collect();
    let curve = found.gear(campaign, joint);
    let longest = found.levers.iter().map(|levers| levers[joint].norm()).fold(0.0, f64::max);
    let poses = (0..recording.len()).filter_map(|row| {
        let lever = found.levers[row][joint];
        let turned = |residual: &Vector3<f64>| lever.dot(residual) / lever.norm_squared();
        let left = turned(&after[row]);
        let shown = match &curve {
            Some(curve) => left + curve.at(angles[row]),
            None => turned(&before[row]),
        };
        (lever.norm() > LEVER * longest).then_some([angles[row].to_degrees(), shown / URAD, left / URAD])
    });
    let of_gear = found.mismatches.iter().find(|mismatch| gear_of(found, mismatch) == Some(joint));
    let reach = of_gear.map_or(0.0, |mismatch| found.diagnosis.findings[mismatch.parts[0]].reach);
    let drawn = |curve: &Curve| {
        let at = |q: f64| [q.to_degrees(), curve.at(q) / URAD, reach * curve.sd(q) / URAD];
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
        with_diagnosed(&|_| Vector3::zeros(), |campaign, found| {
            let panels: usize = errors(campaign, found).iter().map(|figure| figure.panels.len()).sum();
            assert_eq!((found.mismatches.len(), panels), (0, 6));
        });
        // the last of a recording was misread
        let off = |row: usize| Vector3::new(if row == 40 { 2e-3 } else { 0.0 }, 0.0, 0.0);
        with_diagnosed(&off, |campaign, found| {
            let figures = errors(campaign, found);
            let titles: Vec<&str> =
                figures.iter().flat_map(|figure| &figure.panels).map(|panel| panel.title.as_str()).collect();
            assert_eq!(titles.len(), 12);
            assert_eq!(titles[10..], ["joint 6: before", "joint 6: after"]);
        });
    }
}
