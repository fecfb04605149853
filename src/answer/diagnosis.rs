//! Where do recording and model disagree, and which physics was left out?

use std::path::Path;

use super::{Answer, provenance};
use crate::calibration::campaign::FileNames;
use crate::calibration::{Campaign, Mode, Options};
use crate::diagnosis::calibration::{Neighbours, check_memory, look_at_validation, mend};
use crate::diagnosis::rig::{OwnEffect, diagnose_with};
use crate::error::Result;
use crate::report::diagnosis as reports;
use crate::rig::readings::Readings;
use crate::robot::is_urdf;
use crate::rod::Rod;

/// What the readings show that the model of `rod` leaves out, or straight lines without one.
/// `others` are rods that may have been on the rig. With `apply`, rod and readings with what was
/// found are its files, where something can be applied.
///
/// ```
/// use rodcal::answer::diagnose_rig;
/// use rodcal::prelude::*;
///
/// // reconstructed with 0.09 kg (0.88 N) of friction in the slide
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
/// let answer = diagnose_rig(&readings, Some(&rod), &[], None)?;
/// assert_eq!((answer.status, &answer.json["verdict"]), (1, &"mismatch".into()));
/// assert_eq!(answer.json["findings"][0]["effect"], "friction");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`diagnose_with`].
pub fn diagnose_rig(
    readings: &Readings,
    rod: Option<&Rod>,
    others: &[(String, Rod)],
    apply: Option<&dyn Fn(&str) -> String>,
) -> Result<Answer> {
    diagnose_rig_with(readings, rod, others, &[], apply)
}

/// The same, with effects that the lab describes itself.
///
/// ```
/// use rodcal::answer::diagnose_rig_with;
/// use rodcal::diagnosis::rig::OwnEffect;
/// use rodcal::prelude::*;
///
/// let rod = Rod::read("rods/5.toml".as_ref())?;
/// let readings = Readings::read("stiffness_data/5.csv".as_ref())?;
/// let own = OwnEffect::from_toml("own.toml", "
///     [[effect]]
///     name = \"foot\"
///     words = \"a foot\"
///     place = \"clamp\"
///     variable = \"load\"
///     law = \"a*tanh(F/3)\"
///     parameter = [{ name = \"a\", size = 20 }]
/// ")?;
/// let answer = diagnose_rig_with(&readings, Some(&rod), &[], &own, None)?;
/// assert_eq!(answer.json["findings"][0]["effect"], "friction"); // which explains the readings better
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`diagnose_with`].
pub fn diagnose_rig_with(
    readings: &Readings,
    rod: Option<&Rod>,
    others: &[(String, Rod)],
    own: &[OwnEffect],
    apply: Option<&dyn Fn(&str) -> String>,
) -> Result<Answer> {
    let found = diagnose_with(readings, rod, others, own)?;
    let correction = found.correction()?;
    let report = reports::rig::report(&found, correction.as_ref());
    let json = reports::rig::json(&found, correction.as_ref());
    let mut answer = Answer::new(json, report);
    answer.status = u8::from(found.diagnosis.is_mismatch());
    match (apply, correction) {
        (None, _) => {}
        (Some(named), Some(correction)) => {
            answer.files = vec![
                (named("rod"), correction.rod_toml.into_bytes()),
                (named("readings"), correction.readings_csv.into_bytes()),
            ];
            answer.json["applied"] = answer.files.iter().map(|(name, _)| name.as_str()).collect();
        }
        (Some(_), None) => answer.report.warnings.push(match rod {
            Some(_) if found.unit_is_unknown() => {
                "--apply has no effect: what unit the readings have must be looked up".into()
            }
            Some(_) => "--apply has no effect: nothing was found that could be applied".into(),
            None => "--apply has no effect without a rod file".into(),
        }),
    }
    Ok(answer)
}

/// The bytes of a file that a campaign names, by the name that stands there.
pub type Content<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>>;

/// What the residuals of a calibration show that its model leaves out. `others` are files that may
/// have been meant. With `apply`, the content of a file that the campaign names, the corrected
/// robot and campaign are its files, where something can be corrected.
///
/// ```
/// use rodcal::answer::diagnose_calibration;
/// use rodcal::prelude::*;
///
/// // simulated with nothing but noise, and a rod that the readings of its rig describe
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let answer = diagnose_calibration(&campaign, Mode::Meas, &Neighbours::default(), None)?;
/// assert_eq!((answer.status, &answer.json["verdict"]), (0, &"consistent".into()));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`mend`] and what calibrates; [`crate::Error::File`] where a file that is copied cannot be
/// read.
pub fn diagnose_calibration(
    campaign: &Campaign,
    mode: Mode,
    others: &Neighbours,
    apply: Option<Content<'_>>,
) -> Result<Answer> {
    check_memory(campaign)?;
    let options = Options::default();
    let mended = mend(campaign, mode, others, &options)?;
    let mut found = mended.diagnose()?;
    look_at_validation(&mut found)?;
    let mut report = reports::calibration::report(&found);
    report.provenance = provenance(campaign);
    let mut json = reports::calibration::json(&found);
    let applied = match apply {
        Some(_) => mended.apply(&found, &names(&mended.campaign))?,
        None => None,
    };
    match &applied {
        Some(applied) => reports::calibration::applied(&mut report, &mut json, applied),
        None if apply.is_some() => report
            .warnings
            .push("--apply has no effect: nothing was found that belongs to the robot or can be corrected in the campaign".into()),
        None => reports::calibration::announced(&mut report, &found),
    }
    let mut answer = Answer::new(json, report);
    if let (Some(applied), Some(content)) = (applied, apply) {
        answer.files = applied.files.into_iter().map(|(name, text)| (name, text.into_bytes())).collect();
        // what was not written anew is copied
        for copy in copies(&mended.campaign, content)? {
            if answer.files.iter().all(|(name, _)| *name != copy.0) {
                answer.files.push(copy);
            }
        }
    }
    answer.status = u8::from(answer.json["verdict"] != "consistent");
    Ok(answer)
}

/// What a corrected campaign calls its files: all of them stand beside it. What was built in memory
/// has no name of its own (`<rod>`).
fn names(campaign: &Campaign) -> FileNames {
    let base = |name: &str, usual: &str| match name.starts_with('<') {
        true => usual.to_owned(),
        false => Path::new(name)
            .file_name()
            .map_or_else(|| name.to_owned(), |end| end.to_string_lossy().into_owned()),
    };
    let robot = match campaign.robot_file.starts_with("builtin:") {
        true => campaign.robot_file.clone(),
        false if is_urdf(&campaign.robot_text) => base(&campaign.robot_file, "robot.urdf"),
        false => base(&campaign.robot_file, "robot.toml"),
    };
    FileNames {
        effects: campaign.effects_file.as_deref().map(|name| base(name, "effects.toml")),
        robot,
        rod: campaign.rod_file.as_deref().map(|name| base(name, "rod.toml")),
        rig: campaign.readings.as_ref().map(|readings| base(&readings.file, "readings.csv")),
        measurements: "measurements.csv".into(),
        validation: campaign.validation.as_ref().map(|_| "validation.csv".into()),
    }
}

/// Robot, rod and readings as they are, for a corrected campaign in another folder.
fn copies(campaign: &Campaign, content: &dyn Fn(&str) -> Result<Vec<u8>>) -> Result<Vec<(String, Vec<u8>)>> {
    let names = names(campaign);
    let mut copies = Vec::new();
    if let (Some(name), Some(file)) = (names.effects, &campaign.effects_file) {
        copies.push((name, content(file)?));
    }
    if !campaign.robot_file.starts_with("builtin:") {
        copies.push((names.robot, campaign.robot_text.clone().into_bytes()));
    }
    if let (Some(name), Some(file)) = (names.rod, &campaign.rod_file) {
        copies.push((name, content(file)?));
    }
    if let (Some(name), Some(readings)) = (names.rig, &campaign.readings) {
        let directory = Path::new(&campaign.file).parent().unwrap_or(Path::new(""));
        let file = Path::new(&readings.file);
        copies.push((name, content(&file.strip_prefix(directory).unwrap_or(file).to_string_lossy())?));
    }
    Ok(copies)
}
