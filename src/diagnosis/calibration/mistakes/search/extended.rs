//! States with one more change, or with two at once.

use super::super::super::effects::mistakes::UNIT_MISTAKE;
use super::super::draft::DraftChange;
use super::super::quick::Worthwhile;
use super::part::FAR;
use super::{FittedDraft, MistakeSearch, SearchStep};
use crate::parallel::in_parallel;

const BEAM: usize = 5;
/// What a robot as drawn leaves, as a share of the reach: what is tried must not be far worse.
const DRAWN: f64 = 0.02;

impl MistakeSearch<'_> {
    /// The state with every further change, the best first; those that will not reach the score
    /// `least` may be missing.
    pub(super) fn extended(&self, from: &FittedDraft, least: f64) -> Vec<FittedDraft> {
        let mut tried = self.extended_by_all(from, least);
        // what all rows hold is no matter of some
        if !tried.first().is_some_and(|best| self.is_cured(best, from)) {
            tried.extend(self.partial(from));
            tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        }
        tried
    }

    /// True where a change of all rows makes every one of them fit.
    fn is_cured(&self, state: &FittedDraft, from: &FittedDraft) -> bool {
        let is_of_all = matches!(state.steps.last(), Some(SearchStep::Move(_)));
        let fits = || state.fit.residuals.iter().all(|left| *left < FAR * state.fit.scale);
        is_of_all && fits() && self.is_better(state, from)
    }

    fn extended_by_all(&self, from: &FittedDraft, least: f64) -> Vec<FittedDraft> {
        let reach = self.bodies[from.thin.body].reach;
        let most_left = (0.8 * from.fit.rough).max(DRAWN * reach);
        let mut steps: Vec<SearchStep> = (0..self.moves.len()).map(SearchStep::Move).collect();
        steps.retain(|step| !from.steps.contains(step));
        let elsewhere = self.elsewhere(from).into_iter().chain(self.fixtures(from));
        steps.extend(elsewhere.map(SearchStep::Elsewhere));
        let tried = in_parallel(steps.len(), |k| {
            let mut all = from.steps.clone();
            all.push(steps[k].clone());
            if self.change(&steps[k]).is_guess() {
                // the same fit, another guess
                let thin = from.thin.with(self.change(&steps[k]));
                return Some(self.scored(all, thin, from.fit.clone()));
            }
            let is_two_bodies =
                matches!(self.change(&steps[k]), DraftChange::Body(..)) && from.thin.body != 0;
            // a score is the likelihood, less what is paid
            let log_likelihood = match self.draft.has_sockets() {
                true => f64::NEG_INFINITY,
                false => least - self.log_prior(&all),
            };
            let worthwhile = Worthwhile { most_left, log_likelihood };
            if is_two_bodies { None } else { self.state(&all, worthwhile) }
        });
        let mut tried: Vec<FittedDraft> = tried.into_iter().flatten().collect();
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        // a move of the base is tried after some rows only: at its own it may be the best
        let is_move = |state: &FittedDraft| {
            matches!(state.steps.last(), Some(SearchStep::Elsewhere(DraftChange::Moved(_))))
        };
        if let Some(k) = tried.iter().position(is_move) {
            tried[k] = self.sharpened(tried[k].clone());
            tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        }
        tried
    }

    /// Two changes at once, from the best few.
    pub(super) fn pair(&self, from: &FittedDraft, tried: &[FittedDraft]) -> Option<FittedDraft> {
        let moves = || tried.iter().filter(|state| matches!(state.steps.last(), Some(SearchStep::Move(_))));
        // what hardly moves, or is of another size, fits anything badly: units are always tried
        let is_unit = |state: &&FittedDraft| match state.steps.last() {
            Some(SearchStep::Move(number)) => self.moves[*number].effect == &UNIT_MISTAKE,
            _ => false,
        };
        let first: Vec<&FittedDraft> = moves().take(BEAM).chain(moves().skip(BEAM).filter(is_unit)).collect();
        let grown =
            first.iter().flat_map(|state| self.extended_by_all(state, f64::NEG_INFINITY).into_iter().take(1));
        let mut grown: Vec<FittedDraft> =
            grown.filter(|state| self.is_better(state, from) && !self.has_failed(state)).collect();
        grown.sort_by(|a, b| b.score.total_cmp(&a.score));
        grown.into_iter().next()
    }
}
