//! Where a robot was calibrated: the ranges of its joints, and how sure its tip is there by its
//! numbers alone.

use serde::Deserialize;
use toml::Spanned;

use crate::error::Result;
use crate::toml_text::{Number, TomlText, in_unit};
use crate::units::MM;

/// The poses that a robot was calibrated with, as far as a prediction asks for them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CalibratedRange {
    /// Least and greatest value of each joint, rad or m.
    pub joints: Vec<(f64, f64)>,
    /// √tr(J·Σ·Jᵀ), root mean square over these poses, m; base left out, as its user aligns it.
    pub sd: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [calibrated]")]
pub(super) struct RawCalibrated {
    low_deg_or_mm: Spanned<Vec<Number>>,
    high_deg_or_mm: Spanned<Vec<Number>>,
    sd_mm: Number,
}

impl CalibratedRange {
    /// The section of a robot file; `units` of the joints in SI.
    pub(super) fn written(&self, units: &[f64]) -> String {
        let bound = |end: fn(&(f64, f64)) -> f64| -> Vec<f64> {
            self.joints.iter().zip(units).map(|(range, unit)| in_unit(end(range), *unit)).collect()
        };
        let (low, high) = (bound(|range| range.0), bound(|range| range.1));
        let sd = in_unit(self.sd, MM);
        format!("\n[calibrated]\nlow_deg_or_mm = {low:?}\nhigh_deg_or_mm = {high:?}\nsd_mm = {sd:?}\n")
    }
}

/// The section of a robot whose joints have these units in SI.
pub(super) fn read(toml: &TomlText, raw: &RawCalibrated, units: &[f64]) -> Result<CalibratedRange> {
    let bound = |key: &str, list: &Spanned<Vec<Number>>| -> Result<Vec<f64>> {
        if list.get_ref().len() != units.len() {
            return Err(toml.is(key, list, &format!("{} numbers, one for each joint", units.len())));
        }
        let number = |(number, unit): (&Number, &f64)| Ok(toml.finite(key, number)? * unit);
        list.get_ref().iter().zip(units).map(number).collect()
    };
    let low = bound("calibrated.low_deg_or_mm", &raw.low_deg_or_mm)?;
    let high = bound("calibrated.high_deg_or_mm", &raw.high_deg_or_mm)?;
    Ok(CalibratedRange {
        joints: low.into_iter().zip(high).collect(),
        sd: toml.not_negative("calibrated.sd_mm", &raw.sd_mm)? * MM,
    })
}
