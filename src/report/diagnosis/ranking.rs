//! How likely each effect is by itself, at its best place.

use crate::diagnosis::{Diagnosis, World};
use crate::report::pictures::diagnosis::Class;

/// An effect at its place.
pub struct Ranked {
    /// Its name.
    pub effect: String,
    /// Where it was found; where it is likeliest, if it was not.
    pub place: String,
    /// Ln of its odds against none, by itself.
    pub log_odds: f64,
    /// What became of it.
    pub class: Class,
}

/// All effects, the likeliest first; curves that nobody has named are one of them.
pub fn ranking(world: &dyn World, diagnosis: &Diagnosis) -> Vec<Ranked> {
    let candidates = world.candidates();
    let mut ranked: Vec<Ranked> = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        let log_odds = diagnosis.odds[index];
        let place = candidate.location.clone();
        match ranked.iter_mut().find(|known| known.effect == candidate.effect) {
            Some(known) if log_odds > known.log_odds => (known.log_odds, known.place) = (log_odds, place),
            Some(_) => {}
            None => {
                let (effect, class) = (candidate.effect.clone(), Class::Rejected);
                ranked.push(Ranked { effect, place, log_odds, class });
            }
        }
    }
    let unexplained = diagnosis.unexplained.as_ref().and_then(|left| left.candidate);
    for known in &mut ranked {
        let of_effect = |candidate: usize| candidates[candidate].effect == known.effect;
        let adopted = diagnosis.findings.iter().find(|finding| of_effect(finding.chosen.candidate));
        let is_rival =
            || diagnosis.findings.iter().flat_map(|f| &f.rivals).any(|r| of_effect(r.chosen.candidate));
        if let Some(finding) = adopted {
            known.class = Class::Adopted;
            known.place.clone_from(&finding.place);
            known.log_odds = diagnosis.odds[finding.chosen.candidate];
        } else if let Some(curve) = unexplained.filter(|curve| of_effect(*curve)) {
            known.class = Class::Adopted;
            known.place.clone_from(&candidates[curve].location);
            known.log_odds = diagnosis.odds[curve];
        } else if is_rival() {
            known.class = Class::Rival;
        }
    }
    ranked.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    ranked
}
