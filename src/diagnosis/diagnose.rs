//! The diagnosis: is there a mismatch, what is it, what could it be as well, and what remains.

use nalgebra::DVector;

use super::judgement::judged;
use super::lack_of_fit::LackOfFit;
use super::linear::Linearised;
use super::locate::{Structure, locate};
use super::proof::{Proof, prove};
use super::replication::{Replica, replicate};
use super::search::{Search, Story};
use super::selection::Remainder;
use super::{Chosen, EffectParameter, Evidence, World};
use crate::parallel::both;
use crate::statistics::{chi_squared_survival, student_t_quantile};

/// Odds within which another explanation counts as indistinguishable: 20 to 1.
const APART: f64 = 20.0;

/// A form of a law that leaves at most so much more, as a factor, may be the right one.
const HARDLY_MORE: f64 = 1.1;

/// What a recording says about the physics that its model left out.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The effects that were adopted, strongest first.
    pub findings: Vec<Finding>,
    /// What is structured and unexplained.
    pub unexplained: Option<Unexplained>,
    /// Noise of a datum, with what it shares with others: the standard deviation of what is left of the data once the story,
    /// and what is unexplained, are taken out.
    pub noise: f64,
    /// Variance of the errors that data share, over that of their own.
    pub shared_ratio: f64,
    /// What the base model leaves, once it has absorbed what it can.
    pub before: DVector<f64>,
    /// And what the story leaves.
    pub after: DVector<f64>,
    /// Does the base model leave the averages of the repeats? `None` without repeats.
    pub lack_of_fit_before: Option<LackOfFit>,
    /// Does the story?
    pub lack_of_fit_after: Option<LackOfFit>,
    /// Structure of `before` along each covariate of the evidence.
    pub structure_before: Vec<Structure>,
    /// And of `after`.
    pub structure_after: Vec<Structure>,
    /// Every candidate alone against none: ln of the odds, prior included.
    pub odds: Vec<f64>,
    /// Held-out errors, where the recording has folds.
    pub proof: Option<Proof>,
    /// What is found in the other sessions, on each session; nothing where nothing was found or there is one session only.
    pub replicas: Vec<Replica>,
    /// The story.
    pub story: Story,
}

/// An effect that was adopted.
#[derive(Debug, Clone)]
pub struct Finding {
    /// The effect with its values.
    pub chosen: Chosen,
    /// Where it is.
    pub place: String,
    /// Value and 95 % interval of each parameter, SI.
    pub parameters: Vec<(f64, f64, f64)>,
    /// Its first parameter among those of the story: where it stands in the story's covariance.
    pub first: usize,
    /// Half of a 95 % interval in standard deviations.
    pub reach: f64,
    /// Probability that noise alone fits as much better.
    pub p_value: f64,
    /// Root mean square of what it explains.
    pub rms: f64,
    /// What explains it as well, likeliest first.
    pub rivals: Vec<Rival>,
}

/// An effect that may stand in the place of a finding.
#[derive(Debug, Clone)]
pub struct Rival {
    /// The effect with its values.
    pub chosen: Chosen,
    /// Where it is.
    pub place: String,
    /// The whole story with it instead, its effect last.
    pub story: Story,
    /// How much less probable that story is: odds, 1 for as probable.
    pub odds: f64,
}

/// A structured remainder that no effect of the library explains.
#[derive(Debug, Clone)]
pub struct Unexplained {
    /// Index of the curve among the world's candidates; `None` where only the averages of repeats show that something is left.
    pub candidate: Option<usize>,
    /// Root mean square of what the curve describes, or of what is left.
    pub rms: f64,
    /// What the curve says; what is left where there is none.
    pub shape: DVector<f64>,
}

impl Diagnosis {
    /// True where something is left out of the model.
    pub fn is_mismatch(&self) -> bool {
        !self.findings.is_empty() || self.unexplained.is_some()
    }
}

/// Diagnoses a recording.
pub fn diagnose(world: &dyn World, evidence: &Evidence) -> Diagnosis {
    let world = &Linearised::new(world);
    let ((search, story, unknown), proof) = both(|| judged(world, evidence), || prove(world, evidence));
    let none = search.fit(&[]);
    let told_by_none = search.told(&none, evidence, &DVector::zeros(evidence.residual.len()));
    let change = world.change(&story.chosen);
    let told = search.told(&story, evidence, &change);
    let (before, after) = (&evidence.residual - &told_by_none, &evidence.residual - &told);
    let mut findings: Vec<Finding> =
        (0..story.chosen.len()).map(|position| finding(world, evidence, &search, &story, position)).collect();
    findings.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    let lack_of_fit_after = search.lack_of_fit(&story, &told);
    let (mut left, mut determined) = (after.clone(), story.determined);
    let mut unexplained = None;
    if let Some(Remainder::Curve(longer)) = unknown {
        left = &evidence.residual - search.told(&longer, evidence, &world.change(&longer.chosen));
        determined = longer.determined;
        // what the calibration would take up of the curve is not left
        let shape = &after - &left;
        let candidate = longer.chosen.last().map(|curve| curve.candidate);
        unexplained = Some(Unexplained { candidate, rms: rms(&shape), shape });
    } else if let Some(Remainder::Cells) = unknown {
        unexplained = Some(Unexplained { candidate: None, rms: rms(&after), shape: after.clone() });
    }
    let freedom = (search.degrees_of_freedom() as f64 - determined).max(1.0);
    Diagnosis {
        findings,
        unexplained,
        noise: left.norm() / freedom.sqrt(),
        shared_ratio: search.shared_ratio(),
        lack_of_fit_before: search.lack_of_fit(&none, &told_by_none),
        lack_of_fit_after,
        structure_before: locate(evidence, &before),
        structure_after: locate(evidence, &after),
        odds: search.additions(&none),
        proof,
        replicas: if story.chosen.is_empty() { Vec::new() } else { replicate(world, evidence) },
        before,
        after,
        story,
    }
}

fn finding(
    world: &Linearised<'_>,
    evidence: &Evidence,
    search: &Search,
    story: &Story,
    position: usize,
) -> Finding {
    let chosen = &story.chosen[position];
    let candidates = world.candidates();
    let rest = search.without(story, position);
    let first: usize = story.chosen[..position].iter().map(|c| c.values.len()).sum();
    let freedom = (search.degrees_of_freedom() as f64 - story.determined).max(1.0);
    let reach = student_t_quantile(0.975, freedom).unwrap_or(1.96);
    let mut parameters = intervals(world, story, chosen, first, reach);
    // which form of a law is the right one is not known where another one leaves hardly more
    for form in search.other_forms(chosen.candidate) {
        let other = search.with(&rest, form);
        if search.left_rms(&other) > HARDLY_MORE * search.left_rms(story) {
            continue;
        }
        let Some(own) = other.chosen.last() else { continue };
        let at = other.covariance.nrows() - own.values.len();
        for (known, other) in parameters.iter_mut().zip(intervals(world, &other, own, at, reach)) {
            (known.1, known.2) = (known.1.min(other.1), known.2.max(other.2));
        }
    }
    // candidates that would do in its place
    let additions = search.additions(&rest);
    // by the same measure as what was found: without it, what else the story holds is less certain than with it
    let gained = (story.log_probability - rest.log_probability).min(additions[chosen.candidate]);
    let least = gained - 2.0 * APART.ln();
    let mut rivals: Vec<Rival> = (0..additions.len())
        .filter(|&index| {
            index != chosen.candidate && !candidates[index].is_unknown && additions[index] > least
        })
        .filter_map(|index| {
            let other = search.with(&rest, index);
            let odds = (story.log_probability - other.log_probability).exp();
            let own = other.chosen.last()?.clone();
            Some(Rival { place: world.place(&own), chosen: own, story: other, odds })
        })
        .filter(|rival| rival.odds < APART)
        .collect();
    rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
    let without = &evidence.residual - world.change(&rest.chosen);
    let with = &evidence.residual - world.change(&story.chosen);
    let gained = (search.length(&without).powi(2) - search.length(&with).powi(2)) / story.sigma.powi(2);
    // a curve has more parameters than the data determine of it
    let own_freedom = (story.determined - rest.determined).clamp(1.0, chosen.values.len().max(1) as f64);
    Finding {
        chosen: chosen.clone(),
        place: world.place(chosen),
        parameters,
        first,
        reach,
        p_value: chi_squared_survival(gained.max(0.0), own_freedom).unwrap_or(1.0),
        rms: rms(&world.change(std::slice::from_ref(chosen))),
        rivals,
    }
}

/// Value and 95 % interval of the parameters of an effect, which begin at `first` in the covariance of its story.
fn intervals(
    world: &Linearised<'_>,
    story: &Story,
    chosen: &Chosen,
    first: usize,
    reach: f64,
) -> Vec<(f64, f64, f64)> {
    let parameters = &world.candidates()[chosen.candidate].parameters;
    let of = |(k, (&value, parameter)): (usize, (&f64, &EffectParameter))| {
        let half = reach * story.covariance[(first + k, first + k)].max(0.0).sqrt();
        let (low, high) = parameter.bounds;
        (value, (value - half).max(low), (value + half).min(high))
    };
    chosen.values.iter().zip(parameters).enumerate().map(of).collect()
}

/// Root mean square.
pub fn rms(v: &DVector<f64>) -> f64 {
    v.norm() / (v.len().max(1) as f64).sqrt()
}
