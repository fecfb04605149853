//! `[standard_uncertainty]`: how well the numbers of a rod file are known.

use serde::Deserialize;

use super::check::Check;
use crate::error::Result;
use crate::rod::StandardUncertainty;
use crate::toml_text::Number;
use crate::units::{GRAM, MM, PERCENT};

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, expecting = "a section [standard_uncertainty]")]
pub(super) struct RawUncertainty {
    pub youngs_modulus_percent: Option<Number>,
    pub shear_modulus_percent: Option<Number>,
    pub density_percent: Option<Number>,
    pub shear_coefficient_percent: Option<Number>,
    diameter_mm: Option<Number>,
    length_mm: Option<Number>,
    tip_mass_g: Option<Number>,
    section_percent: Option<Number>,
}

/// A key of the table with its path.
pub(super) fn of_table(field: &str) -> String {
    format!("standard_uncertainty.{field}")
}

impl Check<'_> {
    /// Of the dimensions; that of the materials is theirs.
    pub(super) fn standard_uncertainty(&mut self, raw: &RawUncertainty) -> Result<StandardUncertainty> {
        let mut known = StandardUncertainty::default();
        for (field, number, unit, target) in [
            ("diameter_mm", &raw.diameter_mm, MM, &mut known.diameter),
            ("length_mm", &raw.length_mm, MM, &mut known.length),
            ("tip_mass_g", &raw.tip_mass_g, GRAM, &mut known.tip_mass),
        ] {
            if let Some(number) = number {
                *target = self.standard_deviation(&of_table(field), number)? * unit;
            }
        }
        if let Some(number) = &raw.section_percent {
            known.section = self.percent(&of_table("section_percent"), number)?;
        }
        // also where every material has its own
        for (field, number) in [
            ("youngs_modulus_percent", &raw.youngs_modulus_percent),
            ("shear_modulus_percent", &raw.shear_modulus_percent),
            ("density_percent", &raw.density_percent),
            ("shear_coefficient_percent", &raw.shear_coefficient_percent),
        ] {
            if let Some(number) = number {
                self.percent(&of_table(field), number)?;
            }
        }
        Ok(known)
    }

    /// A standard uncertainty in per cent, as a share.
    pub(super) fn percent(&mut self, key: &str, number: &Number) -> Result<f64> {
        let percent = self.standard_deviation(key, number)?;
        if percent > LARGEST_PERCENT {
            let expected = format!("at most {LARGEST_PERCENT} per cent: what is known worse is not known");
            return Err(self.toml.is(key, number, &expected));
        }
        Ok(percent * PERCENT)
    }

    fn standard_deviation(&self, key: &str, number: &Number) -> Result<f64> {
        let value = self.toml.finite(key, number)?;
        match value >= 0.0 {
            true => Ok(value),
            false => Err(self.toml.is(key, number, "one standard deviation >= 0 (0 is exact)")),
        }
    }
}

/// A factor of two either way at one standard deviation.
const LARGEST_PERCENT: f64 = 100.0;
