//! Something that nobody has named, in the place of what changes with the time.
//!
//! Where loads rise as evenly as the time passes, a drift and a stand that gives way to the load
//! are the same to the readings. One has a name and the other has none, which says nothing of which
//! it is.

use crate::inference::columns::linearised::Linearised;
use crate::inference::score::priors::APART;
use crate::inference::search::Search;
use crate::inference::{Candidate, ForwardModel, Hypothesis, Kind, Location, Rival, Variable};

/// So many curves, the likeliest, are fitted in the place of an effect.
const TRIED: usize = 4;
/// A curve of at most so many numbers, one for each coordinate, has one shape: that is what
/// distinguishes it from an effect, not in how many coordinates that is seen.
const OF_ONE_SHAPE: usize = 3;

/// The likeliest curve over anything but the time that does as well, within 20:1, as the term at
/// `position` of a hypothesis, which the data show along the time alone; `rest` is the hypothesis
/// without it.
pub fn unnamed(
    model: &Linearised<'_>,
    search: &Search,
    (hypothesis, rest): (&Hypothesis, &Hypothesis),
    position: usize,
) -> Option<Rival> {
    let term = &hypothesis.terms[position];
    let (candidates, effect) = (model.candidates(), model.candidates()[term.candidate].effect);
    let seen_along = (effect.seen_along)(&model.location(term));
    let is_of_time = !seen_along.is_empty() && seen_along.into_iter().all(Variable::is_of_time);
    if effect.kind != Kind::Physics || !is_of_time {
        return None;
    }
    let additions = search.additions(rest);
    // what a number more costs by itself, ½·ln n (G. Schwarz, Ann. Statist. 6, 1978)
    let of_number = 0.5 * (search.degrees_of_freedom().max(1) as f64).ln();
    let cost = |index: usize| match candidates[index].parameters.len() {
        numbers @ ..=OF_ONE_SHAPE => numbers.saturating_sub(term.values.len()) as f64 * of_number,
        _ => 0.0,
    };
    let least = hypothesis.log_probability - rest.log_probability - 2.0 * APART.ln();
    let is_along_another = |index: &usize| match &candidates[*index].location {
        Location::Curve { along: Some(along), .. } => !along.is_of_time(),
        _ => false,
    };
    let near = search.likeliest(&additions, true).into_iter().filter(is_along_another);
    let near = near.take(TRIED).filter(|&index| additions[index] + cost(index) > least);
    let fitted = near.map(|index| {
        let with = search.with(rest, index);
        (with.log_probability + cost(index), with)
    });
    let (as_well, best) = fitted.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let odds = (hypothesis.log_probability - as_well).exp();
    let own = best.terms.last()?.clone();
    let Candidate { effect, location, .. } = &candidates[own.candidate];
    let rival = Rival { effect, location: location.clone(), term: Some(own), hypothesis: best, odds };
    (odds < APART).then_some(rival)
}
