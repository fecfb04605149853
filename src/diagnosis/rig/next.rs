//! The measurement that would tell a finding from its rivals.
//!
//! Two stories predict new readings η₁ and η₂, each with the uncertainty that its parameters have by now. New readings of noise
//! σ tell them apart by the expected ln of the odds
//!
//! ½·dᵀ·(σ²(1 + ρJ) + S₁Σ₁S₁ᵀ + S₂Σ₂S₂ᵀ)⁻¹·d,   d = η₁ − η₂
//!
//! with S the sensitivities and Σ the covariances of the parameters. Of the feasible measurements the one is proposed that
//! leaves least of the rivals (`choice.rs`).

use nalgebra::{DMatrix, DVector};

use super::carried::{Carried, is_same};
use super::feasible::{Measurement, Plan, feasible};
use super::{Body, RigWorld};
use crate::diagnosis::choice::{Choice, is_told};
use crate::diagnosis::{Candidate, Chosen, Diagnosis, Evidence, Finding, Rival, Story, World};
use crate::error::Result;
use crate::rig::readings::Readings;
use crate::rod::Rod;

/// Effects that a measurement has to separate the finding from, and their places: the likeliest ones.
const MOST_RIVALS: usize = 6;
const MOST_PLACES: usize = 10;

/// A measurement to make next.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// In the user's words; a full sentence.
    pub words: String,
    /// The same as numbers.
    pub plan: Plan,
    /// By how much it would tell the finding from the closest of `rivals`: ln of the odds that are expected.
    pub log_odds: f64,
    /// What it tells the finding from: effect and place.
    pub rivals: Vec<(String, String)>,
}

/// The feasible measurement that best tells `finding` from its rivals; `None` where it has none, or where no measurement tells
/// it from any of them.
pub(super) fn next_measurement(
    readings: &Readings,
    rod: Option<&Rod>,
    world: &RigWorld,
    evidence: &Evidence,
    diagnosis: &Diagnosis,
    finding: &Finding,
) -> Result<Option<Proposal>> {
    let rivals = apart(world, finding);
    if rivals.is_empty() {
        return Ok(None);
    }
    let noise = diagnosis.story.sigma.max(evidence.resolution / 12.0f64.sqrt());
    let odds: Vec<f64> = rivals.iter().map(|rival| rival.odds).collect();
    let mut choice = Choice::new();
    let stories = rivals.iter().map(|rival| &rival.story).chain([&diagnosis.story]);
    let involved: Vec<&Candidate> =
        stories.flat_map(|story| &story.chosen).map(|chosen| &world.candidates[chosen.candidate]).collect();
    for measurement in feasible(readings, rod) {
        let Some(future) = Future::new(&measurement, world, rod, &involved)? else { continue };
        let of_rival = |rival: &&Rival| {
            future.log_odds(world, &diagnosis.story, &rival.story, noise, diagnosis.shared_ratio)
        };
        let separations: Vec<f64> = rivals.iter().map(of_rival).collect();
        choice.offer(measurement, separations, &odds);
    }
    Ok(choice.best().map(|(measurement, separations)| {
        let told = || rivals.iter().zip(&separations).filter(|(_, apart)| is_told(**apart));
        let name = |rival: &Rival| world.candidates()[rival.chosen.candidate].effect.clone();
        Proposal {
            words: measurement.words,
            plan: measurement.plan,
            log_odds: told().map(|(_, apart)| *apart).fold(f64::INFINITY, f64::min),
            rivals: told().map(|(rival, _)| (name(rival), rival.place.clone())).collect(),
        }
    }))
}

/// The rivals to be told apart: the likeliest of every other effect, with the other places where it may sit; without any, those
/// of the same effect at the farthest places.
fn apart<'a>(world: &RigWorld, finding: &'a Finding) -> Vec<&'a Rival> {
    let effect = |chosen: &Chosen| world.candidates()[chosen.candidate].effect.as_str();
    let own = effect(&finding.chosen);
    let mut apart: Vec<&Rival> = Vec::new();
    for rival in &finding.rivals {
        let is_new = apart.iter().all(|known| effect(&known.chosen) != effect(&rival.chosen));
        if effect(&rival.chosen) != own && is_new && apart.len() < MOST_RIVALS {
            apart.push(rival);
        }
    }
    let is_rival = |rival: &&Rival| apart.iter().any(|known| effect(&known.chosen) == effect(&rival.chosen));
    let is_other = |rival: &&Rival| apart.iter().all(|known| known.chosen != rival.chosen);
    let places: Vec<&Rival> =
        finding.rivals.iter().filter(is_rival).filter(is_other).take(MOST_PLACES - MOST_RIVALS).collect();
    apart.extend(places);
    if apart.is_empty() {
        let mut places: Vec<&Rival> = finding.rivals.iter().collect();
        places.sort_by_key(|rival| rival.chosen.candidate);
        apart.extend(places.first().copied());
        apart.extend(places.last().copied().filter(|_| places.len() > 1));
    }
    apart
}

/// Readings that might be made, as a world of their own.
struct Future {
    world: RigWorld,
    /// The data that are new.
    rows: Vec<usize>,
    shared: Vec<usize>,
    nuisance: DMatrix<f64>,
}

impl Future {
    /// `None` where the measurement is none for this world.
    fn new(
        measurement: &Measurement,
        present: &RigWorld,
        rod: Option<&Rod>,
        involved: &[&Candidate],
    ) -> Result<Option<Future>> {
        let is_involved = |candidate: &Candidate| involved.iter().any(|known| is_same(candidate, known));
        let (world, evidence) = RigWorld::of_candidates(&measurement.readings, rod, &is_involved)?;
        let rows: Vec<usize> =
            (0..world.data.len()).filter(|&i| world.data[i].row > measurement.known_rows).collect();
        let is_none = rows.is_empty()
            || matches!((&present.body, &world.body), (Body::Lines(a), Body::Lines(b)) if a != b);
        Ok((!is_none).then(|| Future {
            shared: rows.iter().map(|&row| evidence.shared[row]).collect(),
            nuisance: evidence.nuisance.select_rows(&rows),
            world,
            rows,
        }))
    }

    fn log_odds(&self, present: &RigWorld, a: &Story, b: &Story, noise: f64, shared_ratio: f64) -> f64 {
        let n = self.rows.len();
        let mut covariance = DMatrix::from_fn(n, n, |i, j| {
            let shared = if self.shared[i] == self.shared[j] { shared_ratio } else { 0.0 };
            noise * noise * (shared + f64::from(u8::from(i == j)))
        });
        let mut difference = DVector::zeros(n);
        for (story, sign) in [(a, 1.0), (b, -1.0)] {
            let carried = self.world.carried(present, &story.chosen);
            difference += self.world.change(&carried.story).select_rows(&self.rows) * sign;
            let columns = self.sensitivities(&carried.story);
            covariance += &columns * self.covariance(story, &carried) * columns.transpose();
        }
        // what the base model absorbs by itself tells nothing
        let scale = difference.amax().max(noise);
        for column in self.nuisance.column_iter() {
            let unit = column.amax();
            if unit > 0.0 {
                let column = column * (100.0 * scale / unit);
                covariance += &column * column.transpose();
            }
        }
        match covariance.cholesky() {
            Some(root) => 0.5 * difference.dot(&root.solve(&difference)),
            None => 0.0,
        }
    }

    /// Covariance of the parameters of a carried story, SI: what is known by now, and of what is not the prior.
    fn covariance(&self, story: &Story, carried: &Carried) -> DMatrix<f64> {
        let parameters: Vec<f64> = carried
            .story
            .iter()
            .flat_map(|chosen| &self.world.candidates[chosen.candidate].parameters)
            .map(|parameter| parameter.size)
            .collect();
        DMatrix::from_fn(parameters.len(), parameters.len(), |i, j| {
            match (carried.known[i], carried.known[j]) {
                (Some(a), Some(b)) => story.covariance[(a, b)],
                (None, None) if i == j => parameters[i] * parameters[i],
                _ => 0.0,
            }
        })
    }

    /// ∂change/∂parameter of the new data, SI.
    fn sensitivities(&self, story: &[Chosen]) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(self.rows.len(), 0);
        for (position, chosen) in story.iter().enumerate() {
            let columns = self.world.columns(story, position).select_rows(&self.rows);
            let parameters = &self.world.candidates[chosen.candidate].parameters;
            for (column, parameter) in columns.column_iter().zip(parameters) {
                let at = all.ncols();
                all = all.insert_column(at, 0.0);
                all.set_column(at, &(column / parameter.size));
            }
        }
        all
    }
}
