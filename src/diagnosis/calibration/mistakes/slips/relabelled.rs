//! Placements and sockets that stand some rows away from the angles that belong to them.
//!
//! Of blocks of rows in one socket each only the rows where a block begins are in the wrong one:
//! they are far out, and fit where the rows beside them do.

use super::super::draft::{Draft, DraftChange};
use super::super::moves::exact;
use super::super::search::MistakeSearch;
use super::super::search::part::Reference;
use super::Slip;
use crate::diagnosis::calibration::effects::mistakes::ROW_MISTAKE;
use crate::inference::Key;

/// Farthest displacement that is tried.
const FARTHEST: isize = 3;
/// Rows that come into another socket, at least: one or two are slips of their own.
const FEWEST: usize = 3;
/// Share of them that is far out as recorded, and not so then.
const MOST: f64 = 0.8;

impl MistakeSearch<'_> {
    /// The displacement that brings home most of the rows where sockets change, the least of them.
    pub fn displaced_names(&self, draft: &Draft, reference: &Reference, lengths: &[f64]) -> Option<Slip> {
        if !draft.has_sockets() {
            return None;
        }
        let tried = (1..=FARTHEST).flat_map(|by| [by, -by]);
        let all = tried.filter_map(|by| self.names(draft, reference, lengths, by));
        let best = all.reduce(|best, own| if own.0 > best.0 { own } else { best });
        best.map(|(_, slip)| slip)
    }

    /// How many rows a displacement brings home, and what is said of it.
    fn names(
        &self,
        draft: &Draft,
        reference: &Reference,
        lengths: &[f64],
        by: isize,
    ) -> Option<(usize, Slip)> {
        let change = DraftChange::Rows { by, with_clamps: true };
        let moved = draft.with(&change);
        let there = reference.lengths(&moved);
        let mut touched = Vec::new();
        for (at, row) in moved.rows.iter().enumerate() {
            let Ok(before) = draft.rows.binary_search(row) else { continue };
            if moved.group[at] != draft.group[before] {
                touched.push((lengths[before], there[at]));
            }
        }
        let is_home = |(before, after): &&(f64, f64)| *before > reference.far && *after < reference.far;
        let home = touched.iter().filter(is_home).count();
        if touched.len() < FEWEST || (home as f64) < MOST * touched.len() as f64 {
            return None;
        }
        let square: f64 = touched.iter().map(|(before, after)| before * before - after * after).sum();
        let (count, way) = (by.unsigned_abs(), if by > 0 { "up" } else { "down" });
        let rows = if count == 1 { "row" } else { "rows" };
        let there = if by > 0 { "above" } else { "below" };
        let slip = Slip {
            change,
            effect: &ROW_MISTAKE,
            location: Key::new("placement, socket"),
            estimates: exact("rows", by as f64),
            cure: format!("Move placement and socket {count} {rows} {way}"),
            why: format!("each belongs to the angles {count} {rows} {there}"),
            log_odds: reference.gains(draft, lengths, &moved).iter().sum(),
            explains: (square.max(0.0) / draft.len().max(1) as f64).sqrt(),
            rivals: Vec::new(),
        };
        Some((home, slip))
    }
}
