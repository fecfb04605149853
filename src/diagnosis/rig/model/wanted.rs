//! Which candidates a model has: all that its readings allow, or those of another model.

use crate::diagnosis::rig::own_effect::OwnEffect;
use crate::inference::{Candidate, Effect, Kind, UNKNOWN};

/// Which candidates a model shall have.
pub enum Wanted<'a> {
    All,
    /// No effect of the library, what has no name alone.
    Unnamed,
    /// And these, which a lab describes itself.
    AllAnd(&'a [OwnEffect]),
    /// Those that are the same things at the same places as these.
    Like(&'a [&'a Candidate]),
    /// The same, where some may be a lab's own.
    LikeAnd(&'a [&'a Candidate], &'a [OwnEffect]),
}

impl Wanted<'_> {
    /// False where no candidate of an effect is wanted.
    pub fn includes(&self, effect: &Effect) -> bool {
        match self {
            Wanted::All | Wanted::AllAnd(_) => true,
            Wanted::Unnamed => *effect == UNKNOWN,
            Wanted::Like(these) | Wanted::LikeAnd(these, _) => {
                these.iter().any(|candidate| candidate.effect == effect)
            }
        }
    }

    /// Effects that a lab describes itself.
    pub fn own(&self) -> &[OwnEffect] {
        match self {
            Wanted::All | Wanted::Unnamed | Wanted::Like(_) => &[],
            Wanted::AllAnd(own) | Wanted::LikeAnd(_, own) => own,
        }
    }

    pub fn has(&self, candidate: &Candidate) -> bool {
        match self {
            Wanted::All | Wanted::AllAnd(_) => true,
            Wanted::Unnamed => candidate.is_nonparametric,
            Wanted::Like(these) | Wanted::LikeAnd(these, _) => {
                these.iter().any(|known| is_same(candidate, known))
            }
        }
    }
}

/// The candidate of another recording that stands for the same. Laws of one effect at one place
/// differ in their parameters; of one law either recording may show some only.
pub fn is_same(new: &Candidate, old: &Candidate) -> bool {
    (&new.effect, &new.location) == (&old.effect, &old.location)
        && !new.is_nonparametric
        && old.effect.kind == Kind::Physics
        && new.parameters.iter().any(|p| old.parameters.iter().any(|q| q.name == p.name))
}
