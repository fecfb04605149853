//! Poses for a simulated campaign: reachable, sensible, and picked for what they show.

use nalgebra::{DMatrix, Matrix3, Vector3};

use super::plan::{AIM, Plan};
use crate::calibration::campaign::Group;
use crate::error::{Error, Result};
use crate::robot::{Kinematics, Motion, Parameter, Robot, Setup};
use crate::statistics::Random;
use crate::units::MM;

/// Candidates for every pose that is picked.
const CANDIDATES: usize = 6;
/// Random starts of the inverse kinematics per candidate before the robot counts as unable to reach
/// a clamp.
const MOST_TRIALS: usize = 400;
/// How far the flange stays above the ball, m: rod and flange come from above.
const CLEARANCE: f64 = 0.03;

/// Joint values with the index of their clamp, clamp after clamp.
///
/// From a candidates of random postures that bring the ball to each clamp, those are picked one by
/// one that add most to the determinant of the information matrix, and so to O1.
pub(super) fn choose(
    truth: &Setup,
    free: &[Parameter],
    groups: &[Group],
    plan: &Plan,
) -> Result<Vec<(usize, Vec<f64>)>> {
    let mut random = Random::seeded(plan.seed, 1);
    let n = free.len();
    let mut kinematics = Kinematics::new(truth);
    let mut candidates = Vec::new();
    for (group, clamp) in groups.iter().enumerate() {
        for _ in 0..CANDIDATES * plan.poses_per_clamp {
            let q = reach(truth, &clamp.device.origin, &mut kinematics, &mut random).ok_or_else(|| {
                Error::NotApplicable {
                    what: format!("simulating {} with {}", clamp.name, truth.robot.name),
                    why: "no posture within the joint limits brings this rod's ball there from above".into(),
                    hint: "choose another robot or a rod of another size".into(),
                }
            })?;
            let torque = vec![1.0; q.len()];
            kinematics.update(&q, &[]);
            let column = |k: usize| kinematics.column(free[k], &torque);
            let rows = DMatrix::from_fn(3, n, |i, k| column(k)[i]);
            candidates.push((group, q, rows));
        }
    }
    // information matrices in sensible units: columns of norm 1 over the whole candidates
    let norms: Vec<f64> = (0..n)
        .map(|k| candidates.iter().map(|(_, _, rows)| rows.column(k).norm_squared()).sum::<f64>().sqrt())
        .map(|norm: f64| if norm > 0.0 { norm } else { 1.0 })
        .collect();
    for (_, _, rows) in &mut candidates {
        for (k, norm) in norms.iter().enumerate() {
            rows.column_mut(k).scale_mut(1.0 / norm);
        }
    }
    // P = M⁻¹, from a faint multiple of the identity on
    let mut inverse = DMatrix::identity(n, n) * 1e6;
    let mut left: Vec<bool> = vec![true; candidates.len()];
    let mut chosen: Vec<(usize, Vec<f64>)> = Vec::new();
    for _ in 0..plan.poses_per_clamp {
        for group in 0..groups.len() {
            let gain = |index: &usize| {
                let rows = &candidates[*index].2;
                (Matrix3::identity() + fixed(&(rows * &inverse * rows.transpose()))).determinant()
            };
            let open = (0..candidates.len()).filter(|&i| left[i] && candidates[i].0 == group);
            let Some(best) = open.max_by(|a, b| gain(a).total_cmp(&gain(b))) else { continue };
            left[best] = false;
            let rows = &candidates[best].2;
            // Woodbury: (M + JᵀJ)⁻¹ = P − P·Jᵀ(1 + J·P·Jᵀ)⁻¹J·P
            let across = rows * &inverse;
            let middle = Matrix3::identity() + fixed(&(&across * rows.transpose()));
            if let Some(middle) = middle.try_inverse() {
                inverse -= across.transpose() * middle * &across;
            }
            chosen.push((group, candidates[best].1.clone()));
        }
    }
    chosen.sort_by_key(|&(group, _)| group);
    Ok(chosen)
}

fn fixed(m: &DMatrix<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| m[(i, j)])
}

/// Joint values anywhere within the limits, the last tenth of the range left out.
pub(super) fn anywhere(robot: &Robot, random: &mut Random) -> Vec<f64> {
    robot
        .joints
        .iter()
        .map(|joint| {
            let widest = match joint.motion {
                Motion::Revolute => std::f64::consts::PI,
                Motion::Prismatic => 1.0,
            };
            let [low, high] = joint.limits.unwrap_or([-widest, widest]);
            let margin = 0.05 * (high - low);
            random.uniform((low + margin).max(-widest), (high - margin).min(widest))
        })
        .collect()
}

/// All joints stay above a table at this height, m.
pub(super) fn is_above_table(kinematics: &Kinematics, table: f64) -> bool {
    kinematics.joints.iter().skip(1).all(|frames| frames.distal.origin.z > table + 50.0 * MM)
        && kinematics.flange.origin.z > table + 50.0 * MM
}

/// Joint values of a random posture that brings the ball within the aim of a point, if one is
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
        for _ in 0..25 {
            kinematics.update(&q, &[]);
            let miss = aim - kinematics.tip;
            if miss.norm() < 1e-6 {
                break;
            }
            // the shortest way in joint space, damped: δ = Jᵀ(J·Jᵀ + ε)⁻¹·miss
            let columns: Vec<Vector3<f64>> = (0..q.len()).map(|j| kinematics.joint_jacobian(j)).collect();
            let square: Matrix3<f64> = columns.iter().map(|c| c * c.transpose()).sum();
            let Some(inverse) = (square + Matrix3::identity() * 1e-6).try_inverse() else { break };
            let pull = inverse * miss;
            for (q, column) in q.iter_mut().zip(&columns) {
                *q += column.dot(&pull).clamp(-0.3, 0.3);
            }
        }
        let limits_hold = q
            .iter()
            .zip(&robot.joints)
            .all(|(&q, joint)| joint.limits.is_none_or(|[low, high]| (low..=high).contains(&q)));
        kinematics.update(&q, &[]);
        let arrived = (aim - kinematics.tip).norm() < 1e-5;
        let from_above = kinematics.flange.origin.z > kinematics.tip.z + CLEARANCE;
        if arrived && limits_hold && from_above && is_above_table(kinematics, truth.base_position.z) {
            return Some(q);
        }
    }
    None
}
