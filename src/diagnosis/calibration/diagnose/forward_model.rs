//! A calibration as the engine sees it: every response is a sum of columns.

use nalgebra::{DMatrix, DVector};

use super::super::effects::registry;
use super::super::model::CalibrationModel;
use crate::inference::{
    Candidate, Description, Estimate, Finding, FindingPart, ForwardModel, Hypothesis, StoredColumn, Term,
};

impl ForwardModel for CalibrationModel<'_> {
    fn candidates(&self) -> &[Candidate] {
        &self.terms.candidates
    }

    fn response(&self, hypothesis: &[Term]) -> DVector<f64> {
        self.terms.response(hypothesis)
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn columns(&self, hypothesis: &[Term], position: usize) -> DMatrix<f64> {
        self.terms.columns(hypothesis[position].candidate)
    }

    fn stored(&self, candidate: usize) -> Vec<StoredColumn<'_>> {
        self.terms.stored(candidate)
    }

    fn estimates(&self, parts: &[FindingPart], _: &Hypothesis) -> Vec<Estimate> {
        let Some(first) = parts.first() else { return Vec::new() };
        let effect = registry::record(self.terms.candidates[first.term.candidate].effect);
        effect.map_or_else(Vec::new, |effect| (effect.estimates)(self, parts))
    }

    fn describe(&self, finding: &Finding) -> Description {
        let effect = registry::record(finding.effect);
        Description {
            observed: effect.map_or_else(String::new, |effect| (effect.observed)(finding, self)),
            cause: finding.effect.cause.to_owned(),
        }
    }
}
