//! The values of a hypothesis: fitted together, within their bounds, by Gauss–Newton steps.

use nalgebra::{DMatrix, DVector};

use crate::inference::score::Score;
use crate::inference::search::Search;
use crate::inference::{ForwardModel, Hypothesis, Term};

/// Most Gauss–Newton steps to the values of a hypothesis.
const STEPS: usize = 20;
/// So often they may turn back.
const RETURNS: usize = 4;
/// Step, in sizes, below which they have arrived: the noise of a value is hardly ever a
/// ten-thousandth of its size.
const ARRIVED: f64 = 1e-5;
/// Step, in standard deviations of each value, below which they have arrived, and below which they
/// have for a first look: the evidence still changes by half the square of it.
const SETTLED: (f64, f64) = (1e-3, 0.1);

impl Search<'_> {
    /// Fits the values of `terms` together, by Gauss–Newton steps from where they are, and scores
    /// them.
    pub fn fit(&self, terms: &[Term]) -> Hypothesis {
        self.fitted.answer(terms, || self.fit_until(terms, SETTLED.0))
    }

    /// The same for a first look: values within a tenth of their standard deviations, where there
    /// is more than one step to them.
    pub fn fit_roughly(&self, terms: &[Term]) -> Hypothesis {
        if self.model.is_linear_in(terms) {
            return self.fit(terms);
        }
        self.fit_until(terms, SETTLED.1)
    }

    /// The same until a step is smaller than `settled` standard deviations of every value.
    fn fit_until(&self, terms: &[Term], settled: f64) -> Hypothesis {
        let background = self.background.0.ncols();
        let mut terms = terms.to_vec();
        let mut moments = self.moments(&terms);
        let mut scored = moments.score();
        let (mut returns, mut last, mut least) = (0, DVector::zeros(0), f64::INFINITY);
        for _ in 0..STEPS {
            let before = flat(&terms);
            self.put(&mut terms, &scored);
            let moved = (flat(&terms) - &before).component_div(&self.sizes(&terms));
            // where effects are linear the first step arrives
            let variance = |k: usize| scored.covariance[(background + k, background + k)];
            let is_small = |k: usize| moved[k].powi(2) < settled.powi(2) * variance(k);
            if self.model.is_linear_in(&terms) || moved.amax() < ARRIVED || (0..moved.len()).all(is_small) {
                least = f64::INFINITY;
                break;
            }
            // a curved law may send the values to and fro for ever: halfway is nearer
            returns += usize::from(!last.is_empty() && is_return(&moved, &last));
            if returns > RETURNS {
                set_flat(&mut terms, &before);
                break;
            }
            if returns > 0 {
                let share = 0.5f64.powi(returns as i32);
                let halfway = &before + moved.component_mul(&self.sizes(&terms)) * share;
                set_flat(&mut terms, &halfway);
            }
            (last, least) = (moved, scored.log_evidence);
            moments = self.moments(&terms);
            scored = moments.score();
        }
        // where it has not arrived, of two views the one that claims less
        let log_evidence = scored.log_evidence.min(least);
        let mut prior: f64 = terms.iter().map(|c| self.prior[c.candidate]).sum();
        if terms.iter().any(|term| self.is_lost_in_noise(term, scored.sigma)) {
            prior = f64::NEG_INFINITY;
        }
        let sizes = DMatrix::from_diagonal(&self.sizes(&terms));
        let covariance = moments.covariance(&scored, &self.alike(&terms));
        let own = covariance.view((background, background), (sizes.nrows(), sizes.ncols()));
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

    /// Of each term, how many numbers of one unit follow one another.
    fn alike(&self, terms: &[Term]) -> Vec<Vec<usize>> {
        let of_term = |term: &Term| {
            let parameters = &self.model.candidates()[term.candidate].parameters;
            parameters.chunk_by(|a, b| a.unit.si == b.unit.si).map(<[_]>::len).collect()
        };
        terms.iter().map(of_term).collect()
    }

    /// Values less neutral values, in sizes.
    pub fn offsets(&self, terms: &[Term]) -> DVector<f64> {
        let from_neutral = |c: &Term| -> Vec<f64> {
            let parameters = &self.model.candidates()[c.candidate].parameters;
            parameters.iter().zip(&c.values).map(|(p, value)| (value - p.neutral) / p.size).collect()
        };
        DVector::from_vec(terms.iter().flat_map(from_neutral).collect())
    }

    pub fn sizes(&self, terms: &[Term]) -> DVector<f64> {
        let in_sizes = |c: &Term| -> Vec<f64> {
            self.model.candidates()[c.candidate].parameters.iter().map(|p| p.size).collect()
        };
        DVector::from_vec(terms.iter().flat_map(in_sizes).collect())
    }

    /// Puts the estimates of a score, in sizes from the neutral values, into a hypothesis, within
    /// the physical bounds: what would be beyond its bound is held there, and the others are what
    /// they are given that.
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
