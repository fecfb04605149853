//! What was found, written into robot and campaign, and calibrated again.
//!
//! What belongs to the robot enters its model; what happened to the fixture, single bad poses and
//! all that a robot file has no key for are taken out of the measured points; a socket that moved
//! becomes another one. The campaign that is written has the nominal robot with these effects, so
//! that `calibrate` finds base and geometry anew beside them; the calibrated robot is for
//! `predict`. What neither can hold is listed, before anything is written too.

use super::super::diagnose::CalibrationDiagnosis;
use super::correction_table;
use super::extended::{Extended, proposed};
use crate::calibration::campaign::{Campaign, FileNames, Recording};
use crate::calibration::{Options, Summary, calibrate, write_back_with, write_beside};
use crate::error::Result;
use crate::inference::law::Proposed;
use crate::robot::{Effect, Robot, corrections_csv, is_urdf};
use crate::units::UM;

/// The robot with what was found.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Applied {
    /// Names and texts: the calibrated robot, for a URDF with a table of corrections beside it.
    pub files: Vec<(String, String)>,
    /// Mistakes that the campaign file and its recordings no longer hold.
    pub undone: Vec<String>,
    /// What entered the model, for people.
    pub entered: Vec<String>,
    /// What was taken out of the measured points, or made another socket.
    pub removed: Vec<String>,
    /// What nothing can hold.
    pub left_out: Vec<String>,
    /// Mean distance of the tip after the calibration with all that, m.
    pub mean: f64,
}

/// Robot and campaign with what `found` says; `None` where nothing of it could be written. `names`
/// are those of the campaign's files; the comments `above` stand on top of them.
///
/// ```
/// use rodcal::calibration::campaign::FileNames;
/// use rodcal::diagnosis::calibration::{apply, diagnose_as_recorded};
/// use rodcal::prelude::*;
///
/// // a clamp that stands 0.5 mm beside where the file says
/// let mut campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let groups: Vec<usize> = campaign.measurements.rows.iter().map(|row| row.group).collect();
/// let Targets::Points(points) = &mut campaign.measurements.targets else { unreachable!() };
/// points.iter_mut().zip(groups).filter(|(_, group)| *group == 2).for_each(|(point, _)| point.x += 0.5e-3);
/// let found = diagnose_as_recorded(&campaign, Mode::Meas, &Options::default())?;
/// assert_eq!(found.diagnosis.findings[0].effect.name, "clamp_pose");
/// let names = FileNames::new("builtin:tx90", "measurements.csv");
/// let applied = apply(&found, &names, &[])?.expect("a clamp's pose can be corrected");
/// assert_eq!(applied.removed.len(), 1);
/// assert!(applied.mean < 60e-6, "{}", applied.mean);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibrate`] and [`crate::calibration::write_back`].
pub fn apply(found: &CalibrationDiagnosis, names: &FileNames, above: &[String]) -> Result<Option<Applied>> {
    let model = &found.model;
    let Some(Extended { campaign: extended, entered, removed, left_out }) = Extended::of(found) else {
        return Ok(None);
    };
    let calibration = calibrate(&extended, model.calibration.mode, &Options::default())?;
    let held_out = found.diagnosis.held_out.as_ref();
    let sd = held_out.map_or(found.diagnosis.noise, |held_out| held_out.after);
    let sd = proposed(found).and_then(Proposed::held_out_with).unwrap_or(sd);
    let mut comments = Vec::new();
    let mut comment = |what: &str, list: &[String]| {
        if !list.is_empty() {
            comments.push(format!("{what}: {}.", list.join("; ")));
        }
    };
    comment("With the findings", &entered);
    comment("Corrected in the measurements", &removed);
    comment("Not written, because no file has a key for it", &left_out);
    let corrections = comments.clone();
    let sd_um = sd / UM;
    comments.push(format!("sd: {sd_um:.1} µm per coordinate, the error of held-out poses."));
    let mut files = vec![write_back_with(&extended, &calibration, Some(sd), &comments)?];
    files.extend(write_beside(&extended, &calibration, Some(sd)));
    if is_urdf(&model.campaign.robot_text) && extended.robot.effects.iter().any(Effect::is_of_own_angle) {
        let joints = 0..extended.robot.joints.len();
        let angles: Vec<Vec<f64>> =
            joints.map(|joint| angles(&extended, joint, &model.angles(joint))).collect();
        files.push(("corrections.csv".into(), corrections_csv(&extended.robot, &angles)));
    }
    let corrected = format!("CORRECTED, not as recorded: {}.", model.campaign.file);
    let above: Vec<String> =
        std::iter::once(corrected).chain(above.iter().cloned()).chain(corrections).collect();
    files.extend(campaign_files(model.campaign, &extended, names, &above)?);
    let mean = Summary::of(&calibration.residuals()).mean;
    Ok(Some(Applied { files, undone: Vec::new(), entered, removed, left_out, mean }))
}

/// The campaign with the nominal robot and its effects. Rod and readings are as they were.
fn campaign_files(
    campaign: &Campaign,
    extended: &Campaign,
    names: &FileNames,
    above: &[String],
) -> Result<Vec<(String, String)>> {
    let mut names = names.clone();
    let mut files = Vec::new();
    if extended.robot != campaign.robot {
        if is_urdf(&campaign.robot_text) {
            let mut robot =
                Robot { tip: None, uncertainty: None, calibrated: None, ..extended.robot.clone() };
            let own = robot.joints.iter().zip(&campaign.robot.joints).enumerate();
            let more = own.map(|(joint, (new, old))| (joint, new.compliance - old.compliance));
            let more = more.filter(|(_, per_nm)| *per_nm != 0.0);
            let more: Vec<Effect> =
                more.map(|(joint, per_nm)| Effect::Compliance { joint, per_nm }).collect();
            robot.effects.extend(more);
            names.effects = Some("effects.toml".into());
            files.push(("effects.toml".into(), robot.beside_to_toml(above)));
        } else {
            if names.robot.starts_with("builtin:") {
                names.robot = "robot.toml".into();
            }
            files.push((names.robot.clone(), extended.robot.to_toml(above)?));
        }
    }
    let text = |recording: &Recording, above: &[String]| recording.to_csv(&extended.robot, above);
    files.push(("campaign.toml".into(), extended.to_toml(&names, above)));
    files.push((names.measurements.clone(), text(&extended.measurements, above)));
    if let (Some(name), Some(validation)) = (&names.validation, &extended.validation) {
        files.push((name.clone(), text(validation, &above[..1])));
    }
    Ok(files)
}

/// Angles over the recorded range of a joint, as fine as its finest effect.
fn angles(extended: &Campaign, joint: usize, recorded: &[f64]) -> Vec<f64> {
    let rows = |effect: &Effect| match effect {
        Effect::Harmonic { cycles_per_rev, .. } => correction_table::rows(recorded, *cycles_per_rev),
        Effect::Table { rows, .. } => rows.len(),
        // straight lines, or no functions of the joint's own angle
        Effect::EncoderScale { .. }
        | Effect::Backlash { .. }
        | Effect::PlayByApproach { .. }
        | Effect::Friction { .. }
        | Effect::Lag { .. }
        | Effect::Compliance { .. }
        | Effect::NonlinearStiffness { .. }
        | Effect::LinkFlexibility { .. }
        | Effect::GravityTilt { .. }
        | Effect::Weight { .. }
        | Effect::Coupling { .. } => 0,
    };
    let own = extended.robot.effects.iter().filter(|effect| effect.joint() == Some(joint));
    correction_table::spaced(recorded, own.map(rows).max().unwrap_or(0)).collect()
}
