//! A calibration as the engine gets it: the model with all its effects, and the evidence.

use nalgebra::Vector3;

use super::super::effects::registry;
use super::super::evidence;
use super::super::model::context::Side;
use super::super::model::covariance::Covariance;
use super::super::model::torque_uncertainty::TorqueUncertainty;
use super::super::model::{CalibrationModel, Context, LinearTerms};
use super::super::nonparametric;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Carried, Noise};
use crate::error::Result;
use crate::inference::{Absorbed, Evidence, NotTestable};

/// A calibration as it is given to the engine.
pub struct Prepared<'c> {
    /// The calibration about which effects are linear.
    pub about: Calibration<'c>,
    pub model: CalibrationModel<'c>,
    pub evidence: Evidence,
    /// Effects that the calibration hides.
    pub absorbed: Vec<Absorbed>,
    /// Effects that the campaign's files have no data for.
    pub not_testable: Vec<NotTestable>,
    pub context: Context<'c>,
}

/// What a first look at the residuals has shown.
#[derive(Default, Clone)]
pub struct FirstLook {
    /// How groups scatter, where they do so unequally.
    pub scatter: Option<Noise>,
    /// What poses scatter by, where that is not as much along every axis.
    pub covariance: Option<Covariance>,
    /// What each row counts, where tails are heavy.
    pub weights: Option<Vec<f64>>,
    /// Rows, from 0, that may as well have been misread as be such a tail.
    pub far_out: Vec<usize>,
    /// What is left of each row, in {W}, m; `None` where that is what the calibration leaves.
    pub left: Option<Vec<Vector3<f64>>>,
    /// Rows, from 0, after which something has moved.
    pub moved_after: Vec<usize>,
    /// Rows and joints, from 0, whose load pulls to the other side than the file says.
    pub turned: Vec<Side>,
    /// What hung on the flange of the robot about which effects are linear.
    pub carried: Vec<Carried>,
}

impl<'c> Prepared<'c> {
    /// Data are rows × (x, y, z), in {W}, then what is known besides; see `evidence.rs`.
    pub fn new(campaign: &'c Campaign, calibration: Calibration<'c>) -> Result<Prepared<'c>> {
        Prepared::about(campaign, calibration.clone(), calibration, &FirstLook::default())
    }

    /// The same of effects that are linear about another robot, after a first look.
    pub fn about(
        campaign: &'c Campaign,
        calibration: Calibration<'c>,
        about: Calibration<'c>,
        look: &FirstLook,
    ) -> Result<Prepared<'c>> {
        Prepared::with_effects(campaign, (calibration, about), look, true)
    }

    /// The same of a finished calibration with no effect of the library, what has no name alone.
    pub fn unnamed(
        campaign: &'c Campaign,
        calibration: Calibration<'c>,
        look: &FirstLook,
    ) -> Result<Prepared<'c>> {
        let look = FirstLook { carried: Vec::new(), ..look.clone() };
        Prepared::with_effects(campaign, (calibration.clone(), calibration), &look, false)
    }

    /// True where effects are linear about the robot as it was calibrated, beside nothing else.
    pub fn is_as_calibrated(&self) -> bool {
        self.about.deviations == self.model.calibration.deviations
    }

    fn with_effects(
        campaign: &'c Campaign,
        (calibration, about): (Calibration<'c>, Calibration<'c>),
        look: &FirstLook,
        has_names: bool,
    ) -> Result<Prepared<'c>> {
        let context = Context::new(campaign, &about)?;
        let context = match &look.covariance {
            Some(covariance) => {
                let whitens = covariance.weights(&context);
                context.whitened(whitens)
            }
            None => context,
        };
        let context = match &look.scatter {
            Some(noise) => context.scattered(&noise.of_group),
            None => context,
        };
        let context = match &look.weights {
            Some(weights) => context.weighted(weights),
            None => context,
        };
        let context = match &look.left {
            Some(left) => context.left(left),
            None => context,
        };
        let context = context.moved_after(&look.moved_after).turned(&look.turned).carrying(&look.carried);
        let evidence = evidence::evidence_of(campaign, &about, &context);
        let (mut entries, not_testable) =
            if has_names { registry::candidates(&context) } else { (Vec::new(), Vec::new()) };
        entries.extend(nonparametric::all(&context));
        let (terms, absorbed) = LinearTerms::new(entries, &evidence);
        let jacobians = context.configurations.iter().map(|there| there.tip_jacobian.clone());
        let model = CalibrationModel {
            campaign,
            calibration,
            tip_jacobians: jacobians.collect(),
            recorded: None,
            validated: None,
            scatter: look.covariance.as_ref().map(|covariance| covariance.sources(&context)),
            weights: context.weights(),
            torque_uncertainty: TorqueUncertainty::new(campaign, &context),
            terms,
        };
        Ok(Prepared { about, model, evidence, absorbed, not_testable, context })
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
