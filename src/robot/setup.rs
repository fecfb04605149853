//! A robot that stands somewhere and holds a tip: all numbers that a calibration changes, by
//! [`Parameter`].

use nalgebra::Vector3;

use super::{Hayati, Parameter, Robot};
use crate::spatial::{Pose, exponential};

/// A nominal robot with its present geometry, base and tool.
///
/// ```
/// use rodcal::prelude::*;
///
/// let joint = Joint::new("one", Motion::Revolute, Hayati { a: 0.5, ..Hayati::default() });
/// let robot = Robot::new("arm", vec![joint]);
/// let mut setup = Setup::new(&robot, Pose::IDENTITY, [0.0, 0.0, 0.1].into());
/// setup.set(Parameter::A(0), 0.501);
/// setup.set(Parameter::BaseRotation(2), 0.01);
/// assert!((setup.base().rotation[(1, 0)] - 0.01f64.sin()).abs() < 1e-15);
/// assert_eq!((setup.calibrated().joints[0].link.a, robot.joints[0].link.a), (0.501, 0.5));
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Setup<'r> {
    /// The nominal robot: joints, masses, limits.
    pub robot: &'r Robot,
    /// First guess of {0} in {W}.
    pub base_guess: Pose,
    /// Position of {0} in {W}, m.
    pub base_position: Vector3<f64>,
    /// Turn of {0} away from its first guess, rotation vector in {W}, rad.
    pub base_turn: Vector3<f64>,
    /// Present links, one per joint.
    pub links: Vec<Hayati>,
    /// Present compliances, rad/(N·m), one per joint.
    pub compliance: Vec<f64>,
    /// Undeflected tip in {T}, m.
    pub tool: Vector3<f64>,
}

impl<'r> Setup<'r> {
    /// The nominal robot on `base` with its tip at `tool` (m, in {T}).
    pub fn new(robot: &'r Robot, base: Pose, tool: Vector3<f64>) -> Self {
        Setup {
            robot,
            base_guess: base,
            base_position: base.origin,
            base_turn: Vector3::zeros(),
            links: robot.joints.iter().map(|joint| joint.link).collect(),
            compliance: robot.joints.iter().map(|joint| joint.compliance).collect(),
            tool,
        }
    }

    /// {0} in {W}.
    pub fn base(&self) -> Pose {
        Pose { rotation: exponential(&self.base_turn) * self.base_guess.rotation, origin: self.base_position }
    }

    /// The value of a parameter, SI: m, rad, or rad/(N·m) of a compliance.
    pub fn get(&self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::BasePosition(axis) => self.base_position[axis],
            Parameter::BaseRotation(axis) => self.base_turn[axis],
            Parameter::Theta(j) => self.links[j].theta,
            Parameter::D(j) => self.links[j].d,
            Parameter::A(j) => self.links[j].a,
            Parameter::Alpha(j) => self.links[j].alpha,
            Parameter::Beta(j) => self.links[j].beta,
            Parameter::Compliance(j) => self.compliance[j],
            Parameter::Tool(axis) => self.tool[axis],
        }
    }

    /// Changes the value of a parameter, SI.
    pub fn set(&mut self, parameter: Parameter, value: f64) {
        *match parameter {
            Parameter::BasePosition(axis) => &mut self.base_position[axis],
            Parameter::BaseRotation(axis) => &mut self.base_turn[axis],
            Parameter::Theta(j) => &mut self.links[j].theta,
            Parameter::D(j) => &mut self.links[j].d,
            Parameter::A(j) => &mut self.links[j].a,
            Parameter::Alpha(j) => &mut self.links[j].alpha,
            Parameter::Beta(j) => &mut self.links[j].beta,
            Parameter::Compliance(j) => &mut self.compliance[j],
            Parameter::Tool(axis) => &mut self.tool[axis],
        } = value;
    }

    /// The robot with the present links and compliances.
    pub fn calibrated(&self) -> Robot {
        let mut robot = self.robot.clone();
        for (j, joint) in robot.joints.iter_mut().enumerate() {
            joint.link = self.links[j];
            joint.compliance = self.compliance[j];
        }
        robot
    }
}
