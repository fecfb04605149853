//! What the robot does at every row: Jacobians, loads and the move that led there, in {W}, once and
//! for all effects.

use nalgebra::{Matrix3, Vector3};

use crate::calibration::campaign::Recording;
use crate::calibration::{Compensation, TORQUE_ROUNDS};
use crate::robot::{Kinematics, Loads, Motion, Pull, Setup, across};
use crate::spatial::Pose;

/// A move of a joint below which it did not move, rad or m: a readout's last digit.
pub const STANDSTILL: f64 = 1e-7;
/// The calibrated robot at one row.
#[derive(Debug, Clone)]
pub struct Configuration {
    /// Joint values as recorded, rad or m.
    pub joints: Vec<f64>,
    /// ∂tip/∂q of every joint, m/rad or m/m.
    pub tip_jacobian: Vec<Vector3<f64>>,
    /// Direction of every joint's axis.
    pub axis: Vec<Vector3<f64>>,
    /// A point on it, m.
    pub origin: Vec<Vector3<f64>>,
    /// Torque of all loads beyond a joint about its axis, N·m (N).
    pub torque: Vec<f64>,
    /// Their moment about the point on the axis, N·m.
    pub moment: Vec<Vector3<f64>>,
    /// Force of all loads beyond a joint, N.
    pub force: Vec<Vector3<f64>>,
    /// First moment of all masses beyond a joint about the point on its axis, kg·m: what g × has to
    /// be multiplied by for their moment.
    pub first_moment: Vec<Vector3<f64>>,
    /// Horizontal part of the moment of all that the base carries about the origin of {0}, N·m.
    pub base_moment: Vector3<f64>,
    /// Compliance of each joint, rad/(N·m), or m/N of a prismatic one.
    pub compliance: Vec<f64>,
    /// The frame of the link that each joint moves.
    pub link: Vec<Pose>,
    /// {0}.
    pub base: Pose,
    /// {T}.
    pub flange: Pose,
    /// The ball: the deflected tip, m.
    pub tip: Vector3<f64>,
    /// Acceleration of gravity, m/s².
    pub gravity: Vector3<f64>,
    /// Joint values less those of the row before, zeros for the first.
    pub step: Vec<f64>,
    /// Direction from which each joint came: 1, −1, or 0 where it never moved.
    pub approach: Vec<f64>,
}

impl Configuration {
    /// Displacement of the tip, m, by joints that deflect under one more force (N) at a point (m)
    /// beyond all of them: Σ J·c·(∂point/∂q · force), in {W}.
    pub fn joint_deflection(&self, point: &Vector3<f64>, force: &Vector3<f64>) -> Vector3<f64> {
        let of_joint =
            |j: usize| self.tip_jacobian[j] * (self.compliance[j] * self.torque_of(j, point, force));
        (0..self.tip_jacobian.len()).map(of_joint).sum()
    }

    /// Displacement of the tip, m, by joints up to `last` that deflect under a force (N) at a point
    /// of the link that joint moves: Σ J·c·z·(lever × force), the levers from each joint's origin,
    /// m.
    pub fn joint_deflection_below(
        &self,
        last: usize,
        lever: impl Fn(usize) -> Vector3<f64>,
        force: &Vector3<f64>,
    ) -> Vector3<f64> {
        let of_joint = |j: usize| {
            let torque = self.axis[j].dot(&lever(j).cross(force));
            self.tip_jacobian[j] * (self.compliance[j] * torque)
        };
        (0..=last).map(of_joint).sum()
    }

    /// Displacement of the tip, m, by joints that deflect under one more acceleration of all masses
    /// (m/s²): Σ J·c·z·(S × acceleration).
    pub fn joint_deflection_by_weight(&self, acceleration: &Vector3<f64>) -> Vector3<f64> {
        let of_joint = |j: usize| {
            let torque = self.axis[j].dot(&self.first_moment[j].cross(acceleration));
            self.tip_jacobian[j] * (self.compliance[j] * torque)
        };
        (0..self.tip_jacobian.len()).map(of_joint).sum()
    }

    /// Torque about a joint's axis of one more force (N) at a point (m), N·m.
    pub fn torque_of(&self, joint: usize, point: &Vector3<f64>, force: &Vector3<f64>) -> f64 {
        self.axis[joint].dot(&(point - self.origin[joint]).cross(force))
    }

    /// A tensor given in {T}, in {W}.
    pub fn in_world(&self, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        self.flange.rotation * tensor * self.flange.rotation.transpose()
    }
}

/// One for every row of a recording; the joints have this `compliance`, `deflections` are what
/// deflects the tip there, in {W}, m.
pub fn all(
    recording: &Recording,
    setup: &Setup,
    compliance: &[f64],
    deflections: &[Vector3<f64>],
    compensation: &Compensation,
) -> Vec<Configuration> {
    let count = recording.joint_count;
    let mut kinematics = Kinematics::new(setup);
    let gravity = setup.base().rotation * setup.robot.gravity;
    let mut approach = vec![0.0; count];
    (0..recording.len())
        .map(|row| {
            let tip_force = recording.device(row).rotation * compensation.contact_force;
            let loads = Loads { gravity, payload: compensation.payload, tip_force };
            let mut torque = vec![0.0; count];
            for _ in 0..TORQUE_ROUNDS {
                kinematics.update(recording.joints(row), &torque);
                kinematics.torques(&loads, &mut torque);
            }
            kinematics.update(recording.joints(row), &torque);
            let pulls = kinematics.pulls(&loads);
            let base = setup.base();
            let upright = gravity.try_normalize(0.0).unwrap_or_default();
            let base_moment = pulls.first().map(|pull| across(&pull.moment_about(&base.origin), &upright));
            kinematics.tip += deflections[row];
            let step = step(recording, row);
            for (approach, step) in approach.iter_mut().zip(&step).filter(|(_, s)| s.abs() > STANDSTILL) {
                *approach = step.signum();
            }
            Configuration {
                joints: recording.joints(row).to_vec(),
                tip_jacobian: (0..count).map(|j| kinematics.moved(j)).collect(),
                axis: kinematics.joints.iter().map(|joint| joint.axis).collect(),
                origin: kinematics.joints.iter().map(|joint| joint.origin).collect(),
                torque,
                moment: at_axes(&kinematics, &pulls, Pull::moment_about),
                force: pulls.iter().map(|pull| pull.force).collect(),
                first_moment: at_axes(&kinematics, &pulls, Pull::first_moment_about),
                base_moment: base_moment.unwrap_or_default(),
                compliance: compliance.to_vec(),
                link: kinematics.joints.iter().map(|joint| joint.distal).collect(),
                base,
                flange: kinematics.flange,
                tip: kinematics.tip,
                gravity,
                step,
                approach: approach.clone(),
            }
        })
        .collect()
}

fn step(recording: &Recording, row: usize) -> Vec<f64> {
    let before = recording.joints(row.saturating_sub(1));
    recording.joints(row).iter().zip(before).map(|(now, before)| now - before).collect()
}

/// About a point on the axis of each joint; zeros for a prismatic one.
fn at_axes(
    kinematics: &Kinematics,
    pulls: &[Pull],
    about: fn(&Pull, &Vector3<f64>) -> Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let of_joints = kinematics.joints.iter().zip(pulls);
    let at = of_joints.map(|(frames, pull)| match frames.motion {
        Motion::Revolute => about(pull, &frames.origin),
        Motion::Prismatic => Vector3::zeros(),
    });
    at.collect()
}

/// The direction in which a device in the origin of {W} sees a point; zero for that origin itself.
pub fn sight(point: &Vector3<f64>) -> Vector3<f64> {
    point.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vector3::zeros)
}
