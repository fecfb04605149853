//! Which two effects together may explain what neither does alone.
//!
//! A modulus that is too low and a root that gives way hide each other: each alone makes the fit
//! worse. All pairs are screened by the inner products of their columns, G and b, what the
//! hypothesis so far explains taken out:
//!
//! ```text
//! gain ≈ −½·ν·ln(1 − Δ/νσ²) − ½·ln|1 + G/s|     Δ = bᵀ(G + s)⁻¹b, s what is then left of σ²
//! ```
//!
//! and only the best are fitted.

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
        if base.ncols() > 0 {
            let mut ridge = transposed_product(&base, &base);
            (0..ridge.ncols()).for_each(|k| ridge[(k, k)] += s);
            if let Some(root) = Cholesky::new(ridge) {
                let solved = root.solve(&cross);
                gram -= transposed_product(&cross, &solved);
                product -= solved.tr_mul(&base.tr_mul(&residual));
            }
        }
        let nu = (self.informative() as f64).max(1.0);
        let gain = |columns: &[usize]| gain(&gram, &product, columns, s, nu);
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
        gains.into_iter().take(REFITTED).map(|(_, first, second)| (first, second)).collect()
    }
}

/// About what some columns of a whole are worth. Of the few numbers of two effects no matrices are
/// made.
fn gain(gram: &DMatrix<f64>, product: &DVector<f64>, columns: &[usize], noise: f64, nu: f64) -> f64 {
    match columns.len() {
        1 => gain_of::<1>(gram, product, columns, noise, nu),
        2 => gain_of::<2>(gram, product, columns, noise, nu),
        3 => gain_of::<3>(gram, product, columns, noise, nu),
        4 => gain_of::<4>(gram, product, columns, noise, nu),
        k => {
            let own = DMatrix::from_fn(k, k, |i, j| gram[(columns[i], columns[j])]);
            worth(own, DVector::from_fn(k, |i, _| product[columns[i]]), noise, nu)
        }
    }
}

fn gain_of<const K: usize>(
    gram: &DMatrix<f64>,
    product: &DVector<f64>,
    columns: &[usize],
    noise: f64,
    nu: f64,
) -> f64 {
    let own = SMatrix::<f64, K, K>::from_fn(|i, j| gram[(columns[i], columns[j])]);
    worth(own, SVector::<f64, K>::from_fn(|i, _| product[columns[i]]), noise, nu)
}

fn worth<D: Dim>(own: OMatrix<f64, D, D>, b: OVector<f64, D>, noise: f64, nu: f64) -> f64
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let mut left = noise;
    let mut last = None;
    for _ in 0..3 {
        let mut ridge = own.clone();
        (0..b.len()).for_each(|i| ridge[(i, i)] += left + 1e-9 * own[(i, i)]);
        let Some(root) = Cholesky::new(ridge) else { return f64::NEG_INFINITY };
        let explained = (b.dot(&root.solve(&b)) / (nu * noise)).clamp(0.0, 1.0 - 1e-9);
        last = Some((root, explained, left));
        left = (noise * (1.0 - explained)).max(f64::MIN_POSITIVE);
    }
    last.map_or(f64::NEG_INFINITY, |(root, explained, left)| {
        let lower = root.l_dirty();
        let determinant: f64 = (0..b.len()).map(|i| (lower[(i, i)] * lower[(i, i)] / left).ln()).sum();
        -0.5 * (nu * (-explained).ln_1p() + determinant)
    })
}
