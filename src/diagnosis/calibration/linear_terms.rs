//! Candidates whose columns are the same at all values: the response is a sum of them.

use nalgebra::{DMatrix, DVector};

use super::entry::{Column, Entry};
use super::evidence::unknown_beforehand;
use super::law::Law;
use crate::inference::{Absorbed, Candidate, Evidence, Term, Whitening};
use crate::parallel::in_parallel;

/// Share of an effect that must be left once the calibration has absorbed what it can.
const LEAST_UNABSORBED: f64 = 0.02;

/// All that might be left in a calibration's residuals.
#[derive(Debug, Clone)]
pub(super) struct LinearTerms {
    pub candidates: Vec<Candidate>,
    /// How each of them acts.
    pub laws: Vec<Law>,
    /// For each candidate ∂response/∂parameter.
    columns: Vec<Vec<Column>>,
    /// What is left of each candidate once the calibration has absorbed what it can.
    pub unabsorbed: Vec<f64>,
    data: usize,
}

impl LinearTerms {
    /// Of entries, without what does nothing and without what is absorbed, which is returned too.
    pub fn new(entries: Vec<Entry>, evidence: &Evidence) -> (LinearTerms, Vec<Absorbed>) {
        let data = evidence.residual.len();
        let mut terms = LinearTerms {
            candidates: Vec::new(),
            laws: Vec::new(),
            columns: Vec::new(),
            unabsorbed: Vec::new(),
            data,
        };
        let mut absorbed = Vec::new();
        // what a parameter of the robot does as well is no effect of its own, however unlikely its size
        let all = unknown_beforehand(evidence);
        let whitening = Whitening::new(&all, &all.residual);
        let entries: Vec<Entry> = entries.into_iter().filter_map(Entry::felt).collect();
        let shares = in_parallel(entries.len(), |k| unabsorbed(&entries[k], &whitening, data));
        for (entry, unabsorbed) in entries.into_iter().zip(shares) {
            if unabsorbed < LEAST_UNABSORBED {
                let Candidate { effect, location, .. } = entry.candidate;
                absorbed.push(Absorbed { effect, location, unabsorbed });
                continue;
            }
            terms.candidates.push(entry.candidate);
            terms.laws.push(entry.law);
            terms.columns.push(entry.columns);
            terms.unabsorbed.push(unabsorbed);
        }
        (terms, absorbed)
    }

    /// See [`crate::inference::ForwardModel::response`].
    pub fn response(&self, hypothesis: &[Term]) -> DVector<f64> {
        let mut response = DVector::zeros(self.data);
        for term in hypothesis {
            let Some(candidate) = self.candidates.get(term.candidate) else { continue };
            let parameters = candidate.parameters.iter().zip(&self.columns[term.candidate]);
            for ((parameter, column), value) in parameters.zip(&term.values) {
                if *value != parameter.neutral {
                    column.add_to(&mut response, value - parameter.neutral);
                }
            }
        }
        response
    }

    /// See [`crate::inference::ForwardModel::columns`].
    pub fn columns(&self, candidate: usize) -> DMatrix<f64> {
        let columns = &self.columns[candidate];
        let mut matrix = DMatrix::zeros(self.data, columns.len());
        let parameters = &self.candidates[candidate].parameters;
        for ((k, column), parameter) in columns.iter().enumerate().zip(parameters) {
            let mut slots = matrix.view_mut((column.first, k), (column.values.len(), 1));
            slots.copy_from_slice(&column.values);
            slots *= parameter.size;
        }
        matrix
    }
}

/// √(Σ‖M·C‖²/Σ‖C‖²) over the parameters at their sizes.
fn unabsorbed(entry: &Entry, whitening: &Whitening, data: usize) -> f64 {
    let (mut left, mut all) = (0.0, 0.0);
    for (parameter, column) in entry.candidate.parameters.iter().zip(&entry.columns) {
        let mut own = DVector::zeros(data);
        column.add_to(&mut own, parameter.size);
        all += own.norm_squared();
        left += whitening.apply(&own).norm_squared();
    }
    (left / all.max(f64::MIN_POSITIVE)).sqrt()
}
