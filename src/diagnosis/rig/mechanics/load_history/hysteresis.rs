//! Hysteresis: the loops that a load leaves on its way up and down.

use std::collections::HashMap;

use super::memory::{Memory, none, runs};
use crate::diagnosis::rig::recording::datum::Datum;
use crate::spatial::Direction;

/// Shape of a hysteresis loop. All are independent of rate and closed at the largest load of the
/// run, F_max, and at half of it h of full scale wide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loop {
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
    /// As [`Loop::NewByRayleigh`], read from the zero that was taken before the first run: what the
    /// first run has left, 2h·F_max, stands in all that follow it in its direction.
    KeptByRayleigh,
    /// As [`Loop::NewByPlays`], read from one zero: the first run leaves h·F_max.
    KeptByPlays,
    /// A rod that is loaded for the first time by such plays in every run: other directions between
    /// the runs undo what they remember. ⅔ of [`Loop::NewByPlays`], h wide at half load.
    FirstByPlays,
    /// A load that goes up and down across zero: half of h of its whole range above the straight
    /// line between its turns while falling, below it while rising, by parabolas (Lord Rayleigh's
    /// branches, Masing's rule).
    Turning,
}

impl Loop {
    pub const ALL: [Loop; 10] = [
        Loop::Closed,
        Loop::Symmetric,
        Loop::Remanent,
        Loop::Virgin,
        Loop::NewByRayleigh,
        Loop::NewByPlays,
        Loop::KeptByRayleigh,
        Loop::KeptByPlays,
        Loop::FirstByPlays,
        Loop::Turning,
    ];

    /// For people; nothing for the plainest.
    pub fn name(self) -> &'static str {
        match self {
            Loop::Closed => "",
            Loop::Symmetric => "loaded before",
            Loop::Remanent => "open at zero",
            Loop::Virgin => "loaded for the first time",
            Loop::Turning => "at each turn",
            Loop::NewByRayleigh => "new before these readings",
            Loop::NewByPlays => "new before these readings, by plays",
            Loop::KeptByRayleigh => "new before these readings, one zero",
            Loop::KeptByPlays => "new before these readings, one zero, by plays",
            Loop::FirstByPlays => "loaded for the first time, by plays",
        }
    }

    /// The same, read from a zero of each run; and what its first run leaves there, as a share of
    /// h·F_max, where the one zero shows it.
    fn of_each_run(self) -> (Loop, f64) {
        match self {
            Loop::KeptByRayleigh => (Loop::NewByRayleigh, 2.0),
            Loop::KeptByPlays => (Loop::NewByPlays, 1.0),
            other => (other, 0.0),
        }
    }
}

/// Hysteresis; nothing where nothing was read on the way down.
pub fn hysteresis(data: &[Datum], shape: Loop) -> Option<Memory> {
    data.iter().any(Datum::is_unloading).then_some(())?;
    if shape == Loop::Turning {
        return turning(data);
    }
    let mut memory = none(data);
    let (shape, leaves) = shape.of_each_run();
    let mut known: HashMap<Direction, f64> = HashMap::new();
    let mut left: HashMap<Direction, f64> = HashMap::new();
    let remembers = matches!(shape, Loop::NewByRayleigh | Loop::NewByPlays);
    for run in runs(data) {
        let size = |d: &Datum| d.imposed.map_or(d.load, |u| u.set.abs() / u.per_newton);
        let largest = run.iter().fold(0.0, |max: f64, &i| max.max(size(&data[i])));
        let direction = data[run[0]].direction;
        let before = known.entry(direction).or_insert(f64::NEG_INFINITY);
        let is_new = largest > *before;
        *before = before.max(largest);
        let remains = if is_new { 0.0 } else { left.get(&direction).copied().unwrap_or(0.0) };
        if is_new {
            left.insert(direction, leaves * largest);
        }
        let shape = if remembers && !is_new { Loop::Symmetric } else { shape };
        let (shape, share) = match shape {
            Loop::FirstByPlays => (Loop::NewByPlays, 2.0 / 3.0),
            other => (other, 1.0),
        };
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
                (Loop::Closed | Loop::Remanent, false)
                | (Loop::Turning | Loop::FirstByPlays | Loop::KeptByRayleigh | Loop::KeptByPlays, _) => {}
            }
            memory.relative[i] *= share;
            memory.lingering[i] = share * memory.lingering[i] + remains;
        }
    }
    Some(memory)
}

/// Loops between the turns of a load across zero.
fn turning(data: &[Datum]) -> Option<Memory> {
    let mut memory = none(data);
    let mut is_any = false;
    for run in runs(data) {
        let load = |i: usize| data[i].imposed.map_or(data[i].signed_load(), |u| u.set / u.per_newton);
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
