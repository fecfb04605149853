//! A proposed law as what a file holds: a formula in the syntax of [`crate::expression`], with its
//! constants.

use nalgebra::DMatrix;

use crate::inference::law::{Constant, Form, Law, Memory};
use crate::rod::LawConstant;
use crate::statistics::HALF_95;
use crate::units::significant;

/// The law along one of its directions, in `x`; a formula of a variable with two signs is odd where
/// its form is.
pub(super) fn formula(law: &Law, x: &str, is_signed: bool, direction: usize) -> String {
    let (sign, size) =
        if is_signed { (format!("sign({x})*"), format!("abs({x})")) } else { (String::new(), x.to_owned()) };
    let largest = digits(law.site.largest() / law.site.variable.si);
    let corner = format!("{x}_0");
    // amplitudes are called as the law's are, `a_x`
    let named = |k: usize| law.amplitudes[direction * law.form.count() + k].symbol.as_str();
    let a = named(0);
    let powers = || {
        let term = |k: usize| match k {
            0 => format!("{}*{x}", named(k)),
            _ => format!("{}*{x}^{}", named(k), k + 1),
        };
        (0..law.form.count()).map(term).collect::<Vec<_>>().join(" + ")
    };
    let b = if law.form.count() > 1 { named(1) } else { "" };
    let c = if law.form.count() > 2 { named(2) } else { "" };
    let plain = match law.form {
        Form::Power => format!("{a}*{sign}({size}/{largest:?})^p"),
        Form::PowerAfterGap if is_signed => format!("{sign}({a}*({size}/{largest:?})^p + {b})"),
        Form::PowerAfterGap => format!("{a}*({size}/{largest:?})^p + {b}*step({x})"),
        Form::Saturation => format!("{a}*{sign}min({size}/{corner}, 1)"),
        Form::Rounded => format!("{a}*tanh({x}/{corner})"),
        Form::Pull => format!("{a}*{sign}(1/({corner} - {size})^2 - 1/{corner}^2)"),
        Form::PullBelow | Form::PullAbove => format!("{a}/({x} - {corner})^2"),
        Form::Threshold => format!("{a}*max({x} - {corner}, 0)"),
        Form::PowerBeyond(_) => format!("{a}*(max({x} - {corner}, 0)/({largest:?} - {corner}))^p"),
        Form::Rough(_) => {
            format!("{a}*v*(ln(1 + exp(({x} - {corner})/v)) - ln(1 + exp(-{corner}/v)))")
        }
        Form::Step => format!("{a}*step({x} - {corner})"),
        Form::Approach => format!("{a}*{sign}(1 - exp(-{size}/{corner}))"),
        Form::Decay => format!("{a}*{sign}exp(-{size}/{corner})"),
        Form::Settling if is_signed => format!("{sign}({a}*exp(-{size}/{corner}) + {b})"),
        Form::Settling => format!("{a}*exp(-{size}/{corner}) + {b}"),
        Form::Logarithm => format!("{a}*{sign}ln(1 + {size}/{corner})"),
        Form::Harmonic => format!("{a}*(cos(2*pi*{x}/P) - 1) + {b}*sin(2*pi*{x}/P)"),
        Form::Chirp(_) => {
            let turns = format!("2*pi*{x}/P*(1 + q*({x}/{largest:?} - 1))");
            format!("{a}*(cos({turns}) - 1) + {b}*sin({turns})")
        }
        Form::Swell(_) => {
            let grown = format!("(1 + g*{size}/{largest:?})");
            format!("{a}*({grown}*cos(2*pi*{x}/P) - 1) + {b}*{grown}*sin(2*pi*{x}/P)")
        }
        Form::Oscillation => format!("{a}*cos(2*pi*{x}/P) + {b}*sin(2*pi*{x}/P) + {c}"),
        Form::Polynomial(_) => powers(),
    };
    match law.memory {
        Memory::Side => format!("side*({plain})"),
        Memory::None
        | Memory::Stop
        | Memory::Play
        | Memory::Stops(_)
        | Memory::BoucWen(_)
        | Memory::Lag
        | Memory::Lagged => plain,
    }
}

/// The constants of a law.
pub(super) fn constants(law: &Law) -> Vec<LawConstant> {
    let correlation = written(&law.correlation);
    let own = |(k, constant): (usize, &Constant)| LawConstant {
        name: constant.symbol.clone(),
        value: digits(constant.value),
        // several values apart have no standard deviation: the source says which they are
        standard_uncertainty: match constant.also.is_empty() {
            true => rounded((constant.high - constant.low) / (2.0 * HALF_95)),
            false => 0.0,
        },
        correlation: (0..k).filter_map(|j| correlation.get((k, j)).copied()).collect(),
        unit: constant.unit.clone(),
    };
    law.constants().enumerate().map(own).collect()
}

/// Correlations to thousandths. Nearly dependent constants may then have ones that nothing can
/// have: these are made smaller until no combination has a negative variance.
fn written(correlation: &DMatrix<f64>) -> DMatrix<f64> {
    const LESS: f64 = 1e-3;
    if correlation.is_empty() {
        return correlation.clone();
    }
    let mut share = 1.0;
    loop {
        let rounded = DMatrix::from_fn(correlation.nrows(), correlation.ncols(), |i, j| {
            if i == j { 1.0 } else { thousandths(share * correlation[(i, j)]) }
        });
        if share <= 0.0 || rounded.symmetric_eigenvalues().iter().all(|value| *value >= 0.0) {
            return rounded;
        }
        share -= LESS;
    }
}

/// From where to where its variable was recorded, in its unit.
pub(super) fn range(law: &Law) -> (f64, f64) {
    let (si, (low, high)) = (law.site.variable.si, law.site.range());
    (digits(low / si), digits(high / si))
}

/// Where a law comes from, with other values of its constant that fit as well.
pub(super) fn source(law: &Law, source: &str) -> String {
    let also = |constant: &Constant| {
        let others: Vec<String> = constant.also.iter().map(|other| significant(*other, 3)).collect();
        let Constant { symbol, unit, .. } = constant;
        (!others.is_empty()).then(|| format!("; {symbol} may as well be {} {unit}", others.join(", ")))
    };
    let also = law.constant.as_ref().and_then(|(_, constant)| also(constant)).unwrap_or_default();
    format!("{source}{also}")
}

/// As many digits as change nothing that anybody reads.
fn digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// Two digits, as uncertainties have (GUM 7.2.6).
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// As exactly as a correlation is known; towards 0, so that those of several constants stay
/// possible.
fn thousandths(value: f64) -> f64 {
    (value * 1000.0).trunc() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlations_that_are_written_can_be() {
        let given = DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 0.5, 0.0, 1.0, 0.867, 0.5, 0.867, 1.0]);
        let least = |matrix: &DMatrix<f64>| matrix.clone().symmetric_eigenvalues().min();
        assert!(least(&given) < 0.0);
        let found = written(&given);
        assert!(least(&found) >= 0.0 && (&found - &given).amax() < 0.05, "{found}");
        let free = DMatrix::from_row_slice(2, 2, &[1.0, -0.9234, -0.9234, 1.0]);
        assert_eq!(written(&free)[(0, 1)], -0.923);
    }
}
