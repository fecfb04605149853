//! The physics as the engine sees it: candidates with parameters, and what they would do to a
//! recording.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::inference::columns::stored_column::StoredColumn;
use crate::inference::{Description, Effect, Estimate, Finding, FindingPart, Hypothesis, Location, Term};
use crate::units::Unit;

/// Step of a derivative, relative to the size of a parameter.
pub const DERIVATIVE_STEP: f64 = 1e-4;

/// One effect at one place.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Candidate {
    /// The effect. Candidates of one effect share its prior probability.
    pub effect: &'static Effect,
    /// The place at which it acts.
    pub location: Location,
    /// Its parameters; without effect at their neutral values.
    pub parameters: Vec<Parameter>,
    /// How much of its effect's prior probability it has, relative to the effect's other places.
    pub weight: f64,
    /// True for one of several forms of the same thing, such as laws of creep: a hypothesis holds
    /// one of them at most.
    pub is_alternative: bool,
    /// True for a smooth curve that stands for physics nobody has named: it competes, but is never
    /// a finding.
    pub is_nonparametric: bool,
}

/// A number that says how strong an effect is.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Parameter {
    /// Name with its unit, for example `force_n`.
    pub name: String,
    /// The unit of the name.
    pub unit: Unit,
    /// Value at which nothing happens, SI.
    pub neutral: f64,
    /// Size at which the effect is typically met: standard deviation of its prior about the neutral
    /// value, SI.
    pub size: f64,
    /// Physical bounds, SI; ±∞ where there are none.
    pub bounds: (f64, f64),
}

impl Parameter {
    /// A parameter without bounds that is 0 where nothing happens: its name with its unit, and the
    /// standard deviation of its prior, SI.
    pub fn new(name: impl Into<String>, unit: Unit, size: f64) -> Parameter {
        Parameter { name: name.into(), unit, neutral: 0.0, size, bounds: (f64::NEG_INFINITY, f64::INFINITY) }
    }

    /// With this value where nothing happens, SI.
    pub fn with_neutral(self, neutral: f64) -> Parameter {
        Parameter { neutral, ..self }
    }

    /// Within these bounds, SI.
    pub fn within(self, bounds: (f64, f64)) -> Parameter {
        Parameter { bounds, ..self }
    }
}

/// A parameter that adds its value to all data of a sequence from one of them on.
#[derive(Debug, Clone)]
pub struct Step {
    /// The sequence, which other steps share.
    pub data: Arc<[usize]>,
    /// Where in it the step is.
    pub from: usize,
}

/// What would have been recorded.
pub trait ForwardModel: Sync {
    /// All that might be real. The order is that of preference among equals.
    fn candidates(&self) -> &[Candidate];

    /// The recording with these terms, all acting together, less the recording without any: one
    /// number per datum of the evidence, in its unit. Zeros for no term, or for neutral values.
    fn response(&self, terms: &[Term]) -> DVector<f64>;

    /// True where the response is a sum of the effects' columns, the same at all values: much is
    /// then computed once.
    fn is_linear(&self) -> bool {
        false
    }

    /// True where the response to these terms is linear in all their values.
    fn is_linear_in(&self, _: &[Term]) -> bool {
        self.is_linear()
    }

    /// A candidate's [`ForwardModel::columns`] at neutral values as a linear model stores them.
    fn stored(&self, candidate: usize) -> Vec<StoredColumn<'_>> {
        let columns = self.columns(&[self.candidates()[candidate].neutral(candidate)], 0);
        let plain = |column: &[f64]| StoredColumn {
            factor: 1.0,
            first: 0,
            values: column.to_vec().into(),
            pattern: None,
        };
        columns.column_iter().map(|column| plain(column.as_slice())).collect()
    }

    /// Number of the case of each datum, counted from 0, where data of one case respond alike to
    /// many of the candidates; nothing where no two do. It saves time and memory only.
    fn cases(&self) -> &[usize] {
        &[]
    }

    /// The step that a candidate is, where it is one and nothing else. It saves time and memory
    /// only.
    fn step(&self, _candidate: usize) -> Option<Step> {
        None
    }

    /// Where a term is once its values are known; the candidate's location unless they say more.
    fn location(&self, term: &Term) -> Location {
        self.candidates()[term.candidate].location.clone()
    }

    /// What the parts of a finding amount to; their own parameters unless the model says more.
    fn estimates(&self, parts: &[FindingPart], _: &Hypothesis) -> Vec<Estimate> {
        parts.iter().flat_map(|part| part.estimates.clone()).collect()
    }

    /// Which of [`ForwardModel::estimates`] is the place of these parts, where that is a number
    /// that is fitted.
    fn place_among_estimates(&self, _: &[FindingPart]) -> Option<usize> {
        None
    }

    /// A finding in words.
    fn describe(&self, finding: &Finding) -> Description {
        let observed = format!("{} at {}", finding.effect.title(), finding.location);
        Description { observed, cause: finding.effect.cause.to_owned() }
    }

    /// ∂response/∂parameter times the size of the parameter, at the values of `terms`: one column
    /// for each parameter of the term at `position`.
    fn columns(&self, terms: &[Term], position: usize) -> DMatrix<f64> {
        let term = &terms[position];
        let mut moved = terms.to_vec();
        let parameters = &self.candidates()[term.candidate].parameters;
        let mut column = |(k, parameter): (usize, &Parameter)| {
            let h = DERIVATIVE_STEP * parameter.size;
            moved[position].values[k] = term.values[k] + h;
            let more = self.response(&moved);
            moved[position].values[k] = term.values[k] - h;
            let less = self.response(&moved);
            moved[position].values[k] = term.values[k];
            (more - less) / (2.0 * DERIVATIVE_STEP)
        };
        let columns: Vec<DVector<f64>> = parameters.iter().enumerate().map(&mut column).collect();
        DMatrix::from_columns(&columns)
    }
}

impl Candidate {
    /// An effect at a place with its parameters: as probable as at its other places, and neither an
    /// alternative of another one nor a curve that nobody has named.
    pub fn new(effect: &'static Effect, location: Location, parameters: Vec<Parameter>) -> Candidate {
        let (is_alternative, is_nonparametric) = (false, false);
        Candidate { effect, location, parameters, weight: 1.0, is_alternative, is_nonparametric }
    }

    /// The candidate at its neutral values.
    pub fn neutral(&self, index: usize) -> Term {
        Term { candidate: index, values: self.parameters.iter().map(|p| p.neutral).collect() }
    }

    /// Bounds of its parameters in sizes from the neutral values.
    pub fn scaled_bounds(&self) -> impl Iterator<Item = (f64, f64)> {
        let scaled = |p: &Parameter| {
            let in_sizes = |bound: f64| (bound - p.neutral) / p.size;
            (in_sizes(p.bounds.0), in_sizes(p.bounds.1))
        };
        self.parameters.iter().map(scaled)
    }
}
