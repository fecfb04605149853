//! The constants of a law in a file: `[[law.constant]]`.

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
            unit: own.unit.clone(),
        });
    }
    Ok(constants)
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
