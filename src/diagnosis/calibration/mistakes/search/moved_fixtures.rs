//! A clamp or a socket that is not in its place, as what a change of some rows may be taken for.
//!
//! Rows that a mistake is said to concern are often those of one fixture, or of one after a knock:
//! a displacement of it, three numbers, is then tried in place of the mistake.

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
