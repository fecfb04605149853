//! Inner products between the columns of all candidates of a linear model, computed when they are first asked for.
//!
//! A search adds, takes away and exchanges effects, and each time asks how every candidate goes with those that are there.
//! Where effects are linear the products of a candidate's columns with all others are the same each time, and are kept.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use super::sparse::Sparse;

/// For each candidate the products of some columns (rows) with its own (columns).
type Products = Arc<Vec<DMatrix<f64>>>;

/// Products of the candidates' columns with the residual, with the background and with each other.
pub struct GramCache {
    residual: Vec<DVector<f64>>,
    background: Vec<DMatrix<f64>>,
    effects: Mutex<BTreeMap<usize, Products>>,
}

impl GramCache {
    /// Of whitened `columns`; residual and background are whitened and projected.
    pub fn new(
        columns: &[(Sparse, DMatrix<f64>)],
        residual: &DVector<f64>,
        background: &DMatrix<f64>,
    ) -> Self {
        GramCache {
            residual: columns.iter().map(|(own, _)| own.tr_mul(residual)).collect(),
            background: columns.iter().map(|(own, _)| own.tr_mul_into(background)).collect(),
            effects: Mutex::default(),
        }
    }

    /// Products of a candidate's columns with the residual.
    pub fn residual(&self, candidate: usize) -> &DVector<f64> {
        &self.residual[candidate]
    }

    /// Products of the columns of a hypothesis (rows: background, then each effect) with those of a candidate. `compute` gives those
    /// of an effect that is met for the first time.
    pub fn hypothesis<'a>(
        &'a self,
        effects: &[usize],
        compute: &dyn Fn(usize) -> Vec<DMatrix<f64>>,
    ) -> impl Fn(usize) -> DMatrix<f64> + use<'a> {
        let mut kept = self.effects.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |&effect: &usize| kept.entry(effect).or_insert_with(|| Arc::new(compute(effect))).clone();
        let parts: Vec<Products> = effects.iter().map(of).collect();
        move |candidate| {
            let background = &self.background[candidate];
            let rows = background.nrows() + parts.iter().map(|part| part[candidate].nrows()).sum::<usize>();
            let mut all = DMatrix::zeros(rows, background.ncols());
            let mut next = 0;
            for part in std::iter::once(background).chain(parts.iter().map(|part| &part[candidate])) {
                all.rows_mut(next, part.nrows()).copy_from(part);
                next += part.nrows();
            }
            all
        }
    }
}
