//! The columns of all candidates at their neutral values, each stored as small as it is.
//!
//! A recording of n data has a column for each of some hundred parameters, and a step may be
//! anywhere. Most columns are the same for all data of a case (one load, one channel), however
//! often it was recorded; a step is two numbers. With W what whitens, the inner product of a column
//! c with a whitened vector v is
//!
//! ```text
//! (W·c)ᵀv = cᵀu,   u = Wᵀv      of a case: Σ over its data of u      of a step: Σ of u from its place on
//! ```
//!
//! so that all products with v take one pass over u, and nothing is whitened but v.

pub(in crate::inference) mod background;
pub(in crate::inference) mod fit_cache;
pub(in crate::inference) mod gram_cache;
pub(in crate::inference) mod linearised;
pub(in crate::inference) mod part_products;
pub(in crate::inference) mod stored_column;
pub(in crate::inference) mod table;

#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;

use crate::inference::columns::table::Table;
use crate::inference::{Candidate, ForwardModel};
use crate::linalg::transposed_product;
use crate::parallel::checkpoint;

/// Share of a column that is not zero from which on it is stored whole.
const DENSE: f64 = 0.5;
/// Numbers of the vectors that products are computed for at once.
const AT_ONCE: usize = 1 << 20;

/// Columns ∂response/∂parameter times the size of the parameter, of n data.
pub struct Columns {
    data: usize,
    /// Case of each datum; nothing where no two data are alike.
    cases: Vec<usize>,
    /// n × those that are stored whole.
    whole: DMatrix<f64>,
    /// Cases × those that are the same for all data of a case.
    by_case: DMatrix<f64>,
    listed: Vec<Vec<(usize, f64)>>,
    sequences: Vec<Arc<[usize]>>,
    columns: Vec<Column>,
    /// The first column of each candidate, and the number of all.
    first: Arc<[usize]>,
}

#[derive(Debug, Clone, Copy)]
enum Column {
    Whole(usize),
    ByCase(usize),
    Listed(usize),
    /// From this datum of a sequence on.
    Step {
        sequence: usize,
        from: usize,
        size: f64,
    },
}

/// Inner products of all columns with some vectors.
pub struct Products<'a> {
    columns: &'a Columns,
    vectors: DMatrix<f64>,
    /// Vectors × columns, as these are stored.
    whole: DMatrix<f64>,
    by_case: DMatrix<f64>,
    /// Of each sequence: vectors × its data, the sums from a datum on; computed when they are first
    /// asked for.
    sums: OnceLock<Vec<DMatrix<f64>>>,
}

impl Columns {
    /// Of all candidates of a model.
    pub fn new(model: &dyn ForwardModel) -> Columns {
        let cases = model.cases();
        let mut building = Building {
            first_of_case: firsts(cases),
            cases,
            whole: Vec::new(),
            by_case: Vec::new(),
            listed: Vec::new(),
            sequences: Vec::new(),
            known: HashMap::new(),
            columns: Vec::new(),
        };
        let (mut first, data) = (vec![0], model.response(&[]).len());
        for (index, candidate) in model.candidates().iter().enumerate() {
            match model.step(index) {
                Some(step) => building.add_step(candidate, &step),
                None => {
                    let columns = model.columns(&[candidate.neutral(index)], 0);
                    columns.column_iter().for_each(|column| building.add(column.as_slice()));
                }
            }
            first.push(building.columns.len());
        }
        let cases_count = building.first_of_case.len();
        let (whole, by_case) = (building.whole.len(), building.by_case.len());
        Columns {
            data,
            cases: cases.to_vec(),
            whole: DMatrix::from_vec(data, whole / data.max(1), building.whole),
            by_case: DMatrix::from_vec(cases_count, by_case / cases_count.max(1), building.by_case),
            listed: building.listed,
            sequences: building.sequences,
            columns: building.columns,
            first: first.into(),
        }
    }

    /// How many data there are.
    pub fn data(&self) -> usize {
        self.data
    }

    /// Of one candidate, `rows` of the data or all of them.
    pub fn dense(&self, candidate: usize, rows: Option<&[usize]>) -> DMatrix<f64> {
        checkpoint();
        let own = self.own(candidate);
        let mut dense = DMatrix::zeros(self.data, own.len());
        for (column, mut dense) in own.iter().zip(dense.column_iter_mut()) {
            match *column {
                Column::Whole(k) => dense.copy_from(&self.whole.column(k)),
                Column::ByCase(k) => {
                    let of_case = self.by_case.column(k);
                    dense.iter_mut().zip(&self.cases).for_each(|(value, &case)| *value = of_case[case]);
                }
                Column::Listed(k) => self.listed[k].iter().for_each(|&(row, value)| dense[row] = value),
                Column::Step { sequence, from, size } => {
                    self.sequences[sequence][from..].iter().for_each(|&row| dense[row] = size);
                }
            }
        }
        match rows {
            Some(rows) => dense.select_rows(rows),
            None => dense,
        }
    }

    /// cᵀu of every column with every column u of `vectors`, which have the data `rows` only, or
    /// all.
    pub fn products(&self, vectors: DMatrix<f64>, rows: Option<&[usize]>) -> Products<'_> {
        let vectors = match rows {
            None => vectors,
            Some(rows) => {
                let mut all = DMatrix::zeros(self.data, vectors.ncols());
                for (mut all, own) in all.column_iter_mut().zip(vectors.column_iter()) {
                    rows.iter().zip(own.iter()).for_each(|(&row, value)| all[row] = *value);
                }
                all
            }
        };
        let mut by_case = DMatrix::zeros(self.by_case.nrows(), vectors.ncols());
        for (vector, mut sums) in vectors.column_iter().zip(by_case.column_iter_mut()) {
            vector.iter().zip(&self.cases).for_each(|(value, &case)| sums[case] += value);
        }
        Products {
            columns: self,
            whole: transposed_product(&vectors, &self.whole),
            by_case: transposed_product(&by_case, &self.by_case),
            sums: OnceLock::new(),
            vectors,
        }
    }

    /// The same for many vectors, some at a time, lest all that is computed for them stands in
    /// memory.
    pub fn table(&self, vectors: &DMatrix<f64>, rows: Option<&[usize]>) -> Table {
        let at_once = (AT_ONCE / self.data.max(1)).max(1);
        let mut all = DMatrix::zeros(vectors.ncols(), self.columns.len());
        for first in (0..vectors.ncols()).step_by(at_once) {
            let count = at_once.min(vectors.ncols() - first);
            let products = self.products(vectors.columns(first, count).into_owned(), rows);
            for candidate in 0..self.first.len() - 1 {
                let own = products.of(candidate);
                all.view_mut((first, self.first[candidate]), own.shape()).copy_from(&own);
            }
        }
        Table::new(Arc::clone(&self.first), all)
    }

    /// The square of a candidate that is a step, by the `squares` of steps of size 1 at each datum
    /// of each sequence.
    pub fn square_of_step(&self, candidate: usize, squares: &[Vec<f64>]) -> Option<f64> {
        match *self.own(candidate) {
            [Column::Step { sequence, from, size }] => {
                Some(size * size * squares.get(sequence)?.get(from).copied().unwrap_or(0.0))
            }
            _ => None,
        }
    }

    /// How many data two candidates are apart that are steps of one sequence.
    pub fn steps_apart(&self, one: usize, other: usize) -> Option<usize> {
        match (self.own(one), self.own(other)) {
            (
                [Column::Step { sequence: a, from: first, .. }],
                [Column::Step { sequence: b, from: second, .. }],
            ) if a == b => Some(first.abs_diff(*second)),
            _ => None,
        }
    }

    /// The sequences that steps may be in.
    pub fn sequences(&self) -> &[Arc<[usize]>] {
        &self.sequences
    }

    fn own(&self, candidate: usize) -> &[Column] {
        &self.columns[self.first[candidate]..self.first[candidate + 1]]
    }
}

impl Products<'_> {
    fn sums(&self) -> Vec<DMatrix<f64>> {
        let of_sequence = |sequence: &Arc<[usize]>| {
            let mut sums = DMatrix::zeros(self.vectors.ncols(), sequence.len());
            for (j, vector) in self.vectors.column_iter().enumerate() {
                let mut sum = 0.0;
                for (k, &row) in sequence.iter().enumerate().rev() {
                    sum += vector[row];
                    sums[(j, k)] = sum;
                }
            }
            sums
        };
        self.columns.sequences.iter().map(of_sequence).collect()
    }

    /// Vectors × columns of a candidate.
    pub fn of(&self, candidate: usize) -> DMatrix<f64> {
        let own = self.columns.own(candidate);
        let mut products = DMatrix::zeros(self.whole.nrows(), own.len());
        for (column, mut product) in own.iter().zip(products.column_iter_mut()) {
            match *column {
                Column::Whole(k) => product.copy_from(&self.whole.column(k)),
                Column::ByCase(k) => product.copy_from(&self.by_case.column(k)),
                Column::Listed(k) => {
                    for (product, vector) in product.iter_mut().zip(self.vectors.column_iter()) {
                        *product = self.columns.listed[k].iter().map(|&(row, x)| x * vector[row]).sum();
                    }
                }
                Column::Step { sequence, from, size } => {
                    let sums = &self.sums.get_or_init(|| self.sums())[sequence];
                    if from < sums.ncols() {
                        product.copy_from(&(sums.column(from) * size));
                    }
                }
            }
        }
        products
    }
}

/// Columns while they are sorted by how they are stored.
struct Building<'a> {
    cases: &'a [usize],
    first_of_case: Vec<usize>,
    whole: Vec<f64>,
    by_case: Vec<f64>,
    listed: Vec<Vec<(usize, f64)>>,
    sequences: Vec<Arc<[usize]>>,
    /// Number of each sequence by where it is in memory.
    known: HashMap<*const usize, usize>,
    columns: Vec<Column>,
}

impl Building<'_> {
    fn add_step(&mut self, candidate: &Candidate, step: &crate::inference::Step) {
        let next = self.sequences.len();
        let sequence = *self.known.entry(step.data.as_ptr()).or_insert(next);
        if sequence == next {
            self.sequences.push(Arc::clone(&step.data));
        }
        let size = candidate.parameters.first().map_or(0.0, |parameter| parameter.size);
        self.columns.push(Column::Step { sequence, from: step.from, size });
    }

    fn add(&mut self, column: &[f64]) {
        let is_by_case = !self.cases.is_empty()
            && column.iter().zip(self.cases).all(|(x, &case)| *x == column[self.first_of_case[case]]);
        let count = column.iter().filter(|x| **x != 0.0).count();
        let own = if is_by_case {
            self.by_case.extend(self.first_of_case.iter().map(|&row| column[row]));
            Column::ByCase(self.by_case.len() / self.first_of_case.len() - 1)
        } else if count as f64 > DENSE * column.len() as f64 {
            self.whole.extend(column);
            Column::Whole(self.whole.len() / column.len() - 1)
        } else {
            self.listed.push(column.iter().copied().enumerate().filter(|(_, x)| *x != 0.0).collect());
            Column::Listed(self.listed.len() - 1)
        };
        self.columns.push(own);
    }
}

/// The first datum of each case.
fn firsts(cases: &[usize]) -> Vec<usize> {
    let mut first = Vec::new();
    for (row, &case) in cases.iter().enumerate() {
        if case == first.len() {
            first.push(row);
        }
    }
    first
}
