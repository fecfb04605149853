//! The prior of a hypothesis.
//!
//! Before the data half of all recordings hold nothing, the library shares 0.4, physics that nobody
//! has named 0.1. Within the library every effect has the same share, and within an effect every
//! place a share of that, so that a scan over a hundred places finds nothing a hundred times as
//! often as a single place does. Where all places of an effect together have a weight below 1, it
//! is so much rarer than others.

use std::collections::BTreeMap;

use crate::inference::{Candidate, Kind};

/// Prior probability that the next effect is none, one of the library, or one that nobody has
/// named.
pub const PRIOR: (f64, f64, f64) = (0.5, 0.4, 0.1);
/// Odds against chance from which on an effect is named.
pub const NAMED: f64 = 50.0;
/// Odds within which another explanation counts as indistinguishable: 20 to 1.
pub const APART: f64 = 20.0;
/// Share of it that a mistake has: it is named at odds of 1000, where an effect is at 50.
const MISTAKE: f64 = 0.05;

/// The weight of all places of an effect together, by its name and whether it is nonparametric.
type Weights<'a> = BTreeMap<(&'a str, bool), f64>;

fn weights(candidates: &[Candidate]) -> Weights<'_> {
    let mut weights = Weights::new();
    for candidate in candidates {
        *weights.entry((candidate.effect.name, candidate.is_nonparametric)).or_default() += candidate.weight;
    }
    weights
}

/// For each candidate how much rarer its effect is than others of its kind: a mistake, and an
/// effect whose places have little weight together.
pub fn rarity(candidates: &[Candidate]) -> Vec<f64> {
    let weights = weights(candidates);
    let of_candidate = |candidate: &Candidate| match candidate.effect.kind {
        Kind::Mistake => MISTAKE,
        _ => weights[&(candidate.effect.name, candidate.is_nonparametric)].min(1.0),
    };
    candidates.iter().map(of_candidate).collect()
}

/// Ln of each candidate's prior over that of none.
pub fn priors(candidates: &[Candidate]) -> Vec<f64> {
    let (none, library, unknown) = PRIOR;
    let places = weights(candidates);
    let effects = |wanted: bool| {
        places.keys().filter(|(_, is_nonparametric)| *is_nonparametric == wanted).count().max(1) as f64
    };
    let (known, unnamed) = (effects(false), effects(true));
    candidates
        .iter()
        .map(|candidate| {
            // an effect whose places have little weight together is a rare one
            let places = places[&(candidate.effect.name, candidate.is_nonparametric)].max(1.0);
            let share = match candidate.is_nonparametric {
                true => unknown / unnamed,
                false if candidate.effect.kind == Kind::Mistake => MISTAKE * library / known,
                false => library / known,
            };
            (share * candidate.weight / places / none).ln()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::tests::Columns;
    use nalgebra::DMatrix;

    #[test]
    fn an_effect_of_little_weight_is_rare_and_one_of_many_places_is_not() {
        let mut model = Columns::new(4);
        for (effect, place) in [("a", ""), ("b", "1"), ("b", "2"), ("c", "")] {
            model.add(effect, place, DMatrix::zeros(4, 1), false);
        }
        model.candidates[3].weight = 0.1;
        let odds: Vec<f64> = priors(&model.candidates).iter().map(|prior| prior.exp()).collect();
        assert!(
            (odds[1] / odds[0] - 0.5).abs() < 1e-12 && (odds[3] / odds[0] - 0.1).abs() < 1e-12,
            "{odds:?}"
        );
    }
}
