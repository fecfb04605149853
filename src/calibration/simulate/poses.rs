//! Poses for a simulated campaign: reachable, sensible, and picked for what they show.

use nalgebra::{DMatrix, Matrix3xX, Vector3};

use super::plan::{AIM, Plan};
use crate::calibration::campaign::Group;
use crate::error::{Error, Result};
use crate::optimal_design::{Criterion, Measurements, grow};
use crate::robot::configurations::{anywhere, bring_to, has_arrived, is_above_table, keeps_limits};
use crate::robot::{Kinematics, Parameter, Setup};
use crate::statistics::Random;

/// Candidates for every pose that is picked.
const CANDIDATES: usize = 6;
/// Random starts of the inverse kinematics per candidate before the robot counts as unable to reach
/// a clamp.
const MOST_TRIALS: usize = 400;
/// How far the flange stays above the ball, m: rod and flange come from above.
const CLEARANCE: f64 = 0.03;
/// What is known before the first pose, in columns of norm 1 over the whole candidates.
const FAINT: f64 = 1e-6;

/// Joint values with the index of their clamp, clamp after clamp.
///
/// From candidates of random configurations that bring the ball to each clamp, those are picked one
/// by one that add most to the determinant of the information matrix, and so to O1.
pub(super) fn choose(
    truth: &Setup,
    free: &[Parameter],
    groups: &[Group],
    plan: &Plan,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<(usize, Vec<f64>)>> {
    let mut random = Random::seeded(plan.seed, 1);
    let mut kinematics = Kinematics::new(truth);
    let mut configurations = Vec::new();
    let mut all = Measurements::new(free.len());
    let torque = vec![1.0; truth.robot.joints.len()];
    for (group, clamp) in groups.iter().enumerate() {
        for _ in 0..CANDIDATES * plan.poses_per_clamp {
            let q = reach(truth, &clamp.device.origin, &mut kinematics, &mut random).ok_or_else(|| {
                Error::NotApplicable {
                    what: format!("simulating {} with {}", clamp.name, truth.robot.name),
                    why: "no configuration within the joint limits brings this rod's ball there from above"
                        .into(),
                    hint: "choose another robot or a rod of another size".into(),
                }
            })?;
            kinematics.update(&q, &[]);
            let columns: Vec<Vector3<f64>> = free.iter().map(|&p| kinematics.column(p, &torque)).collect();
            all.push(group, &Matrix3xX::from_columns(&columns));
            configurations.push(q);
            progress();
        }
    }
    all.scale(&all.column_norms());
    let before = DMatrix::identity(free.len(), free.len()) * FAINT;
    let quotas = vec![plan.poses_per_clamp; groups.len()];
    let mut chosen = grow(&all, &quotas, &before, &Criterion::Determinant, progress).unwrap_or_default();
    chosen.sort_by_key(|&index| all.group(index));
    Ok(chosen
        .into_iter()
        .map(|index| (all.group(index), std::mem::take(&mut configurations[index])))
        .collect())
}

/// Joint values of a random configuration that brings the ball within the aim of a point, if one is
/// found.
fn reach(
    truth: &Setup,
    point: &Vector3<f64>,
    kinematics: &mut Kinematics,
    random: &mut Random,
) -> Option<Vec<f64>> {
    let robot = truth.robot;
    for _ in 0..MOST_TRIALS {
        let mut q = anywhere(robot, random);
        let aim = point + Vector3::from_fn(|_, _| AIM * random.uniform(-1.0, 1.0));
        let left = bring_to(kinematics, &mut q, &aim);
        let from_above = kinematics.flange.origin.z > kinematics.tip.z + CLEARANCE;
        let is_above = is_above_table(kinematics, truth.base_position.z);
        if has_arrived(left) && keeps_limits(robot, &q) && from_above && is_above {
            return Some(q);
        }
    }
    None
}
