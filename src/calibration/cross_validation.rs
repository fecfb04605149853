//! How well a campaign predicts its own poses, each from a calibration that has not seen it.

use std::ops::Range;

use nalgebra::Vector3;

use super::calibrate_from::calibrate_from;
use super::campaign::{Campaign, Recording, Targets};
use super::compensation::Compensation;
use super::options::Options;
use super::problem::Pass;
use super::result::Calibration;
use super::validation::Summary;
use crate::error::{Error, Result};
use crate::parallel::in_parallel;
use crate::robot::Kinematics;

/// Held-out errors of all poses.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CrossValidation {
    /// Fold of each row.
    pub fold: Vec<usize>,
    /// Number of folds.
    pub folds: usize,
    /// Predicted less measured, in {W}, m; with sockets less the mean of the socket's predicted
    /// tips.
    pub deviations: Vec<Vector3<f64>>,
    /// Their lengths, m.
    pub errors: Vec<f64>,
    /// What they sum up to.
    pub summary: Summary,
}

/// Holds out one fold after the other ([`super::campaign::Recording::folds`]), calibrates on the
/// rest as `calibration` was, and predicts what was held out.
///
/// ```
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let options = Options::default();
/// let calibration = calibrate(&campaign, Mode::Fea, &options)?;
/// let compensation = Compensation::new(&campaign, Mode::Fea)?;
/// let held_out = cross_validate(&campaign, &calibration, &compensation, 5, &options)?;
/// assert_eq!((held_out.folds, held_out.errors.len()), (5, 60));
/// // poses that a fit has not seen are predicted worse than those that it has
/// let residual = calibration.residuals().iter().sum::<f64>() / 60.0;
/// assert!(held_out.summary.mean > residual, "{} {residual}", held_out.summary.mean);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for more folds than poses; as [`super::calibrate()`], where a fold leaves
/// too few poses.
pub fn cross_validate(
    campaign: &Campaign,
    calibration: &Calibration,
    compensation: &Compensation,
    folds: usize,
    options: &Options,
) -> Result<CrossValidation> {
    let fold = folds_of(campaign, folds)?;
    let all = fold.iter().max().map_or(0, |last| last + 1);
    let predicted = predict_held_out(campaign, calibration, compensation, folds, 0..all, options)?;
    CrossValidation::of(campaign, folds, predicted)
}

/// Fold of each row where so many are asked for, numbered from 0.
///
/// ```
/// use rodcal::calibration::folds_of;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let folds = folds_of(&campaign, 5)?;
/// assert_eq!(folds.iter().filter(|&&fold| fold == 0).count(), 15); // whole blocks of poses
/// assert!(folds_of(&campaign, 61).is_err());
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for more folds than poses.
pub fn folds_of(campaign: &Campaign, folds: usize) -> Result<Vec<usize>> {
    let recording = &campaign.measurements;
    if folds > recording.len() {
        return Err(Error::Argument {
            name: "folds",
            found: folds.to_string(),
            expected: format!("at most {}: so many poses were recorded", recording.len()),
        });
    }
    Ok(recording.folds(folds))
}

/// Row and deviation of every pose of these folds, each from a calibration without its fold, m: a
/// part of a cross-validation.
///
/// ```
/// use rodcal::calibration::predict_held_out;
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let options = Options::default();
/// let calibration = calibrate(&campaign, Mode::Fea, &options)?;
/// let compensation = Compensation::new(&campaign, Mode::Fea)?;
/// // the first of five folds
/// let predicted = predict_held_out(&campaign, &calibration, &compensation, 5, 0..1, &options)?;
/// assert_eq!(predicted.len(), 15);
/// assert!(predicted.iter().all(|(_, deviation)| deviation.norm() < 300e-6));
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`cross_validate`].
pub fn predict_held_out(
    campaign: &Campaign,
    calibration: &Calibration,
    compensation: &Compensation,
    folds: usize,
    held_out: Range<usize>,
    options: &Options,
) -> Result<Vec<(usize, Vector3<f64>)>> {
    let (recording, fold) = (&campaign.measurements, folds_of(campaign, folds)?);
    let free: Vec<_> = calibration.parameters.iter().map(|p| p.parameter).collect();
    let predictions = in_parallel(held_out.len(), |k| -> Result<Vec<(usize, Vector3<f64>)>> {
        let held_out = held_out.start + k;
        let rows_where = |wanted: bool| -> Vec<usize> {
            (0..recording.len()).filter(|&row| (fold[row] == held_out) == wanted).collect()
        };
        let training = recording.subset(&rows_where(false));
        let trained =
            calibrate_from(campaign, &training, calibration.start.clone(), &free, compensation, options)?;
        let rows = rows_where(true);
        let deviations = predict(&trained, &training, &recording.subset(&rows), compensation);
        Ok(rows.into_iter().zip(deviations).collect())
    });
    Ok(predictions.into_iter().collect::<Result<Vec<_>>>()?.concat())
}

impl CrossValidation {
    /// Of what was predicted of every pose, in parts and in any order.
    ///
    /// # Errors
    /// [`Error::Argument`] for more folds than poses, and unless each row is predicted once.
    pub fn of(
        campaign: &Campaign,
        folds: usize,
        predicted: Vec<(usize, Vector3<f64>)>,
    ) -> Result<CrossValidation> {
        let fold = folds_of(campaign, folds)?;
        let mut known = vec![None; fold.len()];
        let is_once = predicted.iter().all(|(row, deviation)| {
            known.get_mut(*row).is_some_and(|place| place.replace(*deviation).is_none())
        });
        let deviations: Option<Vec<Vector3<f64>>> = known.into_iter().collect();
        let Some(deviations) = deviations.filter(|_| is_once) else {
            return Err(Error::Argument {
                name: "predicted",
                found: format!("{} predictions", predicted.len()),
                expected: format!("one of each of the {} poses", fold.len()),
            });
        };
        let errors: Vec<f64> = deviations.iter().map(|d| d.norm()).collect();
        let folds = fold.iter().max().map_or(0, |last| last + 1);
        Ok(CrossValidation { fold, folds, summary: Summary::of(&errors), errors, deviations })
    }
}

/// Deflected tips of a recording as a calibration on `training` predicts them, less what was
/// measured or less their sockets' means.
fn predict(
    trained: &Calibration,
    training: &Recording,
    recording: &Recording,
    compensation: &Compensation,
) -> Vec<Vector3<f64>> {
    let setup = &trained.setup;
    let mut pass = Pass::at_rest(recording);
    // torques turn the joints that they act on: the second time they are those of the turned joints
    for _ in 0..3 {
        compensation.update(setup, recording, &mut pass);
    }
    let mut kinematics = Kinematics::new(setup);
    let tips: Vec<Vector3<f64>> = (0..recording.len())
        .map(|row| {
            pass.deflect(&mut kinematics, recording, row);
            kinematics.tip
        })
        .collect();
    match &recording.targets {
        Targets::Points(points) => {
            let motions = trained.motions(training, recording);
            let targets = points.iter().zip(&recording.rows);
            let targets = targets.map(|(point, row)| motions[row.station].point(point));
            tips.iter().zip(targets).map(|(tip, x)| tip - x).collect()
        }
        Targets::Sockets(_) => recording.minus_group_means(&tips),
    }
}
