//! Where joints, flange and tip are for given joint values, and how the tip moves with every
//! parameter.

use nalgebra::{Matrix3, Vector3};

use super::{Effect, Hayati, Motion, Parameter, Robot, Setup};
use crate::spatial::{Pose, left_jacobian, turned_about_x, turned_about_y, turned_about_z};
use crate::units::STANDARD_GRAVITY;

/// One configuration of a [`Setup`] in {W}. Made once and moved from pose to pose without
/// allocation.
///
/// ```
/// use rodcal::prelude::*;
/// use rodcal::robot::Loads;
///
/// // an arm of 0.5 m that turns about a horizontal axis, 2 kg at its end
/// let mut joint = Joint::new("shoulder", Motion::Revolute, Hayati { a: 0.5, ..Hayati::default() });
/// joint.body = Some(rodcal::robot::Body { mass: 2.0, centre: [0.0; 3].into() });
/// let arm = Robot::new("arm", vec![joint]);
/// // the base stands on a wall: its z is horizontal
/// let base = Pose::from_xyz_rpy([0.0; 3], [std::f64::consts::FRAC_PI_2, 0.0, 0.0]);
/// let setup = Setup::new(&arm, base, [0.0; 3].into());
/// let mut kinematics = Kinematics::new(&setup);
/// kinematics.update(&[0.0], &[]);
/// // the tip moves upwards by its lever arm per radian
/// assert!((kinematics.joint_jacobian(0).z - 0.5).abs() < 1e-15);
/// let mut torque = [0.0];
/// let gravity = [0.0, 0.0, -9.80665].into();
/// kinematics.torques(&Loads::new(gravity, None, [0.0; 3].into()), &mut torque);
/// assert!((torque[0] + 2.0 * 9.80665 * 0.5).abs() < 1e-12); // −m·g·a
/// ```
#[derive(Debug, Clone)]
pub struct Kinematics<'s> {
    /// Base to flange, one per joint.
    pub joints: Vec<JointFrames>,
    /// {T}.
    pub flange: Pose,
    /// The undeflected tip, m.
    pub tip: Vector3<f64>,
    setup: &'s Setup<'s>,
    /// {0}.
    base: Pose,
    /// Frame of the first joint.
    root: Pose,
    /// From a change of the base's rotation vector to the rotation that it makes.
    base_turn: Matrix3<f64>,
}

/// What the parameters of one joint's link act along and about, in {W}.
#[derive(Debug, Clone, Copy)]
pub struct JointFrames {
    /// What the joint does.
    pub motion: Motion,
    /// The joint's axis: θ turns about it, d moves along it.
    pub axis: Vector3<f64>,
    /// A point on the axis, m.
    pub origin: Vector3<f64>,
    /// a moves along this x, α turns about it.
    x: Vector3<f64>,
    /// β turns about this y.
    y: Vector3<f64>,
    /// The joint's distal frame, which its link is fixed to.
    pub distal: Pose,
    /// Sine and cosine of α and β, the same in every configuration.
    alpha: (f64, f64),
    beta: (f64, f64),
}

impl<'s> Kinematics<'s> {
    /// Of a setup, in no configuration yet: [`Kinematics::update`] moves it to one.
    pub fn new(setup: &'s Setup<'s>) -> Self {
        let zero = Vector3::zeros();
        let joints = setup.robot.joints.iter().zip(&setup.links).map(|(joint, link)| JointFrames {
            motion: joint.motion,
            axis: zero,
            origin: zero,
            x: zero,
            y: zero,
            distal: Pose::IDENTITY,
            alpha: link.alpha.sin_cos(),
            beta: link.beta.sin_cos(),
        });
        let base = setup.base();
        Kinematics {
            joints: joints.collect(),
            flange: Pose::IDENTITY,
            tip: zero,
            setup,
            root: base.then(&setup.robot.root),
            base,
            base_turn: left_jacobian(&setup.base_turn),
        }
    }

    /// Moves to the joint values `q` (rad or m). `torque` (N·m, one per joint) turns compliant
    /// joints on; it may be empty where no joint is compliant.
    pub fn update(&mut self, q: &[f64], torque: &[f64]) {
        self.place(q, torque, &[]);
        // what weights turn hardly moves their levers
        let turns = self.turns_by_weights();
        if !turns.is_empty() {
            self.place(q, torque, &turns);
        }
    }

    /// Turn of each joint by unknown weights: Σ c·z·((p − o) × down); nothing where there are none.
    fn turns_by_weights(&self) -> Vec<f64> {
        let robot = self.setup.robot;
        let mut turns = Vec::new();
        for effect in &robot.effects {
            let Effect::Weight { joint, at, per_metre } = effect else { continue };
            turns.resize(robot.joints.len(), 0.0);
            let down = (self.base.rotation * robot.gravity).try_normalize(0.0).unwrap_or_default();
            let point = at.map_or(self.flange.origin, |k| self.joints[k].origin);
            let own = &self.joints[*joint];
            turns[*joint] += per_metre * own.axis.dot(&(point - own.origin).cross(&down));
        }
        turns
    }

    fn place(&mut self, q: &[f64], torque: &[f64], turns: &[f64]) {
        let setup = self.setup;
        let mut frame = self.root;
        let mut carrier = self.base.rotation;
        for (j, frames) in self.joints.iter_mut().enumerate() {
            if let Some(shift) = setup.robot.axis_shift(j, q) {
                frame.origin += carrier * shift;
            }
            // θ = offset + q + c·τ + effects
            let compliant_turn = torque.get(j).map_or(0.0, |torque| setup.compliance[j] * torque);
            let by_weights = turns.get(j).copied().unwrap_or(0.0);
            let correction = setup.robot.correction(j, q, torque) + by_weights;
            let link = setup.links[j].moved(frames.motion, q[j] + compliant_turn + correction);
            let turned = turned_about_z(&frame.rotation, link.theta.sin_cos());
            let tilted = turned_about_x(&turned, frames.alpha);
            frames.axis = axis(&frame.rotation, 2);
            frames.origin = frame.origin;
            frames.x = axis(&turned, 0);
            frames.y = axis(&tilted, 1);
            frames.distal = Pose {
                rotation: turned_about_y(&tilted, frames.beta),
                origin: frame.origin + frames.axis * link.d + frames.x * link.a,
            };
            if let Some(turn) = setup.robot.link_turn(j, q) {
                frames.distal.rotation *= turn;
            }
            frame = frames.distal;
            carrier = frame.rotation;
        }
        self.flange = frame.then(&setup.robot.flange);
        let mut tool = setup.tool;
        if !setup.robot.laws.is_empty() {
            let gravity = self.base.rotation * (setup.robot.gravity / STANDARD_GRAVITY);
            let weight = self.flange.rotation.transpose() * gravity;
            tool += setup.robot.tool_shift(q, &weight).unwrap_or_default();
        }
        self.tip = self.flange.point(&tool);
    }

    /// ∂tip/∂parameter in {W}, m per unit of the parameter (SI). `torque` as for
    /// [`Kinematics::update`].
    pub fn column(&self, parameter: Parameter, torque: &[f64]) -> Vector3<f64> {
        match parameter {
            Parameter::BasePosition(axis) => Matrix3::identity().column(axis).into(),
            // (Jₗ·eₖ) × (p − o)
            Parameter::BaseRotation(axis) => {
                let turn: Vector3<f64> = self.base_turn.column(axis).into();
                turn.cross(&(self.tip - self.base.origin))
            }
            // z × (p − o)
            Parameter::Theta(j) => self.turned(j),
            Parameter::D(j) => self.joints[j].axis,
            Parameter::A(j) => self.joints[j].x,
            // x × (p − o′) and y × (p − o′), o′ beyond d and a
            Parameter::Alpha(j) => self.joints[j].x.cross(&(self.tip - self.joints[j].distal.origin)),
            Parameter::Beta(j) => self.joints[j].y.cross(&(self.tip - self.joints[j].distal.origin)),
            // ∂q/∂c = τ
            Parameter::Compliance(j) => self.joint_jacobian(j) * torque.get(j).copied().unwrap_or(0.0),
            Parameter::Tool(axis) => self.flange.rotation.column(axis).into(),
        }
    }

    /// A column of the joint Jacobian: ∂tip/∂q of a joint, m/rad or m/m, in {W}.
    pub fn joint_jacobian(&self, joint: usize) -> Vector3<f64> {
        match self.joints[joint].motion {
            Motion::Revolute => self.turned(joint),
            Motion::Prismatic => self.joints[joint].axis,
        }
    }

    /// The former name of [`Kinematics::joint_jacobian`].
    #[doc(hidden)]
    pub fn moved(&self, joint: usize) -> Vector3<f64> {
        self.joint_jacobian(joint)
    }

    /// {0}.
    pub(super) fn base(&self) -> &Pose {
        &self.base
    }

    /// The robot that it is the configuration of.
    pub(super) fn robot(&self) -> &Robot {
        self.setup.robot
    }

    /// The tip's displacement per radian of a turn about a joint's axis, m/rad.
    fn turned(&self, joint: usize) -> Vector3<f64> {
        self.joints[joint].axis.cross(&(self.tip - self.joints[joint].origin))
    }
}

/// An axis of a frame, a column of its rotation.
fn axis(rotation: &Matrix3<f64>, number: usize) -> Vector3<f64> {
    Vector3::from(rotation.data.0[number])
}

impl Hayati {
    /// `frame` after Rz(θ)·Tz(d)·Tx(a)·Rx(α)·Ry(β).
    pub fn beyond(&self, frame: &Pose) -> Pose {
        let turned = turned_about_z(&frame.rotation, self.theta.sin_cos());
        let origin = frame.origin + axis(&turned, 2) * self.d + axis(&turned, 0) * self.a;
        let tilted = turned_about_x(&turned, self.alpha.sin_cos());
        Pose { rotation: turned_about_y(&tilted, self.beta.sin_cos()), origin }
    }

    /// With joint value `q` (rad or m) added where the joint moves.
    pub fn moved(&self, motion: Motion, q: f64) -> Hayati {
        match motion {
            Motion::Revolute => Hayati { theta: self.theta + q, ..*self },
            Motion::Prismatic => Hayati { d: self.d + q, ..*self },
        }
    }
}

impl Robot {
    /// How much farther a joint turns than it reads by its effects and laws, rad; see
    /// [`super::Effect::turn`].
    pub fn correction(&self, joint: usize, q: &[f64], torque: &[f64]) -> f64 {
        // most robots have none, and kinematics do little else
        if self.effects.is_empty() && self.laws.is_empty() {
            return 0.0;
        }
        let own = self.effects.iter().filter(|effect| effect.joint() == Some(joint));
        own.map(|effect| effect.turn(q, torque)).sum::<f64>() + self.law_turn(joint, q, torque)
    }

    /// {T} in {0} at the joint values `q` (rad or m, one per joint), with no torque on the joints.
    pub fn flange_at(&self, q: &[f64]) -> Pose {
        let value = |j: usize| q[j] + self.correction(j, q, &[]);
        let mut frame = self.root;
        let mut carrier = Matrix3::identity();
        for (j, joint) in self.joints.iter().enumerate().take(q.len()) {
            if let Some(shift) = self.axis_shift(j, q) {
                frame.origin += carrier * shift;
            }
            frame = joint.link.moved(joint.motion, value(j)).beyond(&frame);
            if let Some(turn) = self.link_turn(j, q) {
                frame.rotation *= turn;
            }
            carrier = frame.rotation;
        }
        frame.then(&self.flange)
    }
}
