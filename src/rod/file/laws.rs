//! The laws of a rod file: `[[law]]`.

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use crate::error::Result;
use crate::expression::is_reserved;
use crate::limits;
use crate::rod::{LawConstant, LawMemory, LawVariable, Rod, RodLaw, Warning};
use crate::toml_text::Number;

#[derive(Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a section [[law]] with place, variable, formula, range and its constants"
)]
pub(super) struct RawLaw {
    place: Spanned<String>,
    variable: Spanned<String>,
    formula: Spanned<String>,
    memory: Option<Spanned<String>>,
    range: Spanned<Vec<Number>>,
    source: Option<String>,
    #[serde(default)]
    constant: Vec<RawConstant>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[law.constant]] with name and value")]
struct RawConstant {
    name: Spanned<String>,
    value: Number,
    standard_uncertainty: Option<Number>,
    #[serde(default)]
    unit: String,
}

/// Places of a rod file besides its joints.
const PLACES: [&str; 7] = ["rod", "clamp", "root", "slide", "dx", "dy", "dz"];
/// Where in its range a formula is tried.
const TRIED: usize = 8;

impl Check<'_> {
    /// Adds the laws to the rod.
    pub(super) fn laws(&mut self, raw: &[RawLaw], rod: &mut Rod) -> Result<()> {
        limits::check(self.toml.file(), raw.len(), limits::ROD_PARTS, "laws")?;
        for raw in raw {
            let law = self.law(raw, rod)?;
            if !(law.is_of_rod() && law.is_static()) {
                self.warnings.push(Warning::LawOfRig { law: law.words(), is_static: law.is_static() });
            }
            rod.laws.push(law);
        }
        Ok(())
    }

    fn law(&self, raw: &RawLaw, rod: &Rod) -> Result<RodLaw> {
        let toml = self.toml;
        let place = raw.place.get_ref();
        let joints = rod.joints.iter().map(|joint| joint.name.as_str());
        if !PLACES.contains(&place.as_str()) && joints.clone().all(|joint| joint != place) {
            let known: Vec<&str> = PLACES.into_iter().chain(joints).collect();
            return Err(toml.is("law.place", &raw.place, &format!("one of {}", known.join(", "))));
        }
        let at_place = || LawVariable::ALL.into_iter().filter(|variable| variable.is_at(place));
        let Some(variable) = at_place().find(|variable| variable.key() == raw.variable.get_ref()) else {
            let known: Vec<&str> = at_place().map(LawVariable::key).collect();
            let expected = format!("a variable of {place}: {}", known.join(", "));
            return Err(toml.is("law.variable", &raw.variable, &expected));
        };
        limits::check(toml.file(), raw.constant.len(), limits::OWN_PARAMETERS, "constants of a law")?;
        let mut constants: Vec<LawConstant> = Vec::new();
        for own in &raw.constant {
            let name = own.name.get_ref();
            let is_taken = name == variable.symbol() || constants.iter().any(|other| other.name == *name);
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
        let range = match &raw.range.get_ref()[..] {
            [low, high] => (toml.finite("law.range", low)?, toml.finite("law.range", high)?),
            _ => (0.0, 0.0),
        };
        if range.0 >= range.1 {
            return Err(toml.is("law.range", &raw.range, "two numbers, [from, to]: where it was recorded"));
        }
        let mut law = RodLaw::new(place, variable, raw.formula.get_ref(), constants, range)
            .map_err(|fault| toml.in_formula(&raw.formula, fault))?;
        law.source.clone_from(&raw.source);
        if let Some(memory) = &raw.memory {
            let known = [LawMemory::Stop, LawMemory::Lag].into_iter();
            let Some(of_key) = known.clone().find(|known| known.key() == memory.get_ref()) else {
                return Err(toml.is("law.memory", memory, "\"stop\" or \"lag\""));
            };
            let own = law.constants.iter().find(|own| own.name == of_key.constant());
            if own.is_none_or(|own| own.value <= 0.0) {
                let expected = format!("with it a constant {} > 0", of_key.constant());
                return Err(toml.is("law.memory", memory, &expected));
            }
            law.memory = Some(of_key);
        }
        for k in 0..=TRIED {
            let x = range.0 + (range.1 - range.0) * k as f64 / TRIED as f64;
            if !law.at(x, 1.0).is_finite() {
                let found = format!("`law.formula` is no number at {} = {x}", variable.symbol());
                return Err(toml.wrong(&raw.formula, found, "a formula that is defined in its range"));
            }
        }
        Ok(law)
    }
}

fn is_name(name: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '\'';
    name.len() <= limits::NAME_BYTES
        && name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(is_part)
        && name != crate::rod::law::SIDE
}
