//! Poses that could be measured next with what stands there already.

use nalgebra::{Rotation3, Unit, Vector3};

use super::super::model::Configuration;
use crate::calibration::Calibration;
use crate::calibration::campaign::{Campaign, Group, GroupName, Row, Targets};
use crate::inference::{PlannedPose, PosePlan};
use crate::spatial::Pose;

/// Most poses of one proposal: an hour's work.
const MOST: usize = 40;
/// Steps of a joint that is moved alone, there and as many back.
const STEPS: usize = 20;
/// Turn of joint 1 for a clamp that is set up once more, degrees, and how far that joint turns
/// where the robot's file does not say it.
const TURN: f64 = 40.0;
const WIDEST: f64 = 170.0;
/// Fewest poses that are worth a clamp.
const FEWEST: usize = 6;

/// Poses to measure beside those that were.
#[derive(Debug, Clone, PartialEq)]
pub struct FeasiblePoses {
    /// What to do, a full sentence for the user.
    pub instruction: String,
    /// The same as numbers.
    pub plan: PosePlan,
}

impl FeasiblePoses {
    /// With the clamps that are there.
    fn in_place(instruction: String, poses: Vec<PlannedPose>) -> Self {
        FeasiblePoses { instruction, plan: PosePlan { poses, new_fixture: None } }
    }

    /// The campaign and its calibration with these poses measured, without any error.
    pub fn measured<'c>(
        &self,
        campaign: &Campaign,
        calibration: &Calibration<'c>,
    ) -> (Campaign, Calibration<'c>) {
        let (mut campaign, mut calibration) = (campaign.clone(), calibration.clone());
        let recording = &mut campaign.measurements;
        let last = recording.rows.last().and_then(|row| row.time);
        let first = recording.rows.first().and_then(|row| row.time);
        let pace = first.zip(last).map(|(a, b)| (b - a) / (recording.rows.len().max(2) - 1) as f64);
        let temperature = recording.rows.last().and_then(|row| row.temperature);
        for (number, PlannedPose { joints, like, group }) in self.plan.poses.iter().enumerate() {
            let time = last.zip(pace).map(|(last, pace)| last + pace * (number + 1) as f64);
            let pose = format!("new {}", number + 1);
            recording.rows.push(Row {
                pose,
                group: *group,
                time,
                temperature,
                ..recording.rows[*like].clone()
            });
            recording.joint_values.extend(joints);
            if let Targets::Points(points) = &mut recording.targets {
                points.push(points[*like]);
            }
            calibration.deviations.push(Vector3::zeros());
            calibration.deflections.push(calibration.deflections[*like]);
            calibration.tips.push(calibration.tips[*like]);
        }
        if let Some((name, device)) = &self.plan.new_fixture {
            recording.groups.push(Group::new(GroupName::Clamp(name.clone()), *device));
            calibration.noise.of_group.push(calibration.noise.pooled);
        }
        (campaign, calibration)
    }
}

/// All plans, the least laborious first.
pub fn feasible(campaign: &Campaign, configurations: &[Configuration]) -> Vec<FeasiblePoses> {
    let recording = &campaign.measurements;
    let count = configurations.len();
    if count == 0 {
        return Vec::new();
    }
    let again = |row: usize| PlannedPose {
        joints: configurations[row].joints.clone(),
        like: row,
        group: recording.rows[row].group,
    };
    let stride = count.div_ceil(MOST);
    let some = || (0..count).step_by(stride);
    let which = match stride {
        1 => "all poses".to_owned(),
        2 => "every second pose".to_owned(),
        3 => "every third pose".to_owned(),
        n => format!("every {n}th pose"),
    };
    let same_order = format!("Measure {which} once more, in the same order.");
    let reverse_order =
        format!("Measure {which} once more in reverse order, so that every joint comes from the other side.");
    let mut plans = vec![
        FeasiblePoses::in_place(same_order, some().map(again).collect()),
        FeasiblePoses::in_place(reverse_order, some().rev().map(again).collect()),
    ];
    let is_tracked = matches!(recording.targets, Targets::Points(_))
        && recording.groups.len() == 1
        && recording.groups[0].name.is_tracked();
    match (&recording.targets, is_tracked) {
        (_, true) => {
            let joints = 0..recording.joint_count;
            plans.extend(joints.filter_map(|joint| alone(campaign, configurations, joint)));
        }
        (Targets::Points(_), false) => {
            let again: Vec<_> = some().map(again).collect();
            plans.extend(turned_clamp(campaign, configurations, Vec::new(), ""));
            let first = format!("Measure {which} once more. ");
            plans.extend(turned_clamp(campaign, configurations, again, &first));
        }
        (Targets::Sockets(_), false) => {}
    }
    plans
}

/// One joint moved alone over its range and back, from the pose in which it moves the tip most.
fn alone(campaign: &Campaign, configurations: &[Configuration], joint: usize) -> Option<FeasiblePoses> {
    let lever = |row: &usize| configurations[*row].tip_jacobian[joint].norm();
    let at = (0..configurations.len()).max_by(|a, b| lever(a).total_cmp(&lever(b)))?;
    let values = configurations.iter().map(|there| there.joints[joint]);
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), q| (a.min(q), b.max(q)));
    let there = (0..STEPS).map(|step| low + (high - low) * step as f64 / (STEPS - 1) as f64);
    let poses = there.clone().chain(there.rev()).map(|q| {
        let mut joints = configurations[at].joints.clone();
        joints[joint] = q;
        PlannedPose { joints, like: at, group: campaign.measurements.rows[at].group }
    });
    let instruction = format!(
        "Move joint {} alone through its range and back in {STEPS} steps each, the other joints as in pose {}, and \
         measure at every step.",
        joint + 1,
        campaign.measurements.rows[at].pose
    );
    (high > low).then(|| FeasiblePoses::in_place(instruction, poses.collect()))
}

/// After some other poses the clamp with most poses once more, turned about joint 1 with all of
/// them: what it needs is a place to stand.
fn turned_clamp(
    campaign: &Campaign,
    configurations: &[Configuration],
    before: Vec<PlannedPose>,
    first: &str,
) -> Option<FeasiblePoses> {
    let recording = &campaign.measurements;
    let rows_of = |group: usize| {
        let rows = 0..configurations.len();
        rows.filter(move |&row| recording.rows[row].group == group)
    };
    let group = (0..recording.groups.len()).max_by_key(|&group| rows_of(group).count())?;
    let there = configurations.first()?;
    let [low, high] = campaign.robot.joints.first()?.limits.unwrap_or_else(|| {
        let recorded = configurations.iter().map(|there| there.joints[0].abs());
        let widest = recorded.fold(0.0, f64::max).max(WIDEST.to_radians());
        [-widest, widest]
    });
    let within = |degrees: f64| {
        let turned = |row: usize| (row, configurations[row].joints[0] + degrees.to_radians());
        rows_of(group).map(turned).filter(|(_, q)| (low..=high).contains(q)).take(MOST).collect::<Vec<_>>()
    };
    // towards the middle of the joint's range, unless that is the way out of it
    let mean = rows_of(group).map(|row| configurations[row].joints[0]).sum::<f64>();
    let degrees = if mean > 0.0 { -TURN } else { TURN };
    let degrees = if within(-degrees).len() > within(degrees).len() { -degrees } else { degrees };
    let reached = within(degrees);
    if reached.len() < FEWEST {
        return None;
    }
    let turn = Rotation3::from_axis_angle(&Unit::new_normalize(there.axis[0]), degrees.to_radians());
    let old = &recording.groups[group].device;
    let device = Pose {
        rotation: turn.matrix() * old.rotation,
        origin: there.origin[0] + turn * (old.origin - there.origin[0]),
    };
    let some =
        if reached.len() < rows_of(group).count().min(MOST) { " as far as joint 1 reaches" } else { "" };
    let poses = reached.into_iter().map(|(row, q)| {
        let mut joints = configurations[row].joints.clone();
        joints[0] = q;
        PlannedPose { joints, like: row, group: recording.groups.len() }
    });
    let name = &recording.groups[group].name;
    let instruction = format!(
        "{first}Set up one more clamp where {name} would be if joint 1 were turned by {degrees}°, and measure the poses of \
         {name} there{some}."
    );
    let poses = before.into_iter().chain(poses).collect();
    let new_fixture = Some(("new clamp".into(), device));
    Some(FeasiblePoses { instruction, plan: PosePlan { poses, new_fixture } })
}
