//! The laws of a rod file: `[[law]]`.

use serde::Deserialize;
use toml::Spanned;

use super::check::Check;
use crate::error::Result;
use crate::limits;
use crate::rod::constants::{self, RawConstant};
use crate::rod::{LawMemory, LawVariable, Rod, RodLaw, RodLawPlace, Warning};
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

/// Where in its range a formula is tried.
const TRIED: usize = 8;

impl Check<'_> {
    /// Adds the laws to the rod.
    pub(super) fn laws(&mut self, raw: &[RawLaw], rod: &mut Rod) -> Result<()> {
        limits::check(self.toml.file(), raw.len(), limits::ROD_PARTS, "laws")?;
        for raw in raw {
            let law = self.law(raw, rod)?;
            if !(law.is_of_rod() && law.is_static()) {
                self.warnings.push(Warning::LawOfRig { law: law.to_string(), is_static: law.is_static() });
            }
            rod.laws.push(law);
        }
        Ok(())
    }

    fn law(&self, raw: &RawLaw, rod: &Rod) -> Result<RodLaw> {
        let toml = self.toml;
        let place = self.place(raw, rod)?;
        let at_place = || LawVariable::ALL.into_iter().filter(|variable| variable.is_at(&place));
        let Some(variable) = at_place().find(|variable| variable.key() == raw.variable.get_ref()) else {
            let known: Vec<&str> = at_place().map(LawVariable::key).collect();
            let expected = format!("a variable of {place}: {}", known.join(", "));
            return Err(toml.is("law.variable", &raw.variable, &expected));
        };
        let constants = constants::read(&toml, &raw.constant, variable.symbol())?;
        let range = constants::range(&toml, &raw.range)?;
        let mut law = RodLaw::new(place, variable, raw.formula.get_ref(), constants, range)
            .map_err(|fault| toml.in_formula(&raw.formula, fault))?;
        law.source.clone_from(&raw.source);
        if let Some(memory) = &raw.memory {
            let known = |own: &LawMemory| own.key() == memory.get_ref();
            let Some(of_key) = LawMemory::ALL.into_iter().find(known) else {
                return Err(toml.is("law.memory", memory, &LawMemory::keys()));
            };
            for needed in of_key.constants() {
                let own = law.constants.iter().find(|own| own.name == needed.name);
                if !own.is_some_and(|own| needed.may_be(own.value)) {
                    let expected = format!("with it a constant {}", needed.description());
                    return Err(toml.is("law.memory", memory, &expected));
                }
            }
            let value =
                |name: &str| law.constants.iter().find(|own| own.name == name).map_or(0.0, |own| own.value);
            if let Some(expected) = of_key.amiss(value) {
                return Err(toml.is("law.memory", memory, &format!("with it constants {expected}")));
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

    fn place(&self, raw: &RawLaw, rod: &Rod) -> Result<RodLawPlace> {
        let place = RodLawPlace::named(raw.place.get_ref());
        let joints = || rod.joints.iter().map(|joint| joint.name.as_str());
        match &place {
            RodLawPlace::Joint(name) if joints().all(|joint| joint != name) => {
                let of_every_rod = RodLawPlace::OF_EVERY_ROD.iter().map(RodLawPlace::to_string);
                let known: Vec<String> = of_every_rod.chain(joints().map(str::to_owned)).collect();
                Err(self.toml.is("law.place", &raw.place, &format!("one of {}", known.join(", "))))
            }
            _ => Ok(place),
        }
    }
}
