//! Intervals of numbers that readings cannot separate from those of neighbouring candidates.

use super::{Body, RigModel};
use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::mechanics::structure::Deformation;
use crate::inference::{Estimate, FindingPart};

/// A number of a joint that may be anywhere along the rod.
#[derive(PartialEq)]
enum OfJoint {
    Compliance(Deformation),
    Station,
}

impl RigModel {
    /// The estimates of a part: of a joint that nobody declared the interval also holds what the
    /// joint would be at the other stations that the readings cannot separate from its own.
    pub(in crate::diagnosis::rig) fn widened(&self, part: &FindingPart) -> Vec<Estimate> {
        let own = part.term.candidate;
        let mut estimates = part.estimates.clone();
        // where between two readings a slider meets the end of its play nobody sees
        for (estimate, action) in estimates.iter_mut().zip(&self.actions[own]) {
            if matches!(action, Action::SliderPlay) {
                estimate.low = estimate.low.min(estimate.value - 0.5 * self.step).max(0.0);
                estimate.high = estimate.high.max(estimate.value + 0.5 * self.step);
            }
        }
        if !self.is_scanned(own) {
            return estimates;
        }
        for (k, estimate) in estimates.iter_mut().enumerate() {
            let number = self.of_joint(&self.actions[own][k]);
            let (half, least) = match number {
                Some(OfJoint::Station) => (0.0, f64::NEG_INFINITY),
                _ => {
                    let half = (estimate.high - estimate.low) / 2.0;
                    (half, self.candidates[own].parameters[k].bounds.0)
                }
            };
            let terms = part.rivals.iter().filter_map(|rival| rival.term.as_ref());
            for term in terms.filter(|term| self.is_scanned(term.candidate)) {
                let actions = &self.actions[term.candidate];
                let same = actions.iter().position(|action| self.of_joint(action) == number);
                let Some(other) = same.and_then(|k| term.values.get(k)) else { continue };
                estimate.low = estimate.low.min(other - half).max(least);
                estimate.high = estimate.high.max(other + half);
            }
        }
        estimates
    }

    /// True for a joint that may be anywhere about its station.
    fn is_scanned(&self, candidate: usize) -> bool {
        self.actions[candidate].iter().any(|action| matches!(action, Action::Station(_)))
    }

    fn of_joint(&self, action: &Action) -> Option<OfJoint> {
        match action {
            Action::Station(_) => Some(OfJoint::Station),
            Action::Joint(number, _) => match &self.body {
                Body::Rod(structure) => Some(OfJoint::Compliance(structure.deformation(*number))),
                Body::Lines(_) => None,
            },
            Action::Friction(_)
            | Action::PulleyFriction(_)
            | Action::Presliding
            | Action::SliderPlay
            | Action::LoadOffset(_)
            | Action::TurnLoad(..)
            | Action::Stiffness
            | Action::StiffnessOf(_)
            | Action::ShearModulus
            | Action::Bend(_)
            | Action::JointIn(..)
            | Action::Varied(..)
            | Action::PerLoadSquared
            | Action::PerLoad
            | Action::Memory(..)
            | Action::Onset(_)
            | Action::SensorScale(_)
            | Action::TurnSensor(..)
            | Action::TurnSensors(..)
            | Action::Play(_)
            | Action::Display(_)
            | Action::Shift(_)
            | Action::Drift(..)
            | Action::Step(..)
            | Action::Own(..) => None,
        }
    }
}
