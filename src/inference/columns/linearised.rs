//! A model with its columns at neutral values at hand, whole or of some of the data.

use std::sync::{Arc, OnceLock};

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::part_products::{PartProducts, Training};
use crate::inference::columns::stored_column::dense;
use crate::inference::columns::table::Table;
use crate::inference::columns::{Columns, Products};
use crate::inference::noise::whitening::Whitening;
use crate::inference::{
    Candidate, Description, Estimate, Evidence, Finding, FindingPart, ForwardModel, Hypothesis, Location,
    Step, Term,
};

/// A model of which the linear part is computed once.
pub struct Linearised<'a> {
    model: &'a dyn ForwardModel,
    /// Each candidate's [`ForwardModel::columns`] at its neutral values, alone; of all data,
    /// whatever `rows` are. Found when they are first asked for: a linear model needs only what is
    /// in `parts`.
    columns: Arc<OnceLock<Columns>>,
    /// Products of a linear model's columns over parts of the data, and the part that is left out.
    parts: Option<(Arc<PartProducts<'a>>, Option<usize>)>,
    /// The data, where these are not all.
    rows: Option<&'a [usize]>,
}

impl<'a> Linearised<'a> {
    /// Of all data.
    pub fn new(model: &'a dyn ForwardModel) -> Self {
        let columns = OnceLock::new();
        // others wait for what is found among parallel jobs
        if !model.is_linear() {
            columns.get_or_init(|| Columns::new(model));
        }
        Linearised { model, columns: Arc::new(columns), parts: None, rows: None }
    }

    /// With what searches share that leave one of these parts of an evidence out, where the model
    /// is linear.
    pub fn in_parts(&self, evidence: &Evidence, part: &[usize]) -> Linearised<'a> {
        let parts = PartProducts::new(self.model, evidence, part);
        let parts = parts.map(|parts| (Arc::new(parts), None));
        Linearised { model: self.model, columns: Arc::clone(&self.columns), parts, rows: self.rows }
    }

    /// Of the data `rows`, which are all but those of the part `left_out`.
    pub fn part<'b>(&self, rows: &'b [usize], left_out: usize) -> Linearised<'b>
    where
        'a: 'b,
    {
        let parts = self.parts.as_ref().map(|(parts, _)| (Arc::clone(parts), Some(left_out)));
        Linearised { model: self.model, columns: Arc::clone(&self.columns), parts, rows: Some(rows) }
    }

    /// What a search on these data needs of the columns of a linear model.
    pub fn training(&self, whitening: &Whitening) -> Option<Training<'a>> {
        let (parts, left_out) = self.parts.as_ref()?;
        Some(Training::new(parts, *left_out, whitening))
    }

    /// A candidate's columns at its neutral values.
    pub fn neutral(&self, candidate: usize) -> DMatrix<f64> {
        if self.model.is_linear() {
            let whole = dense(&self.model.stored(candidate), self.model.response(&[]).len());
            return match self.rows {
                Some(rows) => whole.select_rows(rows),
                None => whole,
            };
        }
        self.stored().dense(candidate, self.rows)
    }

    /// What a candidate is, where it is a step among all data.
    pub fn step(&self, candidate: usize) -> Option<Step> {
        if self.rows.is_some() { None } else { self.model.step(candidate) }
    }

    /// How many data two candidates are apart that are steps of one sequence; a model that stores
    /// its own columns has none.
    pub fn steps_apart(&self, one: usize, other: usize) -> Option<usize> {
        if self.model.is_linear() { None } else { self.stored().steps_apart(one, other) }
    }

    /// Inner products of all candidates' columns at neutral values with some vectors.
    pub fn products(&self, vectors: DMatrix<f64>) -> Products<'_> {
        self.stored().products(vectors, self.rows)
    }

    /// The same for many vectors, to be kept.
    pub fn table(&self, vectors: &DMatrix<f64>) -> Table {
        self.stored().table(vectors, self.rows)
    }

    /// All of these columns.
    pub fn stored(&self) -> &Columns {
        self.columns.get_or_init(|| Columns::new(self.model))
    }

    /// The sequences that steps may be in, by the numbers that their data have here; `None` for
    /// those that are left out.
    pub fn sequences(&self) -> Vec<Vec<Option<usize>>> {
        let mut place: Vec<Option<usize>> = Vec::new();
        if let Some(rows) = self.rows {
            place.resize(self.stored().data(), None);
            rows.iter().enumerate().for_each(|(own, &row)| place[row] = Some(own));
        }
        let own = |&row: &usize| if self.rows.is_some() { place[row] } else { Some(row) };
        self.stored().sequences().iter().map(|sequence| sequence.iter().map(own).collect()).collect()
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
