//! What the user states about single parameters: `[parameters]` and `[[prior]]`.

use serde::Deserialize;
use toml::Spanned;

use super::ParameterConstraints;
use crate::delimited::nearest_name;
use crate::error::{Error, Result};
use crate::robot::Parameter;
use crate::toml_text::{Number, TomlText};

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a section [parameters] with fix, free")]
pub(super) struct RawParameters {
    #[serde(default)]
    fix: Vec<Spanned<String>>,
    #[serde(default)]
    free: Vec<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[prior]] with parameter, value, sd")]
pub(super) struct RawPrior {
    parameter: Spanned<String>,
    value: Number,
    sd: Number,
}

/// The constraints for a robot with `joints` joints; each parameter may be spoken of once, but
/// freed with a prior.
pub(super) fn parameter_constraints(
    toml: TomlText<'_>,
    raw: &RawParameters,
    priors: &[RawPrior],
    joints: usize,
) -> Result<ParameterConstraints> {
    let reader = Reader { toml, joints };
    let mut constraints = ParameterConstraints::default();
    for name in &raw.fix {
        let parameter = reader.parameter("parameters.fix", name)?;
        reader.once(name, parameter, &constraints.fixed, "in fix")?;
        constraints.fixed.push(parameter);
    }
    for name in &raw.free {
        let parameter = reader.parameter("parameters.free", name)?;
        reader.once(name, parameter, &constraints.freed, "in free")?;
        reader.once(name, parameter, &constraints.fixed, "in fix")?;
        constraints.freed.push(parameter);
    }
    for RawPrior { parameter: name, value, sd } in priors {
        let parameter = reader.parameter("prior.parameter", name)?;
        if parameter.key() != *name.get_ref() {
            // value and sd would be without a unit
            let expected = format!("\"{}\", with the unit of value and sd", parameter.key());
            return Err(toml.is("prior.parameter", name, &expected));
        }
        let known: Vec<Parameter> = constraints.priors.iter().map(|&(known, ..)| known).collect();
        reader.once(name, parameter, &known, "in another [[prior]]")?;
        reader.once(name, parameter, &constraints.fixed, "in fix")?;
        let unit = parameter.unit().si;
        let value = toml.finite("prior.value", value)? * unit;
        constraints.priors.push((parameter, value, toml.positive("prior.sd", sd)? * unit));
    }
    Ok(constraints)
}

struct Reader<'a> {
    toml: TomlText<'a>,
    joints: usize,
}

impl Reader<'_> {
    fn parameter(&self, key: &str, name: &Spanned<String>) -> Result<Parameter> {
        Parameter::from_key(name.get_ref(), self.joints).ok_or_else(|| self.unknown(key, name))
    }

    fn unknown(&self, key: &str, name: &Spanned<String>) -> Error {
        let joints = self.joints;
        let expected =
            format!("a parameter such as \"a1_mm\" or \"tool_z_mm\" of a robot with {joints} joints");
        let keys: Vec<String> = Parameter::all(joints).into_iter().map(Parameter::key).collect();
        let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
        // the same parameter of another joint is near in letters only
        let is_of_a_longer_robot = Parameter::from_key(name.get_ref(), 2 * joints + 10).is_some();
        let near = nearest_name(name.get_ref(), &keys).filter(|_| !is_of_a_longer_robot);
        let error = self.toml.wrong(name, format!("`{key}` has {}", self.toml.source(name)), &expected);
        error.with_hint(near.map(|near| format!("did you mean \"{near}\"?")))
    }

    /// Refuses a parameter that is among the `known` ones, which stand `there`.
    fn once(
        &self,
        name: &Spanned<String>,
        parameter: Parameter,
        known: &[Parameter],
        there: &str,
    ) -> Result<()> {
        if !known.contains(&parameter) {
            return Ok(());
        }
        let found = format!("{} stands {there} already", self.toml.source(name));
        Err(self.toml.wrong(name, found, "one constraint for each parameter"))
    }
}
