//! Errors of a joint that depend on the move before: they are known where the order of the poses
//! is.
//!
//! ```text
//! q + ½·b·(direction of approach)     play that friction holds open, to the side that it was driven to
//! q + ½·h·|τ|·(direction of approach) friction that grows with the load
//! q + f·(q − q before)                f of the last move was still to come when q was read
//! q + law(q, direction of approach)   a formula with `side`
//! ```
//!
//! τ is the torque of the weights: of the arm, and of what hangs on its flange.

use nalgebra::Vector3;

use super::{Body, Effect, Kinematics, LawPlace, Loads, Robot, RobotLaw, Setup};
use crate::spatial::Pose;

/// A move of a joint below which it did not move, rad or m: a readout's last digit.
pub const STANDSTILL: f64 = 1e-7;

impl Robot {
    /// True where the joints' values depend on the order of the poses.
    pub fn has_moves(&self) -> bool {
        self.effects.iter().any(Effect::follows_moves) || self.sided_laws().next().is_some()
    }

    /// Joint values (rad or m, one per joint, pose after pose) with what the moves between them
    /// add; before the first pose nothing moved.
    ///
    /// ```
    /// use rodcal::prelude::*;
    /// use rodcal::robot::Effect;
    ///
    /// let mut arm = Robot::new("arm", vec![Joint::new("one", Motion::Revolute, Hayati::default())]);
    /// arm.effects.push(Effect::PlayByApproach { joint: 0, play: 2e-4 });
    /// // the last pose is the one before it: the joint stays where it was driven to
    /// assert_eq!(arm.after_moves(&[0.0, 1.0, 0.5, 0.5]), [0.0, 1.0001, 0.4999, 0.4999]);
    /// ```
    pub fn after_moves(&self, values: &[f64]) -> Vec<f64> {
        self.after_moves_with(None, values)
    }

    /// The same with a payload on the flange, whose weight friction grows with.
    pub fn after_moves_with(&self, payload: Option<Body>, values: &[f64]) -> Vec<f64> {
        let n = self.joints.len();
        let has_friction = self.effects.iter().any(|effect| matches!(effect, Effect::Friction { .. }));
        let setup = Setup::new(self, Pose::IDENTITY, Vector3::zeros());
        let mut kinematics = Kinematics::new(&setup);
        let loads = Loads::new(self.gravity, payload, Vector3::zeros());
        let mut torque = vec![0.0; n];
        let mut turned = values.to_vec();
        let mut approach = vec![0.0; n];
        for row in 1..values.len() / n.max(1) {
            let step: Vec<f64> = (0..n).map(|j| values[row * n + j] - values[(row - 1) * n + j]).collect();
            for (approach, step) in approach.iter_mut().zip(&step) {
                if step.abs() > STANDSTILL {
                    *approach = step.signum();
                }
            }
            if has_friction {
                kinematics.update(&values[row * n..][..n], &[]);
                kinematics.torques(&loads, &mut torque);
            }
            for (joint, law) in self.sided_laws() {
                turned[row * n + joint] += law.turn(&values[row * n..][..n], &[], approach[joint]);
            }
            for effect in &self.effects {
                match effect {
                    Effect::PlayByApproach { joint, play } => {
                        turned[row * n + joint] += 0.5 * play * approach[*joint];
                    }
                    Effect::Friction { joint, per_nm } => {
                        let wound = 0.5 * per_nm * torque[*joint].abs();
                        turned[row * n + joint] += wound * approach[*joint];
                    }
                    Effect::Lag { joint, fraction } => {
                        let own = |j: &usize| joint.is_none_or(|joint| joint == *j);
                        (0..n).filter(own).for_each(|j| turned[row * n + j] += fraction * step[j]);
                    }
                    // by where the robot is, whatever it did before
                    Effect::Harmonic { .. }
                    | Effect::Table { .. }
                    | Effect::EncoderScale { .. }
                    | Effect::Backlash { .. }
                    | Effect::Compliance { .. }
                    | Effect::NonlinearStiffness { .. }
                    | Effect::LinkFlexibility { .. }
                    | Effect::GravityTilt { .. }
                    | Effect::Weight { .. }
                    | Effect::Coupling { .. } => {}
                }
            }
        }
        turned
    }

    /// Laws of a joint that follow the way that it came.
    fn sided_laws(&self) -> impl Iterator<Item = (usize, &RobotLaw)> {
        let of_joint = |law: &'_ RobotLaw| match law.place {
            LawPlace::Joint(joint) if law.is_sided() => Some(joint),
            _ => None,
        };
        self.laws.iter().filter_map(move |law| Some((of_joint(law)?, law)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Hayati, Joint, Motion};

    /// An arm of 0.5 m with 2 kg at its end, then with 1 kg more.
    #[test]
    fn friction_keeps_a_joint_wound_up_by_its_load() {
        let link = Hayati { a: 0.5, ..Hayati::default() };
        let mut joint = Joint::new("one", Motion::Revolute, link);
        joint.body = Some(Body { mass: 2.0, centre: Vector3::zeros() });
        let mut arm = Robot::new("arm", vec![joint]);
        arm.gravity = [0.0, -10.0, 0.0].into();
        arm.effects = vec![Effect::Friction { joint: 0, per_nm: 1e-5 }];
        assert!(arm.has_moves());
        // 10 N·m lying, none standing
        let upright = std::f64::consts::FRAC_PI_2;
        let turned = arm.after_moves(&[-0.1, 0.0, upright, 0.0]);
        for (turned, expected) in turned.iter().zip([-0.1, 5e-5, upright, -5e-5]) {
            assert!((turned - expected).abs() < 1e-12, "{turned} {expected}");
        }
        let payload = Some(Body { mass: 1.0, centre: Vector3::zeros() });
        assert!((arm.after_moves_with(payload, &[-0.1, 0.0])[1] - 7.5e-5).abs() < 1e-12);
    }

    #[test]
    fn a_lag_is_a_share_of_the_last_move_of_one_joint_or_of_all() {
        let joints = ["a", "b"].map(|name| Joint::new(name, Motion::Revolute, Hayati::default()));
        let mut arm = Robot::new("arm", joints.to_vec());
        assert!(!arm.has_moves());
        arm.effects = vec![Effect::Lag { joint: Some(1), fraction: 0.1 }];
        assert_eq!(arm.after_moves(&[0.0, 0.0, 1.0, 2.0]), [0.0, 0.0, 1.0, 2.2]);
        arm.effects = vec![Effect::Lag { joint: None, fraction: 0.5 }];
        assert!(arm.has_moves());
        assert_eq!(arm.after_moves(&[0.0, 0.0, 1.0, 2.0]), [0.0, 0.0, 1.5, 3.0]);
    }
}
