//! What happened between poses that were recorded in the order of an angle.

use super::*;
use crate::diagnosis::calibration::in_order::{Progress, recorded_along};
use crate::inference::{Covariate, Finding, JointVariable, Plan, Variable};

const ANGLE: JointVariable = JointVariable::Angle;

/// A recording of 100 poses by a tracker, whose first joint turns by so much more from half of the
/// poses on; in the order of its angles, or in that in which they were chosen.
fn slipped(is_sorted: bool) -> Finding {
    let mut campaign = tracked(100, &|_, tip| *tip);
    let own = &mut campaign.measurements;
    if is_sorted {
        let mut order: Vec<usize> = (0..own.len()).collect();
        order.sort_by(|a, b| own.joints(*a)[0].total_cmp(&own.joints(*b)[0]));
        *own = own.subset(&order);
    }
    let (half, count) = (own.len() / 2, own.joint_count);
    own.joint_values.chunks_exact_mut(count).skip(half).for_each(|q| q[0] += 600e-6);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    let [finding] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    finding.clone()
}

#[test]
fn a_slip_in_poses_sorted_by_an_angle_may_as_well_follow_the_angle() {
    let sorted = slipped(true);
    assert_eq!(sorted.effect.name, "joint_shift");
    let said = sorted.other_causes();
    let expected =
        "another cause that follows the angle of joint 1, in the order of which the poses were recorded";
    assert_eq!(said, [expected]);
    // first poses, measured again after the last one, distinguish the two
    let next = sorted.next.expect("a measurement");
    let Some(Plan::Poses(plan)) = &next.plan else { panic!("{next:?}") };
    let last = sorted.location.moved_after().unwrap();
    assert!(plan.poses.len() > 4 && plan.poses.iter().all(|pose| pose.like <= last), "{plan:?}");
    assert!(next.description.ends_with("once more, after the last one."), "{}", next.description);
    let unsorted = slipped(false);
    assert_eq!(unsorted.effect.name, "joint_shift");
    assert!(unsorted.unnamed.is_none(), "{:?}", unsorted.unnamed);
}

#[test]
fn the_order_is_that_of_the_angle_by_which_earlier_poses_differ_from_later_ones() {
    let rows: usize = 24;
    let each = |value: &dyn Fn(usize) -> f64| (0..3 * rows).map(|datum| value(datum / 3)).collect::<Vec<_>>();
    let mut evidence = Evidence::new(DVector::zeros(3 * rows));
    let alternating = |row: usize| (row % 2) as f64;
    // two blocks, within each of which it goes to and fro; and a height that falls all the time
    let in_blocks = |row: usize| (row / 12) as f64 + 0.1 * alternating(row);
    let falling = |row: usize| -(row as f64);
    evidence.covariates = vec![
        Covariate { variable: Variable::Joint(0, ANGLE), values: each(&alternating) },
        Covariate { variable: Variable::Joint(1, ANGLE), values: each(&in_blocks) },
        Covariate { variable: Variable::Joint(2, JointVariable::Torque), values: each(&falling) },
    ];
    let step = |from: usize| (0..rows).map(|row| f64::from(row >= from)).collect::<Vec<f64>>();
    let order: Vec<f64> = (0..rows).map(|row| row as f64).collect();
    let along = |at: &[f64]| recorded_along(&evidence, &Progress::of_all(at.to_vec()));
    assert_eq!(along(&step(12)), Some(Variable::Joint(1, ANGLE)));
    // within a block, by three poses alone, and evenly in time, nothing is in order
    for at in [&step(6), &step(21), &order] {
        assert_eq!(along(at), None);
    }
    let height = Variable::Tip(crate::spatial::Axis::Z);
    evidence.covariates.push(Covariate { variable: height, values: each(&falling) });
    assert_eq!(recorded_along(&evidence, &Progress::of_all(order.clone())), Some(height));
    // at one clamp the tip stays where it is
    let second: Vec<bool> = (0..rows).map(|row| row >= 12).collect();
    let moved = |concerns: Vec<bool>| Progress { at: step(18), concerns };
    assert_eq!(recorded_along(&evidence, &moved(second.clone())), None);
    // angles that other clamps were visited at too, where nothing moved, are no cause
    let [to_and_fro, beyond] = [1, 2].map(|clamps| move |row: usize| (row % (12 * clamps)) as f64);
    for (values, expected) in [(each(&to_and_fro), None), (each(&beyond), Some(Variable::Joint(0, ANGLE)))] {
        evidence.covariates[0].values = values;
        assert_eq!(recorded_along(&evidence, &moved(second.clone())), expected);
    }
}

/// What drifts with the order does so whatever a thermometer showed meanwhile.
#[test]
fn a_drift_in_poses_sorted_by_an_angle_may_as_well_follow_the_angle() {
    let mut campaign = tracked(100, &|_, tip| *tip);
    let own = &mut campaign.measurements;
    let mut order: Vec<usize> = (0..own.len()).collect();
    order.sort_by(|a, b| own.joints(*a)[1].total_cmp(&own.joints(*b)[1]));
    *own = own.subset(&order);
    for (k, row) in own.rows.iter_mut().enumerate() {
        row.temperature = Some(22.0 + (0.3 * k as f64).sin());
    }
    let Targets::Points(points) = &mut own.targets else { panic!("no points") };
    points.iter_mut().enumerate().for_each(|(row, point)| point.x += 6.0 * UM * row as f64);
    let found = diagnose_as_recorded(&campaign, Mode::None, &Options::default()).unwrap();
    let [drift] = &found.diagnosis.findings[..] else { panic!("{:?}", found.diagnosis.findings) };
    let along = drift.unnamed.as_ref().map(|rival| rival.location.to_string());
    assert_eq!((drift.effect.name, along.as_deref()), ("thermal_drift", Some("joint 2 angle")));
}
