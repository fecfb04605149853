//! Torques on the joints at rest: weights of links and payload, and the force on the tip.
//!
//! The recursive Newton–Euler equations without motion: from the tip inwards, every link adds its
//! weight to the force and the moment that the joint before it carries.

use nalgebra::Vector3;

use super::{Body, Kinematics, Motion};

/// What pulls at the robot in one configuration, in {W}.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Loads {
    /// Acceleration of gravity, m/s².
    pub gravity: Vector3<f64>,
    /// Rod on the flange, its centre in {T}.
    pub payload: Option<Body>,
    /// Force on the tip, N.
    pub tip_force: Vector3<f64>,
}

impl Loads {
    /// Gravity (m/s²), what hangs on the flange, and a force on the tip (N), in {W}.
    pub fn new(gravity: Vector3<f64>, payload: Option<Body>, tip_force: Vector3<f64>) -> Loads {
        Loads { gravity, payload, tip_force }
    }
}

impl Kinematics<'_> {
    /// The torque of the loads about each joint's axis, N·m (along it for a prismatic joint, N),
    /// into `torque`:
    ///
    /// τⱼ = zⱼ · (Σ pₖ × fₖ − oⱼ × Σ fₖ)   over the forces f at the points p beyond the joint
    pub fn torques(&self, loads: &Loads, torque: &mut [f64]) {
        let mut force = loads.tip_force;
        let mut moment = self.tip.cross(&loads.tip_force);
        if let Some(payload) = &loads.payload {
            let weight = loads.gravity * payload.mass;
            force += weight;
            moment += self.flange.point(&payload.centre).cross(&weight);
        }
        for (j, frames) in self.joints.iter().enumerate().rev() {
            if let Some(body) = &self.robot().joints[j].body {
                let weight = loads.gravity * body.mass;
                force += weight;
                moment += frames.distal.point(&body.centre).cross(&weight);
            }
            torque[j] = match frames.motion {
                Motion::Revolute => frames.axis.dot(&(moment - frames.origin.cross(&force))),
                Motion::Prismatic => frames.axis.dot(&force),
            };
        }
    }
}
