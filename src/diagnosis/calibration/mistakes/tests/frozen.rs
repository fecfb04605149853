//! Joints whose readings stood still while the arm moved on.

use std::ops::Range;

use super::spots::visited_within;
use super::*;
use crate::calibration::campaign::{Distance, GroupName};

/// The campaign in whose file joints show in some rows what they showed in the row before.
fn stuck(campaign: &Campaign, joints: &[usize], rows: Range<usize>) -> Campaign {
    let mut wrong = campaign.clone();
    let last = campaign.measurements.joints(rows.start - 1).to_vec();
    for row in rows {
        joints.iter().for_each(|&joint| wrong.measurements.joint_values[6 * row + joint] = last[joint]);
    }
    wrong
}

#[test]
fn a_joint_that_stood_still_in_the_file_alone() {
    for (right, joint, rows) in
        [(tracked(60, 7), 4, 21..24), (tracked(60, 7), 1, 21..46), (tx90(), 3, 30..45)]
    {
        let wrong = stuck(&right, &[joint], rows.clone());
        let place = format!("q{}_deg, pose {} to pose {}", joint + 1, rows.start + 1, rows.end);
        assert_eq!(found(&wrong), one("stuck_sensor", &place));
        let mended = mended(&wrong);
        let shown = right.measurements.joints(rows.start - 1)[joint] / DEG;
        assert!((mended.found[0].estimates[0].value - shown).abs() < 1e-9);
        let there = format!("Leave out pose {} to pose {}, or measure anew", rows.start + 1, rows.end);
        assert_eq!(mended.found[0].description.observed, there);
        assert_eq!(mended.campaign.measurements.len(), 60 - rows.len());
        assert!(mended.suspicions[0].spoils_fit);
    }
}

#[test]
fn a_whole_arm_that_stood_still_in_the_file_alone() {
    let wrong = stuck(&tracked(60, 7), &[0, 1, 2, 3, 4, 5], 30..40);
    let names = "q1_deg, q2_deg, q3_deg, q4_deg, q5_deg, q6_deg";
    assert_eq!(found(&wrong), one("stuck_sensor", &format!("{names}, pose 31 to pose 40")));
}

/// A plan of poses may hold a joint still; and if its zero is another one there, that is what is
/// said.
#[test]
fn a_joint_that_was_meant_to_stand_still() {
    let (nominal, built) = (robot(0.0, 7), robot(1.0, 7));
    let mut random = Random::seeded(7, 2);
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let mut recording = Recording::new(6);
    for row in 0..80 {
        let mut q: Vec<f64> = (0..6).map(|_| random.uniform(-2.4, 2.4)).collect();
        if (30..50).contains(&row) {
            q[2] = 0.7;
        }
        let noise = Vector3::from_fn(|_, _| 30.0 * UM * random.normal());
        recording.add(&q, base.point(&built.flange_at(&q).point(&TOOL.into())) + noise).unwrap();
    }
    let held = Campaign::new(nominal, recording).unwrap().with_base(BASE.0, BASE.1).with_tool(TOOL.into());
    assert_eq!(found(&held), []);
    let mut off = held.clone();
    (30..50).for_each(|row| off.measurements.joint_values[6 * row + 2] += 20.0 * DEG);
    assert_eq!(found(&off), one("offset_mistake", "q3_deg, from pose 31 to pose 50"));
}

/// Of three placements with two sockets; all rows of the third socket are lost.
#[test]
fn a_joint_that_stood_still_in_sockets() {
    let middles = [[0.5, 0.3, 0.4], [-0.4, 0.5, 0.5], [0.2, -0.6, 0.3]].map(Vector3::from);
    let spots: Vec<Vector3<f64>> = middles.iter().flat_map(|own| [*own, own + Vector3::x() * 0.08]).collect();
    let mut right = visited_within(&spots, 12, 30.0 * UM);
    let recording = &mut right.measurements;
    let named = |k: usize| GroupName::socket(["front", "left", "back"][k / 2], (k % 2).to_string());
    recording.groups = (0..6).map(|k| Group::new(named(k), Pose::IDENTITY)).collect();
    recording.rows.iter_mut().enumerate().for_each(|(row, own)| own.group = row / 12);
    let distance = |k: usize| Distance::new([2 * k, 2 * k + 1], 0.08, 0.1 * MM);
    recording.targets = Targets::Sockets((0..3).map(distance).collect());
    let wrong = stuck(&right, &[3], 20..40);
    let mended = mended(&wrong);
    assert_eq!(found(&wrong), one("stuck_sensor", "q4_deg, pose 21 to pose 40"));
    let left = &mended.campaign.measurements;
    let names: Vec<String> = left.groups.iter().map(|group| group.name.to_string()).collect();
    assert_eq!(names, ["front/0", "front/1", "left/1", "back/0", "back/1"]);
    assert_eq!(left.groups[left.rows[39].group].name, recording_name(&right, 59));
    let Targets::Sockets(distances) = &left.targets else { panic!("sockets") };
    let between: Vec<[usize; 2]> = distances.iter().map(|own| own.between).collect();
    assert_eq!(between, [[0, 1], [3, 4]]);
}

fn recording_name(campaign: &Campaign, row: usize) -> GroupName {
    let recording = &campaign.measurements;
    recording.groups[recording.rows[row].group].name.clone()
}
