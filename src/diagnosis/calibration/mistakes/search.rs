//! Which mistakes turn poses that fit nothing into poses that fit.
//!
//! Greedy: the change that gains most, then the best beside it; where no single one cures a fit
//! that fails, pairs that begin with the best few, or with a unit; where no pair does, nothing is
//! named. A state is kept where it is a thousand times more probable than the one that it grew from
//! **and**
//! what it touches lies three times nearer. It must also be a thousand times more probable than
//! what is left to the effects: a small move of base or tracker, a clamp that is not quite in its
//! place.

use super::super::effects::mistakes::UNIT_MISTAKE;
use super::draft::{Change, Draft};
use super::motion::moved;
use super::moves::Move;
use super::part::FAR;
use super::quick::{Body, Fit, Worthwhile, fit, fit_from};
use crate::inference::{Effect, Key};
use crate::parallel::in_parallel;
use crate::statistics::median;
use crate::units::{DEG, MM};

/// A change is made at these odds against what there is without it: ln 1000.
pub(super) const ODDS: f64 = 6.907_755;
/// Another change within these odds explains alike: ln 20.
pub(super) const ALIKE: f64 = 2.995_732;
/// How rare any one of some hundred mistakes is: ln.
const RARE: f64 = -4.0;
/// The price of a frame that moved: half of ln 150 for each of its six numbers, and which row.
const MOVED: f64 = -20.0;
/// That of a clamp that stands elsewhere, or is turned: its three numbers, and which.
const FIXTURE: f64 = -12.0;
/// What a change touches must come so many times nearer.
const NEARER: f64 = 3.0;
/// Share of the rows that it touches at least, and their number.
const TOUCHED: (f64, usize) = (0.05, 3);
/// Rows that a fit sees.
const ROWS: usize = 120;
const MOST_CHANGES: usize = 6;
const BEAM: usize = 5;
/// What a robot as drawn leaves, as a share of the reach: what is tried must not be far worse.
const DRAWN: f64 = 0.02;
/// A fit that leaves more, as a share of the reach, fails.
pub(super) const FAILED: f64 = 5e-3;
/// How sure a stated base is: share of the reach, rad; and a stated tip: m and share of its length.
/// Then what it costs at most that it was a rough guess, ln.
const BASE: (f64, f64, f64) = (0.03, 2.0 * DEG, 24.0);
const TOOL: (f64, f64, f64) = (5.0 * MM, 0.03, 12.0);

/// One of the changes that make a state.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    /// By its number among the moves.
    Move(usize),
    /// Tracker or base, or a clamp, stands elsewhere.
    Elsewhere(Change),
    /// A change of some rows, by its number among those of rows.
    Part(usize, Change),
    /// One row, or a few: no fit depends on it.
    Slip(Change),
}

/// A draft with some changes, fitted.
#[derive(Clone)]
pub(super) struct State {
    pub steps: Vec<Step>,
    /// Some of the rows.
    pub thin: Draft,
    pub fit: Fit,
    pub score: f64,
    /// The part of the score that first guesses make.
    guess: f64,
    /// That of the volume which the recorded angles span: with sockets angles of a smaller unit
    /// scatter less, and say nothing by it.
    volume: f64,
}

/// A change that was found necessary.
pub(super) struct Found {
    pub step: Step,
    pub log_odds: f64,
    /// Root mean square of what it explains, m.
    pub explains: f64,
    /// Moves that explain as much in its place, with the odds against them.
    pub rivals: Vec<(&'static Effect, Key, f64)>,
    /// True where a clamp, instead, may stand elsewhere from the same row on.
    pub may_be_clamp: Option<usize>,
}

/// A campaign with all that may have been mistaken.
pub(super) struct Search<'a> {
    pub draft: Draft,
    pub bodies: Vec<Body<'a>>,
    pub moves: Vec<Move>,
    /// What may have gone wrong with some rows alone.
    pub of_rows: Vec<Move>,
    /// Times that it costs more than usual that base or tip was a rough guess: where a calibration
    /// that begins with it does not arrive, it was no guess.
    pub guess_weight: f64,
}

impl Search<'_> {
    /// The changes that this campaign needs, with the state that they make, and what was there
    /// before; `None` where nothing can be fitted at all.
    pub fn found(&self) -> Option<(State, State, Vec<Found>)> {
        let base = self.state(&[], Worthwhile::ANY)?;
        let mut best = base.clone();
        while best.steps.len() < MOST_CHANGES {
            // beside one that fits only what is better counts
            let least = if self.has_failed(&best) { f64::NEG_INFINITY } else { best.score };
            let tried = self.extended(&best, least);
            let is_next = |state: &&State| {
                self.is_better(state, &best)
                    && !self.has_failed(state)
                    && state.score - self.of_effects(state, &best, &tried) > ODDS
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

    /// True where base or tip are not where they were said to be.
    pub fn is_rough_guess(&self, state: &State) -> bool {
        state.guess < -0.5 * TOOL.2 * self.guess_weight
    }

    /// True where even the best fit leaves what no robot leaves.
    pub fn has_failed(&self, state: &State) -> bool {
        is_failed(&state.fit, self.bodies[state.thin.body].reach)
    }

    /// The draft with some changes.
    pub fn changed(&self, steps: &[Step]) -> Draft {
        steps.iter().fold(self.draft.clone(), |draft, step| draft.with(self.change(step)))
    }

    pub(super) fn change<'s>(&'s self, step: &'s Step) -> &'s Change {
        match step {
            Step::Move(number) => &self.moves[*number].change,
            Step::Elsewhere(change) | Step::Part(_, change) | Step::Slip(change) => change,
        }
    }

    pub(super) fn state(&self, steps: &[Step], worthwhile: Worthwhile) -> Option<State> {
        let thin = self.thinned(&self.changed(steps));
        let body = &self.bodies[thin.body];
        let fit = fit(&thin, body, worthwhile)?;
        Some(self.scored(steps.to_vec(), thin, fit))
    }

    /// The state, or what it becomes where its fit begins with that of another one, whichever is
    /// more probable: rows that a mistake or a move touches pull at a fit, and one that has let
    /// them go is the better one with any reading of them.
    pub(super) fn restarted(&self, state: State, start: &State) -> State {
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
    fn without(&self, state: &State, k: usize) -> Option<State> {
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

    /// Ln of how rare these changes are.
    fn log_prior(&self, steps: &[Step]) -> f64 {
        let price = |step: &Step| match step {
            Step::Move(number) => RARE + self.moves[*number].log_prior,
            Step::Elsewhere(Change::Placed(_) | Change::Devices(_)) => FIXTURE,
            Step::Elsewhere(_) => MOVED,
            Step::Part(number, change) => RARE + self.of_rows[*number].log_prior - self.log_stretches(change),
            Step::Slip(_) => 0.0,
        };
        steps.iter().map(price).sum()
    }

    pub(super) fn scored(&self, steps: Vec<Step>, thin: Draft, fit: Fit) -> State {
        let prior = self.log_prior(&steps);
        let reach = self.bodies[thin.body].reach;
        // where nothing fits, base and tip are anywhere
        let most = [BASE.2, TOOL.2].map(|most| most * self.guess_weight);
        let guess = match is_failed(&fit, reach) {
            true => -most[0] - most[1],
            false => guess(&thin, &fit, reach, most),
        };
        let volume = fit.log_volume(&thin, &self.bodies[thin.body]);
        State { score: fit.log_likelihood + guess + prior + volume, steps, thin, fit, guess, volume }
    }

    /// The state with every further change, the best first; those that will not reach the score
    /// `least` may be missing.
    fn extended(&self, from: &State, least: f64) -> Vec<State> {
        let mut tried = self.extended_by_all(from, least);
        // what all rows hold is no matter of some
        if !tried.first().is_some_and(|best| self.is_cured(best, from)) {
            tried.extend(self.partial(from));
            tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        }
        tried
    }

    /// True where a change of all rows makes every one of them fit.
    fn is_cured(&self, state: &State, from: &State) -> bool {
        let is_of_all = matches!(state.steps.last(), Some(Step::Move(_)));
        let fits = || state.fit.residuals.iter().all(|left| *left < FAR * state.fit.scale);
        is_of_all && fits() && self.is_better(state, from)
    }

    fn extended_by_all(&self, from: &State, least: f64) -> Vec<State> {
        let reach = self.bodies[from.thin.body].reach;
        let most_left = (0.8 * from.fit.rough).max(DRAWN * reach);
        let mut steps: Vec<Step> = (0..self.moves.len()).map(Step::Move).collect();
        steps.retain(|step| !from.steps.contains(step));
        let elsewhere = self.elsewhere(from).into_iter().chain(self.fixtures(from));
        steps.extend(elsewhere.map(Step::Elsewhere));
        let tried = in_parallel(steps.len(), |k| {
            let mut all = from.steps.clone();
            all.push(steps[k].clone());
            if self.change(&steps[k]).is_guess() {
                // the same fit, another guess
                let thin = from.thin.with(self.change(&steps[k]));
                return Some(self.scored(all, thin, from.fit.clone()));
            }
            let is_two_bodies = matches!(self.change(&steps[k]), Change::Body(..)) && from.thin.body != 0;
            // a score is the likelihood, less what is paid
            let log_likelihood = match self.draft.has_sockets() {
                true => f64::NEG_INFINITY,
                false => least - self.log_prior(&all),
            };
            let worthwhile = Worthwhile { most_left, log_likelihood };
            if is_two_bodies { None } else { self.state(&all, worthwhile) }
        });
        let mut tried: Vec<State> = tried.into_iter().flatten().collect();
        tried.sort_by(|a, b| b.score.total_cmp(&a.score));
        tried
    }

    /// Two changes at once, from the best few.
    fn pair(&self, from: &State, tried: &[State]) -> Option<State> {
        let moves = || tried.iter().filter(|state| matches!(state.steps.last(), Some(Step::Move(_))));
        // what hardly moves, or is of another size, fits anything badly: units are always tried
        let is_unit = |state: &&State| match state.steps.last() {
            Some(Step::Move(number)) => self.moves[*number].effect == &UNIT_MISTAKE,
            _ => false,
        };
        let first: Vec<&State> = moves().take(BEAM).chain(moves().skip(BEAM).filter(is_unit)).collect();
        let grown =
            first.iter().flat_map(|state| self.extended_by_all(state, f64::NEG_INFINITY).into_iter().take(1));
        let mut grown: Vec<State> =
            grown.filter(|state| self.is_better(state, from) && !self.has_failed(state)).collect();
        grown.sort_by(|a, b| b.score.total_cmp(&a.score));
        grown.into_iter().next()
    }

    /// True where `after` is beyond doubt better than `before`.
    pub(super) fn is_better(&self, after: &State, before: &State) -> bool {
        let more = after.steps.len().saturating_sub(before.steps.len()) as f64;
        if after.score - before.score < ODDS * more.max(1.0) || !self.is_far(after) || !self.is_placed(after)
        {
            return false;
        }
        // a first guess that agrees now where it did not, with a fit that is good both times
        let agrees = !self.has_failed(before) && after.guess - before.guess > ODDS;
        // no physics makes a force so much larger or smaller
        agrees || self.is_of_force(after) || self.is_nearer(after, before)
    }

    fn is_of_force(&self, state: &State) -> bool {
        matches!(state.steps.last(), Some(Step::Move(number)) if self.moves[*number].force.is_some())
    }

    /// True where what differs between two states lies so many times nearer, and is enough.
    fn is_nearer(&self, after: &State, before: &State) -> bool {
        // in what the angles span before
        let unit = ((before.volume - after.volume) / (3 * after.thin.len().max(1)) as f64).exp();
        let sure = 3.0 * after.fit.scale * unit;
        let touched: Vec<(f64, f64)> = pairs(before, after)
            .into_iter()
            .map(|(old, new)| (old, new * unit))
            .filter(|(old, new)| (old - new).abs() > sure)
            .collect();
        // a part of the rows may be a small one
        let is_part =
            (after.steps.iter()).any(|step| matches!(step, Step::Part(..)) && !before.steps.contains(step));
        let share = if is_part { 0.0 } else { TOUCHED.0 };
        let least = (share * after.thin.len() as f64).max(TOUCHED.1 as f64);
        let (old, new): (Vec<f64>, Vec<f64>) = touched.into_iter().unzip();
        let (Some(old_middle), Some(new_middle)) = (median(&old), median(&new)) else { return false };
        // what a part of the rows holds makes them as good as the others
        let is_good =
            !is_part || median(&after.fit.residuals).is_some_and(|all| new_middle < NEARER * all * unit);
        old.len() as f64 >= least && old_middle > NEARER * new_middle && is_good
    }

    /// One change of a state against the state without it.
    fn judged(&self, best: &State, k: usize) -> Option<Found> {
        let rest = self.without(best, k)?;
        let square: f64 = pairs(&rest, best).iter().map(|(old, new)| old * old - new * new).sum();
        let explains = (square / best.thin.len().max(1) as f64).max(0.0).sqrt();
        let log_odds = (best.score - rest.score).min(700.0);
        let step = best.steps[k].clone();
        let alike: Vec<State> = self
            .extended(&rest, best.score - ALIKE)
            .into_iter()
            .filter(|state| best.score - state.score < ALIKE && state.steps.last() != Some(&step))
            .collect();
        let rivals = alike.iter().filter_map(|state| {
            let odds = (best.score - state.score).max(0.0).exp();
            let own = match (state.steps.last()?, &step) {
                (Step::Move(number), _) => return Some(self.moves[*number].with_odds(odds)),
                (Step::Part(number, _), Step::Part(known, _)) if number != known => &self.of_rows[*number],
                (Step::Part(number, _), Step::Elsewhere(_)) => &self.of_rows[*number],
                _ => return None,
            };
            let (effect, location, odds) = own.with_odds(odds);
            Some((effect, location.rows("in these poses"), odds))
        });
        let may_be_clamp = match &step {
            Step::Elsewhere(Change::Moved(_)) => alike.iter().find_map(|state| match state.steps.last() {
                Some(Step::Elsewhere(Change::Apart(clamp))) => Some(*clamp),
                _ => None,
            }),
            _ => None,
        };
        Some(Found { rivals: rivals.collect(), step, log_odds, explains, may_be_clamp })
    }
}

fn is_failed(fit: &Fit, reach: f64) -> bool {
    median(&fit.residuals).is_some_and(|left| left > FAILED * reach)
}

/// Residuals of the rows that two states have in common.
fn pairs(before: &State, after: &State) -> Vec<(f64, f64)> {
    let of_row = |row: usize| before.thin.rows.binary_search(&row).ok().map(|at| before.fit.residuals[at]);
    let rows = after.thin.rows.iter().zip(&after.fit.residuals);
    rows.filter_map(|(&row, &new)| Some((of_row(row)?, new))).collect()
}

/// Ln of how well the stated base and tip agree with those found; `most` is what each may cost.
fn guess(draft: &Draft, fit: &Fit, reach: f64, most: [f64; 2]) -> f64 {
    let saturated = |square: f64, most: f64| -most * -(-square / (2.0 * most)).exp_m1();
    let mut sum = 0.0;
    if let (Some(stated), Some(found)) = (&draft.base, fit.bases.first()) {
        let (way, angle) = moved(stated, found);
        let square = (way / (BASE.0 * reach)).powi(2) + (angle / BASE.1).powi(2);
        sum += saturated(square, most[0]);
    }
    if let Some(stated) = draft.tool.filter(|_| !draft.has_sockets()) {
        let square = ((stated - fit.tool).norm() / (TOOL.0 + TOOL.1 * stated.norm())).powi(2);
        sum += saturated(square, most[1]);
    }
    sum
}
