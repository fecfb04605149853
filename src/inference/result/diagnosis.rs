//! What a recording says about the physics that its model left out.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::inference::model::evidence::rms;
use crate::inference::{
    Evidence, Finding, HeldOut, Hypothesis, LackOfFit, LeftOutSession, Location, NoiseTest, NominalEstimate,
    Structure, Suspect,
};

/// The answer of the engine.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Diagnosis {
    /// The effects that were adopted, strongest first.
    pub findings: Vec<Finding>,
    /// What is structured and no effect explains.
    pub discrepancy: Option<Discrepancy>,
    /// Noise of a datum, with what it shares with others: the standard deviation of what is left of
    /// the data once the hypothesis, and the discrepancy, are taken out, or of repeats about their
    /// averages, m, where these are off all the same.
    pub noise: f64,
    /// A stated noise against what is left.
    pub noise_test: NoiseTest,
    /// Single data far off: remarks, not findings.
    pub suspects: Vec<Suspect>,
    /// Numbers of the model's file that moved within what they are known to, the farthest first.
    pub nominal: Vec<NominalEstimate>,
    /// Factors of all nominal numbers, in standard uncertainties, with their covariance.
    pub nominal_factors: (DVector<f64>, DMatrix<f64>),
    /// Variance of the errors that data share, over that of their own.
    pub shared_ratio: f64,
    /// How many data, from the first, were recorded.
    pub recorded: usize,
    /// How many numbers of all data base model and hypothesis have taken.
    pub taken: f64,
    /// What the base model leaves, once it has absorbed what it can.
    pub before: DVector<f64>,
    /// And what the hypothesis leaves.
    pub after: DVector<f64>,
    /// Does the base model leave the averages of the repeats? `None` without repeats.
    pub lack_of_fit_before: Option<LackOfFit>,
    /// Does the hypothesis?
    pub lack_of_fit_after: Option<LackOfFit>,
    /// Structure of `before` along each covariate of the evidence.
    pub structure_before: Vec<Structure>,
    /// And of `after`.
    pub structure_after: Vec<Structure>,
    /// The same of what is left without the findings that are seen along a covariate, all others
    /// known; `None` where none of several is.
    pub structure_given_others: Vec<Option<Structure>>,
    /// Every candidate alone against none: ln of the odds, prior included.
    pub odds: Vec<f64>,
    /// Held-out errors, where the recording has folds.
    pub held_out: Option<HeldOut>,
    /// What is found in the other sessions, on each session; nothing where nothing was found or
    /// there is one session only.
    pub sessions: Vec<LeftOutSession>,
    /// All findings together, fitted.
    pub hypothesis: Hypothesis,
    /// The recording with its nominal numbers and zeros in the background and the weights and
    /// shared errors that were found, and the noise of a datum apart from these.
    pub settled: (Arc<Evidence>, f64),
}

/// A structured remainder that no effect of the library explains.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Discrepancy {
    /// Index of the curve among the candidates; `None` where only the averages of repeats show
    /// that something is left.
    pub candidate: Option<usize>,
    /// The curve's place.
    pub location: Option<Location>,
    /// What shows it.
    pub shown_by: ShownBy,
    /// Root mean square of what the curve describes, or of what is left.
    pub rms: f64,
    /// What the curve says; what is left where there is none.
    pub shape: DVector<f64>,
}

impl Discrepancy {
    /// One that no curve describes: `shape` is left.
    pub(in crate::inference) fn without_curve(shown_by: ShownBy, shape: DVector<f64>) -> Discrepancy {
        Discrepancy { candidate: None, location: None, shown_by, rms: rms(&shape), shape }
    }
}

/// What shows that something is left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShownBy {
    /// A smooth curve describes it.
    Curve,
    /// What was named is larger here than there.
    Varying,
    /// Averages of repeats differ from the model by more than the repeats scatter.
    Repeats,
    /// So many data are far off that they are no single ones.
    Suspects,
    /// Most of what is left goes on from datum to datum for longer than scatter does.
    Neighbours,
    /// It is more than the noise that was stated.
    StatedNoise,
    /// It is more than any scatter of such a recording.
    Size,
    /// The numbers of the model's file would have to be farther off than it says they are known.
    Numbers,
}

impl Diagnosis {
    /// Root mean square of what the base model leaves of what was recorded.
    pub fn error_before(&self) -> f64 {
        rms(&self.before.rows(0, self.recorded).into_owned())
    }

    /// And of what the hypothesis leaves.
    pub fn error_after(&self) -> f64 {
        rms(&self.after.rows(0, self.recorded).into_owned())
    }

    /// The same without suspects.
    pub fn error_of_others(&self) -> f64 {
        let is_suspect = |datum: usize| self.suspects.iter().any(|suspect| suspect.datum == datum);
        let others = (0..self.recorded).filter(|&datum| !is_suspect(datum)).map(|datum| self.after[datum]);
        rms(&DVector::from_vec(others.collect()))
    }

    /// True where something is left out of the model.
    pub fn is_mismatch(&self) -> bool {
        !self.findings.is_empty() || self.discrepancy.is_some()
    }
}
