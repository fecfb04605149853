//! A joint's zero that drifts, as what another zero in some rows may be taken for.
//!
//! ```text
//! q true = q recorded + c·x       x the temperature, the time or the order, or a warm-up over them
//! ```
//!
//! One number for a whole recording, where a stretch takes one and its ends. c comes from how far
//! each tip is off along the joint's own motion, about fits of which each begins with the last.

use super::super::draft::{Draft, DraftChange};
use super::super::quick::fit_from;
use super::part::Reference;
use super::{FittedDraft, MistakeSearch, SearchStep};
use crate::calibration::campaign::Recording;

/// The price of a drift: its number, and what it follows.
const DRIFTS: f64 = -6.0;
/// Fits, each with the c of the one before.
const FITS: usize = 4;
/// Warm-ups 1 − e^(−x/τ) over the order, τ as shares of it.
const WARM_UPS: [f64; 2] = [0.1, 0.3];

/// What a zero may drift with, by row of the recording: mean 0, root mean square 1.
pub fn clocks(recording: &Recording) -> Vec<Vec<f64>> {
    let rows = &recording.rows;
    let order: Vec<f64> = (0..rows.len()).map(|row| row as f64 / rows.len() as f64).collect();
    let times = rows.iter().map(|row| row.time).collect::<Option<Vec<f64>>>();
    let recorded = [times, recording.temperatures()];
    let warm_ups = WARM_UPS.map(|tau| order.iter().map(|x| -(-x / tau).exp_m1()).collect());
    let all = recorded.into_iter().flatten().chain(warm_ups).chain([order.clone()]);
    all.filter_map(|clock: Vec<f64>| standardised(&clock)).collect()
}

fn standardised(clock: &[f64]) -> Option<Vec<f64>> {
    let count = clock.len().max(1) as f64;
    let mean = clock.iter().sum::<f64>() / count;
    let square = clock.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    (square > 0.0).then(|| clock.iter().map(|x| (x - mean) / square.sqrt()).collect())
}

impl MistakeSearch<'_> {
    /// Scores with the zero of the last change of `changed` drifting in place of it.
    pub fn drifts(&self, changed: &FittedDraft, from: &FittedDraft) -> Vec<f64> {
        let Some(SearchStep::Part(_, DraftChange::Within(_, change))) = changed.steps.last() else {
            return Vec::new();
        };
        let DraftChange::Zero { joint, .. } = **change else { return Vec::new() };
        self.clocks.iter().filter_map(|clock| self.drifting(joint, clock, from)).collect()
    }

    fn drifting(&self, joint: usize, clock: &[f64], from: &FittedDraft) -> Option<f64> {
        let body = &self.bodies[from.thin.body];
        let (mut thin, mut fit) = (from.thin.clone(), from.fit.clone());
        for _ in 0..FITS {
            let by = Reference::of_all(&thin, body, &fit).drift(&thin, joint, clock)?;
            thin = thin.drifting(joint, clock, by);
            fit = fit_from(&thin, body, &fit, fit.rough)?;
        }
        Some(self.scored(from.steps.clone(), thin, fit).score + DRIFTS)
    }
}

impl Draft {
    /// The same with a zero that drifts by so much.
    fn drifting(&self, joint: usize, clock: &[f64], by: f64) -> Draft {
        let mut draft = self.clone();
        let own = draft.joints.iter_mut().skip(joint).step_by(draft.joint_count);
        own.zip(&self.rows).for_each(|(q, &row)| *q += by * clock.get(row).unwrap_or(&0.0));
        draft
    }
}
