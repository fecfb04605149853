//! Rows in which a display stood still or was cut off, where they do not fit what the others say.

use super::super::draft::{Draft, DraftChange};
use super::super::held::Held;
use super::super::names::poses;
use super::super::search::part::Reference;
use super::super::search::{FittedDraft, MistakeSearch};
use super::Slip;
use crate::calibration::campaign::Recording;
use crate::inference::Key;
use crate::statistics::median;

/// Rows do not fit where half of them are so many times as far out as half of the others.
const FARTHER: f64 = 1.5;

impl MistakeSearch<'_> {
    /// Those of `all` that do not fit what the other rows say, of the rows of `draft`.
    pub(in super::super) fn held_slips(
        &self,
        recording: &Recording,
        (best, draft): (&FittedDraft, &Draft),
        all: &[Held],
    ) -> Vec<Slip> {
        if all.is_empty() || self.has_failed(best) {
            return Vec::new();
        }
        let steps = best.steps.iter();
        let draft = steps.fold(draft.clone(), |draft, step| draft.with(self.change(step)));
        let reference = Reference::of_all(&best.thin, &self.bodies[draft.body], &best.fit);
        let lengths = reference.lengths(&draft);
        let is_held = |row: &usize| all.iter().any(|held| held.rows.contains(row));
        let of_rows = |is_there: &dyn Fn(&usize) -> bool| -> Vec<f64> {
            let own = draft.rows.iter().zip(&lengths).filter(|(row, _)| is_there(row));
            own.map(|(_, length)| *length).collect()
        };
        let Some(usual) = median(&of_rows(&|row| !is_held(row))) else { return Vec::new() };
        let mut known: Vec<usize> = Vec::new();
        let mut slips = Vec::new();
        for held in all {
            let own = of_rows(&|row| held.rows.contains(row));
            if !median(&own).is_some_and(|median| median > FARTHER * usual) {
                continue;
            }
            let names = held.names();
            let (first, last) = (held.rows[0], held.rows[held.rows.len() - 1]);
            let there = poses(recording, first, last);
            let (location, cure) = match held.is_limit {
                true => {
                    let these = format!("the {} poses in which {names} is cut off", held.rows.len());
                    (Key::new(&names), format!("Leave out {these}, or use a sensor of a longer range"))
                }
                false => (Key::new(&names).rows(&there), format!("Leave out {there}, or measure anew")),
            };
            let rows: Vec<usize> = held.rows.iter().copied().filter(|row| !known.contains(row)).collect();
            known.extend(&rows);
            let square: f64 = own.iter().map(|length| length * length).sum();
            slips.push(Slip {
                change: DraftChange::Without(rows),
                effect: held.effect(),
                location,
                estimates: held.estimates(),
                cure,
                why: format!("{names} {}", held.said()),
                log_odds: held.log_odds,
                explains: (square / draft.len().max(1) as f64).sqrt(),
                rivals: Vec::new(),
            });
        }
        slips
    }
}
