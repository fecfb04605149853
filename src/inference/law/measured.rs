//! The numbers of a law with their intervals.

use super::choice::LawColumns;
use super::form::{Constant, Form, FormConstant};
use super::remainder::Remainder;
use super::scan::Scanned;
use super::site::Site;
use crate::inference::selection::APART;
use crate::statistics::student_t_quantile;

/// Values of s by which its posterior counts in the amplitudes' intervals.
const DRAWS: usize = 24;
/// Most other values of s that are reported.
const MOST_OTHERS: usize = 5;

/// The numbers of a law.
pub(super) struct Measured {
    pub amplitudes: Vec<Constant>,
    pub constant: Option<(FormConstant, Constant)>,
    pub values: (Vec<f64>, f64),
}

impl Measured {
    /// At each s that counts the amplitudes are normal: together
    ///
    /// ```text
    /// var a = Σ p_s·(var_s a + (a_s − ā)²)
    /// ```
    pub fn of(remainder: &Remainder, site: &Site, law: &Scanned, size: f64) -> Measured {
        let (choice, best) = (law.choice, law.at);
        let draws = match choice.constant() {
            Some(_) => law.posterior.even(DRAWS),
            None => vec![best],
        };
        let at = |u: f64| {
            let LawColumns { columns, amplitudes } = choice.columns(site, u, size);
            let (factors, covariance) = remainder.factors(&columns);
            let value = |k: usize| factors[k] * amplitudes[k];
            let variance = |k: usize| covariance[(k, k)] * amplitudes[k].powi(2);
            let count = amplitudes.len();
            let values: Vec<f64> = (0..count).map(value).collect();
            let variances: Vec<f64> = (0..count).map(variance).collect();
            (values, variances)
        };
        let columns = choice.columns(site, best, size);
        let fitted = remainder.fit(&columns.columns);
        let mode: Vec<f64> = fitted.factors.iter().zip(&columns.amplitudes).map(|(f, a)| f * a).collect();
        let freedom = fitted.degrees_of_freedom;
        let (mut mean, mut square) = (vec![0.0; mode.len()], vec![0.0; mode.len()]);
        let share = 1.0 / draws.len() as f64;
        for u in draws {
            let (values, variances) = at(u);
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
            let (low, high) = (low.min(value), high.max(value));
            Constant { symbol, name, unit, value, low, high, also: Vec::new() }
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
        Form::Decay => vec![("a", "first value", 0)],
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
    let value = at(law.at);
    let peaks = law.posterior.peaks(APART).into_iter().map(|(u, _)| u);
    let others = peaks.filter(|u| *u != law.at);
    Constant {
        symbol,
        name: name.into(),
        unit: unit.into(),
        value,
        low: ends[0].min(ends[1]).min(value),
        high: ends[0].max(ends[1]).max(value),
        also: others.take(MOST_OTHERS).map(at).collect(),
    }
}
