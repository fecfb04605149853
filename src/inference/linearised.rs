//! A model with its columns at neutral values at hand, whole or of some of the data.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::columns::{Columns, Products, Table};
use super::{
    Candidate, Description, Estimate, Finding, FindingPart, ForwardModel, Hypothesis, Location, Term,
};

/// A model of which the linear part is computed once.
pub struct Linearised<'a> {
    model: &'a dyn ForwardModel,
    /// Each candidate's [`ForwardModel::columns`] at its neutral values, alone; of all data, whatever `rows` are.
    columns: Arc<Columns>,
    /// The data, where these are not all.
    rows: Option<&'a [usize]>,
}

impl<'a> Linearised<'a> {
    /// Of all data.
    pub fn new(model: &'a dyn ForwardModel) -> Self {
        Linearised { model, columns: Arc::new(Columns::new(model)), rows: None }
    }

    /// Of the data `rows`.
    pub fn part(&self, rows: &'a [usize]) -> Linearised<'a> {
        Linearised { model: self.model, columns: Arc::clone(&self.columns), rows: Some(rows) }
    }

    /// A candidate's columns at its neutral values.
    pub(super) fn neutral(&self, candidate: usize) -> DMatrix<f64> {
        self.columns.dense(candidate, self.rows)
    }

    /// Inner products of all candidates' columns at neutral values with some vectors.
    pub(super) fn products(&self, vectors: DMatrix<f64>) -> Products<'_> {
        self.columns.products(vectors, self.rows)
    }

    /// The same for many vectors, to be kept.
    pub(super) fn table(&self, vectors: &DMatrix<f64>) -> Table<'_> {
        self.columns.table(vectors, self.rows)
    }

    /// All of these columns.
    pub(super) fn stored(&self) -> &Columns {
        &self.columns
    }

    /// The sequences that steps may be in, by the numbers that their data have here; `None` for those that are left out.
    pub(super) fn sequences(&self) -> Vec<Vec<Option<usize>>> {
        let mut place: Vec<Option<usize>> = Vec::new();
        if let Some(rows) = self.rows {
            place.resize(self.columns.data(), None);
            rows.iter().enumerate().for_each(|(own, &row)| place[row] = Some(own));
        }
        let own = |&row: &usize| if self.rows.is_some() { place[row] } else { Some(row) };
        self.columns.sequences().iter().map(|sequence| sequence.iter().map(own).collect()).collect()
    }

    fn own(&self, whole: DVector<f64>) -> DVector<f64> {
        match self.rows {
            Some(rows) => whole.select_rows(rows),
            None => whole,
        }
    }
}

impl ForwardModel for Linearised<'_> {
    fn candidates(&self) -> &[Candidate] {
        self.model.candidates()
    }

    fn response(&self, hypothesis: &[Term]) -> DVector<f64> {
        self.own(self.model.response(hypothesis))
    }

    fn is_linear(&self) -> bool {
        self.model.is_linear()
    }

    fn is_linear_in(&self, terms: &[Term]) -> bool {
        self.model.is_linear_in(terms)
    }

    fn location(&self, term: &Term) -> Location {
        self.model.location(term)
    }

    fn estimates(&self, parts: &[FindingPart], hypothesis: &Hypothesis) -> Vec<Estimate> {
        self.model.estimates(parts, hypothesis)
    }

    fn describe(&self, finding: &Finding) -> Description {
        self.model.describe(finding)
    }

    fn columns(&self, hypothesis: &[Term], position: usize) -> DMatrix<f64> {
        let whole = self.model.columns(hypothesis, position);
        match self.rows {
            Some(rows) => whole.select_rows(rows),
            None => whole,
        }
    }
}
