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

pub mod feasible_poses;
pub mod unfollowed;

use self::feasible_poses::{FeasiblePoses, feasible};
use self::unfollowed::Unfollowed;
use super::effects::registry;
use super::evidence;
use super::model::{CalibrationModel, Context, LinearTerms};
use crate::error::Result;
use crate::inference::{
    Candidate, Diagnosis, Effect, Evidence, ExperimentDesign, Finding, Location, Plan, Proposal, Rival, Term,
    separates,
};
use crate::parallel::in_parallel;

/// Rivals that poses have to separate the finding from: the likeliest ones.
const MOST_RIVALS: usize = 3;

/// For each finding what best separates it from its rivals; `None` where it has none, or where no
/// feasible poses can.
///
/// # Errors
/// As [`Context::new`].
pub(super) fn next_measurements(
    model: &CalibrationModel,
    context: &Context,
    present: &Evidence,
    diagnosis: &Diagnosis,
) -> Result<Vec<Option<Proposal>>> {
    let own = Named::new(&model.terms, &diagnosis.hypothesis.terms);
    let mut next: Vec<Option<Proposal>> = Vec::new();
    let mut questions = Vec::new();
    for finding in &diagnosis.findings {
        let rivals = apart(finding);
        if rivals.is_empty() {
            next.push(None);
            continue;
        }
        let check = finding.direct_check(&rivals);
        if check.is_none() {
            let named = |rival: &&Rival| Named::new(&model.terms, &rival.hypothesis.terms);
            let others = rivals.iter().map(named).collect();
            questions.push(Question { finding: next.len(), rivals, others });
        }
        next.push(check);
    }
    let hypotheses: Vec<&Named> =
        std::iter::once(&own).chain(questions.iter().flat_map(|q| &q.others)).collect();
    let variance = diagnosis.hypothesis.sigma.powi(2);
    let separations = |terms: &LinearTerms, evidence: &Evidence| {
        let evidence = evidence::unknown_beforehand(evidence);
        let found = hypotheses.iter().filter_map(|hypothesis| hypothesis.found_in(terms)).flatten();
        let unfollowed = Unfollowed::new(terms, &evidence, found.map(|term| term.candidate));
        separations(&unfollowed, &own, &questions, variance)
    };
    if questions.is_empty() {
        return Ok(next);
    }
    let Some(now) = separations(&model.terms, present) else { return Ok(next) };
    let moved_after: Vec<usize> = hypotheses.iter().flat_map(|hypothesis| hypothesis.moved_after()).collect();
    let (campaign, calibration) = (model.campaign, &model.calibration);
    let plans = feasible(campaign, &context.configurations);
    let measured = in_parallel(plans.len(), |k| -> Result<_> {
        let (campaign, calibration) = plans[k].measured(campaign, calibration);
        let context = Context::new(&campaign, &calibration)?.moved_after(&moved_after);
        let evidence = evidence::evidence_of(&campaign, &calibration, &context);
        let (mut entries, _) = registry::candidates(&context);
        entries.retain(|entry| hypotheses.iter().any(|hypothesis| hypothesis.holds(&entry.candidate)));
        let (terms, _) = LinearTerms::new(entries, &evidence);
        Ok(separations(&terms, &evidence))
    });
    let mut designs: Vec<ExperimentDesign<&FeasiblePoses>> = Vec::new();
    designs.resize_with(questions.len(), ExperimentDesign::default);
    for (poses, then) in plans.iter().zip(measured) {
        let Some(then) = then? else { continue };
        for (k, question) in questions.iter().enumerate() {
            let gained = |(then, now): (&Option<f64>, &Option<f64>)| match (then, now) {
                (Some(then), Some(now)) => then - now,
                // other poses have no place for this rival: nothing is known
                _ => 0.0,
            };
            let odds: Vec<f64> = question.rivals.iter().map(|rival| rival.odds).collect();
            designs[k].offer(poses, then[k].iter().zip(&now[k]).map(gained).collect(), &odds);
        }
    }
    for (question, design) in questions.iter().zip(designs) {
        let best = design.best();
        next[question.finding] =
            best.map(|(poses, gained)| proposal(poses.clone(), &gained, &question.rivals));
    }
    Ok(next)
}

/// A finding, by its number, that poses have to separate from its rivals.
struct Question<'a> {
    finding: usize,
    rivals: Vec<&'a Rival>,
    others: Vec<Named>,
}

/// The expected ln of the odds of every question between the finding and each of its rivals; `None`
/// where these poses have no place for the findings, or for one rival.
fn separations(
    unfollowed: &Unfollowed,
    own: &Named,
    questions: &[Question],
    variance: f64,
) -> Option<Vec<Vec<Option<f64>>>> {
    let own = own.found_in(unfollowed.terms)?;
    let apart = |other: &Named| {
        let other = other.found_in(unfollowed.terms)?;
        let less = unfollowed.of(&own, &other).min(unfollowed.of(&other, &own));
        Some(less / (2.0 * variance))
    };
    Some(questions.iter().map(|question| question.others.iter().map(apart).collect()).collect())
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
    let FeasiblePoses { instruction, plan } = poses;
    Proposal {
        description: instruction,
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
