//! The section `[calibrated]` of a robot file.

use serde::Deserialize;
use toml::Spanned;

use super::calibrated::CalibratedRange;
use super::{Joint, Motion};
use crate::error::Result;
use crate::toml_text::{Number, TomlText, in_unit};
use crate::units::{DEG, MM};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [calibrated]")]
pub(super) struct RawCalibrated {
    low_deg_or_mm: Spanned<Vec<Number>>,
    high_deg_or_mm: Spanned<Vec<Number>>,
    sd_mm: Number,
}

fn unit(joint: &Joint) -> f64 {
    if joint.motion == Motion::Revolute { DEG } else { MM }
}

impl CalibratedRange {
    /// The section of a robot file.
    pub(super) fn written(&self, joints: &[Joint]) -> String {
        let bound = |of: fn(&(f64, f64)) -> f64| -> Vec<f64> {
            self.joints.iter().zip(joints).map(|(range, joint)| in_unit(of(range), unit(joint))).collect()
        };
        let (low, high) = (bound(|range| range.0), bound(|range| range.1));
        let sd = in_unit(self.sd, MM);
        format!("\n[calibrated]\nlow_deg_or_mm = {low:?}\nhigh_deg_or_mm = {high:?}\nsd_mm = {sd:?}\n")
    }
}

/// The section of a robot of these joints.
pub(super) fn read(toml: &TomlText, raw: &RawCalibrated, joints: &[Joint]) -> Result<CalibratedRange> {
    let bound = |key: &str, list: &Spanned<Vec<Number>>| -> Result<Vec<f64>> {
        if list.get_ref().len() != joints.len() {
            return Err(toml.is(key, list, &format!("{} numbers, one for each joint", joints.len())));
        }
        let number = |(number, joint): (&Number, &Joint)| Ok(toml.finite(key, number)? * unit(joint));
        list.get_ref().iter().zip(joints).map(number).collect()
    };
    let low = bound("calibrated.low_deg_or_mm", &raw.low_deg_or_mm)?;
    let high = bound("calibrated.high_deg_or_mm", &raw.high_deg_or_mm)?;
    Ok(CalibratedRange {
        joints: low.into_iter().zip(high).collect(),
        sd: toml.not_negative("calibrated.sd_mm", &raw.sd_mm)? * MM,
    })
}
