//! A law that was found, with its numbers, its rivals, its picture and what would settle it.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::another_way::another_way;
use super::beyond::{apart, comparable, further};
use super::choice::Choice;
use super::measured::Measured;
use super::proposed::{Beside, Law, LawRival, NextRecord, Point};
use super::remainder::Remainder;
use super::scan::{Scan, Scanned};
use super::site::Site;
use crate::inference::model::evidence::rms;
use crate::inference::score::priors::APART;
use crate::inference::{Evidence, ForwardModel, Term};
use crate::linalg::least_squares;

/// How far beyond the data a law is asked to part from its rivals.
const BEYOND: f64 = 2.0;
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
/// Ln of the odds by which the probability of a law of several numbers may be off: they are near
/// their bounds, and of what has edges there are few points.
const UNSURE: f64 = 1.0;
/// Rivals that are reported, the likeliest, and the likeliest of every other place.
const MOST_RIVALS: usize = 8;

/// A model with what is known of its data.
#[derive(Clone, Copy)]
pub(super) struct Data<'a> {
    pub model: &'a dyn ForwardModel,
    pub evidence: &'a Evidence,
    /// The findings.
    pub terms: &'a [Term],
    /// How large, about, what is left is, m.
    pub size: f64,
    /// Noise of a datum, about, m.
    pub sigma: f64,
}

/// All that a law is described by.
pub(super) struct Known<'a> {
    pub data: Data<'a>,
    pub sites: &'a [Site],
    pub remainder: &'a Remainder<'a>,
    /// Columns of the background that are no law's.
    pub background: usize,
}

/// The first of laws that the data do not distinguish, the others as its rivals; `held_out` are
/// their errors, `curve` the ln odds of the likeliest smooth curve.
pub(super) fn described(
    known: &Known,
    class: &[&Scanned],
    held_out: &[Option<f64>],
    curve: f64,
) -> Option<Law> {
    let (all, remainder) = (known.sites, known.remainder);
    let Data { evidence, size, .. } = known.data;
    let best = class.first()?;
    let mut measured: Vec<Measured> =
        class.iter().map(|law| Measured::of(remainder, &all[law.choice.site], law, size)).collect();
    let site_of = |law: &Scanned| &all[law.choice.site];
    let is_kin = |law: &&&Scanned| {
        law.choice.form.is_kin(best.choice.form)
            && law.choice.memory.is(best.choice.memory)
            && site_of(law).variable == site_of(best).variable
    };
    let kin: Vec<(&Scanned, &Site)> = class.iter().filter(is_kin).map(|law| (*law, site_of(law))).collect();
    if let Some(own) = measured.first_mut().filter(|_| kin.len() > 1) {
        own.average(&kin);
    }
    let rivals = class.iter().zip(&measured).zip(held_out).skip(1);
    let rivals: Vec<LawRival> = rivals
        .map(|((law, measured), &held_out)| LawRival {
            site: all[law.choice.site].clone(),
            form: law.choice.form,
            memory: law.choice.memory,
            constant: measured.constant.clone(),
            values: measured.values.clone(),
            odds: (best.log_odds - law.log_odds).exp(),
            held_out,
        })
        .collect();
    let site = all[best.choice.site].clone();
    let columns = best.choice.columns(&site, best.at, size);
    let fitted = remainder.fit(&columns.columns);
    let Measured { amplitudes, constant, of_shape, correlation, values } = measured.into_iter().next()?;
    let mut law = Law {
        form: best.choice.form,
        memory: best.choice.memory,
        amplitudes,
        constant,
        of_shape,
        correlation,
        values,
        log_odds: (best.log_odds, best.log_odds - curve),
        held_out: held_out.first().copied().flatten(),
        explains: rms(&fitted.own),
        noise: fitted.sigma,
        adds: fitted.own.iter().copied().collect(),
        left: Vec::new(),
        beside: beside(known, &fitted.base),
        rivals,
        next: None,
        further: None,
        another_way: None,
        points: Vec::new(),
        curve: Vec::new(),
        more: None,
        second: None,
        site,
    };
    let residual = &evidence.residual - &fitted.predicted;
    law.left = residual.iter().copied().collect();
    law.points = points(&law, best.choice, &residual);
    law.curve = smooth(&law.points, law.site.directions.len());
    law.next = next(&law);
    law.further = further(&law, best, remainder, size);
    law.another_way = another_way(&law, best, (remainder, size));
    Some(law)
}

/// Findings and background once a law stands beside them: x = neutral + size × factor, within its
/// bounds.
fn beside(known: &Known, base: &DVector<f64>) -> Beside {
    let Data { model, evidence, terms, .. } = known.data;
    let mut next = evidence.background.ncols();
    let background = base.rows(0, known.background).iter().copied().collect();
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

/// The best law and all that are not 20 times less likely, or as much more as the odds are unsure.
pub(super) fn alike<'a>(found: &'a Scan, best: &Scanned) -> Vec<&'a Scanned> {
    let unsure = if best.choice.has_shape() { UNSURE } else { 0.0 };
    let near = found.laws.iter().take_while(|law| law.log_odds > best.log_odds - APART.ln() - unsure);
    let mut sites = Vec::new();
    // many forms of one place do not hide another place
    let is_said = |(number, law): &(usize, &Scanned)| {
        let is_new = !sites.contains(&law.choice.site);
        sites.push(law.choice.site);
        is_new || *number <= MOST_RIVALS
    };
    near.enumerate().filter(is_said).map(|(_, law)| law).collect()
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
