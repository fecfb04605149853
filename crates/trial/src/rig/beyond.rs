//! Physics that no library has, as large as it may be:
//!
//! | effect | size | at most |
//! |---|---|---|
//! | a gap that closes | stiffening beyond it | 70 % |
//! | sensor ripple | amplitude µm; period 20 to 200 µm | 20 |
//! | Hertzian seat | µm at the largest load, with F^(2/3) below | 100 |
//! | running in | share of the first displacement; over 3 to 30 loadings | 20 % |
//! | clamp loose one way | more displacement one way | 50 % |
//! | oscillation in time | µm in some direction; 1.3 to 6 periods in the recording | 40 |
//! | wall that varies along the rod | bending, in 0.6 to 2 waves over its length | 60 % |
//! | memory of the load before | product of both loads, at the largest | 20 % |
//! | damped slide | share of a change of the load that is still to come | 100 % |
//! | friction that wears | share of the largest load, in the last run; three times less in the first | 15 % |
//! | speed of loading | softer for each decade of speed | 10 % |

use super::bench::Bench;
use super::draw::direction;
use super::effect::Effect;
use super::setup::Needs;
use crate::chance::{happens, log_uniform, one_of};
use rodcal_base::statistics::Random;
use rodcal_base::units::UM;

/// How many there are, by number.
pub const BEYOND: usize = 11;
/// Range of the largest size, of the end in the table.
const LARGEST: (f64, f64) = (0.5, 1.0);

/// What a protocol must have to carry it.
pub fn needs(effect: usize) -> Needs {
    let needs = Needs { two_channels: true, ..Needs::default() };
    match effect {
        2 => Needs { tip: true, ..needs },
        4 => Needs { both_signs: true, ..needs },
        5 => Needs { time: true, trials: true, ..needs },
        6 => Needs { stations: true, two_axes: true, ..needs },
        7 => Needs { shuffled: true, ..needs },
        8 => Needs { time: true, varied_waits: true, unloading: true, ..needs },
        9 => Needs { trials: true, unloading: true, ..needs },
        10 => Needs { time: true, varied_waits: true, ..needs },
        _ => needs,
    }
}

/// The effect of this number.
pub fn draw(effect: usize, bench: &Bench, random: &mut Random) -> Effect {
    let protocol = &bench.protocol;
    let largest = protocol.largest_load();
    let phase = random.uniform(0.0, std::f64::consts::TAU);
    let large = random.uniform(LARGEST.0, LARGEST.1);
    match effect {
        0 => {
            let load = random.uniform(0.3, 0.7) * largest;
            Effect::GapCloses { load, share: 1.0 - 0.7 * large }
        }
        1 => Effect::Ripple {
            channel: one_of(random, &protocol.axes(), 0),
            amplitude: 20.0 * large * UM,
            period: log_uniform(random, 20.0, 200.0) * UM,
            phase,
        },
        2 => Effect::Seat(100.0 * large * UM),
        3 => Effect::RunningIn { share: 0.2 * large, loadings: log_uniform(random, 3.0, 30.0) },
        4 => Effect::LooseClamp(0.5 * large),
        5 => {
            let length = protocol.loadings.last().map_or(1.0, |l| l.time);
            let amplitude = direction(random).map(|part| 40.0 * large * UM * part);
            Effect::Oscillation { amplitude, period: length / random.uniform(1.3, 6.0), phase }
        }
        6 => {
            let period = bench.drawing.length() / random.uniform(0.6, 2.0);
            Effect::Waviness { amplitude: 0.6 * large, period, phase }
        }
        7 => {
            let sign = if happens(random, 0.5) { -1.0 } else { 1.0 };
            Effect::LoadBefore(sign * 0.2 * large)
        }
        8 => {
            // as slow as the readings are apart, else nothing of it is seen
            let waits = protocol.loadings.iter().map(|l| l.time - l.changed);
            let shortest = waits.fold(f64::INFINITY, f64::min);
            Effect::Damping { share: large, time: shortest * log_uniform(random, 0.5, 3.0) }
        }
        9 => Effect::WearingFriction { first: 0.05 * large * largest, last: 0.15 * large * largest },
        // a rod that is stiffer where it is loaded faster creeps since each load was hung, by the
        // same numbers: log₁₀ of a speed is that of a step less that of its time
        _ => Effect::SpeedOfLoading(0.1 * large),
    }
}
