//! Rows that repeat others to the last digit.

use super::super::columns::agreement;
use super::super::draft::{Draft, DraftChange};
use super::super::names::poses;
use super::super::search::MistakeSearch;
use super::super::search::part::FAR;
use super::super::typed::{decimals, tidy};
use super::Slip;
use super::odds::disturbance;
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::effects::mistakes::COPY_MISTAKE;
use crate::inference::Key;
use crate::units::MM;

/// Fewest neighbours that stand twice: single rows may agree by chance.
const FEWEST_COPIES: usize = 3;
/// Times that the last digit goes into the scatter at least where equal numbers are no chance.
const FINE: f64 = 5.0;
/// Numbers that differ by less are the same, rad or m.
const SAME: f64 = 1e-12;

impl MistakeSearch<'_> {
    /// Rows that repeat others to the last digit: neighbours that stand twice, and rows that are
    /// far out with the position of another one.
    pub(super) fn copies(
        &self,
        draft: &Draft,
        lengths: &[f64],
        scale: f64,
        recording: &Recording,
    ) -> Vec<Slip> {
        if draft.has_sockets() {
            return Vec::new();
        }
        let coarse = (0..3).map(|axis| {
            let places = decimals(draft.seen.iter().map(|seen| tidy(seen[axis] / MM)));
            MM * 0.1f64.powi(places as i32)
        });
        if coarse.fold(0.0, f64::max) * FINE > scale {
            return Vec::new();
        }
        let mut order: Vec<usize> = (0..draft.len()).collect();
        let key = |at: usize| draft.seen[at];
        order.sort_by(|&a, &b| {
            let axes = (0..3).map(|axis| key(a)[axis].total_cmp(&key(b)[axis]));
            axes.fold(a.cmp(&a), |known, next| known.then(next)).then(a.cmp(&b))
        });
        // of each row the first one with the same position
        let mut first: Vec<usize> = (0..draft.len()).collect();
        for pair in order.windows(2) {
            let is_same = (key(pair[0]) - key(pair[1])).amax() < SAME;
            if is_same {
                first[pair[1]] = first[pair[0]];
            }
        }
        let is_far = |at: usize| lengths[at] > FAR * scale;
        let angles = |a: usize, b: usize| {
            let pairs = draft.joints(a).iter().zip(draft.joints(b));
            pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) < SAME
        };
        let copy_at = |at: usize| match first[at] {
            other if other == at => None,
            other if angles(at, other) => {
                (draft.group[at] == draft.group[other]).then_some((at, other, true))
            }
            // which of the two is the copy is seen by which one does not fit
            other if is_far(at) && !is_far(other) => Some((at, other, false)),
            other if is_far(other) && !is_far(at) => Some((other, at, false)),
            _ => None,
        };
        let mut pairs: Vec<(usize, usize, bool)> = (0..draft.len()).filter_map(copy_at).collect();
        pairs.sort_unstable();
        let runs = pairs.chunk_by(|a, b| a.0 + 1 == b.0 && a.1 + 1 == b.1 && a.2 == b.2);
        let counts = |run: &&[(usize, usize, bool)]| !run[0].2 || run.len() >= FEWEST_COPIES;
        runs.filter(counts).map(|run| copy(draft, (lengths, scale), run, recording)).collect()
    }
}

fn copy(
    draft: &Draft,
    (lengths, scale): (&[f64], f64),
    run: &[(usize, usize, bool)],
    recording: &Recording,
) -> Slip {
    let named = |member: fn(&(usize, usize, bool)) -> usize| {
        let rows = || run.iter().map(member).map(|at| draft.rows[at]);
        poses(recording, rows().next().unwrap_or(0), rows().next_back().unwrap_or(0))
    };
    let (copies, originals) = (named(|pair| pair.0), named(|pair| pair.1));
    let square: f64 = run.iter().map(|pair| lengths[pair.0].powi(2)).sum();
    let (of_position, of_angles) = (agreement(3), agreement(draft.joint_count));
    let log_odds = run.iter().map(|pair| match pair.2 {
        true => of_position + of_angles,
        false => of_position + disturbance(lengths[pair.0], scale),
    });
    let what = match (run[0].2, run.len()) {
        (true, _) => format!("they repeat {originals} to the last digit"),
        (false, 1) => format!("its position is that of {originals} to the last digit"),
        (false, _) => format!("their positions are those of {originals} to the last digit"),
    };
    Slip {
        change: DraftChange::Without(run.iter().map(|pair| draft.rows[pair.0]).collect()),
        effect: &COPY_MISTAKE,
        location: Key::new(&copies),
        estimates: Vec::new(),
        cure: format!("Leave out {copies}, or measure anew"),
        why: what,
        log_odds: log_odds.sum(),
        explains: (square / draft.len().max(1) as f64).sqrt(),
        rivals: Vec::new(),
    }
}
