//! Writes a robot as a table in TOML, such that reading it gives the same robot.

use std::fmt::Write;

use super::defaults::default_name;
use super::{Joint, Motion, Robot, Uncertainty, effects_file, law_file};
use crate::error::{Error, Result};
use crate::spatial::Pose;
use crate::toml_text::{self, in_unit, quoted};
use crate::units::{DEG, MM, URAD_PER_NM};

impl Robot {
    /// This robot as a table, the format of [`Robot::from_text`], below `comments`.
    ///
    /// Every number has as many digits as it takes to read the very same one again; where the
    /// change of units makes that impossible, the last bit may differ.
    ///
    /// ```
    /// use rodcal::prelude::*;
    ///
    /// let link = Hayati { a: 0.425, alpha: std::f64::consts::FRAC_PI_2, ..Hayati::default() };
    /// let robot = Robot::new("arm", vec![Joint::new("joint 1", Motion::Revolute, link)]);
    /// let text = robot.to_toml(&["made by hand".to_owned()])?;
    /// assert!(text.contains("a_mm = 425.0\nalpha_deg = 90.0"), "{text}");
    /// assert_eq!(Robot::from_text("arm.toml", &text, None, None)?.joints[0].link, link);
    /// # Ok::<(), rodcal::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotApplicable`] where the robot has a root or a flange of its own, as one read from
    /// a URDF: a table has no place for them.
    pub fn to_toml(&self, comments: &[String]) -> Result<String> {
        if self.root != Pose::IDENTITY || self.flange != Pose::IDENTITY {
            return Err(Error::NotApplicable {
                what: format!("writing robot `{}` as a table", self.name),
                why: "its first joint or its flange is not where a table has it".to_owned(),
                hint: "write it into its URDF".to_owned(),
            });
        }
        let mut text = toml_text::comments(comments);
        text += &format!("name = {}\n", quoted(&self.name));
        if let Some(source) = &self.source {
            text += &format!("source = {}\n", quoted(source));
        }
        text += &format!("convention = \"hayati\"\ngravity_m_s2 = {:?}\n", self.gravity.as_slice());
        if let Some(tip) = &self.tip {
            let at: Vec<f64> = tip.at.iter().map(|&x| in_unit(x, MM)).collect();
            text += &format!("\n[tip]\nxyz_mm = {at:?}\n");
            text += &tip.sd.map_or_else(String::new, |sd| format!("sd_mm = {:?}\n", in_unit(sd, MM)));
        }
        for (index, joint) in self.joints.iter().enumerate() {
            text += "\n[[joint]]\n";
            // writing to a String cannot fail
            let _ = write_joint(&mut text, index, joint);
        }
        text += &self.standard_uncertainty.written();
        text += &self.uncertainty.as_ref().map_or_else(String::new, Uncertainty::written);
        text += &self
            .calibrated
            .as_ref()
            .map_or_else(String::new, |range| range.written(&joint_units(&self.joints)));
        text += &self.effects.iter().map(effects_file::written).collect::<String>();
        text += &self.laws.iter().map(law_file::written).collect::<String>();
        Ok(text)
    }
}

/// What a joint's values are in, in files.
pub(super) fn joint_units(joints: &[Joint]) -> Vec<f64> {
    joints.iter().map(|joint| if joint.motion == Motion::Revolute { DEG } else { MM }).collect()
}

/// Which joints are prismatic.
pub(super) fn are_prismatic(joints: &[Joint]) -> Vec<bool> {
    joints.iter().map(|joint| joint.motion == Motion::Prismatic).collect()
}

fn write_joint(text: &mut String, index: usize, joint: &Joint) -> std::fmt::Result {
    if joint.name != default_name(index) {
        writeln!(text, "name = {}", quoted(&joint.name))?;
    }
    if joint.motion == Motion::Prismatic {
        writeln!(text, "type = \"prismatic\"")?;
    }
    let link = &joint.link;
    for (key, value, si) in [
        ("theta_offset_deg", link.theta, DEG),
        ("d_mm", link.d, MM),
        ("a_mm", link.a, MM),
        ("alpha_deg", link.alpha, DEG),
        ("beta_deg", link.beta, DEG),
    ] {
        writeln!(text, "{key} = {:?}", in_unit(value, si))?;
    }
    if joint.compliance != 0.0 {
        writeln!(text, "compliance_urad_per_nm = {:?}", in_unit(joint.compliance, URAD_PER_NM))?;
    }
    if let Some(body) = &joint.body {
        let centre: Vec<f64> = body.centre.iter().map(|&x| in_unit(x, MM)).collect();
        writeln!(text, "mass_kg = {:?}\ncom_mm = {centre:?}", body.mass)?;
    }
    if let Some(limits) = joint.limits {
        let (key, si) = match joint.motion {
            Motion::Revolute => ("limits_deg", DEG),
            Motion::Prismatic => ("limits_mm", MM),
        };
        writeln!(text, "{key} = {:?}", limits.map(|limit| in_unit(limit, si)))?;
    }
    Ok(())
}
