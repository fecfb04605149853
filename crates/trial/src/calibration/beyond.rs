//! Physics that no library has, and how large at most.
//!
//! | | at most |
//! |---|---|
//! | a link twists with two joints | 1000 µrad/rad² |
//! | a ball out of round | 200 µm |
//! | a worn tooth: play in a window of 20° to 60° | 2000 µrad |
//! | a disturbance that comes and goes in 4 to 20 poses | 300 µm |
//! | refraction of a tracker's light | 300 µm/m² |
//! | a bearing that wobbles twice per turn | 300 µm |
//! | a tool that is loose in its mount | 300 µm |
//! | angles that remember the move before the last one | 3·10⁻⁴ |

use super::draw::{direction, either, loaded};
use super::effect::Effect;
use super::setup::Needs;
use super::site::Site;
use crate::chance::log_uniform;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, UM, URAD};

/// How many there are, by number for [`beyond`].
pub const BEYOND: usize = 8;
/// Range of the largest size, of the end in the table.
const LARGEST: (f64, f64) = (0.5, 1.0);

/// What a recording must have to carry it.
pub fn needs(effect: usize) -> Needs {
    let none = Needs::default();
    match effect {
        2 => Needs { masses: Some(true), ..none },
        3 => Needs { clock: true, ..none },
        4 => Needs { device: Some(1), ..none },
        _ => none,
    }
}

/// As large as it may be.
pub fn beyond(effect: usize, site: &Site, random: &mut Random) -> Effect {
    let large = |random: &mut Random, most: f64| most * random.uniform(LARGEST.0, LARGEST.1);
    let phase = |random: &mut Random| random.uniform(0.0, std::f64::consts::TAU);
    match effect {
        0 => {
            let link = 1 + random.index(3);
            let joints = [random.index(link), link + 1 + random.index(5 - link)];
            Effect::LinkTorsion { link, joints, per: either(random) * large(random, 1000.0) * URAD }
        }
        1 => Effect::Ball(large(random, 200.0) * UM),
        2 => {
            let (joint, _) = loaded(site, random);
            let window = [random.uniform(-1.5, 1.5), random.uniform(20.0, 60.0) * DEG];
            Effect::Wear { joint, window, play: large(random, 2000.0) * URAD }
        }
        3 => Effect::Disturbance {
            by: direction(random) * large(random, 300.0) * UM,
            period: 30.0 * log_uniform(random, 4.0, 20.0),
            phase: phase(random),
        },
        4 => Effect::Refraction(large(random, 300.0) * UM),
        5 => Effect::Runout { joint: random.index(5), by: large(random, 300.0) * UM, phase: phase(random) },
        6 => Effect::LooseMount(large(random, 300.0) * UM),
        _ => Effect::MoveHistory(large(random, 3e-4)),
    }
}
