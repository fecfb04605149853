//! The sections `[[effect]]` of a robot file, and the table of corrections that other programs can
//! use.

use serde::Deserialize;
use toml::Spanned;

use super::{Effect, Robot, TorquePower};
use crate::delimited::Table;
use crate::error::Result;
use crate::toml_text::{Number, TomlText, in_unit};
use crate::units::{DEG, MM, URAD, URAD_PER_NM};

/// Names of the effects.
const TRANSMISSION_ERROR: &str = "transmission_error";
const ENCODER_SCALE: &str = "encoder_scale";
const BACKLASH: &str = "backlash";
const WEIGHT: &str = "weight";
const JOINT_COMPLIANCE: &str = "joint_compliance";
const JOINT_NONLINEAR_STIFFNESS: &str = "joint_nonlinear_stiffness";
const LINK_FLEXIBILITY: &str = "link_flexibility";
const JOINT_FRICTION: &str = "joint_friction";
const READBACK_LAG: &str = "readback_lag";
const WRIST_COUPLING: &str = "wrist_coupling";
const GRAVITY_TILT: &str = "gravity_tilt";

/// Columns of the table of corrections.
const COLUMNS: [&str; 3] = ["joint", "angle_deg", "correction_urad"];

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a section [[effect]]")]
pub(super) struct RawEffect {
    name: Spanned<String>,
    joint: Option<Spanned<usize>>,
    cycles_per_rev: Option<Number>,
    sin_urad: Option<Number>,
    cos_urad: Option<Number>,
    angle_deg: Option<Spanned<Vec<Number>>>,
    correction_urad: Option<Spanned<Vec<Number>>>,
    factor: Option<Number>,
    play_urad: Option<Number>,
    from_joint: Option<Spanned<usize>>,
    fraction: Option<Number>,
    taken_up: Option<Spanned<String>>,
    at_joint: Option<Spanned<usize>>,
    urad_per_m: Option<Number>,
    urad_per_nm: Option<Number>,
    at_mm: Option<Number>,
    urad_per_nm2: Option<Number>,
    urad_per_nm3: Option<Number>,
}

/// An effect of a robot with so many joints.
pub(super) fn read(toml: &TomlText, spanned: &Spanned<RawEffect>, joints: usize) -> Result<Effect> {
    EffectSection { toml, spanned, joints }.read()
}

/// The section of an effect.
pub(super) fn written(effect: &Effect) -> String {
    let joint = effect.joint().map_or_else(String::new, |joint| format!("joint = {}\n", joint + 1));
    format!("\n[[effect]]\nname = \"{}\"\n{joint}{}", effect.name(), numbers(effect))
}

/// Corrections of joints over their own angles as a table (CSV): joint, angle_deg, correction_urad.
/// `angles` (rad) by joint.
///
/// ```
/// use rodcal::robot::{Effect, Robot, corrections_csv};
///
/// let (file, text) = Robot::builtin("tx90").expect("the program carries it");
/// let mut robot = Robot::from_text(file, text, None, None)?;
/// robot.effects.push(Effect::EncoderScale { joint: 1, factor: 1.001 });
/// let table = corrections_csv(&robot, &[vec![], vec![0.0, 1.0]]);
/// assert_eq!(table.lines().last(), Some("2,57.2958,1000.0000")); // 0.1 % of a radian
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn corrections_csv(robot: &Robot, angles: &[Vec<f64>]) -> String {
    let mut text =
        "# add correction_urad to the angle that the joint shows; straight between the rows\n".to_owned();
    text += &format!("{}\n", COLUMNS.join(","));
    for (joint, angles) in angles.iter().enumerate() {
        let own = |effect: &&Effect| effect.joint() == Some(joint) && effect.is_of_own_angle();
        let effects: Vec<&Effect> = robot.effects.iter().filter(own).collect();
        if effects.is_empty() {
            continue;
        }
        for &angle in angles {
            let mut q = vec![0.0; robot.joints.len()];
            q[joint] = angle;
            let turn: f64 = effects.iter().map(|effect| effect.turn(&q, &[])).sum();
            text += &format!("{},{:.4},{:.4}\n", joint + 1, angle / DEG, turn / URAD);
        }
    }
    text
}

/// The effects of a table of corrections for a robot with so many joints.
///
/// ```
/// use rodcal::robot::{Effect, corrections_from_csv};
///
/// let table = "joint,angle_deg,correction_urad\n2,-90,0\n2,90,180\n";
/// let effects = corrections_from_csv("corrections.csv", table, 6)?;
/// let Effect::Table { joint, rows } = &effects[0] else { unreachable!() };
/// assert_eq!((*joint, rows.len()), (1, 2));
/// assert!((rows[1].1 - 180e-6).abs() < 1e-12); // rad
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`crate::Error::Input`] with line and column.
pub fn corrections_from_csv(file: &str, text: &str, joints: usize) -> Result<Vec<Effect>> {
    let table = Table::parse(file, text, |column| COLUMNS.contains(&column))?;
    if let Some(column) = COLUMNS.into_iter().find(|column| !table.has(column)) {
        let found = format!("there is no column {column}");
        return Err(table.header_error(column, found, COLUMNS.join(", "), Some(table.columns_found())));
    }
    let mut rows: Vec<Vec<(f64, f64)>> = vec![Vec::new(); joints];
    for row in table.rows() {
        let number = row.required_number(COLUMNS[0])?;
        let joint = number as usize;
        if joint < 1 || joint > joints || number.fract() != 0.0 {
            return Err(row.error(COLUMNS[0], format!("a joint from 1 to {joints}"), None));
        }
        let (angle, turn) = (row.required_number(COLUMNS[1])? * DEG, row.required_number(COLUMNS[2])? * URAD);
        if rows[joint - 1].last().is_some_and(|last| last.0 >= angle) {
            return Err(row.error(COLUMNS[1], "angles of a joint that ascend".into(), None));
        }
        rows[joint - 1].push((angle, turn));
    }
    let table = |(joint, rows): (usize, Vec<(f64, f64)>)| Effect::Table { joint, rows };
    Ok(rows.into_iter().enumerate().filter(|(_, rows)| !rows.is_empty()).map(table).collect())
}

impl Effect {
    /// Its name in a robot file.
    pub fn name(&self) -> &'static str {
        match self {
            Effect::Harmonic { .. } | Effect::Table { .. } => TRANSMISSION_ERROR,
            Effect::EncoderScale { .. } => ENCODER_SCALE,
            Effect::Backlash { .. } | Effect::PlayByApproach { .. } => BACKLASH,
            Effect::Friction { .. } => JOINT_FRICTION,
            Effect::Lag { .. } => READBACK_LAG,
            Effect::Compliance { .. } => JOINT_COMPLIANCE,
            Effect::NonlinearStiffness { .. } => JOINT_NONLINEAR_STIFFNESS,
            Effect::LinkFlexibility { .. } => LINK_FLEXIBILITY,
            Effect::GravityTilt { .. } => GRAVITY_TILT,
            Effect::Weight { .. } => WEIGHT,
            Effect::Coupling { .. } => WRIST_COUPLING,
        }
    }
}

const EXPECTED: &str = "transmission_error (cycles_per_rev, sin_urad, cos_urad; or angle_deg and correction_urad), \
                        encoder_scale (factor), backlash (play_urad, taken_up), wrist_coupling (from_joint, fraction), \
                        readback_lag (fraction; of all joints without joint), joint_compliance (urad_per_nm), joint_nonlinear_stiffness (urad_per_nm2 or urad_per_nm3), \
                        joint_friction (urad_per_nm), link_flexibility (urad_per_nm, at_mm), gravity_tilt (urad_per_nm; without joint) or weight (at_joint, urad_per_m)";

/// The section of an effect while it is read.
struct EffectSection<'a> {
    toml: &'a TomlText<'a>,
    spanned: &'a Spanned<RawEffect>,
    /// How many joints the robot has.
    joints: usize,
}

impl EffectSection<'_> {
    fn read(&self) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        let joint = raw.joint.as_ref().map(|joint| self.joint("joint", joint)).transpose()?;
        let name = raw.name.get_ref().as_str();
        if let (READBACK_LAG, Some(fraction)) = (name, &raw.fraction) {
            return Ok(Effect::Lag { joint, fraction: self.finite("fraction", fraction, 1.0)? });
        }
        if name == GRAVITY_TILT {
            return self.gravity_tilt();
        }
        let Some(joint) = joint else { return self.lacks("joint") };
        let per_nm = || self.required("urad_per_nm", &raw.urad_per_nm, URAD_PER_NM);
        match name {
            TRANSMISSION_ERROR => self.transmission_error(joint),
            ENCODER_SCALE => {
                Ok(Effect::EncoderScale { joint, factor: self.required("factor", &raw.factor, 1.0)? })
            }
            BACKLASH => self.backlash(joint),
            WEIGHT => self.weight(joint),
            JOINT_COMPLIANCE => Ok(Effect::Compliance { joint, per_nm: per_nm()? }),
            JOINT_NONLINEAR_STIFFNESS => self.nonlinear_stiffness(joint),
            LINK_FLEXIBILITY => {
                let at = raw.at_mm.as_ref().map_or(Ok(0.0), |at| self.finite("at_mm", at, MM))?;
                Ok(Effect::LinkFlexibility { joint, per_nm: per_nm()?, at })
            }
            JOINT_FRICTION => Ok(Effect::Friction { joint, per_nm: per_nm()? }),
            READBACK_LAG => self.lacks("fraction"),
            WRIST_COUPLING => self.coupling(joint),
            _ => Err(self.toml.is("effect.name", &raw.name, EXPECTED)),
        }
    }

    fn gravity_tilt(&self) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        if let Some(joint) = &raw.joint {
            let found = format!("{GRAVITY_TILT} has the key `joint`");
            return Err(self.toml.wrong(joint, found, "no joint: the whole arm tilts"));
        }
        Ok(Effect::GravityTilt { per_nm: self.required("urad_per_nm", &raw.urad_per_nm, URAD_PER_NM)? })
    }

    /// A wave or a table.
    fn transmission_error(&self, joint: usize) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        match (&raw.cycles_per_rev, &raw.angle_deg, &raw.correction_urad) {
            (Some(cycles), None, None) => {
                let part = |key: &str, number: &Option<Number>| match number {
                    Some(number) => self.finite(key, number, URAD),
                    None => Ok(0.0),
                };
                Ok(Effect::Harmonic {
                    joint,
                    cycles_per_rev: self.finite("cycles_per_rev", cycles, 1.0)?,
                    sine: part("sin_urad", &raw.sin_urad)?,
                    cosine: part("cos_urad", &raw.cos_urad)?,
                })
            }
            (None, Some(angles), Some(corrections)) => {
                let numbers = |key: &str, list: &Spanned<Vec<Number>>, si: f64| -> Result<Vec<f64>> {
                    list.get_ref().iter().map(|number| self.finite(key, number, si)).collect()
                };
                let rows: Vec<(f64, f64)> = numbers("angle_deg", angles, DEG)?
                    .into_iter()
                    .zip(numbers("correction_urad", corrections, URAD)?)
                    .collect();
                let is_whole = angles.get_ref().len() == corrections.get_ref().len() && !rows.is_empty();
                match is_whole && rows.is_sorted_by(|a, b| a.0 < b.0) {
                    true => Ok(Effect::Table { joint, rows }),
                    false => {
                        let expected = "ascending angles, with one correction_urad for each";
                        Err(self.toml.wrong(angles, "effect.angle_deg is another list".into(), expected))
                    }
                }
            }
            _ => self.lacks("cycles_per_rev, or angle_deg and correction_urad"),
        }
    }

    fn backlash(&self, joint: usize) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        let play = self.required("play_urad", &raw.play_urad, URAD)?;
        match &raw.taken_up {
            None => Ok(Effect::Backlash { joint, play }),
            Some(by) if by.get_ref() == "load" => Ok(Effect::Backlash { joint, play }),
            Some(by) if by.get_ref() == "approach" => Ok(Effect::PlayByApproach { joint, play }),
            Some(by) => Err(self.toml.is("effect.taken_up", by, "\"load\" or \"approach\"")),
        }
    }

    fn weight(&self, joint: usize) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        let per_metre = self.required("urad_per_m", &raw.urad_per_m, URAD)?;
        let at = raw.at_joint.as_ref().map(|at| self.joint("at_joint", at)).transpose()?;
        Ok(Effect::Weight { joint, at, per_metre })
    }

    fn nonlinear_stiffness(&self, joint: usize) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        let (power, key, number) = match (&raw.urad_per_nm2, &raw.urad_per_nm3) {
            (Some(number), None) => (TorquePower::Square, "urad_per_nm2", number),
            (None, Some(number)) => (TorquePower::Cube, "urad_per_nm3", number),
            _ => return self.lacks("urad_per_nm2, or urad_per_nm3"),
        };
        Ok(Effect::NonlinearStiffness { joint, power, coefficient: self.finite(key, number, URAD)? })
    }

    fn coupling(&self, joint: usize) -> Result<Effect> {
        let raw = self.spanned.get_ref();
        let (Some(from), Some(fraction)) = (&raw.from_joint, &raw.fraction) else {
            return self.lacks("from_joint and fraction");
        };
        let from = self.joint("from_joint", from)?;
        Ok(Effect::Coupling { from, joint, fraction: self.finite("fraction", fraction, 1.0)? })
    }

    /// A joint of the robot, from 0.
    fn joint(&self, key: &str, number: &Spanned<usize>) -> Result<usize> {
        match number.get_ref().checked_sub(1) {
            Some(index) if index < self.joints => Ok(index),
            _ => {
                let expected = format!("a joint from 1 to {}", self.joints);
                Err(self.toml.is(&format!("effect.{key}"), number, &expected))
            }
        }
    }

    /// A number, SI.
    fn finite(&self, key: &str, number: &Number, si: f64) -> Result<f64> {
        Ok(self.toml.finite(&format!("effect.{key}"), number)? * si)
    }

    /// A number that must be there, SI.
    fn required(&self, key: &str, number: &Option<Number>, si: f64) -> Result<f64> {
        match number {
            Some(number) => self.finite(key, number, si),
            None => self.lacks(key),
        }
    }

    fn lacks<T>(&self, what: &str) -> Result<T> {
        Err(self.toml.wrong(self.spanned, format!("an effect without {what}"), EXPECTED))
    }
}

/// The keys of an effect beside its name and its joint.
fn numbers(effect: &Effect) -> String {
    let urad = |value: f64| in_unit(value, URAD);
    let per_nm = |value: f64| format!("urad_per_nm = {:?}\n", in_unit(value, URAD_PER_NM));
    match effect {
        Effect::Harmonic { cycles_per_rev, sine, cosine, .. } => format!(
            "cycles_per_rev = {cycles_per_rev:?}\nsin_urad = {:?}\ncos_urad = {:?}\n",
            urad(*sine),
            urad(*cosine)
        ),
        Effect::Table { rows, .. } => {
            let angles: Vec<f64> = rows.iter().map(|row| in_unit(row.0, DEG)).collect();
            let corrections: Vec<f64> = rows.iter().map(|row| urad(row.1)).collect();
            format!("angle_deg = {angles:?}\ncorrection_urad = {corrections:?}\n")
        }
        Effect::EncoderScale { factor, .. } => format!("factor = {factor:?}\n"),
        Effect::Backlash { play, .. } => format!("play_urad = {:?}\n", urad(*play)),
        Effect::PlayByApproach { play, .. } => {
            format!("play_urad = {:?}\ntaken_up = \"approach\"\n", urad(*play))
        }
        Effect::Lag { fraction, .. } => format!("fraction = {fraction:?}\n"),
        Effect::Friction { per_nm: k, .. }
        | Effect::Compliance { per_nm: k, .. }
        | Effect::GravityTilt { per_nm: k } => per_nm(*k),
        Effect::LinkFlexibility { per_nm: k, at, .. } if *at == 0.0 => per_nm(*k),
        Effect::LinkFlexibility { per_nm: k, at, .. } => {
            format!("{}at_mm = {:?}\n", per_nm(*k), in_unit(*at, MM))
        }
        Effect::NonlinearStiffness { power, coefficient, .. } => {
            let key = match power {
                TorquePower::Square => "urad_per_nm2",
                TorquePower::Cube => "urad_per_nm3",
            };
            format!("{key} = {:?}\n", urad(*coefficient))
        }
        Effect::Weight { at, per_metre, .. } => {
            let at = at.map_or_else(String::new, |at| format!("at_joint = {}\n", at + 1));
            format!("{at}urad_per_m = {:?}\n", urad(*per_metre))
        }
        Effect::Coupling { from, fraction, .. } => {
            format!("from_joint = {}\nfraction = {fraction:?}\n", from + 1)
        }
    }
}
