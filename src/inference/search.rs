//! Hypotheses: fitted, scored, and asked what would make them more probable.
//!
//! A hypothesis is a few candidates that act together. Its probability is that of the recording ([`super::score`]) times its prior:
//! before the data half of all recordings hold nothing, the library shares 0.4, physics that nobody has named 0.1. Within the
//! library every effect has the same share, and within an effect every place a share of that, so that a scan over a hundred
//! places finds nothing a hundred times as often as a single place does.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use super::columns::Table;
use super::gram_cache::{GramCache, stacked};
use super::lack_of_fit::{LackOfFit, Replicates};
use super::linearised::Linearised;
use super::part_products::Training;
use super::score::{ColumnBlock, Moments, Score};
use super::whitening::Whitening;
use super::{Candidate, Effect, Evidence, ForwardModel, Hypothesis, Kind, Term};
use crate::linalg::transposed_product;

/// Prior probability that the next effect is none, one of the library, or one that nobody has named.
pub(super) const PRIOR: (f64, f64, f64) = (0.5, 0.4, 0.1);
/// Share of it that a mistake has: it is named at odds of 1000, where an effect is at 50.
const MISTAKE: f64 = 0.05;
/// A mistake is so many times as large as what readings scatter by.
const MISTAKEN: f64 = 10.0;
/// Of how many candidates, the likeliest, and the likeliest of each effect besides, the evidence is computed exactly.
const SCORED: usize = 6;
/// Steps of one sequence are so many data apart at least.
const NO_STEP: usize = 3;
/// Most Gauss–Newton steps to the values of a hypothesis.
const STEPS: usize = 20;
/// So often they may turn back.
const RETURNS: usize = 4;
/// Step, in sizes, below which they have arrived: the noise of a value is hardly ever a ten-thousandth of its size.
const ARRIVED: f64 = 1e-5;

/// Looks for the most probable hypothesis.
pub struct Search<'a> {
    pub(super) model: &'a Linearised<'a>,
    pub(super) evidence: &'a Evidence,
    pub(super) whitening: Whitening,
    /// Background, whitened and projected, and its inner products.
    background: (DMatrix<f64>, DMatrix<f64>),
    /// Those of the background with each candidate's columns at neutral values; not of a linear model in parts.
    beside_background: Option<Table<'a>>,
    /// Of a linear model in parts.
    pub(super) training: Option<Training<'a>>,
    /// Inner products of each candidate's columns, whitened and projected, with each other. Those with what is projected
    /// need no projection of theirs.
    grams: Vec<DMatrix<f64>>,
    /// The residual, whitened and projected.
    residual: DVector<f64>,
    /// Of a linear model.
    kept: Option<GramCache>,
    /// Ln of the prior of each candidate over that of none.
    prior: Vec<f64>,
    /// What repeats have in common; `None` without repeats.
    replicates: Option<Replicates>,
    /// What was fitted and asked before: a search comes to the same hypothesis by several ways.
    fitted: Memory<Hypothesis>,
    added: Memory<Arc<Vec<f64>>>,
}

/// Answers by the terms that they are of, values to the last bit.
type Memory<T> = Mutex<BTreeMap<Vec<(usize, Vec<u64>)>, T>>;

/// For a candidate, the inner products of its columns with those of a hypothesis (rows), and with a residual.
type CrossProducts<'a> = dyn Fn(usize) -> (DMatrix<f64>, DVector<f64>) + 'a;

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
                let of_residual = DMatrix::from_columns(std::slice::from_ref(&evidence.residual));
                let of_residual =
                    training.beside_residual(&whitening.along_basis(&of_residual).column(0).into_owned());
                let of_background = training.beside_background(&whitening.along_basis(&evidence.background));
                (training.grams(), None, Some(GramCache::of_products(of_residual, of_background)))
            }
            None => {
                let grams = grams(model, &whitening);
                let beside_background = model.table(&whitening.transposed(&background));
                let kept = model.is_linear().then(|| {
                    let of_residual = DMatrix::from_column_slice(residual.len(), 1, residual.as_slice());
                    let of_residual = model.table(&whitening.transposed(&of_residual));
                    GramCache::new(grams.len(), &of_residual, &beside_background)
                });
                (grams, Some(beside_background), kept)
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
            replicates: Replicates::new(&whitening, &evidence.replicate_group),
            fitted: Memory::default(),
            added: Memory::default(),
            model,
            evidence,
            whitening,
        }
    }

    /// Fits the values of `terms` together, by Gauss–Newton steps from where they are, and scores them.
    pub fn fit(&self, terms: &[Term]) -> Hypothesis {
        remembered(&self.fitted, terms, || self.fit_anew(terms))
    }

    fn fit_anew(&self, terms: &[Term]) -> Hypothesis {
        let background = self.background.0.ncols();
        let mut terms = terms.to_vec();
        let mut scored = self.moments(&terms).score();
        let (mut returns, mut last, mut least) = (0, DVector::zeros(0), f64::INFINITY);
        for _ in 0..STEPS {
            let before = flat(&terms);
            self.put(&mut terms, &scored);
            let moved = (flat(&terms) - &before).component_div(&self.sizes(&terms));
            // where effects are linear the first step arrives
            if self.model.is_linear_in(&terms) || moved.amax() < ARRIVED {
                least = f64::INFINITY;
                break;
            }
            // a curved law may send the values to and fro for ever: halfway is nearer
            returns += usize::from(!last.is_empty() && is_return(&moved, &last));
            if returns > RETURNS {
                break;
            }
            if returns > 0 {
                let share = 0.5f64.powi(returns as i32);
                let halfway = &before + moved.component_mul(&self.sizes(&terms)) * share;
                set_flat(&mut terms, &halfway);
            }
            (last, least) = (moved, scored.log_evidence);
            scored = self.moments(&terms).score();
        }
        // where it has not arrived, of two views the one that claims less
        let log_evidence = scored.log_evidence.min(least);
        let mut prior: f64 = terms.iter().map(|c| self.prior[c.candidate]).sum();
        if terms.iter().any(|term| self.is_lost_in_noise(term, scored.sigma)) {
            prior = f64::NEG_INFINITY;
        }
        let sizes = DMatrix::from_diagonal(&self.sizes(&terms));
        let own = scored.covariance.view((background, background), (sizes.nrows(), sizes.ncols()));
        Hypothesis {
            log_probability: log_evidence + prior,
            sigma: scored.sigma,
            covariance: &sizes * own * &sizes,
            background: scored.estimate.rows(0, background).into_owned(),
            background_covariance: scored.covariance.view((0, 0), (background, background)).into_owned(),
            determined: scored.determined,
            terms,
        }
    }

    /// True for a mistake that is no larger than readings and their zeros scatter anyway: nobody made it.
    fn is_lost_in_noise(&self, term: &Term, sigma: f64) -> bool {
        if self.model.candidates()[term.candidate].effect.kind != Kind::Mistake {
            return false;
        }
        let response = self.model.response(std::slice::from_ref(term));
        let concerned = response.iter().filter(|change| **change != 0.0).count();
        let rms = response.norm() / (concerned.max(1) as f64).sqrt();
        rms < MISTAKEN * sigma * (1.0 + self.whitening.ratio).sqrt()
    }

    /// About the ln of what adding each candidate to `hypothesis` does to its probability, by the candidate's columns at its
    /// neutral values, exact for the likeliest known and unknown ones and for the likeliest place of every effect, lest
    /// one effect with many places leaves the others out; −∞ for those that are in it already.
    pub fn additions(&self, hypothesis: &Hypothesis) -> Arc<Vec<f64>> {
        remembered(&self.added, &hypothesis.terms, || Arc::new(self.additions_anew(hypothesis)))
    }

    fn additions_anew(&self, hypothesis: &Hypothesis) -> Vec<f64> {
        let (present, products) = self.crossed(&hypothesis.terms);
        let before = present.score();
        let more = |index: usize| {
            let (cross, product) = products(index);
            let bounds = self.model.candidates()[index].scaled_bounds().map(one_sided).collect();
            ColumnBlock { gram: &self.grams[index], cross, product, bounds }
        };
        let alone = present.rest(&before).score().log_evidence;
        let about = |index: usize| match hypothesis.terms.iter().any(|term| self.excludes(term, index)) {
            true => f64::NEG_INFINITY,
            false => present.about(&before, &more(index)) + self.prior[index],
        };
        let mut additions: Vec<f64> = (0..self.grams.len()).map(about).collect();
        for unknown in [false, true] {
            let mut effects: Vec<&Effect> = Vec::new();
            for (rank, index) in self.likeliest(&additions, unknown).into_iter().enumerate() {
                let effect = self.model.candidates()[index].effect;
                let is_first = !effects.contains(&effect);
                if is_first {
                    effects.push(effect);
                }
                if rank >= SCORED && !is_first {
                    continue;
                }
                let with = present.beyond(&before, &more(index)).score();
                additions[index] = with.log_evidence - alone + self.prior[index];
            }
        }
        additions
    }

    /// True where a candidate can not be added to a hypothesis that holds `term`: what returns within two data is no step,
    /// those data are off.
    fn excludes(&self, term: &Term, index: usize) -> bool {
        let (old, new) = (&self.model.candidates()[term.candidate], &self.model.candidates()[index]);
        let are_near = || self.model.stored().steps_apart(term.candidate, index).is_some_and(|n| n < NO_STEP);
        term.candidate == index
            || (old.is_alternative && new.is_alternative && old.effect == new.effect)
            || are_near()
    }

    /// Other forms of the law that a candidate is one of, with the same parameters.
    pub fn other_forms(&self, index: usize) -> Vec<usize> {
        let candidates = self.model.candidates();
        let own = &candidates[index];
        let names = |c: &Candidate| c.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        let is_form = |&other: &usize| {
            let c = &candidates[other];
            own.is_alternative && c.is_alternative && c.effect == own.effect && names(c) == names(own)
        };
        (0..candidates.len()).filter(|&other| other != index).filter(is_form).collect()
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

    /// ‖y − effects − background·b‖²/σ² + ‖b‖² of a hypothesis, shared errors and nuisance taken out: what two
    /// hypotheses differ by has about the χ² distribution where the longer one is chance.
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

    /// What a hypothesis says of all data of `evidence`, of which this search may have seen only a part: its effects' `change`
    /// of them, the background, and the nuisance that fits best to what this search has seen.
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

    /// Residual and columns of a hypothesis, background first, whitened; the residual without what its values explain.
    pub(super) fn linear_part(&self, terms: &[Term]) -> (DVector<f64>, DMatrix<f64>) {
        let (r, own) = self.linear(terms);
        let background = self.background.0.ncols();
        let mut all = self.background.0.clone().resize_horizontally(background + own.ncols(), 0.0);
        all.columns_mut(background, own.ncols()).copy_from(&own);
        (r, all)
    }

    /// Ln of the probability of a hypothesis, of this [`Search::linear_part`], with `more` columns beside its own, each an effect of
    /// no prior by itself; and what it leaves, whitened.
    pub(super) fn with_columns(
        &self,
        hypothesis: &Hypothesis,
        (r, columns): &(DVector<f64>, DMatrix<f64>),
        more: &DMatrix<f64>,
    ) -> (f64, DVector<f64>) {
        let first = self.background.0.ncols();
        let own = columns.columns(first, columns.ncols() - first);
        let mut effects = own.clone_owned().resize_horizontally(own.ncols() + more.ncols(), 0.0);
        effects.columns_mut(own.ncols(), more.ncols()).copy_from(more);
        let mut moments = self.moments_of(r, &effects, &hypothesis.terms);
        moments.bounds.resize(first + effects.ncols(), (f64::NEG_INFINITY, f64::INFINITY));
        moments.effects.extend(std::iter::repeat_n(1, more.ncols()));
        let scored = moments.score();
        let estimate = &scored.estimate;
        let left = r - &self.background.0 * estimate.rows(0, first) - effects * estimate.rows_range(first..);
        let prior: f64 = hypothesis.terms.iter().map(|term| self.prior[term.candidate]).sum();
        (scored.log_evidence + prior, left)
    }

    /// Ln of the prior of a candidate over that of none.
    pub(super) fn prior_of(&self, index: usize) -> f64 {
        self.prior[index]
    }

    /// Residual and columns of the effects of a hypothesis at their values, linear about the neutral ones and whitened.
    /// Estimates are in sizes from the neutral values.
    fn linear(&self, terms: &[Term]) -> (DVector<f64>, DMatrix<f64>) {
        let own: Vec<DMatrix<f64>> =
            (0..terms.len()).map(|position| self.model.columns(terms, position)).collect();
        let count: usize = own.iter().map(DMatrix::ncols).sum();
        let mut columns = DMatrix::zeros(self.evidence.residual.len(), count);
        let mut next = 0;
        for own in own {
            columns.columns_mut(next, own.ncols()).copy_from(&own);
            next += own.ncols();
        }
        // recorded less predicted, plus what the columns make of it
        let left = &self.evidence.residual - self.model.response(terms) + &columns * self.offsets(terms);
        (self.whitening.apply(&left), self.whitening.apply_columns(&columns))
    }

    /// The moments of a hypothesis, and the inner products of each candidate's columns with the hypothesis's and with the residual that it
    /// is fitted to.
    fn crossed(&self, terms: &[Term]) -> (Moments, Box<CrossProducts<'_>>) {
        let Some(kept) = &self.kept else {
            let (r, own) = self.linear(terms);
            let moments = self.moments_of(&r, &own, terms);
            let count = own.ncols();
            let mut with_residual = own.resize_horizontally(count + 1, 0.0);
            with_residual.set_column(count, &r);
            let products = self.model.products(self.whitening.transposed(&with_residual));
            let of = move |index: usize| {
                let all = products.of(index);
                let effects = all.rows(0, count).into_owned();
                let background = self.beside_background.as_ref().map(|table| table.of(index));
                let cross = stacked(&background.unwrap_or_default(), std::iter::once(&effects));
                (cross, all.row(count).transpose())
            };
            return (moments, Box::new(of));
        };
        let effects: Vec<usize> = terms.iter().map(|c| c.candidate).collect();
        let cross = kept.hypothesis(&effects, &|effect| self.beside_effect(effect));
        let moments = self.kept_moments(kept, terms);
        (moments, Box::new(move |index| (cross(index), kept.residual(index).clone())))
    }

    /// Inner products of an effect's columns (rows) with those of each candidate.
    fn beside_effect(&self, effect: usize) -> Vec<DMatrix<f64>> {
        if let Some(training) = &self.training {
            return training.between(effect);
        }
        let own = self.whitening.apply_columns(&self.model.neutral(effect));
        let products = self.model.table(&self.whitening.transposed(&own));
        (0..self.grams.len()).map(|index| products.of(index)).collect()
    }

    fn moments(&self, terms: &[Term]) -> Moments {
        if let Some(kept) = &self.kept {
            return self.kept_moments(kept, terms);
        }
        let (r, own) = self.linear(terms);
        self.moments_of(&r, &own, terms)
    }

    /// Of a linear model. Of the last effect, which is often only tried, no products with all candidates are needed.
    fn kept_moments(&self, kept: &GramCache, terms: &[Term]) -> Moments {
        let effects: Vec<usize> = terms.iter().map(|c| c.candidate).collect();
        let leading = &effects[..effects.len().saturating_sub(1)];
        let cross = kept.hypothesis(leading, &|effect| self.beside_effect(effect));
        let first = self.background.0.ncols();
        let counts: Vec<usize> = effects.iter().map(|&effect| self.grams[effect].ncols()).collect();
        let count = first + counts.iter().sum::<usize>();
        let (mut gram, mut product) = (DMatrix::zeros(count, count), DVector::zeros(count));
        gram.view_mut((0, 0), (first, first)).copy_from(&self.background.1);
        product.rows_mut(0, first).copy_from(&self.background.0.tr_mul(&self.residual));
        let mut next = first;
        for (&effect, &own) in effects.iter().zip(&counts) {
            let block = cross(effect);
            // symmetric to the last bit
            let above = next.min(block.nrows());
            gram.view_mut((0, next), (above, own)).copy_from(&block.rows(0, above));
            gram.view_mut((next, 0), (own, above)).copy_from(&block.rows(0, above).transpose());
            gram.view_mut((next, next), (own, own)).copy_from(&self.grams[effect]);
            product.rows_mut(next, own).copy_from(kept.residual(effect));
            next += own;
        }
        Moments {
            square: self.residual.norm_squared(),
            gram,
            product,
            bounds: self.bounds(terms),
            effects: counts,
            degrees_of_freedom: self.informative(),
            floor: self.floor(),
            stated: self.evidence.stated_noise,
        }
    }

    /// Of a residual and the columns of the effects, the background before them.
    fn moments_of(&self, r: &DVector<f64>, own: &DMatrix<f64>, terms: &[Term]) -> Moments {
        let (background, of_background) = &self.background;
        let (first, count) = (background.ncols(), own.ncols());
        let cross = transposed_product(background, own);
        let mut gram = of_background.clone().resize(first + count, first + count, 0.0);
        gram.view_mut((0, first), (first, count)).copy_from(&cross);
        gram.view_mut((first, 0), (count, first)).copy_from(&cross.transpose());
        gram.view_mut((first, first), (count, count)).copy_from(&transposed_product(own, own));
        let mut product = DVector::zeros(first + count);
        product.rows_mut(0, first).copy_from(&background.tr_mul(r));
        product.rows_mut(first, count).copy_from(&own.tr_mul(r));
        Moments {
            square: r.norm_squared(),
            gram,
            product,
            bounds: self.bounds(terms),
            effects: terms.iter().map(|c| c.values.len()).collect(),
            degrees_of_freedom: self.informative(),
            floor: self.floor(),
            stated: self.evidence.stated_noise,
        }
    }

    /// Bounds of a hypothesis's parameters, background first.
    fn bounds(&self, terms: &[Term]) -> Vec<(f64, f64)> {
        let mut bounds = vec![(f64::NEG_INFINITY, f64::INFINITY); self.background.0.ncols()];
        for c in terms {
            bounds.extend(self.model.candidates()[c.candidate].scaled_bounds());
        }
        bounds
    }

    /// Noise that rounding alone makes.
    fn floor(&self) -> f64 {
        self.evidence.resolution / 12.0f64.sqrt()
    }

    /// Values less neutral values, in sizes.
    fn offsets(&self, terms: &[Term]) -> DVector<f64> {
        let of = |c: &Term| -> Vec<f64> {
            let parameters = &self.model.candidates()[c.candidate].parameters;
            parameters.iter().zip(&c.values).map(|(p, value)| (value - p.neutral) / p.size).collect()
        };
        DVector::from_vec(terms.iter().flat_map(of).collect())
    }

    fn sizes(&self, terms: &[Term]) -> DVector<f64> {
        let of = |c: &Term| -> Vec<f64> {
            self.model.candidates()[c.candidate].parameters.iter().map(|p| p.size).collect()
        };
        DVector::from_vec(terms.iter().flat_map(of).collect())
    }

    /// Puts the estimates of a score, in sizes from the neutral values, into a hypothesis, within the physical bounds: what
    /// would be beyond its bound is held there, and the others are what they are given that.
    fn put(&self, terms: &mut [Term], scored: &Score) {
        let background = self.background.0.ncols();
        let bounds: Vec<(f64, f64)> =
            terms.iter().flat_map(|c| self.model.candidates()[c.candidate].scaled_bounds()).collect();
        let (mut mean, mut covariance) = (scored.estimate.clone(), scored.covariance.clone());
        for _ in 0..bounds.len() {
            let beyond = |k: usize| {
                let (low, high) = bounds[k];
                let value = mean[background + k];
                value.clamp(low, high) - value
            };
            let farthest = (0..bounds.len()).max_by(|&a, &b| beyond(a).abs().total_cmp(&beyond(b).abs()));
            let Some((k, by)) = farthest.map(|k| (background + k, beyond(k))) else { break };
            let variance = covariance[(k, k)];
            // the normal distribution given that x_k is at its bound
            if by == 0.0 || variance <= 0.0 {
                break;
            }
            let column = covariance.column(k).into_owned();
            mean += &column * (by / variance);
            covariance -= &column * column.transpose() / variance;
        }
        let mut next = mean.iter().skip(background);
        for c in terms {
            let parameters = &self.model.candidates()[c.candidate].parameters;
            for (parameter, value) in parameters.iter().zip(&mut c.values) {
                if let Some(offset) = next.next() {
                    let (low, high) = parameter.bounds;
                    *value = (parameter.neutral + offset * parameter.size).clamp(low, high);
                }
            }
        }
    }
}

/// A bound that is where nothing happens; a far one says little about columns at neutral values, where the effect may be far
/// from linear.
fn one_sided((low, high): (f64, f64)) -> (f64, f64) {
    (if low == 0.0 { 0.0 } else { f64::NEG_INFINITY }, if high == 0.0 { 0.0 } else { f64::INFINITY })
}

/// Inner products of each candidate's columns, whitened and projected, with each other.
fn grams(model: &Linearised<'_>, whitening: &Whitening) -> Vec<DMatrix<f64>> {
    let squares = whitening.squares_of_steps(&model.sequences());
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

/// What is known of these terms, or else is found out.
fn remembered<T: Clone>(memory: &Memory<T>, terms: &[Term], find: impl FnOnce() -> T) -> T {
    let bits = |term: &Term| (term.candidate, term.values.iter().map(|value| value.to_bits()).collect());
    let key: Vec<(usize, Vec<u64>)> = terms.iter().map(bits).collect();
    let known = memory.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
    known.unwrap_or_else(|| {
        let found = find();
        memory.lock().unwrap_or_else(PoisonError::into_inner).insert(key, found.clone());
        found
    })
}

fn flat(terms: &[Term]) -> DVector<f64> {
    DVector::from_vec(terms.iter().flat_map(|c| c.values.iter().copied()).collect())
}

/// The reverse of [`flat`].
fn set_flat(terms: &mut [Term], values: &DVector<f64>) {
    terms
        .iter_mut()
        .flat_map(|term| &mut term.values)
        .zip(values.iter())
        .for_each(|(own, value)| *own = *value);
}

/// True for a step back that is at least half as long as the one before.
fn is_return(step: &DVector<f64>, last: &DVector<f64>) -> bool {
    step.dot(last) < -0.5 * last.norm_squared()
}

/// Ln of each candidate's prior over that of none; see the top of the file.
fn priors(candidates: &[Candidate]) -> Vec<f64> {
    let (none, library, unknown) = PRIOR;
    let mut places: BTreeMap<(&str, bool), f64> = BTreeMap::new();
    for candidate in candidates {
        *places.entry((candidate.effect.name, candidate.is_nonparametric)).or_default() += candidate.weight;
    }
    let effects = |wanted: bool| {
        places.keys().filter(|(_, is_nonparametric)| *is_nonparametric == wanted).count().max(1) as f64
    };
    let (known, unnamed) = (effects(false), effects(true));
    candidates
        .iter()
        .map(|candidate| {
            let places = places[&(candidate.effect.name, candidate.is_nonparametric)];
            let share = match candidate.is_nonparametric {
                true => unknown / unnamed,
                false if candidate.effect.kind == Kind::Mistake => MISTAKE * library / known,
                false => library / known,
            };
            (share * candidate.weight / places / none).ln()
        })
        .collect()
}
