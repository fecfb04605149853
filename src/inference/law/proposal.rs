//! A law for what is left, or why none is proposed.

use nalgebra::{DMatrix, DVector};

use super::choice::Choice;
use super::described::{Data, Known, alike, described};
use super::folds::{WORTH, hold_out};
use super::left::{Alone, Left, gain_beside, left_beside};
use super::pairs::beginning;
use super::proposed::{Law, Proposed, Refusal};
use super::remainder::Remainder;
use super::scan::{prior, refit, scan, scan_as_predicted};
use super::site::Site;
use crate::inference::model::evidence::rms;
use crate::inference::noise::scatter::weighted;
use crate::inference::score::priors::NAMED;
use crate::inference::{Diagnosis, Evidence, ForwardModel, ShownBy, Term};

/// Laws whose ln odds are so far behind the best are not tried again without each fold.
const REACH: f64 = 30.0;
/// Nor those whose ln odds against nothing are below this: without a fold they are no better.
const UNLIKELY: f64 = -5.0;
/// A smooth curve may miss so much of what a law explains, as a share of squares.
const LITTLE: f64 = 0.5;

/// A law for what `diagnosis` left unexplained; `None` where nothing was, or where what is left is
/// no law's: single readings, numbers of a file, errors that wander. `sites` are all places for it,
/// given what findings and nominal numbers change of each datum.
pub fn propose(
    model: &dyn ForwardModel,
    diagnosis: &Diagnosis,
    sites: &dyn Fn(&DVector<f64>) -> Vec<Site>,
) -> Option<Proposed> {
    propose_where(model, diagnosis, sites, &|_| true)
}

/// The same, but `None` where `is_hopeful` denies what the likeliest law leaves of the data, before
/// any law is held out: that takes longer than to find it.
pub fn propose_where(
    model: &dyn ForwardModel,
    diagnosis: &Diagnosis,
    sites: &dyn Fn(&DVector<f64>) -> Vec<Site>,
    is_hopeful: &dyn Fn(&DVector<f64>) -> bool,
) -> Option<Proposed> {
    let left = diagnosis.discrepancy.as_ref()?;
    if matches!(left.shown_by, ShownBy::Suspects | ShownBy::Numbers | ShownBy::Neighbours) {
        return None;
    }
    // a curve draws what any law would
    let most = left.rms.powi(2) / rms(&diagnosis.after).powi(2).max(f64::MIN_POSITIVE);
    if left.shown_by == ShownBy::Curve && most < LITTLE * WORTH {
        return Some(Proposed { law: Err(Refusal::Little), lives: None, held_out: None });
    }
    let (settled, sigma) = (&diagnosis.settled.0, diagnosis.settled.1);
    let (terms, size) =
        (&diagnosis.hypothesis.terms[..], rms(&diagnosis.after).max(f64::MIN_POSITIVE.sqrt()));
    let rows = || (0..settled.residual.len()).collect::<Vec<usize>>();
    let response = model.response(terms);
    let known = known(model, diagnosis, left.candidate);
    let change = response + known;
    let mut all = sites(&change);
    // where no curve was taken out what is left has counted as scatter, and the data that show it
    // most hardly count
    let evidence = &match left.shown_by == ShownBy::Curve || !settled.is_robust {
        true => settled.as_ref().clone(),
        false => {
            let even =
                Evidence { weight: settled.even_weight(), information: 1.0, ..settled.as_ref().clone() };
            reweighted(model, &even, terms, &all, (size, sigma)).unwrap_or(even)
        }
    };
    let remainder = Remainder::new(model, evidence, terms, rows(), sigma);
    let mut found = scan_as_predicted(&remainder, &mut all, size, |_| true);
    let best_odds = found.laws.first().map_or(0.0, |law| law.log_odds);
    let reach = (best_odds - REACH).max(UNLIKELY);
    let within_reach = found.laws.iter().take_while(|law| law.log_odds > reach);
    let tried: Vec<Choice> = within_reach.map(|law| law.choice).collect();
    refit(&mut found, &remainder, &all, size);
    let lives = found.curve.map(|(site, _)| (all[site].location.clone(), all[site].variable.clone()));
    let refused = |refusal, held_out| Some(Proposed { law: Err(refusal), lives: lives.clone(), held_out });
    let Some(best) = found.laws.first() else { return refused(Refusal::Chance, None) };
    if best.log_odds < NAMED.ln() {
        return refused(Refusal::Chance, None);
    }
    let columns = best.choice.columns(&all[best.choice.site], best.at, size).columns;
    if !is_hopeful(&(&evidence.residual - remainder.fit(&columns).predicted)) {
        return None;
    }
    let data = Data { model, evidence, terms, size, sigma };
    // the curve that the diagnosis has found competes too; of one number it is a law itself
    let is_curve = |&candidate: &usize| model.candidates()[candidate].parameters.len() > 1;
    let own_curve = left.candidate.filter(is_curve).map_or(f64::NEG_INFINITY, |curve| {
        let curve = model.columns(&[model.candidates()[curve].neutral(curve)], 0);
        let curves = model.candidates().iter().filter(|candidate| candidate.is_nonparametric);
        let prior = prior(curves.count(), 1);
        // what the law says as well is no other than it: a wave that was found among a few periods
        match gain_beside(&data, &columns, &curve) + prior > 0.0 {
            true => remainder.fit(&curve).gain + prior,
            false => f64::NEG_INFINITY,
        }
    });
    let curve_odds = found.curve.map_or(own_curve, |(_, odds)| odds.max(own_curve));
    // two laws may make the curve together
    let behind = curve_odds - best.log_odds;
    let class = alike(&found, best);
    let choices: Vec<Choice> = class.iter().map(|law| law.choice).collect();
    let folds = hold_out(&data, &all, (&choices, &tried));
    let Some(folds) = folds else { return refused(Refusal::NoFolds, None) };
    let errors = Some((folds.without, folds.with));
    let known = Known { data, sites: &all, remainder: &remainder, background: evidence.background.ncols() };
    let beside = |alone: &Alone| left_beside(&known, alone, |own| sites(&(&change + own)));
    // two laws of one memory make something together that neither is
    let likeliest = curve_odds.max(best.log_odds);
    if let Some(first) = beginning(&known, &found, likeliest + NAMED.ln()) {
        let alone = Alone { class: &[&first], held_out: &[], curve: curve_odds };
        if let Left::Laws(law, second) = beside(&alone) {
            let is_likelier = law.log_odds.1 > likeliest - curve_odds + NAMED.ln();
            let with = second.held_out.1;
            if is_likelier && folds.is_lower(with) {
                let (law, held_out) = (Law { second: Some(second), ..*law }, Some((folds.without, with)));
                return Some(Proposed { law: Ok(law), lives, held_out });
            }
        }
    }
    let is_lower = folds.is_lower(folds.with) && folds.is_lower(folds.own[0]);
    if behind <= 0.0 && !is_lower {
        return refused(Refusal::HeldOut, errors);
    }
    let left = match is_lower {
        true => beside(&Alone { class: &class, held_out: &folds.own, curve: curve_odds }),
        false => Left::Nothing,
    };
    let more = match left {
        Left::Laws(first, second) if first.log_odds.1 > if behind > 0.0 { NAMED.ln() } else { 0.0 } => {
            let law = Law { second: Some(second), ..*first };
            return Some(Proposed { law: Ok(law), lives, held_out: errors });
        }
        _ if behind > 0.0 => return refused(Refusal::Curve(behind), None),
        Left::Nothing => None,
        Left::Something(location, variable) => Some((location, variable)),
        Left::Laws(_, second) => Some((second.law.site.location, second.law.site.variable)),
    };
    let own_errors: Vec<Option<f64>> = folds.own.iter().copied().map(Some).collect();
    let Some(law) = described(&known, &class, &own_errors, curve_odds) else {
        return refused(Refusal::Chance, None);
    };
    let law = Law { more, ..law };
    Some(Proposed { law: Ok(law), lives, held_out: errors })
}

/// What nominal numbers change of each datum, once a curve stands for what is left.
fn known(model: &dyn ForwardModel, diagnosis: &Diagnosis, curve: Option<usize>) -> DVector<f64> {
    let (evidence, sigma) = (&diagnosis.settled.0, diagnosis.settled.1);
    let rows: Vec<usize> = (0..evidence.residual.len()).collect();
    let columns = match curve {
        Some(curve) => model.columns(&[model.candidates()[curve].neutral(curve)], 0),
        None => DMatrix::zeros(rows.len(), 0),
    };
    Remainder::new(model, evidence, &diagnosis.hypothesis.terms, rows, sigma).fit(&columns).background
}

/// An evidence with the weights that its data have once the likeliest law is taken out.
fn reweighted(
    model: &dyn ForwardModel,
    even: &Evidence,
    terms: &[Term],
    sites: &[Site],
    (size, sigma): (f64, f64),
) -> Option<Evidence> {
    let remainder = Remainder::new(model, even, terms, (0..even.residual.len()).collect(), sigma);
    let found = scan(&remainder, sites, size);
    let best = found.laws.first()?;
    let columns = best.choice.columns(&sites[best.choice.site], best.at, size);
    let left = &even.residual - remainder.fit(&columns.columns).predicted;
    let (weight, information) = weighted(even, &remainder.without_shared(&left));
    Some(Evidence { weight, information, ..even.clone() })
}
