//! The measurement that would separate a finding from its rivals.
//!
//! Two hypotheses predict new readings η₁ and η₂, each with the uncertainty that its parameters
//! have by now. New readings of noise σ separate them by the expected ln of the odds
//!
//! ½·dᵀ·(σ²(1 + ρJ) + S₁Σ₁S₁ᵀ + S₂Σ₂S₂ᵀ)⁻¹·d,   d = η₁ − η₂
//!
//! with S the sensitivities and Σ the covariances of the parameters. Of the feasible measurements
//! the one is proposed that leaves least of the rivals (`experiment_design.rs`).

use nalgebra::{DMatrix, DVector};

use super::feasible::{Measurement, feasible};
use crate::diagnosis::rig::model::transfer::Transferred;
use crate::diagnosis::rig::model::wanted::Wanted;
use crate::diagnosis::rig::model::{Body, RigModel};
use crate::error::Result;
use crate::inference::{
    Candidate, Diagnosis, Evidence, ExperimentDesign, Finding, ForwardModel, Hypothesis, Plan, Proposal,
    Rival, Term, separates,
};

/// Effects that a measurement has to separate the finding from, and their places: the likeliest
/// ones.
const MOST_RIVALS: usize = 6;
const MOST_PLACES: usize = 10;

/// The feasible measurement that best separates `finding` from its rivals; `None` where it has
/// none, or where no measurement separates it from any of them.
pub fn next_measurement(
    model: &RigModel,
    evidence: &Evidence,
    diagnosis: &Diagnosis,
    finding: &Finding,
) -> Result<Option<Proposal>> {
    let rivals = apart(finding);
    if rivals.is_empty() {
        return Ok(None);
    }
    let noise = diagnosis.hypothesis.sigma.max(evidence.resolution / 12.0f64.sqrt());
    let odds: Vec<f64> = rivals.iter().map(|rival| rival.odds).collect();
    let mut design = ExperimentDesign::default();
    let hypotheses = rivals.iter().map(|rival| &rival.hypothesis).chain([&diagnosis.hypothesis]);
    let involved: Vec<&Candidate> = hypotheses
        .flat_map(|hypothesis| &hypothesis.terms)
        .map(|term| &model.candidates[term.candidate])
        .collect();
    for measurement in feasible(model.readings(), model.rod()) {
        let Some(future) = Future::new(&measurement, model, &involved)? else { continue };
        let apart = |rival: &&Rival| {
            let (own, other) = (&diagnosis.hypothesis, &rival.hypothesis);
            future.log_odds(model, own, other, noise, diagnosis.shared_ratio)
        };
        let separations: Vec<f64> = rivals.iter().map(apart).collect();
        design.offer(measurement, separations, &odds);
    }
    Ok(design.best().map(|(measurement, separations)| {
        let separated = || rivals.iter().zip(&separations).filter(|(_, apart)| separates(**apart));
        Proposal {
            description: measurement.description(),
            plan: Some(Plan::Loads(measurement.plan)),
            log_odds: separated().map(|(_, apart)| *apart).fold(f64::INFINITY, f64::min),
            separates_from: separated().map(|(rival, _)| (rival.effect, rival.location.clone())).collect(),
        }
    }))
}

/// The rivals to be separated: the likeliest of every other effect, with the other places where it
/// may sit, and what has no name; without any, those of the same effect at the farthest places.
fn apart(finding: &Finding) -> Vec<&Rival> {
    let mut apart: Vec<&Rival> = Vec::new();
    for rival in &finding.rivals {
        let is_new = apart.iter().all(|known| known.effect != rival.effect);
        if rival.effect != finding.effect && is_new && apart.len() < MOST_RIVALS {
            apart.push(rival);
        }
    }
    apart.extend(&finding.unnamed);
    let is_rival = |rival: &&Rival| apart.iter().any(|known| known.effect == rival.effect);
    let is_other = |rival: &&Rival| apart.iter().all(|known| known.term != rival.term);
    let places: Vec<&Rival> =
        finding.rivals.iter().filter(is_rival).filter(is_other).take(MOST_PLACES - MOST_RIVALS).collect();
    apart.extend(places);
    if apart.is_empty() {
        let mut places: Vec<&Rival> = finding.rivals.iter().collect();
        // what is no candidate stands behind all that are
        let number = |rival: &&Rival| rival.term.as_ref().map(|term| term.candidate);
        places.sort_by_key(|rival| (number(rival).is_none(), number(rival)));
        apart.extend(places.first().copied());
        apart.extend(places.last().copied().filter(|_| places.len() > 1));
    }
    apart
}

/// Readings that might be made, as a model of their own.
struct Future {
    model: RigModel,
    /// The data that are new.
    rows: Vec<usize>,
    shared: Vec<usize>,
    nuisance: DMatrix<f64>,
}

impl Future {
    /// `None` where the measurement is none for this model.
    fn new(measurement: &Measurement, present: &RigModel, involved: &[&Candidate]) -> Result<Option<Future>> {
        let (model, evidence, _) = RigModel::with_effects(
            &measurement.readings,
            present.rod(),
            &Wanted::LikeAnd(involved, &present.own),
        )?;
        let rows: Vec<usize> =
            (0..model.data.len()).filter(|&i| model.data[i].row > measurement.known_rows).collect();
        let is_none = rows.is_empty()
            || matches!((&present.body, &model.body), (Body::Lines(a), Body::Lines(b)) if a != b);
        Ok((!is_none).then(|| Future {
            shared: rows.iter().map(|&row| evidence.shared[row]).collect(),
            nuisance: evidence.nuisance.select_rows(&rows),
            model,
            rows,
        }))
    }

    fn log_odds(
        &self,
        present: &RigModel,
        a: &Hypothesis,
        b: &Hypothesis,
        noise: f64,
        shared_ratio: f64,
    ) -> f64 {
        let n = self.rows.len();
        let mut covariance = DMatrix::from_fn(n, n, |i, j| {
            let shared = if self.shared[i] == self.shared[j] { shared_ratio } else { 0.0 };
            noise * noise * (shared + f64::from(u8::from(i == j)))
        });
        let mut difference = DVector::zeros(n);
        for (hypothesis, sign) in [(a, 1.0), (b, -1.0)] {
            let transferred = self.model.transferred(present, &hypothesis.terms);
            difference += self.model.response(&transferred.terms).select_rows(&self.rows) * sign;
            let columns = self.sensitivities(&transferred.terms);
            covariance += &columns * self.covariance(hypothesis, &transferred) * columns.transpose();
        }
        // what the base model absorbs by itself separates nothing
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

    /// Covariance of the parameters of a transferred hypothesis, SI: what is known by now, and of
    /// what is not the prior.
    fn covariance(&self, hypothesis: &Hypothesis, transferred: &Transferred) -> DMatrix<f64> {
        let parameters: Vec<f64> = transferred
            .terms
            .iter()
            .flat_map(|term| &self.model.candidates[term.candidate].parameters)
            .map(|parameter| parameter.size)
            .collect();
        DMatrix::from_fn(parameters.len(), parameters.len(), |i, j| {
            match (transferred.known[i], transferred.known[j]) {
                (Some(a), Some(b)) => hypothesis.covariance[(a, b)],
                (None, None) if i == j => parameters[i] * parameters[i],
                _ => 0.0,
            }
        })
    }

    /// ∂change/∂parameter of the new data, SI.
    fn sensitivities(&self, terms: &[Term]) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(self.rows.len(), 0);
        for (position, term) in terms.iter().enumerate() {
            let columns = self.model.columns(terms, position).select_rows(&self.rows);
            let parameters = &self.model.candidates[term.candidate].parameters;
            for (column, parameter) in columns.column_iter().zip(parameters) {
                let at = all.ncols();
                all = all.insert_column(at, 0.0);
                all.set_column(at, &(column / parameter.size));
            }
        }
        all
    }
}
