//! How well the torques on the joints are known: as well as the masses and centres of the links.
//!
//! ```text
//! ρⱼ = √(Σ_k (u·τⱼₖ)² + (g·m_k·u·|c_k|)²)/|τⱼ|        u the share that masses and centres are known to, τⱼₖ what link k loads
//!                                                   joint j with, where that is loaded most
//! ```

use nalgebra::Vector3;

use super::configuration::Configuration;
use super::context::Context;
use crate::calibration::campaign::Campaign;
use crate::robot::across;

/// Relative standard uncertainties of torques.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TorqueUncertainty {
    /// Of each joint's.
    joints: Vec<f64>,
    /// Of the moment about the base.
    base: f64,
}

impl TorqueUncertainty {
    pub fn new(campaign: &Campaign, context: &Context) -> TorqueUncertainty {
        let joint = |j: usize| {
            let size = |there: &Configuration, moment: Vector3<f64>| there.axis[j].dot(&moment).abs();
            relative(campaign, context, j, &|there| there.origin[j], &size)
        };
        TorqueUncertainty {
            joints: (0..context.joint_count()).map(joint).collect(),
            base: relative(campaign, context, 0, &|there| there.base.origin, &|there, moment| {
                across(&moment, &there.gravity.try_normalize(0.0).unwrap_or_default()).norm()
            }),
        }
    }

    /// Of the torque of a joint; of the moment about the base where there is none.
    pub fn of(&self, joint: Option<usize>) -> f64 {
        joint.map_or(self.base, |joint| self.joints.get(joint).copied().unwrap_or_default())
    }
}

/// Standard uncertainty of the torque on a joint in one configuration, N·m.
pub fn of_torque(campaign: &Campaign, joint: usize, there: &Configuration) -> f64 {
    let size = |moment: Vector3<f64>| there.axis[joint].dot(&moment).abs();
    moment_and_uncertainty(campaign, joint, there, there.origin[joint], &size).1
}

/// Where `size` of the moment of all from a joint on, about a point, is largest.
fn relative(
    campaign: &Campaign,
    context: &Context,
    joint: usize,
    about: &dyn Fn(&Configuration) -> Vector3<f64>,
    size: &dyn Fn(&Configuration, Vector3<f64>) -> f64,
) -> f64 {
    let at = |there: &Configuration| {
        moment_and_uncertainty(campaign, joint, there, about(there), &|moment| size(there, moment))
    };
    let most = context.configurations.iter().map(at).max_by(|a, b| a.0.total_cmp(&b.0));
    most.map_or(0.0, |(whole, off)| if whole > 0.0 { (off / whole).min(1.0) } else { 0.0 })
}

/// `size` of the moment of all links from a joint on, about a point, and its standard uncertainty.
fn moment_and_uncertainty(
    campaign: &Campaign,
    joint: usize,
    there: &Configuration,
    about: Vector3<f64>,
    size: &dyn Fn(Vector3<f64>) -> f64,
) -> (f64, f64) {
    let share = campaign.robot.standard_uncertainty.mass;
    let links = campaign.robot.joints.iter().enumerate().skip(joint);
    let (mut whole, mut squares) = (Vector3::zeros(), 0.0);
    for (k, body) in links.filter_map(|(k, joint)| Some((k, joint.body?))) {
        let lever = there.link[k].point(&body.centre) - about;
        let moment = lever.cross(&(there.gravity * body.mass));
        whole += moment;
        let centre = there.gravity.norm() * body.mass * share * body.centre.norm();
        squares += (share * size(moment)).powi(2) + centre * centre;
    }
    (size(whole), squares.sqrt())
}
