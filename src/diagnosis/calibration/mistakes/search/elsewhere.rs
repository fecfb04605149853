//! Where tracker, base or a clamp may have stood elsewhere for some rows.

use nalgebra::{Matrix3, Vector3};

use super::super::draft::{Draft, DraftChange, Tether};
use super::super::motion::moved;
use super::super::quick::{FAILED, Fit, Worthwhile, fit_from};
use super::moved_fixtures::KNOCKED;
use super::{FittedDraft, MistakeSearch, ODDS, SearchStep};
use crate::statistics::median;
use crate::units::MM;

/// Rows after which a move of the base is tried first.
const PLACES: usize = 24;
/// Fewest rows of a station.
pub const LEAST_ROWS: usize = 4;
/// Width of the points of a station, as a share of the reach; see [`width`].
pub const WIDTH: f64 = 0.02;
/// The least that is called a move of the base: smaller ones are left to the effects, which
/// distinguish them from drift.
const LEAST_MOVE: (f64, f64) = (2.0 * MM, 2e-3);

impl MistakeSearch<'_> {
    /// Where tracker, base or a clamp may have been elsewhere.
    pub fn elsewhere(&self, from: &FittedDraft) -> Vec<DraftChange> {
        if self.draft.has_sockets() {
            return Vec::new();
        }
        let rows = &from.thin.rows;
        let count = rows.len();
        let mut places: Vec<usize> = (1..PLACES).map(|k| k * count / PLACES).collect();
        places.dedup();
        let reach = self.bodies[from.thin.body].reach;
        let is_placed = |rows: &[usize]| rows.len() >= LEAST_ROWS && width(&from.thin, rows) > WIDTH * reach;
        let is_two = |&at: &usize| {
            let station = from.thin.station[at];
            let (before, after): (Vec<usize>, Vec<usize>) =
                (0..count).filter(|&row| from.thin.station[row] == station).partition(|&row| row < at);
            is_placed(&before) && is_placed(&after)
        };
        let mut all: Vec<DraftChange> =
            places.into_iter().filter(is_two).map(|at| DraftChange::Moved(rows[at])).collect();
        let clamps = self.draft.devices.len();
        if clamps > 2 {
            let rows_of =
                |k: usize| (0..count).filter(move |&row| from.thin.group[row] == k).collect::<Vec<_>>();
            all.extend((0..clamps).filter(|&k| is_placed(&rows_of(k))).map(DraftChange::Apart));
        }
        all
    }

    /// False where a base moved by so little that the effects find it.
    pub fn is_far(&self, state: &FittedDraft) -> bool {
        match state.steps.last() {
            Some(SearchStep::Elsewhere(DraftChange::Placed(clamp))) => self.is_displaced(state, *clamp),
            Some(SearchStep::Elsewhere(DraftChange::Devices(_))) => true,
            Some(SearchStep::Elsewhere(DraftChange::Moved(first))) => {
                is_large(&state.fit) && self.has_to_be_large(state, *first)
            }
            Some(SearchStep::Elsewhere(_)) => is_large(&state.fit),
            _ => true,
        }
    }

    /// False where a small move explains about as much as that of `state`, by itself or with one
    /// fixture that was knocked: few clamps, or points on a line, leave a turn open, and the place
    /// of a base far from them with it; and one clamp that moved turns the others about it.
    fn has_to_be_large(&self, state: &FittedDraft, first: usize) -> bool {
        let thin = &state.thin;
        let (Some(new), Some(at)) =
            (thin.stations.checked_sub(1), thin.rows.iter().rposition(|&row| row < first))
        else {
            return true;
        };
        let (way, turn) = LEAST_MOVE;
        let tether = Tether { stations: [thin.station[at], new], way, turn };
        let tied = Draft { tether: Some(tether), ..thin.clone() };
        let explains = |draft: &Draft, price: f64| {
            let near = fit_from(draft, &self.bodies[thin.body], &state.fit, state.fit.rough);
            near.is_some_and(|near| {
                !is_large(&near) && near.log_likelihood + price + ODDS > state.fit.log_likelihood
            })
        };
        let knocked = |fixture: usize, station: usize| {
            let is_own = |&at: &usize| thin.group[at] == fixture && thin.station[at] == station;
            let rows: Vec<usize> = (0..thin.len()).filter(is_own).collect();
            !rows.is_empty() && explains(&tied.knocked(&rows, fixture), KNOCKED)
        };
        let mut with_one = (0..thin.devices.len()).filter(|_| thin.devices.len() > 2);
        !explains(&tied, 0.0)
            && !with_one.any(|fixture| tether.stations.iter().any(|&station| knocked(fixture, station)))
    }

    /// False where a frame of its own does not make the rows fit that stood elsewhere.
    pub fn is_placed(&self, state: &FittedDraft) -> bool {
        let Some(SearchStep::Elsewhere(change)) = state.steps.last() else { return true };
        if !change.adds_station() {
            return true;
        }
        let station = state.thin.stations - 1;
        let rows = state.thin.station.iter().zip(&state.fit.residuals);
        let own: Vec<f64> = rows.filter(|(own, _)| **own == station).map(|(_, left)| *left).collect();
        median(&own).is_some_and(|left| left < FAILED * self.bodies[state.thin.body].reach)
    }

    /// A move of the base at the very row.
    pub fn sharpened(&self, state: FittedDraft) -> FittedDraft {
        let mut state = self.turned_again(&state).unwrap_or(state);
        for _ in 0..3 {
            let Some(SearchStep::Elsewhere(DraftChange::Moved(first))) = state.steps.last().cloned() else {
                return state;
            };
            let draft = self.changed(&state.steps);
            let new = draft.stations - 1;
            let before = self.changed(&state.steps[..state.steps.len() - 1]);
            let at = before.rows.iter().position(|&row| row >= first).unwrap_or(0);
            let old = before.station[at];
            let body = &self.bodies[draft.body];
            let rows: Vec<usize> = (0..draft.len()).filter(|&row| before.station[row] == old).collect();
            let part = draft.part(&rows);
            let cost = |lengths: Vec<f64>| -> Vec<f64> {
                lengths.iter().map(|r| (r / state.fit.scale).powi(2).ln_1p()).collect()
            };
            let (here, there) =
                (cost(state.fit.lengths_at(&part, body, old)), cost(state.fit.lengths_at(&part, body, new)));
            let mut sum: f64 = there.iter().sum();
            let (mut least, mut best) = (f64::INFINITY, 0);
            for k in 0..rows.len() {
                if sum < least && k >= LEAST_ROWS && k + LEAST_ROWS <= rows.len() {
                    (least, best) = (sum, k);
                }
                sum += here[k] - there[k];
            }
            let row = part.rows[best];
            if row == first {
                return state;
            }
            let mut steps = state.steps.clone();
            if let Some(last) = steps.last_mut() {
                *last = SearchStep::Elsewhere(DraftChange::Moved(row));
            }
            match self.state(&steps, Worthwhile::ANY) {
                Some(next) if next.score > state.score => state = next,
                _ => return state,
            }
        }
        state
    }
}

/// False where the last station is where the first one was, but for a move that is left to the
/// effects.
fn is_large(fit: &Fit) -> bool {
    match &fit.bases[..] {
        [first, .., last] => {
            let (way, angle) = moved(first, last);
            way > LEAST_MOVE.0 || angle > LEAST_MOVE.1
        }
        _ => true,
    }
}

/// How far apart some points lie at least, across their longest direction, m (root mean square): no
/// frame can be placed on points in one spot or on one line.
pub fn width(draft: &Draft, rows: &[usize]) -> f64 {
    let points = || rows.iter().map(|&row| draft.point(row));
    let mean = points().sum::<Vector3<f64>>() / rows.len().max(1) as f64;
    let spread: Matrix3<f64> = points().map(|p| (p - mean) * (p - mean).transpose()).sum();
    let mut values: Vec<f64> =
        (spread / rows.len().max(1) as f64).symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values.get(1).map_or(0.0, |second| second.max(0.0).sqrt())
}
