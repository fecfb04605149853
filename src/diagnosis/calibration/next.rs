//! The measurement that would tell a mismatch from its rivals.
//!
//! With poses added to those of the campaign, story A says ηA of all of them. What story B, fitted to that together with all
//! that the calibration absorbs, cannot follow is left: M_B·ηA. The ln of the odds between the two is then expected to be
//!
//! ½·‖M_B·ηA‖²/σ²
//!
//! of which what the recorded poses make already is not counted, and of which the less counts of both ways round. Of all
//! plans the one is proposed that leaves least of the rivals (`choice.rs`). What can be weighed or gauged needs no poses.

use nalgebra::DMatrix;

use super::feasible::{Plan, feasible};
use super::findings::{Mismatch, location};
use super::scene::Scene;
use super::{CalibrationWorld, evidence, library};
use crate::calibration::Calibration;
use crate::calibration::campaign::Campaign;
use crate::diagnosis::choice::{Choice, is_told};
use crate::diagnosis::whitening::Whitening;
use crate::diagnosis::{Chosen, Diagnosis, Evidence, Rival, World};
use crate::error::Result;

/// Rivals that poses have to separate the finding from: the likeliest ones.
const MOST_RIVALS: usize = 3;
/// Ln odds that leave no doubt: as of what is weighed or gauged.
const DECISIVE: f64 = 30.0;

/// Poses to measure next.
#[derive(Debug, Clone, PartialEq)]
pub struct NextPoses {
    /// In the user's words; a full sentence.
    pub words: String,
    /// The same as numbers; `None` for what is weighed or gauged without any poses.
    pub plan: Option<Plan>,
    /// By how much they would tell the mismatch from the closest of the rivals that they can tell: ln of the odds that are
    /// expected, 30 at most.
    pub log_odds: f64,
}

/// The poses that best tell `mismatch` from its rivals; `None` where it has none, or where none of the plans can.
pub(super) fn next_poses(
    campaign: &Campaign,
    calibration: &Calibration,
    scene: &Scene,
    world: &CalibrationWorld,
    present: &Evidence,
    diagnosis: &Diagnosis,
    mismatch: &Mismatch,
) -> Result<Option<NextPoses>> {
    let rivals = apart(world, diagnosis, mismatch);
    if rivals.is_empty() {
        return Ok(None);
    }
    // what can be weighed or gauged needs no poses
    let effects = rivals.iter().map(|rival| world.candidates()[rival.chosen.candidate].effect.as_str());
    if let Some(words) = std::iter::once(mismatch.effect.as_str()).chain(effects).find_map(directly) {
        return Ok(Some(NextPoses { words: words.into(), plan: None, log_odds: DECISIVE }));
    }
    let own = Named::of(world, &diagnosis.story.chosen);
    let others: Vec<Named> = rivals.iter().map(|rival| Named::of(world, &rival.story.chosen)).collect();
    let variance = diagnosis.story.sigma.powi(2);
    let distances = |world: &CalibrationWorld, evidence: &Evidence| -> Option<Vec<Option<f64>>> {
        let own = own.found_in(world)?;
        let apart = |other: &Named| {
            let other = other.found_in(world)?;
            let one_way = unfollowed(world, evidence, &own, &other);
            Some(one_way.min(unfollowed(world, evidence, &other, &own)) / (2.0 * variance))
        };
        Some(others.iter().map(apart).collect())
    };
    let Some(now) = distances(world, present) else { return Ok(None) };
    let odds: Vec<f64> = rivals.iter().map(|rival| rival.odds).collect();
    let mut choice = Choice::new();
    for plan in feasible(campaign, &scene.postures) {
        let stories: Vec<&Named> = std::iter::once(&own).chain(&others).collect();
        let (world, evidence) = future(campaign, calibration, &plan, &stories)?;
        let Some(then) = distances(&world, &evidence) else { continue };
        let gained = |(then, now): (&Option<f64>, &Option<f64>)| match (then, now) {
            (Some(then), Some(now)) => then - now,
            // the scan of another number of rows has no place for this rival: nothing is known
            _ => 0.0,
        };
        let gained = then.iter().zip(&now).map(gained).collect();
        choice.offer(plan, gained, &odds);
    }
    Ok(choice.best().map(|(plan, gained)| {
        let told = gained.into_iter().filter(|apart| is_told(*apart));
        let log_odds = told.fold(DECISIVE, f64::min);
        NextPoses { words: plan.words.clone(), plan: Some(plan), log_odds }
    }))
}

/// The likeliest rivals that are told as something else than the mismatch.
fn apart<'d>(world: &CalibrationWorld, diagnosis: &'d Diagnosis, mismatch: &Mismatch) -> Vec<&'d Rival> {
    let is_other = |rival: &&Rival| {
        let effect = &world.candidates()[rival.chosen.candidate].effect;
        effect != &mismatch.effect || location(effect, &rival.place) != mismatch.location
    };
    let rivals = mismatch.parts.iter().flat_map(|&part| &diagnosis.findings[part].rivals);
    let mut rivals: Vec<&Rival> = rivals.filter(is_other).collect();
    rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
    rivals.truncate(MOST_RIVALS);
    rivals
}

/// How a cause is measured without the robot.
fn directly(effect: &str) -> Option<&'static str> {
    match effect {
        "tip_mass" => Some("Weigh the ball with its holder."),
        "payload_mass" => Some("Weigh what is on the flange."),
        "contact_force_variation" => Some("Measure the contact force with a spring balance."),
        "rod_stiffness" => Some("Hang known weights on the rod and let `rodcal rig fit` find its stiffness."),
        _ => None,
    }
}

/// A story whose effects are known by name and place, so that they are found in another world.
struct Named(Vec<(String, String, Vec<f64>)>);

impl Named {
    fn of(world: &CalibrationWorld, story: &[Chosen]) -> Self {
        let of = |chosen: &Chosen| {
            let candidate = &world.candidates()[chosen.candidate];
            (candidate.effect.clone(), candidate.location.clone(), chosen.values.clone())
        };
        Named(story.iter().map(of).collect())
    }

    /// `None` where one of them is not there, or has other parameters.
    fn found_in(&self, world: &CalibrationWorld) -> Option<Vec<Chosen>> {
        let of = |(effect, location, values): &(String, String, Vec<f64>)| {
            let is_it = |c: &crate::diagnosis::Candidate| {
                &c.effect == effect && &c.location == location && c.parameters.len() == values.len()
            };
            let candidate = world.candidates().iter().position(is_it)?;
            Some(Chosen { candidate, values: values.clone() })
        };
        self.0.iter().map(of).collect()
    }

    fn holds(&self, effect: &str, location: &str) -> bool {
        self.0.iter().any(|(own, place, _)| own == effect && place == location)
    }
}

/// The world with a plan's poses, of the effects of some stories only.
fn future(
    campaign: &Campaign,
    calibration: &Calibration,
    plan: &Plan,
    stories: &[&Named],
) -> Result<(CalibrationWorld, Evidence)> {
    let (campaign, calibration) = plan.made(campaign, calibration);
    let scene = Scene::new(&campaign, &calibration)?;
    let evidence = evidence::of(&campaign, &calibration, &scene);
    let (mut entries, _) = library::all(&scene);
    entries.retain(|entry| {
        let candidate = &entry.candidate;
        stories.iter().any(|story| story.holds(&candidate.effect, &candidate.location))
    });
    Ok((CalibrationWorld::of(entries, &evidence), evidence))
}

/// ‖M_B·ηA‖², m².
fn unfollowed(world: &CalibrationWorld, evidence: &Evidence, a: &[Chosen], b: &[Chosen]) -> f64 {
    let own: Vec<DMatrix<f64>> = (0..b.len()).map(|position| world.columns(b, position)).collect();
    let columns: Vec<_> = std::iter::once(&evidence.nuisance)
        .chain(&own)
        .flat_map(|matrix| matrix.column_iter().map(|column| column.into_owned()).collect::<Vec<_>>())
        .collect();
    let absorbed = match columns.is_empty() {
        true => DMatrix::zeros(evidence.residual.len(), 0),
        false => DMatrix::from_columns(&columns),
    };
    let evidence = Evidence { nuisance: absorbed, ..evidence.clone() };
    let whitening = Whitening::new(&evidence, &evidence.residual);
    whitening.apply(&world.change(a)).norm_squared()
}
