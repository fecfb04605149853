//! What a rod remembers of its loads: creep and hysteresis.

use std::collections::HashMap;

use super::datum::Datum;
use crate::spatial::Direction;

/// How the history of loads acts on each datum.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Memory {
    /// w: the displacement is multiplied by 1 + v·w.
    pub relative: Vec<f64>,
    /// W, N: the load v·W is felt besides the one that acts.
    pub lingering: Vec<f64>,
    /// D, m: readings show v·D besides, of loads of other runs; nothing where none counts.
    pub recovery: Vec<f64>,
}

/// Which law a memory follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum History {
    /// Creep by a clock, with t₀ in s.
    Creep(Clock, f64),
    /// Hysteresis of a shape.
    Loop(Loop),
    /// Softening with temperature.
    Temperature,
}

/// Since when a reading has crept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Clock {
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
pub(super) enum Changed {
    /// Right after the one.
    Early,
    /// Half way.
    Midway,
    /// Right before the other.
    Late,
}

impl Changed {
    /// The time of the change between readings at two times, s.
    pub(super) fn between(self, before: f64, after: f64) -> f64 {
        match self {
            Changed::Early => before,
            Changed::Midway => 0.5 * (before + after),
            Changed::Late => after,
        }
    }
}

impl Clock {
    pub(super) const ALL: [Clock; 10] = [
        Clock::FirstReading,
        Clock::FirstLoad,
        Clock::EachLoad(Changed::Early),
        Clock::EachLoad(Changed::Midway),
        Clock::EachLoad(Changed::Late),
        Clock::AllLoads(Changed::Early),
        Clock::AllLoads(Changed::Late),
        Clock::ThisLoad,
        Clock::File,
        Clock::UnknownOnset,
    ];
    /// Where the file says when each load was hung.
    pub(super) const STATED: [Clock; 4] =
        [Clock::ThisLoad, Clock::EachLoad(Changed::Early), Clock::AllLoads(Changed::Early), Clock::FirstLoad];

    /// For people.
    pub(super) fn name(self) -> &'static str {
        match self {
            Clock::ThisLoad => "since this load was hung",
            Clock::UnknownOnset => "since a moment before each run",
            Clock::FirstReading => "since the first reading",
            Clock::FirstLoad => "since the first load",
            Clock::EachLoad(Changed::Early) => "since each load",
            Clock::EachLoad(Changed::Midway) => "since each load, hung between two readings",
            Clock::EachLoad(Changed::Late) => "since each load, hung as it was read",
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
pub(super) struct Onset {
    /// For each datum of the run: its index and the time since the first reading, s.
    since: Vec<(usize, f64)>,
    /// What the memory takes it for, s.
    pub usual: f64,
    t0: f64,
}

impl Onset {
    /// Adds to w what it is more for an onset so long before the first reading.
    pub(super) fn add_to(&self, w: &mut Vec<f64>, before: f64) {
        if before != self.usual {
            self.move_in(w, self.usual, before);
        }
    }

    /// Adds to w what it is more for an onset `to` instead of `from` seconds before the first
    /// reading.
    pub(super) fn move_in(&self, w: &mut Vec<f64>, from: f64, to: f64) {
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
pub(super) fn onsets(data: &[Datum], t0: f64, most: usize) -> Vec<Onset> {
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
pub(super) fn is_stated(data: &[Datum]) -> bool {
    data.iter().any(|d| d.loaded_at.is_some()) && data.iter().all(|d| d.load == 0.0 || d.loaded_at.is_some())
}

/// An instant of a run: its load along the positive axis (N), its time and when that load was hung
/// (s).
pub(super) struct Moment {
    pub load: f64,
    pub time: f64,
    /// NaN where the file does not say.
    pub hung: f64,
    pub data: Vec<usize>,
}

pub(super) fn moments(data: &[Datum], run: &[usize], times: &[f64]) -> Vec<Moment> {
    let of_instant = |instant: Vec<usize>| {
        // of an imposed displacement the one that is largest counts, as the load that it would need
        let load =
            |i: &usize| data[*i].imposed.map_or(data[*i].signed_load(), |u| u.displacement / u.per_newton);
        let is_imposed = |i: &&usize| data[**i].imposed.is_some();
        let imposed = instant.iter().filter(is_imposed).map(load).max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let (first, time) = (instant[0], times[instant[0]]);
        let hung = data[first].loaded_at.unwrap_or(f64::NAN);
        Moment { load: imposed.unwrap_or_else(|| load(&first)), time, hung, data: instant }
    };
    instants(data, run).into_iter().map(of_instant).collect()
}

/// Logarithmic creep: displacement × (1 + k·log₁₀(1 + t/t₀)), t₀ in s. Nothing where a reading has
/// no time, or where all have the same.
pub(super) fn creep(data: &[Datum], clock: Clock, t0: f64) -> Option<Memory> {
    /// Of more changes of a load the first ones creep like the others.
    const MOST_CHANGES: usize = 400;
    let times: Vec<f64> = data.iter().map(|d| d.time).collect::<Option<_>>()?;
    times.iter().any(|time| *time != times[0]).then_some(())?;
    let dwell = dwell(data, &times);
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
                        let since = known(earlier.hung).unwrap_or(when.between(changed, earlier.time));
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

/// Softening with temperature: displacement × (1 + k·(T − T̄)), T̄ the mean of the recording, K.
/// Nothing where a reading has no temperature, or where all have the same.
pub(super) fn warmth(data: &[Datum]) -> Option<Memory> {
    let temperatures: Vec<f64> = data.iter().map(|d| d.temperature).collect::<Option<_>>()?;
    temperatures.iter().any(|one| *one != temperatures[0]).then_some(())?;
    let mean = temperatures.iter().sum::<f64>() / temperatures.len() as f64;
    Some(Memory { relative: temperatures.into_iter().map(|one| one - mean).collect(), ..none(data) })
}

/// Shape of a hysteresis loop. All are independent of rate and closed at the largest load of the
/// run, F_max, and at half of it h of full scale wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Loop {
    /// Closed at zero too: unloading readings are larger by h·4·C·F·(1 − F/F_max).
    Closed,
    /// As [`Loop::Closed`], half of it below the straight line on the way up and half above it on
    /// the way down: a rod that was loaded before (A. Visintin, Differential Models of Hysteresis,
    /// 1994, ch. III: plays of Prandtl and Ishlinskii).
    Symmetric,
    /// Open at zero: unloading readings are larger by h·C·(F_max − F), twice as wide there as at
    /// half load.
    Remanent,
    /// A rod that is loaded for the first time: b·F² on the way up, b·(F_max² − ½(F_max − F)²) on
    /// the way down, b = 8h/5F_max (Lord Rayleigh, Phil. Mag. 23 (1887) 225–245: a quadratic law
    /// and branches of half its curvature).
    Virgin,
    /// A new rod that remembers from run to run: as [`Loop::Symmetric`] but in a run that goes
    /// further than any before in its direction, which is a first one by Lord Rayleigh's law with
    /// the same branches, F·(1 − 2h) + 4h·F²/F_max on the way up.
    NewByRayleigh,
    /// The same by plays that are spread evenly up to half of the largest load (Visintin, ch. III):
    /// beyond half of it the first way up is straight, F·(1 + 2h) − h·F_max.
    NewByPlays,
    /// A load that goes up and down across zero: half of h of its whole range above the straight
    /// line between its turns while falling, below it while rising, by parabolas (Lord Rayleigh's
    /// branches, Masing's rule).
    Turning,
}

impl Loop {
    pub(super) const ALL: [Loop; 7] = [
        Loop::Closed,
        Loop::Symmetric,
        Loop::Remanent,
        Loop::Virgin,
        Loop::NewByRayleigh,
        Loop::NewByPlays,
        Loop::Turning,
    ];

    /// For people; nothing for the plainest.
    pub(super) fn name(self) -> &'static str {
        match self {
            Loop::Closed => "",
            Loop::Symmetric => "loaded before",
            Loop::Remanent => "open at zero",
            Loop::Virgin => "loaded for the first time",
            Loop::Turning => "at each turn",
            Loop::NewByRayleigh => "new before these readings",
            Loop::NewByPlays => "new before these readings, by plays",
        }
    }
}

/// Hysteresis; nothing where nothing was read on the way down.
pub(super) fn hysteresis(data: &[Datum], shape: Loop) -> Option<Memory> {
    data.iter().any(Datum::is_unloading).then_some(())?;
    if shape == Loop::Turning {
        return turning(data);
    }
    let mut memory = none(data);
    let mut known: HashMap<Direction, f64> = HashMap::new();
    let remembers = matches!(shape, Loop::NewByRayleigh | Loop::NewByPlays);
    for run in runs(data) {
        let size = |d: &Datum| d.imposed.map_or(d.load, |u| u.displacement.abs() / u.per_newton);
        let largest = run.iter().fold(0.0, |max: f64, &i| max.max(size(&data[i])));
        let direction = data[run[0]].direction;
        let before = known.entry(direction).or_insert(f64::NEG_INFINITY);
        let is_new = largest > *before;
        *before = before.max(largest);
        let shape = if remembers && !is_new { Loop::Symmetric } else { shape };
        for i in run.into_iter().filter(|_| largest > 0.0) {
            let (load, is_unloading) = (size(&data[i]), data[i].is_unloading());
            let parabola = 4.0 * (1.0 - load / largest);
            match (shape, is_unloading) {
                (Loop::Closed, true) => memory.relative[i] = parabola,
                (Loop::Symmetric, true) => memory.relative[i] = 0.5 * parabola,
                (Loop::Symmetric, false) => memory.relative[i] = -0.5 * parabola,
                (Loop::Remanent, true) => memory.lingering[i] = 2.0 * (largest - load),
                (Loop::Virgin, false) => memory.relative[i] = 1.6 * load / largest,
                (Loop::Virgin, true) => {
                    memory.lingering[i] = 1.6 * (largest.powi(2) - 0.5 * (largest - load).powi(2)) / largest;
                }
                (Loop::NewByPlays, false) if load > 0.5 * largest => {
                    memory.relative[i] = 2.0 - largest / load
                }
                (Loop::NewByRayleigh | Loop::NewByPlays, false) => {
                    memory.relative[i] = 4.0 * load / largest - 2.0;
                }
                // the branch of a rod that was loaded before, from where the first way up has led
                (Loop::NewByRayleigh, true) => {
                    memory.lingering[i] = 0.5 * parabola * load + 2.0 * largest;
                }
                (Loop::NewByPlays, true) => memory.lingering[i] = 0.5 * parabola * load + largest,
                (Loop::Closed | Loop::Remanent, false) | (Loop::Turning, _) => {}
            }
        }
    }
    Some(memory)
}

/// Loops between the turns of a load across zero.
fn turning(data: &[Datum]) -> Option<Memory> {
    let mut memory = none(data);
    let mut is_any = false;
    for run in runs(data) {
        let load =
            |i: usize| data[i].imposed.map_or(data[i].signed_load(), |u| u.displacement / u.per_newton);
        let (least, most) = run.iter().fold((0.0f64, 0.0f64), |(a, b), &i| (a.min(load(i)), b.max(load(i))));
        if least >= 0.0 || most <= 0.0 {
            continue;
        }
        is_any = true;
        let (middle, half) = (0.5 * (least + most), 0.5 * (most - least));
        for i in run {
            let Some(motion) = data[i].motion else { continue };
            let share = 1.0 - ((load(i) - middle) / half).powi(2);
            memory.lingering[i] = -motion.direction * f64::from(data[i].direction.sign) * half * share;
        }
    }
    is_any.then_some(memory)
}

fn none(data: &[Datum]) -> Memory {
    Memory { relative: vec![0.0; data.len()], lingering: vec![0.0; data.len()], recovery: Vec::new() }
}

/// Indices of the data of each run, in the order of recording.
pub(super) fn runs(data: &[Datum]) -> Vec<Vec<usize>> {
    let count = data.iter().map(|d| d.run + 1).max().unwrap_or_default();
    let mut runs = vec![Vec::new(); count];
    for (index, datum) in data.iter().enumerate() {
        runs[datum.run].push(index);
    }
    runs.retain(|run| !run.is_empty());
    runs
}

/// Data of a run by instant.
pub(super) fn instants(data: &[Datum], run: &[usize]) -> Vec<Vec<usize>> {
    run.chunk_by(|&a, &b| data[a].order == data[b].order).map(<[usize]>::to_vec).collect()
}

/// Usual time between two readings of a run, s: the median; 0 where no run has two times.
pub(super) fn dwell(data: &[Datum], times: &[f64]) -> f64 {
    let steps = runs(data)
        .into_iter()
        .flat_map(|run| run.windows(2).map(|pair| times[pair[1]] - times[pair[0]]).collect::<Vec<_>>());
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::rig::datum;
    use crate::rig::readings::Readings;

    const TEXT: &str = "axis,load_n,phase,time_s,dy_um
-y,5,load,100,0
-y,10,load,200,0
-y,5,unload,300,0
-y,0,unload,400,0
";

    fn data(text: &str) -> Vec<Datum> {
        datum::all(&Readings::from_text("f", text).unwrap().rows)
    }

    #[test]
    fn clocks_start_where_they_say() {
        let data = data(TEXT);
        let second = |clock| creep(&data, clock, 1.0).unwrap().relative[1];
        assert_eq!(second(Clock::FirstReading), 101f64.log10());
        assert_eq!(second(Clock::FirstLoad), 201f64.log10());
        assert_eq!(second(Clock::File), 201f64.log10());
        // 5 N for 200 s, 5 N more for 100 s
        let each = (5.0 * 201f64.log10() + 5.0 * 101f64.log10()) / 10.0;
        assert!((second(Clock::EachLoad(Changed::Early)) - each).abs() < 1e-15);
    }

    #[test]
    fn an_unloaded_rod_still_recovers() {
        let memory = creep(&data(TEXT), Clock::EachLoad(Changed::Early), 1.0).unwrap();
        let left = 5.0 * (401f64.log10() + 301f64.log10() - 201f64.log10() - 101f64.log10());
        assert!((memory.lingering[3] - left).abs() < 1e-12 && left > 0.0);
        assert_eq!(memory.relative[3], 0.0);
    }

    #[test]
    fn loops_close_at_the_largest_load() {
        let data = data(TEXT);
        let closed = hysteresis(&data, Loop::Closed).unwrap();
        assert_eq!(closed.relative, [0.0, 0.0, 2.0, 4.0]);
        let remanent = hysteresis(&data, Loop::Remanent).unwrap();
        assert_eq!(remanent.lingering, [0.0, 0.0, 10.0, 20.0]);
        let symmetric = hysteresis(&data, Loop::Symmetric).unwrap();
        assert_eq!(symmetric.relative, [-1.0, 0.0, 1.0, 2.0]);
        // the branches of a virgin rod meet at the largest load, and are h·F_max apart at half of
        // it
        let virgin = hysteresis(&data, Loop::Virgin).unwrap();
        let felt = |i: usize| data[i].load * virgin.relative[i] + virgin.lingering[i];
        assert!((felt(2) - felt(0) - 10.0).abs() < 1e-12 && felt(3) > 0.0);
    }

    #[test]
    fn a_new_rod_is_new_once_in_each_direction() {
        let run = |direction: &str, trial: usize| {
            format!(
                "{direction},5,load,{trial},0\n{direction},10,load,{trial},0\n{direction},5,unload,{trial},0\n"
            )
        };
        let text = |runs: &[String]| "axis,load_n,phase,trial,dy_um\n".to_owned() + &runs.concat();
        let mixed = data(&text(&[run("y", 1), run("-y", 2), run("y", 3)]));
        let before = hysteresis(&mixed, Loop::Symmetric).unwrap();
        for (shape, set) in [(Loop::NewByRayleigh, 2.0), (Loop::NewByPlays, 1.0)] {
            let new = hysteresis(&mixed, shape).unwrap();
            let felt = |i: usize| mixed[i].load * new.relative[i] + new.lingering[i];
            // half the largest load, all of it, and half of it again
            for (at, first) in [(0, 0.0), (3, 0.0)] {
                assert_eq!([0, 1, 2].map(|k| felt(at + k)), [first, 10.0 * set, 10.0 * set + 5.0]);
            }
            assert_eq!(
                (&new.relative[6..], &new.lingering[6..]),
                (&before.relative[6..], &before.lingering[6..])
            );
        }
    }

    #[test]
    fn without_time_or_a_way_down_there_is_no_memory() {
        let data = data("axis,load_n,time_s,dy_um\ny,5,1,0\ny,6,,0\n");
        assert!(creep(&data, Clock::File, 1.0).is_none());
        assert!(hysteresis(&data, Loop::Closed).is_none());
    }
}
