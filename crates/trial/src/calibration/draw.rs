//! Which effect, how large, where. Sizes are log-uniform over the range in which a robot or a fixture may meet them; of two
//! effects in one case over the upper half of it:
//!
//! | effect | size | from | to |
//! |---|---|---|---|
//! | `transmission_error` | amplitude of the strongest of one to four waves of 1 to 30 cycles/rev, some with a beat, µrad | 10 | 500 |
//! | `backlash` | play, µrad, by torque or by approach | 20 | 1000 |
//! | `joint_compliance` | yielding at the largest torque, µrad, in a file without masses | 50 | 2000 |
//! | `joint_nonlinear_stiffness` | the same beyond what is linear | 50 | 2000 |
//! | `encoder_scale` | departure of the factor from 1 | 10⁻⁵ | 10⁻³ |
//! | `wrist_coupling`, `readback_lag` | share | 10⁻⁵ | 10⁻³ |
//! | `clamp_shift`, `socket_shift` | µm | 30 | 3000 |
//! | `clamp_pose` | µm; turned by as many mrad per mm | 30 | 3000 |
//! | `thermal_drift` | µm/K, or µm/h | 3 | 300 |
//! | `payload_mass` | kg | 0.1 | 5 |
//! | `tip_mass` | g | 5 | 300 |
//! | `rod_stiffness` | departure of the factor from 1 | 2 % | 60 % |
//! | `outlier` | noises, one or two rows | 5 | 100 |
//! | a link twists with two joints | µrad/rad² | 10 | 1000 |
//! | a ball out of round | µm | 5 | 200 |
//! | a worn tooth | play in a window of 20° to 60°, µrad | 50 | 2000 |
//! | a periodic disturbance | µm; period 4 to 20 poses | 10 | 300 |
//! | refraction | µm/m² | 5 | 300 |

use nalgebra::Vector3;

use super::effect::Effect;
use super::setup::Needs;
use super::site::Site;
use crate::chance::{happens, log_uniform};
use crate::place::Place;
use rodcal_base::statistics::Random;
use rodcal_base::units::{DEG, GRAM, UM, URAD};

/// Effects that a library may have, by number for [`library`].
pub const LIBRARY: usize = 16;
/// Effects that none has, by number for [`beyond`].
pub const BEYOND: usize = 5;

/// What a recording must have to carry the effect of the library of this number.
pub fn needs(effect: usize) -> Needs {
    let none = Needs::default();
    match effect {
        3 => Needs { masses: Some(false), ..none },
        2 | 4 | 10 => Needs { masses: Some(true), ..none },
        7 => Needs { fixture: true, ..none },
        8 => Needs { device: Some(0), ..none },
        9 => Needs { clock: true, ..none },
        11 | 14 => Needs { rod: true, ..none },
        _ => none,
    }
}

/// The same for what is beyond the library.
pub fn needs_beyond(effect: usize) -> Needs {
    let none = Needs::default();
    match effect {
        2 => Needs { masses: Some(true), ..none },
        4 => Needs { device: Some(1), ..none },
        _ => none,
    }
}

/// Any direction, a unit vector.
pub fn direction(random: &mut Random) -> Vector3<f64> {
    let v = Vector3::from_fn(|_, _| random.normal());
    v / v.norm().max(1e-9)
}

fn either(random: &mut Random) -> f64 {
    if happens(random, 0.5) { -1.0 } else { 1.0 }
}

/// A joint whose gravity torque counts, and its largest size, N·m.
fn loaded(site: &Site, random: &mut Random) -> (usize, f64) {
    let mut largest = vec![0.0f64; site.nominal.len()];
    for row in 0..site.rows.len() {
        for (most, torque) in largest.iter_mut().zip(site.loads(row).0) {
            *most = most.max(torque.abs());
        }
    }
    let most = largest.iter().copied().fold(0.0, f64::max);
    let joints: Vec<usize> = (0..largest.len()).filter(|&j| largest[j] > 0.05 * most).collect();
    let joint = joints.get(random.index(joints.len())).copied().unwrap_or(1);
    (joint, largest[joint])
}

/// An effect of the library at a site that can carry it; of its range the part above the share `faintest` (on the logarithm).
pub fn library(effect: usize, site: &Site, faintest: f64, random: &mut Random) -> Effect {
    let sized = |random: &mut Random, low: f64, high: f64| {
        log_uniform(random, low * (high / low).powf(faintest), high)
    };
    let n = site.nominal.len();
    let any = random.index(n);
    match effect {
        0 | 15 => {
            let largest = sized(random, 10.0, 500.0) * URAD;
            let count = if happens(random, 0.4) { 1 } else { 2 + random.index(3) };
            let base = log_uniform(random, 1.0, 30.0);
            let waves = (0..count)
                .map(|k| {
                    // multiples of one another, nearly
                    let cycles =
                        if k == 0 { base } else { base * (k + 1) as f64 * random.uniform(0.97, 1.03) };
                    let share = if k == 0 { 1.0 } else { random.uniform(0.1, 0.7) };
                    [cycles.min(38.0), share * largest, random.uniform(0.0, std::f64::consts::TAU)]
                })
                .collect();
            let beat = (count > 1 && happens(random, 0.3))
                .then(|| [random.uniform(0.2, 0.6), random.uniform(0.5, 2.0)]);
            Effect::Transmission { joint: any, waves, beat }
        }
        1 => Effect::Backlash { joint: any, play: sized(random, 20.0, 1000.0) * URAD, by_approach: true },
        2 => {
            let (joint, _) = loaded(site, random);
            Effect::Backlash { joint, play: sized(random, 20.0, 1000.0) * URAD, by_approach: false }
        }
        3 => {
            let (joint, largest) = loaded(site, random);
            Effect::Compliance { joint, compliance: sized(random, 50.0, 2000.0) * URAD / largest }
        }
        4 => {
            let (joint, largest) = loaded(site, random);
            let (cubic, by) = (happens(random, 0.6), sized(random, 50.0, 2000.0) * URAD);
            Effect::Nonlinear { joint, cubic, per: by / largest.powi(if cubic { 3 } else { 2 }) }
        }
        5 => Effect::EncoderScale { joint: any, factor: 1.0 + either(random) * sized(random, 1e-5, 1e-3) },
        6 => {
            let from = n - 3 + random.index(2);
            let (from, to) = if happens(random, 0.5) { (from, from + 1) } else { (from + 1, from) };
            Effect::Coupling { from, to, share: either(random) * sized(random, 1e-5, 1e-3) }
        }
        7 => {
            let group = random.index(site.groups());
            let rows: Vec<usize> =
                (0..site.rows.len()).filter(|&row| site.rows[row].group == group).collect();
            let inner = rows.len().saturating_sub(4).max(1);
            let from = rows.get(2 + random.index(inner)).copied().unwrap_or(0);
            Effect::Shift { group, from, by: direction(random) * sized(random, 30.0, 3000.0) * UM }
        }
        8 => {
            let size = sized(random, 30.0, 3000.0);
            let turn = direction(random) * (size * random.uniform(0.2, 2.0) * URAD);
            Effect::ClampPose {
                group: random.index(site.groups()),
                by: direction(random) * (size * UM),
                turn,
            }
        }
        9 => {
            let by = direction(random) * sized(random, 3.0, 300.0) * UM;
            match site.has_temperature {
                true => Effect::Drift { by, by_time: false },
                false => Effect::Drift { by: by / 3600.0, by_time: true },
            }
        }
        10 => Effect::Payload(sized(random, 0.1, 5.0)),
        11 => Effect::TipMass(sized(random, 5.0, 300.0) * GRAM),
        12 => {
            let joint = happens(random, 0.4).then_some(any);
            Effect::Lag { joint, share: sized(random, 1e-5, 1e-3) }
        }
        14 => {
            let departure = sized(random, 0.02, 0.6);
            Effect::Rod(if happens(random, 0.75) { 1.0 + departure } else { 1.0 - departure })
        }
        _ => {
            let count = if happens(random, 0.7) { 1 } else { 2 };
            let first = random.index(site.rows.len());
            let second = (first + 1 + random.index(site.rows.len() - 1)) % site.rows.len();
            let mut by = || direction(random) * (sized(random, 5.0, 100.0) * site.noise);
            let of = [(first, by()), (second, by())];
            Effect::Outlier(of[..count].to_vec())
        }
    }
}

/// Physics that no library has.
pub fn beyond(effect: usize, site: &Site, random: &mut Random) -> Effect {
    match effect {
        0 => {
            let link = 1 + random.index(3);
            let joints = [random.index(link), link + 1 + random.index(5 - link)];
            Effect::LinkTorsion {
                link,
                joints,
                per: either(random) * log_uniform(random, 10.0, 1000.0) * URAD,
            }
        }
        1 => Effect::Ball(log_uniform(random, 5.0, 200.0) * UM),
        2 => {
            let (joint, _) = loaded(site, random);
            let window = [random.uniform(-1.5, 1.5), random.uniform(20.0, 60.0) * DEG];
            Effect::Wear { joint, window, play: log_uniform(random, 50.0, 2000.0) * URAD }
        }
        3 => Effect::Disturbance {
            by: direction(random) * log_uniform(random, 10.0, 300.0) * UM,
            period: 30.0 * log_uniform(random, 4.0, 20.0),
            phase: random.uniform(0.0, std::f64::consts::TAU),
        },
        _ => Effect::Refraction(log_uniform(random, 5.0, 300.0) * UM),
    }
}

/// Where an effect is.
pub fn place(effect: &Effect, site: &Site) -> Place {
    match effect {
        Effect::Transmission { joint, .. }
        | Effect::Backlash { joint, .. }
        | Effect::Compliance { joint, .. }
        | Effect::Nonlinear { joint, .. }
        | Effect::EncoderScale { joint, .. }
        | Effect::Lag { joint: Some(joint), .. }
        | Effect::Wear { joint, .. } => Place::joint(*joint),
        Effect::Coupling { from, to, .. } => Place { driven_by: Some(from + 1), ..Place::joint(*to) },
        Effect::ClampPose { group, .. } => Place::named(&site.group_name(*group)),
        Effect::Shift { group, from, .. } => shift_place(site, *group, *from),
        Effect::Drift { .. } => Place::part("base"),
        Effect::Payload(_) => Place::part("flange"),
        Effect::TipMass(_) => Place::part("tip"),
        Effect::Lag { .. } => Place { joint: Some("all".into()), ..Place::default() },
        Effect::Rod(_) => Place::part("rod"),
        Effect::Outlier(rows) => {
            let of = |(row, _): &(usize, _)| Place { row: Some(row + 1), ..Place::default() };
            Place { all: rows.iter().map(of).collect(), ..Place::default() }
        }
        Effect::LinkTorsion { link, joints: [a, b], .. } => {
            Place::part(&format!("link {}, joints {} and {}", link + 1, a + 1, b + 1))
        }
        Effect::Ball(_) => Place::part("ball"),
        Effect::Disturbance { .. } => Place::part("world"),
        Effect::Refraction(_) => Place::part("tracker"),
    }
}

/// After the last row of the fixture before it moved.
pub fn shift_place(site: &Site, group: usize, from: usize) -> Place {
    let last = (0..from).rev().find(|&row| site.rows[row].group == group).unwrap_or(0);
    Place { after_row: Some(last + 1), ..Place::named(&site.group_name(group)) }
}
