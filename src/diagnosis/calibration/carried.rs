//! What was found in one campaign, in the poses of another one: where the ball would be.
//!
//! The campaign is calibrated once more with all that was found taken out of its rows; then
//!
//! tip = f(ρ, q, τ) + R·Δx + Σ what each effect does there
//!
//! with the loads, the rod and the clock of the other campaign. What happened to a fixture or to single poses concerns none of
//! them: a clamp that is not where its file has it leaves the ball where it is.

use nalgebra::{DVector, Vector3};

use super::library;
use super::scene::{Entry, Scene};
use super::{CalibrationDiagnosis, CalibrationWorld};
use crate::calibration::campaign::Campaign;
use crate::calibration::{Compensation, Options, calibrate_from};
use crate::diagnosis::{Chosen, World};
use crate::error::{Error, Result};

/// What says nothing of other poses.
const OF_THE_RECORDING: [&str; 5] =
    ["clamp_pose", "clamp_shift", "socket_shift", "outlier", "contact_force_variation"];

impl CalibrationDiagnosis<'_> {
    /// Where the ball would be in the poses of `asked`, in {W}, m: one point for every row of its measurements, whose own points
    /// do not matter. Robot and flange are those of `campaign`, which was diagnosed; forces and rod are those of `asked`, whose
    /// clock goes on where that of the recording ended. Of a campaign with sockets {W} is {0}.
    ///
    /// # Errors
    /// [`Error::NotApplicable`] for another robot, or where a drift was found with a clock that `asked` has not; what the mode of
    /// the calibration refuses of `asked`.
    pub fn predicted(&self, campaign: &Campaign, asked: &Campaign) -> Result<Vec<Vector3<f64>>> {
        let not = |why: String, hint: &str| Error::NotApplicable {
            what: format!("a prediction of {}", asked.file),
            why,
            hint: hint.into(),
        };
        if asked.robot.joints.len() != campaign.robot.joints.len() {
            return Err(not("it has another robot".into(), "name the robot of the diagnosed campaign"));
        }
        let calibration = &self.calibration;
        let compensation = Compensation {
            displaced: self.by_row(&self.world.change(&self.diagnosis.story.chosen)),
            ..Compensation::new(campaign, calibration.mode)?
        };
        let free: Vec<_> = calibration.parameters.iter().map(|estimated| estimated.parameter).collect();
        let start = calibration.start.clone();
        let corrected = calibrate_from(
            campaign,
            &campaign.measurements,
            start,
            &free,
            &compensation,
            &Options::default(),
        )?;
        let scene = Scene::later(asked, calibration.mode, &corrected.setup, campaign)?;
        let (entries, _) = library::all(&scene);
        let mut tips: Vec<Vector3<f64>> = scene.postures.iter().map(|posture| posture.tip).collect();
        for finding in &self.diagnosis.findings {
            let change = carried(&self.world, &finding.chosen, &scene, &entries).ok_or_else(|| {
                let effect = &self.world.candidates()[finding.chosen.candidate].effect;
                not(
                    format!("it does not say what {effect}, {}, depends on", finding.place),
                    "give its rows the columns of the diagnosed recording",
                )
            })?;
            tips.iter_mut().zip(change).for_each(|(tip, change)| *tip += change);
        }
        Ok(tips)
    }
}

/// What an effect does to the tip at every row of another scene, m; `None` where that scene lacks what it depends on.
fn carried(
    world: &CalibrationWorld,
    chosen: &Chosen,
    scene: &Scene,
    entries: &[Entry],
) -> Option<Vec<Vector3<f64>>> {
    let candidate = &world.candidates()[chosen.candidate];
    let by_row = |of: &dyn Fn(usize) -> Vector3<f64>| (0..scene.postures.len()).map(of).collect();
    if OF_THE_RECORDING.contains(&candidate.effect.as_str()) {
        return Some(by_row(&|_| Vector3::zeros()));
    }
    if let Some(gear) = world.gear(chosen.candidate) {
        let turn = |q: f64| -> f64 {
            chosen.values.iter().enumerate().map(|(k, value)| value * gear.term(k, q)).sum()
        };
        let joint = gear.joint();
        let of_row = |row: usize| {
            let posture = &scene.postures[row];
            posture.lever[joint] * turn(posture.joints[joint])
        };
        return Some(by_row(&of_row));
    }
    let is_it =
        |e: &&Entry| (&e.candidate.effect, &e.candidate.location) == (&candidate.effect, &candidate.location);
    // the robot stands where it was moved to, whatever row that was after: also if a later pose has that one's name
    let moved = library::base_moved(scene, 0..scene.postures.len(), candidate.location.clone());
    let entry = std::iter::once(&moved).chain(entries).find(is_it)?;
    let mut change = DVector::zeros(3 * scene.postures.len());
    for (parameter, value) in candidate.parameters.iter().zip(&chosen.values) {
        let own = entry.candidate.parameters.iter().position(|p| p.name == parameter.name)?;
        entry.columns[own].add_to(&mut change, value - parameter.neutral);
    }
    Some(by_row(&|row| change.fixed_rows::<3>(3 * row).into_owned()))
}
