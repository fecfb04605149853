//! Inner products between the columns of all candidates of a linear model, computed when they are
//! first asked for.
//!
//! A search adds, takes away and exchanges effects, and each time asks how every candidate goes
//! with those that are there. Where effects are linear the products of a candidate's columns with
//! all others are the same each time, and are kept.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use super::columns::Table;

/// For each candidate the products of some columns (rows) with its own (columns).
type Kept = Arc<Vec<DMatrix<f64>>>;

/// Products of the candidates' columns with the residual, with the background and with each other.
pub struct GramCache {
    residual: Vec<DVector<f64>>,
    background: Vec<DMatrix<f64>>,
    effects: Mutex<Effects>,
}

/// Of effects, the oldest first in the order.
#[derive(Default)]
struct Effects {
    of: BTreeMap<usize, Kept>,
    order: VecDeque<usize>,
    size: usize,
}

/// Numbers of the products between effects that a search keeps: 16 MB.
const MOST: usize = 1 << 21;

impl GramCache {
    /// Of `count` candidates, by their products with residual and background.
    pub(super) fn new(count: usize, residual: &Table<'_>, background: &Table<'_>) -> Self {
        GramCache {
            residual: (0..count).map(|candidate| residual.of(candidate).row(0).transpose()).collect(),
            background: (0..count).map(|candidate| background.of(candidate)).collect(),
            effects: Mutex::default(),
        }
    }

    /// Of the products of each candidate with residual and background.
    pub(super) fn of_products(residual: Vec<DVector<f64>>, background: Vec<DMatrix<f64>>) -> Self {
        GramCache { residual, background, effects: Mutex::default() }
    }

    /// Products of a candidate's columns with the residual.
    pub fn residual(&self, candidate: usize) -> &DVector<f64> {
        &self.residual[candidate]
    }

    /// Products of the columns of a hypothesis (rows: background, then each effect) with those of a
    /// candidate. `compute` gives those of an effect that is met for the first time.
    pub fn hypothesis<'a>(
        &'a self,
        effects: &[usize],
        compute: &dyn Fn(usize) -> Vec<DMatrix<f64>>,
    ) -> impl Fn(usize) -> DMatrix<f64> + use<'a> {
        let kept = || self.effects.lock().unwrap_or_else(PoisonError::into_inner);
        let size = |kept: &Kept| kept.iter().map(DMatrix::len).sum::<usize>();
        let of = |&effect: &usize| {
            let known = kept().of.get(&effect).cloned();
            known.unwrap_or_else(|| {
                // not while others wait
                let found: Kept = Arc::new(compute(effect));
                let mut kept = kept();
                kept.size += size(&found);
                kept.order.push_back(effect);
                if let Some(same) = kept.of.insert(effect, Arc::clone(&found)) {
                    kept.size -= size(&same);
                    kept.order.pop_back();
                }
                // what is asked for again is computed again
                while kept.size > MOST && kept.order.len() > 1 {
                    let oldest = kept.order.pop_front().and_then(|oldest| kept.of.remove(&oldest));
                    kept.size -= oldest.map_or(0, |oldest| size(&oldest));
                }
                found
            })
        };
        let parts: Vec<Kept> = effects.iter().map(of).collect();
        move |candidate| {
            let parts = parts.iter().map(|part| &part[candidate]);
            stacked(&self.background[candidate], parts)
        }
    }
}

/// Blocks of as many columns, one below the other.
pub(super) fn stacked<'a>(
    first: &'a DMatrix<f64>,
    others: impl Iterator<Item = &'a DMatrix<f64>> + Clone,
) -> DMatrix<f64> {
    let all = || std::iter::once(first).chain(others.clone());
    let mut stacked = DMatrix::zeros(all().map(DMatrix::nrows).sum(), first.ncols());
    let mut next = 0;
    for part in all() {
        stacked.rows_mut(next, part.nrows()).copy_from(part);
        next += part.nrows();
    }
    stacked
}
