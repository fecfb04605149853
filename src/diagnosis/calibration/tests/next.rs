//! Poses that are proposed where a finding may be something else.

use super::*;
use crate::inference::Plan as NextPlan;

#[test]
fn one_clamp_more_tells_which_of_a_few_is_misplaced() {
    let mut campaign = clamps(25);
    // three clamps are hardly more than the base can follow
    let kept: Vec<usize> = (0..75).collect();
    campaign.measurements.rows.truncate(kept.len());
    campaign.measurements.joint_values.truncate(6 * kept.len());
    campaign.measurements.groups.truncate(3);
    let Targets::Points(points) = &mut campaign.measurements.targets else { panic!("measured points") };
    points.truncate(kept.len());
    let off = Vector3::new(200.0, 300.0, 100.0) * UM;
    let by = |row: usize| if campaign.measurements.rows[row].group == 2 { off } else { Vector3::zeros() };
    let campaign = recorded(&campaign, &by, 15.0 * UM, 3);
    let found = diagnose_as_recorded(&campaign, Mode::Fea, &Options::default()).unwrap();
    let first = &found.diagnosis.findings[0];
    assert_eq!(first.effect.name, "clamp_pose");
    assert!(first.others().iter().any(|(effect, _)| effect.name == "clamp_pose"));
    let next = first.next.as_ref().unwrap();
    assert!(next.description.contains("et up one more clamp where clamp "), "{}", next.description);
    assert!(next.log_odds > 3.0);
    assert!(next.separates_from.iter().any(|(effect, _)| effect.name == "clamp_pose"));
    let Some(NextPlan::Poses(plan)) = &next.plan else { panic!("no poses") };
    assert!(plan.new_fixture.is_some() && plan.poses.iter().any(|pose| pose.group == 3));
    // no farther than the robot turns
    let [low, high] = campaign.robot.joints[0].limits.unwrap();
    assert!(plan.poses.iter().all(|pose| (low..=high).contains(&pose.joints[0])));
}
