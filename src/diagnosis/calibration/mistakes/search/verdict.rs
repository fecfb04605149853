//! Whether a change is beyond doubt, and what else explains as much.

use super::super::draft::DraftChange;
use super::{ALIKE, AdoptedStep, FittedDraft, MistakeSearch, ODDS, SearchStep};
use crate::statistics::median;

/// What a change touches must come so many times nearer.
const NEARER: f64 = 3.0;
/// Share of the rows that it touches at least, and their number.
const TOUCHED: (f64, usize) = (0.05, 3);

impl MistakeSearch<'_> {
    /// True where `after` is beyond doubt better than `before`.
    pub(super) fn is_better(&self, after: &FittedDraft, before: &FittedDraft) -> bool {
        let more = after.steps.len().saturating_sub(before.steps.len()) as f64;
        if after.score - before.score < ODDS * more.max(1.0) || !self.is_far(after) || !self.is_placed(after)
        {
            return false;
        }
        // what was measured by hand and agrees is no accident: where a fit is good with it, a
        // change that contradicts it is fitted to something else
        if !self.has_failed(before) && before.guess - after.guess > ODDS {
            return false;
        }
        // a first guess that agrees now where it did not, with a fit that is good both times
        let agrees = !self.has_failed(before) && after.guess - before.guess > ODDS;
        // no physics makes a force so much larger or smaller
        agrees || self.is_of_force(after) || self.is_nearer(after, before)
    }

    fn is_of_force(&self, state: &FittedDraft) -> bool {
        matches!(state.steps.last(), Some(SearchStep::Move(number)) if self.moves[*number].force.is_some())
    }

    /// True where what differs between two states lies so many times nearer, and is enough.
    fn is_nearer(&self, after: &FittedDraft, before: &FittedDraft) -> bool {
        // in what the angles span before, and in the units of before, where a robot leaves so much
        let spanned = ((before.volume - after.volume) / (3 * after.thin.len().max(1)) as f64).exp();
        let is_of_robot = !self.has_failed(before);
        let units = in_units_of(before, after).map(|unit| if is_of_robot { spanned * unit } else { spanned });
        let units: Vec<f64> = units.collect();
        let new: Vec<f64> = after.fit.residuals.iter().zip(&units).map(|(new, unit)| new * unit).collect();
        let touched = pairs(before, after)
            .map(|(at, old)| (old, new[at], 3.0 * after.fit.scale * units[at]))
            .filter(|(old, new, sure)| (old - new).abs() > *sure)
            .map(|(old, new, _)| (old, new));
        // a part of the rows may be a small one
        let is_part = (after.steps.iter())
            .any(|step| matches!(step, SearchStep::Part(..)) && !before.steps.contains(step));
        let share = if is_part { 0.0 } else { TOUCHED.0 };
        let least = (share * after.thin.len() as f64).max(TOUCHED.1 as f64);
        let (touched_old, touched_new): (Vec<f64>, Vec<f64>) = touched.unzip();
        let middles = median(&touched_old).zip(median(&touched_new));
        let Some((old_middle, new_middle)) = middles else { return false };
        // what a part of the rows holds makes them as good as the others
        let is_good = !is_part || median(&new).is_some_and(|all| new_middle < NEARER * all);
        touched_old.len() as f64 >= least && old_middle > NEARER * new_middle && is_good
    }

    /// One change of a state against the state without it.
    pub(super) fn judged(&self, best: &FittedDraft, k: usize) -> Option<AdoptedStep> {
        let rest = self.without(best, k)?;
        let left = &best.fit.residuals;
        let square: f64 = pairs(&rest, best).map(|(at, old)| old * old - left[at] * left[at]).sum();
        let explains = (square / best.thin.len().max(1) as f64).max(0.0).sqrt();
        let log_odds = (best.score - rest.score).min(700.0);
        let step = best.steps[k].clone();
        let alike: Vec<FittedDraft> = self
            .extended(&rest, best.score - ALIKE)
            .into_iter()
            .filter(|state| best.score - state.score < ALIKE && state.steps.last() != Some(&step))
            .collect();
        let rivals = alike.iter().filter_map(|state| {
            let odds = (best.score - state.score).max(0.0).exp();
            let own = match (state.steps.last()?, &step) {
                (SearchStep::Move(number), _) => return Some(self.moves[*number].with_odds(odds)),
                (SearchStep::Part(number, _), SearchStep::Part(known, _)) if number != known => {
                    &self.of_rows[*number]
                }
                (SearchStep::Part(number, _), SearchStep::Elsewhere(_)) => &self.of_rows[*number],
                _ => return None,
            };
            let (effect, location, odds) = own.with_odds(odds);
            Some((effect, location.rows("in these poses"), odds))
        });
        let may_be_clamp = match &step {
            SearchStep::Elsewhere(DraftChange::Moved(_)) => {
                alike.iter().find_map(|state| match state.steps.last() {
                    Some(SearchStep::Elsewhere(DraftChange::Apart(clamp))) => Some(*clamp),
                    _ => None,
                })
            }
            _ => None,
        };
        let lead = self.heavier_tip(&step, &rest).map(|score| (best.score - score).max(0.0));
        let may_be_tip = lead.filter(|lead| *lead < ODDS).map(f64::exp);
        Some(AdoptedStep { rivals: rivals.collect(), step, log_odds, explains, may_be_clamp, may_be_tip })
    }
}

/// Where the rows that two states have in common are in `after`, with their residuals before.
fn pairs<'a>(before: &'a FittedDraft, after: &'a FittedDraft) -> impl Iterator<Item = (usize, f64)> + 'a {
    let known = |row| before.thin.rows.binary_search(row).ok().map(|at| before.fit.residuals[at]);
    after.thin.rows.iter().enumerate().filter_map(move |(at, row)| Some((at, known(row)?)))
}

/// What a length of each row of `after` is in the unit that it had before.
fn in_units_of<'a>(before: &'a FittedDraft, after: &'a FittedDraft) -> impl Iterator<Item = f64> + 'a {
    let old = |row| before.thin.rows.binary_search(row).map_or(1.0, |at| before.shrunk[at]);
    after.thin.rows.iter().zip(&after.shrunk).map(move |(row, new)| old(row) / new)
}
