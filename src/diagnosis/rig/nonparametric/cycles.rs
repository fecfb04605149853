//! Which curves along a recording predict the next cycle.
//!
//! Of a load that goes up and down again and again a curve through neighbours follows anything that
//! a law repeats. Each cycle in turn is predicted from the others, by the curve with its prior; a
//! curve stays if it lowers the squares.

use nalgebra::{DMatrix, DVector};

use crate::diagnosis::rig::mechanics::action::Action;
use crate::diagnosis::rig::numbering::numbered;
use crate::diagnosis::rig::recording::datum::Datum;
use crate::inference::Candidate;

/// The cycles of a recording, with what the base model leaves of it.
pub(super) struct Cycles {
    /// m.
    left: DVector<f64>,
    /// The data of each.
    rows: Vec<Vec<usize>>,
}

impl Cycles {
    /// `None` where the loads do not go up and down again and again. `deflections`: how far the rod
    /// deflects at each datum by the base model, m.
    pub fn of(data: &[Datum], deflections: &[f64]) -> Option<Cycles> {
        let is_cyclic = data.iter().any(|d| d.motion.is_some_and(|motion| motion.cycle > 0));
        is_cyclic.then_some(())?;
        let cycle = numbered(data.iter().map(|d| (d.run, d.motion.map(|motion| motion.cycle))));
        let mut rows = vec![Vec::new(); cycle.iter().max().map_or(0, |last| last + 1)];
        cycle.iter().enumerate().for_each(|(i, &cycle)| rows[cycle].push(i));
        let left = data.iter().zip(deflections).map(|(d, u)| d.measured - u);
        Some(Cycles { left: DVector::from_iterator(data.len(), left), rows })
    }

    /// True where a curve that is fitted to all other cycles lowers the squares of each cycle, all
    /// of them together.
    pub fn are_predicted(&self, candidate: &Candidate, actions: &[Action]) -> bool {
        let left = &self.left;
        let mut columns = DMatrix::zeros(left.len(), actions.len());
        for (k, (action, parameter)) in actions.iter().zip(&candidate.parameters).enumerate() {
            let Action::Shift(weights) = action else { continue };
            weights.iter().for_each(|(i, weight)| columns[(i, k)] = weight * parameter.size);
        }
        let all = (columns.tr_mul(&columns), columns.tr_mul(left));
        let noise = left.norm_squared() / left.len().max(1) as f64;
        let (mut before, mut after) = (0.0, 0.0);
        for rows in &self.rows {
            let (own, own_left) = (columns.select_rows(rows), left.select_rows(rows));
            let gram = &all.0 - own.tr_mul(&own) + DMatrix::identity(actions.len(), actions.len()) * noise;
            let Some(root) = gram.cholesky() else { return false };
            let values = root.solve(&(&all.1 - own.tr_mul(&own_left)));
            before += own_left.norm_squared();
            after += (own_left - own * values).norm_squared();
        }
        after < before
    }
}
