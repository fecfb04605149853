//! Slips of single rows: a number that was typed wrongly, a row in another unit, a row that stands
//! twice.
//!
//! A row that is far out was disturbed by anything, or a list of slips (`typed.rs`, and what may
//! happen to many rows) holds the one that brings it home. With s the scatter of the others, r the
//! row's distance as recorded and r' with a slip undone, of a list whose probabilities are p,
//!
//! ```text
//! ln odds = ln t₄(r'; s) + ln(4π/3·r³) + ln p        t₄ Student's density in space
//! ```
//!
//! For a disturbance it is as likely to lie anywhere within r. What has no such explanation stays.

mod copies;
mod held;
mod odds;
mod relabelled;
mod suspects;

use self::odds::{displacement, disturbance, ln_odds, ln_volume};
use self::suspects::Suspect;
use super::draft::{Cell, Draft, DraftChange};
use super::names::pose_name;
use super::quick::FAILED;
use super::search::part::Reference;
use super::search::{ALIKE, FittedDraft, MistakeSearch, ODDS};
use super::typed::{decimals, tidy};
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::effects::events::OUTLIER;
use crate::inference::{Effect, Estimate, Key};
use crate::units::{MM, significant};

/// Rows that are far out and looked at; the farthest first.
const MOST_ROWS: usize = 40;
/// A slip moves a row by so many times its distance, or as much less, or it is not looked at.
const AS_FAR: f64 = 2.0;
/// Share of the rows that are left out at most, and their number: more are no single ones.
const LEFT_OUT: (f64, usize) = (0.05, 2);
/// Something that happened to one row, or to a few.
pub(super) struct Slip {
    pub change: DraftChange,
    pub effect: &'static Effect,
    pub location: Key,
    pub estimates: Vec<Estimate>,
    pub cure: String,
    pub why: String,
    pub log_odds: f64,
    /// Root mean square over all rows of what it explains, m.
    pub explains: f64,
    /// What explains the row as well.
    pub rivals: Vec<(&'static Effect, Key)>,
}

impl MistakeSearch<'_> {
    /// What single rows hold beside the changes of `best`, in the order of the rows.
    pub(super) fn slips(&self, best: &FittedDraft, recording: &Recording) -> Vec<Slip> {
        if self.has_failed(best) {
            return Vec::new();
        }
        let mut draft = self.changed(&best.steps);
        let reference = Reference::of_all(&best.thin, &self.bodies[draft.body], &best.fit);
        let mut lengths = reference.lengths(&draft);
        let displaced = self.displaced_names(&draft, &reference, &lengths);
        if let Some(displaced) = &displaced {
            draft.apply(&displaced.change);
            lengths = reference.lengths(&draft);
        }
        let mut slips = self.copies(&draft, &lengths, reference.scale, recording);
        slips.extend(displaced);
        let is_known = |slips: &[Slip], row: usize| {
            slips.iter().any(|slip| matches!(&slip.change, DraftChange::Without(rows) if rows.contains(&row)))
        };
        let mut far: Vec<usize> = (0..draft.len()).filter(|&at| lengths[at] > reference.far).collect();
        far.retain(|&at| !is_known(&slips, draft.rows[at]));
        far.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
        far.truncate(MOST_ROWS);
        far.sort_unstable();
        let columns = self.columns(&draft);
        let mut lost: Vec<usize> = Vec::new();
        for at in far {
            match self.slip(&draft, at, &reference, lengths[at], &columns, recording) {
                Some(slip) => slips.push(slip),
                None => lost.push(at),
            }
        }
        // what many rows of a column have is no slip of one
        let most = LEFT_OUT.1.max((LEFT_OUT.0 * draft.len() as f64) as usize);
        let column = |slip: &Slip| match slip.change {
            DraftChange::Number { cell, .. } => Some(cell),
            _ => None,
        };
        let columns: Vec<Option<Cell>> = slips.iter().map(column).collect();
        slips.retain(|slip| {
            let own = column(slip);
            own.is_none() || columns.iter().filter(|other| **other == own).count() <= most
        });
        let reach = self.bodies[draft.body].reach;
        // apart from all others: what an effect does most to one pose it does to others nearly as
        // much
        let stays = |at: &usize| !lost.contains(at) && !is_known(&slips, draft.rows[*at]);
        let farthest = (0..draft.len()).filter(stays).map(|at| lengths[at]).fold(0.0, f64::max);
        lost.retain(|&at| lengths[at] > FAILED * reach && lengths[at] > AS_FAR * farthest);
        if lost.len() <= most {
            let scale = reference.scale;
            slips.extend(lost.into_iter().map(|at| left_out(&draft, at, lengths[at], scale, recording)));
        }
        slips
    }

    /// Decimals of the columns, joints first.
    fn columns(&self, draft: &Draft) -> Vec<usize> {
        let count = draft.joint_count;
        let of_joint = |joint: usize| {
            let unit = self.unit(draft, joint);
            decimals(draft.joints.iter().skip(joint).step_by(count).map(|value| tidy(value / unit)))
        };
        let of_axis = |axis: usize| decimals(draft.seen.iter().map(|seen| tidy(seen[axis] / MM)));
        (0..count).map(of_joint).chain((0..3).map(of_axis)).collect()
    }

    /// The slip that brings a row home, if one does.
    fn slip(
        &self,
        draft: &Draft,
        at: usize,
        reference: &Reference,
        length: f64,
        columns: &[usize],
        recording: &Recording,
    ) -> Option<Slip> {
        let row = draft.rows[at];
        let displacement = displacement(draft, recording);
        let mut suspects = self.typed(draft, at, columns, recording);
        suspects.extend(self.of_whole_row(draft, at, recording));
        let alone = |suspect: &Suspect| {
            let changed = match &suspect.change {
                // rows beside it are where its position stands
                DraftChange::Within(_, inner)
                    if matches!(**inner, DraftChange::Rows { .. } | DraftChange::Column { .. }) =>
                {
                    draft.with(&suspect.change)
                }
                change => draft.part(&[at]).with(change),
            };
            changed.rows.iter().position(|own| *own == row).map(|own| changed.part(&[own]))
        };
        let tried: Vec<Option<Draft>> = suspects.iter().map(alone).collect();
        let recorded = reference.offsets(&draft.part(&[at])).first().copied().unwrap_or_default();
        let (mut odds, mut total): (Vec<(f64, f64, usize)>, f64) = (Vec::new(), 0.0);
        for (k, changed) in tried.iter().enumerate() {
            let Some(changed) = changed else { continue };
            // the same by another name
            if tried[..k].iter().flatten().any(|known| is_same_row(known, changed)) {
                continue;
            }
            let Some(off) = reference.offsets(changed).first().copied() else { continue };
            // so far out only what moves the row about as far may have put it
            let way = (off - recorded).norm() / length;
            if (1.0 / AS_FAR..=AS_FAR).contains(&way) {
                total += suspects[k].log_prior.exp();
                let left = off.norm();
                let volume = ln_volume(&suspects[k].change, length, displacement);
                odds.push((ln_odds(volume, left, reference.scale) + suspects[k].log_prior, left, k));
            }
        }
        odds.iter_mut().for_each(|odds| odds.0 -= total.max(1.0).ln());
        odds.sort_by(|a, b| b.0.total_cmp(&a.0));
        let &(log_odds, left, best) = odds.first()?;
        if log_odds < ODDS {
            return None;
        }
        let is_alike = |other: &&(f64, f64, usize)| {
            log_odds - other.0 < ALIKE && suspects[other.2].location != suspects[best].location
        };
        let mut rivals: Vec<(&'static Effect, Key)> = Vec::new();
        for other in odds[1..].iter().filter(is_alike) {
            let rival = (suspects[other.2].effect, suspects[other.2].location.clone());
            if !rivals.contains(&rival) {
                rivals.push(rival);
            }
        }
        let suspect = suspects.swap_remove(best);
        let explains = ((length.powi(2) - left.powi(2)).max(0.0) / draft.len().max(1) as f64).sqrt();
        let Suspect { effect, change, location, cure, why, estimates, .. } = suspect;
        Some(Slip { change, effect, location, estimates, cure, why, log_odds, explains, rivals })
    }
}

fn is_same_row(a: &Draft, b: &Draft) -> bool {
    a.group == b.group && a.joints == b.joints && a.seen == b.seen && a.body == b.body
}

/// A row that nothing explains, and that would spoil the others.
fn left_out(draft: &Draft, at: usize, length: f64, scale: f64, recording: &Recording) -> Slip {
    let row = draft.rows[at];
    let pose = pose_name(recording, row);
    Slip {
        change: DraftChange::Without(vec![row]),
        effect: &OUTLIER.effect,
        location: Key::new(&pose),
        estimates: vec![Estimate::new("off_um", length, length, length)],
        cure: format!("Leave out {pose}, or measure it anew"),
        why: format!("its angles and its position are {} mm apart", significant(length / MM, 3)),
        log_odds: disturbance(length, scale),
        explains: (length.powi(2) / draft.len().max(1) as f64).sqrt(),
        rivals: Vec::new(),
    }
}
