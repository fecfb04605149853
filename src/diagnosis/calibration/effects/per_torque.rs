//! Numbers that are per torque: the poses show their product with it alone, and it is known as well
//! as the masses of the links. A number per p-th power of the torque is known to p·ρ at best, ρ the
//! torque's relative standard uncertainty (`torque_uncertainty.rs`).

use super::super::model::CalibrationModel;
use super::super::model::law::Law;
use crate::inference::{Estimate, FindingPart};
use crate::robot::TorquePower;
use crate::statistics::HALF_95;

/// The parameters with what the torque of the joint, or the moment about the base, leaves
/// uncertain.
pub(super) fn per_torque(model: &CalibrationModel, parts: &[FindingPart]) -> Vec<Estimate> {
    let known = &model.torque_uncertainty;
    let widened = |part: &FindingPart| -> Vec<Estimate> {
        let power = match model.law(part.term.candidate) {
            Law::Nonlinear(TorquePower::Cube) => 3.0,
            Law::Nonlinear(TorquePower::Square) => 2.0,
            Law::Only
            | Law::Gear(_)
            | Law::Play(_)
            | Law::MassesUnknown(_)
            | Law::Rod(_)
            | Law::Hung(_)
            | Law::Drift(..)
            | Law::Warms(..)
            | Law::Bends(_)
            | Law::Moved(_)
            | Law::Axes(_) => 1.0,
        };
        let relative = known.of(part.location.joint());
        let wider = |estimate: &Estimate| {
            let half =
                (0.5 * (estimate.high - estimate.low)).hypot(HALF_95 * power * relative * estimate.value);
            Estimate { low: estimate.value - half, high: estimate.value + half, ..estimate.clone() }
        };
        part.estimates.iter().map(wider).collect()
    };
    parts.iter().flat_map(widened).collect()
}
