//! Creep: since when each load has hung, and how far that has gone.

use super::memory::{Memory, dwell, moments, none, runs, shortest};
use crate::diagnosis::rig::recording::datum::Datum;

/// Since when a reading has crept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// t counts from when this load was hung, as the file says, or else right after the last
    /// reading of another load.
    ThisLoad,
    /// t counts from a moment before the first reading of each run that nobody knows.
    UnknownOnset,
    /// t counts from the first reading of the run.
    FirstReading,
    /// t counts from one reading before that: the first load too had hung for a while when it was
    /// read.
    FirstLoad,
    /// Every change of the load creeps by itself and the changes add up (Boltzmann's
    /// superposition); a load is taken to change right after the reading before, half way to the
    /// reading at it, or when it was first read, unless the file says when it was hung.
    EachLoad(Changed),
    /// The same, and what hung in the runs before goes on recovering (`recovery.rs`).
    AllLoads(Changed),
    /// t is the file's own time.
    File,
}

/// When a load was changed between two readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// Right after the one.
    Early,
    /// Half way.
    Midway,
    /// Right before the other.
    Late,
    /// So many quarters of the shortest time between two readings before each reading: whoever
    /// hangs a load waits about as long every time.
    Waited(u8),
}

impl Changed {
    /// The time of the change between readings at two times, s.
    ///
    /// `shortest`: between any two readings, s.
    pub fn between(self, before: f64, after: f64, shortest: f64) -> f64 {
        match self {
            Changed::Early => before,
            Changed::Midway => 0.5 * (before + after),
            Changed::Late => after,
            Changed::Waited(quarters) => after - 0.25 * f64::from(quarters) * shortest,
        }
    }
}

impl Clock {
    pub const ALL: [Clock; 14] = [
        Clock::FirstReading,
        Clock::FirstLoad,
        Clock::EachLoad(Changed::Early),
        Clock::EachLoad(Changed::Midway),
        Clock::EachLoad(Changed::Late),
        Clock::EachLoad(Changed::Waited(1)),
        Clock::EachLoad(Changed::Waited(2)),
        Clock::EachLoad(Changed::Waited(3)),
        Clock::AllLoads(Changed::Early),
        Clock::AllLoads(Changed::Late),
        Clock::AllLoads(Changed::Waited(2)),
        Clock::ThisLoad,
        Clock::File,
        Clock::UnknownOnset,
    ];
    /// Where the file says when each load was hung.
    pub const STATED: [Clock; 4] =
        [Clock::ThisLoad, Clock::EachLoad(Changed::Early), Clock::AllLoads(Changed::Early), Clock::FirstLoad];

    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            Clock::ThisLoad => "since this load was hung",
            Clock::UnknownOnset => "since a moment before each run",
            Clock::FirstReading => "since the first reading",
            Clock::FirstLoad => "since the first load",
            Clock::EachLoad(Changed::Early) => "since each load",
            Clock::EachLoad(Changed::Midway) => "since each load, hung between two readings",
            Clock::EachLoad(Changed::Late) => "since each load, hung as it was read",
            Clock::EachLoad(Changed::Waited(1)) => {
                "since each load, hung a quarter of the shortest wait before it was read"
            }
            Clock::EachLoad(Changed::Waited(2)) => {
                "since each load, hung half of the shortest wait before it was read"
            }
            Clock::EachLoad(Changed::Waited(_)) => {
                "since each load, hung three quarters of the shortest wait before it was read"
            }
            Clock::AllLoads(Changed::Waited(_)) => {
                "since each load, of earlier runs too, hung half of the shortest wait before it was read"
            }
            Clock::AllLoads(Changed::Early) => "since each load, of earlier runs too",
            Clock::AllLoads(Changed::Midway) => {
                "since each load, of earlier runs too, hung between two readings"
            }
            Clock::AllLoads(Changed::Late) => "since each load, of earlier runs too, hung as it was read",
            Clock::File => "since time 0",
        }
    }
}

/// When the load of a run was hung: so long before the first reading, which nobody knows.
#[derive(Debug, Clone, PartialEq)]
pub struct Onset {
    /// For each datum of the run: its index and the time since the first reading, s.
    since: Vec<(usize, f64)>,
    /// What the memory takes it for, s.
    pub usual: f64,
    t0: f64,
}

impl Onset {
    /// Adds to w what it is more for an onset so long before the first reading.
    pub fn add_to(&self, w: &mut Vec<f64>, before: f64) {
        if before != self.usual {
            self.move_in(w, self.usual, before);
        }
    }

    /// Adds to w what it is more for an onset `to` instead of `from` seconds before the first
    /// reading.
    pub fn move_in(&self, w: &mut Vec<f64>, from: f64, to: f64) {
        let end = self.since.iter().map(|(datum, _)| datum + 1).max().unwrap_or(0);
        w.resize(w.len().max(end), 0.0);
        for &(datum, since) in &self.since {
            // log₁₀(1 + (s + to)/t₀) − log₁₀(1 + (s + from)/t₀)
            let [from, to] = [from, to].map(|before| self.t0 + since + before.max(0.0));
            w[datum] += (to / from).log10();
        }
    }
}

/// The onsets of all runs that creep may have begun before; none where there are more than `most`.
pub fn onsets(data: &[Datum], t0: f64, most: usize) -> Vec<Onset> {
    let Some(times) = data.iter().map(|d| d.time).collect::<Option<Vec<f64>>>() else { return Vec::new() };
    let (usual, runs) = (dwell(data, &times), runs(data));
    let of_run = |run: &Vec<usize>| Onset {
        since: run.iter().map(|&i| (i, times[i] - times[run[0]])).collect(),
        usual,
        t0,
    };
    if runs.len() > most || usual <= 0.0 { Vec::new() } else { runs.iter().map(of_run).collect() }
}

/// True where the file says of every load when it was hung.
pub fn is_stated(data: &[Datum]) -> bool {
    data.iter().any(|d| d.loaded_at.is_some()) && data.iter().all(|d| d.load == 0.0 || d.loaded_at.is_some())
}

/// Logarithmic creep: displacement × (1 + k·log₁₀(1 + t/t₀)), t₀ in s. Nothing where a reading has
/// no time, or where all have the same.
pub fn creep(data: &[Datum], clock: Clock, t0: f64) -> Option<Memory> {
    /// Of more changes of a load the first ones creep like the others.
    const MOST_CHANGES: usize = 400;
    let times: Vec<f64> = data.iter().map(|d| d.time).collect::<Option<_>>()?;
    times.iter().any(|time| *time != times[0]).then_some(())?;
    let (dwell, shortest) = (dwell(data, &times), shortest(data, &times));
    let zero = times.iter().fold(0.0, |zero: f64, t| zero.min(*t));
    let mut memory = none(data);
    for run in runs(data) {
        let moments = moments(data, &run, &times);
        let known = |hung: f64| if hung.is_nan() { None } else { Some(hung) };
        let stated = moments.iter().find(|moment| moment.load != 0.0).and_then(|first| known(first.hung));
        let start = match clock {
            Clock::FirstReading => times[run[0]],
            _ => stated.unwrap_or(times[run[0]] - dwell),
        };
        let grown = |now: f64, since: f64| (1.0 + (now - since).max(0.0) / t0).log10();
        let mut this_load = start;
        for (place, moment) in moments.iter().enumerate() {
            let relative = match clock {
                Clock::FirstReading | Clock::FirstLoad | Clock::UnknownOnset => grown(moment.time, start),
                Clock::ThisLoad => {
                    if place > 0 && moments[place - 1].load != moment.load {
                        this_load = moments[place - 1].time;
                    }
                    grown(moment.time, known(moment.hung).unwrap_or(this_load))
                }
                Clock::File => grown(moment.time, zero),
                Clock::EachLoad(when) | Clock::AllLoads(when) => {
                    if moments.len() > MOST_CHANGES {
                        return None;
                    }
                    let (mut load, mut changed, mut crept) = (0.0, start, 0.0);
                    for earlier in &moments[..=place] {
                        let since =
                            known(earlier.hung).unwrap_or(when.between(changed, earlier.time, shortest));
                        crept += (earlier.load - load) * grown(moment.time, since);
                        (load, changed) = (earlier.load, earlier.time);
                    }
                    if load == 0.0 {
                        for &i in &moment.data {
                            memory.lingering[i] = crept * f64::from(data[i].direction.sign);
                        }
                        continue;
                    }
                    crept / load
                }
            };
            moment.data.iter().for_each(|&i| memory.relative[i] = relative);
        }
    }
    Some(memory)
}
