//! What a law remembers: the way the variable went before.

use super::site::{Course, Site};

/// How what went before acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Memory {
    /// It does not.
    None,
    /// The law has the sign of the last move: it resists.
    Side,
    /// A stop operator: the law follows x − P_r\[x\], P_r a play of half width r (A. Visintin,
    /// *Differential Models of Hysteresis*, Springer 1994, ch. III).
    Stop,
    /// What a first-order lag of time τ still lacks: x − x̃, dx̃/dt = (x − x̃)/τ.
    Lag,
}

impl Memory {
    /// All of them.
    pub const ALL: [Memory; 4] = [Memory::None, Memory::Side, Memory::Stop, Memory::Lag];

    /// For people and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Memory::None => "none",
            Memory::Side => "sign of the last move",
            Memory::Stop => "stop operator",
            Memory::Lag => "first-order lag",
        }
    }

    /// True for one with a number of its own.
    pub fn has_constant(self) -> bool {
        matches!(self, Memory::Stop | Memory::Lag)
    }

    /// Range of its number at a site, r in units of X or τ in s; `None` where it cannot be seen.
    pub fn range(self, site: &Site) -> Option<(f64, f64)> {
        match self {
            Memory::None => Some((0.0, 0.0)),
            Memory::Side => site.moves.iter().any(|way| *way < 0.0).then_some((0.0, 0.0)),
            // what never turns round remembers nothing that the variable itself does not say
            Memory::Stop | Memory::Lag if !site.moves.is_empty() && !turns(site) => None,
            Memory::Stop if site.moves.is_empty() => None,
            Memory::Stop => Some((0.02, 0.5)),
            Memory::Lag => {
                let waits = || site.courses.iter().flat_map(|course| course.instants.iter().map(|i| i.1));
                let known = waits().filter(|wait| *wait > 0.0);
                let shortest = known.fold(f64::INFINITY, f64::min);
                let longest = waits().fold(0.0, f64::max);
                let is_known = shortest.is_finite() && waits().all(f64::is_finite);
                is_known.then_some((0.3 * shortest, 3.0 * longest))
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
                (along(site, stop), None)
            }
            Memory::Lag => {
                let lag = |state: &mut f64, x: f64, elapsed: f64| {
                    // x̃ = x − (x − x̃)·e^(−Δt/τ)
                    let lacks = (x - *state) * (-elapsed / constant).exp();
                    *state = x - lacks;
                    lacks
                };
                (along(site, lag), None)
            }
        }
    }
}

/// True where the variable goes up and down along some course.
fn turns(site: &Site) -> bool {
    let turns = |course: &Course| {
        let values = course.instants.iter().filter_map(|(data, _)| data.first().map(|&i| site.values[i]));
        let all: Vec<f64> = std::iter::once(course.start).chain(values.filter(|x| x.is_finite())).collect();
        let goes = |sign: f64| all.windows(2).any(|pair| sign * (pair[1] - pair[0]) > 0.0);
        goes(1.0) && goes(-1.0)
    };
    site.courses.iter().any(turns)
}

/// What an operator makes of the variable along each course.
fn along(site: &Site, operator: impl Fn(&mut f64, f64, f64) -> f64) -> Vec<f64> {
    let mut followed = vec![f64::NAN; site.values.len()];
    for Course { instants, start } in &site.courses {
        let mut state = *start;
        for (data, elapsed) in instants {
            let Some(x) = data.first().map(|&i| site.values[i]).filter(|x| x.is_finite()) else { continue };
            let value = operator(&mut state, x, *elapsed);
            data.iter().for_each(|&i| followed[i] = value);
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
                instants: (0..values.len()).map(|i| (vec![i], 2.0)).collect(),
                start: 0.0,
            }],
            forms: &Form::ALL,
        }
    }

    #[test]
    fn a_stop_grows_to_its_width_and_turns_round() {
        let site = site(&[1.0, 2.0, 4.0, 3.0, 1.0]);
        let (followed, _) = Memory::Stop.remembered(&site, 0.25);
        assert_eq!(followed, [1.0, 1.0, 1.0, 0.0, -1.0]);
        assert_eq!(Memory::Side.range(&site), None);
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
