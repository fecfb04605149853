//! How likely each effect is by itself, at its best place.

use crate::inference::{Candidate, Diagnosis, Effect, Location};

/// An effect at its place.
#[derive(Debug, Clone)]
pub struct Ranked {
    /// What it is.
    pub effect: &'static Effect,
    /// Where it was found; where it is likeliest, if it was not.
    pub location: Location,
    /// Ln of its odds against none, by itself.
    pub log_odds: f64,
    /// What the diagnosis made of it.
    pub rank: Rank,
}

/// What a diagnosis made of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rank {
    /// It is a finding, or what remains.
    Adopted,
    /// It may stand in the place of a finding.
    Rival,
    /// It is neither a finding nor the rival of one.
    Rejected,
}

/// All effects, the likeliest first; curves that nobody has named are one of them.
pub fn ranking(candidates: &[Candidate], diagnosis: &Diagnosis) -> Vec<Ranked> {
    let mut ranked: Vec<Ranked> = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let log_odds = diagnosis.odds[index];
        match ranked.iter_mut().find(|known| known.effect == candidate.effect) {
            Some(known) if log_odds > known.log_odds => {
                (known.log_odds, known.location) = (log_odds, candidate.location.clone());
            }
            Some(_) => {}
            None => ranked.push(Ranked {
                effect: candidate.effect,
                location: candidate.location.clone(),
                log_odds,
                rank: Rank::Rejected,
            }),
        }
    }
    let curve = diagnosis.discrepancy.as_ref().and_then(|left| left.candidate);
    let parts: Vec<_> = diagnosis.findings.iter().flat_map(|finding| &finding.parts).collect();
    for known in &mut ranked {
        let is_of_effect = |candidate: usize| candidates[candidate].effect == known.effect;
        let adopted = parts.iter().find(|part| is_of_effect(part.term.candidate));
        let mut rivals = parts.iter().flat_map(|part| part.rivals.iter().chain(&part.unnamed));
        let mut is_rival = || rivals.any(|rival| rival.effect == known.effect);
        if let Some(part) = adopted {
            known.rank = Rank::Adopted;
            known.location.clone_from(&part.location);
            known.log_odds = diagnosis.odds[part.term.candidate];
        } else if let Some(curve) = curve.filter(|curve| is_of_effect(*curve)) {
            known.rank = Rank::Adopted;
            known.location.clone_from(&candidates[curve].location);
            known.log_odds = diagnosis.odds[curve];
        } else if is_rival() {
            known.rank = Rank::Rival;
        }
    }
    ranked.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    ranked
}
