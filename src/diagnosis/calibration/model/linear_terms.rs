//! Candidates whose columns are the same at all values: the response is a sum of them.

use nalgebra::{DMatrix, DVector};

use super::super::evidence::unknown_beforehand;
use super::entry::{Column, Entry};
use super::law::Law;
use crate::inference::{Absorbed, Candidate, DataParts, Evidence, StoredColumn, Term, Whitening, products};

/// Share of an effect that must be left once the calibration has absorbed what it can.
const LEAST_UNABSORBED: f64 = 0.02;
/// Share of a square that rounding leaves.
const ROUNDING: f64 = 1e-13;

/// All that might be left in a calibration's residuals.
#[derive(Debug, Clone)]
pub struct LinearTerms {
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
        let entries: Vec<Entry> = entries.into_iter().filter_map(Entry::felt).collect();
        let shares = unabsorbed(&entries, evidence);
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
            let mut whole = DVector::zeros(self.data);
            column.add_to(&mut whole, parameter.size);
            matrix.set_column(k, &whole);
        }
        matrix
    }

    /// See [`crate::inference::ForwardModel::stored`].
    pub fn stored(&self, candidate: usize) -> Vec<StoredColumn<'_>> {
        stored(&self.candidates[candidate], &self.columns[candidate])
    }
}

fn stored<'a>(candidate: &Candidate, columns: &'a [Column]) -> Vec<StoredColumn<'a>> {
    columns.iter().zip(&candidate.parameters).map(|(column, known)| column.stored(known.size)).collect()
}

/// √(Σ‖M·C‖²/Σ‖C‖²) of each entry, over its parameters at their sizes: ‖M·c‖² = ‖c‖² − ‖Qᵀc‖².
fn unabsorbed(entries: &[Entry], evidence: &Evidence) -> Vec<f64> {
    // what a parameter of the robot does as well is no effect of its own, however unlikely its size
    let all = unknown_beforehand(evidence);
    let basis = Whitening::new(&all, &all.residual).basis();
    let columns: Vec<StoredColumn> =
        entries.iter().flat_map(|entry| stored(&entry.candidate, &entry.columns)).collect();
    let along = products(&columns, &basis, &DataParts::whole(evidence.residual.len()));
    let mut of_column = columns.iter().zip(along[0].column_iter());
    let share = |entry: &Entry| {
        let (mut taken, mut all) = (0.0, 0.0);
        for (column, along) in of_column.by_ref().take(entry.columns.len()) {
            all += column.norm_squared();
            taken += along.norm_squared();
        }
        // less is what rounding leaves of the difference
        let left = if all - taken > ROUNDING * all { all - taken } else { 0.0 };
        (left / all.max(f64::MIN_POSITIVE)).sqrt()
    };
    entries.iter().map(share).collect()
}
