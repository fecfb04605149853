//! Which story a recording tells: effects are added, exchanged and taken away while that makes it more probable.
//!
//! A story is a few candidates that act together. Its probability is that of the recording ([`super::score()`]) times its
//! prior: before the data half of all recordings hold nothing, the library shares 0.4, physics that nobody has named 0.1.
//! Within the library every effect has the same share, and within an effect every place, so that a scan over a hundred
//! places finds nothing a hundred times as often as a single place does.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::score::{Score, score};
use super::whitening::Whitening;
use super::{Candidate, Chosen, Evidence, World};

/// Prior probability that the next effect is none, one of the library, or one that nobody has named.
const PRIOR: (f64, f64, f64) = (0.5, 0.4, 0.1);
/// Odds against chance from which on an effect is named.
const NAMED: f64 = 20.0;
/// Most effects in one story.
const MOST: usize = 4;
/// Step of a derivative, relative to the size of a parameter.
const STEP: f64 = 1e-4;
/// Gauss–Newton steps to the values of a story.
const STEPS: usize = 8;

/// A story with what the recording says about it.
#[derive(Debug, Clone)]
pub struct Story {
    /// The effects, strongest first.
    pub chosen: Vec<Chosen>,
    /// Ln of its probability, prior included, less a constant.
    pub log_probability: f64,
    /// Noise of a datum under it.
    pub sigma: f64,
    /// Posterior covariance of all its parameters, SI, in the order of `chosen`.
    pub covariance: DMatrix<f64>,
}

/// Looks for the most probable story.
pub struct Search<'a> {
    world: &'a dyn World,
    evidence: &'a Evidence,
    whitening: Whitening,
    /// Ln of the prior of each candidate over that of none.
    prior: Vec<f64>,
}

impl<'a> Search<'a> {
    /// On an evidence, with the scatter of what `told` leaves.
    pub fn new(world: &'a dyn World, evidence: &'a Evidence, told: &[Chosen]) -> Self {
        let left = &evidence.residual - world.change(told);
        Search {
            world,
            evidence,
            whitening: Whitening::new(evidence, &left),
            prior: priors(world.candidates()),
        }
    }

    /// Fits the values of `chosen` together, by Gauss–Newton steps from where they are, and scores them.
    pub fn fit(&self, chosen: &[Chosen]) -> Story {
        let mut chosen = chosen.to_vec();
        let mut scored = self.scored(&chosen);
        for _ in 0..STEPS {
            let before = flat(&chosen);
            self.put(&mut chosen, &scored.estimate);
            let moved = flat(&chosen) - before;
            scored = self.scored(&chosen);
            if moved.component_div(&self.sizes(&chosen)).amax() < 1e-6 {
                break;
            }
        }
        let prior: f64 = chosen.iter().map(|c| self.prior[c.candidate]).sum();
        let sizes = DMatrix::from_diagonal(&self.sizes(&chosen));
        Story {
            log_probability: scored.log_evidence + prior,
            sigma: scored.sigma,
            covariance: &sizes * &scored.covariance * &sizes,
            chosen,
        }
    }

    /// Ln of what adding each candidate to `story` does to its probability, linearised at the candidate's neutral values;
    /// −∞ for those that are in it already.
    pub fn additions(&self, story: &Story) -> Vec<f64> {
        let present = self.scored(&story.chosen).log_evidence;
        (0..self.world.candidates().len())
            .map(|index| {
                if story.chosen.iter().any(|chosen| chosen.candidate == index) {
                    return f64::NEG_INFINITY;
                }
                let mut chosen = story.chosen.clone();
                chosen.push(self.world.candidates()[index].neutral(index));
                self.scored(&chosen).log_evidence + self.prior[index] - present
            })
            .collect()
    }

    /// The most probable story of known effects, and the one that an unknown curve adds to it, if that is named rather
    /// than chance.
    ///
    /// Known effects are named only as far as they are likelier, by the odds of a name, than a shorter story with an
    /// unknown curve: several of them together can draw the shape of something that is none of them.
    pub fn best(&self) -> (Story, Option<Story>) {
        let mut path = vec![self.fit(&[])];
        loop {
            let story = &path[path.len() - 1];
            if story.chosen.len() >= MOST {
                break;
            }
            let Some(longer) = self.longer(story, false) else { break };
            if longer.log_probability < story.log_probability + NAMED.ln() {
                break;
            }
            let longer = self.exchanged(longer);
            path.push(longer);
        }
        let rivals: Vec<Option<Story>> = path.iter().map(|story| self.longer(story, true)).collect();
        let last = path.len() - 1;
        let shorter = rivals[..last]
            .iter()
            .enumerate()
            .filter_map(|(k, rival)| Some((k, rival.as_ref()?.log_probability)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        let named = match shorter {
            Some((k, rival)) if rival + NAMED.ln() > path[last].log_probability => k,
            _ => last,
        };
        let story = path.swap_remove(named);
        let unknown = rivals.into_iter().nth(named).flatten();
        let is_seen = |longer: &Story| longer.log_probability > story.log_probability + NAMED.ln();
        let unknown = unknown.filter(is_seen);
        (story, unknown)
    }

    /// The story with the likeliest candidate more, of those that are unknown or of those that are not.
    fn longer(&self, story: &Story, unknown: bool) -> Option<Story> {
        let additions = self.additions(story);
        (0..additions.len())
            .filter(|&index| self.world.candidates()[index].is_unknown == unknown)
            .filter(|&index| additions[index] > f64::NEG_INFINITY)
            .max_by(|&a, &b| additions[a].total_cmp(&additions[b]))
            .map(|index| self.with(story, index))
    }

    /// One candidate more.
    pub fn with(&self, story: &Story, index: usize) -> Story {
        let mut chosen = story.chosen.clone();
        chosen.push(self.world.candidates()[index].neutral(index));
        self.fit(&chosen)
    }

    /// One effect less.
    pub fn without(&self, story: &Story, position: usize) -> Story {
        let mut chosen = story.chosen.clone();
        chosen.remove(position);
        self.fit(&chosen)
    }

    /// Variance of the errors that data share, over that of their own.
    pub fn shared_ratio(&self) -> f64 {
        self.whitening.ratio
    }

    /// Length of a residual once shared errors and nuisance are taken out of it.
    pub fn length(&self, residual: &DVector<f64>) -> f64 {
        self.whitening.apply(residual).norm()
    }

    /// Single effects exchanged for others and taken away while the story gets more probable.
    fn exchanged(&self, mut story: Story) -> Story {
        for _ in 0..MOST {
            let mut better: Option<Story> = None;
            for position in 0..story.chosen.len() {
                let rest = self.without(&story, position);
                let additions = self.additions(&rest);
                let known = |&index: &usize| !self.world.candidates()[index].is_unknown;
                let best = (0..additions.len())
                    .filter(known)
                    .max_by(|&a, &b| additions[a].total_cmp(&additions[b]))
                    .map(|index| self.with(&rest, index));
                for other in [Some(rest), best].into_iter().flatten() {
                    let least = better.as_ref().map_or(story.log_probability + 1e-6, |b| b.log_probability);
                    if other.log_probability > least {
                        better = Some(other);
                    }
                }
            }
            match better {
                Some(other) => story = other,
                None => break,
            }
        }
        story
    }

    /// The score of a story, linearised where its values are; estimates are in sizes from the neutral values.
    fn scored(&self, chosen: &[Chosen]) -> Score {
        let columns = self.columns(chosen);
        let offsets = self.offsets(chosen);
        // recorded less told, plus what the columns tell of it: linear about the neutral values
        let left = &self.evidence.residual - self.world.change(chosen) + &columns * &offsets;
        let floor = self.evidence.resolution / 12.0f64.sqrt();
        score(
            &self.whitening.apply(&left),
            &self.whitening.apply_columns(&columns),
            self.whitening.degrees_of_freedom,
            floor,
        )
    }

    /// ∂change/∂parameter, by central differences, times the sizes: one column per parameter of the story.
    fn columns(&self, chosen: &[Chosen]) -> DMatrix<f64> {
        let n = self.evidence.residual.len();
        let mut columns = Vec::new();
        let mut story = chosen.to_vec();
        for position in 0..chosen.len() {
            let parameters = &self.world.candidates()[chosen[position].candidate].parameters;
            for (k, parameter) in parameters.iter().enumerate() {
                let (value, h) = (chosen[position].values[k], STEP * parameter.size);
                story[position].values[k] = value + h;
                let mut column = self.world.change(&story);
                story[position].values[k] = value - h;
                column -= self.world.change(&story);
                story[position].values[k] = value;
                columns.push(column * (parameter.size / (2.0 * h)));
            }
        }
        match columns.is_empty() {
            true => DMatrix::zeros(n, 0),
            false => DMatrix::from_columns(&columns),
        }
    }

    /// Values less neutral values, in sizes.
    fn offsets(&self, chosen: &[Chosen]) -> DVector<f64> {
        let of = |c: &Chosen| -> Vec<f64> {
            let parameters = &self.world.candidates()[c.candidate].parameters;
            parameters.iter().zip(&c.values).map(|(p, value)| (value - p.neutral) / p.size).collect()
        };
        DVector::from_vec(chosen.iter().flat_map(of).collect())
    }

    fn sizes(&self, chosen: &[Chosen]) -> DVector<f64> {
        let of = |c: &Chosen| -> Vec<f64> {
            self.world.candidates()[c.candidate].parameters.iter().map(|p| p.size).collect()
        };
        DVector::from_vec(chosen.iter().flat_map(of).collect())
    }

    /// Puts estimates, in sizes from the neutral values, into a story, within the physical bounds.
    fn put(&self, chosen: &mut [Chosen], estimate: &DVector<f64>) {
        let mut next = estimate.iter();
        for c in chosen {
            let parameters = &self.world.candidates()[c.candidate].parameters;
            for (parameter, value) in parameters.iter().zip(&mut c.values) {
                if let Some(offset) = next.next() {
                    let (low, high) = parameter.bounds;
                    *value = (parameter.neutral + offset * parameter.size).clamp(low, high);
                }
            }
        }
    }
}

fn flat(chosen: &[Chosen]) -> DVector<f64> {
    DVector::from_vec(chosen.iter().flat_map(|c| c.values.iter().copied()).collect())
}

/// Ln of each candidate's prior over that of none; see the top of the file.
fn priors(candidates: &[Candidate]) -> Vec<f64> {
    let (none, library, unknown) = PRIOR;
    let mut places: BTreeMap<(&str, bool), f64> = BTreeMap::new();
    for candidate in candidates {
        *places.entry((&candidate.effect, candidate.is_unknown)).or_default() += 1.0;
    }
    let effects =
        |wanted: bool| places.keys().filter(|(_, is_unknown)| *is_unknown == wanted).count().max(1) as f64;
    let (known, unnamed) = (effects(false), effects(true));
    candidates
        .iter()
        .map(|candidate| {
            let places = places[&(candidate.effect.as_str(), candidate.is_unknown)];
            let share = if candidate.is_unknown { unknown / unnamed } else { library / known };
            (share / places / none).ln()
        })
        .collect()
}
