//! States whose changes concern some rows alone.
//!
//! A mistake of a third of the rows spoils a fit of all, so the rows of several windows are fitted
//! by themselves too: one of them is free of it. About each fit every change is tried on every row
//! (`part.rs`); the best few stretches become states, which the search compares with all others.

use super::super::draft::{DraftChange, Rows};
use super::super::quick::{Fit, Worthwhile, fit, fit_from};
use super::part::{ELSEWHERE, Reference, most, within};
use super::{FittedDraft, MistakeSearch, SearchStep};
use crate::parallel::in_parallel;
use crate::statistics::median;
use crate::units::DEG;

/// Windows of the rows that are fitted by themselves, as shares of them; one that ends before it
/// begins goes on with the first rows.
///
/// Clamps are visited one after another: where the rows between are spoilt, one end alone has seen
/// a single clamp, which says nothing of where the base stands. Both ends together have seen two.
const WINDOWS: [(f64, f64); 10] = [
    (0.0, 0.5),
    (0.5, 1.0),
    (0.0, 0.67),
    (0.33, 1.0),
    (0.0, 0.34),
    (0.33, 0.67),
    (0.66, 1.0),
    (0.67, 0.33),
    (0.75, 0.25),
    (0.83, 0.17),
];
/// Fewest rows that are so many scales out before parts are looked at; or a window that scatters so
/// much less than all.
const FEWEST: usize = 3;
const FAR: f64 = 5.0;
const UNLIKE: f64 = 0.4;
/// A displacement in a clamp is distinguished from none, or from another one, where it is so many
/// scatters large.
const DISTINCT: f64 = 10.0;
/// Least step of a joint's zero that somebody made: a coupling slips by a milliradian or two by
/// itself, rad (m of a prismatic joint).
const LEAST_ZERO: f64 = 0.15 * DEG;
/// Stretches that become states, of each reference.
const MOST: usize = 3;

/// A change of some rows, about one of several fits.
struct Place {
    /// The number of the reference that shows it.
    seen_from: usize,
    number: usize,
    rows: Rows,
    gain: f64,
    change: DraftChange,
}

impl MistakeSearch<'_> {
    /// The state with a change of some rows alone, where rows do not fit.
    pub fn partial(&self, from: &FittedDraft) -> Vec<FittedDraft> {
        let starts = self.starts(from);
        let far = from.fit.residuals.iter().filter(|left| **left > FAR * from.fit.scale).count();
        let is_one = starts.iter().all(|start| start.scale > UNLIKE * from.fit.scale);
        if far < FEWEST && is_one && !self.has_failed(from) {
            return Vec::new();
        }
        let draft = self.changed(&from.steps);
        let body = &self.bodies[from.thin.body];
        // what leaves nothing that fits is worth a second look from farther away
        let off = if self.has_failed(from) { &ELSEWHERE[..] } else { &ELSEWHERE[..1] };
        let of_some = |off: &f64| {
            (1..starts.len())
                .map(|k| (k, Reference::of_some(&from.thin, body, &starts[k], *off)))
                .collect::<Vec<_>>()
        };
        let mut references = vec![(0, Reference::of_all(&from.thin, body, &starts[0]))];
        references.extend(off.iter().flat_map(of_some));
        let lengths: Vec<Vec<f64>> =
            references.iter().map(|(_, reference)| reference.lengths(&from.thin)).collect();
        let places = in_parallel(self.of_rows.len(), |number| {
            let own = &self.of_rows[number];
            let changed = self.thinned(&draft.with(&own.change));
            let entry = |k: usize| {
                let (_, reference) = &references[k];
                if let DraftChange::Zero { joint, .. } = own.change {
                    let far: Vec<usize> =
                        (0..from.thin.len()).filter(|&at| lengths[k][at] > reference.far).collect();
                    let (by, _) = reference.zero(&from.thin, joint, &far)?;
                    // what slips by itself is no mistake
                    if by.abs() < LEAST_ZERO {
                        return None;
                    }
                    let change = DraftChange::Zero { joint, by };
                    let gains = reference.gains(&from.thin, &lengths[k], &from.thin.with(&change));
                    let (rows, gain) = most(&from.thin, &gains)?;
                    return Some(Place { seen_from: k, number, rows, gain, change });
                }
                let gains = reference.gains(&from.thin, &lengths[k], &changed);
                let (rows, gain) = most(&from.thin, &gains)?;
                Some(Place { seen_from: k, number, rows, gain, change: own.change.clone() })
            };
            (0..references.len()).filter_map(entry).collect::<Vec<_>>()
        });
        let mut all: Vec<Place> = places.into_iter().flatten().collect();
        all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let mut chosen: Vec<Place> = Vec::new();
        let mut taken = vec![0; references.len()];
        for place in all {
            let is_known =
                chosen.iter().any(|known| known.number == place.number && known.rows == place.rows);
            if taken[place.seen_from] < MOST && !is_known {
                taken[place.seen_from] += 1;
                chosen.push(place);
            }
        }
        let is_part = |place: &Place| {
            (from.thin.rows.iter().zip(&from.thin.group))
                .filter(|(row, group)| place.rows.contain(**row, **group))
                .count()
                >= FEWEST
        };
        chosen.retain(is_part);
        // in a clamp what makes displacements small, or exchanges them, is seen beside a small
        // scatter alone
        let is_small = |change: &DraftChange| match change {
            DraftChange::Seen(matrix) => matrix.determinant().abs() < 1.0,
            DraftChange::Rows { .. } => true,
            _ => false,
        };
        let blurred = DISTINCT * from.fit.scale.min(starts.iter().map(|s| s.scale).fold(f64::MAX, f64::min));
        let sizes: Vec<f64> = from.thin.seen.iter().map(|seen| seen.norm()).collect();
        let is_blurred = from.thin.devices.len() > 1 && median(&sizes).is_some_and(|size| size < blurred);
        chosen.retain(|place| !is_blurred || !is_small(&place.change));
        let states = in_parallel(chosen.len(), |at| {
            let Place { seen_from, number, rows, change, .. } = &chosen[at];
            let mut steps = from.steps.clone();
            steps.push(SearchStep::Part(*number, within(*rows, change)));
            self.begun(&steps, &starts[references[*seen_from].0])
        });
        states.into_iter().flatten().collect()
    }

    /// A stretch at its very rows; of displaced rows by all that may have been displaced.
    pub fn sharpened_part(&self, state: FittedDraft) -> FittedDraft {
        let Some(SearchStep::Part(number, DraftChange::Within(Rows::Between(first, last), inner))) =
            state.steps.last()
        else {
            return state;
        };
        let own = &self.of_rows[*number];
        let earlier = &state.steps[..state.steps.len() - 1];
        let before = self.changed(earlier);
        let body = &self.bodies[before.body];
        let reference = Reference::of_all(&state.thin, body, &state.fit);
        let lengths = reference.lengths(&before);
        let mut best: Option<Place> = None;
        for (number, other) in self.of_rows.iter().enumerate() {
            let change = match (&other.change, &**inner) {
                (DraftChange::Zero { joint, .. }, DraftChange::Zero { joint: known, .. })
                    if joint == known =>
                {
                    let is_inside = |at: &usize| (*first..=*last).contains(&before.rows[*at]);
                    let rows: Vec<usize> = (0..before.len()).filter(is_inside).collect();
                    let Some((by, _)) = reference.zero(&before, *joint, &rows) else { continue };
                    DraftChange::Zero { joint: *joint, by }
                }
                (DraftChange::Rows { .. }, DraftChange::Rows { .. }) => other.change.clone(),
                (change, inner) if change == inner && other.location == own.location => change.clone(),
                _ => continue,
            };
            let gains = reference.gains(&before, &lengths, &before.with(&change));
            let Some((rows, gain)) = most(&before, &gains) else { continue };
            let gain = gain + other.log_prior;
            if best.as_ref().is_none_or(|best| gain > best.gain) {
                best = Some(Place { seen_from: 0, number, rows, gain, change });
            }
        }
        let Some(Place { number, rows, change, .. }) = best else { return state };
        let mut steps = earlier.to_vec();
        steps.push(SearchStep::Part(number, within(rows, &change)));
        match self.begun(&steps, &state.fit) {
            // rows between those that a fit sees change nothing of its score
            Some(next) if next.score > state.score - 2.0 => next,
            _ => state,
        }
    }

    /// The standard error of a zero that was found in some rows, rad or m.
    pub fn error_of_zero(&self, state: &FittedDraft, rows: Rows, joint: usize) -> f64 {
        let draft = self.changed(&state.steps);
        let reference = Reference::of_all(&state.thin, &self.bodies[draft.body], &state.fit);
        let is_inside = |at: &usize| rows.contain(draft.rows[*at], draft.group[*at]);
        let inside: Vec<usize> = (0..draft.len()).filter(is_inside).collect();
        reference.zero(&draft, joint, &inside).map_or(0.0, |(_, error)| error)
    }

    /// Ln of how many stretches a change may have concerned.
    pub fn log_stretches(&self, change: &DraftChange) -> f64 {
        let count = self.draft.len().max(1) as f64;
        match change {
            DraftChange::Within(Rows::Between(first, last), _) => {
                let is_to_the_end = *first == 0 || self.draft.rows.last() == Some(last);
                if is_to_the_end { count.ln() } else { 2.0 * count.ln() }
            }
            _ => (self.draft.devices.len().max(1) as f64).ln(),
        }
    }

    /// The fit of all rows, then those of windows.
    fn starts(&self, from: &FittedDraft) -> Vec<Fit> {
        let body = &self.bodies[from.thin.body];
        let of_windows = in_parallel(WINDOWS.len(), |k| {
            fit(&from.thin.part(&within_window(WINDOWS[k], from.thin.len())), body, Worthwhile::ANY)
        });
        std::iter::once(from.fit.clone()).chain(of_windows.into_iter().flatten()).collect()
    }

    /// A state whose fit begins roughly or with that of another one, whichever is more probable.
    fn begun(&self, steps: &[SearchStep], start: &Fit) -> Option<FittedDraft> {
        let thin = self.thinned(&self.changed(steps));
        let body = &self.bodies[thin.body];
        let rough = fit(&thin, body, Worthwhile::ANY);
        let known = fit_from(&thin, body, start, rough.as_ref().map_or(start.rough, |fit| fit.rough));
        let fit = match (rough, known) {
            (Some(rough), Some(known)) if known.log_likelihood > rough.log_likelihood => known,
            (Some(fit), _) | (None, Some(fit)) => fit,
            (None, None) => return None,
        };
        Some(self.scored(steps.to_vec(), thin, fit))
    }
}

/// The rows of a window, of so many.
fn within_window((first, last): (f64, f64), count: usize) -> Vec<usize> {
    let [first, last] = [first, last].map(|share| (share * count as f64) as usize);
    match first < last {
        true => (first..last).collect(),
        false => (0..last).chain(first..count).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::within_window;

    #[test]
    fn a_window_that_goes_round() {
        assert_eq!(within_window((0.25, 0.75), 8), [2, 3, 4, 5]);
        assert_eq!(within_window((0.75, 0.25), 8), [0, 1, 6, 7]);
    }
}
