//! Inner products between the columns of all candidates, computed when they are first asked for.
//!
//! A search adds, takes away and exchanges effects, and each time asks how every candidate goes with those that are there.
//! Where effects are linear the products of a candidate's columns with all others are the same each time, and are kept.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

/// Columns of all candidates, side by side, with their products with a residual.
pub struct Crossing {
    columns: DMatrix<f64>,
    ranges: Vec<Range<usize>>,
    grams: Vec<DMatrix<f64>>,
    /// For some candidates the products of their columns with all.
    kept: Mutex<BTreeMap<usize, Arc<DMatrix<f64>>>>,
}

impl Crossing {
    /// Of each candidate's columns, once `prepare` has prepared them.
    pub fn new(of: &[DMatrix<f64>], prepare: impl Fn(&DMatrix<f64>) -> DMatrix<f64>) -> Self {
        let rows = of.first().map_or(0, DMatrix::nrows);
        let mut columns = DMatrix::zeros(rows, of.iter().map(DMatrix::ncols).sum());
        let (mut ranges, mut grams, mut next) = (Vec::new(), Vec::new(), 0);
        for own in of {
            let own = prepare(own);
            grams.push(own.transpose() * &own);
            columns.columns_mut(next, own.ncols()).copy_from(&own);
            ranges.push(next..next + own.ncols());
            next += own.ncols();
        }
        Crossing { columns, ranges, grams, kept: Mutex::default() }
    }

    /// Which columns a candidate has.
    pub fn range(&self, candidate: usize) -> Range<usize> {
        self.ranges[candidate].clone()
    }

    /// Inner products of a candidate's columns.
    pub fn gram(&self, candidate: usize) -> &DMatrix<f64> {
        &self.grams[candidate]
    }

    /// Inner products of all columns with a vector.
    pub fn product(&self, v: &DVector<f64>) -> DVector<f64> {
        self.columns.tr_mul(v)
    }

    /// Inner products of other columns with all, one row for each of the others.
    pub fn with(&self, others: &DMatrix<f64>) -> DMatrix<f64> {
        others.transpose() * &self.columns
    }

    /// Inner products of the columns of some candidates with all, one row for each.
    pub fn of(&self, candidates: &[usize]) -> DMatrix<f64> {
        let count = candidates.iter().map(|&candidate| self.ranges[candidate].len()).sum();
        let mut rows = DMatrix::zeros(count, self.columns.ncols());
        let mut next = 0;
        for &candidate in candidates {
            let own = self.kept(candidate);
            rows.rows_mut(next, own.nrows()).copy_from(&own);
            next += own.nrows();
        }
        rows
    }

    fn kept(&self, candidate: usize) -> Arc<DMatrix<f64>> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let range = self.range(candidate);
        let products = || self.with(&self.columns.columns(range.start, range.len()).into_owned());
        kept.entry(candidate).or_insert_with(|| Arc::new(products())).clone()
    }
}
