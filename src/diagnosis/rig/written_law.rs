//! A proposed law as one of the rod's file.

use crate::inference::Location;
use crate::inference::law::{Constant, Form, Law, Memory};
use crate::rod::{LawConstant, LawMemory, LawVariable, RodLaw};
use crate::units::significant;

/// Half of a 95 % interval, in standard deviations.
const HALF: f64 = 1.96;

/// The law as the rod's file holds it; `None` for one that only this recording has: over its time,
/// its order, its temperatures.
pub(super) fn written(law: &Law, source: &str) -> Option<RodLaw> {
    let place = match &law.site.location {
        Location::Channel { channel, .. } => format!("d{channel}"),
        other => other.to_string(),
    };
    let name = &law.site.variable.name;
    let variable = LawVariable::ALL.into_iter().find(|v| v.words() == name && v.is_at(&place))?;
    let own = |constant: &Constant| LawConstant {
        name: constant.symbol.clone(),
        value: digits(constant.value),
        // several values apart have no standard deviation: the source says which they are
        standard_uncertainty: match constant.also.is_empty() {
            true => rounded((constant.high - constant.low) / (2.0 * HALF)),
            false => 0.0,
        },
        unit: constant.unit.clone(),
    };
    let constants = law.amplitudes.iter().chain(law.constant.iter().map(|(_, constant)| constant));
    let si = law.site.variable.si;
    let (low, high) = law.site.range();
    let range = (digits(low / si), digits(high / si));
    let formula = formula(law, variable);
    let mut written = RodLaw::new(place, variable, formula, constants.map(own).collect(), range).ok()?;
    written.memory = match law.memory {
        Memory::Stop => Some(LawMemory::Stop),
        Memory::Lag => Some(LawMemory::Lag),
        _ => None,
    };
    let also = |constant: &Constant| {
        let others: Vec<String> = constant.also.iter().map(|other| significant(*other, 3)).collect();
        let Constant { symbol, unit, .. } = constant;
        (!others.is_empty()).then(|| format!("; {symbol} may as well be {} {unit}", others.join(", ")))
    };
    let also = law.constant.as_ref().and_then(|(_, constant)| also(constant)).unwrap_or_default();
    written.source = Some(format!("{source}{also}"));
    Some(written)
}

/// In the syntax of [`crate::expression`].
fn formula(law: &Law, variable: LawVariable) -> String {
    let x = variable.symbol();
    // functions of a variable with two signs are odd
    let is_signed = variable == LawVariable::Reading;
    let (sign, size) =
        if is_signed { (format!("sign({x})*"), format!("abs({x})")) } else { (String::new(), x.to_owned()) };
    let largest = digits(law.site.largest() / law.site.variable.si);
    let corner = format!("{x}_0");
    let plain = match law.form {
        Form::Power => format!("a*{sign}({size}/{largest:?})^p"),
        Form::Saturation => format!("a*{sign}min({size}/{corner}, 1)"),
        Form::Threshold => format!("k*max({x} - {corner}, 0)"),
        Form::Step => format!("a*step({x} - {corner})"),
        Form::Approach => format!("a*{sign}(1 - exp(-{size}/{corner}))"),
        Form::Decay => format!("a*{sign}exp(-{size}/{corner})"),
        Form::Logarithm => format!("a*{sign}ln(1 + {size}/{corner})"),
        Form::Harmonic => format!("a*(cos(2*pi*{x}/P) - 1) + b*sin(2*pi*{x}/P)"),
        Form::Polynomial(1) => format!("c1*{x}"),
        Form::Polynomial(2) => format!("c1*{x} + c2*{x}^2"),
        Form::Polynomial(_) => format!("c1*{x} + c2*{x}^2 + c3*{x}^3"),
    };
    match law.memory {
        Memory::Side => format!("side*({plain})"),
        _ => plain,
    }
}

/// As many digits as change nothing that anybody reads.
fn digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// Two digits, as uncertainties have (GUM 7.2.6).
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::law::{FormConstant, Measure, Site};

    /// Each form, written and read as a formula, is the law itself.
    #[test]
    fn what_is_written_is_the_law() {
        let named = |symbol: &str, value: f64| Constant {
            symbol: symbol.into(),
            name: String::new(),
            unit: String::new(),
            value,
            low: value - 0.196,
            high: value + 0.196,
            also: Vec::new(),
        };
        let largest = 250.0f64;
        for form in Form::ALL {
            // amplitudes are of the scaled variable
            let amplitudes = [30.0, -12.0, 5.0][..form.count()].to_vec();
            let s = if form == Form::Harmonic { 2.5 } else { 0.4 };
            let power = |k: usize| match form {
                Form::Polynomial(_) => k as i32 + 1,
                Form::Threshold => 1,
                _ => 0,
            };
            let symbols: &[&str] = match form {
                Form::Threshold => &["k"],
                Form::Harmonic => &["a", "b"],
                Form::Polynomial(_) => &["c1", "c2", "c3"],
                _ => &["a"],
            };
            let constants = symbols.iter().zip(&amplitudes).enumerate();
            let constants: Vec<Constant> =
                constants.map(|(k, (symbol, a))| named(symbol, a / largest.powi(power(k)))).collect();
            let shape = form.constant().map(|what| match what {
                FormConstant::Exponent => (what, named("p", s)),
                FormConstant::Period => (what, named("P", largest / s)),
                _ => (what, named("y_0", s * largest)),
            });
            let measure = |symbol, name: &str| Measure { symbol, name: name.into(), unit: "µm", si: 1e-6 };
            let site = Site {
                location: Location::Channel { channel: crate::spatial::Axis::Y, form: None },
                result: measure("Δy", "reading"),
                variable: measure("y", "reading"),
                directions: vec![(String::new(), vec![1.0; 2])],
                values: vec![-100e-6, largest * 1e-6],
                recorded: None,
                moves: Vec::new(),
                courses: Vec::new(),
                forms: &Form::ALL,
            };
            let si: Vec<f64> = amplitudes.iter().map(|a| a * 1e-6).collect();
            let law = Law::of_numbers(site, form, (constants, shape), (si, s));
            let written = written(&law, "test").unwrap();
            for x in [-90.0, 10.0, 101.0, 240.0] {
                let (own, expected) = (written.at(x, 1.0), law.at(0, x * 1e-6) / 1e-6);
                assert!(
                    (own - expected).abs() < 1e-6 * expected.abs().max(1.0),
                    "{form:?} {x}: {own} {expected}"
                );
            }
            assert_eq!(written.constants[0].standard_uncertainty, 0.1);
        }
    }
}
