//! How well a robot's numbers are known before anybody measures it: `[standard_uncertainty]` of the
//! robot file (GUM: one standard deviation).
//!
//! It is what a drawing and an assembly allow. A calibration takes the nominal robot for known to
//! that, up to a common factor that its data may correct, so that what the poses hardly show stays
//! where the drawing has it.

use serde::Deserialize;

use super::{Parameter, ParameterGroup};
use crate::error::Result;
use crate::toml_text::{Number, TomlText};
use crate::units::{DEG, MM};

/// One standard deviation of the numbers of a robot as built about its drawing.
///
/// ```
/// use rodcal::prelude::*;
/// use rodcal::robot::StandardUncertainty;
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let tx90 = Robot::from_text(file, text, None, None)?;
/// assert_eq!(tx90.standard_uncertainty, StandardUncertainty::default());
/// assert_eq!(tx90.standard_uncertainty.of(Parameter::A(1)), Some(1e-3));
/// // where the robot stands is no part of its drawing
/// assert_eq!(tx90.standard_uncertainty.of(Parameter::BasePosition(0)), None);
/// # Ok::<(), rodcal::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StandardUncertainty {
    /// d, a and the origins of a URDF, m.
    pub length: f64,
    /// α and β, rad.
    pub angle: f64,
    /// θ: the zero of a joint, rad.
    pub joint_zero: f64,
    /// Masses of links and where their centres are, as a share.
    pub mass: f64,
}

impl Default for StandardUncertainty {
    /// 1 mm, 0.1°, 0.3°, 20 %.
    fn default() -> Self {
        StandardUncertainty { length: MM, angle: 0.1 * DEG, joint_zero: 0.3 * DEG, mass: 0.2 }
    }
}

impl StandardUncertainty {
    /// Of a parameter, in its unit; `None` for what no drawing says: base, tool, compliance.
    pub fn of(&self, parameter: Parameter) -> Option<f64> {
        match parameter.group() {
            ParameterGroup::LinkLength => Some(self.length),
            ParameterGroup::LinkTwist => Some(self.angle),
            ParameterGroup::JointZero => Some(self.joint_zero),
            ParameterGroup::BasePosition
            | ParameterGroup::BaseRotation
            | ParameterGroup::Tool
            | ParameterGroup::Compliance => None,
        }
    }

    /// The section of a robot file; nothing where it says what is taken for granted anyway.
    pub(super) fn written(&self) -> String {
        if *self == StandardUncertainty::default() {
            return String::new();
        }
        format!(
            "\n[standard_uncertainty]\nlength_mm = {:?}\nangle_deg = {:?}\njoint_zero_deg = {:?}\nmass_percent = {:?}\n",
            self.length / MM,
            self.angle / DEG,
            self.joint_zero / DEG,
            self.mass * 100.0
        )
    }
}

#[derive(Deserialize, Default)]
#[serde(
    deny_unknown_fields,
    expecting = "a section [standard_uncertainty] with length_mm, angle_deg, joint_zero_deg, mass_percent"
)]
pub(super) struct RawStandardUncertainty {
    length_mm: Option<Number>,
    angle_deg: Option<Number>,
    joint_zero_deg: Option<Number>,
    mass_percent: Option<Number>,
}

/// The section of a robot file; 0 is exact.
pub(super) fn read(toml: &TomlText, raw: &RawStandardUncertainty) -> Result<StandardUncertainty> {
    let known = StandardUncertainty::default();
    let or = |key: &str, number: &Option<Number>, unit: f64, otherwise: f64| match number {
        Some(number) => Ok(toml.not_negative(&format!("standard_uncertainty.{key}"), number)? * unit),
        None => Ok(otherwise),
    };
    Ok(StandardUncertainty {
        length: or("length_mm", &raw.length_mm, MM, known.length)?,
        angle: or("angle_deg", &raw.angle_deg, DEG, known.angle)?,
        joint_zero: or("joint_zero_deg", &raw.joint_zero_deg, DEG, known.joint_zero)?,
        mass: or("mass_percent", &raw.mass_percent, 0.01, known.mass)?,
    })
}
