//! Which two effects together may explain what neither does alone.
//!
//! A modulus that is too low and a root that gives way hide each other: each alone makes the fit
//! worse. All pairs are screened by the inner products of their columns, G and b, what the
//! hypothesis so far explains taken out:
//!
//! ```text
//! gain ≈ −½·ν·ln(1 − Δ/q) − ½·ln|1 + G/s|     Δ = bᵀ(G + s)⁻¹b, s what is then left of σ²
//! ```
//!
//! and only the best are fitted. q is all that is left, ‖r‖². It is νσ² unless the noise is stated:
//! that draws σ to it, and two effects of which one explains most would explain all.

use std::collections::BTreeSet;

use nalgebra::allocator::Allocator;
use nalgebra::{Cholesky, DMatrix, DVector, DefaultAllocator, Dim, OMatrix, OVector, SMatrix, SVector};

use crate::inference::search::Search;
use crate::inference::{ForwardModel, Hypothesis, Kind};
use crate::linalg::transposed_product;

/// Pairs that are fitted.
const REFITTED: usize = 16;
/// Most candidates that are paired, the likeliest alone and the first of every effect.
const MOST: usize = 120;
/// Of more candidates no pairs are screened.
const TOO_MANY: usize = 400;
/// Numbers of the columns that are whitened at once.
const AT_ONCE: usize = 1 << 22;
/// A pair must be worth so much more than the better of the two alone.
const TOGETHER: f64 = 3.0;

impl Search<'_> {
    /// The best pairs of candidates beside a hypothesis, by their columns at neutral values.
    /// Events come one by one: a pair of them explains no more than both.
    pub fn pairs(&self, hypothesis: &Hypothesis, additions: &[f64]) -> Vec<(usize, usize)> {
        let candidates = self.model.candidates();
        let mut paired: Vec<usize> = self
            .likeliest(additions, false)
            .into_iter()
            .filter(|&index| candidates[index].effect.kind != Kind::Event)
            .collect();
        // a scan over hundreds of waves of every joint has too many pairs, and no two of them hide
        if paired.len() > TOO_MANY {
            return Vec::new();
        }
        paired.truncate(MOST);
        let (residual, base) = self.linear_part(&hypothesis.terms);
        let counts: Vec<usize> = paired.iter().map(|&index| candidates[index].parameters.len()).collect();
        let starts: Vec<usize> = counts
            .iter()
            .scan(0, |next, count| {
                let start = *next;
                *next += count;
                Some(start)
            })
            .collect();
        let total: usize = counts.iter().sum();
        let mut gram = DMatrix::zeros(total, total);
        let mut product = DVector::zeros(total);
        let mut cross = DMatrix::zeros(base.ncols(), total);
        // some at a time, lest all columns of a long recording stand in memory
        let at_once = (AT_ONCE / residual.len().max(1)).max(1);
        let mut next = 0;
        while next < paired.len() {
            let mut end = next + 1;
            while end < paired.len() && starts[end] + counts[end] - starts[next] <= at_once {
                end += 1;
            }
            let own: usize = counts[next..end].iter().sum();
            let mut columns = DMatrix::zeros(residual.len(), own);
            for k in next..end {
                let whitened = self.whitening.apply_columns(&self.model.neutral(paired[k]));
                columns.columns_mut(starts[k] - starts[next], counts[k]).copy_from(&whitened);
            }
            match &self.training {
                Some(training) => {
                    for k in next..end {
                        let products = training.between(paired[k]);
                        for (other, &index) in paired.iter().enumerate() {
                            let (at, size) = ((starts[k], starts[other]), (counts[k], counts[other]));
                            gram.view_mut(at, size).copy_from(&products.of(index));
                        }
                    }
                }
                None => {
                    let products = self.model.products(self.whitening.transposed(&columns));
                    for (k, &index) in paired.iter().enumerate() {
                        let (at, size) = ((starts[next], starts[k]), (own, counts[k]));
                        gram.view_mut(at, size).copy_from(&products.of(index));
                    }
                }
            }
            product.rows_mut(starts[next], own).copy_from(&columns.tr_mul(&residual));
            cross.columns_mut(starts[next], own).copy_from(&transposed_product(&base, &columns));
            next = end;
        }
        let s = hypothesis.sigma.powi(2);
        let mut all = residual.norm_squared();
        if base.ncols() > 0 {
            let mut ridge = transposed_product(&base, &base);
            (0..ridge.ncols()).for_each(|k| ridge[(k, k)] += s);
            if let Some(root) = Cholesky::new(ridge) {
                let solved = root.solve(&cross);
                gram -= transposed_product(&cross, &solved);
                let along = base.tr_mul(&residual);
                product -= solved.tr_mul(&along);
                all -= along.dot(&root.solve(&along));
            }
        }
        let nu = (self.informative() as f64).max(1.0);
        let noise = Noise { variance: s, all: all.max(nu * s), informative: nu };
        let gain = |columns: &[usize]| gain(&gram, &product, columns, noise);
        let own = |k: usize| -> Vec<usize> { (starts[k]..starts[k] + counts[k]).collect() };
        let alone: Vec<f64> = (0..paired.len()).map(|k| gain(&own(k))).collect();
        let mut gains: Vec<(f64, usize, usize)> = Vec::new();
        for i in 0..paired.len() {
            for j in i + 1..paired.len() {
                let (a, b) = (&candidates[paired[i]], &candidates[paired[j]]);
                if a.is_alternative && b.is_alternative && a.effect == b.effect {
                    continue;
                }
                let prior = self.prior_of(paired[i]) + self.prior_of(paired[j]);
                let together = gain(&[own(i), own(j)].concat());
                let best_alone =
                    (alone[i] + self.prior_of(paired[i])).max(alone[j] + self.prior_of(paired[j])).max(0.0);
                if together + prior > best_alone + TOGETHER {
                    gains.push((together + prior, paired[i], paired[j]));
                }
            }
        }
        gains.sort_by(|a, b| b.0.total_cmp(&a.0));
        let effects = |(_, first, second): &(f64, usize, usize)| {
            let [a, b] = [first, second].map(|index| candidates[*index].effect.name);
            if a < b { (a, b) } else { (b, a) }
        };
        varied(&gains, effects).into_iter().map(|(_, first, second)| (first, second)).collect()
    }
}

/// So many pairs of a list, the best first: half of them whatever they are, then the best of each
/// other kind, lest a law of many forms leaves no place for others; and the best of the rest.
fn varied<T: Copy, K: Ord>(all: &[T], kind: impl Fn(&T) -> K) -> Vec<T> {
    let mut known = BTreeSet::new();
    let mut ranked: Vec<(bool, usize)> = Vec::new();
    for (rank, one) in all.iter().enumerate() {
        let is_new = known.insert(kind(one));
        ranked.push((rank >= REFITTED / 2 && !is_new, rank));
    }
    ranked.sort_unstable();
    ranked.into_iter().take(REFITTED).map(|(_, rank)| all[rank]).collect()
}

/// What a hypothesis leaves.
#[derive(Clone, Copy)]
struct Noise {
    /// σ².
    variance: f64,
    /// q.
    all: f64,
    /// ν.
    informative: f64,
}

/// About what some columns of a whole are worth. Of the few numbers of two effects no matrices are
/// made.
fn gain(gram: &DMatrix<f64>, product: &DVector<f64>, columns: &[usize], noise: Noise) -> f64 {
    match columns.len() {
        1 => gain_of::<1>(gram, product, columns, noise),
        2 => gain_of::<2>(gram, product, columns, noise),
        3 => gain_of::<3>(gram, product, columns, noise),
        4 => gain_of::<4>(gram, product, columns, noise),
        k => {
            let own = DMatrix::from_fn(k, k, |i, j| gram[(columns[i], columns[j])]);
            worth(own, DVector::from_fn(k, |i, _| product[columns[i]]), noise)
        }
    }
}

fn gain_of<const K: usize>(
    gram: &DMatrix<f64>,
    product: &DVector<f64>,
    columns: &[usize],
    noise: Noise,
) -> f64 {
    let own = SMatrix::<f64, K, K>::from_fn(|i, j| gram[(columns[i], columns[j])]);
    worth(own, SVector::<f64, K>::from_fn(|i, _| product[columns[i]]), noise)
}

fn worth<D: Dim>(own: OMatrix<f64, D, D>, b: OVector<f64, D>, noise: Noise) -> f64
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let mut left = noise.variance;
    let mut last = None;
    for _ in 0..3 {
        let mut ridge = own.clone();
        (0..b.len()).for_each(|i| ridge[(i, i)] += left + 1e-9 * own[(i, i)]);
        let Some(root) = Cholesky::new(ridge) else { return f64::NEG_INFINITY };
        let explained = (b.dot(&root.solve(&b)) / noise.all).clamp(0.0, 1.0 - 1e-9);
        last = Some((root, explained, left));
        left = (noise.variance * (1.0 - explained)).max(f64::MIN_POSITIVE);
    }
    last.map_or(f64::NEG_INFINITY, |(root, explained, left)| {
        let lower = root.l_dirty();
        let determinant: f64 = (0..b.len()).map(|i| (lower[(i, i)] * lower[(i, i)] / left).ln()).sum();
        -0.5 * (noise.informative * (-explained).ln_1p() + determinant)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_of_many_forms_leaves_places_for_others() {
        // thirty forms of one pair, then each of four others twice
        let all: Vec<(u32, char)> = (0..30)
            .map(|k| (k, 'a'))
            .chain((30..38).map(|k| (k, ['b', 'c', 'd', 'e'][k as usize % 4])))
            .collect();
        let varied = varied(&all, |one| one.1);
        let expected: Vec<u32> = (0..8).chain(30..34).chain(8..12).collect();
        assert_eq!(varied.iter().map(|one| one.0).collect::<Vec<_>>(), expected);
        assert_eq!(super::varied(&all[..3], |one| one.1), all[..3]);
    }
}
