//! A proposed law as one of the rod's file.

use super::measures::{SiteVariable, place_in_file};
use super::remembered::in_file;
use crate::diagnosis::law_formula::{constants, formula, range, source};
use crate::inference::law::Law;
use crate::rod::{LawVariable, RodLaw, RodLawPlace};

/// The law as the rod's file holds it; `None` for one that only this recording has: over its time,
/// its order, its temperatures.
pub fn written(law: &Law, from: &str) -> Option<RodLaw> {
    let place = place_in_file(&law.site.location)?;
    let is_its =
        |own: &LawVariable| own.is_at(&place) && SiteVariable::OfFile(*own).measure() == law.site.variable;
    let variable = LawVariable::ALL.into_iter().find(is_its)?;
    // of the rod's file a newton depends on load or deflection, and a share on all else
    if place == RodLawPlace::Rod && variable.adds_load() != (law.site.result.unit == "N") {
        return None;
    }
    // functions of a variable with two signs are odd
    let formula = formula(law, variable.symbol(), variable.has_both_signs(), 0);
    let mut written = RodLaw::new(place, variable, formula, constants(law), range(law)).ok()?;
    written.memory = in_file(law.memory);
    written.source = Some(source(law, from));
    Some(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::Location;
    use crate::inference::law::{Constant, Form, FormConstant, Measure, Site};

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
            open: None,
        };
        let largest = 250.0f64;
        for form in Form::ALL {
            // amplitudes are of the scaled variable
            let amplitudes = [30.0, -12.0, 5.0][..form.count()].to_vec();
            let s = match form {
                _ if form.is_wave() => 2.5,
                Form::Pull | Form::PullAbove => 1.4,
                Form::PullBelow => -0.9,
                _ => 0.4,
            };
            let power = |k: usize| match form {
                Form::Polynomial(_) => k as i32 + 1,
                Form::Threshold | Form::Rough(_) => 1,
                Form::Pull | Form::PullBelow | Form::PullAbove => -2,
                _ => 0,
            };
            let symbols: &[&str] = match form {
                Form::Threshold | Form::Rough(_) | Form::Pull | Form::PullBelow | Form::PullAbove => &["k"],
                Form::Harmonic | Form::Chirp(_) | Form::Swell(_) | Form::Settling => &["a", "b"],
                Form::Oscillation => &["a", "b", "c"],
                Form::PowerAfterGap => &["a", "g"],
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
                rare: &[],
            };
            let si: Vec<f64> = amplitudes.iter().map(|a| a * 1e-6).collect();
            let mut law = Law::of_numbers(site, form, (constants, shape), (si, s));
            law.of_shape = match form {
                Form::PowerBeyond(p) => vec![named("p", p)],
                Form::Rough(v) => vec![named("v", v * largest)],
                Form::Chirp(q) => vec![named("q", q)],
                Form::Swell(g) => vec![named("g", g)],
                _ => Vec::new(),
            };
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
