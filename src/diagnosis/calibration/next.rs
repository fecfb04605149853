//! The measurement that would separate a finding from its rivals.
//!
//! With poses added to those of the campaign, hypothesis A predicts ηA of all of them. What
//! hypothesis B, fitted to that together with all that the calibration absorbs, cannot follow is
//! left: M_B·ηA. The ln of the odds between the two is then expected to be
//!
//! ½·‖M_B·ηA‖²/σ²
//!
//! of which what the recorded poses make already is not counted, and of which the less counts of
//! both ways round. Of all feasible poses those are proposed that leave least of the rivals
//! ([`ExperimentDesign`]). What can be weighed or gauged needs no poses.

use nalgebra::DMatrix;

use super::context::Context;
use super::effects::registry;
use super::evidence;
use super::feasible_poses::{FeasiblePoses, feasible};
use super::linear_terms::LinearTerms;
use super::model::CalibrationModel;
use crate::error::Result;
use crate::inference::{
    Candidate, Diagnosis, Effect, Evidence, ExperimentDesign, Finding, Location, Plan, Proposal, Rival, Term,
    Whitening, separates,
};

/// Rivals that poses have to separate the finding from: the likeliest ones.
const MOST_RIVALS: usize = 3;

/// The poses that best separate `finding` from its rivals; `None` where it has none, or where no
/// feasible poses can.
pub(super) fn next_poses(
    model: &CalibrationModel,
    context: &Context,
    present: &Evidence,
    diagnosis: &Diagnosis,
    finding: &Finding,
) -> Result<Option<Proposal>> {
    let rivals = apart(finding);
    if rivals.is_empty() {
        return Ok(None);
    }
    if let Some(check) = finding.direct_check(&rivals) {
        return Ok(Some(check));
    }
    let (campaign, calibration) = (model.campaign, &model.calibration);
    let own = Named::new(&model.terms, &diagnosis.hypothesis.terms);
    let named = |rival: &&Rival| Named::new(&model.terms, &rival.hypothesis.terms);
    let others: Vec<Named> = rivals.iter().map(named).collect();
    let variance = diagnosis.hypothesis.sigma.powi(2);
    let distances = |terms: &LinearTerms, evidence: &Evidence| -> Option<Vec<Option<f64>>> {
        let own = own.found_in(terms)?;
        let apart = |other: &Named| {
            let other = other.found_in(terms)?;
            let one_way = unfollowed(terms, evidence, &own, &other);
            let other_way = unfollowed(terms, evidence, &other, &own);
            Some(one_way.min(other_way) / (2.0 * variance))
        };
        Some(others.iter().map(apart).collect())
    };
    let present = &evidence::unknown_beforehand(present);
    let Some(now) = distances(&model.terms, present) else { return Ok(None) };
    let odds: Vec<f64> = rivals.iter().map(|rival| rival.odds).collect();
    let mut design = ExperimentDesign::default();
    let hypotheses: Vec<&Named> = std::iter::once(&own).chain(&others).collect();
    let moved_after: Vec<usize> = hypotheses.iter().flat_map(|hypothesis| hypothesis.moved_after()).collect();
    for poses in feasible(campaign, &context.configurations) {
        let (campaign, calibration) = poses.measured(campaign, calibration);
        let context = Context::new(&campaign, &calibration)?.moved_after(&moved_after);
        let evidence = evidence::evidence_of(&campaign, &calibration, &context);
        let evidence = evidence::unknown_beforehand(&evidence);
        let (mut entries, _) = registry::candidates(&context);
        entries.retain(|entry| hypotheses.iter().any(|hypothesis| hypothesis.holds(&entry.candidate)));
        let (terms, _) = LinearTerms::new(entries, &evidence);
        let Some(then) = distances(&terms, &evidence) else { continue };
        let gained = |(then, now): (&Option<f64>, &Option<f64>)| match (then, now) {
            (Some(then), Some(now)) => then - now,
            // other poses have no place for this rival: nothing is known
            _ => 0.0,
        };
        design.offer(poses, then.iter().zip(&now).map(gained).collect(), &odds);
    }
    Ok(design.best().map(|(poses, gained)| proposal(poses, &gained, &rivals)))
}

/// The likeliest rivals that are called something else than the finding.
fn apart(finding: &Finding) -> Vec<&Rival> {
    let is_other =
        |rival: &&Rival| rival.effect != finding.effect || rival.location.place() != finding.location;
    finding.rivals.iter().filter(is_other).take(MOST_RIVALS).collect()
}

/// Poses to measure, by what they gain against each rival.
fn proposal(poses: FeasiblePoses, gained: &[f64], rivals: &[&Rival]) -> Proposal {
    let separated = || gained.iter().zip(rivals).filter(|(gained, _)| separates(**gained));
    let FeasiblePoses { words, plan } = poses;
    Proposal {
        words,
        plan: Some(Plan::Poses(plan)),
        log_odds: separated().map(|(gained, _)| *gained).fold(f64::INFINITY, f64::min),
        separates_from: separated().map(|(_, rival)| place(rival)).collect(),
    }
}

fn place(rival: &Rival) -> (&'static Effect, Location) {
    (rival.effect, rival.location.place())
}

/// A hypothesis whose effects are known by name and place, so that they are found among other
/// candidates.
struct Named(Vec<(&'static Effect, Location, Vec<f64>)>);

impl Named {
    fn new(model: &LinearTerms, hypothesis: &[Term]) -> Self {
        let named = |term: &Term| {
            let candidate = &model.candidates[term.candidate];
            (candidate.effect, candidate.location.clone(), term.values.clone())
        };
        Named(hypothesis.iter().map(named).collect())
    }

    /// Rows, from 0, after which something moved.
    fn moved_after(&self) -> impl Iterator<Item = usize> {
        self.0.iter().filter_map(|(_, location, _)| location.moved_after())
    }

    /// `None` where one of them is not there, or has other parameters.
    fn found_in(&self, model: &LinearTerms) -> Option<Vec<Term>> {
        let term = |(effect, location, values): &(&'static Effect, Location, Vec<f64>)| {
            let is_it = |c: &Candidate| {
                c.effect == *effect && c.location == *location && c.parameters.len() == values.len()
            };
            let candidate = model.candidates.iter().position(is_it)?;
            Some(Term { candidate, values: values.clone() })
        };
        self.0.iter().map(term).collect()
    }

    fn holds(&self, candidate: &Candidate) -> bool {
        let is_it = |(effect, location, _): &(&'static Effect, Location, Vec<f64>)| {
            *effect == candidate.effect && *location == candidate.location
        };
        self.0.iter().any(is_it)
    }
}

/// ‖M_B·ηA‖², m².
fn unfollowed(model: &LinearTerms, evidence: &Evidence, a: &[Term], b: &[Term]) -> f64 {
    let own: Vec<DMatrix<f64>> = b.iter().map(|term| model.columns(term.candidate)).collect();
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
    whitening.apply(&model.response(a)).norm_squared()
}
