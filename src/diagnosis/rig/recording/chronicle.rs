//! What was recorded when: the order of the rows, sessions, trials and runs, and the direction of
//! motion.
//!
//! With a time in every row the rows stand in the order of their times, wherever they stand in the
//! file. Without, the order of the file is the order of recording. A session or trial whose clock
//! begins anew keeps its place in the file.
//!
//! **Direction of motion.** Where no row states a phase and the loads go up and down in steps, a
//! reading was taken while loading or while unloading as the load before it was smaller or larger.
//! A turn counts once the load has gone back by [`TURN`] of its range: a measured load trembles.

#[cfg(test)]
mod tests;

use std::collections::HashMap;

use super::settings::settings;
use crate::diagnosis::rig::numbering::numbered;
use crate::rig::readings::{Direction, Driven, Phase, Reading, instants};

/// Share of the largest load by which a load has to go back for a turn.
const TURN: f64 = 0.02;
/// Instants, on average, of a way up and of a way down: what jumps back at once begins anew.
const STEPS_OF_A_WAY: f64 = 2.0;
/// A clock that falls back no later than to this share of its range begins anew.
const BEGINS_ANEW: f64 = 0.1;

/// Where each row of a file stands in the recording.
pub struct Chronicle {
    /// For each row of the file.
    pub rows: Vec<Entry>,
}

/// What is known of one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// Number of the session.
    pub session: usize,
    /// Number of the trial, across axes.
    pub trial: usize,
    /// Number of the run.
    pub run: usize,
    /// Number of the instant; ascending in the order of recording.
    pub place: usize,
    /// By the direction of motion; `None` where phases are stated or the loads do not go up and
    /// down.
    pub motion: Option<Motion>,
}

/// A way up or down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Along the positive axis: 1, −1, or 0 before anything has moved.
    pub direction: f64,
    /// How often the load has turned from falling to rising before, in this run.
    pub cycle: usize,
    /// Loading or unloading.
    pub phase: Phase,
}

impl Chronicle {
    pub fn of(rows: &[Reading], driven: Driven) -> Chronicle {
        let set = settings(rows, driven).rows;
        let set: Vec<Option<f64>> = set.into_iter().map(|own| own.map(|own| own.set)).collect();
        let place = places(rows);
        let mut walk: Vec<usize> = (0..rows.len()).collect();
        walk.sort_by_key(|&i| (place.as_ref().map_or(0, |place| place[i]), i));
        let session = in_walk(&walk, |i| rows[i].session.as_deref());
        let has_phase = rows.iter().any(|row| row.phase.is_some());
        let ways = |keys: &dyn Fn(usize) -> Option<(usize, usize)>| -> HashMap<usize, Motion> {
            if has_phase { HashMap::new() } else { motions(rows, (driven, &set), &walk, keys) }
        };
        let axis = |i: usize| rows[i].direction.axis.index();
        // rows without a trial that go up and down are one run
        let unnamed = |i: usize| rows[i].trial.is_none().then(|| (session[i], axis(i)));
        let is_one_run = !ways(&unnamed).is_empty();
        let named = numbered(
            walk.iter()
                .filter(|&&i| rows[i].trial.is_some())
                .map(|&i| (session[i], rows[i].trial.as_deref())),
        );
        let count = named.iter().max().map_or(0, |last| last + 1);
        let (mut named, mut open) = (named.into_iter(), HashMap::<(usize, usize), OpenRun>::new());
        let mut trial = vec![0; rows.len()];
        let mut before = None;
        for &i in &walk {
            let own = (session[i], axis(i));
            let goes_on = before.replace(own) == Some(own);
            trial[i] = match rows[i].trial {
                Some(_) => named.next().unwrap_or_default(),
                None if is_one_run => count + session[i],
                None => open.entry(own).or_default().trial(&rows[i], set[i], goes_on),
            };
        }
        if !is_one_run {
            // the k-th unnamed run of an axis, apart for each session
            let unnamed = |i: &usize| rows[*i].trial.is_none();
            let numbers = numbered(walk.iter().copied().filter(unnamed).map(|i| (session[i], trial[i])));
            for (i, number) in walk.iter().copied().filter(unnamed).zip(numbers) {
                trial[i] = count + number;
            }
        }
        let run = in_walk(&walk, |i| (axis(i), trial[i]));
        let of_run = ways(&|i| Some((run[i], 0)));
        let place = place.unwrap_or_else(|| untimed(rows, &run));
        let entry = |i: usize| Entry {
            session: session[i],
            trial: trial[i],
            run: run[i],
            place: place[i],
            motion: of_run.get(&i).copied(),
        };
        Chronicle { rows: (0..rows.len()).map(entry).collect() }
    }
}

/// Number of each row's key, in the order of the walk.
fn in_walk<K: Eq + std::hash::Hash>(walk: &[usize], key: impl Fn(usize) -> K) -> Vec<usize> {
    let mut numbers = vec![0; walk.len()];
    for (&i, number) in walk.iter().zip(numbered(walk.iter().map(|&i| key(i)))) {
        numbers[i] = number;
    }
    numbers
}

/// The place of each row by its time; `None` where times are missing, or say nothing of the order.
fn places(rows: &[Reading]) -> Option<Vec<usize>> {
    let times: Vec<f64> = rows.iter().map(|row| row.time).collect::<Option<_>>()?;
    let key = |row: &'_ Reading| (row.session.clone(), row.trial.clone(), row.direction.axis);
    let group = numbered(rows.iter().map(key));
    let count = group.iter().max().map_or(0, |last| last + 1);
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (i, &group) in group.iter().enumerate() {
        members[group].push(i);
    }
    let falls_back = |own: &Vec<usize>| begins_anew(&own.iter().map(|&i| times[i]).collect::<Vec<_>>());
    if members.iter().any(|own| falls_back(own) && reads_twice(rows, own)) {
        return None;
    }
    // groups one after the other by one clock, or each by a clock of its own
    let span = |own: &Vec<usize>| {
        own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &i| (a.min(times[i]), b.max(times[i])))
    };
    let mut spans: Vec<(f64, f64)> = members.iter().map(span).collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_apart = spans.windows(2).all(|pair| pair[0].1 <= pair[1].0);
    let has_one_clock = is_apart || times.is_sorted();
    let mut sorted: Vec<usize> = (0..rows.len()).collect();
    let rank = |i: usize| if has_one_clock { 0 } else { group[i] };
    sorted.sort_by(|&a, &b| rank(a).cmp(&rank(b)).then(times[a].total_cmp(&times[b])));
    let numbers = numbered(sorted.iter().map(|&i| (rank(i), times[i].to_bits())));
    let mut place = vec![0; rows.len()];
    for (i, number) in sorted.into_iter().zip(numbers) {
        place[i] = number;
    }
    Some(place)
}

/// True where a clock falls back to its beginning, again and again, and else only ascends.
fn begins_anew(times: &[f64]) -> bool {
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    let most = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let falls: Vec<f64> = times.windows(2).filter(|pair| pair[1] < pair[0]).map(|pair| pair[1]).collect();
    let is_early = |time: &f64| *time <= least + BEGINS_ANEW * (most - least);
    !falls.is_empty() && 3 * falls.len() < times.len() && falls.iter().all(is_early) && is_early(&times[0])
}

/// True where one sensor shows two things at one time: these are two times.
fn reads_twice(rows: &[Reading], own: &[usize]) -> bool {
    let mut known: HashMap<(u64, usize, u64), f64> = HashMap::new();
    own.iter().any(|&i| {
        let (row, time) = (&rows[i], rows[i].time.unwrap_or_default());
        let station = row.read_station.unwrap_or(f64::NAN).to_bits();
        let mut channels = row.offset.iter().enumerate().filter_map(|(k, offset)| Some((k, (*offset)?)));
        channels.any(|(channel, offset)| {
            known.insert((time.to_bits(), channel, station), offset).is_some_and(|before| before != offset)
        })
    })
}

/// What all rows of an instant without a time share: direction, load and where it hangs.
type Hung = (Direction, u64, Option<u64>);

/// Without times: neighbours may be one instant; and where stations were written one after the
/// other, the so many-th instant of a run at one of them is that of the others, if its load is the
/// same. An instant stands where its first row does.
fn untimed(rows: &[Reading], run: &[usize]) -> Vec<usize> {
    let mut known: HashMap<(usize, usize), (usize, Hung)> = HashMap::new();
    let mut count: HashMap<(usize, u64), usize> = HashMap::new();
    let mut place = vec![0; rows.len()];
    for instant in instants(rows) {
        // of rows whose clock begins anew those of one time may be of several runs
        for run_of_instant in runs_of(&instant.rows, run) {
            let of_run: Vec<usize> =
                instant.rows.iter().copied().filter(|&i| run[i] == run_of_instant).collect();
            let first = of_run[0];
            let hung = (
                rows[first].direction,
                rows[first].load.to_bits(),
                rows[first].load_station.map(f64::to_bits),
            );
            let mut stations: Vec<u64> =
                of_run.iter().map(|&i| rows[i].read_station.unwrap_or(f64::NAN).to_bits()).collect();
            stations.sort_unstable();
            stations.dedup();
            let mut at = 0;
            for station in stations {
                let count = count.entry((run_of_instant, station)).or_default();
                *count += 1;
                at = at.max(*count);
            }
            let (there, other) = *known.entry((run_of_instant, at)).or_insert((first, hung));
            let own = if other == hung { there } else { first };
            of_run.into_iter().for_each(|i| place[i] = own);
        }
    }
    place
}

/// The runs of some rows, each once.
fn runs_of(rows: &[usize], run: &[usize]) -> Vec<usize> {
    let mut runs: Vec<usize> = rows.iter().map(|&i| run[i]).collect();
    runs.dedup();
    runs
}

/// The direction of motion of each row that has a key; nothing where the rows of the keys do not go
/// up and down in steps.
fn motions(
    rows: &[Reading],
    (driven, set): (Driven, &[Option<f64>]),
    walk: &[usize],
    key: &dyn Fn(usize) -> Option<(usize, usize)>,
) -> HashMap<usize, Motion> {
    let mut groups: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    let mut keys = Vec::new();
    for &i in walk {
        let Some(key) = key(i).filter(|_| set[i].is_some()) else { continue };
        let group = groups.entry(key).or_insert_with(|| {
            keys.push(key);
            Vec::new()
        });
        // a displacement is that of one place
        let is_at = |other: usize| driven == Driven::Load || rows[other].read_station == rows[i].read_station;
        if group.first().is_none_or(|&other| is_at(other)) {
            group.push(i);
        }
    }
    let mut found = HashMap::new();
    // ways while loading, and their instants; the same while unloading
    let mut ways = [(0.0f64, 0.0f64); 2];
    for key in keys {
        let own = &groups[&key];
        let drives: Vec<f64> = own.iter().filter_map(|&i| set[i]).collect();
        let mut before: Option<(f64, Phase)> = None;
        for ((&i, &drive), (direction, cycle)) in own.iter().zip(&drives).zip(turns(&drives)) {
            let phase = match before {
                // read once more: nothing has moved
                Some((known, phase)) if known == drive => phase,
                Some(_) if drive == 0.0 => Phase::Unload,
                _ if direction * drive < 0.0 => Phase::Unload,
                _ => Phase::Load,
            };
            let way = &mut ways[usize::from(phase == Phase::Unload)];
            if before.is_none_or(|(_, other)| other != phase) {
                way.0 += 1.0;
            }
            if before.is_none_or(|(other, _)| other != drive) {
                way.1 += 1.0;
            }
            before = Some((drive, phase));
            found.insert(i, Motion { direction, cycle, phase });
        }
    }
    let goes_in_steps = |(ways, instants): (f64, f64)| ways > 0.0 && instants >= STEPS_OF_A_WAY * ways;
    match ways.into_iter().all(goes_in_steps) {
        true => found,
        false => HashMap::new(),
    }
}

/// For each value of a sequence that begins at rest the direction in which it was reached, and how
/// many turns from falling to rising came before.
fn turns(values: &[f64]) -> Vec<(f64, usize)> {
    let least = TURN * values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let mut direction = vec![0.0; values.len()];
    // direction of the way, its farthest value and the first index behind that
    let (mut way, mut extreme, mut behind) = (0.0f64, 0.0f64, 0);
    for (i, &value) in values.iter().enumerate() {
        let ahead = (value - extreme) * way;
        if way == 0.0 && (value - extreme).abs() > least {
            way = (value - extreme).signum();
            (extreme, behind) = (value, i + 1);
            direction[..=i].iter_mut().filter(|d| **d == 0.0).for_each(|d| *d = way);
        } else if ahead >= 0.0 && way != 0.0 {
            (extreme, behind) = (value, i + 1);
        } else if way != 0.0 && -ahead > least {
            way = -way;
            direction[behind..i].iter_mut().for_each(|d| *d = way);
            (extreme, behind) = (value, i + 1);
        }
        direction[i] = way;
    }
    // at rest nothing has moved
    let moving = values.iter().position(|value| *value != 0.0).unwrap_or(values.len());
    direction[..moving].iter_mut().for_each(|d| *d = 0.0);
    let mut cycle = 0;
    let count = |i: usize| {
        if i > 0 && direction[i - 1] < 0.0 && direction[i] > 0.0 {
            cycle += 1;
        }
        (direction[i], cycle)
    };
    (0..values.len()).map(count).collect()
}

/// What distinguishes a load from others: direction, what was set, phase, places.
type Condition = (i8, u64, Option<Phase>, [Option<u64>; 2]);

/// What a run without a name has seen so far.
#[derive(Default)]
struct OpenRun {
    /// How many runs the axis had before this one.
    ordinal: usize,
    /// The channels that were read at each.
    seen: HashMap<Condition, [bool; 3]>,
    last: Option<Condition>,
}

impl OpenRun {
    /// Number of the run that a row without a trial continues or begins: a run along an axis goes
    /// on until something is read again that it has read before; reading the display once more at
    /// the same load is no new run where the row before it `goes_on`: was of the same axis.
    fn trial(&mut self, row: &Reading, set: Option<f64>, goes_on: bool) -> usize {
        let stations = [row.load_station, row.read_station].map(|s| s.map(f64::to_bits));
        let set = set.unwrap_or(row.load).abs();
        let condition = (row.direction.sign, set.to_bits(), row.phase, stations);
        let channels = row.offset.map(|offset| offset.is_some());
        let overlaps = |other: &[bool; 3]| channels.iter().zip(other).any(|(a, b)| *a && *b);
        let is_same_load = goes_on && self.last == Some(condition);
        if self.seen.get(&condition).is_some_and(overlaps) && !is_same_load {
            *self = OpenRun { ordinal: self.ordinal + 1, ..OpenRun::default() };
        }
        let read = self.seen.entry(condition).or_default();
        (0..3).for_each(|k| read[k] |= channels[k]);
        self.last = Some(condition);
        self.ordinal
    }
}
