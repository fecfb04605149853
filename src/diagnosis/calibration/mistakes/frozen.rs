//! Joints whose readings stood still while the arm moved on.
//!
//! A joint that does not move may be meant not to. Rows in which its column shows one value, by
//! more than chance (`held.rs`), are suspected only where they do not fit what the others say and
//! another value of this one joint, a different one in each row, brings them home:
//!
//! ```text
//! rᵢ > 8·s,   min over q of rᵢ(q) < 8·s       s the scatter of the others, r the distance of a row
//! ```
//!
//! One number moves a tip along a curve: three coordinates do not meet it by chance. Where all
//! joints show one value, some angles of theirs meet any point: there it is enough that the rows
//! lie far out. What is the same number in all of these rows is another zero, and no joint that
//! stood still.

use super::draft::{Cell, Draft, DraftChange};
use super::held::equal_neighbours;
use super::names::{column, poses};
use super::quick::{FAILED, Worthwhile, fit};
use super::search::part::{ELSEWHERE, Reference};
use super::search::{FittedDraft, MistakeSearch};
use super::slips::Slip;
use crate::calibration::campaign::Recording;
use crate::diagnosis::calibration::effects::mistakes::STUCK_SENSOR;
use crate::inference::{Estimate, Key};
use crate::robot::Motion;
use crate::statistics::median;
use crate::units::{DEG, MM, significant};

/// Fewest equal values of a joint, one after the other, that are looked at: the first is right.
const FEWEST: usize = 4;
/// Fewest rows that must be left to say where the others belong.
const FEWEST_OTHERS: usize = 12;
/// Fewest other rows that say where a socket is.
const FEWEST_IN_SOCKET: usize = 3;
/// Stretches that are looked at, the longest first.
const MOST_STRETCHES: usize = 8;
/// Share of the rows that are far out which must come home.
const HOME: f64 = 0.8;
/// Values, in the middle so far from their middle at least, that are no other zero, rad or m.
const APART: f64 = 0.2 * DEG;
/// Values that are tried along a turn, then steps of Newton's from the best of them.
const TRIED: usize = 72;
const STEPS: usize = 6;
/// A turn that shows in which direction a tip moves, rad or m.
const SMALL: f64 = 1e-6;

/// Rows in which one joint, or all of them, show one value.
pub(super) struct Frozen {
    joints: Vec<usize>,
    /// By their numbers in the recording.
    pub rows: Vec<usize>,
    /// What each joint shows, rad or m.
    values: Vec<f64>,
    log_odds: f64,
    /// Root mean square over all rows of how far they are out, m.
    explains: f64,
    /// The least and the largest value that these poses say instead.
    meant: Option<(f64, f64)>,
}

/// All stretches in which joints show one value, the longest first.
fn stretches(draft: &Draft) -> Vec<Frozen> {
    let count = draft.joint_count;
    let mut all: Vec<Frozen> = Vec::new();
    for joint in 0..count {
        let values: Vec<f64> = draft.joints.iter().skip(joint).step_by(count).copied().collect();
        for (at, log_odds) in equal_neighbours(&values, FEWEST) {
            let value = values[at[0]];
            let rows: Vec<usize> = at.iter().map(|&at| draft.rows[at]).collect();
            match all.iter_mut().find(|known| known.rows == rows) {
                Some(known) => {
                    known.joints.push(joint);
                    known.values.push(value);
                    known.log_odds += log_odds;
                }
                None => all.push(Frozen {
                    joints: vec![joint],
                    rows,
                    values: vec![value],
                    log_odds,
                    explains: 0.0,
                    meant: None,
                }),
            }
        }
    }
    // several of them, but not all, are met by any point, and are what a plan of poses holds still
    all.retain(|frozen| frozen.joints.len() == 1 || frozen.joints.len() == count);
    all.retain(|frozen| draft.len() >= frozen.rows.len() + FEWEST_OTHERS);
    all.sort_by_key(|frozen| std::cmp::Reverse(frozen.rows.len()));
    all.truncate(MOST_STRETCHES);
    all
}

impl MistakeSearch<'_> {
    /// The stretches of `draft` in which joints stood still in the file but not in truth, beside
    /// the changes of `best` or beside none.
    pub(super) fn frozen(&self, draft: &Draft, best: Option<&FittedDraft>) -> Vec<Frozen> {
        let mut found: Vec<Frozen> = Vec::new();
        let mut rest = draft.clone();
        let steps = best.filter(|best| !best.steps.is_empty() && !self.has_failed(best));
        for stretch in stretches(draft) {
            let others = rest.with(&DraftChange::Without(stretch.rows.clone()));
            if others.len() < FEWEST_OTHERS {
                continue;
            }
            let plain = self.confirmed_frozen(&stretch, &others, draft);
            let beside = || {
                let with = |draft: &Draft| {
                    let steps = steps?.steps.iter();
                    Some(steps.fold(draft.clone(), |draft, step| draft.with(self.change(step))))
                };
                self.confirmed_frozen(&stretch, &with(&others)?, &with(draft)?)
            };
            if let Some(confirmed) = plain.or_else(beside) {
                rest = rest.with(&DraftChange::Without(confirmed.rows.clone()));
                found.push(confirmed);
            }
        }
        found
    }

    /// The stretch with the rows in which the reading is wrong, where `others` show that it is.
    fn confirmed_frozen(&self, stretch: &Frozen, others: &Draft, draft: &Draft) -> Option<Frozen> {
        let thin = self.thinned(others);
        let body = &self.bodies[thin.body];
        let fit = fit(&thin, body, Worthwhile::ANY)?;
        if median(&fit.residuals)? > FAILED * body.reach {
            return None;
        }
        let reference = Reference::of_some(&thin, body, &fit, ELSEWHERE[0]);
        let at: Vec<usize> = (0..draft.len()).filter(|&at| stretch.rows.contains(&draft.rows[at])).collect();
        let own = draft.part(&at);
        let lengths = reference.lengths(&own);
        // a socket is where the other rows say, if there are any
        let is_known = |at: &usize| {
            let others = || thin.group.iter().filter(|group| **group == own.group[*at]);
            !draft.has_sockets() || others().count() >= FEWEST_IN_SOCKET
        };
        let known: Vec<usize> = (0..own.len()).filter(is_known).collect();
        let is_far = |at: &usize| lengths[*at] > reference.far;
        let far: Vec<usize> = known.iter().copied().filter(is_far).collect();
        // the first of them may be the last that was read
        if far.len() + 1 < FEWEST || 2 * far.len() < known.len() {
            return None;
        }
        let mut confirmed = Frozen {
            joints: stretch.joints.clone(),
            rows: Vec::new(),
            values: stretch.values.clone(),
            log_odds: stretch.log_odds,
            explains: 0.0,
            meant: None,
        };
        if let [joint] = stretch.joints[..] {
            let (values, left) = freed(&reference, &own.part(&far), joint);
            let home = left.iter().filter(|left| **left < reference.far).count();
            let middle = median(&values)?;
            let apart: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
            if (home as f64) < HOME * far.len() as f64 || median(&apart)? < APART {
                return None;
            }
            let there = || values.iter().zip(&left).filter(|(_, left)| **left < reference.far);
            let least = there().map(|(value, _)| *value).fold(f64::INFINITY, f64::min);
            let most = there().map(|(value, _)| *value).fold(f64::NEG_INFINITY, f64::max);
            confirmed.meant = Some((least, most));
        }
        let first = usize::from(known.first() == Some(&0) && far.first() != Some(&0));
        confirmed.rows = own.rows[first..].to_vec();
        let square: f64 = far.iter().map(|&at| lengths[at].powi(2)).sum();
        confirmed.explains = (square / draft.len().max(1) as f64).sqrt();
        Some(confirmed)
    }
}

/// The value of a joint that brings each row the nearest, and how near.
fn freed(reference: &Reference, draft: &Draft, joint: usize) -> (Vec<f64>, Vec<f64>) {
    let with = |values: &[f64]| {
        let mut changed = draft.clone();
        for (at, &value) in values.iter().enumerate() {
            *changed.number_mut(at, Cell::Joint(joint)) = value;
        }
        reference.offsets(&changed)
    };
    let recorded: Vec<f64> = (0..draft.len()).map(|at| draft.joints(at)[joint]).collect();
    let mut best = recorded.clone();
    let mut left: Vec<f64> = with(&recorded).iter().map(|off| off.norm()).collect();
    for k in 0..TRIED {
        let turn = std::f64::consts::TAU * (k as f64 / TRIED as f64 - 0.5);
        let values: Vec<f64> = recorded.iter().map(|value| value + turn).collect();
        for (at, off) in with(&values).iter().enumerate() {
            if off.norm() < left[at] {
                (best[at], left[at]) = (values[at], off.norm());
            }
        }
    }
    for _ in 0..STEPS {
        let off = with(&best);
        let moved = with(&best.iter().map(|value| value + SMALL).collect::<Vec<_>>());
        let next: Vec<f64> = (0..best.len())
            .map(|at| {
                let along = (moved[at] - off[at]) / SMALL;
                let square = along.norm_squared();
                best[at] - if square > 0.0 { along.dot(&off[at]) / square } else { 0.0 }
            })
            .collect();
        for (at, off) in with(&next).iter().enumerate() {
            if off.norm() < left[at] {
                (best[at], left[at]) = (next[at], off.norm());
            }
        }
    }
    (best, left)
}

impl Frozen {
    /// What is said of it.
    pub(super) fn slip(&self, search: &MistakeSearch, recording: &Recording) -> Slip {
        let robot = search.bodies[0].robot;
        let names: Vec<String> = self.joints.iter().map(|&joint| column(robot, joint)).collect();
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let there = poses(recording, first, last);
        let unit = |joint: usize| match robot.joints[joint].motion {
            Motion::Revolute => (DEG, "°", "deg"),
            Motion::Prismatic => (MM, " mm", "mm"),
        };
        let (estimates, why) = match (&self.joints[..], &self.values[..]) {
            ([joint], [value]) => {
                let (unit, symbol, key) = unit(*joint);
                let shown = value / unit;
                let meant = self.meant.map(|(least, most)| {
                    let digits = |value: f64| significant(value / unit, 4);
                    format!(", where the other poses put it at {} to {}{symbol}", digits(least), digits(most))
                });
                let why =
                    format!("it stays at {}{symbol}{}", significant(shown, 4), meant.unwrap_or_default());
                (vec![Estimate::as_written(key, shown, shown, shown)], why)
            }
            _ => (Vec::new(), "all joints stay as they are while the positions change".to_owned()),
        };
        Slip {
            change: DraftChange::Without(self.rows.clone()),
            effect: &STUCK_SENSOR,
            location: Key::new(names.join(", ")).rows(&there),
            estimates,
            cure: format!("Leave out {there}, or measure anew"),
            why,
            log_odds: self.log_odds,
            explains: self.explains,
            rivals: Vec::new(),
        }
    }
}
