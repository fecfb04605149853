//! Products of a linear model's columns over the parts of a recording, computed once for all
//! searches that leave one part out.
//!
//! What a search over the data T needs of a candidate's columns C is, with N, B and r the nuisance,
//! the background and the residual, Q = N·A an orthonormal basis of the nuisance and M = 1 − Q·Qᵀ,
//!
//! ```text
//! QᵀC = Aᵀ·(NᵀC)     CᵀMC = CᵀC − (QᵀC)ᵀQᵀC     BᵀMC = BᵀC − (QᵀB)ᵀQᵀC     rᵀMC alike
//! ```
//!
//! where NᵀC, CᵀC, BᵀC and rᵀC are sums over the parts that T holds. No column is copied for a
//! fold.
//!
//! Where neighbours have errors in common the parts are not apart, and each search whitens its own
//! data:
//!
//! ```text
//! (W·v)ᵀ(W·C) = (Wᵀ·W·v)ᵀC      for few vectors v, and CᵀWᵀWC candidate by candidate
//! ```

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::stored_column::{DataParts, StoredColumn, dense, fit, grams, products};
use crate::inference::columns::table::Table;
use crate::inference::noise::whitening::Whitening;
use crate::inference::{Evidence, ForwardModel};
use crate::linalg::transposed_product;
use crate::parallel::in_parallel;

/// Numbers of the products between candidates that are kept: 32 MB.
const KEPT: usize = 1 << 22;

/// Of all candidates over all parts of a recording.
pub struct PartProducts<'a> {
    columns: Vec<StoredColumn<'a>>,
    /// The first column of each candidate, and the number of all.
    first: Arc<[usize]>,
    /// Numbers of the parts as the evidence has them.
    names: Vec<usize>,
    parts: DataParts,
    /// CᵀC of each candidate, in each part.
    grams: Vec<Vec<DMatrix<f64>>>,
    /// NᵀC, BᵀC and rᵀC, one below the other, of each part.
    beside: Vec<DMatrix<f64>>,
    /// How many columns N and B have.
    counts: (usize, usize),
    /// The data themselves, N, B and r, where neighbours have errors in common: nothing is summed
    /// over parts then.
    correlated: Option<DMatrix<f64>>,
    between: Mutex<Between>,
}

/// CₑᵀC of candidates e with all columns, of each part.
#[derive(Default)]
struct Between {
    /// The oldest first.
    order: VecDeque<usize>,
    size: usize,
    products: BTreeMap<usize, Arc<Vec<DMatrix<f64>>>>,
}

/// What a search over some of the parts needs.
pub struct Training<'a> {
    all: Arc<PartProducts<'a>>,
    /// The parts that it holds.
    held: Vec<usize>,
    /// QᵀC.
    absorbed: DMatrix<f64>,
    /// Where neighbours have errors in common.
    own: Option<Whitened>,
}

/// The data of a search whose errors are not independent.
struct Whitened {
    whitening: Whitening,
    /// Their numbers among all data.
    rows: Vec<usize>,
    /// NᵀWᵀWC, BᵀWᵀWC and rᵀWᵀWC, one below the other.
    beside: DMatrix<f64>,
}

impl<'a> PartProducts<'a> {
    /// By the number of each datum's part in the evidence. `None` for a model that is not linear,
    /// and where data are weighed or share errors.
    pub fn new(model: &'a dyn ForwardModel, evidence: &Evidence, part: &[usize]) -> Option<PartProducts<'a>> {
        if !model.is_linear() || !evidence.is_even() {
            return None;
        }
        let mut names = part.to_vec();
        names.sort_unstable();
        names.dedup();
        let own = part.iter().map(|name| names.binary_search(name).unwrap_or_default());
        let parts = DataParts::new(own.collect());
        let (mut columns, mut first) = (Vec::new(), vec![0]);
        for candidate in 0..model.candidates().len() {
            columns.extend(model.stored(candidate));
            first.push(columns.len());
        }
        let first: Arc<[usize]> = first.into();
        if !fit(&columns, &parts) {
            return None;
        }
        let counts = (evidence.nuisance.ncols(), evidence.background.ncols());
        let mut beside = DMatrix::zeros(evidence.residual.len(), counts.0 + counts.1 + 1);
        beside.columns_mut(0, counts.0).copy_from(&evidence.nuisance);
        beside.columns_mut(counts.0, counts.1).copy_from(&evidence.background);
        beside.set_column(counts.0 + counts.1, &evidence.residual);
        if evidence.correlated_noise.is_some() {
            let (grams, between, correlated) = (Vec::new(), Mutex::default(), Some(beside));
            let beside = Vec::new();
            return Some(PartProducts {
                grams,
                beside,
                columns,
                first,
                names,
                parts,
                counts,
                correlated,
                between,
            });
        }
        let of_candidate = |candidate: usize| grams(&columns[first[candidate]..first[candidate + 1]], &parts);
        let grams = in_parallel(first.len() - 1, of_candidate);
        let beside = products(&columns, &beside, &parts);
        let (correlated, between) = (None, Mutex::default());
        Some(PartProducts { grams, beside, columns, first, names, parts, counts, correlated, between })
    }

    /// Products of a candidate's columns with all, of each part.
    fn between(&self, candidate: usize) -> Arc<Vec<DMatrix<f64>>> {
        let known = |kept: &Between| kept.products.get(&candidate).cloned();
        if let Some(known) = known(&self.between.lock().unwrap_or_else(PoisonError::into_inner)) {
            return known;
        }
        let own = self.of(candidate);
        let found = Arc::new(products(&self.columns, &dense(own, self.parts.count()), &self.parts));
        let mut kept = self.between.lock().unwrap_or_else(PoisonError::into_inner);
        let size = |found: &[DMatrix<f64>]| found.iter().map(DMatrix::len).sum::<usize>();
        kept.size += size(&found);
        kept.order.push_back(candidate);
        if let Some(same) = kept.products.insert(candidate, Arc::clone(&found)) {
            kept.size -= size(&same);
            kept.order.pop_back();
        }
        // what is asked for again is computed again
        while kept.size > KEPT && kept.order.len() > 1 {
            let oldest = kept.order.pop_front().and_then(|oldest| kept.products.remove(&oldest));
            kept.size -= oldest.map_or(0, |oldest| size(&oldest));
        }
        found
    }

    /// The data of these parts, ascending.
    fn rows(&self, held: &[usize]) -> Vec<usize> {
        (0..self.parts.count()).filter(|&datum| held.contains(&self.parts.part_of(datum))).collect()
    }

    fn of(&self, candidate: usize) -> &[StoredColumn<'a>] {
        &self.columns[self.first[candidate]..self.first[candidate + 1]]
    }
}

impl Whitened {
    /// Columns of these data, whitened.
    fn whitened(&self, columns: &[StoredColumn<'_>], count: usize) -> DMatrix<f64> {
        self.whitening.whitened_columns(&dense(columns, count).select_rows(&self.rows))
    }

    /// Products of whitened vectors (rows) with all columns.
    fn products(&self, all: &PartProducts<'_>, whitened: &DMatrix<f64>) -> DMatrix<f64> {
        let count = all.parts.count();
        let mut vectors = DMatrix::zeros(count, whitened.ncols());
        let back = self.whitening.transposed(whitened);
        for (own, &row) in back.row_iter().zip(&self.rows) {
            vectors.set_row(row, &own);
        }
        let found = products(&all.columns, &vectors, &DataParts::whole(count)).pop();
        found.unwrap_or_else(|| DMatrix::zeros(whitened.ncols(), all.columns.len()))
    }
}

impl<'a> Training<'a> {
    /// Without one part, or with all of them; `whitening` is that of what is left.
    pub fn new(all: &Arc<PartProducts<'a>>, left_out: Option<usize>, whitening: &Whitening) -> Training<'a> {
        let held: Vec<usize> = (0..all.names.len()).filter(|&k| Some(all.names[k]) != left_out).collect();
        if let Some(data) = &all.correlated {
            let rows = all.rows(&held);
            let whitened = whitening.whitened_columns(&data.select_rows(&rows));
            let own = Whitened { whitening: whitening.clone(), beside: DMatrix::zeros(0, 0), rows };
            let beside = own.products(all, &whitened);
            let absorbed = own.products(all, &whitening.basis());
            return Training { all: Arc::clone(all), held, absorbed, own: Some(Whitened { beside, ..own }) };
        }
        let mut along = DMatrix::zeros(all.counts.0, all.columns.len());
        held.iter().for_each(|&part| along += all.beside[part].rows(0, all.counts.0));
        let absorbed = whitening.coefficients().tr_mul(&along);
        Training { all: Arc::clone(all), held, absorbed, own: None }
    }

    /// CᵀMC of each candidate.
    pub fn grams(&self) -> Vec<DMatrix<f64>> {
        if let Some(data) = &self.own {
            let gram = |candidate: usize| {
                let absorbed = self.own(candidate);
                let whitened = data.whitened(self.all.of(candidate), self.all.parts.count());
                transposed_product(&whitened, &whitened) - absorbed.tr_mul(&absorbed)
            };
            return in_parallel(self.all.first.len() - 1, gram);
        }
        let gram = |candidate: usize| {
            let own = self.own(candidate);
            let mut sum = -own.tr_mul(&own);
            self.held.iter().for_each(|&part| sum += &self.all.grams[candidate][part]);
            sum
        };
        (0..self.all.first.len() - 1).map(gram).collect()
    }

    /// BᵀMC of all candidates, `of_background` being QᵀB.
    pub fn beside_background(&self, of_background: &DMatrix<f64>) -> Table {
        let (first, count) = self.all.counts;
        self.beside(first, count, of_background)
    }

    /// rᵀMC of all candidates, `of_residual` being Qᵀr.
    pub fn beside_residual(&self, of_residual: &DVector<f64>) -> Table {
        let (nuisance, background) = self.all.counts;
        let along = DMatrix::from_column_slice(of_residual.len(), 1, of_residual.as_slice());
        self.beside(nuisance + background, 1, &along)
    }

    fn beside(&self, first: usize, count: usize, along: &DMatrix<f64>) -> Table {
        let mut sum = -along.tr_mul(&self.absorbed);
        if let Some(data) = &self.own {
            return self.table(sum + data.beside.rows(first, count));
        }
        self.held.iter().for_each(|&part| sum += self.all.beside[part].rows(first, count));
        self.table(sum)
    }

    /// CₑᵀMC of a candidate e with all candidates.
    pub fn between(&self, candidate: usize) -> Table {
        let mut sum = -self.own(candidate).tr_mul(&self.absorbed);
        if let Some(data) = &self.own {
            let whitened = data.whitened(self.all.of(candidate), self.all.parts.count());
            return self.table(sum + data.products(&self.all, &whitened));
        }
        let between = self.all.between(candidate);
        self.held.iter().for_each(|&part| sum += &between[part]);
        self.table(sum)
    }

    fn own(&self, candidate: usize) -> DMatrix<f64> {
        let (first, next) = (self.all.first[candidate], self.all.first[candidate + 1]);
        self.absorbed.columns(first, next - first).into_owned()
    }

    fn table(&self, all: DMatrix<f64>) -> Table {
        Table::new(Arc::clone(&self.all.first), all)
    }
}
