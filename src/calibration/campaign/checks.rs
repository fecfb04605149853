//! Whether what was read can be as it was meant: which warnings apply to a campaign.

use std::collections::HashSet;

use nalgebra::Vector3;

use super::layout::{Clamp, Role};
use super::{Campaign, Recording, Targets, Warning};
use crate::delimited::Table;
use crate::robot::{Motion, Robot};
use crate::units::{DEG, MM};

/// The largest angle in size that angles in radians have: a full turn, and some play, rad.
const LARGEST_IN_RADIANS: f64 = 1.05 * 2.0 * std::f64::consts::PI;
/// From how many rows on small angles are no accident.
const ROWS_TO_JUDGE: usize = 10;
/// A joint that moves less than this hardly moves.
const LEAST_TURN: f64 = 1.0 * DEG;
const LEAST_TRAVEL: f64 = 1.0 * MM;
/// No robot is so wrong that its positions spread this many times less or more than they should;
/// metres taken for millimetres do.
const IMPOSSIBLE_RATIO: f64 = 50.0;
/// But the positions of a robot that hardly moves may be nothing but errors, m.
const LEAST_SPREAD: f64 = 50.0 * MM;
/// Joint values and limits are rounded in their files, rad or m.
const ROUNDING: f64 = 1e-5;

/// About how the numbers of a file are written.
pub(super) fn about_dialect(file: &str, table: &Table) -> Vec<Warning> {
    let dialect = table.dialect();
    let commas = Warning::DecimalCommas { file: file.to_owned(), dialect };
    if dialect.decimal_mark == ',' { vec![commas] } else { vec![] }
}

/// About the joint values of a recording.
pub(super) fn about_joints(recording: &Recording, robot: &Robot, role: Role) -> Vec<Warning> {
    if let Some(warning) = in_radians(recording, robot) {
        // what else there is to say follows from this
        return vec![warning];
    }
    let count = robot.joints.len();
    let mut warnings: Vec<Warning> = (0..count).filter_map(|j| outside(recording, robot, j)).collect();
    if role == Role::Measurements && recording.len() > 1 {
        warnings.extend((0..count).filter_map(|j| still(recording, robot, j)));
    }
    warnings
}

/// About what belongs together.
pub(super) fn about(campaign: &Campaign, clamps: &[Clamp]) -> Vec<Warning> {
    let Campaign { rod, contact_force, measurements, validation, .. } = campaign;
    let mut warnings = Vec::new();
    for clamp in clamps {
        if measurements.groups.iter().all(|group| group.name != clamp.group().name) {
            warnings.push(Warning::UnusedClamp { id: clamp.id.clone() });
        }
    }
    match contact_force {
        None if rod.is_some() && !clamps.is_empty() => warnings.push(Warning::NoContactForce),
        Some(_) if rod.is_none() => warnings.push(Warning::ContactForceWithoutRod),
        Some(_) if clamps.is_empty() => warnings.push(Warning::ContactForceWithoutClamp),
        _ => {}
    }
    if measurements.targets == Targets::Sockets(vec![]) {
        warnings.push(Warning::NoDistance { file: measurements.file.clone() });
    }
    // in clamps the ball hardly moves, whatever the robot does
    let in_world = if clamps.is_empty() { Some(measurements) } else { None };
    warnings.extend(in_world.into_iter().chain(validation).filter_map(|recording| size(recording, campaign)));
    warnings.extend(validation.as_ref().and_then(|validation| not_independent(measurements, validation)));
    warnings
}

fn in_radians(recording: &Recording, robot: &Robot) -> Option<Warning> {
    let turns: Vec<bool> = robot.joints.iter().map(|joint| joint.motion == Motion::Revolute).collect();
    let angles = recording.joint_values.iter().zip(turns.iter().cycle()).filter(|(_, turns)| **turns);
    let largest = angles.map(|(q, _)| q.abs() / DEG).fold(0.0, f64::max);
    let is_small = largest > 0.0 && largest < LARGEST_IN_RADIANS && recording.len() >= ROWS_TO_JUDGE;
    is_small.then(|| Warning::AnglesInRadians { file: recording.file.clone(), largest })
}

/// The values of one joint.
fn values(recording: &Recording, joint: usize) -> impl Iterator<Item = f64> {
    (0..recording.len()).map(move |row| recording.joints(row)[joint])
}

fn outside(recording: &Recording, robot: &Robot, joint: usize) -> Option<Warning> {
    let limits @ [least, most] = robot.joints[joint].limits?;
    let is_beyond = |q: f64| q < least - ROUNDING || q > most + ROUNDING;
    let mut beyond = values(recording, joint).enumerate().filter(|&(_, q)| is_beyond(q));
    let (row, value) = beyond.next()?;
    Some(Warning::OutsideLimits {
        file: recording.file.clone(),
        joint,
        motion: robot.joints[joint].motion,
        limits,
        count: 1 + beyond.count(),
        pose: recording.rows[row].pose.clone(),
        line: recording.rows[row].line,
        value,
    })
}

fn still(recording: &Recording, robot: &Robot, joint: usize) -> Option<Warning> {
    let least = values(recording, joint).fold(f64::INFINITY, f64::min);
    let most = values(recording, joint).fold(f64::NEG_INFINITY, f64::max);
    let (motion, range) = (robot.joints[joint].motion, most - least);
    let enough = match motion {
        Motion::Revolute => LEAST_TURN,
        Motion::Prismatic => LEAST_TRAVEL,
    };
    (range < enough).then(|| Warning::StillJoint { file: recording.file.clone(), joint, motion, range })
}

fn size(recording: &Recording, campaign: &Campaign) -> Option<Warning> {
    let Targets::Points(points) = &recording.targets else { return None };
    let poses = (0..recording.len()).map(|row| campaign.robot.flange_at(recording.joints(row)));
    let nominal: Vec<Vector3<f64>> = poses.map(|flange| flange.point(&campaign.tool)).collect();
    let (measured, nominal) = (spread(points), spread(&nominal));
    let is_impossible = |small: f64, large: f64| large > LEAST_SPREAD && large > IMPOSSIBLE_RATIO * small;
    let is_odd = is_impossible(measured, nominal) || is_impossible(nominal, measured);
    is_odd.then(|| Warning::OtherSize { file: recording.file.clone(), measured, nominal })
}

/// Root mean square distance from the mean.
fn spread(points: &[Vector3<f64>]) -> f64 {
    let count = points.len() as f64;
    let mean = points.iter().sum::<Vector3<f64>>() / count;
    (points.iter().map(|point| (point - mean).norm_squared()).sum::<f64>() / count).sqrt()
}

fn not_independent(measurements: &Recording, validation: &Recording) -> Option<Warning> {
    let rounded = |q: &[f64]| -> Vec<i64> { q.iter().map(|q| (q / ROUNDING).round() as i64).collect() };
    let known: HashSet<Vec<i64>> =
        (0..measurements.len()).map(|row| rounded(measurements.joints(row))).collect();
    let mut same =
        (0..validation.len()).filter(|&row| known.contains(&rounded(validation.joints(row)))).peekable();
    let pose = validation.rows[*same.peek()?].pose.clone();
    Some(Warning::NotIndependent { count: same.count(), rows: validation.len(), pose })
}
