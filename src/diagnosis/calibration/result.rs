//! What a campaign says about its calibration: the engine's diagnosis with what only the calibration knows.

use nalgebra::{DVector, Vector3};

use super::evidence::session_name;
use super::findings::{Mismatch, location, mismatches};
use super::gear::Curve;
use super::limits::{Limit, limits};
use super::next::{NextPoses, next_poses};
use super::scene::Scene;
use super::{CalibrationWorld, Gear};
use crate::calibration::campaign::Campaign;
use crate::calibration::{Calibration, Mode, Options, calibrate};
use crate::diagnosis::{Candidate, Diagnosis, Evidence, World, diagnose as of_world};
use crate::error::Result;
use crate::parallel::in_parallel;

/// A campaign's diagnosis.
#[derive(Debug, Clone)]
pub struct CalibrationDiagnosis<'c> {
    /// The best calibration without any of the effects.
    pub calibration: Calibration<'c>,
    /// The physics that was asked about; which effects are absorbed or not testable is in it.
    pub world: CalibrationWorld,
    /// The recording as numbers.
    pub evidence: Evidence,
    /// What was found.
    pub diagnosis: Diagnosis,
    /// The same as it is told, strongest first: what concerns one joint's gear is one thing, and so are all outliers.
    pub mismatches: Vec<Mismatch>,
    /// For each of them the poses that would tell it from its rivals.
    pub next: Vec<Option<NextPoses>>,
    /// ∂tip/∂q of every joint at each row, m/rad (or m/m).
    pub levers: Vec<Vec<Vector3<f64>>>,
    /// What makes every claim weaker.
    pub limits: Vec<Limit>,
    /// Name of the clamp or socket of each row.
    pub groups: Vec<String>,
}

/// Calibrates `campaign` and diagnoses what is left.
///
/// # Errors
/// As [`calibrate`].
pub fn diagnose<'c>(
    campaign: &'c Campaign,
    mode: Mode,
    options: &Options,
) -> Result<CalibrationDiagnosis<'c>> {
    let calibration = calibrate(campaign, mode, options)?;
    let (world, evidence) = CalibrationWorld::new(campaign, &calibration)?;
    let diagnosis = of_world(&world, &evidence);
    let scene = Scene::new(campaign, &calibration)?;
    let limits = limits(&scene, &calibration, &evidence);
    let mismatches = mismatches(&world, campaign, &diagnosis);
    let next = in_parallel(mismatches.len(), |k| {
        next_poses(campaign, &calibration, &scene, &world, &evidence, &diagnosis, &mismatches[k])
    });
    let next = next.into_iter().collect::<Result<Vec<_>>>()?;
    let levers = scene.postures.into_iter().map(|posture| posture.lever).collect();
    let recording = &campaign.measurements;
    let groups = recording.rows.iter().map(|row| recording.groups[row.group].name.clone()).collect();
    Ok(CalibrationDiagnosis {
        calibration,
        world,
        evidence,
        diagnosis,
        mismatches,
        next,
        levers,
        limits,
        groups,
    })
}

impl CalibrationDiagnosis<'_> {
    /// Name of a session: a clamp, or a placement of sockets.
    pub fn session(&self, number: usize) -> &str {
        let datum = self.evidence.session.iter().position(|&session| session == number);
        let group = datum.and_then(|datum| self.groups.get(datum / 3));
        group.map_or("", |group| session_name(group))
    }

    /// Of numbers by datum the displacement of each row in {W}, m: for residuals and changes.
    pub fn by_row(&self, data: &DVector<f64>) -> Vec<Vector3<f64>> {
        let row = |row: usize| data.fixed_rows::<3>(3 * row).into_owned() / self.world.scale(row);
        (0..self.levers.len()).map(row).collect()
    }

    /// What one mismatch does to the recording by itself, as data.
    pub fn change(&self, mismatch: &Mismatch) -> DVector<f64> {
        let parts = mismatch.parts.iter().map(|&part| self.diagnosis.findings[part].chosen.clone());
        self.world.change(&parts.collect::<Vec<_>>())
    }

    /// Effects at their places that stand for a mismatch as well, likeliest first, none of them twice.
    pub fn others(&self, mismatch: &Mismatch) -> Vec<(String, String)> {
        let mut rivals: Vec<_> =
            mismatch.parts.iter().flat_map(|&part| &self.diagnosis.findings[part].rivals).collect();
        rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
        let mut others = Vec::new();
        for rival in rivals {
            let effect = self.world.candidates()[rival.chosen.candidate].effect.clone();
            let other = (effect.clone(), location(&effect, &rival.place));
            let is_itself = other.0 == mismatch.effect && other.1 == mismatch.location;
            if !is_itself && !others.contains(&other) {
                others.push(other);
            }
        }
        others
    }

    /// How many stories of the folds hold a mismatch, of how many: its effect, and in joints at its joint.
    pub fn found_in_folds(&self, mismatch: &Mismatch) -> Option<(usize, usize)> {
        let stories = &self.diagnosis.proof.as_ref()?.stories;
        let is_it = |chosen: &crate::diagnosis::Chosen| {
            let candidate = &self.world.candidates()[chosen.candidate];
            candidate.effect == mismatch.effect
                && (!mismatch.location.starts_with("joint ")
                    || location(&candidate.effect, &candidate.location) == mismatch.location)
        };
        let count = stories.iter().filter(|story| story.iter().any(is_it)).count();
        Some((count, stories.len()))
    }

    /// What the calibration hides, by effect: the places, without those that are seen in another form.
    pub fn hidden(&self) -> Vec<(String, Vec<String>)> {
        let is_seen = |effect: &str, place: &str| {
            let seen = |c: &Candidate| c.effect == effect && location(effect, &c.location) == place;
            self.world.candidates().iter().any(seen)
        };
        let mut hidden: Vec<(String, Vec<String>)> = Vec::new();
        for absorbed in &self.world.absorbed {
            let place = location(&absorbed.effect, &absorbed.location);
            if is_seen(&absorbed.effect, &place) {
                continue;
            }
            match hidden.iter_mut().find(|(effect, _)| *effect == absorbed.effect) {
                Some((_, places)) if places.contains(&place) => {}
                Some((_, places)) => places.push(place),
                None => hidden.push((absorbed.effect.clone(), vec![place])),
            }
        }
        hidden
    }

    /// All that was found of a joint's gear, over the angles of `campaign`; `None` where nothing was.
    pub fn gear(&self, campaign: &Campaign, joint: usize) -> Option<Curve> {
        let mut parts = Vec::new();
        let mut places = Vec::new();
        for finding in &self.diagnosis.findings {
            let gear = self.world.gear(finding.chosen.candidate).filter(|gear| Gear::joint(gear) == joint);
            if let Some(gear) = gear {
                places.extend(finding.first..finding.first + finding.chosen.values.len());
                parts.push((gear.clone(), finding.chosen.values.clone()));
            }
        }
        let covariance = self.diagnosis.story.covariance.select_rows(&places).select_columns(&places);
        let recording = &campaign.measurements;
        let angles: Vec<f64> = (0..recording.len()).map(|row| recording.joints(row)[joint]).collect();
        (!parts.is_empty()).then(|| Curve::new(joint, parts, covariance, &angles))
    }
}
