//! A model with its columns at neutral values at hand, whole or of some of the data.

use nalgebra::{DMatrix, DVector};

use super::{
    Candidate, Description, Estimate, Finding, FindingPart, ForwardModel, Hypothesis, Location, Term,
};

/// A model of which the linear part is computed once.
pub struct Linearised<'a> {
    model: &'a dyn ForwardModel,
    /// Each candidate's [`ForwardModel::columns`] at its neutral values, alone.
    pub neutral: Vec<DMatrix<f64>>,
    /// The data, where these are not all.
    rows: Option<&'a [usize]>,
}

impl<'a> Linearised<'a> {
    /// Of all data.
    pub fn new(model: &'a dyn ForwardModel) -> Self {
        let of = |(index, candidate): (usize, &Candidate)| model.columns(&[candidate.neutral(index)], 0);
        Linearised { model, neutral: model.candidates().iter().enumerate().map(of).collect(), rows: None }
    }

    /// Of the data `rows`.
    pub fn part(&self, rows: &'a [usize]) -> Linearised<'a> {
        let neutral = self.neutral.iter().map(|columns| columns.select_rows(rows)).collect();
        Linearised { model: self.model, neutral, rows: Some(rows) }
    }
}

impl ForwardModel for Linearised<'_> {
    fn candidates(&self) -> &[Candidate] {
        self.model.candidates()
    }

    fn response(&self, hypothesis: &[Term]) -> DVector<f64> {
        let whole = self.model.response(hypothesis);
        match self.rows {
            Some(rows) => whole.select_rows(rows),
            None => whole,
        }
    }

    fn is_linear(&self) -> bool {
        self.model.is_linear()
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
