//! What bends besides the joints: links and base.
//!
//! Their angles are small (hundreds of µrad), so that the tip's displacement is to first order all
//! that is left of them:
//!
//! Δp = Σⱼ kⱼ·M⊥ⱼ × (p − oⱼ) + k·Mₕ × (p − o₀), oⱼ the joint's origin or another point of its axis

use nalgebra::Vector3;

use super::{Effect, Kinematics, Loads};

/// All that pulls beyond a place, in {W}.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pull {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Its moment about the origin of {W}, N·m.
    pub moment: Vector3<f64>,
    /// The mass among it, kg.
    pub mass: f64,
    /// Its first moment about the origin of {W}, kg·m.
    pub first_moment: Vector3<f64>,
}

impl Pull {
    /// Moment about a point, N·m.
    pub fn moment_about(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.moment - point.cross(&self.force)
    }

    /// First moment of the masses about a point, kg·m.
    pub fn first_moment_about(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.first_moment - point * self.mass
    }
}

impl Kinematics<'_> {
    /// What pulls beyond every joint, its own link included: at the first, all that the base
    /// carries.
    pub fn pulls(&self, loads: &Loads) -> Vec<Pull> {
        let moment = self.tip.cross(&loads.tip_force);
        let mut pull = Pull { force: loads.tip_force, moment, mass: 0.0, first_moment: Vector3::zeros() };
        let mut add = |point: Vector3<f64>, mass: f64| {
            let weight = loads.gravity * mass;
            pull.force += weight;
            pull.moment += point.cross(&weight);
            pull.mass += mass;
            pull.first_moment += point * mass;
            pull
        };
        if let Some(payload) = &loads.payload {
            add(self.flange.point(&payload.centre), payload.mass);
        }
        let mut pulls: Vec<Pull> = (self.joints.iter().zip(&self.robot().joints).rev())
            .map(|(frames, joint)| match &joint.body {
                Some(body) => add(frames.distal.point(&body.centre), body.mass),
                None => add(frames.origin, 0.0),
            })
            .collect();
        pulls.reverse();
        pulls
    }

    /// Displacement of the tip by links that bend and a base that tilts, m, in {W}.
    pub fn structural_deflection(&self, loads: &Loads) -> Vector3<f64> {
        // most robots have none
        if !self.robot().effects.iter().any(Effect::bends_structure) {
            return Vector3::zeros();
        }
        let pulls = self.pulls(loads);
        let of_effect = |effect: &Effect| match effect {
            Effect::LinkFlexibility { joint, per_nm, at } => {
                let (frames, pull) = (&self.joints[*joint], &pulls[*joint]);
                let point = frames.origin + frames.axis * *at;
                // M⊥ = M − z·(z·M)
                let across = across(&pull.moment_about(&point), &frames.axis);
                (across * *per_nm).cross(&(self.tip - point))
            }
            Effect::GravityTilt { per_nm } => {
                let (up, base) = (loads.gravity.try_normalize(0.0), self.base().origin);
                let (Some(up), Some(pull)) = (up, pulls.first()) else { return Vector3::zeros() };
                (across(&pull.moment_about(&base), &up) * *per_nm).cross(&(self.tip - base))
            }
            Effect::Harmonic { .. }
            | Effect::Table { .. }
            | Effect::EncoderScale { .. }
            | Effect::Backlash { .. }
            | Effect::PlayByApproach { .. }
            | Effect::Friction { .. }
            | Effect::Lag { .. }
            | Effect::Compliance { .. }
            | Effect::NonlinearStiffness { .. }
            | Effect::Weight { .. }
            | Effect::Coupling { .. } => Vector3::zeros(),
        };
        self.robot().effects.iter().map(of_effect).sum()
    }
}

/// A moment without its part about an axis.
///
/// ```
/// use rodcal::robot::across;
///
/// let moment = across(&[1.0, 2.0, 3.0].into(), &[0.0, 0.0, 1.0].into()); // N·m
/// assert_eq!(moment.as_slice(), [1.0, 2.0, 0.0]);
/// ```
pub fn across(moment: &Vector3<f64>, axis: &Vector3<f64>) -> Vector3<f64> {
    moment - axis * axis.dot(moment)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Body, Hayati, Joint, Motion, Robot, Setup};
    use crate::spatial::Pose;

    const GRAVITY: f64 = 9.80665;
    const MASS: f64 = 2.0;

    /// An arm of 0.5 m about a vertical axis 0.3 m up, with 2 kg at its end.
    fn arm(effect: Effect) -> Robot {
        let link = Hayati { a: 0.5, ..Hayati::default() };
        let mut joint = Joint::new("one", Motion::Revolute, link);
        joint.body = Some(Body { mass: MASS, centre: Vector3::zeros() });
        let mut arm = Robot::new("arm", vec![joint]);
        arm.root.origin.z = 0.3;
        arm.gravity = [0.0, 0.0, -GRAVITY].into();
        arm.effects = vec![effect];
        arm
    }

    /// The tip above the flange by h sinks by θ·½ m and moves out by θ times its height above where
    /// it turns, θ = k·m·g·½ m.
    #[test]
    fn a_link_bends_about_its_joint_and_a_base_about_its_foot() {
        let (k, tool) = (1e-5, Vector3::new(0.0, 0.0, 0.2));
        let turn = k * MASS * GRAVITY * 0.5;
        let bends = |at: f64| Effect::LinkFlexibility { joint: 0, per_nm: k, at };
        for (effect, height) in
            [(bends(0.0), 0.2), (bends(0.15), 0.05), (Effect::GravityTilt { per_nm: k }, 0.5)]
        {
            let tip = arm(effect).tip_at(tool, &[0.0]).0 - Vector3::new(0.5, 0.0, 0.5);
            assert!((tip - Vector3::new(height, 0.0, -0.5) * turn).norm() < 1e-12, "{tip}");
        }
    }

    /// The sum over the forces is the recursion of the torques, whatever pulls.
    #[test]
    fn moments_about_the_axes_are_the_torques() {
        let mut robot = arm(Effect::GravityTilt { per_nm: 0.0 });
        let link = Hayati { a: 0.3, alpha: 1.1, d: 0.1, ..Hayati::default() };
        robot.joints.push(Joint::new("two", Motion::Revolute, link));
        robot
            .joints
            .push(Joint { body: robot.joints[0].body, ..Joint::new("three", Motion::Revolute, link) });
        let base = Pose::from_xyz_rpy([0.2, -0.1, 0.4], [0.3, 0.2, 0.1]);
        let setup = Setup::new(&robot, base, [0.05, 0.1, 0.2].into());
        let mut kinematics = Kinematics::new(&setup);
        kinematics.update(&[0.3, -0.7, 1.9], &[]);
        let payload = Some(Body { mass: 0.7, centre: [0.0, 0.1, 0.2].into() });
        let loads = Loads::new([0.1, -0.3, -9.8].into(), payload, [1.0, -2.0, 3.0].into());
        let mut torque = [0.0; 3];
        kinematics.torques(&loads, &mut torque);
        for ((frames, pull), torque) in kinematics.joints.iter().zip(kinematics.pulls(&loads)).zip(torque) {
            let moment = pull.moment_about(&frames.origin);
            assert!((frames.axis.dot(&moment) - torque).abs() < 1e-12);
            let first = pull.first_moment_about(&frames.origin);
            let own = first.cross(&loads.gravity) + (kinematics.tip - frames.origin).cross(&loads.tip_force);
            assert!((own - moment).norm() < 1e-12);
        }
    }
}
