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

use std::f64::consts::PI;

use super::super::effects::events::OUTLIER;
use super::super::effects::mistakes::{COPY_MISTAKE, TYPING_MISTAKE};
use super::columns::agreement;
use super::draft::{Cell, Change, Draft, Rows};
use super::names::{AXES, cell, column, place, pose_name, poses};
use super::part::{FAR, Reference, within};
use super::search::{ALIKE, FAILED, ODDS, Search, State};
use super::typed::{Meant, decimals, meant};
use crate::calibration::campaign::Recording;
use crate::inference::{Effect, Estimate, Key};
use crate::robot::Motion;
use crate::statistics::median;
use crate::units::{DEG, MM, UM, significant};

/// Degrees of freedom of the distances' distribution.
const NU: f64 = 4.0;
/// Ln of Γ(7/2)/(Γ(2)·(4π)^(3/2)), the density of that distribution in space at its middle.
const MIDDLE: f64 = -2.595;
/// Rows that are far out and looked at; the farthest first.
const MOST_ROWS: usize = 40;
/// A slip moves a row by so many times its distance, or as much less, or it is not looked at.
const AS_FAR: f64 = 2.0;
/// Share of the rows that are left out at most, and their number: more are no single ones.
const LEFT_OUT: (f64, usize) = (0.05, 2);
/// Fewest neighbours that stand twice: single rows may agree by chance.
const FEWEST_COPIES: usize = 3;
/// Times that the last digit goes into the scatter at least where equal numbers are no chance.
const FINE: f64 = 5.0;

/// Something that happened to one row, or to a few.
pub(super) struct Slip {
    pub change: Change,
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

/// What may have happened to a row.
struct Suspect {
    effect: &'static Effect,
    change: Change,
    location: Key,
    cure: String,
    why: String,
    estimates: Vec<Estimate>,
    log_prior: f64,
}

impl Search<'_> {
    /// What single rows hold beside the changes of `best`, in the order of the rows.
    pub(super) fn slips(&self, best: &State, recording: &Recording) -> Vec<Slip> {
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
            slips.iter().any(|slip| matches!(&slip.change, Change::Without(rows) if rows.contains(&row)))
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
            Change::Number { cell, .. } => Some(cell),
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

    fn unit(&self, draft: &Draft, joint: usize) -> f64 {
        match self.bodies[draft.body].robot.joints[joint].motion {
            Motion::Revolute => DEG,
            Motion::Prismatic => MM,
        }
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
                Change::Within(_, inner)
                    if matches!(**inner, Change::Rows { .. } | Change::Column { .. }) =>
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

    /// Each number of a row as it may have been meant.
    fn typed(&self, draft: &Draft, at: usize, columns: &[usize], recording: &Recording) -> Vec<Suspect> {
        let (row, count) = (draft.rows[at], draft.joint_count);
        let pose = pose_name(recording, row);
        let robot = self.bodies[draft.body].robot;
        let mut all = Vec::new();
        let mut add = |own: Cell, name: String, unit: f64, recorded: f64, places: usize| {
            let recorded = tidy(recorded / unit);
            for Meant { text, why, log_prior } in meant(recorded, places) {
                let value = text.parse::<f64>().unwrap_or(f64::NAN);
                all.push(Suspect {
                    effect: &TYPING_MISTAKE,
                    change: Change::Number { row, cell: own, value: value * unit },
                    location: cell(&name, &pose),
                    cure: format!("Write {text} for {recorded:.places$} as {name} of {pose}"),
                    why: why.into(),
                    estimates: vec![Estimate {
                        name: "meant".into(),
                        unit: 1.0,
                        value,
                        low: value,
                        high: value,
                    }],
                    log_prior,
                });
            }
        };
        for (joint, &places) in columns.iter().enumerate().take(count) {
            let recorded = draft.joints(at)[joint];
            add(Cell::Joint(joint), column(robot, joint), self.unit(draft, joint), recorded, places);
        }
        for (axis, name) in AXES.into_iter().enumerate().filter(|_| !draft.has_sockets()) {
            add(Cell::Axis(axis), name.into(), MM, draft.seen[at][axis], columns[count + axis]);
        }
        all
    }

    /// What may happen to many rows, at one.
    fn of_whole_row(&self, draft: &Draft, at: usize, recording: &Recording) -> Vec<Suspect> {
        let row = draft.rows[at];
        let rows = Rows::Between(row, row);
        let of_own = |own: &super::moves::Move| Suspect {
            effect: own.effect,
            change: within(rows, &own.change),
            location: cell(&own.location.names, &pose_name(recording, row)),
            cure: format!("{} {}", own.cure, place(recording, rows)),
            why: own.why.clone(),
            estimates: own.estimates.clone(),
            log_prior: own.log_prior,
        };
        // a row whose angles are its neighbour's may hold the wrong angles as well
        let is_beside = |by: isize| {
            let beside = at.checked_add_signed(by).filter(|&other| other < draft.len());
            beside.is_some_and(|other| draft.joints(other) == draft.joints(at))
        };
        let may_be = |own: &&super::moves::Move| match own.change {
            Change::Rows { by, .. } => !is_beside(by),
            Change::Zero { .. } => false,
            _ => true,
        };
        self.of_rows.iter().filter(may_be).map(of_own).collect()
    }

    /// Rows that repeat others to the last digit: neighbours that stand twice, and rows that are
    /// far out with the position of another one.
    fn copies(&self, draft: &Draft, lengths: &[f64], scale: f64, recording: &Recording) -> Vec<Slip> {
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

/// Numbers that differ by less are the same, rad or m.
const SAME: f64 = 1e-12;

/// A number of the file without what converting it to rad or m and back has left.
pub(super) fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

fn is_same_row(a: &Draft, b: &Draft) -> bool {
    a.group == b.group && a.joints == b.joints && a.seen == b.seen && a.body == b.body
}

/// Ln of the odds that a row was `left` from its point and a slip made it `length`, against any
/// disturbance that puts it anywhere in a volume (ln).
fn ln_odds(ln_volume: f64, left: f64, scale: f64) -> f64 {
    let own = MIDDLE - 0.5 * (NU + 3.0) * ((left / scale).powi(2) / NU).ln_1p();
    own + ln_volume - 3.0 * scale.ln() + (4.0 * PI / 3.0).ln()
}

/// Ln of the odds that a row so far from its point was disturbed, against the scatter of the
/// others; none where it lies among them.
fn disturbance(length: f64, scale: f64) -> f64 {
    (-ln_odds(3.0 * length.ln(), length, scale)).max(0.0)
}

/// Ln of the cube of what a disturbance may fill, m³. A displacement in a clamp is small whatever
/// happened: one that becomes small, or a neighbour's, is near for that alone.
fn ln_volume(change: &Change, length: f64, displacement: f64) -> f64 {
    let small = length.min(displacement).ln();
    match change {
        Change::Within(_, inner) => ln_volume(inner, length, displacement),
        Change::Seen(_) | Change::Rows { .. } => 3.0 * small,
        Change::Number { cell: Cell::Axis(_), .. } | Change::Column { cell: Cell::Axis(_), .. } => {
            2.0 * length.ln() + small
        }
        _ => 3.0 * length.ln(),
    }
}

/// How large displacements in clamps are, in the middle, m; nothing limits points in {W}.
fn displacement(draft: &Draft, recording: &Recording) -> f64 {
    if draft.has_sockets() || recording.groups.iter().any(|group| group.name.is_tracked()) {
        return f64::INFINITY;
    }
    let sizes: Vec<f64> = draft.seen.iter().map(|seen| seen.norm()).collect();
    median(&sizes).unwrap_or(f64::INFINITY).max(f64::MIN_POSITIVE)
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
        change: Change::Without(run.iter().map(|pair| draft.rows[pair.0]).collect()),
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

/// A row that nothing explains, and that would spoil the others.
fn left_out(draft: &Draft, at: usize, length: f64, scale: f64, recording: &Recording) -> Slip {
    let row = draft.rows[at];
    let pose = pose_name(recording, row);
    Slip {
        change: Change::Without(vec![row]),
        effect: &OUTLIER.effect,
        location: Key::new(&pose),
        estimates: vec![Estimate {
            name: "off_um".into(),
            unit: UM,
            value: length,
            low: length,
            high: length,
        }],
        cure: format!("Leave out {pose}, or measure it anew"),
        why: format!("its angles and its position are {} mm apart", significant(length / MM, 3)),
        log_odds: disturbance(length, scale),
        explains: (length.powi(2) / draft.len().max(1) as f64).sqrt(),
        rivals: Vec::new(),
    }
}
