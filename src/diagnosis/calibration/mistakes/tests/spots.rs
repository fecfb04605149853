//! Clamps that are visited one after another, by an arm with an offset wrist.

use nalgebra::{Matrix3, Matrix3x6, Vector6};

use super::*;
use crate::calibration::campaign::GroupName;
use crate::robot::Body;
use crate::units::STANDARD_GRAVITY;

const SPOTS: [[f64; 3]; 3] = [[0.5, 0.3, 0.4], [-0.4, 0.5, 0.5], [0.2, -0.6, 0.3]];

/// Spots are visited one after another, and either end of the recording has seen a single one.
#[test]
fn radians_in_the_middle_of_spots_that_are_visited_one_by_one() {
    let right = visited(&SPOTS.map(Vector3::from), 16);
    let wrong = parts::in_rows(&right, 13..36, |q| q.iter_mut().for_each(|q| *q *= DEG));
    let (effect, cure, _) = parts::only(&wrong);
    assert_eq!(effect, "unit_mistake");
    assert_eq!(cure, "Multiply q1_deg … q6_deg by 180/π from pose 14 to pose 36");
}

/// Of three clamps one that stands beside its place looks like gravity along another axis.
#[test]
fn one_of_three_clamps_that_stands_aside_is_no_other_gravity() {
    for (clamp, aside) in [(0, [-0.4, -1.1, -1.8]), (2, [0.3, -0.4, -3.8]), (0, [1.2, 0.0, 0.3])] {
        let mut wrong = heavy_in_clamps(24);
        let rows = 24 * clamp..24 * (clamp + 1);
        points(&mut wrong)[rows].iter_mut().for_each(|point| *point += Vector3::from(aside) * MM);
        assert_eq!(found(&wrong), [], "clamp {clamp}, {aside:?} mm");
    }
}

/// So does one that was knocked on the way: its place before and after is no mistake of a file.
#[test]
fn one_of_three_clamps_that_was_knocked_is_no_other_gravity() {
    for (clamp, after, aside) in [(2, 5, [3.1, 1.5, 2.8]), (0, 8, [-0.4, -1.1, -1.8])] {
        let mut wrong = heavy_in_clamps(24);
        let rows = 24 * clamp + after..24 * (clamp + 1);
        points(&mut wrong)[rows].iter_mut().for_each(|point| *point += Vector3::from(aside) * MM);
        let found = found(&wrong);
        assert!(found.iter().all(|(_, place)| place != "gravity_m_s2"), "clamp {clamp}: {found:?}");
    }
}

/// An arm with masses in three clamps, with so many poses in each.
fn heavy_in_clamps(each: usize) -> Campaign {
    let masses = [8.0, 14.0, 5.0, 1.7, 1.9, 0.4];
    let centres = [
        [0.0, -0.02, 0.02],
        [0.22, 0.0, 0.15],
        [0.18, 0.0, 0.05],
        [0.0, 0.0, 0.02],
        [0.0, 0.01, 0.02],
        [0.0, 0.0, -0.03],
    ];
    let spots = SPOTS.map(Vector3::from);
    let mut campaign = visited(&spots, each);
    for (joint, (mass, centre)) in campaign.robot.joints.iter_mut().zip(masses.into_iter().zip(centres)) {
        joint.body = Some(Body { mass, centre: Vector3::from(centre) });
    }
    campaign.robot.gravity = -STANDARD_GRAVITY * Vector3::z();
    campaign.robot_file = "arm.toml".into();
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let clamp = |(id, spot): (&str, &Vector3<f64>)| {
        let device = Pose { rotation: Matrix3::identity(), origin: base.point(spot) };
        Group::new(GroupName::Clamp(id.into()), device)
    };
    let recording = &mut campaign.measurements;
    recording.groups = ["1", "2", "3"].into_iter().zip(&spots).map(clamp).collect();
    recording.rows.iter_mut().enumerate().for_each(|(row, own)| own.group = row / each);
    campaign
}

/// Poses whose tip is within a millimetre of some spots of {0}, so many at each.
fn visited(spots: &[Vector3<f64>], each: usize) -> Campaign {
    visited_within(spots, each, 0.5 * MM)
}

/// The same; tips scatter about their spots by so much, m.
pub(super) fn visited_within(spots: &[Vector3<f64>], each: usize, scatter: f64) -> Campaign {
    let built = robot(1.0, 7);
    let mut random = Random::seeded(7, 3);
    let base = Pose::from_xyz_rpy(BASE.0, BASE.1);
    let mut recording = Recording::new(6);
    for spot in spots {
        let mut found = 0;
        while found < each {
            let there = spot + Vector3::from_fn(|_, _| scatter * random.normal());
            let start = Vector6::from_fn(|_, _| random.uniform(-2.4, 2.4));
            let Some(q) = reaching(&built, &there, start) else { continue };
            let noise = Vector3::from_fn(|_, _| 30.0 * UM * random.normal());
            let tip = built.flange_at(q.as_slice()).point(&TOOL.into());
            recording.add(q.as_slice(), base.point(&tip) + noise).unwrap();
            found += 1;
        }
    }
    Campaign::new(robot(0.0, 7), recording).unwrap().with_base(BASE.0, BASE.1).with_tool(TOOL.into())
}

/// Joint values near `q` that bring the tip to a point, by Gauss and Newton.
fn reaching(robot: &Robot, point: &Vector3<f64>, mut q: Vector6<f64>) -> Option<Vector6<f64>> {
    const STEP: f64 = 1e-6;
    let off = |q: &Vector6<f64>| robot.flange_at(q.as_slice()).point(&TOOL.into()) - point;
    for _ in 0..30 {
        let here = off(&q);
        let columns: [Vector3<f64>; 6] = std::array::from_fn(|joint| {
            let mut beside = q;
            beside[joint] += STEP;
            (off(&beside) - here) / STEP
        });
        let jacobian: Matrix3x6<f64> = Matrix3x6::from_columns(&columns);
        q -= jacobian.pseudo_inverse(1e-3).ok()? * here;
    }
    (off(&q).norm() < UM && q.amax() < 3.0).then_some(q)
}
