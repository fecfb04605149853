//! How accurate is a robot, and does it matter how its rod's deflection is known?

use super::Answer;
use crate::calibration::campaign::Recording;
use crate::calibration::{
    self, Calibration, Campaign, CompareOptions, Compensation, CrossValidation, Draws, Mode, Options,
    write_back, write_beside,
};
use crate::diagnosis::Suspicion;
use crate::diagnosis::calibration::{Neighbours, suspected};
use crate::error::Result;
use crate::report;

/// Calibrates, with the calibrated robot as a file; `folds` also predicts every pose from a
/// calibration without it. `others` are files that may have been meant.
///
/// ```
/// use rodcal::answer::calibrate;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let others = Neighbours::default();
/// let (answer, calibration) = calibrate(&campaign, Mode::Fea, &Options::default(), None, &others)?;
/// assert_eq!(answer.status, 0); // plausible
/// let rms = answer.json["residual"]["rms_um"].as_f64().unwrap_or(0.0);
/// assert!((10.0..40.0).contains(&rms), "{rms}"); // the noise of a coordinate is 18 µm
/// assert!(calibration.is_converged && answer.files[0].0 == "calibrated.toml");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibration::calibrate`] and [`calibration::cross_validate`].
pub fn calibrate<'c>(
    campaign: &'c Campaign,
    mode: Mode,
    options: &Options,
    folds: Option<usize>,
    others: &Neighbours,
) -> Result<(Answer, Calibration<'c>)> {
    calibrate_held_out(campaign, mode, options, folds, others, &|calibrated, folds| {
        let compensation = Compensation::new(campaign, mode)?;
        calibration::cross_validate(campaign, calibrated, &compensation, folds, options)
    })
}

/// As [`calibrate`], with `held_out` for what predicts every pose from a calibration without it:
/// others may have done that.
///
/// ```
/// use rodcal::answer::calibrate_held_out;
/// use rodcal::calibration::{folds_of, predict_held_out, CrossValidation};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let (options, others) = (Options::default(), Neighbours::default());
/// let compensation = Compensation::new(&campaign, Mode::Fea)?;
/// let (answer, _) = calibrate_held_out(&campaign, Mode::Fea, &options, Some(3), &others, &|found, folds| {
///     // fold by fold, as a cluster would
///     let mut predicted = Vec::new();
///     for fold in 0..folds {
///         predicted.extend(predict_held_out(&campaign, found, &compensation, folds, fold..fold + 1, &options)?);
///     }
///     assert_eq!(folds_of(&campaign, folds)?.iter().max(), Some(&2));
///     CrossValidation::of(&campaign, folds, predicted)
/// })?;
/// assert_eq!(answer.json["cross_validation"]["folds"], 3);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibrate`], and what `held_out` says.
pub fn calibrate_held_out<'c>(
    campaign: &'c Campaign,
    mode: Mode,
    options: &Options,
    folds: Option<usize>,
    others: &Neighbours,
    held_out: &dyn Fn(&Calibration, usize) -> Result<CrossValidation>,
) -> Result<(Answer, Calibration<'c>)> {
    let calibrated = calibration::calibrate(campaign, mode, options)?;
    let cross_validation = folds.map(|folds| held_out(&calibrated, folds)).transpose()?;
    let cross_validation = cross_validation.as_ref();
    let mut report = report::calibration::report(campaign, &calibrated, cross_validation);
    report.provenance = provenance(campaign);
    if let (Some(asked), Some(held_out)) = (folds, cross_validation)
        && held_out.folds != asked
    {
        report.warnings.push(format!(
            "{} folds in place of {asked}: with sockets whole placements are held out, for poses of one placement share its \
             unknown points",
            held_out.folds
        ));
    }
    let suspicions = suspected(campaign, mode, others)?;
    let is_plausible = calibrated.is_plausible() && suspicions.iter().all(|suspicion| !suspicion.spoils_fit);
    let line = |suspicion: &Suspicion| format!("{suspicion} (`rodcal diagnose calibration` says more)");
    let lines: Vec<String> = suspicions.iter().map(line).collect();
    let mut json = report::calibration::json(campaign, &calibrated, cross_validation);
    json["plausible"] = is_plausible.into();
    json["suspected_mistakes"] = lines.clone().into();
    // before all else: it explains the rest
    report.warnings.splice(0..0, lines);
    let files = calibrated_robot(campaign, &calibrated)?;
    let answer = Answer { files, status: u8::from(!is_plausible), ..Answer::new(json, report) };
    Ok((answer, calibrated))
}

/// Every mode of compensation that the campaign allows, and which differences are significant.
/// `progress` is called at every draw.
///
/// ```
/// use rodcal::answer::compare;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let answer = compare(&campaign, &CompareOptions::default().with_draws(2), &|_| {})?;
/// let modes = answer.json["modes"].as_array().expect("one for each mode");
/// assert_eq!((modes.len(), &modes[0]["mode"]), (4, &"none".into()));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`calibration::compare`].
pub fn compare(
    campaign: &Campaign,
    options: &CompareOptions,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Answer> {
    let draws = Draws::new(campaign, options)?;
    let drawn = draws.means(0..options.draws, progress);
    Ok(compare_drawn(campaign, draws, drawn))
}

/// As [`compare`], from draws that others may have made: the means of all of them, in order.
///
/// ```
/// use rodcal::answer::compare_drawn;
/// use rodcal::calibration::Draws;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let draws = Draws::new(&campaign, &CompareOptions::default().with_draws(2))?;
/// // in two parts, as two machines would
/// let drawn = [draws.means(0..1, &|_| {}), draws.means(1..2, &|_| {})].concat();
/// let answer = compare_drawn(&campaign, draws, drawn);
/// assert_eq!(answer.json["modes"].as_array().map(Vec::len), Some(4));
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn compare_drawn(campaign: &Campaign, draws: Draws<'_>, drawn: Vec<Option<Vec<f64>>>) -> Answer {
    let comparison = draws.comparison(drawn);
    let mut report = report::comparison::report(campaign, &comparison);
    report.provenance = provenance(campaign);
    Answer::new(report::comparison::json(campaign, &comparison), report)
}

/// Where it all comes from.
///
/// ```
/// use rodcal::answer::provenance;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let list = provenance(&campaign);
/// assert_eq!(list[0], ("campaign".to_owned(), "campaigns/tx90-5/campaign.toml".to_owned()));
/// assert_eq!(list[1].1, "builtin:tx90"); // the robot
/// # Ok::<(), rodcal::Error>(())
/// ```
pub fn provenance(campaign: &Campaign) -> Vec<(String, String)> {
    let mut list = vec![
        ("campaign".to_owned(), campaign.file.clone()),
        ("robot".to_owned(), campaign.robot_file.clone()),
    ];
    if let Some(rod) = &campaign.rod {
        list.push(("rod".into(), rod.name.clone()));
        list.extend(
            rod.source.iter().map(|source| ("source of the rod's numbers".to_owned(), source.clone())),
        );
    }
    list.extend(campaign.readings.iter().map(|readings| ("rig readings".to_owned(), readings.file.clone())));
    let described = |recording: &Recording| match &recording.source {
        Some(source) => format!("{} ({source})", recording.file),
        None => recording.file.clone(),
    };
    list.push(("measurements".into(), described(&campaign.measurements)));
    list.extend(campaign.validation.iter().map(|recording| ("validation".to_owned(), described(recording))));
    list.push(("program".into(), concat!("rodcal ", env!("CARGO_PKG_VERSION")).into()));
    list
}

/// The calibrated robot in the format of its file.
///
/// ```
/// use rodcal::answer::calibrated_robot;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Fea, &Options::default())?;
/// let files = calibrated_robot(&campaign, &calibration)?;
/// // of a URDF there would be a second file, for what it has no place for
/// assert_eq!((files.len(), files[0].0.as_str()), (1, "calibrated.toml"));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`write_back`].
pub fn calibrated_robot(campaign: &Campaign, calibrated: &Calibration) -> Result<Vec<(String, Vec<u8>)>> {
    let (name, text) = write_back(campaign, calibrated)?;
    let beside = write_beside(campaign, calibrated, None);
    let files = std::iter::once((name, text)).chain(beside);
    Ok(files.map(|(name, text)| (name, text.into_bytes())).collect())
}
