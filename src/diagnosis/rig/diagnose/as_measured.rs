//! Sizes of effects on the rod as the readings say it is.
//!
//! Every hypothesis holds the nominal numbers by their derivatives, beside effects of the rod as
//! its file gives it. Where the rod is 2 % stiffer than its file, the friction that displaces its
//! tip as far is 2 % larger. With δᵢ the share by which the nominal numbers change the deflection
//! of datum i, an effect whose response r is in proportion to the rod's compliance has the response
//! (1 + δ)·r, and the sizes θ of all effects become those that do the same to that rod,
//!
//! ```text
//! Σ (1 + δ)·r(θ + Δ) = Σ r(θ):   Δ = −(J'ᵀJ' + λ)⁻¹·J'ᵀ·Σ δ·r(θ),   J' = (1 + δ)·J
//! ```
//!
//! A joint's compliance, a play and whatever shifts readings is what it is on any rod, and a factor
//! on the file's stiffness counts from the file: δ = 0. Intervals gain what is left unknown of the
//! numbers: Δ is to its uncertainty as the mean of δ is to its own.

use nalgebra::{DMatrix, DVector};

use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::model::RigModel;
use crate::inference::{Diagnosis, Estimate, Evidence, Finding, ForwardModel, Term};

/// Share of the largest deflection below which a datum's own δ is that of all: a cross channel.
const SMALL: f64 = 0.05;
/// Ridge of the columns J', relative to their mean square: what they cannot separate stays.
const RIDGE: f64 = 1e-6;
/// Change of the stiffness below which there is nothing to do.
const NOTHING: f64 = 1e-5;

/// Gives the findings of `diagnosis` the sizes that they have on the rod as it was found.
pub fn resize(model: &RigModel, evidence: &Evidence, diagnosis: &mut Diagnosis) {
    let Some((shares, mean, sd)) = stiffness(model, evidence, diagnosis) else { return };
    let terms = &diagnosis.hypothesis.terms;
    if terms.is_empty() || mean.abs() < NOTHING {
        return;
    }
    let count: usize = terms.iter().map(|term| term.values.len()).sum();
    let (mut jacobian, mut more) =
        (DMatrix::zeros(model.data.len(), count), DVector::zeros(model.data.len()));
    let all = model.response(terms);
    let mut at = 0;
    for (position, term) in terms.iter().enumerate() {
        let factor = if model.is_of_compliance(term) { 1.0 } else { 0.0 };
        let columns = model.columns(terms, position);
        for column in columns.column_iter() {
            let scaled = column.zip_map(&shares, |own, share| own * (1.0 + factor * share));
            jacobian.set_column(at, &scaled);
            at += 1;
        }
        // what it does beside the others: a rod ten times stiffer moves a tenth as far
        let others: Vec<Term> = terms.iter().filter(|other| *other != term).cloned().collect();
        let own = &all - model.response(&others);
        more += own.zip_map(&shares, |own, share| own * factor * share);
    }
    let mut gram = jacobian.tr_mul(&jacobian);
    let ridge = RIDGE * gram.trace() / count.max(1) as f64;
    (0..count).for_each(|k| gram[(k, k)] += ridge);
    let Some(root) = gram.cholesky() else { return };
    let steps = -root.solve(&jacobian.tr_mul(&more));
    for finding in &mut diagnosis.findings {
        moved(model, finding, &steps, sd / mean.abs());
        finding.estimates = model.estimates(&finding.parts, &diagnosis.hypothesis);
        finding.description = model.describe(finding);
    }
}

impl RigModel {
    /// True where the response of a term is in proportion to the compliance of the rod.
    fn is_of_compliance(&self, term: &Term) -> bool {
        self.actions[term.candidate].iter().all(|action| match action {
            Action::Friction(_)
            | Action::PulleyFriction(_)
            | Action::Presliding
            | Action::SliderPlay
            | Action::LoadOffset(_)
            | Action::TurnLoad(..)
            | Action::Bend(_)
            | Action::PerLoadSquared
            | Action::PerLoad
            | Action::Memory(..)
            | Action::Onset(_)
            | Action::Varied(..)
            | Action::TurnSensor(..)
            | Action::TurnSensors(..) => true,
            Action::Stiffness
            | Action::StiffnessOf(_)
            | Action::ShearModulus
            | Action::SensorScale(_)
            | Action::Joint(..)
            | Action::JointIn(..)
            | Action::Station(_)
            | Action::Play(_)
            | Action::Display(_)
            | Action::Shift(_)
            | Action::Drift(..)
            | Action::Step(..)
            | Action::Own(..) => false,
        })
    }
}

/// Moves the estimates of a finding by `steps`, in sizes of the parameters of the whole hypothesis.
fn moved(model: &RigModel, finding: &mut Finding, steps: &DVector<f64>, unsure: f64) {
    for part in &mut finding.parts {
        let parameters = &model.candidates()[part.term.candidate].parameters;
        for (k, (estimate, parameter)) in part.estimates.iter_mut().zip(parameters).enumerate() {
            let step = steps[part.first + k] * parameter.size;
            let more = part.coverage_factor * unsure * step.abs();
            let (low, high) = parameter.bounds;
            let Estimate { value, low: from, high: to, .. } = estimate;
            let halves = [(*value - *from).hypot(more), (*to - *value).hypot(more)];
            *value = (*value + step).clamp(low, high);
            (*from, *to) = ((*value - halves[0]).max(low), (*value + halves[1]).min(high));
        }
    }
}

/// By what share the nominal numbers change the deflection of each datum; of all together, with its
/// standard deviation. `None` without deflections or without such numbers.
fn stiffness(
    model: &RigModel,
    evidence: &Evidence,
    diagnosis: &Diagnosis,
) -> Option<(DVector<f64>, f64, f64)> {
    let (factors, covariance) = &diagnosis.nominal_factors;
    let predicted = DVector::from_column_slice(&model.bent);
    let square = predicted.norm_squared();
    if square == 0.0 || factors.is_empty() {
        return None;
    }
    let gradient = evidence.nominal.tr_mul(&predicted) / square;
    let mean = gradient.dot(factors);
    let sd = gradient.dot(&(covariance * &gradient)).max(0.0).sqrt();
    let change = &evidence.nominal * factors;
    let small = SMALL * predicted.amax();
    let share = |own: f64, change: f64| if own.abs() > small { change / own } else { mean };
    Some((predicted.zip_map(&change, share), mean, sd))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::diagnose;
    use crate::rig::readings::Readings;
    use crate::rod::Rod;
    use crate::statistics::Random;
    use crate::units::UM;

    /// A rod that is 1.5 % stiffer than its file, read to 0.5 µm with 2 N held back: the friction
    /// is that which the stiffer rod needs to bend as much.
    #[test]
    fn friction_is_that_of_the_rod_as_it_was_found() {
        let file = Rod::from_toml("rod", include_str!("../../../../rods/5.toml")).unwrap();
        let mut actual = file.clone();
        for pipe in [&mut actual.pipe1, &mut actual.bend, &mut actual.pipe2] {
            pipe.material.youngs_modulus *= 1.015;
            pipe.material.shear_modulus *= 1.015;
        }
        let mut text = "axis,load_n,trial,phase,dy_um\n".to_owned();
        for trial in 0..4 {
            for (load, phase) in [
                (5.0, "load"),
                (10.0, "load"),
                (20.0, "load"),
                (30.0, "load"),
                (20.0, "unload"),
                (5.0, "unload"),
            ] {
                text += &format!("y,{load},{trial},{phase},0\n");
            }
        }
        let mut readings = Readings::from_text("f", &text).unwrap();
        let model = RigModel::new(&readings, Some(&actual)).unwrap().0;
        let is_it = |candidate: &&crate::inference::Candidate| candidate.effect.name == "friction";
        let friction = model.candidates().iter().position(|candidate| is_it(&candidate)).unwrap();
        let change = model.response(&[Term { candidate: friction, values: vec![2.0] }]);
        let mut random = Random::seeded(2, 0);
        for (datum, change) in model.data().iter().zip(change.iter()) {
            let shown = datum.predicted + change + 0.5 * UM * random.normal();
            readings.rows[datum.row - 1].offset[datum.channel.index()] = Some(shown);
        }
        let found = diagnose(&readings, Some(&file)).unwrap();
        let force = found.diagnosis.findings[0].quantity("force_n").unwrap();
        assert!(force.low < 2.0 && 2.0 < force.high, "{force:?}");
        assert!((force.value - 2.0).abs() < 0.02, "{force:?}: 1.5 % less on the rod of the file");
    }
}
