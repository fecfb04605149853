//! A finding, complete in itself: what, where, how large, how sure, what else it may be, what to
//! do.

use nalgebra::{DMatrix, DVector};

use crate::inference::{
    Description, Effect, Hypothesis, Kind, Location, Proposal, Quantity, Term, WrittenTo,
};
use crate::units::Unit;

/// An effect that was adopted: one term of the hypothesis, or several that are reported as one.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Finding {
    /// What it is.
    pub effect: &'static Effect,
    /// Where it is.
    pub location: Location,
    /// What it amounts to.
    pub estimates: Vec<Estimate>,
    /// Which of these is its place, where that is a number that was fitted.
    pub place: Option<usize>,
    /// The finding in words, with its numbers.
    pub description: Description,
    /// What explains it as well, likeliest first, its own places included.
    pub rivals: Vec<Rival>,
    /// The likeliest curve that nobody has named and that explains it as well, of what has nothing
    /// to do with the time, where it is seen along the time.
    pub unnamed: Option<Rival>,
    /// Probability that noise alone fits as much better.
    pub p_value: f64,
    /// Root mean square of what it explains, in the unit of the evidence.
    pub explains: f64,
    /// How many searches without a part of the data find it again, of how many. `None` without
    /// folds, and of a mistake: it is undone before there is a model whose errors could be held
    /// out, and its odds stand in `p_value`.
    pub found_in_folds: Option<(usize, usize)>,
    /// Share of the squares of the held-out errors before that comes back where it is left out of
    /// what the others hold; negative where it does harm. `None` where `found_in_folds` is.
    pub held_out_loss: Option<f64>,
    /// Which file holds it once it is corrected; of a mistake that which it is undone in.
    pub written_to: WrittenTo,
    /// The measurement that would separate it from its rivals.
    pub next: Option<Proposal>,
    /// Its terms, the strongest first.
    pub parts: Vec<FindingPart>,
}

/// One term of a finding.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FindingPart {
    /// The candidate with its values.
    pub term: Term,
    /// Where it is, the form of its law included.
    pub location: Location,
    /// Value and 95 % interval of each of its parameters.
    pub estimates: Vec<Estimate>,
    /// Its first parameter among those of the hypothesis: where it stands in the covariance.
    pub first: usize,
    /// Posterior covariance of its values, SI.
    pub covariance: DMatrix<f64>,
    /// Half of a 95 % interval in standard deviations (GUM: coverage factor).
    pub coverage_factor: f64,
    /// Probability that noise alone fits as much better.
    pub p_value: f64,
    /// Root mean square of what it explains.
    pub explains: f64,
    /// What explains it as well, likeliest first.
    pub rivals: Vec<Rival>,
    /// True where without it the numbers of the file would have to be much farther off than their
    /// uncertainties allow: then held-out data are predicted as well by these.
    pub takes_numbers_place: bool,
    /// As [`Finding::unnamed`].
    pub unnamed: Option<Rival>,
}

/// A number with its 95 % interval, SI.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Name with its unit, for example `force_n`.
    pub name: String,
    /// The unit of the name.
    pub unit: Unit,
    /// Value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// An effect that may stand in the place of a part of a finding.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Rival {
    /// What it is.
    pub effect: &'static Effect,
    /// Where it is.
    pub location: Location,
    /// The candidate with its values; `None` of what is no candidate of the model.
    pub term: Option<Term>,
    /// The whole hypothesis with it instead, its term last; without terms where it has none.
    pub hypothesis: Hypothesis,
    /// How much less probable that hypothesis is: odds, 1 for as probable. Of another effect at its
    /// likeliest place: how much less probable it is that the effect is anywhere.
    pub odds: f64,
}

impl Rival {
    /// A rival of a finding without terms.
    pub(crate) fn without_term(effect: &'static Effect, location: Location, odds: f64) -> Rival {
        let hypothesis = Hypothesis {
            terms: Vec::new(),
            log_probability: -odds.ln(),
            sigma: 0.0,
            covariance: DMatrix::zeros(0, 0),
            background: DVector::zeros(0),
            background_covariance: DMatrix::zeros(0, 0),
            determined: 0.0,
        };
        Rival { effect, location, term: None, hypothesis, odds }
    }
}

impl Estimate {
    /// Of this name, which ends with its unit; the numbers are SI.
    pub fn new(name: impl Into<String>, value: f64, low: f64, high: f64) -> Estimate {
        let name = name.into();
        Estimate { unit: Unit::of_key(&name), name, value, low, high }
    }

    /// Of this name, whose numbers stay as they stand in a file: in the unit of the name.
    pub fn as_written(name: impl Into<String>, value: f64, low: f64, high: f64) -> Estimate {
        let new = Estimate::new(name, value, low, high);
        Estimate { unit: new.unit.as_written(), ..new }
    }

    /// In the unit of its name.
    pub fn quantity(&self) -> Quantity {
        let si = self.unit.si;
        Quantity { value: self.value / si, low: self.low / si, high: self.high / si }
    }
}

impl Finding {
    /// A finding of one part, of which nothing more is known yet.
    pub(crate) fn from_part(
        effect: &'static Effect,
        location: Location,
        estimates: Vec<Estimate>,
        part: FindingPart,
    ) -> Finding {
        Finding {
            effect,
            location,
            estimates,
            place: None,
            description: Description::default(),
            rivals: Vec::new(),
            unnamed: None,
            p_value: part.p_value,
            explains: 0.0,
            found_in_folds: None,
            held_out_loss: None,
            written_to: effect.written_to,
            next: None,
            parts: vec![part],
        }
    }

    /// A finding that is no term of a model: something that was undone before there was one.
    pub(crate) fn without_terms(
        effect: &'static Effect,
        location: Location,
        estimates: Vec<Estimate>,
        description: Description,
    ) -> Finding {
        Finding {
            effect,
            location,
            estimates,
            place: None,
            description,
            rivals: Vec::new(),
            unnamed: None,
            p_value: 0.0,
            explains: 0.0,
            found_in_folds: None,
            held_out_loss: None,
            written_to: effect.written_to,
            next: None,
            parts: Vec::new(),
        }
    }

    /// What can be weighed, gauged or looked up without any recording, and separates it from some
    /// of `rivals`: the finding, or else the likeliest such rival.
    pub fn direct_check(&self, rivals: &[&Rival]) -> Option<Proposal> {
        /// Ln odds that leave no doubt.
        const DECISIVE: f64 = 30.0;
        let effects = std::iter::once(self.effect).chain(rivals.iter().map(|rival| rival.effect));
        let checked = effects.into_iter().find(|effect| effect.direct_check.is_some())?;
        // a check of the finding separates it from all others; one of a rival only from that rival
        let is_separated = |rival: &&&Rival| match checked == self.effect {
            true => rival.effect != checked,
            false => rival.effect == checked,
        };
        let separated = rivals.iter().filter(is_separated);
        Some(Proposal {
            description: checked.direct_check?.to_owned(),
            plan: None,
            log_odds: DECISIVE,
            separates_from: separated.map(|rival| (rival.effect, rival.location.place())).collect(),
        })
    }

    /// True of what the model has terms for; false of a mistake, or a frame that moved, which was
    /// undone before there was a model.
    pub fn is_of_model(&self) -> bool {
        !self.parts.is_empty()
    }

    /// What sort of thing it is.
    pub fn kind(&self) -> Kind {
        self.effect.kind
    }

    /// The estimate of this name, in its unit.
    pub fn quantity(&self, name: &str) -> Option<Quantity> {
        self.estimates.iter().find(|estimate| estimate.name == name).map(Estimate::quantity)
    }

    /// Effects at their places that stand for it as well, likeliest first, none of them twice.
    pub fn others(&self) -> Vec<(&'static Effect, Location)> {
        let mut others = Vec::new();
        for rival in &self.rivals {
            let other = (rival.effect, rival.location.place());
            let is_itself = other.0 == self.effect && other.1 == self.location;
            if !is_itself && !others.contains(&other) {
                others.push(other);
            }
        }
        others
    }

    /// Other effects that stand for it as well, each at its likeliest place, likeliest first.
    pub fn other_effects(&self) -> Vec<(&'static Effect, Location)> {
        let mut others: Vec<(&'static Effect, Location)> = Vec::new();
        for (effect, location) in self.others() {
            if effect != self.effect && others.iter().all(|(known, _)| *known != effect) {
                others.push((effect, location));
            }
        }
        others
    }

    /// All that these data cannot distinguish from it, in words: what has no name first, then other
    /// effects, likeliest first.
    pub fn other_causes(&self) -> Vec<String> {
        let unnamed = self.unnamed.as_ref().and_then(|rival| match &rival.location {
            Location::Curve { follows, .. } => Some(format!("another cause that {follows}")),
            _ => None,
        });
        let effects = self.other_effects().into_iter();
        unnamed.into_iter().chain(effects.map(|(effect, place)| (effect.cause_at)(&place))).collect()
    }

    /// The estimate of its place, where that is a number that was fitted: where it is, and between
    /// which ends.
    pub fn place_estimate(&self) -> Option<&Estimate> {
        self.estimates.get(self.place?)
    }

    /// Other places where the same effect may be as well, likeliest first.
    pub fn other_places(&self) -> Vec<Location> {
        let same = self.others().into_iter().filter(|(effect, _)| *effect == self.effect);
        same.map(|(_, location)| location).collect()
    }
}
