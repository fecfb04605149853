//! Which rod with which mode of compensation is worth it, before anybody records anything.

use super::forecast::{Budget, Forecast, Forecaster, Where};
use super::poses::{PoseCriterion, PoseLimits, PoseStudy, Source, Wanted};
use crate::beam::Physics;
use crate::calibration::campaign::{Campaign, Recording, Targets};
use crate::calibration::{Mode, places, planned_setup};
use crate::compliance::{Compliance, DEFAULT_ELEMENTS, closed_form, paper_contact_force};
use crate::error::Result;
use crate::rod::Rod;
use crate::units::DEG;

/// Candidates for every chosen pose of a rod that nothing was recorded with.
const CANDIDATES: usize = 12;
/// Poses on each clamp where neither a recording nor the user says how many: the paper's.
const PER_CLAMP: usize = 30;

/// What is to be expected of one rod in every mode.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RodForecast {
    /// The rod's name; empty without a rod.
    pub rod: String,
    /// c_rod of the beam model under the paper's contact force, m; 0 without a rod.
    pub c_rod: f64,
    /// Number of poses that the forecast is of.
    pub poses: usize,
    /// True for the poses of the recording, false for poses that were chosen by O1.
    pub is_recorded: bool,
    /// In every mode that applies, in the paper's order.
    pub modes: Vec<Forecast>,
    /// True where the rod is still to be measured: 1 % is assumed for mode meas.
    pub is_rig_assumed: bool,
}

/// Forecasts of the campaign's own rod (`rods` empty) or of others in its place, with the recorded
/// poses where there are any, else with `count` poses chosen by O1 for each.
///
/// ```
/// use rodcal::design::{Budget, Where, rods_and_modes};
/// use rodcal::prelude::*;
///
/// let campaign = Campaign::read("campaigns/tx90-5/campaign.toml".as_ref())?;
/// let budget = Budget::of(&campaign, Some(17.6e-6), Some(30e-6), 0.0)?;
/// let rods = rods_and_modes(&campaign, &[], &budget, &Where::Validation, None)?;
/// let means: Vec<f64> = rods[0].modes.iter().map(|forecast| forecast.mean).collect();
/// assert_eq!((means.len(), rods[0].poses, rods[0].is_recorded), (4, 60, true));
/// // a rod that is assumed rigid is worse than one that was measured, by little
/// assert!((1.0..1.2).contains(&(means[0] / means[3])), "{means:?}");
/// # Ok::<(), rodcal::Error>(())
/// ```
///
/// # Errors
/// What the choice of poses and the forecast refuse.
pub fn rods_and_modes(
    campaign: &Campaign,
    rods: &[Rod],
    budget: &Budget,
    at: &Where,
    count: Option<usize>,
) -> Result<Vec<RodForecast>> {
    let all: Vec<Option<&Rod>> = match rods.is_empty() {
        true => vec![campaign.rod.as_ref()],
        false => rods.iter().map(Some).collect(),
    };
    all.into_iter().map(|rod| rod_forecast(campaign, rod, budget, at, count)).collect()
}

/// The same of one rod in the place of the campaign's own, or of that; `None` for a campaign
/// without any.
///
/// # Errors
/// As [`rods_and_modes`].
pub(super) fn rod_forecast(
    campaign: &Campaign,
    rod: Option<&Rod>,
    budget: &Budget,
    at: &Where,
    count: Option<usize>,
) -> Result<RodForecast> {
    let recorded = campaign.measurements.len();
    let other = rod.filter(|rod| campaign.rod.as_ref() != Some(*rod));
    let is_recorded = other.is_none() && recorded > 0 && count.is_none();
    let planned = other.map_or_else(|| Ok(campaign.clone()), |rod| with_rod(campaign, rod))?;
    let setup = planned_setup(&planned)?;
    let poses = match is_recorded {
        true => recorded_poses(&planned, &setup),
        false => {
            let (places, _) = places(&planned, &setup);
            let default = if recorded > 0 { recorded } else { PER_CLAMP * places.len().max(1) };
            let count = count.unwrap_or(default);
            let wanted = Wanted {
                count,
                criterion: PoseCriterion::O1,
                source: Source::Generated(CANDIDATES * count),
                limits: PoseLimits { change: 1.0 * DEG, ..PoseLimits::default() },
                mode: rod.map(|_| Mode::Fea),
                at: at.clone(),
                seed: budget.seed,
            };
            PoseStudy::new(&planned, wanted, budget.clone(), &|_| {})?.chosen
        }
    };
    let forecaster = Forecaster::new(&planned, setup.clone(), budget.clone(), at)?;
    let has_calc = rod.is_some_and(|rod| closed_form::compliance(rod).is_ok());
    let modes = Mode::ALL.into_iter().filter(|&mode| match mode {
        Mode::None => true,
        Mode::Calc => has_calc,
        Mode::Fea | Mode::Meas => rod.is_some(),
    });
    Ok(RodForecast {
        rod: rod.map(|rod| rod.name.clone()).unwrap_or_default(),
        c_rod: rod.map(c_rod).transpose()?.unwrap_or(0.0),
        poses: poses.len(),
        is_recorded,
        modes: modes.map(|mode| forecaster.forecast(&poses, mode)).collect::<Result<_>>()?,
        is_rig_assumed: rod.is_some() && planned.readings.is_none(),
    })
}

/// c_rod of the beam model under the paper's contact force, m.
pub(super) fn c_rod(rod: &Rod) -> Result<f64> {
    let model = Compliance::of_model(rod, &Physics::default(), DEFAULT_ELEMENTS)?;
    Ok(model.index(paper_contact_force()))
}

/// The campaign with another rod, nothing recorded, its base where the recording has it.
fn with_rod(campaign: &Campaign, rod: &Rod) -> Result<Campaign> {
    let base = planned_setup(campaign)?.base();
    let mut planned =
        campaign.clone().with_rod(rod.clone()).with_base(base.origin.into(), base.roll_pitch_yaw());
    planned.readings = None;
    planned.tool_is_given = false;
    if matches!(planned.measurements.targets, Targets::Points(_)) {
        planned.measurements = Recording::new(planned.robot.joints.len());
    }
    Ok(planned)
}

fn recorded_poses(campaign: &Campaign, setup: &crate::robot::Setup) -> Vec<(usize, Vec<f64>)> {
    let recording = &campaign.measurements;
    let (places, _) = places(campaign, setup);
    let place = |group: usize| {
        let name = &recording.groups[group].name;
        places.iter().position(|place| place.name == *name).unwrap_or(0)
    };
    (0..recording.len())
        .map(|row| (place(recording.rows[row].group), recording.joints(row).to_vec()))
        .collect()
}
