//! What a URDF has no place for, in a file beside it (TOML): tip, uncertainty, calibrated ranges and effects, in the sections
//! that a robot file has.

use serde::Deserialize;
use toml::Spanned;

use super::calibrated_section::{self, RawCalibrated};
use super::effects_file::{self, RawEffect};
use super::file::{self, RawTip};
use super::uncertainty::{self, RawUncertainty};
use super::{Effect, Robot, Uncertainty};
use crate::error::Result;
use crate::toml_text::{self, TomlText, in_unit};
use crate::units::MM;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawBeside {
    tip: Option<RawTip>,
    uncertainty: Option<RawUncertainty>,
    calibrated: Option<RawCalibrated>,
    #[serde(default)]
    effect: Vec<Spanned<RawEffect>>,
}

impl Robot {
    /// The sections of a robot file that are about no joint's geometry, below `comments`.
    pub fn beside_to_toml(&self, comments: &[String]) -> String {
        let mut text = toml_text::comments(comments);
        if let Some(tip) = &self.tip {
            let at: Vec<f64> = tip.at.iter().map(|&x| in_unit(x, MM)).collect();
            text += &format!("\n[tip]\nxyz_mm = {at:?}\n");
            text += &tip.sd.map_or_else(String::new, |sd| format!("sd_mm = {:?}\n", in_unit(sd, MM)));
        }
        text += &self.uncertainty.as_ref().map_or_else(String::new, Uncertainty::written);
        text += &self.calibrated.as_ref().map_or_else(String::new, |range| range.written(&self.joints));
        text + &self.effects.iter().map(effects_file::written).collect::<String>()
    }

    /// Adds what stands in a file beside the robot's own.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let mut arm = Robot::new("arm", vec![Joint::new("one", Motion::Revolute, Hayati::default())]);
    /// let text = "[[effect]]\nname = \"encoder_scale\"\njoint = 1\nfactor = 1.001\n";
    /// arm.add_beside("effects.toml", text)?;
    /// assert!((arm.correction(0, &[1.0], &[]) - 1e-3).abs() < 1e-15);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Syntax`] or [`crate::Error::Input`] with line and column.
    pub fn add_beside(&mut self, file: &str, text: &str) -> Result<()> {
        let toml = TomlText::new(file, text);
        let raw: RawBeside = toml.parse(file::REQUIRED)?;
        let count = self.joints.len();
        if let Some(tip) = &raw.tip {
            self.tip = Some(file::tip(&toml, tip)?);
        }
        if let Some(known) = &raw.uncertainty {
            self.uncertainty = Some(uncertainty::read(&toml, known, count)?);
        }
        if let Some(range) = &raw.calibrated {
            self.calibrated = Some(calibrated_section::read(&toml, range, &self.joints)?);
        }
        let read = |effect: &Spanned<RawEffect>| effects_file::read(&toml, effect, count);
        let effects: Vec<Effect> = raw.effect.iter().map(read).collect::<Result<_>>()?;
        self.effects.extend(effects);
        Ok(())
    }
}
