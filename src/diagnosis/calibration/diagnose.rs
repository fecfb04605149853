//! What a campaign says about its calibration.

use super::context::Context;
use super::effects::registry;
use super::evidence;
use super::gear::Curve;
use super::limits::limits;
use super::linear_terms::LinearTerms;
use super::memory::check_memory;
use super::model::CalibrationModel;
use super::next::next_poses;
use super::nonparametric;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Mode, Options, calibrate};
use crate::error::Result;
use crate::inference::{Absorbed, Diagnosed, Evidence, Finding, Location, NotTestable, diagnose as infer};
use crate::parallel::in_parallel;

/// A campaign's diagnosis.
pub type CalibrationDiagnosis<'c> = Diagnosed<CalibrationModel<'c>>;

/// Calibrates `campaign` and diagnoses what is left.
///
/// # Errors
/// As [`calibrate`].
pub fn diagnose<'c>(
    campaign: &'c Campaign,
    mode: Mode,
    options: &Options,
) -> Result<CalibrationDiagnosis<'c>> {
    diagnose_calibrated(campaign, calibrate(campaign, mode, options)?)
}

/// Diagnoses what a calibration of `campaign` leaves.
///
/// ```
/// use rodcal::diagnosis::calibration::diagnose_calibrated;
/// use rodcal::prelude::*;
///
/// // simulated with nothing but noise of 18 µm, and a rod that the readings of its rig describe
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let calibration = calibrate(&campaign, Mode::Meas, &Options::default())?;
/// let found = diagnose_calibrated(&campaign, calibration)?;
/// assert!(found.diagnosis.findings.is_empty());
/// assert!((found.diagnosis.noise - 18e-6).abs() < 4e-6, "{}", found.diagnosis.noise);
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// As [`crate::calibration::Compensation::new`].
pub fn diagnose_calibrated<'c>(
    campaign: &'c Campaign,
    calibration: Calibration<'c>,
) -> Result<CalibrationDiagnosis<'c>> {
    check_memory(campaign)?;
    let Prepared { model, evidence, absorbed, not_testable, context } = Prepared::new(campaign, calibration)?;
    let mut diagnosis = infer(&model, &evidence);
    let next = in_parallel(diagnosis.findings.len(), |k| {
        next_poses(&model, &context, &evidence, &diagnosis, &diagnosis.findings[k])
    });
    for (finding, next) in diagnosis.findings.iter_mut().zip(next) {
        finding.next = next?;
    }
    let limits = limits(&context, &model.calibration, &evidence);
    Ok(Diagnosed { model, evidence, diagnosis, not_testable, absorbed, limits })
}

/// A calibration as it is given to the engine.
pub(super) struct Prepared<'c> {
    pub model: CalibrationModel<'c>,
    pub evidence: Evidence,
    /// Effects that the calibration hides.
    pub absorbed: Vec<Absorbed>,
    /// Effects that the campaign's files have no data for.
    pub not_testable: Vec<NotTestable>,
    pub context: Context<'c>,
}

impl<'c> Prepared<'c> {
    /// Data are rows × (x, y, z), in {W}, then what is known besides; see `evidence.rs`.
    pub fn new(campaign: &'c Campaign, calibration: Calibration<'c>) -> Result<Prepared<'c>> {
        let context = Context::new(campaign, &calibration)?;
        let evidence = evidence::evidence_of(campaign, &calibration, &context);
        let (mut entries, not_testable) = registry::candidates(&context);
        entries.extend(nonparametric::all(&context));
        let (terms, absorbed) = LinearTerms::new(entries, &evidence);
        let jacobians = context.configurations.iter().map(|there| there.tip_jacobian.clone());
        let recording = &campaign.measurements;
        let name = |group: usize| recording.groups[group].name.clone();
        let model = CalibrationModel {
            campaign,
            calibration,
            tip_jacobians: jacobians.collect(),
            recorded: None,
            groups: recording.rows.iter().map(|row| name(row.group)).collect(),
            scale: context.scale.clone(),
            terms,
        };
        Ok(Prepared { model, evidence, absorbed, not_testable, context })
    }
}

impl<'c> CalibrationModel<'c> {
    /// The model of a finished calibration, with what it leaves as numbers.
    ///
    /// # Errors
    /// As [`crate::calibration::Compensation::new`].
    pub fn new(
        campaign: &'c Campaign,
        calibration: Calibration<'c>,
    ) -> Result<(CalibrationModel<'c>, Evidence)> {
        let prepared = Prepared::new(campaign, calibration)?;
        Ok((prepared.model, prepared.evidence))
    }
}

/// Something that happened while the poses were recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Happened {
    /// The first row, from 0, that it changed.
    pub row: usize,
    /// True for what moved before that row and stayed there; false for a single pose.
    pub stays: bool,
    /// For example `clamp 2 moved`, `pose 7`.
    pub words: String,
}

impl CalibrationDiagnosis<'_> {
    /// All that was found of a joint's gear, joints counted from 0; `None` where nothing was.
    pub fn gear(&self, joint: usize) -> Option<Curve> {
        let mut positions = Vec::new();
        let mut parts = Vec::new();
        for part in self.diagnosis.findings.iter().flat_map(|finding| &finding.parts) {
            let own = self.model.gear_of(part).filter(|gear| gear.joint() == joint);
            if let Some(gear) = own {
                let values = part.term.values.clone();
                positions.extend(part.first..part.first + values.len());
                parts.push((gear.clone(), values));
            }
        }
        let covariance = &self.diagnosis.hypothesis.covariance;
        let covariance = covariance.select_rows(&positions).select_columns(&positions);
        let angles = self.model.angles(joint);
        (!parts.is_empty()).then(|| Curve::new(joint, parts, covariance, &angles))
    }

    /// The joint, from 0, whose gear a finding is about.
    pub fn gear_joint(&self, finding: &Finding) -> Option<usize> {
        self.model.gear_of(finding.parts.first()?).map(|gear| gear.joint())
    }

    /// What happened at single poses, in the order of the findings.
    pub fn happened(&self) -> Vec<Happened> {
        let mut happened = Vec::new();
        for part in self.diagnosis.findings.iter().flat_map(|finding| &finding.parts) {
            let effect = self.model.terms.candidates[part.term.candidate].effect;
            let words = registry::record(effect).and_then(|effect| (effect.event)(&part.location));
            let row = self.model.first_row(&part.term);
            let stays = matches!(part.location, Location::Shift { .. });
            happened.extend(row.zip(words).map(|(row, words)| Happened { row, stays, words }));
        }
        happened
    }
}
