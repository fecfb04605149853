//! The numbers of a law with their intervals.

use nalgebra::{DMatrix, DVector};

use super::choice::{Choice, LawColumns};
use super::constant::{Constant, OpenEnd};
use super::form::{Form, FormConstant};
use super::looked::{SAME, at_point};
use super::remainder::Remainder;
use super::scan::Scanned;
use super::shape::OfShape;
use super::site::Site;
use crate::inference::score::priors::APART;
use crate::statistics::{HALF_95, student_t_quantile};

/// Values of s by which its posterior counts in the amplitudes' intervals.
const DRAWS: usize = 24;
/// Values of a number by which each of several laws counts in its interval.
const OF_KIN: usize = 200;
/// Most other values of s that are reported.
const MOST_OTHERS: usize = 5;

/// The numbers of a law.
pub(super) struct Measured {
    pub amplitudes: Vec<Constant>,
    pub constant: Option<(FormConstant, Constant)>,
    /// Others that are not linear.
    pub of_shape: Vec<Constant>,
    /// Of all of them, in this order.
    pub correlation: DMatrix<f64>,
    pub values: (Vec<f64>, f64),
}

impl Measured {
    /// Intervals of its numbers that are not linear as wide as laws make them of which one
    /// holds the other, and that data do not distinguish: each number is the same in all of
    /// them, and each counts by its probability. The first is the law itself.
    pub fn average(&mut self, kin: &[(&Scanned, &Site)]) {
        let Some((own, _)) = kin.first() else { return };
        for constant in self.constant.iter_mut().map(|(_, own)| own).chain(&mut self.of_shape) {
            let mut all: Vec<(f64, f64)> = Vec::new();
            for (law, site) in kin {
                let values: Vec<f64> = numbers(law, site, &constant.name);
                let share = (law.log_odds - own.log_odds).exp() / values.len() as f64;
                all.extend(values.into_iter().map(|value| (value, share)));
            }
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let whole: f64 = all.iter().map(|(_, share)| share).sum();
            let below = |p: f64| {
                let mut sum = 0.0;
                all.iter().find_map(|(value, share)| {
                    sum += share;
                    (sum >= p * whole).then_some(*value)
                })
            };
            constant.low = below(0.025).map_or(constant.low, |low| low.min(constant.low));
            constant.high = below(0.975).map_or(constant.high, |high| high.max(constant.high));
        }
    }

    /// At each s that counts the amplitudes are normal: together
    ///
    /// ```text
    /// var a = Σ p_s·(var_s a + (a_s − ā)²)
    /// ```
    pub fn of(remainder: &Remainder, site: &Site, law: &Scanned, size: f64) -> Measured {
        let (choice, best) = (law.choice, law.at);
        let names = names(site, choice.form);
        let columns = choice.columns(site, best, size);
        let fitted = remainder.fit(&columns.columns);
        let mode: Vec<f64> = fitted.factors.iter().zip(&columns.amplitudes).map(|(f, a)| f * a).collect();
        let (mean, covariance) = moments(remainder, site, law, size);
        let factor = student_t_quantile(0.975, fitted.degrees_of_freedom).unwrap_or(HALF_95);
        let amplitude = |k: usize| {
            let (symbol, name, unit, si) = names[k].clone();
            let half = factor * covariance[(k, k)].max(0.0).sqrt();
            let (value, low, high) = (mode[k] / si, (mean[k] - half) / si, (mean[k] + half) / si);
            let (low, high) = (low.min(value), high.max(value));
            Constant { symbol, name, unit, value, low, high, also: Vec::new(), open: None }
        };
        let constant = choice.constant().map(|what| (what, shape(site, law, what)));
        Measured {
            amplitudes: (0..mode.len()).map(amplitude).collect(),
            constant,
            of_shape: of_shape(site, law),
            correlation: correlation(&covariance),
            values: (mode, choice.at(best)),
        }
    }
}

/// Values of a number of this name, each of which stands for as much of the posterior; nothing
/// where a law has none.
fn numbers(law: &Scanned, site: &Site, name: &str) -> Vec<f64> {
    let value = |(choice, u): (Choice, f64)| {
        let of_form = choice.constant().filter(|what| named(*what) == name);
        let of_shape = || choice.of_shape(widths(site, choice, u)).into_iter().find(|own| own.name == name);
        of_form.map(|what| along(site, what, choice.at(u))).or_else(|| of_shape().map(|own| own.value))
    };
    law.even(OF_KIN).into_iter().filter_map(value).collect()
}

/// What the number that is not linear is called.
fn named(what: FormConstant) -> &'static str {
    match what {
        FormConstant::Exponent => "exponent",
        FormConstant::Corner => "corner",
        FormConstant::Scale => "scale",
        FormConstant::Pole => "place of the pull",
        FormConstant::Play => "half width",
        FormConstant::Yield => "yield",
        FormConstant::Period => "period",
        FormConstant::Lag => "time constant",
    }
}

/// Mean and covariance of amplitudes (SI), the number that is not linear (in its unit) and those of
/// its shape.
fn moments(remainder: &Remainder, site: &Site, law: &Scanned, size: f64) -> (DVector<f64>, DMatrix<f64>) {
    let draws = law.even(DRAWS);
    let share = 1.0 / draws.len() as f64;
    let mut sums: Option<(DVector<f64>, DMatrix<f64>)> = None;
    for (choice, u) in draws {
        let LawColumns { columns, amplitudes } = choice.columns(site, u, size);
        let (factors, of_factors) = remainder.factors(&columns);
        let count = amplitudes.len();
        let mut values: Vec<f64> = factors.iter().zip(&amplitudes).map(|(f, a)| f * a).collect();
        values.extend(choice.constant().map(|what| along(site, what, choice.at(u))));
        let of_shape = choice.of_shape(widths(site, choice, u)).into_iter();
        values.extend(of_shape.map(|own| own.value));
        let values = DVector::from_vec(values);
        let mut square = &values * values.transpose();
        for i in 0..count {
            for j in 0..count {
                square[(i, j)] += of_factors[(i, j)] * amplitudes[i] * amplitudes[j];
            }
        }
        let (mean, whole) = sums.get_or_insert_with(|| {
            (DVector::zeros(values.len()), DMatrix::zeros(values.len(), values.len()))
        });
        *mean += values * share;
        *whole += square * share;
    }
    let (mean, whole) = sums.unwrap_or_else(|| (DVector::zeros(0), DMatrix::zeros(0, 0)));
    let covariance = whole - &mean * mean.transpose();
    (mean, covariance)
}

/// Correlation coefficients of a covariance.
fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let sd: Vec<f64> = covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect();
    DMatrix::from_fn(sd.len(), sd.len(), |i, j| {
        let product = sd[i] * sd[j];
        let is_known = product > 0.0 && product.is_finite();
        if is_known { (covariance[(i, j)] / product).clamp(-1.0, 1.0) } else { 0.0 }
    })
}

/// The number that is not linear in its unit for people.
fn along(site: &Site, what: FormConstant, s: f64) -> f64 {
    let scale = site.largest() / site.variable.si;
    match what {
        FormConstant::Exponent | FormConstant::Lag => s,
        FormConstant::Corner
        | FormConstant::Scale
        | FormConstant::Pole
        | FormConstant::Play
        | FormConstant::Yield => s * scale,
        FormConstant::Period => scale / s,
    }
}

/// Symbol, name, unit and SI of each amplitude: those of a polynomial, a threshold or a memory are
/// per power of the variable.
fn names(site: &Site, form: Form) -> Vec<(String, String, String, f64)> {
    let (result, variable) = (&site.result, &site.variable);
    let per = |power: i8| {
        let below = bracketed(variable.unit);
        let unit = match power {
            _ if power == 0 || below.is_empty() => result.unit.to_owned(),
            -2 => format!("{}·{below}²", result.unit),
            1 => format!("{}/{below}", result.unit),
            2 => format!("{}/{below}²", result.unit),
            _ => format!("{}/{below}³", result.unit),
        };
        // amplitudes are of the scaled variable
        (unit, result.si * (site.largest() / variable.si).powi(i32::from(power)))
    };
    let of_form: Vec<(&str, &str, i8)> = match form {
        Form::Harmonic | Form::Chirp(_) | Form::Swell(_) => vec![("a", "cosine", 0), ("b", "sine", 0)],
        Form::Oscillation => vec![("a", "cosine", 0), ("b", "sine", 0), ("c", "level", 0)],
        Form::Threshold | Form::Rough(_) => vec![("k", "slope", 1)],
        Form::PowerBeyond(_) => vec![("a", "value at the largest", 0)],
        Form::Step => vec![("a", "height", 0)],
        Form::Saturation | Form::Approach | Form::Rounded => vec![("a", "final value", 0)],
        Form::Pull | Form::PullBelow | Form::PullAbove => vec![("k", "strength", -2)],
        Form::Decay => vec![("a", "first value", 0)],
        Form::Settling => vec![("a", "first value above the level", 0), ("b", "level", 0)],
        Form::Power => vec![("a", "value at the largest", 0)],
        Form::PowerAfterGap => vec![("a", "value at the largest after the gap", 0), ("g", "gap", 0)],
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
            let along = if direction.is_empty() { String::new() } else { format!("_{direction}") };
            let said = if direction.is_empty() { String::new() } else { format!(", {direction}") };
            names.push((format!("{symbol}{along}"), format!("{name}{said}"), unit, si));
        }
    }
    names
}

/// A unit that is a product needs brackets before a power.
fn bracketed(unit: &str) -> String {
    if unit.contains('·') || unit.contains('/') { format!("({unit})") } else { unit.to_owned() }
}

/// How wide its memory is, and X, in the unit of the variable.
fn widths(site: &Site, choice: Choice, u: f64) -> (f64, f64) {
    let largest = site.largest() / site.variable.si;
    (choice.at(u) * largest, largest)
}

/// Numbers of its shape.
fn of_shape(site: &Site, law: &Scanned) -> Vec<Constant> {
    let Some(peak) = &law.peak else { return Vec::new() };
    let own = law.choice.of_shape(widths(site, law.choice, law.at));
    let measured = |(k, own): (usize, OfShape)| {
        let at = |point: &DVector<f64>| {
            let (choice, u) = at_point(law.choice, point);
            choice.of_shape(widths(site, choice, u)).get(k).map_or(own.value, |own| own.value)
        };
        let (low, high) = peak.interval(&at, own.range);
        Constant {
            unit: if own.is_width { site.variable.unit.to_owned() } else { String::new() },
            value: own.value,
            low: low.min(own.value),
            high: high.max(own.value),
            symbol: own.symbol,
            name: own.name,
            also: Vec::new(),
            open: None,
        }
    };
    own.into_iter().enumerate().map(measured).collect()
}

/// The number that is not linear, in units for people.
fn shape(site: &Site, law: &Scanned, what: FormConstant) -> Constant {
    let unit = &site.variable;
    let at = |u: f64| along(site, what, law.choice.at(u));
    let variable = unit.symbol;
    let (symbol, unit) = match what {
        FormConstant::Exponent => ("p".to_owned(), ""),
        FormConstant::Corner | FormConstant::Scale | FormConstant::Pole => {
            (format!("{variable}_0"), unit.unit)
        }
        FormConstant::Play | FormConstant::Yield => ("r".to_owned(), unit.unit),
        FormConstant::Period => ("P".to_owned(), unit.unit),
        FormConstant::Lag => ("tau".to_owned(), "s"),
    };
    // times and lengths that are far longer than the data are all alike
    let is_scale = matches!(what, FormConstant::Scale | FormConstant::Lag);
    let open = law.posterior.open_end().filter(|_| is_scale && law.peak.is_none());
    let ends = match open {
        None => (0.025, 0.975),
        Some(OpenEnd::High) => (0.05, 1.0),
        Some(OpenEnd::Low) => (0.0, 0.95),
    };
    let ends = [law.posterior.quantile(ends.0), law.posterior.quantile(ends.1)].map(at);
    let value = at(law.at);
    // of numbers together there is one peak
    let modes = if law.peak.is_none() { law.posterior.modes(APART) } else { Vec::new() };
    let mut others: Vec<f64> = Vec::new();
    for u in modes.into_iter().chain(law.also.iter().copied()) {
        let is_known = |known: &f64| (u - known).abs() < SAME;
        if !is_known(&law.at) && !others.iter().any(is_known) {
            others.push(u);
        }
    }
    Constant {
        symbol,
        name: named(what).into(),
        unit: unit.into(),
        value,
        low: ends[0].min(ends[1]).min(value),
        high: ends[0].max(ends[1]).max(value),
        also: others.into_iter().take(MOST_OTHERS).map(at).collect(),
        open,
    }
}
