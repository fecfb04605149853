//! The sections `[[effect]]` of a robot file, and the table of corrections that other programs can
//! use.

use serde::Deserialize;
use toml::Spanned;

use super::{Effect, Robot, TorquePower};
use crate::delimited::Table;
use crate::error::Result;
use crate::toml_text::{Number, TomlText, in_unit};
use crate::units::{DEG, URAD, URAD_PER_NM};

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
    urad_per_nm2: Option<Number>,
    urad_per_nm3: Option<Number>,
}

/// An effect of a robot with so many joints.
pub(super) fn read(toml: &TomlText, spanned: &Spanned<RawEffect>, joints: usize) -> Result<Effect> {
    let raw = spanned.get_ref();
    let number_of = |key: &str, number: &Spanned<usize>| match number.get_ref().checked_sub(1) {
        Some(index) if index < joints => Ok(index),
        _ => Err(toml.is(key, number, &format!("a joint from 1 to {joints}"))),
    };
    let lacks = |what: &str| Err(toml.wrong(spanned, format!("an effect without {what}"), EXPECTED));
    let finite = |key: &str, number: &Number, si: f64| Ok(toml.finite(key, number)? * si);
    let joint = raw.joint.as_ref().map(|joint| number_of("effect.joint", joint)).transpose()?;
    if let ("readback_lag", Some(fraction)) = (raw.name.get_ref().as_str(), &raw.fraction) {
        return Ok(Effect::Lag { joint, fraction: finite("effect.fraction", fraction, 1.0)? });
    }
    if raw.name.get_ref() == "gravity_tilt" {
        if let Some(joint) = &raw.joint {
            let found = "gravity_tilt has the key `joint`".to_owned();
            return Err(toml.wrong(joint, found, "no joint: the whole arm tilts"));
        }
        return match &raw.urad_per_nm {
            Some(tilt) => {
                Ok(Effect::GravityTilt { per_nm: finite("effect.urad_per_nm", tilt, URAD_PER_NM)? })
            }
            None => lacks("urad_per_nm"),
        };
    }
    let Some(joint) = joint else { return lacks("joint") };
    match raw.name.get_ref().as_str() {
        "transmission_error" => match (&raw.cycles_per_rev, &raw.angle_deg, &raw.correction_urad) {
            (Some(cycles), None, None) => {
                let part = |key: &str, number: &Option<Number>| match number {
                    Some(number) => finite(key, number, URAD),
                    None => Ok(0.0),
                };
                Ok(Effect::Harmonic {
                    joint,
                    cycles_per_rev: finite("effect.cycles_per_rev", cycles, 1.0)?,
                    sine: part("effect.sin_urad", &raw.sin_urad)?,
                    cosine: part("effect.cos_urad", &raw.cos_urad)?,
                })
            }
            (None, Some(angles), Some(corrections)) => {
                let numbers = |key: &str, list: &Spanned<Vec<Number>>, si: f64| -> Result<Vec<f64>> {
                    list.get_ref().iter().map(|number| finite(key, number, si)).collect()
                };
                let rows: Vec<(f64, f64)> = numbers("effect.angle_deg", angles, DEG)?
                    .into_iter()
                    .zip(numbers("effect.correction_urad", corrections, URAD)?)
                    .collect();
                let is_whole = angles.get_ref().len() == corrections.get_ref().len() && !rows.is_empty();
                match is_whole && rows.is_sorted_by(|a, b| a.0 < b.0) {
                    true => Ok(Effect::Table { joint, rows }),
                    false => {
                        let expected = "ascending angles, with one correction_urad for each";
                        Err(toml.wrong(angles, "effect.angle_deg is another list".into(), expected))
                    }
                }
            }
            _ => lacks("cycles_per_rev, or angle_deg and correction_urad"),
        },
        "encoder_scale" => match &raw.factor {
            Some(factor) => Ok(Effect::EncoderScale { joint, factor: finite("effect.factor", factor, 1.0)? }),
            None => lacks("factor"),
        },
        "backlash" => match &raw.play_urad {
            Some(play) => {
                let play = finite("effect.play_urad", play, URAD)?;
                match &raw.taken_up {
                    None => Ok(Effect::Backlash { joint, play }),
                    Some(by) if by.get_ref() == "load" => Ok(Effect::Backlash { joint, play }),
                    Some(by) if by.get_ref() == "approach" => Ok(Effect::PlayByApproach { joint, play }),
                    Some(by) => Err(toml.is("effect.taken_up", by, "\"load\" or \"approach\"")),
                }
            }
            None => lacks("play_urad"),
        },
        "weight" => match &raw.urad_per_m {
            Some(turn) => {
                let at = raw.at_joint.as_ref().map(|at| number_of("effect.at_joint", at)).transpose()?;
                Ok(Effect::Weight { joint, at, per_metre: finite("effect.urad_per_m", turn, URAD)? })
            }
            None => lacks("urad_per_m"),
        },
        "joint_compliance" => match &raw.urad_per_nm {
            Some(turn) => {
                Ok(Effect::Compliance { joint, per_nm: finite("effect.urad_per_nm", turn, URAD_PER_NM)? })
            }
            None => lacks("urad_per_nm"),
        },
        "joint_nonlinear_stiffness" => {
            let (power, key, number) = match (&raw.urad_per_nm2, &raw.urad_per_nm3) {
                (Some(number), None) => (TorquePower::Square, "effect.urad_per_nm2", number),
                (None, Some(number)) => (TorquePower::Cube, "effect.urad_per_nm3", number),
                _ => return lacks("urad_per_nm2, or urad_per_nm3"),
            };
            Ok(Effect::NonlinearStiffness { joint, power, coefficient: finite(key, number, URAD)? })
        }
        "link_flexibility" => match &raw.urad_per_nm {
            Some(turn) => Ok(Effect::LinkFlexibility {
                joint,
                per_nm: finite("effect.urad_per_nm", turn, URAD_PER_NM)?,
            }),
            None => lacks("urad_per_nm"),
        },
        "joint_friction" => match &raw.urad_per_nm {
            Some(wound) => {
                Ok(Effect::Friction { joint, per_nm: finite("effect.urad_per_nm", wound, URAD_PER_NM)? })
            }
            None => lacks("urad_per_nm"),
        },
        "readback_lag" => lacks("fraction"),
        "wrist_coupling" => match (&raw.from_joint, &raw.fraction) {
            (Some(from), Some(fraction)) => Ok(Effect::Coupling {
                from: number_of("effect.from_joint", from)?,
                joint,
                fraction: finite("effect.fraction", fraction, 1.0)?,
            }),
            _ => lacks("from_joint and fraction"),
        },
        _ => Err(toml.is("effect.name", &raw.name, EXPECTED)),
    }
}

const EXPECTED: &str = "transmission_error (cycles_per_rev, sin_urad, cos_urad; or angle_deg and correction_urad), \
                        encoder_scale (factor), backlash (play_urad, taken_up), wrist_coupling (from_joint, fraction), \
                        readback_lag (fraction; of all joints without joint), joint_compliance (urad_per_nm), joint_nonlinear_stiffness (urad_per_nm2 or urad_per_nm3), \
                        joint_friction (urad_per_nm), link_flexibility (urad_per_nm), gravity_tilt (urad_per_nm; without joint) or weight (at_joint, urad_per_m)";

/// The section of an effect.
pub(super) fn written(effect: &Effect) -> String {
    let head = |name: &str, joint: usize| format!("\n[[effect]]\nname = \"{name}\"\njoint = {}\n", joint + 1);
    let urad = |value: f64| in_unit(value, URAD);
    match effect {
        Effect::Harmonic { joint, cycles_per_rev, sine, cosine } => format!(
            "{}cycles_per_rev = {cycles_per_rev:?}\nsin_urad = {:?}\ncos_urad = {:?}\n",
            head("transmission_error", *joint),
            urad(*sine),
            urad(*cosine)
        ),
        Effect::Table { joint, rows } => {
            let angles: Vec<f64> = rows.iter().map(|row| in_unit(row.0, DEG)).collect();
            let corrections: Vec<f64> = rows.iter().map(|row| urad(row.1)).collect();
            format!(
                "{}angle_deg = {angles:?}\ncorrection_urad = {corrections:?}\n",
                head("transmission_error", *joint)
            )
        }
        Effect::EncoderScale { joint, factor } => {
            format!("{}factor = {factor:?}\n", head("encoder_scale", *joint))
        }
        Effect::Backlash { joint, play } => {
            format!("{}play_urad = {:?}\n", head("backlash", *joint), urad(*play))
        }
        Effect::PlayByApproach { joint, play } => {
            format!("{}play_urad = {:?}\ntaken_up = \"approach\"\n", head("backlash", *joint), urad(*play))
        }
        Effect::Friction { joint, per_nm } => {
            let h = in_unit(*per_nm, URAD_PER_NM);
            format!("{}urad_per_nm = {h:?}\n", head("joint_friction", *joint))
        }
        Effect::Lag { joint: Some(joint), fraction } => {
            format!("{}fraction = {fraction:?}\n", head("readback_lag", *joint))
        }
        Effect::Lag { joint: None, fraction } => {
            format!("\n[[effect]]\nname = \"readback_lag\"\nfraction = {fraction:?}\n")
        }
        Effect::Compliance { joint, per_nm } => {
            let c = in_unit(*per_nm, URAD_PER_NM);
            format!("{}urad_per_nm = {c:?}\n", head("joint_compliance", *joint))
        }
        Effect::NonlinearStiffness { joint, power, coefficient } => {
            let key = match power {
                TorquePower::Square => "urad_per_nm2",
                TorquePower::Cube => "urad_per_nm3",
            };
            format!("{}{key} = {:?}\n", head("joint_nonlinear_stiffness", *joint), urad(*coefficient))
        }
        Effect::LinkFlexibility { joint, per_nm } => {
            let k = in_unit(*per_nm, URAD_PER_NM);
            format!("{}urad_per_nm = {k:?}\n", head("link_flexibility", *joint))
        }
        Effect::GravityTilt { per_nm } => {
            let k = in_unit(*per_nm, URAD_PER_NM);
            format!("\n[[effect]]\nname = \"gravity_tilt\"\nurad_per_nm = {k:?}\n")
        }
        Effect::Weight { joint, at, per_metre } => {
            let at = at.map_or_else(String::new, |at| format!("at_joint = {}\n", at + 1));
            format!("{}{at}urad_per_m = {:?}\n", head("weight", *joint), urad(*per_metre))
        }
        Effect::Coupling { from, joint, fraction } => {
            format!("{}from_joint = {}\nfraction = {fraction:?}\n", head("wrist_coupling", *joint), from + 1)
        }
    }
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
