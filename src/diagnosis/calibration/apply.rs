//! What was found, written into the robot: its model with effects, calibrated again.
//!
//! What belongs to the robot enters its model, and the campaign is calibrated once more with it, so
//! that base, geometry and effects fit together. What happened to the fixture, and single bad
//! poses, are taken out of the measured points before that. What neither can hold is said.

use super::correction_table;
use super::diagnose::CalibrationDiagnosis;
use super::effects::registry;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Options, Summary, calibrate, write_back_with};
use crate::error::Result;
use crate::inference::WrittenTo;
use crate::robot::{Effect, corrections_csv, is_urdf};
use crate::units::UM;

/// The robot with what was found.
#[derive(Debug, Clone)]
pub struct Applied {
    /// Names and texts: the calibrated robot, for a URDF with a table of corrections beside it.
    pub files: Vec<(String, String)>,
    /// Mistakes that the campaign file and its recordings no longer hold.
    pub undone: Vec<String>,
    /// What entered the model, in words.
    pub entered: Vec<String>,
    /// What was taken out of the measured points.
    pub removed: Vec<String>,
    /// What nothing can hold.
    pub left_out: Vec<String>,
    /// Mean distance of the tip after the calibration with all that, m.
    pub mean: f64,
}

/// The robot of the diagnosed campaign with what `found` says; `None` where nothing of it belongs
/// to the robot.
///
/// # Errors
/// As [`calibrate`] and [`crate::calibration::write_back`].
pub fn apply(found: &CalibrationDiagnosis) -> Result<Option<Applied>> {
    let model = &found.model;
    let mut extended = model.campaign.clone();
    let (mut entered, mut removed, mut left_out) = (Vec::new(), Vec::new(), Vec::new());
    // what was undone before there was a model is nothing to write into it
    for finding in found.diagnosis.findings.iter().filter(|finding| !finding.parts.is_empty()) {
        let words = (finding.effect.cause_at)(&finding.location);
        let written = registry::record(finding.effect)
            .map_or(WrittenTo::Nowhere, |effect| (effect.write)(finding, model, &mut extended));
        match written {
            WrittenTo::Model => entered.push(words),
            WrittenTo::Recording => removed.push(words),
            WrittenTo::Nowhere => left_out.push(words),
        }
    }
    if entered.is_empty() {
        return Ok(None);
    }
    let calibration = calibrate(&extended, model.calibration.mode, &Options::default())?;
    let held_out = found.diagnosis.held_out.as_ref();
    let sd = held_out.map_or(found.diagnosis.noise, |held_out| held_out.after);
    let mut comments = vec![format!("With the findings: {}.", entered.join("; "))];
    if !removed.is_empty() {
        comments.push(format!("Removed from the measured points: {}.", removed.join("; ")));
    }
    if !left_out.is_empty() {
        comments.push(format!("Not written, because this file has no key for it: {}.", left_out.join("; ")));
    }
    let sd_um = sd / UM;
    comments.push(format!("sd: {sd_um:.1} µm per coordinate, the error of held-out poses."));
    let mut files = vec![write_back_with(&extended, &calibration, Some(sd), &comments)?];
    if is_urdf(&model.campaign.robot_text) {
        let joints = 0..extended.robot.joints.len();
        let angles: Vec<Vec<f64>> =
            joints.map(|joint| angles(&extended, joint, &model.angles(joint))).collect();
        files.push(("corrections.csv".into(), corrections_csv(&extended.robot, &angles)));
    }
    let mean = Summary::of(&calibration.residuals()).mean;
    Ok(Some(Applied { files, undone: Vec::new(), entered, removed, left_out, mean }))
}

/// Angles over the recorded range of a joint, as fine as its finest effect.
fn angles(extended: &Campaign, joint: usize, recorded: &[f64]) -> Vec<f64> {
    let rows = |effect: &Effect| match effect {
        Effect::Harmonic { cycles_per_rev, .. } => correction_table::rows(recorded, *cycles_per_rev),
        Effect::Table { rows, .. } => rows.len(),
        Effect::EncoderScale { .. } | Effect::Backlash { .. } | Effect::Coupling { .. } => 0,
    };
    let own = extended.robot.effects.iter().filter(|effect| effect.joint() == joint);
    correction_table::spaced(recorded, own.map(rows).max().unwrap_or(0)).collect()
}
