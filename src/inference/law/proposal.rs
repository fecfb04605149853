//! A law for what is left, or why none is proposed.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::choice::Choice;
use super::folds::{WORTH, hold_out};
use super::form::FormConstant;
use super::left::most_left;
use super::measured::Measured;
use super::proposed::{Beside, Law, LawRival, NextRecord, Point, Proposed, Refusal};
use super::remainder::Remainder;
use super::scan::{Scan, Scanned, curve, prior, scan, scan_as_recorded};
use super::site::Site;
use crate::inference::evidence::rms;
use crate::inference::scatter::weighted;
use crate::inference::selection::{APART, NAMED};
use crate::inference::{Diagnosis, Evidence, ForwardModel, ShownBy, Term};
use crate::linalg::least_squares;

/// How far beyond the data a law is asked to part from its rivals.
const BEYOND: f64 = 2.0;
/// How far beyond the data it is said how far laws are apart.
const FURTHER: f64 = 1.5;
/// How far apart they have to be, in standard deviations of a reading.
const PARTED: f64 = 4.0;
/// Points between nothing and [`BEYOND`].
const STEPS: usize = 80;
/// Cosines of a smooth curve in a picture.
const CURVE: usize = 6;
/// Points of a curve in a picture.
const POINTS: usize = 60;
/// Data that the law moves by less than this share of the largest are not drawn.
const DRAWN: f64 = 0.2;
/// Of so many laws, the likeliest, all else is fitted anew.
const REFITTED: usize = 16;
/// Laws whose ln odds are so far behind the best are not tried again without each fold.
const REACH: f64 = 30.0;
/// Nor those whose ln odds against nothing are below this: without a fold they are no better.
const UNLIKELY: f64 = -5.0;
/// A smooth curve may miss so much of what a law explains, as a share of squares.
const LITTLE: f64 = 0.5;
/// Most rivals that are reported.
const MOST_RIVALS: usize = 8;

/// A law for what `diagnosis` left unexplained; `None` where nothing was, or where what is left is
/// no law's: single readings, numbers of a file. `sites` are all places for it, given what
/// findings, nominal numbers and zeros change of each datum.
pub fn propose(
    model: &dyn ForwardModel,
    diagnosis: &Diagnosis,
    sites: &dyn Fn(&DVector<f64>) -> Vec<Site>,
) -> Option<Proposed> {
    let left = diagnosis.discrepancy.as_ref()?;
    if matches!(left.shown_by, ShownBy::Suspects | ShownBy::Numbers) {
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
            let even = Evidence {
                weight: vec![1.0; settled.residual.len()],
                information: 1.0,
                ..settled.as_ref().clone()
            };
            reweighted(model, &even, terms, &all, (size, sigma)).unwrap_or(even)
        }
    };
    let remainder = Remainder::new(model, evidence, terms, rows(), sigma);
    let mut found = scan_as_recorded(&remainder, &mut all, (size, sigma));
    let best_odds = found.laws.first().map_or(0.0, |law| law.log_odds);
    let reach = (best_odds - REACH).max(UNLIKELY);
    let within_reach = found.laws.iter().take_while(|law| law.log_odds > reach);
    let tried: Vec<Choice> = within_reach.map(|law| law.choice).collect();
    refit(&mut found, &remainder, &all, size);
    let lives = found.curve.map(|(site, _)| (all[site].location.clone(), all[site].variable.clone()));
    let refused = |refusal, held_out| Some(Proposed { law: Err(refusal), lives: lives.clone(), held_out });
    // the curve that the diagnosis has found competes too; of one number it is a law itself
    let is_curve = |&candidate: &usize| model.candidates()[candidate].parameters.len() > 1;
    let own_curve = left.candidate.filter(is_curve).map_or(f64::NEG_INFINITY, |curve| {
        let term = model.candidates()[curve].neutral(curve);
        let curves = model.candidates().iter().filter(|candidate| candidate.is_nonparametric);
        remainder.fit(&model.columns(&[term], 0)).gain + prior(curves.count(), 1)
    });
    let curve_odds = found.curve.map_or(own_curve, |(_, odds)| odds.max(own_curve));
    let Some(best) = found.laws.first() else { return refused(Refusal::Chance, None) };
    if best.log_odds < NAMED.ln() {
        return refused(Refusal::Chance, None);
    }
    if best.log_odds < curve_odds {
        return refused(Refusal::Curve(curve_odds - best.log_odds), None);
    }
    let class = alike(&found, best);
    let choices: Vec<Choice> = class.iter().map(|law| law.choice).collect();
    let folds = hold_out(model, evidence, terms, &all, (&choices, &tried), (size, sigma));
    let Some(folds) = folds else { return refused(Refusal::NoFolds, None) };
    let errors = Some((folds.without, folds.with));
    if !(folds.is_lower(folds.with) && folds.is_lower(folds.of[0])) {
        return refused(Refusal::HeldOut, errors);
    }
    let measured: Vec<Measured> =
        class.iter().map(|law| Measured::of(&remainder, &all[law.choice.site], law, size)).collect();
    let rivals = class.iter().zip(&measured).zip(&folds.of).skip(1);
    let rivals: Vec<LawRival> = rivals
        .map(|((law, measured), &held_out)| LawRival {
            site: all[law.choice.site].clone(),
            form: law.choice.form,
            memory: law.choice.memory,
            constant: measured.constant.clone(),
            values: measured.values.clone(),
            odds: (best.log_odds - law.log_odds).exp(),
            held_out: Some(held_out),
        })
        .collect();
    let data = (model, evidence, terms, (size, sigma));
    let site = all[best.choice.site].clone();
    let columns = best.choice.columns(&site, best.at, size);
    let fitted = remainder.fit(&columns.columns);
    let Measured { amplitudes, constant, values } = measured.into_iter().next()?;
    let mut law = Law {
        form: best.choice.form,
        memory: best.choice.memory,
        amplitudes,
        constant,
        values,
        log_odds: (best.log_odds, best.log_odds - curve_odds),
        held_out: folds.of.first().copied(),
        explains: rms(&fitted.own),
        noise: fitted.sigma,
        adds: fitted.own.iter().copied().collect(),
        beside: beside(model, evidence, terms, &fitted.base),
        rivals,
        next: None,
        further: None,
        points: Vec::new(),
        curve: Vec::new(),
        more: most_left(data, &all, best, |own| sites(&(&change + own))),
        site,
    };
    let residual = &evidence.residual - &fitted.predicted;
    law.points = points(&law, best.choice, &residual);
    law.curve = smooth(&law.points, law.site.directions.len());
    law.next = next(&law);
    law.further = further(&law);
    Some(Proposed { law: Ok(law), lives, held_out: errors })
}

/// Findings and background once a law stands beside them: x = neutral + size × factor, within its
/// bounds.
fn beside(model: &dyn ForwardModel, evidence: &Evidence, terms: &[Term], base: &DVector<f64>) -> Beside {
    let mut next = evidence.background.ncols();
    let background = base.rows(0, next).iter().copied().collect();
    let mut terms = terms.to_vec();
    for term in &mut terms {
        let parameters = &model.candidates()[term.candidate].parameters;
        for (value, parameter) in term.values.iter_mut().zip(parameters) {
            let (low, high) = parameter.bounds;
            *value = (parameter.neutral + parameter.size * base[next]).clamp(low, high);
            next += 1;
        }
    }
    Beside { terms, background }
}

/// What nominal numbers and zeros are, once a curve stands for what is left.
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
    let (weight, information) = weighted(&remainder.without_shared(&left), even.rounding());
    Some(Evidence { weight, information, ..even.clone() })
}

/// The likeliest laws and the curve, all else fitted anew with each at its best; the others go.
fn refit(found: &mut Scan, remainder: &Remainder, sites: &[Site], size: f64) {
    found.laws.truncate(REFITTED);
    for law in &mut found.laws {
        let columns = law.choice.columns(&sites[law.choice.site], law.at, size).columns;
        law.log_odds += remainder.fit(&columns).gain - remainder.gain(&columns);
    }
    found.laws.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    if let Some((site, log_odds)) = &mut found.curve {
        let columns = curve(&sites[*site], size);
        *log_odds += remainder.fit(&columns).gain - remainder.gain(&columns);
    }
}

/// The best law and all that are not 20 times less likely.
fn alike<'a>(found: &'a Scan, best: &Scanned) -> Vec<&'a Scanned> {
    let near = found.laws.iter().take_while(|law| law.log_odds > best.log_odds - APART.ln());
    near.take(1 + MOST_RIVALS).collect()
}

/// What the law follows, and what each datum says of its result there.
fn points(law: &Law, choice: Choice, residual: &DVector<f64>) -> Vec<Point> {
    let (followed, sign) = choice.memory.remembered(&law.site, law.values.1);
    let mut points = Vec::new();
    for (direction, (_, weights)) in law.site.directions.iter().enumerate() {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        for (i, &x) in followed.iter().enumerate() {
            let weight = weights[i] * sign.map_or(1.0, |moves| moves[i]);
            if x.is_finite() && weight.abs() > DRAWN * largest && weight != 0.0 {
                points.push(Point { direction, x, value: law.at(direction, x) + residual[i] / weight });
            }
        }
    }
    points
}

/// A smooth curve through the points of each direction: Σ a_j·cos(πjx) by least squares.
fn smooth(points: &[Point], directions: usize) -> Vec<Point> {
    let mut curve = Vec::new();
    for direction in 0..directions {
        let own: Vec<&Point> = points.iter().filter(|point| point.direction == direction).collect();
        let ends = own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p.x), b.max(p.x)));
        let wave = |x: f64, j: usize| (PI * j as f64 * (x - ends.0) / (ends.1 - ends.0)).cos();
        let mut xs: Vec<f64> = own.iter().map(|point| point.x).collect();
        xs.sort_by(f64::total_cmp);
        xs.dedup();
        let count = xs.len().min(CURVE);
        let columns = DMatrix::from_fn(own.len(), count, |i, j| wave(own[i].x, j));
        let values = DVector::from_iterator(own.len(), own.iter().map(|point| point.value));
        let Ok(factors) = least_squares(&columns, &values) else { continue };
        for k in 0..=POINTS {
            let x = ends.0 + (ends.1 - ends.0) * k as f64 / POINTS as f64;
            let value = (0..count).map(|j| factors[j] * wave(x, j)).sum();
            curve.push(Point { direction, x, value });
        }
    }
    curve
}

/// Where the law and a rival at its place part first, what zeros and stiffnesses take up apart:
/// between the data if they do, or else beyond them.
fn next(law: &Law) -> Option<NextRecord> {
    let (low, high) = law.site.range();
    let (number, rival) = comparable(law).next()?;
    let apart = |x: f64| apart(law, rival, x);
    let least = low.min(0.0);
    let x = |k: usize| least + (BEYOND * high - least) * k as f64 / STEPS as f64;
    let within = (0..=STEPS).map(x).filter(|x| *x <= high).max_by(|a, b| apart(*a).total_cmp(&apart(*b)));
    let far = |x: &f64| apart(*x) > PARTED * law.noise;
    let at = within.filter(far).or_else(|| (0..=STEPS).map(x).filter(|x| *x > high).find(far))?;
    Some(NextRecord { rival: number, at, is_beyond: at > high, apart: apart(at) })
}

/// How far the law is apart beyond the data from its rivals at its place, and a wave from itself
/// with another period: the variable there, and the largest distance, m.
fn further(law: &Law) -> Option<(f64, f64)> {
    let at = FURTHER * law.site.range().1;
    let distances = comparable(law).map(|(_, rival)| apart(law, rival, at));
    distances.chain(out_of_step(law)).reduce(f64::max).map(|most| (at, most))
}

/// How far a wave may be from what goes on half again beyond its data, m. Its phase is known in
/// their middle: from there on it is out of step by φ = 2π·X·(1/P_low − 1/P_high)/2, and by a
/// distance 2·A·sin(φ/2); of several periods by as much as there is.
fn out_of_step(law: &Law) -> Option<f64> {
    let Some((FormConstant::Period, period)) = &law.constant else { return None };
    let count = law.form.count();
    let amplitudes = law.values.0.chunks(count).zip(&law.site.directions).map(|(own, (_, weights))| {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        own.iter().map(|a| a * a).sum::<f64>().sqrt() * largest
    });
    let largest = law.site.largest() / law.site.variable.si;
    let phase = match period.also.is_empty() {
        true => PI * largest * (1.0 / period.low - 1.0 / period.high),
        false => PI,
    };
    amplitudes.reduce(f64::max).map(|amplitude| 2.0 * amplitude * (0.5 * phase.min(PI)).sin())
}

/// Rivals with their numbers that differ from the law in nothing but form and constants.
fn comparable(law: &Law) -> impl Iterator<Item = (usize, &LawRival)> {
    let is_alike = |rival: &LawRival| {
        rival.memory == law.memory
            && rival.site.location == law.site.location
            && rival.site.result == law.site.result
            && rival.site.variable == law.site.variable
    };
    law.rivals.iter().enumerate().filter(move |(_, rival)| is_alike(rival))
}

/// How far two laws are apart at x, m, but for what zeros and stiffnesses take up.
fn apart(law: &Law, rival: &LawRival, x: f64) -> f64 {
    let per_result =
        law.site.directions.iter().flat_map(|(_, w)| w).fold(0.0, |most: f64, w| most.max(w.abs()));
    let of_direction = |direction: usize| {
        let (level, slope) = taken_up(law, rival, direction);
        (law.at(direction, x) - rival.at(direction, x) - level - slope * x).abs() * per_result
    };
    (0..law.site.directions.len()).map(of_direction).fold(0.0, f64::max)
}

/// What zeros and stiffnesses take up of the difference of two laws: the straight line through it
/// at the data. Level and slope.
fn taken_up(law: &Law, rival: &LawRival, direction: usize) -> (f64, f64) {
    let own: Vec<f64> = law.points.iter().filter(|p| p.direction == direction).map(|p| p.x).collect();
    let columns = DMatrix::from_fn(own.len(), 2, |i, j| if j == 0 { 1.0 } else { own[i] });
    let differences = own.iter().map(|&x| law.at(direction, x) - rival.at(direction, x));
    let values = DVector::from_iterator(own.len(), differences);
    least_squares(&columns, &values).map_or((0.0, 0.0), |line| (line[0], line[1]))
}
