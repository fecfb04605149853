//! How far the numbers of a robot may be from its drawing, in a quick fit.

use super::super::draft::Draft;
use super::loaded_robot::LoadedRobot;
use super::residuals::FitState;
use crate::robot::{Parameter, ParameterGroup};
use crate::units::{DEG, MM};

/// Standard deviations of a robot as built, twice the usual: lengths, twists, zeros of joints.
const LENGTH: f64 = 2.0 * MM;
const TWIST: f64 = 0.2 * DEG;
const ZERO: f64 = 0.6 * DEG;
/// How far a joint deflects under its largest torque, rad.
const DEFLECTION: f64 = 1e-3;
/// A step of the tip is at most so uncertain, m: a ridge, no knowledge.
const TOOL: f64 = 0.5;

/// Standard deviations of the free parameters.
pub(super) fn sizes(draft: &Draft, body: &LoadedRobot, torque: &[f64]) -> Vec<f64> {
    let largest = |j: usize| {
        let of_joint = torque.iter().skip(j).step_by(draft.joint_count);
        of_joint.fold(1e-6, |most: f64, torque| most.max(torque.abs()))
    };
    let size = |parameter: &Parameter| match parameter {
        Parameter::D(_) | Parameter::A(_) => LENGTH,
        Parameter::Alpha(_) | Parameter::Beta(_) => TWIST,
        Parameter::Theta(_) => ZERO,
        Parameter::Compliance(j) => DEFLECTION / largest(*j),
        // a base has columns of its own
        Parameter::BasePosition(_) | Parameter::BaseRotation(_) | Parameter::Tool(_) => TOOL,
    };
    body.free.iter().map(size).collect()
}

/// What the normal matrix has of the priors: those of the free parameters, and a ridge of the
/// bases.
pub(super) fn prior_precision(sd: &[f64], columns: usize) -> Vec<f64> {
    (0..columns).map(|k| sd.get(k).map_or(1e-6, |sd| sd.powi(-2))).collect()
}

/// ½·Σ((ρ − nominal)/sd)², the tip excepted.
pub(super) fn moved(body: &LoadedRobot, state: &FitState, nominal: &[f64], sd: &[f64]) -> f64 {
    let known = (0..body.free.len()).filter(|&k| body.free[k].group() != ParameterGroup::Tool);
    0.5 * known.map(|k| ((state.setup.get(body.free[k]) - nominal[k]) / sd[k]).powi(2)).sum::<f64>()
}
