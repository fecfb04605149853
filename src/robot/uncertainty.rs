//! How sure the numbers of a calibrated robot are, and what that means for its tip.
//!
//! Cov(tip) = J·Σ·Jᵀ, J = ∂tip/∂parameter, Σ the covariance of the parameters
//!
//! In a robot file it is the section `[uncertainty]`: names, standard errors and, below the
//! diagonal, correlations.

use nalgebra::{DMatrix, DVector};
use serde::Deserialize;
use toml::Spanned;

use super::Parameter;
use crate::error::Result;
use crate::toml_text::{Number, TomlText};

/// Covariance of parameters of the chain {0} → joints → {T} → tip.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Uncertainty {
    /// n parameters.
    pub parameters: Vec<Parameter>,
    /// Σ, n × n, SI.
    pub covariance: DMatrix<f64>,
}

impl Uncertainty {
    /// The section of a robot file.
    pub(super) fn written(&self) -> String {
        let errors: DVector<f64> = self.covariance.diagonal().map(f64::sqrt);
        let names: Vec<String> = self.parameters.iter().map(|p| format!("{:?}", p.key())).collect();
        let in_units: Vec<String> = errors
            .iter()
            .zip(&self.parameters)
            .map(|(error, p)| format!("{:.6e}", error / p.unit().si))
            .collect();
        let row = |i: usize| {
            let correlation = |j: usize| {
                let product = errors[i] * errors[j];
                format!("{:.9}", if product > 0.0 { self.covariance[(i, j)] / product } else { 0.0 })
            };
            format!("    [{}],\n", (0..i).map(correlation).collect::<Vec<_>>().join(", "))
        };
        let rows: String = (1..self.parameters.len()).map(row).collect();
        format!(
            "\n[uncertainty]\nparameters = [{}]\nstd_error = [{}]\ncorrelation = [\n{rows}]\n",
            names.join(", "),
            in_units.join(", ")
        )
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [uncertainty]")]
pub(super) struct RawUncertainty {
    parameters: Spanned<Vec<Spanned<String>>>,
    std_error: Spanned<Vec<Number>>,
    correlation: Spanned<Vec<Spanned<Vec<Number>>>>,
}

/// The section of a robot with so many joints.
pub(super) fn read(toml: &TomlText, raw: &RawUncertainty, joints: usize) -> Result<Uncertainty> {
    let count = raw.parameters.get_ref().len();
    let parameter = |name: &Spanned<String>| {
        let known = Parameter::from_key(name.get_ref(), joints).filter(|parameter| !parameter.is_base());
        let expected = "parameters as theta2_deg, a3_mm, tool_x_mm, c2_urad_per_nm";
        known.ok_or_else(|| toml.is("uncertainty.parameters", name, expected))
    };
    let parameters: Vec<Parameter> = raw.parameters.get_ref().iter().map(parameter).collect::<Result<_>>()?;
    if raw.std_error.get_ref().len() != count {
        let expected = format!("{count} numbers, one for each parameter");
        return Err(toml.is("uncertainty.std_error", &raw.std_error, &expected));
    }
    let mut errors = Vec::with_capacity(count);
    for (number, parameter) in raw.std_error.get_ref().iter().zip(&parameters) {
        errors.push(toml.not_negative("uncertainty.std_error", number)? * parameter.unit().si);
    }
    let rows = raw.correlation.get_ref();
    if rows.len() + 1 != count.max(1) {
        let expected = format!("{} rows: the triangle below the diagonal", count.max(1) - 1);
        return Err(toml.is("uncertainty.correlation", &raw.correlation, &expected));
    }
    let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(count, errors.iter().map(|e| e * e)));
    for (i, row) in (1..).zip(rows) {
        if row.get_ref().len() != i {
            return Err(toml.is("uncertainty.correlation", row, &format!("{i} numbers in row {i}")));
        }
        for (j, number) in row.get_ref().iter().enumerate() {
            let correlation = toml.finite("uncertainty.correlation", number)?;
            if correlation.abs() > 1.0 {
                return Err(toml.is("uncertainty.correlation", number, "numbers from -1 to 1"));
            }
            covariance[(i, j)] = correlation * errors[i] * errors[j];
            covariance[(j, i)] = covariance[(i, j)];
        }
    }
    Ok(Uncertainty { parameters, covariance })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Robot;

    const ROBOT: &str = "name = \"arm\"\n[[joint]]\nd_mm = 0\na_mm = 500\nalpha_deg = 0\n\
                         [tip]\nxyz_mm = [0, 0, 0]\nsd_mm = 0.03\n";

    fn robot(section: &str) -> Result<Robot> {
        Robot::from_text("arm.toml", &format!("{ROBOT}{section}"), None, None)
    }

    #[test]
    fn the_tip_is_as_unsure_as_the_numbers_make_it() {
        // a link of 500 mm along x: its length moves the tip along x, its angle across it
        let arm = robot(
            "[uncertainty]\nparameters = [\"a1_mm\", \"theta1_deg\"]\nstd_error = [0.04, 0.01]\ncorrelation = [[0.5]]\n",
        )
        .unwrap();
        let (_, sd) = arm.tip_at(Default::default(), &[0.0]);
        let sd = sd.unwrap() * 1e3;
        let across = 500.0 * 0.01f64.to_radians();
        assert!((sd.x - 0.05).abs() < 1e-9, "3, 4, 5");
        assert!((sd.y - 0.03f64.hypot(across)).abs() < 1e-9);
        assert!((sd.z - 0.03).abs() < 1e-12);
        let known = arm.uncertainty.as_ref().unwrap();
        assert!((known.covariance[(0, 1)] - 0.5 * 0.04e-3 * 0.01f64.to_radians()).abs() < 1e-18);
        let again = Robot::from_text("again.toml", &arm.to_toml(&[]).unwrap(), None, None).unwrap();
        let difference = &again.uncertainty.unwrap().covariance - &known.covariance;
        assert!(difference.amax() < 1e-6 * known.covariance.amax());
    }

    #[test]
    fn what_is_wrong_is_said() {
        let message = |section: &str| robot(&format!("[uncertainty]\n{section}")).unwrap_err().to_string();
        for (section, expected) in [
            ("parameters = [\"base_x\"]\nstd_error = [1]\ncorrelation = []", "theta2_deg"),
            ("parameters = [\"a1_mm\"]\nstd_error = []\ncorrelation = []", "1 numbers"),
            ("parameters = [\"a1_mm\"]\nstd_error = [-1]\ncorrelation = []", "a number >= 0"),
            ("parameters = [\"a1_mm\", \"d1_mm\"]\nstd_error = [1, 1]\ncorrelation = []", "1 rows"),
            ("parameters = [\"a1_mm\", \"d1_mm\"]\nstd_error = [1, 1]\ncorrelation = [[2]]", "from -1 to 1"),
        ] {
            let message = message(section);
            assert!(message.contains(expected) && message.contains("arm.toml:"), "{section}: {message}");
        }
    }
}
