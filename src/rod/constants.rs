//! The constants of a law in a file: `[[law.constant]]`.

use nalgebra::DMatrix;
use serde::Deserialize;
use toml::Spanned;

use super::law::{LawConstant, SIDE};
use crate::error::Result;
use crate::expression::is_reserved;
use crate::limits;
use crate::toml_text::{Number, TomlText, quoted};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[law.constant]] with name and value")]
pub(crate) struct RawConstant {
    name: Spanned<String>,
    value: Number,
    standard_uncertainty: Option<Number>,
    correlation: Option<Spanned<Vec<Number>>>,
    #[serde(default)]
    unit: String,
}

/// Constants of a formula whose variable is `symbol`.
pub(crate) fn read(toml: &TomlText, raw: &[RawConstant], symbol: &str) -> Result<Vec<LawConstant>> {
    limits::check(toml.file(), raw.len(), limits::LAW_CONSTANTS, "constants of a law")?;
    let mut constants: Vec<LawConstant> = Vec::new();
    for own in raw {
        let name = own.name.get_ref();
        let is_taken = name == symbol || constants.iter().any(|other| other.name == *name);
        // what is read as something else is no name
        if is_taken || !is_name(name) || is_reserved(name) {
            let expected = "a name of its own: letters, digits and _, no variable and no function";
            return Err(toml.is("law.constant.name", &own.name, expected));
        }
        constants.push(LawConstant {
            name: name.clone(),
            value: toml.finite("law.constant.value", &own.value)?,
            standard_uncertainty: match &own.standard_uncertainty {
                Some(number) => toml.not_negative("law.constant.standard_uncertainty", number)?,
                None => 0.0,
            },
            correlation: match &own.correlation {
                Some(row) => correlation(toml, row, constants.len())?,
                None => Vec::new(),
            },
            unit: own.unit.clone(),
        });
        if let Some(row) = own.correlation.as_ref().filter(|_| !is_possible(&constants)) {
            let expected = "correlations that constants can have with each other";
            return Err(toml.is("law.constant.correlation", row, expected));
        }
    }
    Ok(constants)
}

/// A constant's correlations with those before it.
fn correlation(toml: &TomlText, row: &Spanned<Vec<Number>>, before: usize) -> Result<Vec<f64>> {
    if row.get_ref().len() != before {
        let expected = format!("{before} numbers: one for each constant before it");
        return Err(toml.is("law.constant.correlation", row, &expected));
    }
    let one = |number: &Number| {
        let value = toml.finite("law.constant.correlation", number)?;
        match value.abs() <= 1.0 {
            true => Ok(value),
            false => Err(toml.is("law.constant.correlation", number, "numbers from -1 to 1")),
        }
    };
    row.get_ref().iter().map(one).collect()
}

/// True where no combination of the constants has a negative variance, but for rounding.
fn is_possible(constants: &[LawConstant]) -> bool {
    const ROUNDING: f64 = 1e-3;
    correlations(constants).symmetric_eigenvalues().iter().all(|value| *value > -ROUNDING)
}

fn correlations(constants: &[LawConstant]) -> DMatrix<f64> {
    let count = constants.len();
    DMatrix::from_fn(count, count, |i, j| match i == j {
        true => 1.0,
        false => constants[i.max(j)].correlation.get(i.min(j)).copied().unwrap_or(0.0),
    })
}

/// The covariance of a law's constants, each in its unit.
pub(crate) fn covariance(constants: &[LawConstant]) -> DMatrix<f64> {
    let mut covariance = correlations(constants);
    for (k, own) in constants.iter().enumerate() {
        covariance.row_mut(k).scale_mut(own.standard_uncertainty);
        covariance.column_mut(k).scale_mut(own.standard_uncertainty);
    }
    covariance
}

/// From where to where a law was recorded.
pub(crate) fn range(toml: &TomlText, raw: &Spanned<Vec<Number>>) -> Result<(f64, f64)> {
    let range = match &raw.get_ref()[..] {
        [low, high] => (toml.finite("law.range", low)?, toml.finite("law.range", high)?),
        _ => (0.0, 0.0),
    };
    match range.0 < range.1 {
        true => Ok(range),
        false => Err(toml.is("law.range", raw, "two numbers, [from, to]: where it was recorded")),
    }
}

/// Range, source and constants as lines of a file.
pub(crate) fn written(range: (f64, f64), source: Option<&str>, constants: &[LawConstant]) -> Vec<String> {
    let mut lines = vec![format!("range = [{:?}, {:?}]", range.0, range.1)];
    lines.extend(source.map(|source| format!("source = {}", quoted(source))));
    for own in constants {
        lines.push(format!("[[law.constant]]\nname = {}", quoted(&own.name)));
        lines.push(format!("value = {:?}", own.value));
        lines.push(format!("standard_uncertainty = {:?}", own.standard_uncertainty));
        if own.correlation.iter().any(|value| *value != 0.0) {
            lines.push(format!("correlation = {:?}", own.correlation));
        }
        lines.push(format!("unit = {}", quoted(&own.unit)));
    }
    lines
}

fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    name.len() <= limits::NAME_BYTES
        && name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(is_part)
        && name != SIDE
}
