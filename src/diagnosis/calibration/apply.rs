//! What was found, written into the robot: its model with effects, calibrated again.
//!
//! What belongs to the robot enters its model, and the campaign is calibrated once more with it, so that base, geometry and
//! effects fit together. What happened to the fixture, and single bad poses, are taken out of the measured points before
//! that. What neither can hold is said.

use super::gear::Gear;
use super::{CalibrationDiagnosis, Mismatch, cause_at};
use crate::calibration::campaign::{Campaign, Targets};
use crate::calibration::{Options, Summary, calibrate, write_back_with};
use crate::error::Result;
use crate::robot::{Effect, corrections_csv, is_urdf};
use crate::units::UM;

/// Rows of a table for each cycle of its curve, and at least and at most.
const PER_CYCLE: f64 = 16.0;
const ROWS: (usize, usize) = (60, 4000);

/// The robot with what was found.
#[derive(Debug, Clone)]
pub struct Applied {
    /// Names and texts: the calibrated robot, for a URDF with a table of corrections beside it.
    pub files: Vec<(String, String)>,
    /// What entered the model, in words.
    pub entered: Vec<String>,
    /// What was taken out of the measured points.
    pub removed: Vec<String>,
    /// What nothing can hold.
    pub left_out: Vec<String>,
    /// Mean distance of the tip after the calibration with all that, m.
    pub mean: f64,
}

/// Where a mismatch goes.
enum Place {
    Robot,
    Recording,
    Nowhere,
}

/// The robot of `campaign` with what `found` says; `None` where nothing of it belongs to the robot.
///
/// # Errors
/// As [`calibrate`] and [`crate::calibration::write_back`].
pub fn apply(campaign: &Campaign, found: &CalibrationDiagnosis) -> Result<Option<Applied>> {
    let mut extended = campaign.clone();
    let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    for mismatch in &found.mismatches {
        let words = cause_at(&mismatch.effect, &mismatch.location);
        match enter(&mut extended, campaign, found, mismatch) {
            Place::Robot => entered.push(words),
            Place::Recording => removed.push(words),
            Place::Nowhere => left_out.push(words),
        }
    }
    if entered.is_empty() {
        return Ok(None);
    }
    let calibration = calibrate(&extended, found.calibration.mode, &Options::default())?;
    let sd = found.diagnosis.proof.as_ref().map_or(found.diagnosis.noise, |proof| proof.after);
    let mut comments = vec![format!("With what was found: {}.", entered.join("; "))];
    if !removed.is_empty() {
        comments.push(format!("Taken out of the measured points: {}.", removed.join("; ")));
    }
    if !left_out.is_empty() {
        comments.push(format!("Left out, for this file cannot hold it: {}.", left_out.join("; ")));
    }
    comments.push(format!("sd: {:.1} µm per coordinate, the error of poses that were held out.", sd / UM));
    let mut files = vec![write_back_with(&extended, &calibration, Some(sd), &comments)?];
    if is_urdf(&campaign.robot_text) {
        let angles =
            (0..extended.robot.joints.len()).map(|joint| angles(&extended, joint)).collect::<Vec<_>>();
        files.push(("corrections.csv".into(), corrections_csv(&extended.robot, &angles)));
    }
    let mean = Summary::of(&calibration.residuals()).mean;
    Ok(Some(Applied { files, entered, removed, left_out, mean }))
}

fn enter(
    extended: &mut Campaign,
    campaign: &Campaign,
    found: &CalibrationDiagnosis,
    mismatch: &Mismatch,
) -> Place {
    let finding = &found.diagnosis.findings[mismatch.parts[0]];
    let first = finding.chosen.values.first().copied().unwrap_or_default();
    let joints: Vec<usize> = mismatch
        .location
        .trim_start_matches("joint ")
        .split(" to ")
        .filter_map(|number| number.parse::<usize>().ok()?.checked_sub(1))
        .collect();
    let effect = match (mismatch.effect.as_str(), &joints[..]) {
        ("transmission_error", _) => {
            extended.robot.effects.extend(gears(campaign, found, mismatch));
            return Place::Robot;
        }
        ("encoder_scale", &[joint]) => Effect::EncoderScale { joint, factor: first },
        ("backlash", &[joint]) if !finding.place.ends_with("by approach") => {
            Effect::Backlash { joint, play: first }
        }
        ("wrist_coupling", &[from, joint]) => Effect::Coupling { from, joint, fraction: first },
        ("joint_compliance", &[joint]) if finding.chosen.values.len() == 1 && campaign.robot.has_masses() => {
            extended.robot.joints[joint].compliance = found.calibration.setup.compliance[joint] + first;
            return Place::Robot;
        }
        ("clamp_pose" | "clamp_shift" | "base_shift" | "outlier" | "thermal_drift" | "readback_lag", _) => {
            let changes = found.by_row(&found.change(mismatch));
            let Targets::Points(points) = &mut extended.measurements.targets else { return Place::Nowhere };
            points.iter_mut().zip(changes).for_each(|(point, change)| *point -= change);
            return Place::Recording;
        }
        _ => return Place::Nowhere,
    };
    extended.robot.effects.push(effect);
    Place::Robot
}

/// Waves as they are, curves as tables over the recorded angles.
fn gears(campaign: &Campaign, found: &CalibrationDiagnosis, mismatch: &Mismatch) -> Vec<Effect> {
    let of_part = |&part: &usize| {
        let chosen = &found.diagnosis.findings[part].chosen;
        let gear = found.world.gear(chosen.candidate)?;
        match (gear, &chosen.values[..]) {
            (&Gear::Harmonic { joint, cycles_per_rev }, &[sine, cosine]) => {
                Some(Effect::Harmonic { joint, cycles_per_rev, sine, cosine })
            }
            (Gear::Harmonic { .. }, _) => None,
            (Gear::Wave { joint, .. } | Gear::Curve { joint, .. }, values) => {
                let range = range(campaign, *joint);
                let turns = (range.1 - range.0) / std::f64::consts::TAU;
                let count = (PER_CYCLE * turns * gear.highest(values.len())) as usize;
                let turn = |q: f64| values.iter().enumerate().map(|(k, value)| value * gear.term(k, q)).sum();
                let rows = spaced(range, count.clamp(ROWS.0, ROWS.1)).map(|q| (q, turn(q))).collect();
                Some(Effect::Table { joint: *joint, rows })
            }
        }
    };
    mismatch.parts.iter().filter_map(of_part).collect()
}

fn range(campaign: &Campaign, joint: usize) -> (f64, f64) {
    let recording = &campaign.measurements;
    let angles = (0..recording.len()).map(|row| recording.joints(row)[joint]);
    angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)))
}

fn spaced((low, high): (f64, f64), count: usize) -> impl Iterator<Item = f64> {
    (0..=count).map(move |k| low + (high - low) * k as f64 / count as f64)
}

/// Angles over the recorded range of a joint, as fine as its finest effect.
fn angles(extended: &Campaign, joint: usize) -> Vec<f64> {
    let range = range(extended, joint);
    let turns = (range.1 - range.0) / std::f64::consts::TAU;
    let rows = |effect: &Effect| match effect {
        Effect::Harmonic { cycles_per_rev, .. } => (PER_CYCLE * turns * cycles_per_rev) as usize,
        Effect::Table { rows, .. } => rows.len(),
        _ => 0,
    };
    let own = extended.robot.effects.iter().filter(|effect| effect.joint() == joint);
    spaced(range, own.map(rows).max().unwrap_or(0).clamp(ROWS.0, ROWS.1)).collect()
}
