//! Which mistakes turn poses that fit nothing into poses that fit.
//!
//! Greedy: the change that gains most, then the best beside it; where no single one cures a fit
//! that fails, pairs that begin with the best few, or with a unit; where no pair does, nothing is
//! named. A state is kept where it is a thousand times more probable than the one that it grew from
//! **and** what it touches
//! lies three times nearer. It must also be a thousand times more probable than
//! what is left to the effects: a small move of base or tracker, a clamp that is not quite in its
//! place.

pub mod drifts;
pub mod elsewhere;
mod extended;
pub mod fixtures;
mod left_to_effects;
mod loose_tool;
mod moved_fixtures;
pub mod part;
mod partial;
pub mod score;
mod verdict;

pub(super) use self::score::RARE;
use super::draft::{Draft, DraftChange};
use super::moves::PossibleMistake;
use super::quick::{Fit, LoadedRobot, Worthwhile, fit, fit_from};
use crate::inference::{Effect, Key};

/// A change is made at these odds against what there is without it: ln 1000.
pub(super) const ODDS: f64 = 6.907_755;
/// Another change within these odds explains alike: ln 20.
pub(super) const ALIKE: f64 = 2.995_732;
/// Rows that a fit sees.
const ROWS: usize = 120;
const MOST_CHANGES: usize = 6;
/// One of the changes that make a state.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SearchStep {
    /// By its number among the moves.
    Move(usize),
    /// Tracker or base, or a clamp, stands elsewhere.
    Elsewhere(DraftChange),
    /// A change of some rows, by its number among those of rows.
    Part(usize, DraftChange),
    /// One row, or a few: no fit depends on it.
    Slip(DraftChange),
}

/// A draft with some changes, fitted.
#[derive(Clone)]
pub(super) struct FittedDraft {
    pub steps: Vec<SearchStep>,
    /// Some of the rows.
    pub thin: Draft,
    pub fit: Fit,
    pub score: f64,
    /// The part of the score that first guesses make.
    guess: f64,
    /// That of the volume which the recorded angles span: with sockets angles of a smaller unit
    /// scatter less, and say nothing by it.
    volume: f64,
    /// By what a change of units has made lengths of each row smaller, or 1: they scatter less by
    /// as much, and say nothing by it.
    shrunk: Vec<f64>,
}

/// A change that was found necessary.
pub(super) struct AdoptedStep {
    pub step: SearchStep,
    pub log_odds: f64,
    /// Root mean square of what it explains, m.
    pub explains: f64,
    /// Moves that explain as much in its place, with the odds against them.
    pub rivals: Vec<(&'static Effect, Key, f64)>,
    /// True where a clamp, instead, may stand elsewhere from the same row on.
    pub may_be_clamp: Option<usize>,
    /// The odds against another mass at the tip, where that may be it instead.
    pub may_be_tip: Option<f64>,
}

/// A campaign with all that may have been mistaken.
pub(super) struct MistakeSearch<'a> {
    pub draft: Draft,
    pub bodies: Vec<LoadedRobot<'a>>,
    pub moves: Vec<PossibleMistake>,
    /// What may have gone wrong with some rows alone.
    pub of_rows: Vec<PossibleMistake>,
    /// What a zero may drift with, by row of the recording.
    pub clocks: Vec<Vec<f64>>,
    /// What the rod's file says of the mass on the tip, kg.
    pub tip_mass: f64,
    /// Times that it costs more than usual that base or tip was a rough guess: where a calibration
    /// that begins with it does not arrive, it was no guess.
    pub guess_weight: f64,
}

impl MistakeSearch<'_> {
    /// The changes that this campaign needs, with the state that they make, and what was there
    /// before; `None` where nothing can be fitted at all.
    pub fn found(&self) -> Option<(FittedDraft, FittedDraft, Vec<AdoptedStep>)> {
        let base = self.state(&[], Worthwhile::ANY)?;
        let mut best = base.clone();
        while best.steps.len() < MOST_CHANGES {
            // beside one that fits only what is better counts
            let least = if self.has_failed(&best) { f64::NEG_INFINITY } else { best.score };
            let tried = self.extended(&best, least);
            // no physics makes a first guess another one, nor the zero that turns a base from it
            let is_guess = |state: &FittedDraft| {
                state.steps.last().is_some_and(|step| self.change(step).is_guess())
                    || !self.has_failed(&best) && state.score - best.score < state.guess - best.guess
            };
            // physics that explains what one change does competes with all others too
            let mut of_effects = f64::NEG_INFINITY;
            let is_next = |state: &&FittedDraft| {
                if !self.is_better(state, &best) || self.has_failed(state) {
                    return false;
                }
                if is_guess(state) {
                    return true;
                }
                of_effects = self.of_effects(state, &best, &tried).max(of_effects);
                state.score - of_effects > ODDS
            };
            let next = tried.iter().find(is_next);
            let next = match next {
                Some(next) => Some(next.clone()),
                None if self.has_failed(&best) => self.pair(&best, &tried),
                None => None,
            };
            let Some(next) = next else { break };
            // what another start of the same fit explains is no change
            let again = self.restarted(best.clone(), &next);
            if again.score - best.score > ODDS {
                best = again;
                continue;
            }
            best = self.sharpened_part(self.sharpened(next));
        }
        // what a later one made needless goes
        loop {
            let needless = (0..best.steps.len()).find_map(|k| {
                let rest = self.without(&best, k)?;
                (best.steps.len() > 1 && !self.is_better(&best, &rest)).then_some(rest)
            });
            match needless {
                Some(rest) => best = rest,
                None => break,
            }
        }
        let found = (0..best.steps.len()).filter_map(|k| self.judged(&best, k)).collect();
        Some((base, best, found))
    }

    /// The draft with some changes.
    pub fn changed(&self, steps: &[SearchStep]) -> Draft {
        steps.iter().fold(self.draft.clone(), |draft, step| draft.with(self.change(step)))
    }

    pub(super) fn change<'s>(&'s self, step: &'s SearchStep) -> &'s DraftChange {
        match step {
            SearchStep::Move(number) => &self.moves[*number].change,
            SearchStep::Elsewhere(change) | SearchStep::Part(_, change) | SearchStep::Slip(change) => change,
        }
    }

    pub(super) fn state(&self, steps: &[SearchStep], worthwhile: Worthwhile) -> Option<FittedDraft> {
        let thin = self.thinned(&self.changed(steps));
        let body = &self.bodies[thin.body];
        let fit = fit(&thin, body, worthwhile)?;
        Some(self.scored(steps.to_vec(), thin, fit))
    }

    /// The state, or what it becomes where its fit begins with that of another one, whichever is
    /// more probable: rows that a mistake or a move touches pull at a fit, and one that has let
    /// them go is the better one with any reading of them.
    pub(super) fn restarted(&self, state: FittedDraft, start: &FittedDraft) -> FittedDraft {
        if state.thin.body != start.thin.body {
            return state;
        }
        let body = &self.bodies[state.thin.body];
        let again = fit_from(&state.thin, body, &start.fit, state.fit.rough)
            .map(|fit| self.scored(state.steps.clone(), state.thin.clone(), fit));
        match again {
            Some(again) if again.score > state.score => again,
            _ => state,
        }
    }

    /// A state without one of its changes.
    fn without(&self, state: &FittedDraft, k: usize) -> Option<FittedDraft> {
        let mut steps = state.steps.to_vec();
        steps.remove(k);
        Some(self.restarted(self.state(&steps, Worthwhile::ANY)?, state))
    }

    /// Always the same rows of the recording, so that states can be compared row by row.
    pub(super) fn thinned(&self, draft: &Draft) -> Draft {
        let count = self.draft.len();
        let is_kept = |row: usize| count <= ROWS || (row * ROWS) % count < ROWS;
        let rows: Vec<usize> = (0..draft.len()).filter(|&row| is_kept(draft.rows[row])).collect();
        draft.part(&rows)
    }
}
