//! Inner products between the columns of all candidates of a linear model, computed when they are
//! first asked for.
//!
//! A search adds, takes away and exchanges effects, and each time asks how every candidate goes
//! with those that are there. Where effects are linear the products of a candidate's columns with
//! all others are the same each time, and are kept.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::DMatrix;

use crate::inference::columns::table::{Table, stacked};

/// Products of the columns of an effect with those of all candidates.
type Kept = Arc<Table>;

/// Products of the candidates' columns with the residual, with the background and with each other.
pub struct GramCache {
    residual: Table,
    background: Table,
    effects: Mutex<Effects>,
}

/// Of effects, the oldest first in the order.
#[derive(Default)]
struct Effects {
    products: BTreeMap<usize, Kept>,
    order: VecDeque<usize>,
    size: usize,
}

/// Numbers of the products between effects that a search keeps: 16 MB.
const MOST: usize = 1 << 21;
/// Effects whose products it keeps however large they are: those of one hypothesis are asked for
/// again with each candidate.
const AT_LEAST: usize = 12;

impl GramCache {
    /// Of the candidates' products with residual and background.
    pub fn new(residual: Table, background: Table) -> Self {
        GramCache { residual, background, effects: Mutex::default() }
    }

    /// Products of the columns of some candidates with the residual.
    pub fn residual(&self, candidates: &[usize]) -> DMatrix<f64> {
        stacked(&[&self.residual], candidates)
    }

    /// Products of the columns of a hypothesis (rows: background, then each effect) with those of
    /// some candidates. `compute` gives those of an effect that is met for the first time.
    pub fn hypothesis<'a>(
        &'a self,
        effects: &[usize],
        compute: &dyn Fn(usize) -> Table,
    ) -> impl Fn(&[usize]) -> DMatrix<f64> + use<'a> {
        let kept = || self.effects.lock().unwrap_or_else(PoisonError::into_inner);
        let of_effect = |&effect: &usize| {
            let known = kept().products.get(&effect).cloned();
            known.unwrap_or_else(|| {
                // not while others wait
                let found: Kept = Arc::new(compute(effect));
                let mut kept = kept();
                kept.size += found.len();
                kept.order.push_back(effect);
                if let Some(same) = kept.products.insert(effect, Arc::clone(&found)) {
                    kept.size -= same.len();
                    kept.order.pop_back();
                }
                // what is asked for again is computed again
                while kept.size > MOST && kept.order.len() > AT_LEAST {
                    let oldest = kept.order.pop_front().and_then(|oldest| kept.products.remove(&oldest));
                    kept.size -= oldest.map_or(0, |oldest| oldest.len());
                }
                found
            })
        };
        let parts: Vec<Kept> = effects.iter().map(of_effect).collect();
        move |candidates| {
            let mut tables = vec![&self.background];
            tables.extend(parts.iter().map(Arc::as_ref));
            stacked(&tables, candidates)
        }
    }
}
