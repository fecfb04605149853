//! Configurations at random, and those that bring the tip to a point.

use nalgebra::{Matrix3, Vector3};

use super::{Kinematics, Motion, Robot};
use crate::statistics::Random;

/// Steps towards a point before a configuration counts as unable to get there.
const MOST_STEPS: usize = 25;
/// Distance from the point at which the tip has arrived, m, and at which no more steps are needed.
const ARRIVED: f64 = 1e-5;
const CLOSE: f64 = 1e-6;
/// Most that a joint moves in a step, rad or m.
const LONGEST_STEP: f64 = 0.3;
/// How far joints and flange stay above a table, m.
const ABOVE: f64 = 0.05;

/// Joint values anywhere within the limits, the last tenth of the range left out.
pub fn anywhere(robot: &Robot, random: &mut Random) -> Vec<f64> {
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

/// True where every joint value is within its limits.
pub fn keeps_limits(robot: &Robot, q: &[f64]) -> bool {
    let keeps =
        |(&q, limits): (&f64, Option<[f64; 2]>)| limits.is_none_or(|[low, high]| (low..=high).contains(&q));
    q.iter().zip(robot.joints.iter().map(|joint| joint.limits)).all(keeps)
}

/// True where all joints but the first, and the flange, are well above a table at this height, m.
pub fn is_above_table(kinematics: &Kinematics, table: f64) -> bool {
    kinematics.joints.iter().skip(1).all(|frames| frames.distal.origin.z > table + ABOVE)
        && kinematics.flange.origin.z > table + ABOVE
}

/// Moves `q` the shortest way in joint space until the tip is at `aim` (m, in {W}), and
/// `kinematics` with it; gives what is left of the way, m. Limits are not looked at.
pub fn bring_to(kinematics: &mut Kinematics, q: &mut [f64], aim: &Vector3<f64>) -> f64 {
    for _ in 0..MOST_STEPS {
        kinematics.update(q, &[]);
        let miss = aim - kinematics.tip;
        if miss.norm() < CLOSE {
            break;
        }
        // damped: δ = Jᵀ(J·Jᵀ + ε)⁻¹·miss
        let columns: Vec<Vector3<f64>> = (0..q.len()).map(|j| kinematics.joint_jacobian(j)).collect();
        let square: Matrix3<f64> = columns.iter().map(|c| c * c.transpose()).sum();
        let Some(inverse) = (square + Matrix3::identity() * 1e-6).try_inverse() else { break };
        let pull = inverse * miss;
        for (q, column) in q.iter_mut().zip(&columns) {
            *q += column.dot(&pull).clamp(-LONGEST_STEP, LONGEST_STEP);
        }
    }
    kinematics.update(q, &[]);
    (aim - kinematics.tip).norm()
}

/// True for a way that is as good as gone.
pub fn has_arrived(left: f64) -> bool {
    left < ARRIVED
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Setup;
    use crate::spatial::Pose;

    #[test]
    fn a_tip_is_brought_to_its_point_or_as_near_as_the_arm_is_long() {
        let (file, text) = Robot::builtin("tx90").unwrap();
        let robot = Robot::from_text(file, text, None, None).unwrap();
        let setup = Setup::new(&robot, Pose::IDENTITY, Vector3::new(0.525, 0.0, 0.15));
        let mut kinematics = Kinematics::new(&setup);
        let mut random = Random::seeded(3, 0);
        let aim = Vector3::new(0.62, -0.03, 0.16);
        let mut arrived = 0;
        for _ in 0..50 {
            let mut q = anywhere(&robot, &mut random);
            assert!(keeps_limits(&robot, &q));
            if has_arrived(bring_to(&mut kinematics, &mut q, &aim)) {
                arrived += 1;
                kinematics.update(&q, &[]);
                assert!((kinematics.tip - aim).norm() < ARRIVED);
            }
        }
        assert!(arrived > 35, "{arrived}");
        let mut q = anywhere(&robot, &mut random);
        assert!(bring_to(&mut kinematics, &mut q, &Vector3::new(9.0, 0.0, 0.0)) > 6.0);
    }
}
