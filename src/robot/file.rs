//! The reader of robot files: a table of joints in TOML, or a URDF. Every error names the place and
//! what is right.

use nalgebra::Vector3;
use serde::Deserialize;
use toml::Spanned;

use super::calibrated::{self, RawCalibrated};
use super::defaults::{DOWN, default_name, file_stem};
use super::effects_file::{self, RawEffect};
use super::law_file::{self, RawLaw};
use super::standard_uncertainty::{self, RawStandardUncertainty};
use super::uncertainty::{self, RawUncertainty};
use super::write::{are_prismatic, joint_units};
use super::{Body, Effect, Hayati, Joint, Motion, Robot, Tip, urdf};
use crate::error::Result;
use crate::limits;
use crate::spatial::Pose;
use crate::toml_text::{Number, Required, TomlText};
use crate::units::{DEG, MM, URAD_PER_NM};

impl Robot {
    /// Reads and checks the text of a robot file; `file` names it in errors (and the robot, where
    /// it has no name).
    ///
    /// A text that begins with `<` is a URDF, of which the chain from `base_link` to `tip_link` is
    /// read; where none are given, from the link named `base_link` to the one named `tip_link`. Any
    /// other text is a table in TOML, which needs no links.
    ///
    /// A table, the paper's TX90 (Table 1):
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
    /// let tx90 = Robot::from_text(file, text, None, None)?;
    /// assert_eq!((tx90.joints.len(), tx90.joints[1].link.a), (6, 0.425));
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// A URDF, two links of 0.4 m and 0.3 m about z:
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let text = r#"<robot name="arm">
    ///   <link name="base_link"/> <link name="upper"/> <link name="lower"/> <link name="tip_link"/>
    ///   <joint name="shoulder" type="continuous">
    ///     <parent link="base_link"/> <child link="upper"/> <axis xyz="0 0 1"/>
    ///   </joint>
    ///   <joint name="elbow" type="continuous">
    ///     <parent link="upper"/> <child link="lower"/> <origin xyz="0.4 0 0"/> <axis xyz="0 0 1"/>
    ///   </joint>
    ///   <joint name="hand" type="fixed">
    ///     <parent link="lower"/> <child link="tip_link"/> <origin xyz="0.3 0 0"/>
    ///   </joint>
    /// </robot>"#;
    /// let arm = Robot::from_text("arm.urdf", text, None, None)?;
    /// let hand = arm.flange_at(&[0.0, std::f64::consts::FRAC_PI_2]).origin;
    /// assert!((hand.x - 0.4).abs() < 1e-12 && (hand.y - 0.3).abs() < 1e-12);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Syntax`] or [`crate::Error::Input`] with line and column.
    pub fn from_text(
        file: &str,
        text: &str,
        base_link: Option<&str>,
        tip_link: Option<&str>,
    ) -> Result<Robot> {
        match is_urdf(text) {
            true => urdf::read(file, text, base_link, tip_link),
            false => read_table(file, text),
        }
    }

    /// File name and text of a robot that the program carries: `tx90`.
    pub fn builtin(name: &str) -> Option<(&'static str, &'static str)> {
        match name {
            "tx90" => Some(("robots/tx90.toml", include_str!("../../robots/tx90.toml"))),
            _ => None,
        }
    }
}

/// True of XML, which no TOML begins like.
///
/// ```
/// use rodcal::robot::is_urdf;
///
/// assert!(is_urdf("<?xml version=\"1.0\"?><robot/>") && !is_urdf("name = \"TX90\""));
/// ```
pub fn is_urdf(text: &str) -> bool {
    text.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}').starts_with('<')
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRobot {
    name: Option<String>,
    source: Option<String>,
    convention: Option<Spanned<String>>,
    gravity_m_s2: Option<Spanned<Vec<Number>>>,
    joint: Spanned<Vec<Spanned<RawJoint>>>,
    tip: Option<RawTip>,
    #[serde(default)]
    standard_uncertainty: RawStandardUncertainty,
    uncertainty: Option<RawUncertainty>,
    calibrated: Option<RawCalibrated>,
    #[serde(default)]
    effect: Vec<Spanned<RawEffect>>,
    #[serde(default)]
    law: Vec<Spanned<RawLaw>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [tip]")]
pub(super) struct RawTip {
    xyz_mm: Spanned<Vec<Number>>,
    sd_mm: Option<Number>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[joint]]")]
struct RawJoint {
    name: Option<String>,
    r#type: Option<Spanned<String>>,
    theta_offset_deg: Option<Number>,
    d_mm: Number,
    a_mm: Number,
    alpha_deg: Number,
    beta_deg: Option<Number>,
    compliance_urad_per_nm: Option<Number>,
    mass_kg: Option<Number>,
    com_mm: Option<Spanned<Vec<Number>>>,
    limits_deg: Option<Spanned<Vec<Number>>>,
    limits_mm: Option<Spanned<Vec<Number>>>,
}

/// What a robot file cannot do without, in words.
pub(super) const REQUIRED: &Required = &[
    ("[joint]", "a section [[joint]] with d_mm, a_mm, alpha_deg for each joint, base to flange"),
    ("d_mm", "the offset along the joint's axis in mm"),
    ("a_mm", "the length of the link in mm"),
    ("alpha_deg", "the twist of the link in degrees"),
];

fn read_table(file: &str, text: &str) -> Result<Robot> {
    let toml = TomlText::new(file, text);
    let raw: RawRobot = toml.parse(REQUIRED)?;
    if let Some(convention) = &raw.convention
        && convention.get_ref() != "hayati"
    {
        let expected =
            "\"hayati\", Rz(θ+offset)·Tz(d)·Tx(a)·Rx(α)·Ry(β); with beta_deg = 0 that is standard DH";
        return Err(toml.is("convention", convention, expected));
    }
    let table = Table(toml);
    let gravity = match &raw.gravity_m_s2 {
        Some(list) => table.vector("gravity_m_s2", list, "in m/s² in the robot's base frame")?,
        None => DOWN,
    };
    if raw.joint.get_ref().is_empty() {
        return Err(toml.wrong(&raw.joint, "the robot has no joint".to_owned(), REQUIRED[0].1));
    }
    let tip = match &raw.tip {
        Some(raw) => Some(self::tip(&table.0, raw)?),
        None => None,
    };
    let joint_count = raw.joint.get_ref().len();
    limits::check(file, joint_count, limits::ROBOT_JOINTS, "joints")?;
    limits::check(file, raw.effect.len(), limits::ROBOT_EFFECTS, "effects")?;
    let known = raw.uncertainty.as_ref().map(|known| uncertainty::read(&table.0, known, joint_count));
    let uncertainty = known.transpose()?;
    let effects: Vec<Effect> = raw
        .effect
        .iter()
        .map(|effect| effects_file::read(&table.0, effect, joint_count))
        .collect::<Result<_>>()?;
    let joints = raw.joint.get_ref().iter().enumerate();
    let joints: Vec<Joint> = joints.map(|(index, joint)| table.joint(index, joint)).collect::<Result<_>>()?;
    let calibrated =
        raw.calibrated.as_ref().map(|range| calibrated::read(&table.0, range, &joint_units(&joints)));
    let laws = law_file::read(&table.0, &raw.law, &are_prismatic(&joints))?;
    Ok(Robot {
        calibrated: calibrated.transpose()?,
        name: raw.name.unwrap_or_else(|| file_stem(file)),
        source: raw.source,
        gravity,
        root: Pose::IDENTITY,
        joints,
        flange: Pose::IDENTITY,
        effects,
        laws,
        tip,
        standard_uncertainty: standard_uncertainty::read(&table.0, &raw.standard_uncertainty)?,
        uncertainty,
    })
}

/// The section [tip].
pub(super) fn tip(toml: &TomlText, raw: &RawTip) -> Result<Tip> {
    let number = |number| Ok(toml.finite("tip.xyz_mm", number)? * MM);
    let [x, y, z] = raw.xyz_mm.get_ref().as_slice() else {
        return Err(toml.is("tip.xyz_mm", &raw.xyz_mm, "three numbers [x, y, z] in mm in {T}"));
    };
    let at = Vector3::new(number(x)?, number(y)?, number(z)?);
    let sd = raw.sd_mm.as_ref().map(|sd| toml.not_negative("tip.sd_mm", sd));
    Ok(Tip { at, sd: sd.transpose()?.map(|sd| sd * MM) })
}

/// The checks of a table's values.
struct Table<'a>(TomlText<'a>);

impl Table<'_> {
    fn joint(&self, index: usize, spanned: &Spanned<RawJoint>) -> Result<Joint> {
        let raw = spanned.get_ref();
        let motion = self.motion(raw)?;
        let scaled = |key: &str, number: &Number, si: f64| Ok(self.0.finite(key, number)? * si);
        let or_zero = |key: &str, number: &Option<Number>, si: f64| match number {
            Some(number) => scaled(key, number, si),
            None => Ok(0.0),
        };
        Ok(Joint {
            name: raw.name.clone().unwrap_or_else(|| default_name(index)),
            motion,
            link: Hayati {
                theta: or_zero("joint.theta_offset_deg", &raw.theta_offset_deg, DEG)?,
                d: scaled("joint.d_mm", &raw.d_mm, MM)?,
                a: scaled("joint.a_mm", &raw.a_mm, MM)?,
                alpha: scaled("joint.alpha_deg", &raw.alpha_deg, DEG)?,
                beta: or_zero("joint.beta_deg", &raw.beta_deg, DEG)?,
            },
            compliance: or_zero("joint.compliance_urad_per_nm", &raw.compliance_urad_per_nm, URAD_PER_NM)?,
            body: self.body(raw)?,
            limits: self.limits(raw, motion)?,
        })
    }

    /// What the joint does, with the keys that only the other kind of joint has refused.
    fn motion(&self, raw: &RawJoint) -> Result<Motion> {
        let Some(kind) = &raw.r#type else {
            return self.revolute(raw);
        };
        match kind.get_ref().as_str() {
            "revolute" => self.revolute(raw),
            "prismatic" => {
                if let Some(limits) = &raw.limits_deg {
                    let expected = "limits_mm: a prismatic joint moves in mm";
                    return Err(self.0.is("joint.limits_deg", limits, expected));
                }
                if let Some(compliance) = &raw.compliance_urad_per_nm {
                    let expected = "no compliance: a prismatic joint does not turn";
                    return Err(self.0.is("joint.compliance_urad_per_nm", compliance, expected));
                }
                Ok(Motion::Prismatic)
            }
            _ => Err(self.0.is("joint.type", kind, "\"revolute\" or \"prismatic\"")),
        }
    }

    fn revolute(&self, raw: &RawJoint) -> Result<Motion> {
        match &raw.limits_mm {
            Some(limits) => {
                Err(self.0.is("joint.limits_mm", limits, "limits_deg: a revolute joint turns in degrees"))
            }
            None => Ok(Motion::Revolute),
        }
    }

    fn body(&self, raw: &RawJoint) -> Result<Option<Body>> {
        let centre = match &raw.com_mm {
            Some(list) => self.vector("joint.com_mm", list, "in mm in the joint's distal frame")? * MM,
            None => Vector3::zeros(),
        };
        match (&raw.mass_kg, &raw.com_mm) {
            (Some(mass), _) => {
                let mass = self.0.not_negative("joint.mass_kg", mass)?;
                Ok(Some(Body { mass, centre }))
            }
            (None, Some(list)) => {
                Err(self.0.is("joint.com_mm", list, "a mass_kg in the same [[joint]], or no com_mm"))
            }
            (None, None) => Ok(None),
        }
    }

    fn limits(&self, raw: &RawJoint, motion: Motion) -> Result<Option<[f64; 2]>> {
        let (key, list, si) = match motion {
            Motion::Revolute => ("joint.limits_deg", &raw.limits_deg, DEG),
            Motion::Prismatic => ("joint.limits_mm", &raw.limits_mm, MM),
        };
        let Some(list) = list else { return Ok(None) };
        match self.numbers(key, list)?.as_slice() {
            // also where the unit makes 0 of both
            &[lower, upper] if lower * si < upper * si => Ok(Some([lower * si, upper * si])),
            _ => Err(self.0.is(key, list, "two numbers [lower, upper], the lower one first")),
        }
    }

    fn vector(&self, key: &str, list: &Spanned<Vec<Number>>, meaning: &str) -> Result<Vector3<f64>> {
        match self.numbers(key, list)?.as_slice() {
            &[x, y, z] => Ok(Vector3::new(x, y, z)),
            _ => Err(self.0.is(key, list, &format!("three numbers [x, y, z] {meaning}"))),
        }
    }

    fn numbers(&self, key: &str, list: &Spanned<Vec<Number>>) -> Result<Vec<f64>> {
        list.get_ref().iter().map(|number| self.0.finite(key, number)).collect()
    }
}
