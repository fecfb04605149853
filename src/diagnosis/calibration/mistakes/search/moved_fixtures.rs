//! A clamp or a socket that is not in its place, as what a change of some rows may be taken for.
//!
//! Rows that a mistake is said to concern are often those of one fixture, or of one after a knock:
//! a displacement of it, three numbers, is then tried in place of the mistake.

use nalgebra::Vector3;

use super::super::draft::{Draft, DraftChange};
use super::super::quick::{Worthwhile, fit};
use super::left_to_effects::DISPLACED;
use super::{FittedDraft, MistakeSearch, SearchStep};

/// The price of a fixture that is displaced in some rows: three numbers and the row.
pub const KNOCKED: f64 = -12.0;

impl MistakeSearch<'_> {
    /// Scores with each fixture of the rows that the last change of `changed` concerns displaced in
    /// place of it: in these rows alone, a clamp in all of its rows too.
    pub fn moved_fixtures(&self, changed: &FittedDraft, from: &FittedDraft) -> Vec<f64> {
        let Some(SearchStep::Part(_, DraftChange::Within(rows, _))) = changed.steps.last() else {
            return Vec::new();
        };
        let thin = &from.thin;
        let is_tracker = !thin.has_sockets() && thin.devices.len() < 2;
        let is_inside = |at: &usize| rows.contain(thin.rows[*at], thin.group[*at]);
        let inside: Vec<usize> = (0..thin.len()).filter(|at| !is_tracker && is_inside(at)).collect();
        let mut fixtures: Vec<usize> = inside.iter().map(|&at| thin.group[at]).collect();
        fixtures.sort_unstable();
        fixtures.dedup();
        let mut scores = Vec::new();
        for fixture in fixtures {
            let own: Vec<usize> = inside.iter().copied().filter(|&at| thin.group[at] == fixture).collect();
            scores.extend(self.with_loose(thin.knocked(&own, fixture), KNOCKED, changed, from));
            if !thin.has_sockets() {
                let loose = vec![fixture];
                scores.extend(self.with_loose(Draft { loose, ..thin.clone() }, DISPLACED, changed, from));
            }
        }
        scores
    }

    /// Scores with each clamp knocked in place of another robot: gravity along another axis, which
    /// a few clamps hardly tell from one of them that moved. The row is the one before and after
    /// which the middle residuals differ most, by the rows on both sides:
    ///
    /// max |r̄₁ − r̄₂|²·n₁·n₂/(n₁ + n₂)
    pub fn knocked_clamps(&self, changed: &FittedDraft, from: &FittedDraft) -> Vec<f64> {
        let thin = &from.thin;
        let is_body =
            matches!(changed.steps.last().map(|step| self.change(step)), Some(DraftChange::Body(..)));
        if !is_body || thin.has_sockets() || thin.devices.len() < 2 {
            return Vec::new();
        }
        let off = from.fit.offsets(thin, &self.bodies[thin.body]);
        let knocked = |clamp: usize| {
            let own: Vec<usize> = (0..thin.len()).filter(|&at| thin.group[at] == clamp).collect();
            let after = own.get(step_of(&own.iter().map(|&at| off[at]).collect::<Vec<_>>())..)?;
            self.with_loose(thin.knocked(after, clamp), KNOCKED, changed, from)
        };
        (0..thin.devices.len()).filter_map(knocked).collect()
    }

    /// The score of a draft with loose fixtures in place of the last change of `changed`.
    pub fn with_loose(
        &self,
        thin: Draft,
        price: f64,
        changed: &FittedDraft,
        from: &FittedDraft,
    ) -> Option<f64> {
        let fit = fit(&thin, &self.bodies[thin.body], Worthwhile::ANY)?;
        let loose = self.restarted(self.scored(from.steps.clone(), thin, fit), changed);
        Some(loose.score + price)
    }
}

impl Draft {
    /// The same where some rows of a fixture have one of their own, whose place is free.
    pub fn knocked(&self, rows: &[usize], fixture: usize) -> Draft {
        let mut draft = self.clone();
        let own = draft.devices.len();
        draft.devices.push(draft.devices[fixture]);
        rows.iter().for_each(|&at| draft.group[at] = own);
        draft.loose.push(own);
        draft
    }
}

/// Where a sequence steps, if it does: the first of those behind the step.
fn step_of(values: &[Vector3<f64>]) -> usize {
    let all: Vector3<f64> = values.iter().sum();
    let (mut before, mut best) = (Vector3::zeros(), (0.0, 0));
    for at in 1..values.len() {
        before += values[at - 1];
        let (first, second) = (at as f64, (values.len() - at) as f64);
        let apart = (before / first - (all - before) / second).norm_squared();
        let explained = apart * first * second / values.len() as f64;
        if explained > best.0 {
            best = (explained, at);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_a_sequence_steps() {
        let values: Vec<Vector3<f64>> = [0.1, -0.1, 0.0, 0.9, 1.1].map(|x| Vector3::new(0.0, x, 0.2)).into();
        assert_eq!(step_of(&values), 3);
        assert_eq!(step_of(&[]), 0);
    }
}
