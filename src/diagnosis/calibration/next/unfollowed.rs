//! What one hypothesis predicts and another cannot follow, whatever its numbers: ‖M_B·ηA‖².
//!
//! Predictions are linear, ηA = C·a, C all columns once the nuisance is taken out of them. With
//! their inner products G = CᵀC,
//!
//! ‖M_B·ηA‖² = aᵀGa − (G_B·a)ᵀ·G_BB⁻¹·(G_B·a),
//!
//! so that G, which is the same for all pairs of hypotheses, is all that is computed from the data.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::super::model::LinearTerms;
use crate::inference::{Evidence, Term, Whitening};
use crate::linalg::transposed_product;

/// Share of a column's square that rounding leaves where the others make it.
const ROUNDING: f64 = 1e-13;

/// The columns of some candidates beside what a calibration absorbs.
pub struct Unfollowed<'a> {
    pub terms: &'a LinearTerms,
    /// First column of each candidate.
    first: BTreeMap<usize, usize>,
    /// G, m².
    gram: DMatrix<f64>,
    /// Squares of the columns before anything was taken out of them, m².
    squares: Vec<f64>,
}

impl<'a> Unfollowed<'a> {
    /// Of `candidates`, beside the nuisance of `evidence`.
    pub fn new(terms: &'a LinearTerms, evidence: &Evidence, candidates: impl Iterator<Item = usize>) -> Self {
        let mut first: BTreeMap<usize, usize> = candidates.map(|candidate| (candidate, 0)).collect();
        let mut columns = Vec::new();
        for (&candidate, first) in &mut first {
            *first = columns.len();
            columns.extend(terms.columns(candidate).column_iter().map(|column| column.into_owned()));
        }
        let columns = match columns.is_empty() {
            true => DMatrix::zeros(evidence.residual.len(), 0),
            false => DMatrix::from_columns(&columns),
        };
        let whitening = Whitening::new(evidence, &evidence.residual);
        let whitened = whitening.whitened_columns(&columns);
        let squares = whitened.column_iter().map(|column| column.norm_squared()).collect();
        let projected = whitening.apply_columns(&columns);
        Unfollowed { terms, first, squares, gram: transposed_product(&projected, &projected) }
    }

    /// ‖M_B·ηA‖², m², of candidates that this was made for.
    pub fn of(&self, a: &[Term], b: &[Term]) -> f64 {
        let counts = self.counts(a);
        let mut along = &self.gram * &counts;
        let mut left = counts.dot(&along);
        let own: Vec<usize> = b.iter().flat_map(|term| self.positions(term)).collect();
        let mut gram = self.gram.select_rows(&own).select_columns(&own);
        along = along.select_rows(&own);
        // Gauss, one column after the other; what those before it make is none
        for (k, &column) in own.iter().enumerate() {
            let pivot = gram[(k, k)];
            if pivot <= ROUNDING * self.squares[column] {
                continue;
            }
            left -= along[k].powi(2) / pivot;
            let row: Vec<f64> = gram.column(k).rows_range(k + 1..).iter().copied().collect();
            for (i, shared) in row.iter().enumerate() {
                let share = shared / pivot;
                along[k + 1 + i] -= share * along[k];
                let mut below = gram.column_mut(k + 1 + i);
                below
                    .rows_range_mut(k + 1 + i..)
                    .iter_mut()
                    .zip(&row[i..])
                    .for_each(|(g, r)| *g -= share * r);
            }
        }
        left.max(0.0)
    }

    /// a: how often each column stands in what the terms predict.
    fn counts(&self, terms: &[Term]) -> DVector<f64> {
        let mut counts = DVector::zeros(self.squares.len());
        for term in terms {
            let known = &self.terms.candidates[term.candidate].parameters;
            for ((column, value), known) in self.positions(term).zip(&term.values).zip(known) {
                counts[column] += (value - known.neutral) / known.size;
            }
        }
        counts
    }

    fn positions(&self, term: &Term) -> std::ops::Range<usize> {
        let first = self.first[&term.candidate];
        first..first + self.terms.candidates[term.candidate].parameters.len()
    }
}
