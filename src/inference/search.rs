//! Hypotheses: fitted, scored, and asked what would make them more probable.
//!
//! A hypothesis is a few candidates that act together. Its probability is that of the recording
//! ([`crate::inference::score`]) times its prior ([`crate::inference::score::priors`]).

pub(in crate::inference) mod findings;
pub(in crate::inference) mod hidden_in_correlation;
pub(in crate::inference) mod hidden_in_groups;
pub(in crate::inference) mod hidden_in_noise;
pub(in crate::inference) mod misread;
pub(in crate::inference) mod pairs;
pub(in crate::inference) mod parts;
pub(in crate::inference) mod pruning;
pub(in crate::inference) mod selection;
pub(in crate::inference) mod unnamed;
pub(in crate::inference) mod varying;

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::fit_cache::FitCache;
use crate::inference::columns::gram_cache::GramCache;
use crate::inference::columns::linearised::Linearised;
use crate::inference::columns::part_products::Training;
use crate::inference::columns::table::Table;
use crate::inference::noise::lack_of_fit::{LackOfFit, Replicates};
use crate::inference::noise::scatter::in_spread;
use crate::inference::noise::whitening::Whitening;
use crate::inference::score::ColumnBlock;
use crate::inference::score::priors::{NAMED, priors};
use crate::inference::{Candidate, Effect, Evidence, ForwardModel, Hypothesis, Kind, Parameter, Term};
use crate::linalg::transposed_product;
use crate::parallel::in_parallel_outside_of_jobs;

/// A mistake is so many times as large as what readings scatter by.
const MISTAKEN: f64 = 10.0;
/// Of how many candidates, the likeliest, and the likeliest of each effect besides, the evidence is
/// computed exactly.
const SCORED: usize = 6;
/// Candidates whose products are computed at once.
const AT_ONCE: usize = 64;
/// Steps of one sequence are so many data apart at least.
const NO_STEP: usize = 3;
/// Two responses are one within this share of the larger.
const SAME: f64 = 1e-9;

/// Looks for the most probable hypothesis.
pub struct Search<'a> {
    pub(super) model: &'a Linearised<'a>,
    pub(super) evidence: &'a Evidence,
    pub(super) whitening: Whitening,
    /// Background, whitened and projected, and its inner products.
    pub(super) background: (DMatrix<f64>, DMatrix<f64>),
    /// Those of the background with each candidate's columns at neutral values; not of a linear
    /// model in parts.
    pub(super) beside_background: Option<Table>,
    /// Of a linear model in parts.
    pub(super) training: Option<Training<'a>>,
    /// Inner products of each candidate's columns, whitened and projected, with each other. Those
    /// with what is projected need no projection of theirs.
    pub(super) grams: Vec<DMatrix<f64>>,
    /// The residual, whitened and projected.
    pub(super) residual: DVector<f64>,
    /// Of a linear model.
    pub(super) kept: Option<GramCache>,
    /// Ln of the prior of each candidate over that of none.
    pub(super) prior: Vec<f64>,
    /// What repeats have in common; `None` without repeats.
    replicates: Option<Replicates>,
    /// What was fitted and asked before.
    pub(super) fitted: FitCache<Hypothesis>,
    added: FitCache<Arc<Vec<f64>>>,
}

impl<'a> Search<'a> {
    /// On an evidence, with the scatter of what `adopted` leaves.
    pub fn new(model: &'a Linearised<'a>, evidence: &'a Evidence, adopted: &[Term]) -> Self {
        let left = &evidence.residual - model.response(adopted);
        let whitening = Whitening::new(evidence, &left);
        let residual = whitening.apply(&evidence.residual);
        let background = whitening.apply_columns(&evidence.background);
        let training = model.training(&whitening);
        let (grams, beside_background, kept) = match &training {
            Some(training) => {
                let along =
                    |columns: &DMatrix<f64>| whitening.along_basis(&whitening.whitened_columns(columns));
                let of_residual = DMatrix::from_columns(std::slice::from_ref(&evidence.residual));
                let of_residual = training.beside_residual(&along(&of_residual).column(0).into_owned());
                let of_background = training.beside_background(&along(&evidence.background));
                (training.grams(), None, Some(GramCache::new(of_residual, of_background)))
            }
            None => {
                let grams = grams(model, &whitening);
                let beside_background = || model.table(&whitening.transposed(&background));
                let kept = model.is_linear().then(|| {
                    let of_residual = DMatrix::from_column_slice(residual.len(), 1, residual.as_slice());
                    let of_residual = model.table(&whitening.transposed(&of_residual));
                    GramCache::new(of_residual, beside_background())
                });
                let beside_background = kept.is_none().then(beside_background);
                (grams, beside_background, kept)
            }
        };
        Search {
            kept,
            training,
            grams,
            residual,
            background: {
                let gram = transposed_product(&background, &background);
                (background, gram)
            },
            beside_background,
            prior: priors(model.candidates()),
            replicates: Replicates::new(&whitening, evidence),
            fitted: FitCache::new(|fitted| fitted.covariance.len() + fitted.background_covariance.len()),
            added: FitCache::new(|added| added.len()),
            model,
            evidence,
            whitening,
        }
    }

    /// True for a mistake that is no larger than readings and their zeros scatter anyway: nobody
    /// made it.
    pub(super) fn is_lost_in_noise(&self, term: &Term, sigma: f64) -> bool {
        if self.model.candidates()[term.candidate].effect.kind != Kind::Mistake {
            return false;
        }
        let response = self.model.response(std::slice::from_ref(term));
        let response = in_spread(self.evidence, &response);
        let concerned = response.iter().filter(|change| **change != 0.0).count();
        let rms = response.norm() / (concerned.max(1) as f64).sqrt();
        rms < MISTAKEN * sigma * (1.0 + self.whitening.ratio).sqrt()
    }

    /// About the ln of what adding each candidate to `hypothesis` does to its probability, by the
    /// candidate's columns at its neutral values, exact for the likeliest known and unknown ones
    /// and for the likeliest place of every effect, lest one effect with many places leaves the
    /// others out; −∞ for those that are in it already.
    pub fn additions(&self, hypothesis: &Hypothesis) -> Arc<Vec<f64>> {
        self.added.answer(&hypothesis.terms, || Arc::new(self.additions_anew(hypothesis)))
    }

    fn additions_anew(&self, hypothesis: &Hypothesis) -> Vec<f64> {
        let (present, products) = self.crossed(&hypothesis.terms);
        let before = present.score();
        let bounds = |index: usize| self.model.candidates()[index].scaled_bounds().map(one_sided).collect();
        let is_open = |&index: &usize| !hypothesis.terms.iter().any(|term| self.excludes(term, index));
        let open: Vec<usize> = (0..self.grams.len()).filter(is_open).collect();
        let about = |part: &[usize]| -> Vec<f64> {
            let (cross, product) = products(part);
            let solved = before.solved(&cross);
            let mut next = 0;
            let of_index = |&index: &usize| {
                let gram = &self.grams[index];
                let own = next..next + gram.ncols();
                next = own.end;
                let more = ColumnBlock {
                    gram,
                    cross: cross.columns_range(own.clone()),
                    solved: solved.columns_range(own.clone()),
                    product: product.rows_range(own),
                    bounds: bounds(index),
                };
                present.about(&before, &more) + self.prior[index]
            };
            part.iter().map(of_index).collect()
        };
        let parts: Vec<&[usize]> = open.chunks(AT_ONCE).collect();
        let of_parts = in_parallel_outside_of_jobs(parts.len(), |k| about(parts[k]));
        let mut additions = vec![f64::NEG_INFINITY; self.grams.len()];
        for (&index, about) in open.iter().zip(of_parts.into_iter().flatten()) {
            additions[index] = about;
        }
        let alone = present.rest(&before).score().log_evidence;
        let exact = |index: usize| {
            let (cross, product) = products(&[index]);
            let solved = before.solved(&cross);
            let more = ColumnBlock {
                gram: &self.grams[index],
                cross: cross.as_view(),
                solved: solved.as_view(),
                product: product.as_view(),
                bounds: bounds(index),
            };
            let with = present.beyond(&before, &more).score();
            with.log_evidence - alone + self.prior[index]
        };
        for unknown in [false, true] {
            let mut effects: Vec<&Effect> = Vec::new();
            let mut likeliest = self.likeliest(&additions, unknown);
            let mut rank = 0;
            likeliest.retain(|&index| {
                let effect = self.model.candidates()[index].effect;
                let is_first = !effects.contains(&effect);
                if is_first {
                    effects.push(effect);
                }
                rank += 1;
                rank <= SCORED || is_first
            });
            let scored = in_parallel_outside_of_jobs(likeliest.len(), |k| exact(likeliest[k]));
            for (index, exact) in likeliest.into_iter().zip(scored) {
                additions[index] = exact;
            }
        }
        additions
    }

    /// True where a candidate can not be added to a hypothesis that holds `term`: what returns
    /// within two data is no step, those data are off.
    fn excludes(&self, term: &Term, index: usize) -> bool {
        let (old, new) = (&self.model.candidates()[term.candidate], &self.model.candidates()[index]);
        let are_near = || self.model.steps_apart(term.candidate, index).is_some_and(|n| n < NO_STEP);
        term.candidate == index
            || (old.is_alternative && new.is_alternative && old.effect == new.effect)
            || are_near()
    }

    /// Other forms of the law that a candidate is one of: with the same parameters, or with more
    /// that make it this one where they are neutral.
    pub fn other_forms(&self, index: usize) -> Vec<usize> {
        let candidates = self.model.candidates();
        let own = &candidates[index];
        let names = |c: &Candidate| c.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        let is_form = |&other: &usize| {
            let c = &candidates[other];
            let is_law = own.is_alternative && c.is_alternative && c.effect == own.effect;
            is_law && (names(c) == names(own) || self.is_held_by(index, other))
        };
        (0..candidates.len()).filter(|&other| other != index).filter(is_form).collect()
    }

    /// True where a candidate is another one whose further parameters are neutral.
    fn is_held_by(&self, index: usize, other: usize) -> bool {
        let [own, wider] = [index, other].map(|index| &self.model.candidates()[index]);
        let value = |p: &Parameter| p.neutral + p.size;
        let is_own = |p: &Parameter| own.parameters.iter().any(|known| known.name == p.name);
        if wider.parameters.len() <= own.parameters.len()
            || wider.parameters.iter().filter(|p| is_own(p)).count() < own.parameters.len()
        {
            return false;
        }
        let values = wider.parameters.iter().map(|p| if is_own(p) { value(p) } else { p.neutral }).collect();
        let by_wider = self.model.response(&[Term { candidate: other, values }]);
        let values = own.parameters.iter().map(value).collect();
        let by_own = self.model.response(&[Term { candidate: index, values }]);
        (by_wider - &by_own).amax() <= SAME * by_own.amax()
    }

    /// Candidates that may be added, known or unknown ones, the likeliest first.
    pub(super) fn likeliest(&self, additions: &[f64], unknown: bool) -> Vec<usize> {
        let mut likeliest: Vec<usize> = (0..additions.len())
            .filter(|&index| self.model.candidates()[index].is_nonparametric == unknown)
            .filter(|&index| additions[index] > f64::NEG_INFINITY)
            .collect();
        likeliest.sort_by(|&a, &b| additions[b].total_cmp(&additions[a]));
        likeliest
    }

    /// One candidate more.
    pub fn with(&self, hypothesis: &Hypothesis, index: usize) -> Hypothesis {
        let mut terms = hypothesis.terms.clone();
        terms.push(self.model.candidates()[index].neutral(index));
        self.fit(&terms)
    }

    /// One effect less.
    pub fn without(&self, hypothesis: &Hypothesis, position: usize) -> Hypothesis {
        let mut terms = hypothesis.terms.clone();
        terms.remove(position);
        self.fit(&terms)
    }

    /// Data less what the nuisance absorbs.
    pub fn degrees_of_freedom(&self) -> usize {
        self.whitening.degrees_of_freedom
    }

    /// The same where tails are heavy, as so many data of a normal distribution.
    pub(super) fn informative(&self) -> usize {
        (self.whitening.degrees_of_freedom as f64 * self.evidence.information).round() as usize
    }

    /// Variance of the errors that data share, over that of their own.
    pub fn shared_ratio(&self) -> f64 {
        self.whitening.ratio
    }

    /// Correlation of neighbours beyond that.
    pub(super) fn correlation(&self) -> f64 {
        self.whitening.correlation
    }

    /// ‖y − effects − background·b‖²/σ² + ‖b‖² of a hypothesis, shared errors and nuisance taken
    /// out: what two hypotheses differ by has about the χ² distribution where the longer one is
    /// chance.
    pub fn deviance(&self, hypothesis: &Hypothesis, sigma: f64) -> f64 {
        let left = &self.evidence.residual
            - self.model.response(&hypothesis.terms)
            - &self.evidence.background * &hypothesis.background;
        (self.whitening.apply(&left).norm() / sigma).powi(2) + hypothesis.background.norm_squared()
    }

    /// Do the averages of repeats leave a hypothesis that predicts `predicted`?
    pub fn lack_of_fit(&self, hypothesis: &Hypothesis, predicted: &DVector<f64>) -> Option<LackOfFit> {
        let parameters: usize = hypothesis.terms.iter().map(|term| term.values.len()).sum();
        let absorbed = self.evidence.residual.len() - self.whitening.degrees_of_freedom;
        let left = &self.evidence.residual - predicted;
        self.replicates.as_ref()?.test(&self.whitening.whitened(&left), parameters + absorbed)
    }

    /// What repeats scatter by where the averages of what a hypothesis leaves, `left`, are surely
    /// off by more than that; see [`Replicates::scatter`].
    pub fn scatter_beside_repeats(&self, hypothesis: &Hypothesis, left: &DVector<f64>) -> Option<f64> {
        let test = self.lack_of_fit(hypothesis, &(&self.evidence.residual - left))?;
        let is_sure = self.evidence.information * test.log_odds() > NAMED.ln();
        self.replicates.as_ref().filter(|_| is_sure).map(|own| own.scatter(self.evidence, left))
    }

    /// What a hypothesis says of all data of `evidence`, of which this search may have seen only a
    /// part: its effects' `change` of them, the background, and the nuisance that fits best to what
    /// this search has seen.
    pub fn predicted(
        &self,
        hypothesis: &Hypothesis,
        evidence: &Evidence,
        change: &DVector<f64>,
    ) -> DVector<f64> {
        let predicted = change + &evidence.background * &hypothesis.background;
        if evidence.nuisance.ncols() == 0 {
            return predicted;
        }
        let left = &self.evidence.residual
            - self.model.response(&hypothesis.terms)
            - &self.evidence.background * &hypothesis.background;
        predicted + &evidence.nuisance * self.whitening.nuisance(&self.evidence.nuisance, &left)
    }

    /// Ln of the prior of a candidate over that of none.
    pub(super) fn prior_of(&self, index: usize) -> f64 {
        self.prior[index]
    }
}

/// A bound that is where nothing happens; a far one says little about columns at neutral values,
/// where the effect may be far from linear.
fn one_sided((low, high): (f64, f64)) -> (f64, f64) {
    (if low == 0.0 { 0.0 } else { f64::NEG_INFINITY }, if high == 0.0 { 0.0 } else { f64::INFINITY })
}

/// Inner products of each candidate's columns, whitened and projected, with each other.
fn grams(model: &Linearised<'_>, whitening: &Whitening) -> Vec<DMatrix<f64>> {
    // along a course no step is a sum over the data behind it
    let sequences = if whitening.is_correlated() { Vec::new() } else { model.sequences() };
    let squares = whitening.squares_of_steps(&sequences);
    let basis = whitening.basis();
    let absorbed = (basis.ncols() > 0).then(|| model.table(&whitening.transposed(&basis)));
    let gram = |candidate: usize| match model.stored().square_of_step(candidate, &squares) {
        Some(square) => {
            let lost = absorbed.as_ref().map_or(0.0, |absorbed| absorbed.of(candidate).norm_squared());
            DMatrix::from_element(1, 1, square - lost)
        }
        None => whitening.projected_gram(&whitening.whitened_columns(&model.neutral(candidate))),
    };
    (0..model.candidates().len()).map(gram).collect()
}
