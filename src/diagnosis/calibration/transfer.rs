//! What was found in one campaign, in the poses of another one: where the ball would be.
//!
//! The campaign is calibrated once more with all that was found taken out of its rows; then
//!
//! tip = f(ρ, q, τ) + R·Δx + Σ what each effect does there
//!
//! with the loads, the rod and the clock of the other campaign. What happened to a fixture or to
//! single poses concerns none of them: a clamp that is not where its file has it leaves the ball
//! where it is.

use nalgebra::{DVector, Vector3};

use super::diagnose::CalibrationDiagnosis;
use super::diagnose::beside::Loads;
use super::effects::{Transfer, registry};
use super::model::Context;
use super::model::entry::Entry;
use super::model::law::Law;
use crate::calibration::campaign::Campaign;
use crate::calibration::{Compensation, Options, calibrate_from};
use crate::error::{Error, Result};
use crate::inference::{Candidate, Term};

impl CalibrationDiagnosis<'_> {
    /// Where the ball would be in the poses of `asked`, in {W}, m: one point for every row of its
    /// measurements, whose own points do not matter. Robot and flange are those of the diagnosed
    /// campaign; forces and rod are those of `asked`, whose clock goes on where that of the
    /// recording ended. Of a campaign with sockets {W} is {0}.
    ///
    /// # Errors
    /// [`Error::NotApplicable`] for another robot, or where a drift was found with a clock that
    /// `asked` has not; what the mode of the calibration refuses of `asked`.
    pub fn predicted(&self, asked: &Campaign) -> Result<Vec<Vector3<f64>>> {
        let model = &self.model;
        let campaign = model.campaign;
        let not = |why: String, hint: &str| Error::NotApplicable {
            what: format!("a prediction of {}", asked.file),
            why,
            hint: hint.into(),
        };
        if asked.robot.joints.len() != campaign.robot.joints.len() {
            let hint = "name the robot of the diagnosed campaign";
            return Err(not("it has another robot".into(), hint));
        }
        let calibration = &model.calibration;
        let found = Loads::of(model, &self.diagnosis.hypothesis.terms);
        let plain = Compensation::new(campaign, calibration.mode)?;
        let loaded = found.beside(plain, campaign.rod.as_ref(), &calibration.setup.tool);
        let compensation = Compensation { displaced: found.displaced, ..loaded };
        let free: Vec<_> = calibration.parameters.iter().map(|known| known.parameter).collect();
        let corrected = calibrate_from(
            campaign,
            &campaign.measurements,
            calibration.start.clone(),
            &free,
            &compensation,
            &Options::default(),
        )?;
        let context = Context::later(asked, calibration.mode, &corrected.setup, campaign)?;
        let mut tips: Vec<Vector3<f64>> = context.configurations.iter().map(|there| there.tip).collect();
        for part in self.diagnosis.findings.iter().flat_map(|finding| &finding.parts) {
            let candidate = &model.terms.candidates[part.term.candidate];
            let law = model.law(part.term.candidate);
            let moved = moved(candidate, law, &part.term, &context).ok_or_else(|| {
                not(
                    format!("it lacks the variable that {}, {}, depends on", candidate.effect, part.location),
                    "give its rows the columns of the diagnosed recording",
                )
            })?;
            tips.iter_mut().zip(moved).for_each(|(tip, moved)| *tip += moved);
        }
        Ok(tips)
    }
}

/// What an effect does to the tip at every row of another context, m; `None` where that context
/// lacks what it depends on.
fn moved(candidate: &Candidate, law: &Law, term: &Term, context: &Context) -> Option<Vec<Vector3<f64>>> {
    let effect = registry::record(candidate.effect)?;
    let rows = context.configurations.len();
    let entry = match effect.transfer {
        Transfer::Nothing => return Some(vec![Vector3::zeros(); rows]),
        Transfer::Made(made) => made(context, candidate, law),
        Transfer::Candidate => {
            let is_it = |entry: &Entry| entry.candidate.location == candidate.location && entry.law == *law;
            (effect.candidates)(context, &mut Vec::new()).into_iter().find(is_it)?
        }
    };
    let mut response = DVector::zeros(3 * rows);
    for (parameter, value) in candidate.parameters.iter().zip(&term.values) {
        let names = &mut entry.candidate.parameters.iter();
        let own = names.position(|known| known.name == parameter.name)?;
        entry.columns[own].add_to(&mut response, value - parameter.neutral);
    }
    Some((0..rows).map(|row| response.fixed_rows::<3>(3 * row).into_owned()).collect())
}
