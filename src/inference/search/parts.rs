//! One term of a hypothesis as it is reported: its interval, whatever else may be there, and its
//! rivals.

use crate::inference::columns::linearised::Linearised;
use crate::inference::score::priors::{APART, rarity};
use crate::inference::search::Search;
use crate::inference::search::unnamed::unnamed;
use crate::inference::{
    Candidate, Effect, Estimate, FindingPart, ForwardModel, Hypothesis, Location, Parameter, Rival, Term,
};
use crate::statistics::{HALF_95, chi_squared_survival, student_t_quantile};

/// So many of the effects that may be there besides count for an interval.
const AVERAGED: usize = 8;
/// How well the evidence of an effect is known by its columns at neutral values, as a share of it;
/// and so many effects, the likeliest by that, are fitted in place of another one.
const ABOUT: f64 = 0.3;
const TRIED: usize = 8;
/// A form of a law that leaves at most so much more, as a factor, may be the right one.
const HARDLY_MORE: f64 = 1.1;

/// One term with its interval and its rivals. What is left unexplained, a curve of the hypothesis
/// `beside`, may be a part of it or not: the interval holds both.
pub fn part(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    beside: Option<&Hypothesis>,
) -> FindingPart {
    let term = &hypothesis.terms[position];
    let candidates = model.candidates();
    let rest = search.without(hypothesis, position);
    let first = first_of(hypothesis, position);
    let coverage_factor = coverage_factor_of(search, hypothesis);
    let mut estimates = estimates(model, search, hypothesis, position, beside, coverage_factor);
    // which form of a law is the right one is not known where another one leaves hardly more
    for form in search.other_forms(term.candidate) {
        let other = search.with(&rest, form);
        if search.left_rms(&other) > HARDLY_MORE * search.left_rms(hypothesis) {
            continue;
        }
        let Some(own) = other.terms.last() else { continue };
        let at = other.covariance.nrows() - own.values.len();
        widen(&mut estimates, intervals(model, &other, own, at, coverage_factor));
    }
    // candidates that would do in its place
    let additions = search.additions(&rest);
    // by the same measure as what was found: without it, what else the hypothesis holds is less
    // certain than with it
    let gained = (hypothesis.log_probability - rest.log_probability).min(additions[term.candidate]);
    let least = gained - 2.0 * APART.ln();
    // what a large effect comes to is only about known before it is fitted
    let nearly = gained - (2.0 * APART.ln()).max(ABOUT * gained);
    // a mistake is as rare as it is easily looked up, and so is an effect of little weight: neither
    // is less of a rival
    let rare = rarity(candidates);
    let own = candidates[term.candidate].effect;
    let many = in_many_places(candidates, &additions);
    let places_of = |effect: &Effect| {
        many.iter().find(|(best, _)| candidates[*best].effect == effect).copied().unwrap_or((0, 1.0))
    };
    let of_own = places_of(own).1;
    // an effect against another one, each wherever it may be
    let places = |index: usize| match places_of(candidates[index].effect) {
        (best, of_other) if best == index && candidates[index].effect != own => of_other / of_own,
        _ => 1.0,
    };
    let is_above = |index: usize, least: f64| additions[index] + (places(index) / rare[index]).ln() > least;
    let mut near = search.likeliest(&additions, false);
    near.retain(|&index| index != term.candidate && is_above(index, nearly));
    let surely = near.iter().filter(|&&index| is_above(index, least)).count();
    near.truncate(surely.max(TRIED));
    let mut rivals: Vec<Rival> = near
        .into_iter()
        .filter_map(|index| {
            let other = search.with(&rest, index);
            let factor = rare[index] / places(index);
            let odds = (hypothesis.log_probability - other.log_probability).exp() * factor;
            let own = other.terms.last()?.clone();
            let (effect, location) = (candidates[index].effect, model.location(&own));
            Some(Rival { effect, location, term: Some(own), hypothesis: other, odds })
        })
        .filter(|rival| rival.odds < APART)
        .collect();
    rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
    // nor is it known which of several places along one part is the right one
    let is_along = |location: &Location| matches!(location, Location::Named(_) | Location::Station(_));
    for rival in rivals.iter().filter(|rival| rival.effect == own && is_along(&rival.location)) {
        if is_along(&candidates[term.candidate].location) {
            let Some(other) = &rival.term else { continue };
            let at = rival.hypothesis.covariance.nrows() - other.values.len();
            widen(&mut estimates, intervals(model, &rival.hypothesis, other, at, coverage_factor));
        }
    }
    let gained = search.deviance(&rest, hypothesis.sigma) - search.deviance(hypothesis, hypothesis.sigma);
    // a curve has more parameters than the data determine of it
    let determined = (hypothesis.determined - rest.determined).clamp(1.0, term.values.len().max(1) as f64);
    FindingPart {
        term: term.clone(),
        location: model.location(term),
        estimates,
        first,
        covariance: {
            let count = term.values.len();
            hypothesis.covariance.view((first, first), (count, count)).into_owned()
        },
        coverage_factor,
        p_value: chi_squared_survival(gained.max(0.0), determined).unwrap_or(1.0),
        explains: explained(search, &rest, hypothesis),
        rivals,
        takes_numbers_place: search.takes_numbers_place(hypothesis, position),
        unnamed: unnamed(model, search, (hypothesis, &rest), position),
    }
}

/// For each effect its likeliest candidate, and how much likelier than that it is that the effect
/// is there at all, in any of its places and forms: Σ exp(aᵢ − a_best), a the ln of what it adds.
fn in_many_places(candidates: &[Candidate], additions: &[f64]) -> Vec<(usize, f64)> {
    let mut best: Vec<(usize, f64)> = Vec::new();
    for (index, &added) in additions.iter().enumerate().filter(|(_, added)| **added > f64::NEG_INFINITY) {
        match best.iter_mut().find(|(other, _)| candidates[*other].effect == candidates[index].effect) {
            None => best.push((index, 1.0)),
            Some((other, sum)) if added > additions[*other] => {
                (*other, *sum) = (index, 1.0 + *sum * (additions[*other] - added).exp());
            }
            Some((other, sum)) => *sum += (added - additions[*other]).exp(),
        }
    }
    best
}

/// How many standard deviations a 95 % interval is, by the degrees of freedom that a hypothesis
/// leaves.
pub fn coverage_factor_of(search: &Search, hypothesis: &Hypothesis) -> f64 {
    let degrees_of_freedom = (search.degrees_of_freedom() as f64 - hypothesis.determined).max(1.0);
    student_t_quantile(0.975, degrees_of_freedom).unwrap_or(HALF_95)
}

/// Where the parameters of a term begin among all of a hypothesis.
fn first_of(hypothesis: &Hypothesis, position: usize) -> usize {
    hypothesis.terms[..position].iter().map(|term| term.values.len()).sum()
}

/// Value and interval of the parameters of a term, with what else may be there, and with the curve
/// `beside`.
pub fn estimates(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    beside: Option<&Hypothesis>,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let (term, first) = (&hypothesis.terms[position], first_of(hypothesis, position));
    let mut estimates = averaged(model, search, hypothesis, position, first, coverage_factor);
    let own =
        |other: &Hypothesis| other.terms.get(position).filter(|own| own.candidate == term.candidate).cloned();
    if let Some((longer, own)) = beside.and_then(|longer| Some((longer, own(longer)?))) {
        widen(&mut estimates, intervals(model, longer, &own, first, coverage_factor));
    }
    estimates
}

/// Value and 95 % interval of the parameters of a term, whatever else may be there besides: the
/// hypotheses with one effect or curve more, Y, have their share p in it (J. A. Hoeting et
/// al., *Statistical Science* 14 (1999) 382–417, Eq 3),
///
/// ```text
/// var x = Σ p_Y·(s_Y² + (x_Y − x)²)
/// ```
fn averaged(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    first: usize,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let term = &hypothesis.terms[position];
    let additions = search.additions(hypothesis);
    let is_possible = |index: &usize| additions[*index] > -APART.ln();
    let mut likeliest: Vec<usize> = (0..additions.len()).filter(is_possible).collect();
    likeliest.sort_by(|&a, &b| additions[b].total_cmp(&additions[a]));
    likeliest.truncate(AVERAGED);
    let others: Vec<Hypothesis> = likeliest.into_iter().map(|index| search.with(hypothesis, index)).collect();
    let share = |other: &Hypothesis| (other.log_probability - hypothesis.log_probability).min(0.0).exp();
    let mut estimates = intervals(model, hypothesis, term, first, coverage_factor);
    let parameters = &model.candidates()[term.candidate].parameters;
    for (k, (estimate, parameter)) in estimates.iter_mut().zip(parameters).enumerate() {
        let variance = |hypothesis: &Hypothesis| hypothesis.covariance[(first + k, first + k)].max(0.0);
        let (mut total, mut weight) = (variance(hypothesis), 1.0);
        for other in &others {
            let off = other.terms[position].values[k] - term.values[k];
            total += share(other) * (variance(other) + off * off);
            weight += share(other);
        }
        let half = coverage_factor * (total / weight).sqrt();
        let (low, high) = parameter.bounds;
        (estimate.low, estimate.high) = ((term.values[k] - half).max(low), (term.values[k] + half).min(high));
    }
    estimates
}

/// Makes intervals hold those of another hypothesis.
fn widen(estimates: &mut [Estimate], others: Vec<Estimate>) {
    let named = |known: &Estimate| others.iter().find(|other| other.name == known.name);
    for known in estimates {
        let Some(other) = named(known) else { continue };
        (known.low, known.high) = (known.low.min(other.low), known.high.max(other.high));
    }
}

/// By how much the residual of a hypothesis is less than that of a shorter one, root of the
/// difference of their mean squares: what the base model would take up is explained by nothing
/// else.
pub fn explained(search: &Search, shorter: &Hypothesis, hypothesis: &Hypothesis) -> f64 {
    let squares = search.left_rms(shorter).powi(2) - search.left_rms(hypothesis).powi(2);
    squares.max(0.0).sqrt()
}

/// Value and 95 % interval of the parameters of a term, which begin at `first` in the covariance of
/// its hypothesis.
fn intervals(
    model: &Linearised<'_>,
    hypothesis: &Hypothesis,
    term: &Term,
    first: usize,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let parameters = &model.candidates()[term.candidate].parameters;
    let interval = |(k, (&value, parameter)): (usize, (&f64, &Parameter))| {
        let variance = hypothesis.covariance[(first + k, first + k)];
        let half = coverage_factor * variance.max(0.0).sqrt();
        let (low, high) = parameter.bounds;
        let (name, unit) = (parameter.name.clone(), parameter.unit);
        let (low, high) = ((value - half).max(low), (value + half).min(high));
        Estimate { name, unit, value, low, high }
    };
    term.values.iter().zip(parameters).enumerate().map(interval).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::Columns;

    /// Three places of a half each and one of the whole are two and a half times the best of them;
    /// one that is there already is in no place more.
    #[test]
    fn an_effect_is_as_likely_as_all_its_places_together() {
        let mut model = Columns::new(1);
        for (effect, place) in
            [("hinge", "a"), ("slide", "b"), ("hinge", "c"), ("hinge", "d"), ("hinge", "e")]
        {
            model.add(effect, place, DMatrix::from_element(1, 1, 1.0), false);
        }
        let half = 0.5f64.ln();
        let found = in_many_places(&model.candidates, &[half, 3.0, 0.0, half, half]);
        assert_eq!(found.iter().map(|(best, _)| *best).collect::<Vec<_>>(), [2, 1]);
        assert!((found[0].1 - 2.5).abs() < 1e-12 && found[1].1 == 1.0);
        let found = in_many_places(&model.candidates, &[f64::NEG_INFINITY, 3.0, 0.0, half, half]);
        assert!(found[1].0 == 2 && (found[1].1 - 2.0).abs() < 1e-12);
    }
}
