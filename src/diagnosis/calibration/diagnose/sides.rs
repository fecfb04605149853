//! Poses in which nobody knows to which side the load pulls a joint.
//!
//! Play that is taken up on the side of the load depends on the sign of a torque τ, which is known
//! as well as masses and centres are, to s. Where it is near zero the pose itself says more:
//!
//! ```text
//! ln odds of the other side = ln Φ(−|τ|/s) − ln Φ(|τ|/s) + (|r|² − |r + 2e|²)/2σ²
//! ```
//!
//! r what is left of the pose, e what the play does there, σ of a coordinate.

use nalgebra::{DVector, Vector3};

use super::super::effects::play::BACKLASH;
use super::super::model::Context;
use super::super::model::context::Side;
use super::super::model::law::{Law, TakenUp};
use super::super::model::torque_uncertainty::of_torque;
use super::prepared::Prepared;
use crate::diagnosis::Limitation;
use crate::inference::{Diagnosis, Finding, Hypothesis, Location, Term};
use crate::statistics::ln_normal_mass;

/// Torques that are known better than so many standard uncertainties have the sign that they have.
const KNOWN: f64 = 3.0;

/// Poses that are likelier on the other side than the one on which they count now.
pub fn on_the_other_side(prepared: &Prepared, hypothesis: &Hypothesis, left: &DVector<f64>) -> Vec<Side> {
    let model = &prepared.model;
    let response = |terms: &[Term]| model.by_row(&model.terms.response(terms));
    let is_pose =
        |term: &&Term| matches!(model.terms.candidates[term.candidate].location, Location::Pose { .. });
    let poses: Vec<Term> = hypothesis.terms.iter().filter(is_pose).cloned().collect();
    let off: Vec<Vector3<f64>> =
        model.by_row(left).iter().zip(response(&poses)).map(|(left, pose)| left + pose).collect();
    let variance = {
        let rows = model.by_row(left);
        rows.iter().map(|left| left.norm_squared()).sum::<f64>() / (3 * rows.len()).max(1) as f64
    };
    let mut turned = Vec::new();
    for term in &hypothesis.terms {
        let joint = model.terms.candidates[term.candidate].location.joint();
        let (Some(joint), Law::Play(TakenUp::ByTorque)) = (joint, model.law(term.candidate)) else {
            continue;
        };
        let play = response(std::slice::from_ref(term));
        for (row, there) in prepared.context.configurations.iter().enumerate() {
            let uncertainty = of_torque(model.campaign, joint, there);
            let torque = there.torque[joint].abs() / uncertainty.max(f64::MIN_POSITIVE);
            let gain = off[row].norm_squared() - (off[row] + 2.0 * play[row]).norm_squared();
            let known = ln_normal_mass(f64::NEG_INFINITY, torque) - ln_normal_mass(torque, f64::INFINITY);
            // on which side it counts now has been asked of the pose before
            let by_load = if prepared.context.turned.contains(&(row, joint)) { -known } else { known };
            if torque < KNOWN && gain / (2.0 * variance) > by_load {
                turned.push((row, joint));
            }
        }
    }
    turned
}

/// Those of two lists that stand in one of them alone: turned twice is not turned.
pub fn either(one: &[Side], other: &[Side]) -> Vec<Side> {
    let alone = |own: &[Side], other: &[Side]| -> Vec<Side> {
        own.iter().filter(|side| !other.contains(side)).copied().collect()
    };
    let mut sides = [alone(one, other), alone(other, one)].concat();
    sides.sort_unstable();
    sides
}

/// Poses whose play was found on the other side than the masses of the file say.
pub fn unknown_sides(context: &Context, diagnosis: &Diagnosis) -> Vec<Limitation> {
    let is_play = |joint: usize| {
        let is_of =
            |finding: &Finding| finding.effect == &BACKLASH.effect && finding.location.joint() == Some(joint);
        diagnosis.findings.iter().any(is_of)
    };
    let of_joint = |joint: usize| {
        let own = context.turned.iter().filter(|(_, own)| *own == joint);
        let poses: Vec<String> = own.map(|(row, _)| context.pose_name(*row)).collect();
        (!poses.is_empty()).then_some(Limitation::UnknownSide(joint, poses))
    };
    (0..context.joint_count()).filter(|joint| is_play(*joint)).filter_map(of_joint).collect()
}
