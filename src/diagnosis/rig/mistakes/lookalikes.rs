//! Units that look like physics: a pound for a kilogram is a rod 2.2 times stiffer than its file.
//!
//! A unit so near to what a rod may do is not tried as a mistake, since a joint or a modulus would
//! be blamed on the operator. It is a rival instead: where all that a finding does to the readings
//! ŷ is one factor,
//!
//! ```text
//! ŷ + Δ ≈ s·ŷ,   s = ŷᵀ(ŷ + Δ)/ŷᵀŷ        Δ the response of the finding's terms
//! ```
//!
//! and s comes near a unit's, these readings cannot say which of the two it is.

use nalgebra::DVector;

use super::super::effects::mistakes::UNIT_MISTAKE;
use super::super::model::RigModel;
use super::moves::{HARDLY_BESIDE, like_physics};
use crate::inference::{Finding, ForwardModel, Location, Rival, Term};

/// What is left of a factor's response beside that factor, as a share of it (rms).
const ONE_FACTOR: f64 = 0.1;

/// The units of the loads that `finding` may be as well.
pub fn lookalikes(model: &RigModel, finding: &Finding) -> Vec<Rival> {
    let terms: Vec<Term> = finding.parts.iter().map(|part| part.term.clone()).collect();
    let predicted = DVector::from_iterator(model.data.len(), model.data.iter().map(|datum| datum.predicted));
    let squares = predicted.norm_squared();
    if terms.is_empty() || squares == 0.0 || model.rod.is_none() {
        return Vec::new();
    }
    let change = model.response(&terms);
    let excess = predicted.dot(&change) / squares;
    let beside = (&change - &predicted * excess).norm();
    let scale = 1.0 + excess;
    if scale <= 0.0 || beside > ONE_FACTOR * change.norm() {
        return Vec::new();
    }
    let (column, units) = like_physics(model.readings.load_column);
    let is_near = |factor: f64| (scale / factor).ln().abs() < HARDLY_BESIDE.ln();
    let near = units.into_iter().filter(|(_, factor)| is_near(*factor));
    near.map(|(unit, _)| {
        Rival::without_term(&UNIT_MISTAKE, Location::Key(format!("{column} in {unit}")), 1.0)
    })
    .collect()
}
