//! What a URDF has no place for, in a file beside it (TOML): tip, uncertainty, calibrated ranges,
//! effects and laws, in the sections that a robot file has.

use serde::Deserialize;
use toml::Spanned;

use super::calibrated::{self, RawCalibrated};
use super::effects_file::{self, RawEffect};
use super::file::{self, RawTip};
use super::law_file::{self, RawLaw};
use super::uncertainty::{self, RawUncertainty};
use super::write::{are_prismatic, joint_units};
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
    #[serde(default)]
    law: Vec<Spanned<RawLaw>>,
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
        text += &self
            .calibrated
            .as_ref()
            .map_or_else(String::new, |range| range.written(&joint_units(&self.joints)));
        text += &self.effects.iter().map(effects_file::written).collect::<String>();
        text + &self.laws.iter().map(law_file::written).collect::<String>()
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
            self.calibrated = Some(calibrated::read(&toml, range, &joint_units(&self.joints))?);
        }
        let read = |effect: &Spanned<RawEffect>| effects_file::read(&toml, effect, count);
        let effects: Vec<Effect> = raw.effect.iter().map(read).collect::<Result<_>>()?;
        self.laws.extend(law_file::read(&toml, &raw.law, &are_prismatic(&self.joints))?);
        self.effects.extend(effects);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::robot::{CalibratedRange, Hayati, Joint, Motion, Parameter, Tip, TorquePower};

    #[test]
    fn what_is_written_beside_a_urdf_is_read_again() {
        let joints = ["a", "b"].map(|name| Joint::new(name, Motion::Revolute, Hayati::default()));
        let bare = Robot::new("arm", joints.to_vec());
        let mut arm = bare.clone();
        arm.effects = vec![
            Effect::PlayByApproach { joint: 1, play: 2e-4 },
            Effect::Lag { joint: None, fraction: 3e-4 },
            Effect::Lag { joint: Some(0), fraction: 1e-4 },
            Effect::Weight { joint: 0, at: Some(1), per_metre: 1e-3 },
            Effect::Weight { joint: 0, at: None, per_metre: 2e-3 },
            Effect::Compliance { joint: 1, per_nm: 1e-5 },
            Effect::NonlinearStiffness { joint: 0, power: TorquePower::Square, coefficient: 3e-9 },
            Effect::NonlinearStiffness { joint: 1, power: TorquePower::Cube, coefficient: -2e-11 },
            Effect::LinkFlexibility { joint: 1, per_nm: 2e-6, at: 0.0 },
            Effect::LinkFlexibility { joint: 0, per_nm: 3e-6, at: 0.425 },
            Effect::GravityTilt { per_nm: 4e-6 },
            Effect::Friction { joint: 1, per_nm: 6e-6 },
        ];
        arm.tip = Some(Tip { at: [0.0, 0.0, 0.25].into(), sd: Some(5e-5) });
        arm.calibrated = Some(CalibratedRange { joints: vec![(-0.5, 0.5), (0.25, 1.0)], sd: 1e-5 });
        let covariance = DMatrix::from_element(1, 1, 1e-10);
        arm.uncertainty = Some(Uncertainty { parameters: vec![Parameter::A(0)], covariance });
        let text = arm.beside_to_toml(&["said".to_owned()]);
        let mut again = bare.clone();
        again.add_beside("effects.toml", &text).unwrap();
        assert_eq!(again.beside_to_toml(&["said".to_owned()]), text);
        assert_eq!((&again.effects, again.tip.is_some()), (&arm.effects, true));
        let range = again.calibrated.unwrap();
        assert!((range.joints[1].1 - 1.0).abs() < 1e-12 && (range.sd - 1e-5).abs() < 1e-15);
        let message = |text: &str| bare.clone().add_beside("e.toml", text).unwrap_err().to_string();
        for (text, expected) in [
            (
                "[[effect]]\nname = \"backlash\"\njoint = 1\nplay_urad = 9\ntaken_up = \"wind\"\n",
                "\"approach\"",
            ),
            (
                "[[effect]]\nname = \"weight\"\njoint = 1\nat_joint = 3\nurad_per_m = 9\n",
                "a joint from 1 to 2",
            ),
            (
                "[[effect]]\nname = \"gravity_tilt\"\njoint = 1\nurad_per_nm = 9\n",
                "no joint: the whole arm tilts",
            ),
            ("[calibrated]\nlow_deg_or_mm = [1]\nhigh_deg_or_mm = [1, 2]\nsd_mm = 1\n", "2 numbers"),
        ] {
            let message = message(text);
            assert!(message.contains(expected) && message.contains("e.toml:"), "{message}");
        }
    }

    #[test]
    fn a_weight_turns_its_joint_by_its_lever() {
        // an arm of 0.5 m that turns about a horizontal axis
        let link = Hayati { a: 0.5, ..Hayati::default() };
        let mut arm = Robot::new("arm", vec![Joint::new("one", Motion::Revolute, link)]);
        arm.gravity = [0.0, -9.8, 0.0].into();
        arm.effects = vec![Effect::Weight { joint: 0, at: None, per_metre: 1e-3 }];
        let lowered = |q: f64| arm.tip_at(Default::default(), &[q]).0.y - 0.5 * q.sin();
        // horizontal: a lever of 0.5 m turns it down by 0.5 mrad, which the tip sinks by 0.25 mm;
        // upright: not at all
        assert!((lowered(0.0) + 0.25e-3).abs() < 1e-9);
        assert!(lowered(std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    }
}
