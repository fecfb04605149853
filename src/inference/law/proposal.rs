//! A law for what is left, or why none is proposed.

use nalgebra::DVector;

use super::choice::{Choice, LawColumns};
use super::folds::hold_out;
use super::form::{Constant, Form, FormConstant};
use super::memory::Memory;
use super::remainder::Remainder;
use super::scan::{Scan, Scanned, curve, scan};
use super::site::{Measure, Site};
use crate::inference::evidence::rms;
use crate::inference::selection::{APART, NAMED};
use crate::inference::{Diagnosis, ForwardModel, Location, ShownBy, Term};
use crate::statistics::student_t_quantile;

/// What was made of what is left.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Proposed {
    /// The law, if there is one.
    pub law: std::result::Result<Law, Refusal>,
    /// Along which variable, and where, a smooth curve explains most.
    pub lives: Option<(Location, Measure)>,
    /// Held-out error with the findings alone, and with what the search for a law finds without
    /// each fold besides, m; `None` where nothing was held out.
    pub held_out: Option<(f64, f64)>,
}

/// Why there is no law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// None is likelier than chance by the odds of a name.
    Chance,
    /// A smooth curve is likelier than the likeliest of all laws, by so many times (ln).
    Curve(f64),
    /// Held-out errors are not lowered.
    HeldOut,
    /// Nothing could be held out.
    NoFolds,
}

/// A law with its numbers.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Law {
    /// Where, and the number it is a function of.
    pub site: Site,
    /// What it looks like.
    pub form: Form,
    /// What it remembers.
    pub memory: Memory,
    /// Its amplitudes, one for each function and direction, direction by direction.
    pub amplitudes: Vec<Constant>,
    /// Its number that is not linear.
    pub constant: Option<(FormConstant, Constant)>,
    /// The same as numbers: amplitudes (SI) of each direction's functions, s.
    pub values: (Vec<f64>, f64),
    /// Ln of its odds against nothing, and against the likeliest smooth curve.
    pub log_odds: (f64, f64),
    /// Its own held-out error, m.
    pub held_out: Option<f64>,
    /// Root mean square of what it explains, m.
    pub explains: f64,
    /// Noise of a datum beside it, m.
    pub noise: f64,
    /// Laws that these data do not distinguish from it, the likeliest first.
    pub rivals: Vec<LawRival>,
    /// What would distinguish it from the likeliest rival at its place.
    pub next: Option<NextRecord>,
    /// Data as it sees them: what is left but for the law.
    pub points: Vec<Point>,
    /// A smooth curve through them.
    pub curve: Vec<Point>,
}

/// A law that may be there instead.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LawRival {
    /// Where.
    pub site: Site,
    /// What it looks like.
    pub form: Form,
    /// What it remembers.
    pub memory: Memory,
    /// Its number that is not linear.
    pub constant: Option<(FormConstant, Constant)>,
    /// Amplitudes (SI) and s.
    pub values: (Vec<f64>, f64),
    /// How many times the law is likelier.
    pub odds: f64,
    /// Its own held-out error, m.
    pub held_out: Option<f64>,
}

/// Where two laws part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextRecord {
    /// Number of the rival.
    pub rival: usize,
    /// The variable there, SI.
    pub at: f64,
    /// True where it is beyond what was recorded.
    pub is_beyond: bool,
    /// How far they are apart there, m.
    pub apart: f64,
}

/// A point of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Number of the direction.
    pub direction: usize,
    /// What the law follows, SI.
    pub x: f64,
    /// The result there, SI.
    pub value: f64,
}

/// How far beyond the data a law is asked to part from its rivals.
const BEYOND: f64 = 2.0;
/// How far apart they have to be, in standard deviations of a reading.
const PARTED: f64 = 4.0;
/// Points between nothing and [`BEYOND`].
const STEPS: usize = 80;
/// Points of a curve in a picture.
const POINTS: usize = 60;
/// Data that the law moves by less than this share of the largest are not drawn.
const DRAWN: f64 = 0.2;
/// Most rivals that are reported.
const MOST_RIVALS: usize = 8;

impl Law {
    /// The law at x (SI) in a direction, SI; what a memory makes of the variable is x.
    pub fn at(&self, direction: usize, x: f64) -> f64 {
        at(self.form, &self.values, self.site.largest(), direction, x)
    }
}

impl LawRival {
    /// See [`Law::at`].
    pub fn at(&self, direction: usize, x: f64) -> f64 {
        at(self.form, &self.values, self.site.largest(), direction, x)
    }
}

fn at(form: Form, (amplitudes, s): &(Vec<f64>, f64), largest: f64, direction: usize, x: f64) -> f64 {
    let functions = form.functions(x / largest, *s);
    let own = amplitudes.iter().skip(direction * form.count()).take(form.count());
    own.zip(functions).map(|(amplitude, function)| amplitude * function).sum()
}

/// A law for what `diagnosis` left unexplained; `None` where nothing was, or where what is left is
/// no law's: single readings, numbers of a file. `sites` are all places for it, given the findings;
/// always as many in the same order.
pub fn propose(
    model: &dyn ForwardModel,
    diagnosis: &Diagnosis,
    sites: &(dyn Fn(&[Term]) -> Vec<Site> + Sync),
) -> Option<Proposed> {
    let left = diagnosis.discrepancy.as_ref()?;
    if matches!(left.shown_by, ShownBy::Suspects | ShownBy::Numbers) {
        return None;
    }
    let (evidence, sigma) = (&diagnosis.settled.0, diagnosis.settled.1);
    let (terms, size) =
        (&diagnosis.hypothesis.terms[..], rms(&diagnosis.after).max(f64::MIN_POSITIVE.sqrt()));
    let rows: Vec<usize> = (0..evidence.residual.len()).collect();
    let remainder = Remainder::new(model, evidence, terms, rows, sigma);
    let all = sites(terms);
    let found = scan(&remainder, &all, size);
    let lives = found.curve.map(|(site, _)| (all[site].location.clone(), all[site].variable.clone()));
    let refused = |refusal, held_out| Some(Proposed { law: Err(refusal), lives: lives.clone(), held_out });
    // the curve that the diagnosis has found competes too
    let own_curve = left.candidate.map_or(f64::NEG_INFINITY, |curve| {
        let term = model.candidates()[curve].neutral(curve);
        remainder.gain(&model.columns(&[term], 0)) + curve_prior(model)
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
    let Some(held_out) = &diagnosis.held_out else { return refused(Refusal::NoFolds, None) };
    let choices: Vec<Choice> = class.iter().map(|law| law.choice).collect();
    let folds = hold_out(model, evidence, held_out, sites, &choices, (size, sigma));
    let Some(folds) = folds else { return refused(Refusal::NoFolds, None) };
    let errors = Some((folds.without, folds.with));
    if folds.with >= folds.without || folds.of[0] >= folds.without {
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
    let site = all[best.choice.site].clone();
    let columns = best.choice.columns(&site, best.posterior.best().0, size);
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
        rivals,
        next: None,
        points: Vec::new(),
        curve: Vec::new(),
        site,
    };
    let residual = &evidence.residual - &fitted.predicted;
    law.points = points(&law, best.choice, &residual);
    law.curve = smooth(&remainder, &law, best.choice, size);
    law.next = next(&law);
    Some(Proposed { law: Ok(law), lives, held_out: errors })
}

/// Ln of the prior odds of a curve of the model's.
fn curve_prior(model: &dyn ForwardModel) -> f64 {
    let count = model.candidates().iter().filter(|candidate| candidate.is_nonparametric).count();
    (0.5 * crate::inference::priors::PRIOR.2 / crate::inference::priors::PRIOR.0 / count.max(1) as f64).ln()
}

/// The best law and all that are not 20 times less likely.
fn alike<'a>(found: &'a Scan, best: &Scanned) -> Vec<&'a Scanned> {
    let near = found.laws.iter().take_while(|law| law.log_odds > best.log_odds - APART.ln());
    near.take(1 + MOST_RIVALS).collect()
}

/// The numbers of a law.
struct Measured {
    amplitudes: Vec<Constant>,
    constant: Option<(FormConstant, Constant)>,
    values: (Vec<f64>, f64),
}

impl Measured {
    /// At each s that counts the amplitudes are normal: together
    ///
    /// ```text
    /// var a = Σ p_s·(var_s a + (a_s − ā)²)
    /// ```
    fn of(remainder: &Remainder, site: &Site, law: &Scanned, size: f64) -> Measured {
        let (choice, best) = (law.choice, law.posterior.best().0);
        let mut shares = law.posterior.shares();
        if shares.is_empty() {
            shares = vec![(best, 1.0)];
        }
        let at = |u: f64| {
            let LawColumns { columns, amplitudes } = choice.columns(site, u, size);
            let fitted = remainder.fit(&columns);
            let value = |k: usize| fitted.factors[k] * amplitudes[k];
            let variance = |k: usize| fitted.covariance[(k, k)] * amplitudes[k].powi(2);
            let count = amplitudes.len();
            let values: Vec<f64> = (0..count).map(value).collect();
            let variances: Vec<f64> = (0..count).map(variance).collect();
            (values, variances, fitted.degrees_of_freedom)
        };
        let (mode, _, freedom) = at(best);
        let (mut mean, mut square) = (vec![0.0; mode.len()], vec![0.0; mode.len()]);
        for (u, share) in shares {
            let (values, variances, _) = at(u);
            for (k, (value, variance)) in values.into_iter().zip(variances).enumerate() {
                mean[k] += share * value;
                square[k] += share * (variance + value.powi(2));
            }
        }
        let factor = student_t_quantile(0.975, freedom).unwrap_or(1.96);
        let names = names(site, choice.form);
        let amplitude = |k: usize| {
            let (symbol, name, unit, si) = names[k].clone();
            let half = factor * (square[k] - mean[k].powi(2)).max(0.0).sqrt();
            let (value, low, high) = (mode[k] / si, (mean[k] - half) / si, (mean[k] + half) / si);
            Constant { symbol, name, unit, value, low: low.min(value), high: high.max(value) }
        };
        let constant = choice.constant().map(|what| (what, shape(site, law, what)));
        Measured {
            amplitudes: (0..mode.len()).map(amplitude).collect(),
            constant,
            values: (mode, choice.at(best)),
        }
    }
}

/// Symbol, name, unit and SI of each amplitude: those of a polynomial, a threshold or a memory are
/// per power of the variable.
fn names(site: &Site, form: Form) -> Vec<(String, String, String, f64)> {
    let (result, variable) = (&site.result, &site.variable);
    let per = |power: u8| {
        let below = bracketed(variable.unit);
        let unit = match power {
            _ if power == 0 || below.is_empty() => result.unit.to_owned(),
            1 => format!("{}/{below}", result.unit),
            2 => format!("{}/{below}²", result.unit),
            _ => format!("{}/{below}³", result.unit),
        };
        // amplitudes are of the scaled variable
        (unit, result.si * (site.largest() / variable.si).powi(i32::from(power)))
    };
    let of_form: Vec<(&str, &str, u8)> = match form {
        Form::Harmonic => vec![("a", "cosine", 0), ("b", "sine", 0)],
        Form::Threshold => vec![("k", "slope", 1)],
        Form::Step => vec![("a", "height", 0)],
        Form::Saturation | Form::Approach => vec![("a", "final value", 0)],
        Form::Power => vec![("a", "value at the largest", 0)],
        Form::Logarithm => vec![("a", "factor", 0)],
        Form::Polynomial(1) => vec![("c1", "slope", 1)],
        Form::Polynomial(degree) => {
            let all = [("c1", "first order", 1), ("c2", "second order", 2), ("c3", "third order", 3)];
            all[..degree as usize].to_vec()
        }
    };
    let mut names = Vec::new();
    for (direction, _) in &site.directions {
        for &(symbol, name, power) in &of_form {
            let (unit, si) = per(power);
            let of = if direction.is_empty() { String::new() } else { format!("_{direction}") };
            let said = if direction.is_empty() { String::new() } else { format!(", {direction}") };
            names.push((format!("{symbol}{of}"), format!("{name}{said}"), unit, si));
        }
    }
    names
}

/// A unit that is a product needs brackets before a power.
fn bracketed(unit: &str) -> String {
    if unit.contains('·') || unit.contains('/') { format!("({unit})") } else { unit.to_owned() }
}

/// The number that is not linear, in units for people.
fn shape(site: &Site, law: &Scanned, what: FormConstant) -> Constant {
    let (largest, unit) = (site.largest(), &site.variable);
    let along = |s: f64| s * largest / unit.si;
    let at = |u: f64| {
        let s = law.choice.at(u);
        match what {
            FormConstant::Exponent | FormConstant::Lag => s,
            FormConstant::Corner | FormConstant::Scale | FormConstant::Play => along(s),
            FormConstant::Period => along(1.0 / s),
        }
    };
    let variable = unit.symbol;
    let (symbol, name, unit) = match what {
        FormConstant::Exponent => ("p".to_owned(), "exponent", ""),
        FormConstant::Corner => (format!("{variable}_0"), "corner", unit.unit),
        FormConstant::Scale => (format!("{variable}_0"), "scale", unit.unit),
        FormConstant::Play => ("r".to_owned(), "half width", unit.unit),
        FormConstant::Period => ("P".to_owned(), "period", unit.unit),
        FormConstant::Lag => ("tau".to_owned(), "time constant", "s"),
    };
    let ends = [law.posterior.quantile(0.025), law.posterior.quantile(0.975)].map(at);
    let value = at(law.posterior.best().0);
    Constant {
        symbol,
        name: name.into(),
        unit: unit.into(),
        value,
        low: ends[0].min(ends[1]).min(value),
        high: ends[0].max(ends[1]).max(value),
    }
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

/// A smooth curve in the law's place: what it says at the points of the data, in order.
fn smooth(remainder: &Remainder, law: &Law, choice: Choice, size: f64) -> Vec<Point> {
    if choice.memory != Memory::None {
        return Vec::new();
    }
    let fitted = remainder.fit(&curve(&law.site, size));
    let (low, high) = law.site.range();
    let mut points = Vec::new();
    for (direction, (_, weights)) in law.site.directions.iter().enumerate() {
        let largest = weights.iter().fold(0.0, |most: f64, w| most.max(w.abs()));
        let count = fitted.factors.len() / law.site.directions.len();
        for k in 0..=POINTS {
            let share = k as f64 / POINTS as f64;
            let wave = |j: usize| {
                let angle = std::f64::consts::PI * j as f64 * share;
                fitted.factors[direction * count + j] * size / (1 + j) as f64 / largest * angle.cos()
            };
            points.push(Point {
                direction,
                x: low + share * (high - low),
                value: (0..count).map(wave).sum(),
            });
        }
    }
    points
}

/// Where the law and a rival at its place part first: between the data if they do, or else beyond
/// them.
fn next(law: &Law) -> Option<NextRecord> {
    let (low, high) = law.site.range();
    let per_result =
        law.site.directions.iter().flat_map(|(_, w)| w).fold(0.0, |most: f64, w| most.max(w.abs()));
    let is_alike = |rival: &&LawRival| {
        rival.memory == law.memory
            && rival.site.location == law.site.location
            && rival.site.variable == law.site.variable
    };
    let (number, rival) = law.rivals.iter().enumerate().find(|(_, rival)| is_alike(rival))?;
    let apart = |x: f64| {
        let of = |direction| (law.at(direction, x) - rival.at(direction, x)).abs() * per_result;
        (0..law.site.directions.len()).map(of).fold(0.0, f64::max)
    };
    let least = low.min(0.0);
    let x = |k: usize| least + (BEYOND * high - least) * k as f64 / STEPS as f64;
    let within = (0..=STEPS).map(x).filter(|x| *x <= high).max_by(|a, b| apart(*a).total_cmp(&apart(*b)));
    let far = |x: &f64| apart(*x) > PARTED * law.noise;
    let at = within.filter(far).or_else(|| (0..=STEPS).map(x).filter(|x| *x > high).find(far))?;
    Some(NextRecord { rival: number, at, is_beyond: at > high, apart: apart(at) })
}
