//! Robots that the robot file means where numbers of it are in another unit.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::super::super::effects::mistakes::{FRAME_MISTAKE, SIGN_MISTAKE, TYPING_MISTAKE, UNIT_MISTAKE};
use super::super::draft::DraftChange;
use super::{List, RARE, Reading, UNUSUAL, exact};
use crate::calibration::campaign::Campaign;
use crate::inference::Key;
use crate::robot::{Robot, is_urdf};
use crate::units::{DEG, STANDARD_GRAVITY};

const GRAVITY: &str = "gravity_m_s2";
/// How far gravity may be from its standard value on Earth, as a share.
const ON_EARTH: f64 = 0.01;

/// What a table may mean; a robot of the program's own, or one of a URDF, which has other keys and
/// no gravity, means what it says.
pub fn readings(campaign: &Campaign) -> Vec<Reading> {
    if !is_table(campaign) {
        return Vec::new();
    }
    lengths(&campaign.robot).chain([radians(&campaign.robot)]).chain(gravity(campaign)).collect()
}

pub(super) fn is_table(campaign: &Campaign) -> bool {
    !campaign.robot_file.starts_with("builtin:") && !is_urdf(&campaign.robot_text)
}

/// Links in metres, centimetres, inches.
fn lengths(robot: &Robot) -> impl Iterator<Item = Reading> {
    let units = [
        (1e3, "they are in metres, not in millimetres"),
        (10.0, "they are in centimetres, not in millimetres"),
        (25.4, "they are in inches, not in millimetres"),
    ];
    units.into_iter().map(|(factor, why)| {
        let mut robot = robot.clone();
        for joint in &mut robot.joints {
            joint.link.a *= factor;
            joint.link.d *= factor;
        }
        Reading {
            robot,
            effect: &UNIT_MISTAKE,
            key: "a_mm and d_mm".into(),
            log_prior: UNUSUAL,
            estimates: exact("factor", factor),
            cure: format!("Multiply a_mm and d_mm of all joints by {factor}"),
            why,
        }
    })
}

/// Angles of links in radians.
fn radians(robot: &Robot) -> Reading {
    let factor = 1.0 / DEG;
    let mut robot = robot.clone();
    for joint in &mut robot.joints {
        joint.link.theta *= factor;
        joint.link.alpha *= factor;
        joint.link.beta *= factor;
    }
    Reading {
        robot,
        effect: &UNIT_MISTAKE,
        key: "theta_offset_deg, alpha_deg and beta_deg".into(),
        log_prior: UNUSUAL,
        estimates: exact("factor", factor),
        cure: "Multiply theta_offset_deg, alpha_deg and beta_deg of all joints by 57.2958".into(),
        why: "they are in radians, not in degrees",
    }
}

/// Gravity in another unit, along another axis of {0}, or none.
fn gravity(campaign: &Campaign) -> Vec<Reading> {
    let given = campaign.robot.gravity;
    let with = |gravity: Vector3<f64>| Robot { gravity, ..campaign.robot.clone() };
    let is_on_earth = |size: f64| (size / STANDARD_GRAVITY - 1.0).abs() < ON_EARTH;
    let units = [
        (STANDARD_GRAVITY, "9.80665", "it is in g, not in m/s²"),
        (1e-3, "0.001", "it is in mm/s², not in m/s²"),
        (0.01, "0.01", "it is in cm/s², not in m/s²"),
        (0.3048, "0.3048", "it is in feet per s², not in m/s²"),
    ];
    let meant = |(factor, by, why): (f64, &str, &'static str)| {
        let robot = with(given * factor);
        is_on_earth(robot.gravity.norm()).then(|| Reading {
            robot,
            effect: &UNIT_MISTAKE,
            key: GRAVITY.into(),
            log_prior: 0.0,
            estimates: exact("factor", factor),
            cure: format!("Multiply {GRAVITY} by {by}"),
            why,
        })
    };
    let mut all: Vec<Reading> = units.into_iter().filter_map(meant).collect();
    let is_turned = given != Vector3::zeros() && shows_its_direction(campaign);
    if is_turned {
        all.push(Reading {
            robot: with(-given),
            effect: &SIGN_MISTAKE,
            key: GRAVITY.into(),
            log_prior: UNUSUAL,
            estimates: Vec::new(),
            cure: format!("Multiply {GRAVITY} by −1"),
            why: "it pulls the other way",
        });
    }
    let axis = given.iamax();
    let is_along_axis = is_turned && given[axis].abs() == given.norm();
    let aside = (0..3).filter(|&other| is_along_axis && other != axis);
    for (other, sign) in aside.flat_map(|other| [(other, -1.0), (other, 1.0)]) {
        let mut gravity = Vector3::zeros();
        gravity[other] = sign * given.norm();
        all.push(Reading {
            robot: with(gravity),
            effect: &FRAME_MISTAKE,
            key: GRAVITY.into(),
            log_prior: RARE,
            estimates: Vec::new(),
            cure: format!("Write {GRAVITY} = [{:?}, {:?}, {:?}]", gravity.x, gravity.y, gravity.z),
            why: "gravity pulls along that axis of the base",
        });
    }
    if given == Vector3::zeros() {
        all.push(Reading {
            robot: with(Vector3::new(0.0, 0.0, -STANDARD_GRAVITY)),
            effect: &TYPING_MISTAKE,
            key: GRAVITY.into(),
            log_prior: 0.0,
            estimates: Vec::new(),
            cure: format!("Write {GRAVITY} = [0.0, 0.0, -9.80665]"),
            why: "the arm has weight",
        });
    }
    all
}

/// Whether poses tell gravity that is turned from a clamp that stands aside: between two clamps one
/// three millimetres aside was taken for it, between three none was.
fn shows_its_direction(campaign: &Campaign) -> bool {
    let recording = &campaign.measurements;
    let groups: BTreeSet<usize> = recording.rows.iter().map(|row| row.group).collect();
    groups.len() >= 3 || groups.iter().all(|&group| recording.groups[group].name.is_tracked())
}

impl List<'_> {
    /// Bodies with robots that may be meant.
    pub fn robots(&mut self, readings: &[(usize, &Reading)]) {
        for (body, reading) in readings {
            let Reading { effect, key, log_prior, estimates, cure, why, .. } = reading;
            let found = self.add(effect, Key::new(key), DraftChange::Body(*body, None), cure, why);
            (found.log_prior, found.estimates) = (*log_prior, estimates.clone());
        }
    }
}
