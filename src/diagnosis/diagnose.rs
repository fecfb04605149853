//! The diagnosis: is there a mismatch, what is it, what could it be as well, and what remains.

use nalgebra::DVector;

use super::linear::Linearised;
use super::proof::{Proof, prove};
use super::selection::{Search, Story};
use super::{Evidence, World};
use crate::statistics::chi_squared_survival;

/// Odds within which another explanation counts as indistinguishable: 20 to 1.
const APART: f64 = 20.0;
/// Half width of a 95 % interval in standard deviations.
const INTERVAL: f64 = 1.96;

/// What a recording says about the physics that its model left out.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The effects that were adopted, strongest first.
    pub findings: Vec<Finding>,
    /// What is structured and unexplained.
    pub unexplained: Option<Unexplained>,
    /// Noise of a datum under the story.
    pub noise: f64,
    /// Variance of the errors that data share, over that of their own.
    pub shared_ratio: f64,
    /// Root mean square of what the base model leaves.
    pub rms_before: f64,
    /// And of what the story leaves.
    pub rms_after: f64,
    /// Held-out errors, where the recording has folds.
    pub proof: Option<Proof>,
    /// The story, for whoever draws it.
    pub story: Story,
}

/// An effect that was adopted.
#[derive(Debug, Clone)]
pub struct Finding {
    /// Index among the world's candidates.
    pub candidate: usize,
    /// Value and 95 % interval of each parameter, SI.
    pub parameters: Vec<(f64, f64, f64)>,
    /// Probability that noise alone fits as much better.
    pub p_value: f64,
    /// Root mean square of what it explains.
    pub rms: f64,
    /// Candidates of other effects that explain it as well, the likeliest first.
    pub indistinguishable: Vec<usize>,
    /// Candidates of the same effect at other places that do.
    pub places: Vec<usize>,
}

/// A structured remainder that no effect of the library explains.
#[derive(Debug, Clone)]
pub struct Unexplained {
    /// Index of the curve among the world's candidates.
    pub candidate: usize,
    /// Root mean square of what it describes.
    pub rms: f64,
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
    let (search, story, unknown) = Search::settled(world, evidence);
    let none = search.fit(&[]);
    let change = world.change(&story.chosen);
    let before = &evidence.residual - search.told(&none, evidence, &DVector::zeros(change.len()));
    let after = &evidence.residual - search.told(&story, evidence, &change);
    let mut findings: Vec<Finding> =
        (0..story.chosen.len()).map(|position| finding(world, evidence, &search, &story, position)).collect();
    findings.sort_by(|a, b| b.rms.total_cmp(&a.rms));
    let unexplained = unknown.and_then(|longer| {
        let curve = longer.chosen.last()?.candidate;
        let rms = rms(&(world.change(&longer.chosen) - &change));
        Some(Unexplained { candidate: curve, rms })
    });
    Diagnosis {
        findings,
        unexplained,
        noise: story.sigma,
        shared_ratio: search.shared_ratio(),
        rms_before: rms(&before),
        rms_after: rms(&after),
        proof: prove(world, evidence),
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
    let parameters = chosen
        .values
        .iter()
        .enumerate()
        .map(|(k, &value)| {
            let half = INTERVAL * story.covariance[(first + k, first + k)].sqrt();
            let (low, high) = candidates[chosen.candidate].parameters[k].bounds;
            (value, (value - half).max(low), (value + half).min(high))
        })
        .collect();
    // candidates that would do in its place
    let additions = search.additions(&rest);
    let least = story.log_probability - rest.log_probability - 2.0 * APART.ln();
    let mut others: Vec<(usize, f64)> = (0..additions.len())
        .filter(|&index| {
            index != chosen.candidate && !candidates[index].is_unknown && additions[index] > least
        })
        .map(|index| (index, search.with(&rest, index).log_probability))
        .filter(|(_, log_probability)| *log_probability > story.log_probability - APART.ln())
        .collect();
    others.sort_by(|a, b| b.1.total_cmp(&a.1));
    let same = |index: &usize| candidates[*index].effect == candidates[chosen.candidate].effect;
    let (places, indistinguishable): (Vec<usize>, Vec<usize>) =
        others.into_iter().map(|(index, _)| index).partition(same);
    let without = &evidence.residual - world.change(&rest.chosen);
    let with = &evidence.residual - world.change(&story.chosen);
    let gained = (search.length(&without).powi(2) - search.length(&with).powi(2)) / story.sigma.powi(2);
    Finding {
        candidate: chosen.candidate,
        parameters,
        p_value: chi_squared_survival(gained.max(0.0), chosen.values.len() as f64).unwrap_or(1.0),
        rms: rms(&world.change(std::slice::from_ref(chosen))),
        indistinguishable,
        places,
    }
}

fn rms(v: &DVector<f64>) -> f64 {
    v.norm() / (v.len().max(1) as f64).sqrt()
}
