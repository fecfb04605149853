//! Readings, or loads, that stand some rows away from where they belong: a cell that was inserted
//! or lost, a list of loads that was pasted once more, a way down that was written upwards.
//!
//! Every row has an owner of its readings: the row whose direction, and the row whose load, they
//! belong to. The lines are fitted through the readings at their owners, and
//!
//! ```text
//! q = Σ min(|y − line(F)|/D, 0.7)²      over the channels of a row, D the largest reading under
//!                                       loads of this direction, and a third of the largest of all
//!                                       at least
//! ```
//!
//! says how far off a row is. The stretch of rows in which another owner takes off the most is
//! found in one pass; lines and stretch in turn. Friction keeps readings off by as much on the way
//! up as on the way down, and zeros differ: without displaced rows each way of each run may have
//! its own, and the rod may hang on a slide, which follows the load only once that has changed by
//! twice the friction. Friction of one step of the loads looks like readings one row too low but
//! for the rows after a reversal.

use std::collections::{BTreeMap, BTreeSet};

use super::super::effects::mistakes::ROW_MISTAKE;
use super::super::numbering::numbered;
use super::limits::without_limits;
use super::lines::{Fit, fit};
use super::part::Part;
use super::possible::exact;
use super::same_load::left_by_any_curve;
use super::search::ODDS;
use crate::diagnosis::rig::recording::chronicle::Chronicle;
use crate::diagnosis::rig::recording::columns::{columns, load_column, rows_between};
use crate::inference::Key;
use crate::rig::readings::{Driven, LoadColumn, Phase, Reading};
use crate::spatial::Axis;
use crate::statistics::median;

/// A row that is off by less than this share of the deflection is where it belongs.
const SHOWN: f64 = 0.1;
const CAP: f64 = 0.7;
/// What a row that is said to be displaced must gain.
const PRICE: f64 = 1e-3;
/// Displaced rows, at least; what they are off by, and may be off by afterwards, rms.
const LEAST: usize = 4;
const OFF: f64 = 0.12;
const LEFT: f64 = 0.1;
/// What is left less than this, rms, needs no other explanation.
const WELL: f64 = 0.03;
/// At most this share of what was left before, rms, or by a curve.
const CURED: f64 = 0.5;
/// Another displacement that leaves no more than so many times as much explains alike.
const NO_WORSE: f64 = 1.1;
const ROUNDS: usize = 3;
/// Friction up to half of the largest load is tried, in steps of a fortieth.
const FRICTION_STEPS: usize = 20;
const FRICTION_STEP: f64 = 1.0 / 40.0;

/// What stands elsewhere.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// The readings of a row belong so many rows further down.
    Readings(isize),
    /// The load of a row stands so many rows further down.
    Loads(isize),
    /// The loads of the way down stand in the order of the way up.
    WayDown,
}

const KINDS: [Kind; 9] = [
    Kind::Readings(-1),
    Kind::Readings(1),
    Kind::Loads(1),
    Kind::Loads(-1),
    Kind::WayDown,
    Kind::Readings(-2),
    Kind::Readings(2),
    Kind::Loads(2),
    Kind::Loads(-2),
];

/// The rows of the direction and of the load to which the readings of a row belong; `None` where
/// they belong to none.
type Owner = Option<(usize, usize)>;

/// What was found, with the rows as they should be.
pub(super) struct Displaced {
    pub part: Part,
    pub rows: Vec<Reading>,
}

/// Rows that are displaced against their readings.
pub(super) fn found(rows: &[Reading], load: LoadColumn) -> Option<Displaced> {
    let known = without_limits(rows);
    let sheet = Sheet::of(&known);
    let own: Vec<Owner> = (0..rows.len()).map(|i| Some((i, i))).collect();
    let (left, is_off) = sheet.left_where_it_is(&own);
    if !is_off {
        return None;
    }
    let tried: Vec<Tried> = KINDS.iter().filter_map(|&kind| sheet.tried(kind, &own)).collect();
    let best = tried.iter().fold(None, |best: Option<&Tried>, one| match best {
        Some(best) if one.left * NO_WORSE > best.left => Some(best),
        _ => Some(one),
    })?;
    let left = (1..=FRICTION_STEPS).map(|k| sheet.left_by_friction(k, &own)).fold(left, f64::min);
    // the rows that it could start and end at are choices too
    let odds = rows.len() as f64 * (left / best.left.max(f64::MIN_POSITIVE)).sqrt().ln();
    if best.left.sqrt() > CURED * left.sqrt() || odds < ODDS + 2.0 * (rows.len() as f64).ln() {
        return None;
    }
    // a sensor that jumps or wraps shows the same at the same load, which no rows of other loads do
    let by_curve = left_by_any_curve(&known, &sheet.label, &sheet.deflection, CAP);
    if best.left > WELL * WELL && by_curve.is_some_and(|left| left < CURED * CURED * best.left) {
        return None;
    }
    let place = |one: &Tried| sheet.place(one, load);
    let near = tried.iter().filter(|one| one.kind != best.kind && one.left < NO_WORSE * best.left);
    let channels = sheet.channels();
    let stretch = rows_between(best.stretch.0 + 1, best.stretch.1 + 1);
    let (what, it) = match best.kind {
        Kind::Readings(_) => ("the readings", channels.as_str()),
        Kind::Loads(_) | Kind::WayDown => ("the loads", load_column(load)),
    };
    let (observed, rows_away) = match best.kind {
        Kind::WayDown => (
            format!(
                "The loads of the way down stand in the wrong order: write {it} the other way round in the rows of each way down"
            ),
            0.0,
        ),
        Kind::Readings(by) | Kind::Loads(by) => {
            // a load that stands further down has to go up
            let by = if matches!(best.kind, Kind::Loads(_)) { -by } else { by };
            let (stand, go) = if by < 0 { ("low", "up") } else { ("high", "down") };
            let count = match by.unsigned_abs() {
                1 => "one row".to_owned(),
                by => format!("{by} rows"),
            };
            (
                format!("In the {stretch}, {what} stand {count} too {stand}: move {it} {go} by {count}"),
                -by as f64,
            )
        }
    };
    let part = Part {
        effect: &ROW_MISTAKE,
        location: place(best),
        estimates: vec![exact("rows", rows_away)],
        looks_like: format!("{} look displaced against the rest", place(best)),
        observed,
        explains: best.explains,
        data: Vec::new(),
        rivals: near.map(|one| (&ROW_MISTAKE, place(one))).collect(),
    };
    Some(Displaced { part, rows: Sheet::of(rows).mended(best) })
}

/// One displacement in the stretch of rows in which it takes off the most.
struct Tried {
    kind: Kind,
    /// The first and the last row, from 0.
    stretch: (usize, usize),
    owners: Vec<Owner>,
    /// Mean of q.
    left: f64,
    /// What it moves the readings of its rows by, m rms.
    explains: f64,
}

/// The lines of a hypothesis, by label and channel.
type Lines = Vec<Option<Fit>>;

/// The rows of a file in their order.
#[derive(Clone)]
struct Sheet<'a> {
    rows: &'a [Reading],
    /// For each row the number of its axis and stations.
    label: Vec<usize>,
    /// And of its run and way.
    way: Vec<usize>,
    /// D by label, m.
    deflection: Vec<f64>,
    /// For each row the one whose load it would have, were the ways down the other way round.
    turned: Vec<usize>,
    /// The load of each row along the positive axis, N.
    load: Vec<f64>,
    /// For each row the number of its run, ways together.
    run: Vec<usize>,
}

impl<'a> Sheet<'a> {
    fn of(rows: &'a [Reading]) -> Sheet<'a> {
        let at = |station: Option<f64>| station.map(f64::to_bits);
        let label = numbered(
            rows.iter().map(|row| (row.direction.axis.index(), at(row.load_station), at(row.read_station))),
        );
        // trials without names are runs too
        let chronicle = Chronicle::of(rows, Driven::Load);
        let run = numbered(chronicle.rows.iter().zip(&label).map(|(own, label)| (own.run, label)));
        let way = numbered(
            rows.iter()
                .zip(&run)
                .map(|(row, run)| (run, row.direction.sign, row.phase == Some(Phase::Unload))),
        );
        let mut of_run: Vec<Vec<usize>> = vec![Vec::new(); way.iter().max().map_or(0, |last| last + 1)];
        way.iter().enumerate().for_each(|(i, &way)| of_run[way].push(i));
        let mut turned: Vec<usize> = (0..rows.len()).collect();
        for own in of_run.iter().filter(|own| rows[own[0]].phase == Some(Phase::Unload)) {
            own.iter().zip(own.iter().rev()).for_each(|(&i, &other)| turned[i] = other);
        }
        let mut deflection = vec![0.0f64; label.iter().max().map_or(0, |last| last + 1)];
        for (row, &label) in rows.iter().zip(&label) {
            let largest = row.offset.iter().flatten().fold(0.0, |most: f64, offset| most.max(offset.abs()));
            deflection[label] = deflection[label].max(largest);
        }
        let most = deflection.iter().copied().fold(0.0, f64::max);
        deflection.iter_mut().for_each(|own| *own = own.max(most / 3.0));
        let load: Vec<f64> = rows.iter().map(|row| f64::from(row.direction.sign) * row.load).collect();
        Sheet { rows, label, way, deflection, turned, load, run }
    }

    /// The same rows on a slide whose friction is this share of the largest load: the rod sees
    ///
    /// ```text
    /// Pᵢ = min(Fᵢ + μ, max(Fᵢ − μ, Pᵢ₋₁)),   P = 0 before a run
    /// ```
    fn rubbing(&self, share: f64) -> Vec<f64> {
        let friction = share * self.load.iter().fold(0.0, |most: f64, load| most.max(load.abs()));
        let mut seen = vec![0.0f64; self.run.iter().max().map_or(0, |last| last + 1)];
        let behind = |(load, &run): (&f64, &usize)| {
            seen[run] = seen[run].clamp(load - friction, load + friction);
            seen[run]
        };
        self.load.iter().zip(&self.run).map(behind).collect()
    }

    fn owner(&self, kind: Kind, i: usize) -> Owner {
        let further = |by: isize| i.checked_add_signed(by).filter(|&other| other < self.rows.len());
        match kind {
            Kind::Readings(by) => further(by).map(|other| (other, other)),
            Kind::Loads(by) => further(by).map(|other| (i, other)),
            Kind::WayDown => Some((i, self.turned[i])),
        }
    }

    /// The load of an owner along the positive axis, N.
    fn load(&self, owner: (usize, usize)) -> f64 {
        match owner.0 == owner.1 {
            true => self.load[owner.0],
            false => f64::from(self.rows[owner.0].direction.sign) * self.rows[owner.1].load,
        }
    }

    fn fits(&self, owners: &[Owner]) -> Lines {
        let labels = self.label.iter().max().map_or(0, |last| last + 1);
        let mut points: Vec<Vec<(f64, f64)>> = vec![Vec::new(); 3 * labels];
        for (row, owner) in self.rows.iter().zip(owners) {
            let Some(owner) = *owner else { continue };
            for (channel, offset) in row.offset.iter().enumerate() {
                if let Some(offset) = offset {
                    points[3 * self.label[owner.0] + channel].push((self.load(owner), *offset));
                }
            }
        }
        let line = |points: &Vec<(f64, f64)>| (points.len() >= LEAST).then(|| fit(points));
        points.iter().map(line).collect()
    }

    /// What each channel of a row is off its line by at an owner, as a share of the deflection.
    fn off(&self, lines: &Lines, i: usize, owner: (usize, usize)) -> [Option<f64>; 3] {
        let label = self.label[owner.0];
        Axis::ALL.map(|channel| {
            let k = channel.index();
            let offset = self.rows[i].offset[k]?;
            // what nothing else is read with is not where it belongs
            let Some(line) = lines[3 * label + k] else { return Some(f64::INFINITY) };
            let deflection = self.deflection[label];
            (deflection > 0.0).then(|| (offset - line.at(self.load(owner))) / deflection)
        })
    }

    fn q(&self, lines: &Lines, i: usize, owner: (usize, usize)) -> f64 {
        self.off(lines, i, owner).iter().flatten().map(|off| off.abs().min(CAP).powi(2)).sum()
    }

    /// Mean of q where nothing is displaced and each way has its own zero, and whether any row is
    /// off at all.
    fn left_where_it_is(&self, own: &[Owner]) -> (f64, bool) {
        let lines = self.fits(own);
        let mut off: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
        for i in 0..self.rows.len() {
            for (k, channel) in self.off(&lines, i, (i, i)).into_iter().enumerate() {
                off.entry((self.way[i], k)).or_default().extend(channel.filter(|off| off.is_finite()));
            }
        }
        let zero: BTreeMap<(usize, usize), f64> =
            off.iter().map(|(key, off)| (*key, median(off).unwrap_or(0.0))).collect();
        let q = |i: usize| -> f64 {
            let off = self.off(&lines, i, (i, i)).into_iter().enumerate();
            let off = off.filter_map(|(k, off)| Some(off? - zero[&(self.way[i], k)]));
            off.map(|off| off.abs().min(CAP).powi(2)).sum()
        };
        let all: Vec<f64> = (0..self.rows.len()).map(q).collect();
        let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
        (mean, all.iter().filter(|&&q| q > SHOWN * SHOWN).count() >= LEAST)
    }

    /// The same where the rod hangs on a slide, its friction so many steps.
    fn left_by_friction(&self, steps: usize, own: &[Owner]) -> f64 {
        let load = self.rubbing(FRICTION_STEP * steps as f64);
        Sheet { load, ..self.clone() }.left_where_it_is(own).0
    }

    fn tried(&self, kind: Kind, own: &[Owner]) -> Option<Tried> {
        let everywhere: Vec<Owner> = (0..own.len()).map(|i| self.owner(kind, i)).collect();
        let mut best: Option<Tried> = None;
        for start in [own, &everywhere[..]] {
            let mut tried = self.stretch(kind, start, own)?;
            for _ in 1..ROUNDS {
                tried = self.stretch(kind, &tried.owners, own)?;
            }
            if best.as_ref().is_none_or(|best| tried.left < best.left) {
                best = Some(tried);
            }
        }
        let mut best = best?;
        // a sensor that is read under loads along some axes only would be read under others
        if self.lines_read(&best.owners) > self.lines_read(own) {
            return None;
        }
        best.explains = self.shown(&best)?;
        Some(best)
    }

    /// How many lines there are: channels that are read, by label.
    fn lines_read(&self, owners: &[Owner]) -> usize {
        let of_row = |(row, owner): (&Reading, &Owner)| {
            let label = owner.map(|owner| self.label[owner.0]);
            let read = row.offset.map(|offset| offset.is_some());
            (0..read.len()).filter(move |&k| read[k]).filter_map(move |k| Some((label?, k)))
        };
        self.rows.iter().zip(owners).flat_map(of_row).collect::<BTreeSet<(usize, usize)>>().len()
    }

    /// The stretch by the lines through `owners`.
    fn stretch(&self, kind: Kind, owners: &[Owner], own: &[Owner]) -> Option<Tried> {
        let lines = self.fits(owners);
        let gain = |i: usize| match self.owner(kind, i) {
            Some(owner) => self.q(&lines, i, (i, i)) - self.q(&lines, i, owner) - PRICE,
            None => 0.0,
        };
        let (mut best, mut sum, mut from) = ((0, 0, 0.0), 0.0, 0);
        for i in 0..own.len() {
            if sum <= 0.0 {
                (sum, from) = (0.0, i);
            }
            sum += gain(i);
            if sum > best.2 {
                best = (from, i, sum);
            }
        }
        // what lies beyond either end of the file belongs to nothing that there is
        let (mut from, mut to, _) = best;
        while from > 0 && self.owner(kind, from - 1).is_none() {
            from -= 1;
        }
        while to + 1 < own.len() && self.owner(kind, to + 1).is_none() {
            to += 1;
        }
        let stretch = match kind {
            Kind::WayDown => (0, own.len().checked_sub(1)?),
            _ => (from, to),
        };
        let is_inside = |i: usize| i >= stretch.0 && i <= stretch.1;
        let owner = |i: usize| match is_inside(i) {
            true => self.owner(kind, i).filter(|owner| is_inside(owner.1)),
            false => own[i],
        };
        let owners: Vec<Owner> = (0..own.len()).map(owner).collect();
        let lines = self.fits(&owners);
        let (mut left, mut count) = (0.0, 0);
        for (i, owner) in owners.iter().enumerate() {
            if let Some(owner) = *owner {
                left += self.q(&lines, i, owner);
                count += 1;
            }
        }
        Some(Tried { kind, stretch, owners, left: left / f64::from(count.max(1)), explains: 0.0 })
    }

    /// What the rows are off by without it, m rms; `None` where too few are, or still with it.
    fn shown(&self, tried: &Tried) -> Option<f64> {
        let lines = self.fits(&tried.owners);
        let (mut before, mut after, mut count, mut moved, mut squares) = (0.0, 0.0, 0, 0, 0.0);
        for i in tried.stretch.0..=tried.stretch.1 {
            let Some(owner) = tried.owners[i].filter(|owner| *owner != (i, i)) else { continue };
            let q = self.q(&lines, i, (i, i));
            before += q;
            after += self.q(&lines, i, owner);
            squares += q * self.deflection[self.label[i]].powi(2);
            count += 1;
            moved += usize::from(q > SHOWN * SHOWN);
        }
        let count = f64::from(count);
        let is_cured = after < LEFT * LEFT * count && after < CURED * CURED * before;
        let is_shown = moved >= LEAST && before > OFF * OFF * count && is_cured;
        is_shown.then(|| (squares / count).sqrt())
    }

    fn mended(&self, tried: &Tried) -> Vec<Reading> {
        let mut rows = self.rows.to_vec();
        let (from, to) = tried.stretch;
        for (i, row) in rows.iter_mut().enumerate().take(to + 1).skip(from) {
            match tried.kind {
                Kind::Readings(by) => {
                    // the row whose readings belong here
                    let source = i.checked_add_signed(-by).filter(|&other| other >= from && other <= to);
                    row.offset = source.map_or([None; 3], |other| self.rows[other].offset);
                }
                _ => match tried.owners[i] {
                    Some((_, other)) => row.load = self.rows[other].load,
                    None => row.offset = [None; 3],
                },
            }
        }
        rows
    }

    fn channels(&self) -> String {
        let is_read = |channel: &Axis| self.rows.iter().any(|row| row.offset[channel.index()].is_some());
        columns(&Axis::ALL.into_iter().filter(is_read).collect::<Vec<_>>())
    }

    /// `dy_um, dz_um, rows 21 to 56`.
    fn place(&self, tried: &Tried, load: LoadColumn) -> Key {
        let rows = rows_between(tried.stretch.0 + 1, tried.stretch.1 + 1);
        match tried.kind {
            Kind::Readings(_) => Key::new(self.channels()).rows(rows),
            Kind::Loads(_) => Key::new(load_column(load)).rows(rows),
            Kind::WayDown => Key::new(load_column(load)).rows("way down"),
        }
    }
}
