//! What a law remembers: the way the variable went before.

use super::bouc_wen::{Loop, LoopShape};
use super::site::{Course, Instant, Site};
use super::stops::{MOST, Stops};

/// How what went before acts.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Memory {
    /// It does not.
    None,
    /// The law has the sign of the last move: it resists.
    Side,
    /// A stop operator: the law follows x − P_r\[x\], P_r a play of half width r (A. Visintin,
    /// *Differential Models of Hysteresis*, Springer 1994, ch. III).
    Stop,
    /// P_r\[x\] itself: what is moved through a play of half width r, and stays where it was left.
    Play,
    /// Several stop operators side by side, the widest of half width r: see [`Stops`].
    Stops(Stops),
    /// z of a Bouc–Wen loop that yields at r: see [`LoopShape`].
    BoucWen(LoopShape),
    /// What a first-order lag of time τ still lacks: x − x̃, dx̃/dt = (x − x̃)/τ.
    Lag,
    /// Its lagged self since the start, x̃ − x_0, of what changes evenly between two readings, as
    /// temperatures do: the zero was taken then.
    Lagged,
}

/// What lags behind a load is known by the loads that came before, up to this share of a course.
const OF_COURSE: f64 = 0.3;
/// A lag may be so many times as long as the recording: it is known as a rate alone then.
const LONGER: f64 = 5.0;

impl Memory {
    /// All of them.
    pub const ALL: [Memory; 9] = [
        Memory::None,
        Memory::Side,
        Memory::Stop,
        Memory::Play,
        Memory::Stops(Stops::TWO),
        Memory::Stops(Stops::THREE),
        Memory::BoucWen(LoopShape::MIDDLE),
        Memory::Lag,
        Memory::Lagged,
    ];

    /// For people and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Memory::None => "none",
            Memory::Side => "sign of the last move",
            Memory::Stop => "stop operator",
            Memory::Play => "play operator",
            Memory::Stops(stops) if stops.count() == 2 => "two stop operators",
            Memory::Stops(_) => "three stop operators",
            Memory::BoucWen(_) => "Bouc–Wen loop",
            Memory::Lag => "first-order lag",
            Memory::Lagged => "lagged self",
        }
    }

    /// True for one with a number of its own.
    pub fn has_constant(self) -> bool {
        match self {
            Memory::None | Memory::Side => false,
            Memory::Stop
            | Memory::Play
            | Memory::Stops(_)
            | Memory::BoucWen(_)
            | Memory::Lag
            | Memory::Lagged => true,
        }
    }

    /// True for the same, whatever the shape of its loop.
    pub fn is(self, other: Memory) -> bool {
        match (self, other) {
            (Memory::Stops(one), Memory::Stops(other)) => one.count() == other.count(),
            _ => std::mem::discriminant(&self) == std::mem::discriminant(&other),
        }
    }

    /// Range of its number at a site, r in units of X or τ in s; `None` where it cannot be seen.
    pub fn range(self, site: &Site) -> Option<(f64, f64)> {
        match self {
            Memory::None => Some((0.0, 0.0)),
            Memory::Side => site.moves.iter().any(|way| *way < 0.0).then_some((0.0, 0.0)),
            // what never turns round remembers nothing that the variable itself does not say
            Memory::Stop | Memory::Play | Memory::Stops(_) | Memory::BoucWen(_) | Memory::Lag
                if !site.moves.is_empty() && !turns(site) =>
            {
                None
            }
            Memory::Stop | Memory::Play | Memory::Stops(_) | Memory::BoucWen(_) if site.moves.is_empty() => {
                None
            }
            // what a law only adds to is moved by no clearance, and friction with a compliance
            // looks like one there
            Memory::Play if !site.gives_way() => None,
            Memory::Stop | Memory::Play => Some((0.02, 0.5)),
            // the widest of several need not slip both ways
            Memory::Stops(_) => Some((0.02, 1.0)),
            // it is nearly a straight line up to r, and bends from half of that on
            Memory::BoucWen(_) => Some((0.02, 1.0)),
            // of a load it is what the load itself is, less what it lacks
            Memory::Lagged if !site.moves.is_empty() => None,
            Memory::Lag | Memory::Lagged => {
                let waits =
                    || site.courses.iter().flat_map(|course| course.instants.iter().map(|i| i.elapsed));
                let known = waits().filter(|wait| *wait > 0.0);
                let shortest = known.fold(f64::INFINITY, f64::min);
                // a load is what it is from one reading to the next; all else has changed before
                let lasted = |course: &Course| course.instants.iter().map(|i| i.elapsed).sum::<f64>();
                let longest = match site.moves.is_empty() {
                    true => LONGER * waits().sum::<f64>(),
                    false => {
                        let course = site.courses.iter().map(lasted).fold(0.0, f64::max);
                        (3.0 * waits().fold(0.0, f64::max)).max(OF_COURSE * course)
                    }
                };
                let is_known = shortest.is_finite() && waits().all(f64::is_finite);
                is_known.then_some((0.3 * shortest, longest))
            }
        }
    }

    /// What a law follows at each datum instead of x, and the sign with which.
    pub fn remembered(self, site: &Site, constant: f64) -> (Vec<f64>, Option<&[f64]>) {
        match self {
            Memory::None => (site.values.clone(), None),
            Memory::Side => (site.values.clone(), Some(&site.moves)),
            Memory::Stop => {
                let half = constant * site.largest();
                let stop = |state: &mut f64, x: f64, _: f64| {
                    // the play moves only where its edge is met
                    *state = state.clamp(x - half, x + half);
                    x - *state
                };
                (along(site, |start| start, stop), None)
            }
            Memory::Play => {
                let half = constant * site.largest();
                let play = |state: &mut f64, x: f64, _: f64| {
                    *state = state.clamp(x - half, x + half);
                    *state
                };
                (along(site, |start| start, play), None)
            }
            Memory::Stops(stops) => {
                let half = constant * site.largest();
                let follow = |plays: &mut [f64; MOST], x: f64, _: f64| stops.follow(plays, x, half);
                (along(site, |start| [start; MOST], follow), None)
            }
            Memory::BoucWen(shape) => {
                let (yielding, of_shape) = (constant * site.largest(), Loop::new(shape));
                let follow = |state: &mut (f64, f64), x: f64, _: f64| {
                    let (before, zeta) = *state;
                    *state = (x, of_shape.after(zeta, (x - before) / yielding));
                    yielding * state.1
                };
                (along(site, |start| (start, 0.0), follow), None)
            }
            Memory::Lag => {
                let lag = |state: &mut f64, x: f64, elapsed: f64| {
                    // x̃ = x − (x − x̃)·e^(−Δt/τ)
                    let lacks = (x - *state) * (-elapsed / constant).exp();
                    *state = x - lacks;
                    lacks
                };
                (along(site, |start| start, lag), None)
            }
            Memory::Lagged => {
                let lagged = |(start, before, own): &mut (f64, f64, f64), x: f64, elapsed: f64| {
                    // of x = x₀ + s·t: x̃ = x − s·τ + (x̃₀ − x₀ + s·τ)·e^(−t/τ)
                    let behind = if elapsed > 0.0 { (x - *before) / elapsed * constant } else { 0.0 };
                    *own = x - behind + (*own - *before + behind) * (-elapsed / constant).exp();
                    *before = x;
                    *own - *start
                };
                (along(site, |start| (start, start, start), lagged), None)
            }
        }
    }
}

/// True where the variable goes up and down along some course.
fn turns(site: &Site) -> bool {
    let turns = |course: &Course| {
        let values = course.instants.iter().filter_map(|instant| signed(site, instant));
        let all: Vec<f64> = std::iter::once(course.start).chain(values).collect();
        let goes = |sign: f64| all.windows(2).any(|pair| sign * (pair[1] - pair[0]) > 0.0);
        goes(1.0) && goes(-1.0)
    };
    site.courses.iter().any(turns)
}

/// The variable at an instant, along its course.
fn signed(site: &Site, instant: &Instant) -> Option<f64> {
    let value = instant.data.first().map(|&i| instant.sense * site.values[i]);
    value.filter(|x| x.is_finite())
}

/// What an operator makes of the variable along each course, from the state that belongs to its
/// start on.
fn along<State>(
    site: &Site,
    start: impl Fn(f64) -> State,
    operator: impl Fn(&mut State, f64, f64) -> f64,
) -> Vec<f64> {
    let mut followed = vec![f64::NAN; site.values.len()];
    for course in &site.courses {
        let mut state = start(course.start);
        for instant in &course.instants {
            let Some(x) = signed(site, instant) else { continue };
            let value = instant.sense * operator(&mut state, x, instant.elapsed);
            instant.data.iter().for_each(|&i| followed[i] = value);
        }
    }
    followed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::law::{Form, Measure};
    use crate::inference::{Location, Part};

    fn site(values: &[f64]) -> Site {
        let measure = |symbol| Measure { symbol, name: symbol.into(), unit: "", si: 1.0 };
        Site {
            location: Location::Part(Part::Clamp),
            result: measure("u"),
            variable: measure("F"),
            directions: vec![(String::new(), vec![1.0; values.len()])],
            values: values.to_vec(),
            recorded: None,
            moves: vec![1.0; values.len()],
            courses: vec![Course {
                instants: (0..values.len())
                    .map(|i| Instant { data: vec![i], elapsed: 2.0, sense: 1.0 })
                    .collect(),
                start: 0.0,
            }],
            forms: &Form::ALL,
            rare: &[],
        }
    }

    #[test]
    fn a_stop_grows_to_its_width_and_turns_round() {
        let site = site(&[1.0, 2.0, 4.0, 3.0, 1.0]);
        let (followed, _) = Memory::Stop.remembered(&site, 0.25);
        assert_eq!(followed, [1.0, 1.0, 1.0, 0.0, -1.0]);
        assert_eq!(Memory::Side.range(&site), None);
    }

    /// What points the other way goes through zero.
    #[test]
    fn a_stop_goes_on_across_zero() {
        let mut site = site(&[2.0, 2.0, 2.0]);
        site.courses[0].instants[1].sense = -1.0;
        let (followed, _) = Memory::Stop.remembered(&site, 0.25);
        assert_eq!(followed, [0.5, 0.5, 0.5]);
        // nothing is left of where it was
        let shape = LoopShape { sharpness: 1.0, balance: 0.5 };
        let (followed, _) = Memory::BoucWen(shape).remembered(&site, 0.25);
        let first = 0.5 * (1.0 - (-4.0f64).exp());
        let second = 0.5 * (1.0 - (-8.0 + first / 0.5).exp());
        assert!((followed[0] - first).abs() < 1e-5 && (followed[1] - second).abs() < 1e-5, "{followed:?}");
    }

    /// Behind what grows evenly it stays by what grows in τ.
    #[test]
    fn a_lagged_self_comes_behind() {
        let mut site = site(&[0.0, 2.0, 4.0, 6.0, 100.0]);
        site.moves.clear();
        assert_eq!(Memory::Lagged.range(&site), Some((0.6, 50.0)));
        let (followed, _) = Memory::Lagged.remembered(&site, 0.5);
        assert!((followed[3] - 5.5).abs() < 1e-4, "{followed:?}");
        let exact = |t: f64| t - 0.5 + 0.5 * (-t / 0.5).exp();
        assert!((followed[1] - exact(2.0)).abs() < 1e-12, "{followed:?}");
        site.courses[0].start = -1.0;
        let (later, _) = Memory::Lagged.remembered(&site, 1e-3);
        assert!((later[3] - 7.0).abs() < 0.01, "{later:?}");
        // of a load it says nothing that the load and what it lacks do not say
        site.moves = vec![1.0; 5];
        assert_eq!(Memory::Lagged.range(&site), None);
    }

    #[test]
    fn a_lag_lacks_less_the_longer_it_waits() {
        let site = site(&[1.0, 1.0, 0.0]);
        let (followed, _) = Memory::Lag.remembered(&site, 2.0);
        let e = (-1.0f64).exp();
        let lacks = [e, e * e, -(1.0 - e * e) * e];
        assert!(followed.iter().zip(lacks).all(|(a, b)| (a - b).abs() < 1e-15), "{followed:?}");
        assert_eq!(Memory::Lag.range(&site), Some((0.6, 6.0)));
    }
}
