//! Units that look like physics: a pound for a kilogram is a rod 2.2 times stiffer than its file.
//!
//! A unit so near to what a rod may do is not tried as a mistake, since a joint or a modulus would
//! be blamed on the operator; and of a straight rod even kilograms are no surer than a soft root.
//! Such a unit is a rival instead: where all that a finding does to the readings ŷ is one factor,
//!
//! ```text
//! ŷ + Δ ≈ s·ŷ,   s = ŷᵀ(ŷ + Δ)/ŷᵀŷ        Δ the response of the finding's terms
//! ```
//!
//! and s comes near a unit's, these readings cannot say which of the two it is. Nor can they where
//! the readings themselves, without what the other findings do, are one factor of ŷ: a rod with a
//! joint that is stiffer all over is not quite what a unit makes of it.
//!
//! A factor that is beyond what moduli and walls do is a rival too, whatever unit it is of.

use nalgebra::DVector;

use super::super::effects::mistakes::UNIT_MISTAKE;
use super::super::model::RigModel;
use super::labels::{BEYOND_A_ROD, HARDLY_BESIDE, of_loads};
use crate::diagnosis::rig::recording::columns::load_column;
use crate::inference::{Evidence, Finding, ForwardModel, Location, Rival, Term};
use crate::linalg::least_squares;

/// What is left of a factor's response beside that factor, as a share of it (rms).
const ONE_FACTOR: f64 = 0.1;

/// The units of the loads that the finding of this number may be as well.
pub fn lookalikes(model: &RigModel, evidence: &Evidence, findings: &[Finding], number: usize) -> Vec<Rival> {
    let terms_of =
        |finding: &Finding| finding.parts.iter().map(|part| part.term.clone()).collect::<Vec<Term>>();
    let own = terms_of(&findings[number]);
    if own.is_empty() || model.rod.is_none() {
        return Vec::new();
    }
    let others: Vec<Term> = findings
        .iter()
        .enumerate()
        .filter(|(k, _)| *k != number)
        .flat_map(|(_, other)| terms_of(other))
        .collect();
    let column = load_column(model.readings.load_column);
    let predicted = DVector::from_iterator(model.data.len(), model.data.iter().map(|datum| datum.predicted));
    let fitted = factor_of(&predicted, &model.response(&own));
    let beside_zeros = |values: &DVector<f64>| match least_squares(&evidence.nuisance, values) {
        Ok(zeros) => values - &evidence.nuisance * zeros,
        Err(_) => values.clone(),
    };
    let recorded = &evidence.residual - model.response(&others);
    let recorded = factor_of(&beside_zeros(&predicted), &beside_zeros(&recorded));
    let is_near = |factor: f64| {
        [fitted, recorded].into_iter().flatten().any(|scale| (scale / factor).ln().abs() < HARDLY_BESIDE.ln())
    };
    let units = of_loads(model.readings.load_column).into_iter();
    let near = units.filter(|(_, factor)| is_near(*factor)).map(|(unit, _)| format!("{column} in {unit}"));
    let mut meant: Vec<String> = near.collect();
    let is_far = |scale: f64| scale.ln().abs() > BEYOND_A_ROD.ln();
    if meant.is_empty() && [fitted, recorded].into_iter().flatten().any(is_far) {
        meant.push(format!("of {column} or of the readings"));
    }
    meant.into_iter().map(|unit| Rival::without_term(&UNIT_MISTAKE, Location::key(unit), 1.0)).collect()
}

/// True where the readings as they were `recorded`, beside the rod file as it is, are one factor of
/// what that rod would show: then a rod that is softer or stiffer by that factor explains them too.
pub fn is_one_factor(recorded: &RigModel, evidence: &Evidence) -> bool {
    let predicted = recorded.data.iter().map(|datum| datum.predicted);
    let predicted = DVector::from_iterator(recorded.data.len(), predicted);
    recorded.rod.is_some() && factor_of(&predicted, &evidence.residual).is_some()
}

/// s, where a change of all data is one factor.
fn factor_of(predicted: &DVector<f64>, change: &DVector<f64>) -> Option<f64> {
    let squares = predicted.norm_squared();
    let excess = if squares > 0.0 { predicted.dot(change) / squares } else { 0.0 };
    let beside = (change - predicted * excess).norm();
    let scale = 1.0 + excess;
    (scale > 0.0 && squares > 0.0 && beside <= ONE_FACTOR * change.norm()).then_some(scale)
}
